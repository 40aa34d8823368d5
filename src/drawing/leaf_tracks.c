#include "drawing/region_identity.h"

#include "base/colour_difference.h"
#include "base/each.h"
#include <string.h>

/*
 * Leaves of two frames are paired greedily, the most alike first. Only leaves of the same label and
 * kind are compared, by paint, overlap, place in the document, id and class together. The more of
 * these agree, the further the paint may have changed. Exporters that keep the tree (lottie-web,
 * SMIL) and those that sort by depth (Zdog) both work: the former keep the place while the paint
 * may change, the latter keep the paint while the place changes.
 */
#define GRADUAL 30.0f // CIE76 between frames, for a leaf at the same place in document and picture
#define SUBTLE 12.0f  // for one of the same class, or at the same place in the picture alone
#define SLIGHT 4.0f   // for a flat one with none of these: its colour jitters
#define OVERLAP 0.6f  // of boxes at the same place in the picture, intersection over union
#define STAYS 0.9f    // of boxes of a leaf that need not be compared with others
#define TOO_MANY 4000 // unpaired leaves on a side; beyond that only exact matches are followed

typedef struct Pair {
    float score;
    int track, part;
} Pair;

static float overlap(const float a[4], const float b[4])
{
    const float w = MIN(a[2], b[2]) - MAX(a[0], b[0]), h = MIN(a[3], b[3]) - MAX(a[1], b[1]);
    if (w <= 0 || h <= 0)
        return 0;
    const float both = w * h;
    return both / ((a[2] - a[0]) * (a[3] - a[1]) + (b[2] - b[0]) * (b[3] - b[1]) - both);
}

/** Likeness of two leaves, 0 … 10; -1 if they cannot be the same. */
static float likeness(const FlSurveyPart *a, const FlSurveyPart *b)
{
    const bool same_paint = a->paint == b->paint, same_tree = a->tree == b->tree;
    const bool same_name = a->name == b->name && a->name > 0;
    const bool same_class = a->classes == b->classes && a->classes > 0;
    const bool flat = a->kind == FL_PAINT_FLAT && b->kind == FL_PAINT_FLAT;
    const float difference = same_paint ? 0 : fl_colour_difference(a->rgb, b->rgb);
    const float shared = overlap(a->box, b->box);
    const float most = same_tree && (shared >= 0.2f || same_name)  ? GRADUAL
                       : shared >= OVERLAP || (flat && same_class) ? SUBTLE
                       : flat                                      ? SLIGHT
                                                                   : 0;
    if (!same_paint && (difference > most || most <= 0))
        return -1;
    const bool same_nodes = a->pose.n == b->pose.n;
    return (float)(2 * (same_paint + same_name) + same_tree + same_class + same_nodes) +
           2 * shared + (1 - MIN(difference, GRADUAL) / GRADUAL);
}

static int compare_pairs(const void *x, const void *y)
{
    const Pair *a = x, *b = y;
    if (a->score != b->score)
        return a->score > b->score ? -1 : 1;
    return a->track != b->track ? a->track - b->track : a->part - b->part;
}

typedef struct Follow {
    const FlSurvey *survey;
    const int *label_of;
    GArray *tracks;
} Follow;

static void follow_on(Follow *f, int t, FlSurveyPart *part, int track)
{
    FlTrack *tr = &g_array_index(f->tracks, FlTrack, track);
    const int change[2] = {t, part->paint};
    if (tr->paints->len == 0)
        memcpy(tr->rgb, part->rgb, sizeof tr->rgb);
    if (tr->paints->len > 0 && tr->last.paint != part->paint) {
        tr->varies = true;
        tr->drift = MAX(tr->drift, fl_colour_difference(tr->rgb, part->rgb));
    }
    g_array_append_vals(tr->paints, change, 2);
    part->nth = track;
    tr->last = *part;
    tr->last_frame = t;
}

static void new_track(Follow *f, int t, FlSurveyPart *part)
{
    const FlTrack track = {.paints = g_array_new(FALSE, FALSE, sizeof(int)),
                           .last_frame = -1,
                           .rule = -1,
                           .is_hair = true};
    g_array_append_val(f->tracks, track);
    follow_on(f, t, part, (int)f->tracks->len - 1);
}

