#include "job/style_cache.h"

#include "style/adapt.h"
#include <string.h>

struct FlStyleCache {
    GPtrArray *boxes; // of FlStyleInstance
};

static void paintbox_free(FlStyleInstance *box)
{
    g_free(box->path);
    fl_exemplar_free(box->exemplar);
    fl_ink_free(box->ink);
    g_free(box);
}
G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlStyleInstance, paintbox_free)

FlStyleCache *fl_style_cache_new(void)
{
    FlStyleCache *exemplars = g_new0(FlStyleCache, 1);
    exemplars->boxes = g_ptr_array_new_with_free_func((GDestroyNotify)paintbox_free);
    return exemplars;
}

void fl_style_cache_free(FlStyleCache *exemplars)
{
    if (!exemplars)
        return;
    g_ptr_array_unref(exemplars->boxes);
    g_free(exemplars);
}

static bool same_params(const FlParams *a, const FlParams *b)
{
    for (int i = 0; i < fl_param_count(); i++) {
        g_autofree char *x = fl_params_get(a, fl_param_info(i)->name);
        g_autofree char *y = fl_params_get(b, fl_param_info(i)->name);
        if (!g_str_equal(x, y))
            return false;
    }
    return true;
}

static FlStyleInstance *load(const char *path, const FlRegionSettings *settings, GError **error)
{
    const FlParams *params = &settings->params;
    const FlStyleUse use = {params->style_start, params->style_frames, params->style_step,
                            params->style_scale, settings->reverse};
    g_autoptr(FlStyle) whole = fl_style_load(path, error);
    g_autoptr(FlStyle) style = whole ? fl_style_adapt(whole, &use, error) : NULL;
    if (!style)
        return NULL;
    g_clear_pointer(&whole, fl_style_free); // recordings are large
    g_autoptr(FlStyleInstance) box = g_new0(FlStyleInstance, 1);
    *box = (FlStyleInstance){.path = g_strdup(path),
                             .params = *params,
                             .reverse = settings->reverse,
                             .medium = style->medium};
    memcpy(box->paper, style->paper, sizeof box->paper);
    if (!(box->ink = fl_ink_of_style(style, error)) ||
        !(box->exemplar = fl_exemplar_new(style, params, error)))
        return NULL;
    return g_steal_pointer(&box);
}

const FlStyleInstance *fl_style_cache_get(FlStyleCache *exemplars, const FlRegionSettings *settings,
                                          GError **error)
{
    g_autofree char *path = fl_style_find(settings->style, error);
    if (!path)
        return NULL;
    for (guint i = 0; i < exemplars->boxes->len; i++) {
        const FlStyleInstance *box = exemplars->boxes->pdata[i];
        if (g_str_equal(box->path, path) && box->reverse == settings->reverse &&
            same_params(&box->params, &settings->params))
            return box;
    }
    FlStyleInstance *box = load(path, settings, error);
    if (box)
        g_ptr_array_add(exemplars->boxes, box);
    return box;
}

double fl_style_cache_bytes(const FlStyleCache *exemplars)
{
    const double of_window = 50, of_rest = 9; // measured: with its rotations; while it is read
    double bytes = 0;
    for (guint i = 0; i < exemplars->boxes->len; i++) {
        const FlStyleInstance *box = exemplars->boxes->pdata[i];
        const FlExemplarLevel *full = &box->exemplar->level[0];
        bytes += (double)full->width * full->height *
                 (of_window * full->window + of_rest * (full->n_frames - full->window));
    }
    return bytes;
}

/*
 * The window moves with the film, at most a frame of the recording for a frame of the film, as far
 * as the recording goes or, in a loop, there and back. It is a function of the frame alone, so that
 * regions may share it and a render that is interrupted goes on with the same.
 */
static int window_at(int spare, int frame, int n_frames, bool loops)
{
    if (loops)
        return (int)((int64_t)2 * MIN(spare, n_frames / 2) * MIN(frame, n_frames - frame) /
                     n_frames);
    return n_frames > 1 ? (int)((int64_t)MIN(spare, n_frames - 1) * frame / (n_frames - 1)) : 0;
}

bool fl_style_cache_seek(FlStyleCache *exemplars, int frame, int n_frames, bool loops,
                         GError **error)
{
    for (guint i = 0; i < exemplars->boxes->len; i++) {
        FlExemplar *exemplar = ((FlStyleInstance *)exemplars->boxes->pdata[i])->exemplar;
        const FlExemplarLevel *full = &exemplar->level[0];
        const int first = window_at(full->n_frames - full->window, frame, n_frames, loops);
        if (!fl_exemplar_seek(exemplar, first, error))
            return false;
    }
    return true;
}
