#include "synth/enlargement.h"

#include "base/alloc.h"
#include "base/error.h"
#include "base/spill.h"
#include "synth/spline.h"

struct FlEnlargement {
    FlExemplarLevel level; // its colours only
    FlSpill *rgb;          // a block for each frame; NULL: all are in the window
};

void fl_enlargement_free(FlEnlargement *enlargement)
{
    if (!enlargement)
        return;
    free(enlargement->level.colour);
    fl_spill_free(enlargement->rgb);
    g_free(enlargement);
}

static size_t pixels_of(const FlEnlargement *enlargement)
{
    return (size_t)enlargement->level.width * (size_t)enlargement->level.height;
}

/* ---- the window ------------------------------------------------------------------------------ */

/* The spline coefficients of frame t; planes: scratch for three. */
static void pack_frame(FlEnlargement *enlargement, const uint8_t *rgb, int t, float *planes)
{
    FlExemplarLevel *level = &enlargement->level;
    const size_t n = pixels_of(enlargement);
    float *const plane[3] = {planes, planes + n, planes + 2 * n};
    for (size_t c = 0; c < 3; c++)
        for (size_t p = 0; p < n; p++)
            plane[c][p] = rgb[3 * p + c] / 255.0f;
    fl_spline_prefilter(plane, 3, level->width, level->height,
                        level->colour + (size_t)t * level->frame_pixels + FL_PAD * level->pitch +
                            FL_PAD,
                        (int)level->pitch);
}

static bool pack_window(FlEnlargement *enlargement, const FlStyle *style, GError **error)
{
    const FlExemplarLevel *level = &enlargement->level;
    const size_t n = 3 * pixels_of(enlargement);
    GError *first = NULL;
#pragma omp parallel
    {
        GError *failure = NULL;
        g_autofree float *planes = fl_alloc(n, sizeof *planes, "an exemplar", &failure);
#pragma omp for schedule(dynamic, 1)
        for (int t = level->first; t < level->first + level->window; t++)
            if (planes)
                pack_frame(enlargement, style->rgb + n * (size_t)t, t, planes);
        fl_parallel_error_keep(&first, failure);
    }
    return fl_parallel_error_propagate(error, first);
}

static bool spill_frames(FlEnlargement *enlargement, const FlStyle *style, GError **error)
{
    const size_t bytes = 3 * pixels_of(enlargement);
    if (!(enlargement->rgb = fl_spill_new((size_t)style->n_frames, error)))
        return false;
    for (int t = 0; t < style->n_frames; t++)
        if (!fl_spill_put(enlargement->rgb, (size_t)t, style->rgb + bytes * (size_t)t, bytes,
                          error))
            return false;
    return true;
}

FlEnlargement *fl_enlargement_new(const FlStyle *style, const FlExemplarLevel *half, GError **error)
{
    g_autoptr(FlEnlargement) enlargement = g_new0(FlEnlargement, 1);
    FlExemplarLevel *level = &enlargement->level;
    level->width = style->width, level->height = style->height;
    level->n_frames = style->n_frames;
    level->first = half->first, level->window = half->window;
    level->pitch = (size_t)style->width + 2 * FL_PAD;
    level->frame_pixels = level->pitch * ((size_t)style->height + 2 * FL_PAD);
    const size_t pixels = level->frame_pixels * (size_t)level->n_frames;
    level->colour = fl_alloc_lazy(pixels, sizeof *level->colour, "an exemplar", error);
    if (!level->colour || !pack_window(enlargement, style, error) ||
        (level->window < level->n_frames && !spill_frames(enlargement, style, error)))
        return NULL;
    return g_steal_pointer(&enlargement);
}

const FlExemplarLevel *fl_enlargement_level(const FlEnlargement *enlargement)
{
    return &enlargement->level;
}

double fl_enlargement_bytes(const FlEnlargement *enlargement)
{
    const FlExemplarLevel *level = &enlargement->level;
    return (double)level->frame_pixels * level->window * sizeof *level->colour;
}

/* Frees the frames t to end - 1. */
static void release_frames(FlEnlargement *enlargement, int t, int end)
{
    const FlExemplarLevel *level = &enlargement->level;
    fl_release(level->colour + (size_t)t * level->frame_pixels,
               (size_t)(end - t) * level->frame_pixels * sizeof *level->colour);
}

bool fl_enlargement_seek(FlEnlargement *enlargement, int now, GError **error)
{
    FlExemplarLevel *level = &enlargement->level;
    const int old = level->first, window = level->window;
    const size_t values = 3 * pixels_of(enlargement);
    if (now == old)
        return true;
    g_autofree uint8_t *rgb = fl_alloc(values, 1, "an exemplar", error);
    g_autofree float *planes = rgb ? fl_alloc(values, sizeof *planes, "an exemplar", error) : NULL;
    if (!planes)
        return false;
    level->first = now;
    release_frames(enlargement, 0, now);
    release_frames(enlargement, now + window, level->n_frames);
    for (int t = now; t < now + window; t++) {
        if (t >= old && t < old + window)
            continue;
        if (!fl_spill_get(enlargement->rgb, (size_t)t, rgb, values, error))
            return false;
        pack_frame(enlargement, rgb, t, planes);
    }
    return true;
}
