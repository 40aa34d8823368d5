/* Frames as pictures, which workers draw; those that no hand draws are kept packed. */
#include "base/rng.h"
#include "drawing/drawing.h"
#include "drawing/drawing_data.h"

#define MOST_KEPT ((size_t)32 << 20) // bytes

FlRequest fl_drawing_request(const FlDrawing *drawing, int frame, FlVerb verb)
{
    const FlDrawingFrame *f = &drawing->frame[frame];
    const FlSvgOptions svg = {
        .canvas = f->canvas, .dpi = drawing->dpi, .whole = (const char *const *)f->whole};
    FlRequest request = fl_sequence_request(drawing->sequence, frame, verb, svg);
    request.frame = f->origin, request.page = f->page;
    request.width = drawing->width, request.height = drawing->height;
    request.n_regions = (int)drawing->regions->len;
    return request;
}

void fl_drawing_forget(FlDrawing *drawing)
{
    for (int i = 0; i < drawing->n_kept; i++)
        g_clear_pointer(&drawing->kept[i], g_bytes_unref);
    drawing->kept_bytes = 0;
}

/** Keeps a frame, if there is room. */
static void keep(FlDrawing *drawing, int frame, const FlReader *packed)
{
    GBytes **kept = &drawing->kept[drawing->frame[frame].origin];
    g_mutex_lock(&drawing->mutex);
    if (!*kept && packed->left <= MOST_KEPT - drawing->kept_bytes) {
        *kept = g_bytes_new(packed->at, packed->left);
        drawing->kept_bytes += packed->left;
    }
    g_mutex_unlock(&drawing->mutex);
}

/** A frame, to be unreferenced; NULL: it is not kept. */
static GBytes *find_kept(FlDrawing *drawing, int frame)
{
    g_mutex_lock(&drawing->mutex);
    GBytes *kept = drawing->kept[drawing->frame[frame].origin];
    GBytes *found = kept ? g_bytes_ref(kept) : NULL;
    g_mutex_unlock(&drawing->mutex);
    return found;
}

static FlDrawList *unpack(const FlDrawing *drawing, int frame, const void *data, size_t bytes,
                          GError **error)
{
    const FlDrawBounds bounds = {drawing->width, drawing->height, (int)drawing->regions->len,
                                 drawing->frame[frame].n};
    g_autoptr(GError) problem = NULL;
    FlDrawList *draws = fl_draws_unpack(data, bytes, &bounds, &problem);
    if (g_error_matches(problem, FL_ERROR, FL_ERROR_INPUT))
        fl_answer_set_damaged(drawing->sequence->frame[frame].file, error);
    else if (problem)
        g_propagate_error(error, g_steal_pointer(&problem));
    return draws;
}

/** The keys of the regions' hands: a name is the same in every render. */
static uint64_t *keys_of(const FlDrawing *drawing, uint64_t seed)
{
    const int n = (int)drawing->regions->len;
    uint64_t *key = g_new(uint64_t, n + 1);
    for (int r = 0; r < n; r++)
        key[r] = fl_key(seed, g_str_hash(fl_drawing_region(drawing, r)->name));
    return key;
}

FlDrawList *fl_drawing_draw_by_hand(const FlDrawing *drawing, int frame, const FlHand *hand,
                                    GError **error)
{
    g_assert(frame >= 0 && frame < drawing->sequence->n);
    const FlDrawingFrame *f = &drawing->frame[frame];
    const bool by_hand = hand && fl_steps_need_hand(f->step, f->n, hand);
    g_autoptr(GBytes) kept = by_hand ? NULL : find_kept((FlDrawing *)drawing, frame);
    if (kept)
        return unpack(drawing, frame, g_bytes_get_data(kept, NULL), g_bytes_get_size(kept), error);
    g_autofree uint64_t *key = by_hand ? keys_of(drawing, hand->seed) : NULL;
    FlRequest request = fl_drawing_request(drawing, frame, FL_VERB_DRAW);
    request.step = f->step, request.n_steps = f->n;
    request.hand = by_hand ? hand : NULL, request.key = key;
    g_auto(FlAnswer) answer = {0};
    if (!fl_workers_ask(drawing->workers, &request, NULL, &answer, error))
        return NULL;
    FlDrawList *draws = unpack(drawing, frame, answer.reader.at, answer.reader.left, error);
    if (draws && !by_hand)
        keep((FlDrawing *)drawing, frame, &answer.reader);
    return draws;
}

