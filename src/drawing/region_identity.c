#include "drawing/region_identity.h"

#include <stdlib.h>
#include <string.h>

#define SHADE_ALPHA 192  // a fill this opaque or more is no overlay
#define SHADE_COVERS 0.8 // share of an overlay that lies over other fills
#define HAIRLINE 0.002   // width of a stroke, share of the page's longer side, that no paint fills
#define LINE_ART 0.5     // share of the ink from which on strokes are the drawing
#define JITTER 10.0f     // CIE76 by which a colour that is exported anew in every frame varies
#define ROUNDING 2       // levels of a channel by which exporters miss a colour from frame to frame

/** Sums over a region, which decide what it is. */
typedef struct Sum {
    double area, covered, alpha;
    bool plain;  // not all of it blends with the leaves below
    double best; // area of the paint of the group so far
} Sum;

typedef struct Work {
    FlSurvey *survey;
    const FlDrawingOptions *options;
    bool paint_strokes;
    int *label_of;
    GArray *tracks;
} Work;

static FlTrack *track_at(const Work *w, int track)
{
    return &g_array_index(w->tracks, FlTrack, track);
}

static bool is_near(const uint8_t a[3], const uint8_t b[3])
{
    return abs(a[0] - b[0]) <= ROUNDING && abs(a[1] - b[1]) <= ROUNDING &&
           abs(a[2] - b[2]) <= ROUNDING;
}

/** The first paint that looks the same; without one, the paint is added to firsts. */
static int first_like(GArray *firsts, const FlSurveyPart *s)
{
    for (guint k = 0; k < firsts->len; k++)
        if (is_near(g_array_index(firsts, FlSurveyPart, k).rgb, s->rgb))
            return g_array_index(firsts, FlSurveyPart, k).paint;
    g_array_append_val(firsts, *s);
    return s->paint;
}

/** Maps flat paints that differ by rounding only to the first like them. To be unref'd. */
static GHashTable *find_near_paints(const FlSurvey *survey)
{
    g_autoptr(GArray) firsts = g_array_new(FALSE, FALSE, sizeof(FlSurveyPart));
    GHashTable *joined = g_hash_table_new(NULL, NULL);
    FL_EACH_PART (survey, t, s) {
        gpointer key = GINT_TO_POINTER(s->paint);
        if (s->kind == FL_PAINT_FLAT && !g_hash_table_contains(joined, key))
            g_hash_table_insert(joined, key, GINT_TO_POINTER(first_like(firsts, s)));
    }
    return joined;
}

static void join_paint(GHashTable *joined, int *paint)
{
    gpointer first = NULL;
    if (g_hash_table_lookup_extended(joined, GINT_TO_POINTER(*paint), NULL, &first))
        *paint = GPOINTER_TO_INT(first);
}

/** Gives paints that look the same one number. Tracks use the exact paints. */
static void join_near_paints(Work *w)
{
    g_autoptr(GHashTable) joined = find_near_paints(w->survey);
    FL_EACH_PART (w->survey, t, s)
        join_paint(joined, &s->paint);
    FL_EACH (FlTrack, track, w->tracks) {
        track->varies = false;
        for (guint i = 1; i < track->paints->len; i += 2) {
            int *paint = &g_array_index(track->paints, int, i);
            join_paint(joined, paint);
            track->varies |= i > 1 && paint[-2] != *paint;
        }
    }
}

/** True if the drawing consists of strokes: zdog figures, line drawings. */
static bool is_line_art(const FlSurvey *survey)
{
    double strokes = 0, fills = 0;
    const double page = (double)survey->width * survey->height;
    FL_EACH_PART (survey, t, s)
        if (s->area_px < 0.95 * page)
            *(s->stroke ? &strokes : &fills) += s->area_px;
    return strokes > LINE_ART * (strokes + fills);
}

static const char *paint_word(const FlSurvey *survey, const FlSurveyPart *s)
{
    switch (s->kind) {
    case FL_PAINT_FLAT:
        return fl_strings_get(&survey->strings, s->paint);
    case FL_PAINT_GRADIENT:
        return "gradient";
    case FL_PAINT_IMAGE:
        return "image";
    default:
        return "mixed";
    }
}

