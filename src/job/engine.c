#include "job/engine.h"

#include "lazy/lazy.h"

/* ---- patch: a field of matches into the recording, then the vote [F21] ------------------------
 */

static bool claims_all(const char *style_folder)
{
    return true;
}

static void *patch_open(const FlEngineInput *input, GError **error)
{
    return fl_synth_new(input->style->exemplar, &input->settings->params, input->size, input->seed,
                        error);
}

static void patch_close(void *state)
{
    fl_synth_free(state);
}

static void patch_measure(void *state, bool energies)
{
    fl_synth_measure(state, energies);
}

static bool patch_frame(void *state, const FlGuides *guides, const FlEnginePaint *paint,
                        GError **error)
{
    return fl_synth_frame(state, guides, paint->rgb, paint->stats, paint->view, error);
}

static GBytes *patch_save(void *state, GError **error)
{
    return fl_synth_save(state, error);
}

static bool patch_load(void *state, GBytes *bytes, GError **error)
{
    return fl_synth_load(state, bytes, error);
}

/* ---- lazyfluids: an exemplar that rides on the motion, used equally [L15] -----------------------
 */

static void *lazy_open(const FlEngineInput *input, GError **error)
{
    return fl_lazy_new(input->style->exemplar, &input->settings->params, input->size, input->seed,
                       error);
}

static void lazy_close(void *state)
{
    fl_lazy_free(state);
}

static void lazy_measure(void *state, bool energies)
{
    (void)state, (void)energies; // they cost nothing
}

static bool lazy_frame(void *state, const FlGuides *guides, const FlEnginePaint *paint,
                       GError **error)
{
    return fl_lazy_frame(state, guides, paint->rgb, NULL, paint->stats, paint->view, error);
}

static GBytes *lazy_save(void *state, GError **error)
{
    return fl_lazy_save(state, error);
}

static bool lazy_load(void *state, GBytes *bytes, GError **error)
{
    return fl_lazy_load(state, bytes, error);
}

/* ---- the table --------------------------------------------------------------------------------
 */

static const FlEngine engines[] = {
    [FL_ENGINE_PATCH] = {"patch", claims_all, patch_open, patch_close, patch_measure, patch_frame,
                         patch_save, patch_load},
    [FL_ENGINE_LAZYFLUIDS] = {"lazyfluids", NULL, lazy_open, lazy_close, lazy_measure, lazy_frame,
                              lazy_save, lazy_load},
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