static bool comparable(const Follow *f, const FlSurveyPart *a, const FlSurveyPart *b)
{
    return a->stroke == b->stroke && f->label_of[a->labels] == f->label_of[b->labels] &&
           (a->leaf < 0) == (b->leaf < 0);
}

static guint exact_hash(gconstpointer p)
{
    const FlSurveyPart *s = p;
    return (guint)(s->paint * 31 + s->tree * 7919 + s->stroke);
}

static gboolean exact_equal(gconstpointer p, gconstpointer q)
{
    const FlSurveyPart *a = p, *b = q;
    return a->paint == b->paint && a->tree == b->tree && a->stroke == b->stroke &&
           a->labels == b->labels && a->part == b->part;
}

/** Continues tracks by leaves that kept paint and place in the document, and hardly moved. */
static void pair_exactly(Follow *f, int t)
{
    g_autoptr(GHashTable) known = g_hash_table_new(exact_hash, exact_equal);
    for (guint k = 0; k < f->tracks->len; k++)
        g_hash_table_insert(known, &g_array_index(f->tracks, FlTrack, k).last,
                            GINT_TO_POINTER(k + 1));
    GArray *parts = f->survey->frame[t].parts;
    g_autofree int *found = g_new0(int, parts->len + 1);
    for (guint i = 0; i < parts->len; i++)
        found[i] =
            GPOINTER_TO_INT(g_hash_table_lookup(known, &g_array_index(parts, FlSurveyPart, i)));
    for (guint i = 0; i < parts->len; i++) {
        const FlTrack *track = found[i] ? &g_array_index(f->tracks, FlTrack, found[i] - 1) : NULL;
        FlSurveyPart *s = &g_array_index(parts, FlSurveyPart, i);
        if (track && track->last_frame < t && overlap(track->last.box, s->box) >= STAYS)
            follow_on(f, t, s, found[i] - 1);
    }
}

static int count_unpaired(const GArray *parts)
{
    int left = 0;
    for (guint i = 0; i < parts->len; i++)
        left += g_array_index(parts, FlSurveyPart, i).nth < 0;
    return left;
}

/** Pairs those of the remaining leaves that are as alike as `least` or more, the most alike first.
 */
static void pair_alike(Follow *f, int t, float least)
{
    GArray *parts = f->survey->frame[t].parts;
    g_autoptr(GArray) pairs = g_array_new(FALSE, FALSE, sizeof(Pair));
    for (guint k = 0; k < f->tracks->len; k++) {
        const FlTrack *track = &g_array_index(f->tracks, FlTrack, k);
        for (guint i = 0; i < parts->len && track->last_frame < t; i++) {
            const FlSurveyPart *s = &g_array_index(parts, FlSurveyPart, i);
            if (s->nth >= 0 || !comparable(f, &track->last, s))
                continue;
            const float like = likeness(&track->last, s);
            const Pair pair = {like - (track->last_frame < t - 1 ? 0.5f : 0), (int)k, (int)i};
            if (like >= 0 && pair.score >= least)
                g_array_append_val(pairs, pair);
        }
    }
    g_array_sort(pairs, compare_pairs);
    FL_EACH (const Pair, pair, pairs) {
        FlSurveyPart *s = &g_array_index(parts, FlSurveyPart, pair->part);
        if (s->nth < 0 && g_array_index(f->tracks, FlTrack, pair->track).last_frame < t)
            follow_on(f, t, s, pair->track);
    }
}

static void track_clear(void *data)
{
    g_array_unref(((FlTrack *)data)->paints);
}

GArray *fl_leaf_tracks_find(const FlSurvey *survey, const int *label_of)
{
    // Once leaves of the same paint at the same place in the document are paired, few are left.
    static const float alike[] = {7, 6, -1};
    Follow f = {survey, label_of, fl_array_of(FlTrack, track_clear)};
    for (int t = 0; t < survey->n_frames; t++) {
        GArray *parts = survey->frame[t].parts;
        FL_EACH (FlSurveyPart, s, parts)
            s->nth = -1;
        pair_exactly(&f, t);
        for (int k = 0; k < (int)G_N_ELEMENTS(alike); k++) {
            const int left = count_unpaired(parts);
            if (left > 0 && left < TOO_MANY)
                pair_alike(&f, t, alike[k]);
        }
        FL_EACH (FlSurveyPart, s, parts)
            if (s->nth < 0)
                new_track(&f, t, s);
    }
    return f.tracks;
}
