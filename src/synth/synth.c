#include "synth/synth.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "base/rng.h"
#include "base/schedule.h"
#include "synth/carry.h"
#include "synth/drying.h"
#include "synth/patch_pairs.h"
#include "synth/shift.h"
#include "synth/synth_data.h"
#include "synth/synth_levels.h"
#include "synth/vote.h"
#include <string.h>

FlSynth *fl_synth_new(const FlExemplar *exemplar, const FlParams *params, FlSynthSize size,
                      uint64_t seed)
{
    FlSynth *synth = g_new0(FlSynth, 1);
    synth->exemplar = exemplar;
    synth->params = params;
    synth->last.painted_width = size.width, synth->last.painted_height = size.height;
    synth->width = synth->last.width = fl_field_side(exemplar, size.width);
    synth->height = synth->last.height = fl_field_side(exemplar, size.height);
    const int frame_width = fl_field_side(exemplar, size.frame_width);
    const int frame_height = fl_field_side(exemplar, size.frame_height);
    synth->side = (float)MAX(frame_width, frame_height);
    synth->n_levels = MIN(exemplar->n_levels, fl_levels_of(frame_width, frame_height));
    synth->key = fl_hash64(seed);
    fl_kernels_init(&synth->kernels, fl_cpu_flags());
    return synth;
}

static void clear_frame(FlSynth *synth)
{
    for (int l = 0; l < synth->n_levels; l++)
        fl_nnf_clear(&synth->nnf[l]);
    fl_target_clear(&synth->target);
    g_clear_pointer(&synth->tone, free);
    synth->view = (FlSynthView){0};
}

void fl_synth_free(FlSynth *synth)
{
    if (!synth)
        return;
    clear_frame(synth);
    fl_synth_state_clear(&synth->last);
    g_free(synth);
}

void fl_synth_stop_by(FlSynth *synth, const FlStop *stop)
{
    synth->stop = stop;
}

void fl_synth_measure(FlSynth *synth, bool energies)
{
    synth->wants_energies = energies;
}

/* A bounding box, enlarged by the coarsest patches, on the coarsest grid. */
static FlRect working_rect(const FlSynth *synth, FlRect box)
{
    const int grid = 1 << (synth->n_levels - 1);
    const FlRect page = {0, 0, synth->width, synth->height};
    return fl_rect_on_grid(fl_rect_grown(box, FL_PATCH_RADIUS * grid, page), grid);
}

/* The last field in the new rectangle, carried along the drawing's motion and shifted in the
 * exemplar's time. */
static bool carry_last(const FlSynth *synth, const FlGuides *guides, FlRect rect, FlCarried *out,
                       GError **error)
{
    const FlSynthState *last = &synth->last;
    const FlParams *params = synth->params;
    g_autofree uint8_t *angle = fl_alloc_unset(fl_rect_pixels(rect), 1, "a field", error);
    if (!angle || !fl_carried_init(out, rect.width, rect.height, error))
        return false;
    const FlCarry carry = {
        guides,       params->carry, params->rotate, last->frame,
        synth->width, last->mask,    last->wet,      params->settled > 0 ? synth->exemplar : NULL};
    fl_nnf_carry(&last->nnf, last->rect, &carry, rect, &synth->exemplar->level[0], out);
    fl_rect_copy(guides->angle, fl_guides_rect(guides), angle, rect, 1);
    const FlTargetMotion motion = {out->speed, angle, params->flow_still, synth->boil};
    fl_nnf_shift(&out->nnf, synth->exemplar, &motion);
    return true;
}

#define DRY_AFTER 36     // frames at rest
#define DRIES_FROM 0.75f // carry from which on paint dries, wholly where it is 1

int fl_synth_drying_frames(const FlExemplar *exemplar, const FlParams *params)
{
    const int window = exemplar->level[0].window;
    const bool dries = params->carry > DRIES_FROM && params->w_age > 0 && window > 1;
    return !dries ? 0 : params->play_age ? window : DRY_AFTER;
}

static bool dries(const FlSynth *synth)
{
    return fl_synth_drying_frames(synth->exemplar, synth->params) > 0;
}

/* The frames of the exemplar that paint plays by its age; 0: it dries. */
static int plays(const FlSynth *synth)
{
    return synth->params->play_age ? synth->exemplar->level[0].window - 1 : 0;
}

/* Computes the wetness of the frame's paint, *wet, and moves carried matches to this wetness. */
static bool dry(FlSynth *synth, const FlGuides *guides, FlRect rect, FlCarried *carried,
                uint8_t **wet, bool *goes_on, GError **error)
{
    const float share = fl_ease(DRIES_FROM, 1, synth->params->carry);
    const FlDrying drying = {guides,       synth->side / 480,
                             synth->width, share * synth->exemplar->wets,
                             plays(synth), carried ? synth->last.wet : NULL};
    *goes_on = false;
    *wet = fl_alloc((size_t)synth->width * (size_t)synth->height, 1, "a mask", error);
    if (!*wet || !dries(synth))
        return *wet;
    if (!(synth->tone = fl_alloc_unset(fl_rect_pixels(rect), 1, "a mask", error)))
        return false;
    *goes_on = fl_drying_step(&drying, rect, carried, *wet, synth->tone);
    if (carried)
        fl_drying_show(&drying, rect, *wet, synth->exemplar, carried);
    return true;
}