/** The first rule that a track matches in any frame. */
static void match_rules(Work *w)
{
    const FlStrings *strings = &w->survey->strings;
    for (int t = 0; t < w->survey->n_frames && w->options->n_rules > 0; t++)
        FL_EACH (const FlSurveyPart, s, w->survey->frame[t].parts) {
            const FlRuleSubject subject = {
                .ids = fl_strings_get(strings, s->ids),
                .classes = fl_strings_get(strings, s->classes),
                .labels = fl_strings_get(strings, s->labels),
                .layers = fl_strings_get(strings, s->layers),
                .stroke = s->stroke,
                .has_fill = s->has_fill,
                .has_stroke = s->has_stroke,
                .paint = paint_word(w->survey, s),
                .rgb = s->rgb,
            };
            const int rule = fl_rules_match(w->options->rules, w->options->n_rules, &subject);
            int *known = &track_at(w, s->nth)->rule;
            if (rule >= 0 && (*known < 0 || rule < *known))
                *known = rule;
        }
}

/** A stroke that swells or shrinks is a line or a limb through all of the film. */
static void find_hairs_and_limbs(Work *w)
{
    const FlSurvey *survey = w->survey;
    const double hair = HAIRLINE * MAX(survey->page.width, survey->page.height);
    FL_EACH_PART (survey, t, s) {
        FlTrack *track = track_at(w, s->nth);
        track->is_hair &= s->width > 0 && (double)s->width < hair;
        track->is_limb |= s->thick;
    }
}

/**
 * Returns: true if a part is a line that is drawn over the paint. Thick strokes are limbs, and
 * painted; hairlines never, as no pixel is theirs for paint to be in.
 */
static bool is_apart(const Work *w, const FlSurveyPart *s)
{
    const FlTrack *track = track_at(w, s->nth);
    const bool thick = track->is_limb && w->options->strokes != FL_STROKES_KEEP;
    return s->stroke && ((!w->paint_strokes && !thick) || track->is_hair);
}

/** In how many frames both tracks are; -1: in one of them their paints differ. */
static int common_frames(const FlTrack *a, const FlTrack *b)
{
    int common = 0;
    for (guint i = 0, j = 0; i < a->paints->len && j < b->paints->len;) {
        const int *x = &g_array_index(a->paints, int, i), *y = &g_array_index(b->paints, int, j);
        if (x[0] == y[0] && x[1] != y[1])
            return -1;
        common += x[0] == y[0];
        i += x[0] <= y[0] ? 2 : 0;
        j += y[0] <= x[0] ? 2 : 0;
    }
    return common;
}

/**
 * Returns: true if a track belongs to another one, whose paint varies: theirs change together; or
 * its own does not change, as it is short, and the other's jitters.
 */
static bool is_twin(const Work *w, const FlTrack *other, const FlTrack *track)
{
    if (is_apart(w, &other->last) != is_apart(w, &track->last) ||
        w->label_of[other->last.labels] != w->label_of[track->last.labels])
        return false;
    const int common = common_frames(other, track);
    return track->varies ? common > 0
                         : other->drift <= JITTER && 2 * common == (int)track->paints->len;
}

static void find_twins(Work *w)
{
    const int n = (int)w->tracks->len;
    g_autofree int *varying = g_new(int, n + 1);
    int n_varying = 0;
    for (int k = 0; k < n; k++)
        if (track_at(w, k)->varies)
            varying[n_varying++] = k;
    for (int k = 0; k < n; k++) {
        FlTrack *track = track_at(w, k);
        track->twin = k;
        for (int v = 0; v < n_varying && track->twin == k; v++) {
            const int j = varying[v];
            const FlTrack *other = track_at(w, j);
            if ((!track->varies || (j < k && other->twin == j)) && is_twin(w, other, track))
                track->twin = j;
        }
    }
    for (int k = 0; k < n; k++) // a twin of one that comes later, which has its own
        track_at(w, k)->twin = track_at(w, track_at(w, k)->twin)->twin;
}

/** The key of a part's region; parts of equal keys are one region. */
static char *key_of(const Work *w, const FlSurveyPart *s)
{
    const FlTrack *track = track_at(w, s->nth);
    const int label = w->label_of[s->labels];
    const char *apart = is_apart(w, s) ? "s" : s->blend_mode != FL_BLEND_MODE_OVER ? "m" : "";
    if (track->rule >= 0) // a rule's name makes the region; other rules of that name join
        return g_strdup_printf("rule %s", w->options->rules[track->rule].name);
    switch (w->options->key) {
    case FL_KEY_FILL:
        return g_strdup_printf("fill %s%d", apart, s->paint);
    case FL_KEY_ID:
        return g_strdup_printf("id %s%d", apart, w->label_of[s->name]);
    case FL_KEY_CLASS:
        return g_strdup_printf("class %s%d", apart, s->classes);
    case FL_KEY_LABEL:
        return g_strdup_printf("label %s%d", apart, label);
    case FL_KEY_TREE:
        return g_strdup_printf("tree %s%d", apart, s->tree);
    default:
        break;
    }
    if (track->varies || track->twin != s->nth)
        return g_strdup_printf("track %d", track->twin);
    const int place = s->kind == FL_PAINT_MIXED || s->kind == FL_PAINT_IMAGE ? s->tree : 0;
    return g_strdup_printf("%s%d/%d/%d/%d", apart, label, s->paint, place, track->depth);
}

