#include "drawing/hold.h"

#include <string.h>

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