/* The picture in twice the size of the field. */
static void enlarge(const FlSynth *synth, uint8_t *rgb)
{
    const FlEnlarged enlarged = {&synth->kernels, fl_synth_sharpness(synth),
                                 synth->last.painted_width, synth->last.painted_height, rgb};
    fl_enlarge(fl_enlargement_level(synth->exemplar->enlargement), &synth->nnf[0],
               &synth->target.level[0].blocks, synth->target.rect, &enlarged);
}

/* Beside the blocks there is paper. */
static void write_rgb(const FlSynth *synth, uint8_t *rgb)
{
    const FlTargetLevel *full = &synth->target.level[0];
    const FlRect rect = synth->target.rect;
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = 0; k < full->blocks.n; k++) {
        const FlRect block = full->blocks.block[k];
        for (int y = block.y; y < block.y + block.height; y++) {
            const size_t from = 3 * ((size_t)y * (size_t)rect.width + (size_t)block.x);
            const size_t to =
                3 * ((size_t)(rect.y + y) * (size_t)synth->width + (size_t)(rect.x + block.x));
            for (size_t v = 0; v < 3 * (size_t)block.width; v++)
                rgb[to + v] = fl_vote_byte(full->colour[from + v]);
        }
    }
}

static void fill_paper(const FlSynth *synth, uint8_t *rgb)
{
    const size_t pixels = fl_synth_state_painted(&synth->last) / 3;
#pragma omp parallel for schedule(static) if (fl_schedule_worth_threads(pixels))
    for (size_t p = 0; p < pixels; p++)
        memcpy(rgb + 3 * p, synth->exemplar->paper, 3);
}

static FlRestRule rest_rule(const FlSynth *synth)
{
    return (FlRestRule){synth->exemplar->border_px, synth->params->flow_still,
                        dries(synth) ? synth->side / 480 : 0, plays(synth) > 0};
}

static bool take_shape(FlSynth *synth, const FlGuides *guides, GError **error)
{
    const size_t pixels = (size_t)synth->width * synth->height;
    if (!(synth->last.mask = fl_alloc(pixels, 1, "a mask", error)))
        return false;
    const FlRestRule rule = rest_rule(synth);
    fl_rest_shape(guides, &rule, synth->last.mask);
    return true;
}

/* The target, and what the next frame needs of the guides, which then may go. */
static bool take_guides(FlSynth *synth, FlGuides *guides, FlRect rect, GError **error)
{
    if (!take_shape(synth, guides, error))
        return false;
    if (guides->disposable)
        fl_guides_drop_motion(guides);
    if (guides->disposable && fl_knows_depth(synth->params))
        g_clear_pointer(&guides->distance, g_free);
    if (!fl_target_init(&synth->target, guides, synth->params, rect, synth->n_levels,
                        synth->exemplar, error) ||
        (dries(synth) &&
         !fl_target_take_wetness(&synth->target, synth->last.wet, synth->width, error)))
        return false;
    if (guides->disposable)
        fl_guides_clear(guides);
    return true;
}

/* The last frame is large, and all that is needed of it is shifted: so that comes first. */
static bool prepare(FlSynth *synth, FlGuides *guides, FlRect rect, FlCarried *carried,
                    FlFrameStats *stats, GError **error)
{
    gint64 time = g_get_monotonic_time();
    const bool continues = synth->last.valid;
    bool goes_on;
    g_autofree uint8_t *wet = NULL;
    if ((continues && !carry_last(synth, guides, rect, carried, error)) ||
        !dry(synth, guides, rect, continues ? carried : NULL, &wet, &goes_on, error))
        return false;
    fl_synth_state_clear(&synth->last);
    synth->last.valid = continues;
    synth->last.wet = g_steal_pointer(&wet), synth->last.dries = goes_on;
    stats->seconds_temporal = fl_lap(&time);
    if (!take_guides(synth, guides, rect, error))
        return false;
    stats->seconds_target = fl_lap(&time);
    if (continues && !fl_synth_make_temporal(synth, carried, error))
        return false;
    stats->seconds_temporal += fl_lap(&time);
    return true;
}

/* The finest field, which is handed over, where it lies, and the picture. */
static bool remember(FlSynth *synth, const uint8_t *rgb, GError **error)
{
    FlSynthState *last = &synth->last;
    last->valid = true;
    last->rect = synth->target.rect;
    last->nnf = synth->nnf[0];
    synth->nnf[0] = (FlNnf){0};
    last->rgb = fl_alloc_unset(fl_synth_state_painted(last), 1, "a picture", error);
    if (last->rgb)
        memcpy(last->rgb, rgb, fl_synth_state_painted(last));
    return last->rgb;
}

