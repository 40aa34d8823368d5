#include "job/engine.h"

#include "lazy/lazy.h"
#include "transport/carried_ink.h"
#include <string.h>

/* Functions of an engine's table, for states that fl_NAME_new() makes. */
#define DEFINE_CALLS(name)                                                                         \
    static void name##_close(void *state)                                                          \
    {                                                                                              \
        fl_##name##_free(state);                                                                   \
    }                                                                                              \
    static void name##_measure(void *state, bool energies)                                         \
    {                                                                                              \
        fl_##name##_measure(state, energies);                                                      \
    }                                                                                              \
    static bool name##_guide_pairs(const void *state, FlGuidePairs *pairs, GError **error)         \
    {                                                                                              \
        return fl_##name##_guide_pairs(state, pairs, error);                                       \
    }                                                                                              \
    static GBytes *name##_save(void *state, GError **error)                                        \
    {                                                                                              \
        return fl_##name##_save(state, error);                                                     \
    }                                                                                              \
    static bool name##_load(void *state, GBytes *bytes, GError **error)                            \
    {                                                                                              \
        return fl_##name##_load(state, bytes, error);                                              \
    }

DEFINE_CALLS(synth)
DEFINE_CALLS(lazy)

/* ---- patch: a field of matches into the recording, then the vote [F21] ------------------------
 */

static void *patch_open(const FlEngineInput *input, GError **error)
{
    FlSynth *synth =
        fl_synth_new(input->style->exemplar, &input->settings->params, input->size, input->seed);
    fl_synth_stop_by(synth, input->stop);
    return synth;
}

static bool patch_frame(void *state, FlGuides *guides, const FlEnginePaint *paint, GError **error)
{
    return fl_synth_frame(state, guides, paint->rgb, paint->stats, paint->view, error);
}

static bool patch_rest(void *state)
{
    return fl_synth_rest(state);
}

static int patch_drying(const FlStyleInstance *style, const FlParams *params)
{
    return fl_synth_drying_frames(style->exemplar, params);
}

/* ---- lazyfluids: an exemplar that rides on the motion, used equally [L15] -----------------------
 */

static void *lazy_open(const FlEngineInput *input, GError **error)
{
    return fl_lazy_new(input->style->exemplar, &input->settings->params,
                       input->settings->recording_end, input->size, input->seed, error);
}

static bool lazy_frame(void *state, FlGuides *guides, const FlEnginePaint *paint, GError **error)
{
    return fl_lazy_frame(state, guides, paint->rgb, paint->alpha, paint->stats, paint->view, error);
}

static float lazy_reach(const FlStyleInstance *style, const FlParams *params)
{
    return style->exemplar->cut_out ? fl_lazy_reach(style->exemplar, params) : 0;
}

/* ---- transport: the region's own ink, moved by the style's tile [KAGS19] ------------------------
 */

/* Amounts of transport are relative to the mean, those of an ink to its median. */
static int transport_exposure(const FlStyleInstance *style)
{
    return FL_EXPOSURE_ONE * FL_AMOUNT_ONE / MAX(style->ink->mean, 1);
}

static void transport_close(void *state)
{
    fl_carried_ink_free(state);
}

static void *transport_open(const FlEngineInput *input, GError **error)
{
    const FlInk *ink = input->style->ink;
    FlCarriedInkInput carried = {.width = input->size.width,
                                 .height = input->size.height,
                                 .tile = input->style->tile,
                                 .scale = input->style->enlarged,
                                 .strength = &input->settings->strength,
                                 .seed = input->seed};
    memcpy(carried.colour.paper, ink->paper, sizeof carried.colour.paper);
    for (int c = 0; c < 3; c++)
        carried.colour.density[c] = (int32_t)((int64_t)ink->density[c] * ink->mean / FL_AMOUNT_ONE);
    return fl_carried_ink_new(&carried, error);
}

static bool transport_frame(void *state, FlGuides *guides, const FlEnginePaint *paint,
                            GError **error)
{
    return fl_carried_ink_frame(state, guides, paint->rgb, error);
}

static GBytes *transport_save(void *state, GError **error)
{
    return fl_carried_ink_save(state, error);
}

static bool transport_load(void *state, GBytes *bytes, GError **error)
{
    return fl_carried_ink_load(state, bytes, error);
}

/* ---- the table --------------------------------------------------------------------------------
 */

static const FlEngine engines[] = {
    [FL_ENGINE_PATCH] = {.name = "patch",
                         .enlarges = true,
                         .plays = true,
                         .open = patch_open,
                         .close = synth_close,
                         .measure = synth_measure,
                         .frame = patch_frame,
                         .rest = patch_rest,
                         .drying = patch_drying,
                         .guide_pairs = synth_guide_pairs,
                         .save = synth_save,
                         .load = synth_load},
    [FL_ENGINE_LAZYFLUIDS] = {.name = "lazyfluids",
                              .reach = lazy_reach,
                              .plays = true,
                              .open = lazy_open,
                              .close = lazy_close,
                              .measure = lazy_measure,
                              .frame = lazy_frame,
                              .guide_pairs = lazy_guide_pairs,
                              .save = lazy_save,
                              .load = lazy_load},
    [FL_ENGINE_TRANSPORT] = {.name = "transport",
                             .claims = fl_tile_exists,
                             .needs_tile = true,
                             .exposure = transport_exposure,
                             .open = transport_open,
                             .close = transport_close,
                             .frame = transport_frame,
                             .save = transport_save,
                             .load = transport_load},
};

const FlEngine *fl_engine_choose(FlEngineChoice choice, const char *style_folder)
{
    if (choice != FL_ENGINE_AUTO)
        return &engines[choice];
    for (size_t e = G_N_ELEMENTS(engines) - 1; e > FL_ENGINE_PATCH; e--)
        if (engines[e].claims && engines[e].claims(style_folder))
            return &engines[e];
    return &engines[FL_ENGINE_PATCH];
}
