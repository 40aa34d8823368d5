#include "base/error.h"
#include "base/file.h"
#include "base/rect.h"
#include "drawing/drawing_data.h"
#include "drawing/region_identity.h"
#include "drawing/survey.h"
#include <math.h>
#include <string.h>

#define MOST_ROUNDS 8 // in which frames are left out

int fl_drawing_frames(const FlDrawing *drawing)
{
    return drawing->sequence->n;
}

int fl_drawing_width(const FlDrawing *drawing)
{
    return drawing->width;
}

int fl_drawing_height(const FlDrawing *drawing)
{
    return drawing->height;
}

/* The files are drawn to the page's size, and steps within their boxes. */
static void halve_anchor(FlAnchor *anchor)
{
    anchor->x /= 2, anchor->y /= 2, anchor->side /= 2;
    anchor->rest_x /= 2, anchor->rest_y /= 2;
    anchor->grows_x /= 2, anchor->grows_y /= 2;
}

void fl_drawing_halve(FlDrawing *drawing)
{
    fl_drawing_forget(drawing);
    drawing->width = fl_half_side(drawing->width), drawing->height = fl_half_side(drawing->height);
    for (int f = 0; f < drawing->sequence->n; f++) {
        FlDrawingFrame *frame = &drawing->frame[f];
        frame->page.width /= 2, frame->page.height /= 2;
        for (int i = 0; i < frame->n; i++) {
            frame->step[i].width /= 2;
            for (int side = 0; side < 4; side++)
                frame->step[i].box[side] /= 2;
        }
        for (guint r = 0; r < drawing->regions->len; r++)
            halve_anchor(&frame->anchor[r]);
        for (guint k = 0; k < frame->limbs->len; k++) {
            FlLimb *limb = &g_array_index(frame->limbs, FlRegionLimb, k).limb;
            halve_anchor(&limb->anchor);
            limb->x /= 2, limb->y /= 2;
            for (int i = 0; i < 3; i++)
                limb->spread[i] /= 4;
        }
    }
}

int fl_drawing_regions(const FlDrawing *drawing)
{
    return (int)drawing->regions->len;
}

const FlRegion *fl_drawing_region(const FlDrawing *drawing, int region)
{
    return &g_array_index(drawing->regions, FlRegion, region);
}

FlAnchor fl_drawing_anchor(const FlDrawing *drawing, int region, int frame)
{
    return drawing->frame[frame].anchor[region];
}

#define DRIFT_FRAMES 14

static bool has_begun(const FlAnchor *anchor)
{
    return anchor->cosine != 0 || anchor->sine != 0;
}

/* The way of a region's anchor from a frame to another; 0 without it. */
static FlPoint way_between(const FlDrawing *drawing, int region, int from, int to)
{
    if (region < 0)
        return (FlPoint){0, 0};
    const FlAnchor *was = &drawing->frame[from].anchor[region];
    const FlAnchor *is = &drawing->frame[to].anchor[region];
    return has_begun(was) && has_begun(is) ? (FlPoint){is->x - was->x, is->y - was->y}
                                           : (FlPoint){0, 0};
}

FlDrift fl_drawing_drift(const FlDrawing *drawing, int region, int ground, int frame, bool loop)
{
    const int n = fl_drawing_frames(drawing);
    const int first = MIN(fl_drawing_region(drawing, region)->first_frame, MAX(n - 2, 0));
    const float all = DRIFT_FRAMES * (DRIFT_FRAMES + 1) / 2.f;
    FlDrift drift = {0};
    for (int k = 0; k < DRIFT_FRAMES; k++) {
        const int before = frame - k - 1;
        const int from = loop ? (before % n + n) % n : CLAMP(before, first, MAX(n - 2, first));
        const float share = (float)(DRIFT_FRAMES - k) / all;
        const FlPoint way = way_between(drawing, region, from, (from + 1) % n);
        const FlPoint paper = way_between(drawing, ground, from, (from + 1) % n);
        const FlAnchor *grown = &drawing->frame[(from + 1) % n].anchor[region];
        const float x = (float)(way.x - paper.x) + grown->grows_x;
        const float y = (float)(way.y - paper.y) + grown->grows_y;
        drift.x += share * x, drift.y += share * y, drift.pace += share * hypotf(x, y);
    }
    return drift;
}