/* True if a region at rest keeps its picture in the frame-th frame. */
static bool may_rest(const FlSynth *synth, int frame)
{
    const FlParams *params = synth->params;
    return params->rest && synth->last.valid &&
           fl_boil_step(params->boil, frame, synth->exemplar->level[0].window) == 0;
}

bool fl_synth_rest(FlSynth *synth)
{
    if (synth->last.dries || !may_rest(synth, synth->last.frame + 1))
        return false;
    synth->last.frame++;
    return true;
}

/* That of the picture which is kept; only its field is, if no view of it is needed. */
static FlSynthView view_at_rest(const FlSynth *synth)
{
    const FlSynthState *last = &synth->last;
    return synth->view.nnf ? synth->view : (FlSynthView){last->rect, &last->nnf, NULL, NULL};
}

/* Paints what the mask has in a rectangle. */
static bool paint_rect(FlSynth *synth, FlGuides *guides, FlRect rect, uint8_t *rgb,
                       FlFrameStats *stats, GError **error)
{
    g_auto(FlCarried) carried = {0};
    const int threads = fl_schedule_set_threads(fl_schedule_threads_for(fl_rect_pixels(rect)));
    const bool done = prepare(synth, guides, rect, &carried, stats, error) &&
                      fl_synth_run_levels(synth, &carried.nnf, stats, error);
    (void)fl_schedule_set_threads(threads);
    if (!done)
        return false;
    fill_paper(synth, rgb); // not before: until it is written to, it takes no memory
    (synth->exemplar->enlargement ? enlarge : write_rgb)(synth, rgb);
    if (synth->tone && synth->exemplar->wets > 0)
        fl_tone_picture(synth->tone, rect, fl_field_px(synth->exemplar), synth->exemplar->paper,
                        synth->last.painted_width, synth->last.painted_height, rgb);
    const FlTargetLevel *full = &synth->target.level[0];
    const bool has_temporal = synth->last.valid && fl_synth_finest_searched(synth) == 0;
    synth->view = (FlSynthView){rect, &synth->last.nnf, has_temporal ? full->temporal : NULL,
                                has_temporal ? full->temporal_weight : NULL};
    return remember(synth, rgb, error);
}

/* Paints the frame; shows: its view is needed. */
static bool paint(FlSynth *synth, FlGuides *guides, uint8_t *rgb, FlFrameStats *stats, bool shows,
                  GError **error)
{
    synth->last.frame++;
    synth->boil =
        fl_boil_step(synth->params->boil, synth->last.frame, synth->exemplar->level[0].window);
    const FlRestRule rule = rest_rule(synth);
    if (may_rest(synth, synth->last.frame) &&
        fl_rests(guides, &rule, synth->last.mask, synth->last.wet)) {
        memcpy(rgb, synth->last.rgb, fl_synth_state_painted(&synth->last));
        synth->view = view_at_rest(synth);
        return true;
    }
    clear_frame(synth);
    synth->moves = guides->has_motion && synth->params->carry > 0;
    fl_cost_scale_init(&synth->scale, synth->params);
    const FlRect box = fl_guides_box(guides, FL_INSIDE);
    if (box.width == 0) {
        fill_paper(synth, rgb);
        fl_synth_state_clear(&synth->last);
        return true;
    }
    const bool disposable = guides->disposable;
    guides->disposable &= !shows;
    const bool done = paint_rect(synth, guides, working_rect(synth, box), rgb, stats, error);
    guides->disposable = disposable;
    return done;
}

bool fl_synth_frame(FlSynth *synth, FlGuides *guides, uint8_t *rgb, FlFrameStats *stats,
                    FlSynthView *view, GError **error)
{
    FlFrameStats no_stats;
    FlFrameStats *const s = stats ? stats : &no_stats;
    *s = (FlFrameStats){0};
    const bool done = paint(synth, guides, rgb, s, view, error);
    if (view)
        *view = synth->view;
    else
        clear_frame(synth);
    if (!done) // its planes may be gone
        fl_synth_state_clear(&synth->last);
    return done;
}

bool fl_synth_guide_pairs(const FlSynth *synth, FlGuidePairs *pairs, GError **error)
{
    return fl_patch_pairs(synth->exemplar, synth->params, &synth->target, &synth->last.nnf,
                          synth->width, synth->height, pairs, error);
}

GBytes *fl_synth_save(FlSynth *synth, GError **error)
{
    return fl_synth_state_pack(&synth->last, error);
}

bool fl_synth_load(FlSynth *synth, GBytes *state, GError **error)
{
    clear_frame(synth); // a view is of the field that goes
    return fl_synth_state_unpack(&synth->last, state, &synth->exemplar->level[0], error);
}