/** Adds a part to its group. */
static void add_up(const Work *w, const FlSurveyPart *s, FlRegionIdentity *group, Sum *sum,
                   GHashTable *areas)
{
    const int64_t key = (int64_t)s->region << 32 | s->paint;
    double *area = g_hash_table_lookup(areas, &key);
    if (!area) {
        int64_t *copy = g_new(int64_t, 1);
        *copy = key;
        area = g_new0(double, 1);
        g_hash_table_insert(areas, copy, area);
    }
    *area += s->area_px;
    if (*area > sum->best) {
        sum->best = *area;
        group->kind = s->kind, group->paint = s->paint;
        group->label = w->label_of[s->labels];
        memcpy(group->rgb, s->rgb, 3);
    }
    sum->area += s->area_px;
    sum->covered += s->covers * s->area_px;
    sum->alpha = MAX(sum->alpha, s->alpha);
    sum->plain |= s->blend_mode == FL_BLEND_MODE_OVER;
    group->stroke = group->stroke && is_apart(w, s);
}

/** Numbers the tracks of each region in the order in which they appear. */
static void number_tracks(const Work *w, guint n_regions)
{
    g_autofree int *count = g_new0(int, n_regions + 1);
    g_autofree int *nth = g_new(int, w->tracks->len + 1);
    memset(nth, -1, w->tracks->len * sizeof *nth);
    FL_EACH_PART (w->survey, t, s) {
        int *number = &nth[s->nth];
        if (s->region < 0)
            continue;
        if (*number < 0)
            *number = count[s->region]++;
        s->nth = *number;
    }
}

static GArray *gather(Work *w)
{
    GArray *groups = g_array_new(FALSE, FALSE, sizeof(FlRegionIdentity));
    g_autoptr(GArray) sums = g_array_new(FALSE, FALSE, sizeof(Sum));
    g_autoptr(GHashTable) numbers = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    g_autoptr(GHashTable) areas =
        g_hash_table_new_full(g_int64_hash, g_int64_equal, g_free, g_free);
    FL_EACH_PART (w->survey, t, s) {
        const int rule = track_at(w, s->nth)->rule;
        if (s->stroke && w->options->strokes == FL_STROKES_DROP && rule < 0)
            continue;
        g_autofree char *key = key_of(w, s);
        gpointer number = NULL;
        if (!g_hash_table_lookup_extended(numbers, key, NULL, &number)) {
            const FlRegionIdentity group = {.rule = rule, .stroke = true};
            const Sum sum = {0};
            number = GINT_TO_POINTER(groups->len);
            g_hash_table_insert(numbers, g_steal_pointer(&key), number);
            g_array_append_val(groups, group);
            g_array_append_val(sums, sum);
        }
        s->region = GPOINTER_TO_INT(number);
        add_up(w, s, &g_array_index(groups, FlRegionIdentity, s->region),
               &g_array_index(sums, Sum, s->region), areas);
    }
    for (guint r = 0; r < groups->len; r++) {
        const Sum *sum = &g_array_index(sums, Sum, r);
        g_array_index(groups, FlRegionIdentity, r).shade =
            (sum->alpha < SHADE_ALPHA || !sum->plain) && sum->covered >= SHADE_COVERS * sum->area;
    }
    return groups;
}

GArray *fl_region_identities_find(FlSurvey *survey, const FlDrawingOptions *options)
{
    Work w = {.survey = survey, .options = options};
    fl_survey_choose_units(survey);
    w.paint_strokes = options->strokes == FL_STROKES_PAINT ||
                      (options->strokes <= FL_STROKES_AUTO && is_line_art(survey));
    w.label_of = fl_clean_labels(survey);
    w.tracks = fl_leaf_tracks_find(survey, w.label_of);
    join_near_paints(&w);
    fl_find_nesting(survey, w.label_of, w.tracks);
    find_hairs_and_limbs(&w);
    match_rules(&w);
    find_twins(&w);
    GArray *groups = gather(&w);
    number_tracks(&w, groups->len);
    g_array_unref(w.tracks);
    g_free(w.label_of);
    return groups;
}