int fl_drawing_limbs(const FlDrawing *drawing, int region, int frame, FlLimb *limbs)
{
    const GArray *all = drawing->frame[frame].limbs;
    int n = 0;
    for (guint k = 0; k < all->len && n < FL_LIMBS; k++)
        if (g_array_index(all, FlRegionLimb, k).region == region)
            limbs[n++] = g_array_index(all, FlRegionLimb, k).limb;
    return n;
}

const char **fl_drawing_linked_files(const FlDrawing *drawing)
{
    guint n;
    const char **paths = (const char **)g_hash_table_get_keys_as_array(drawing->files, &n);
    qsort(paths, n, sizeof *paths, fl_by_name);
    return paths;
}

char *fl_drawing_left_out(const FlDrawing *drawing, FlMissing missing)
{
    const int n = drawing->sequence->n_left_out;
    if (n == 0)
        return NULL;
    return g_strdup_printf("%d frame%s could not be read or drawn and %s %s", n, n == 1 ? "" : "s",
                           n == 1 ? "was" : "were",
                           missing == FL_MISSING_HOLD ? "replaced by the one before" : "skipped");
}

const char *fl_drawing_name(const FlDrawing *drawing)
{
    return drawing->sequence->name;
}

const char *fl_drawing_file(const FlDrawing *drawing, int frame)
{
    return drawing->sequence->frame[frame].file;
}

int fl_drawing_number(const FlDrawing *drawing, int frame)
{
    return drawing->sequence->frame[frame].number;
}

const char *const *fl_drawing_found_files(const FlDrawing *drawing)
{
    return (const char *const *)drawing->sequence->found;
}

int fl_drawing_earlier(const FlDrawing *drawing)
{
    return drawing->sequence->n_earlier;
}

/* Missing frames at the start of the film show the first frame that exists, so that all of these
 * are the same. */
int fl_drawing_shown(const FlDrawing *drawing, int frame)
{
    const FlSequence *s = drawing->sequence;
    while (frame > 0 && (s->frame[frame].stand_in || s->frame[frame - 1].stand_in) &&
           fl_sequence_same(s, frame, frame - 1))
        frame--;
    return frame;
}

static void region_clear(void *data)
{
    FlRegion *region = data;
    g_free(region->name);
    g_free(region->label);
    g_free(region->paint);
    g_free(region->class_word);
}

/** "leg_FB/Group" of "leg_FB\nGroup". */
static char *label_path(const char *labels)
{
    return g_strdelimit(g_strdup(labels), "\n", '/');
}