FlDrawList *fl_drawing_draw_list(const FlDrawing *drawing, int frame, GError **error)
{
    return fl_drawing_draw_by_hand(drawing, frame, NULL, error);
}

/* ---- regions on twos ------------------------------------------------------------------------- */

static void insert(GArray *draws, int at, FlDraw *draw)
{
    g_array_insert_val(draws, (guint)at, *draw);
    *draw = (FlDraw){.region = draw->region}; // its pictures were moved
}

/** Index of the last draw of a region; -1 if the region has no draw. */
static int last_of(const GArray *draws, int region)
{
    for (int r = (int)draws->len - 1; r >= 0; r--)
        if (g_array_index(draws, FlDraw, r).region == region)
            return r;
    return -1;
}

/** The place for draw k of an earlier frame that has no counterpart. */
static int place_of(const GArray *draws, const FlDrawList *earlier, int k)
{
    for (int below = k; below >= 0; below--) {
        const int last = last_of(draws, earlier->draw[below].region);
        if (last >= 0)
            return last + 1;
    }
    return 0;
}

/** The lowest draw of a region that has not been moved yet. */
static FlDraw *first_left(const FlDrawList *draws, int region)
{
    for (int r = 0; r < draws->n; r++)
        if (draws->draw[r].region == region && draws->draw[r].coverage)
            return &draws->draw[r];
    return NULL;
}

/** True if a region's draws come from frame `from` when frame `now` is shown. */
static bool is_from(const int *hold_of, int region, int frame, int from, int now)
{
    const int shown = frame - frame % hold_of[region];
    return shown == from && shown != now;
}

/** Replaces the draws of the regions that show `from` by those of that frame. */
static bool replace(const FlDrawing *drawing, const FlHand *hand, const int *hold_of, GArray *draws,
                    int frame, int from, int now, GError **error)
{
    g_autoptr(FlDrawList) earlier = fl_drawing_draw_by_hand(drawing, from, hand, error);
    if (!earlier)
        return false;
    for (int r = 0; r < (int)draws->len; r++) {
        FlDraw *draw = &g_array_index(draws, FlDraw, r);
        if (!is_from(hold_of, draw->region, frame, from, now))
            continue;
        FlDraw *then = first_left(earlier, draw->region);
        fl_draw_clear(draw);
        if (then)
            *draw = *then, *then = (FlDraw){.region = draw->region};
        else
            g_array_remove_index(draws, (guint)r--);
    }
    for (int k = 0; k < earlier->n; k++)
        if (earlier->draw[k].coverage &&
            is_from(hold_of, earlier->draw[k].region, frame, from, now))
            insert(draws, place_of(draws, earlier, k), &earlier->draw[k]);
    return true;
}

FlDrawList *fl_hold_draw_list(const FlDrawing *drawing, const FlHand *hand, int hold,
                              const int *hold_of, int frame, GError **error)
{
    const int now = frame - frame % hold;
    g_autoptr(FlDrawList) shown = fl_drawing_draw_by_hand(drawing, now, hand, error);
    if (!shown)
        return NULL;
    g_autoptr(GHashTable) done = g_hash_table_new(NULL, NULL);
    GArray *draws = g_array_new(FALSE, FALSE, sizeof(FlDraw));
    g_array_append_vals(draws, shown->draw, (guint)shown->n);
    bool good = true;
    for (int r = 0; r < fl_drawing_regions(drawing) && good; r++) {
        const int from = frame - frame % hold_of[r];
        if (from != now && g_hash_table_add(done, GINT_TO_POINTER(from)))
            good = replace(drawing, hand, hold_of, draws, frame, from, now, error);
    }
    g_free(shown->draw);
    shown->n = (int)draws->len;
    shown->draw = (FlDraw *)g_array_free(draws, FALSE);
    return good ? g_steal_pointer(&shown) : NULL;
}