static char *paint_text(const FlRegionIdentity *group)
{
    const uint8_t *rgb = group->rgb;
    switch (group->kind) {
    case FL_PAINT_FLAT:
        return g_strdup_printf("#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
    case FL_PAINT_GRADIENT:
        return g_strdup("gradient");
    default:
        return g_strdup("image");
    }
}

static bool is_paintable(const FlRegionIdentity *group, const FlRule *rules)
{
    const FlPassthrough override =
        group->rule >= 0 ? rules[group->rule].passthrough : FL_PASSTHROUGH_AUTO;
    if (override != FL_PASSTHROUGH_AUTO)
        return override == FL_PASSTHROUGH_NO;
    return !group->stroke && !group->shade;
}

static void describe(FlDrawing *drawing, const FlSurvey *survey, const GArray *groups,
                     const FlRule *rules)
{
    g_auto(GStrv) names = fl_name_groups(survey, groups, rules);
    for (guint r = 0; r < groups->len; r++) {
        const FlRegionIdentity *group = &g_array_index(groups, FlRegionIdentity, r);
        const FlRegion region = {
            .name = g_strdup(names[r]),
            .label = label_path(fl_strings_get(&survey->strings, group->label)),
            .paint = paint_text(group),
            .rgb = {group->rgb[0], group->rgb[1], group->rgb[2]},
            .paintable = is_paintable(group, rules),
            .rule = group->rule,
        };
        g_array_append_val(drawing->regions, region);
    }
}

#define SEVERAL (-2) // regions have a class word

/** The region that alone has a class word, and how many parts of it have that. */
typedef struct Wearer {
    int region, n;
} Wearer;

static void note_classes(const FlSurveyPart *part, const char *classes, GHashTable *wearers)
{
    g_auto(GStrv) words = g_strsplit(classes, "\n", -1);
    for (int i = 0; words[i]; i++) {
        Wearer *wearer = g_hash_table_lookup(wearers, words[i]);
        if (!wearer) {
            wearer = g_new(Wearer, 1);
            *wearer = (Wearer){part->region, 0};
            g_hash_table_insert(wearers, g_strdup(words[i]), wearer);
        }
        wearer->region = wearer->region == part->region ? part->region : SEVERAL;
        wearer->n++;
    }
}

/** Finds for each region the class word, if there is one, that all of its parts have and no others.
 */
static void find_class_words(FlDrawing *drawing, const FlSurvey *survey)
{
    g_autofree int *n_parts = g_new0(int, drawing->regions->len + 1);
    g_autoptr(GHashTable) wearers = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
    FL_EACH_PART (survey, t, s) {
        if (s->region >= 0)
            n_parts[s->region]++;
        if (s->classes)
            note_classes(s, fl_strings_get(&survey->strings, s->classes), wearers);
    }
    GHashTableIter at;
    gpointer word, found;
    g_hash_table_iter_init(&at, wearers);
    while (g_hash_table_iter_next(&at, &word, &found)) {
        const Wearer *wearer = found;
        if (wearer->region < 0 || wearer->n < n_parts[wearer->region])
            continue;
        char **known = &g_array_index(drawing->regions, FlRegion, wearer->region).class_word;
        if (*known && strcmp(*known, word) < 0)
            continue;
        g_free(*known);
        *known = g_strdup(word);
    }
}

#define HELD_PX 0.2f // of the sides and the middle of a shape that stays as it is

/** The place of a region's leaves in a frame: all boxes, the sum of their sides and middles. */
typedef struct Place {
    float box[4], sides[4], middle[2], area_px;
} Place;

static void add_part(Place *place, const FlSurveyPart *part)
{
    for (int k = 0; k < 4; k++) {
        const bool out = k < 2 ? part->box[k] < place->box[k] : part->box[k] > place->box[k];
        place->box[k] = out || place->area_px <= 0 ? part->box[k] : place->box[k];
        place->sides[k] += part->box[k];
    }
    place->middle[0] += part->pose.middle_x, place->middle[1] += part->pose.middle_y;
    place->area_px += part->area_px;
}

/** How a region lies in the film. */
typedef struct Course {
    Place first, all; // in the first frame that has it; over all frames
    bool spans;       // in every frame from its first on, from side to side of the page
    bool wide;        // so from left to right
    bool rests;       // where it was, as large as it was
} Course;

static bool is_wide(const float box[4], const FlPageSize *page)
{
    return box[0] < 1 && box[2] > (float)page->width - 1;
}

static bool spans(const float box[4], const FlPageSize *page)
{
    return is_wide(box, page) || (box[1] < 1 && box[3] > (float)page->height - 1);
}

static bool is_held(const Place *first, const Place *now)
{
    bool held = fabsf(now->area_px - first->area_px) < 1e-3f * first->area_px;
    for (int k = 0; k < 4; k++)
        held = held && fabsf(now->sides[k] - first->sides[k]) < HELD_PX;
    for (int k = 0; k < 2; k++)
        held = held && fabsf(now->middle[k] - first->middle[k]) < HELD_PX;
    return held;
}

static void follow(Course *course, const Place *now, const FlPageSize *page, bool first)
{
    if (first)
        *course = (Course){*now, *now, true, true, true};
    course->spans = course->spans && spans(now->box, page);
    course->wide = course->wide && is_wide(now->box, page);
    course->rests = course->rests && is_held(&course->first, now);
    for (int k = 0; k < 2 && now->area_px > 0; k++) {
        course->all.box[k] = MIN(course->all.box[k], now->box[k]);
        course->all.box[k + 2] = MAX(course->all.box[k + 2], now->box[k + 2]);
    }
}

/** Says if a region spans the page, rests, and hides nothing that moves: marks of what it hides
 * would show on it. */
static bool stays(const Course *courses, guint region)
{
    const float *own = courses[region].all.box;
    bool ground = courses[region].spans && courses[region].rests;
    for (guint r = 0; r < region && ground; r++) {
        const float *box = courses[r].all.box;
        ground = courses[r].rests || box[2] < own[0] || box[0] > own[2] || box[3] < own[1] ||
                 box[1] > own[3];
    }
    return ground;
}

/** Counts frames, leaves and area of the regions. */
static void measure(FlDrawing *drawing, const FlSurvey *survey)
{
    const guint n = drawing->regions->len;
    g_autofree int *leaves = g_new(int, n + 1);
    g_autofree Place *now = g_new(Place, n + 1);
    g_autofree Course *courses = g_new0(Course, n + 1);
    for (int t = 0; t < survey->n_frames; t++) {
        memset(leaves, 0, n * sizeof *leaves);
        memset(now, 0, n * sizeof *now);
        FL_EACH (const FlSurveyPart, s, survey->frame[t].parts) {
            if (s->region < 0)
                continue;
            leaves[s->region]++;
            g_array_index(drawing->regions, FlRegion, s->region).area_px += s->area_px;
            add_part(&now[s->region], s);
        }
        for (guint r = 0; r < n; r++) {
            FlRegion *region = &g_array_index(drawing->regions, FlRegion, r);
            if (leaves[r] > 0 && region->n_present++ == 0)
                region->first_frame = t;
            if (region->n_present > 0)
                follow(&courses[r], &now[r], &survey->frame[t].page, region->first_frame == t);
            region->n_leaves = MAX(region->n_leaves, leaves[r]);
        }
    }
    for (guint r = 0; r < n; r++) {
        FlRegion *region = &g_array_index(drawing->regions, FlRegion, r);
        region->area_px /= MAX(region->n_present, 1);
        region->wide = courses[r].wide;
        region->stays = stays(courses, r);
    }
}

/** Says if a gradient has a stop of a colour, as programs round it. */
static bool has_stop(const char *gradient, const uint8_t rgb[3])
{
    for (const char *stop = strchr(gradient, ':'); stop; stop = strchr(stop + 1, ':')) {
        const unsigned long colour = strtoul(stop + 1, NULL, 16) >> 8; // without its opacity
        int most = 0;
        for (int c = 0; c < 3; c++)
            most = MAX(most, abs((int)(colour >> (16 - 8 * c) & 255) - rgb[c]));
        if (most <= 2)
            return true;
    }
    return false;
}

/** Finds the region into whose flat paint a gradient goes over; -1: there is none. */
static int skin_of_gradient(const GArray *regions, const char *gradient)
{
    double most = -1;
    int skin = -1;
    for (int k = 0; k < (int)regions->len; k++) {
        const FlRegion *other = &g_array_index(regions, FlRegion, k);
        if (other->skin == k && other->area_px > most && has_stop(gradient, other->rgb))
            skin = k, most = other->area_px;
    }
    return skin;
}

/** Finds the skins of the regions: a neck whose gradient ends in the colour of the body is one with
 * the body. */
static void find_skins(const FlDrawing *drawing, const FlSurvey *survey, const GArray *groups)
{
    FlRegion *all = (FlRegion *)(void *)drawing->regions->data;
    const guint n = drawing->regions->len;
    g_autoptr(GHashTable) largest = g_hash_table_new(g_str_hash, g_str_equal); // by flat paint
    for (guint r = 0; r < n; r++) {
        const FlRegion *known = g_hash_table_lookup(largest, all[r].paint);
        if (all[r].paint[0] == '#' && (!known || all[r].area_px > known->area_px))
            g_hash_table_insert(largest, all[r].paint, &all[r]);
    }
    for (guint r = 0; r < n; r++) {
        const FlRegion *found = g_hash_table_lookup(largest, all[r].paint);
        all[r].skin = found ? (int)(found - all) : -1;
    }
    for (guint r = 0; r < n; r++)
        if (g_str_equal(all[r].paint, "gradient")) {
            const int key = g_array_index(groups, FlRegionIdentity, r).paint;
            all[r].skin = skin_of_gradient(drawing->regions, fl_strings_get(&survey->strings, key));
        }
}

/** Follows merges of merges; a region in a cycle of merges stays itself. */
static int end_of(const int *into, guint n, int region)
{
    int r = region;
    for (guint k = 0; k < n && into[r] != r; k++)
        r = into[r];
    return into[r] == r ? r : region;
}

/** Joins a region whose rule says merge_with to the region of that name. */
static void merge_regions(FlSurvey *survey, GArray *groups, const FlRule *rules)
{
    g_auto(GStrv) names = fl_name_groups(survey, groups, rules);
    g_autofree int *into = g_new(int, groups->len + 1);
    for (guint r = 0; r < groups->len; r++) {
        const int rule = g_array_index(groups, FlRegionIdentity, r).rule;
        const char *override = rule >= 0 ? rules[rule].merge_with : NULL;
        into[r] = (int)r;
        for (guint q = 0; override && q < groups->len; q++)
            if (q != r && strcmp(names[q], override) == 0)
                into[r] = (int)q;
    }
    g_autofree int *end = g_new(int, groups->len + 1);
    for (guint r = 0; r < groups->len; r++)
        end[r] = end_of(into, groups->len, (int)r);
    g_autofree int *number = g_new(int, groups->len + 1);
    guint kept = 0;
    for (guint r = 0; r < groups->len; r++) {
        number[r] = (int)kept;
        if (end[r] == (int)r)
            g_array_index(groups, FlRegionIdentity, kept++) =
                g_array_index(groups, FlRegionIdentity, r);
    }
    FL_EACH_PART (survey, t, s)
        if (s->region >= 0)
            s->region = number[end[s->region]];
    g_array_set_size(groups, kept);
}

static void remember(FlDrawing *drawing, FlSurvey *survey)
{
    g_autofree GArray **limbs = NULL;
    g_autofree FlAnchor **anchors =
        fl_region_anchors_find(survey, (int)drawing->regions->len, &limbs);
    drawing->frame = g_new0(FlDrawingFrame, survey->n_frames);
    for (int t = 0; t < survey->n_frames; t++) {
        const GArray *parts = survey->frame[t].parts;
        FlDrawingFrame *frame = &drawing->frame[t];
        frame->page = survey->frame[t].page;
        frame->canvas = survey->frame[t].canvas;
        frame->origin = t;
        frame->anchor = anchors[t];
        frame->limbs = limbs[t];
        for (guint r = 0; r < drawing->regions->len; r++) {
            const FlRegion *region = fl_drawing_region(drawing, (int)r);
            frame->anchor[r].side = (float)sqrt(region->area_px / MAX(region->n_leaves, 1));
        }
        for (int i = 0; survey->frame[t].files && survey->frame[t].files[i]; i++)
            g_hash_table_add(drawing->files, g_strdup(survey->frame[t].files[i]));
        frame->whole = g_steal_pointer(&survey->frame[t].whole);
        frame->step = g_new0(FlDrawStep, parts->len + 1);
        FL_EACH (const FlSurveyPart, s, parts) {
            if (s->region < 0)
                continue;
            FlDrawStep *step = &frame->step[frame->n++];
            *step = (FlDrawStep){.leaf = s->leaf,
                                 .region = (int16_t)s->region,
                                 .part = (uint8_t)s->part,
                                 .flat = s->kind == FL_PAINT_FLAT,
                                 .rgb = {s->rgb[0], s->rgb[1], s->rgb[2]},
                                 .alpha = s->peak,
                                 .drawn = s->peak,
                                 .blend_mode = (uint8_t)s->blend_mode,
                                 .nth = (uint16_t)s->nth,
                                 .width = s->width};
            memcpy(step->box, s->box, sizeof step->box);
        }
    }
}

/** Applies rules without conditions to the regions of their names. */
static void apply_names(const FlSurvey *survey, GArray *groups, const FlRule *rules, int n)
{
    g_auto(GStrv) names = fl_name_groups(survey, groups, rules);
    for (guint r = 0; r < groups->len; r++) {
        FlRegionIdentity *group = &g_array_index(groups, FlRegionIdentity, r);
        for (int i = 0; i < n && group->rule < 0; i++)
            if (rules[i].by_name && g_pattern_match_simple(rules[i].name, names[r]))
                group->rule = i;
    }
}

static FlDrawing *make_film(const FlDrawingOptions *options, FlSequence *sequence, FlSurvey *survey,
                            GError **error)
{
    g_autoptr(GArray) groups = fl_region_identities_find(survey, options);
    apply_names(survey, groups, options->rules, options->n_rules);
    merge_regions(survey, groups, options->rules);
    if (groups->len > INT16_MAX)
        return fl_none(error, FL_ERROR_LIMIT,
                       "%s: %u regions, more than the limit of %d; use another ‘key’",
                       sequence->frame[0].file, groups->len, INT16_MAX);
    FlDrawing *drawing = g_new0(FlDrawing, 1);
    *drawing = (FlDrawing){.sequence = sequence,
                           .dpi = options->dpi,
                           .width = survey->width,
                           .height = survey->height,
                           .regions = g_array_new(FALSE, TRUE, sizeof(FlRegion)),
                           .files = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL),
                           .kept = g_new0(GBytes *, sequence->n),
                           .n_kept = sequence->n};
    g_mutex_init(&drawing->mutex);
    g_array_set_clear_func(drawing->regions, region_clear);
    describe(drawing, survey, groups, options->rules);
    measure(drawing, survey);
    find_skins(drawing, survey, groups);
    find_class_words(drawing, survey);
    remember(drawing, survey);
    return drawing;
}

/** Reads all frames; `missing` decides about those that cannot be read. */
static bool read_frames(FlSurvey *survey, FlSequence *sequence, const FlDrawingOptions *options,
                        FlWorkers *workers, FlWarnings *warnings, GError **error)
{
    for (int round = 1;; round++) { // a frame may turn out to be bad once others are known
        GError *reason = NULL;
        g_autoptr(FlWarnings) remarks = fl_warnings_new();
        const bool good = fl_survey_init(survey, sequence, options, workers, remarks, &reason);
        int n_failed = 0;
        for (int t = 0; t < sequence->n; t++)
            n_failed += survey->failed[t] != NULL;
        if (good || n_failed == 0 || options->frames.missing <= FL_MISSING_ERROR ||
            round > MOST_ROUNDS) {
            fl_warnings_append(warnings, remarks);
            if (reason)
                g_propagate_error(error, reason);
            return good;
        }
        g_error_free(reason);
        if (!fl_may_leave_out(survey->failed, sequence->n, error))
            return false;
        fl_sequence_leave_out(sequence, options->frames.missing, survey->failed, warnings);
        fl_survey_clear(survey);
    }
}

FlDrawing *fl_drawing_open(const FlDrawingOptions *options, FlWarnings *warnings, GError **error)
{
    if (!fl_rules_check(options->rules, options->n_rules, error))
        return NULL;
    g_autoptr(FlSequence) sequence = fl_sequence_open(&options->frames, warnings, error);
    if (!sequence)
        return NULL;
    g_auto(GStrv) paths = fl_paths_of((const char *const *)sequence->found);
    g_autoptr(FlWorkers) workers = fl_workers_new(
        (const char *const *)paths, options->frames.sandbox, options->sandboxed, error);
    if (!workers)
        return NULL;
    FlSurvey survey;
    FlDrawing *drawing = NULL;
    if (read_frames(&survey, sequence, options, workers, warnings, error))
        drawing = make_film(options, sequence, &survey, error);
    if (drawing) {
        drawing->workers = g_steal_pointer(&workers);
        const char *lack = options->sandboxed ? fl_workers_lack(drawing->workers) : NULL;
        if (lack)
            fl_warnings_add(warnings, sequence->frame[0].file, -1, NULL,
                            "is read without a whole sandbox: %s", lack);
        g_steal_pointer(&sequence);
    }
    fl_survey_clear(&survey);
    return drawing;
}

void fl_drawing_frame_clear(FlDrawingFrame *frame)
{
    g_free(frame->step);
    g_free(frame->anchor);
    g_clear_pointer(&frame->limbs, g_array_unref);
    g_strfreev(frame->whole);
    *frame = (FlDrawingFrame){0};
}

void fl_drawing_free(FlDrawing *drawing)
{
    if (!drawing)
        return;
    fl_workers_free(drawing->workers);
    fl_drawing_forget(drawing);
    g_free(drawing->kept);
    g_mutex_clear(&drawing->mutex);
    for (int t = 0; t < drawing->sequence->n; t++)
        fl_drawing_frame_clear(&drawing->frame[t]);
    g_free(drawing->frame);
    fl_sequence_free(drawing->sequence);
    g_array_unref(drawing->regions);
    g_hash_table_unref(drawing->files);
    g_free(drawing);
}
