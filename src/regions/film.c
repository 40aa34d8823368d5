#include "base/box.h"
#include "regions/filmdata.h"
#include "regions/identity.h"
#include "regions/names.h"
#include <string.h>

int fl_film_frames(const FlFilm *film)
{
    return film->sequence->n;
}

int fl_film_width(const FlFilm *film)
{
    return film->width;
}

int fl_film_height(const FlFilm *film)
{
    return film->height;
}

/* The files are drawn to the page's size, and steps within their boxes. */
void fl_film_halve(FlFilm *film)
{
    film->width = fl_half_side(film->width), film->height = fl_half_side(film->height);
    for (int f = 0; f < film->sequence->n; f++) {
        FlFilmFrame *frame = &film->frame[f];
        frame->page_width /= 2, frame->page_height /= 2;
        for (int i = 0; i < frame->n; i++)
            for (int side = 0; side < 4; side++)
                frame->step[i].box[side] /= 2;
    }
}

int fl_film_regions(const FlFilm *film)
{
    return (int)film->regions->len;
}

const FlRegion *fl_film_region(const FlFilm *film, int region)
{
    return &g_array_index(film->regions, FlRegion, region);
}

const char *fl_film_name(const FlFilm *film)
{
    return film->sequence->name;
}

const char *fl_film_file(const FlFilm *film, int frame)
{
    return film->sequence->file[frame];
}

int fl_film_number(const FlFilm *film, int frame)
{
    return film->sequence->number[frame];
}

static void region_clear(void *data)
{
    FlRegion *region = data;
    g_free(region->name);
    g_free(region->label);
    g_free(region->paint);
}

/** "leg_FB/Group" of "leg_FB\nGroup". */
static char *label_path(const char *labels)
{
    return g_strdelimit(g_strdup(labels), "\n", '/');
}

static char *paint_text(const FlGroup *group)
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

static bool is_paintable(const FlGroup *group, const FlRegionRule *rules)
{
    const FlPassthrough wish =
        group->rule >= 0 ? rules[group->rule].passthrough : FL_PASSTHROUGH_AUTO;
    if (wish != FL_PASSTHROUGH_AUTO)
        return wish == FL_PASSTHROUGH_NO;
    return !group->stroke && !group->shade;
}

static void describe(FlFilm *film, const FlScan *scan, const GArray *groups,
                     const FlRegionRule *rules)
{
    g_auto(GStrv) names = fl_name_groups(scan, groups, rules);
    for (guint r = 0; r < groups->len; r++) {
        const FlGroup *group = &g_array_index(groups, FlGroup, r);
        const FlRegion region = {
            .name = g_strdup(names[r]),
            .label = label_path(fl_strings_get(&scan->strings, group->label)),
            .paint = paint_text(group),
            .paintable = is_paintable(group, rules),
            .rule = group->rule,
        };
        g_array_append_val(film->regions, region);
    }
}

/** Counts frames, leaves and area of the regions. */
static void measure(FlFilm *film, const FlScan *scan)
{
    const guint n = film->regions->len;
    g_autofree int *leaves = g_new(int, n + 1);
    for (int t = 0; t < scan->n_frames; t++) {
        memset(leaves, 0, n * sizeof *leaves);
        for (guint i = 0; i < scan->frame[t].seen->len; i++) {
            const FlSeen *s = &g_array_index(scan->frame[t].seen, FlSeen, i);
            if (s->region < 0)
                continue;
            leaves[s->region]++;
            g_array_index(film->regions, FlRegion, s->region).area_px += s->area_px;
        }
        for (guint r = 0; r < n; r++) {
            FlRegion *region = &g_array_index(film->regions, FlRegion, r);
            if (leaves[r] > 0 && region->n_present++ == 0)
                region->first_frame = t;
            region->n_leaves = MAX(region->n_leaves, leaves[r]);
        }
    }
    for (guint r = 0; r < n; r++) {
        FlRegion *region = &g_array_index(film->regions, FlRegion, r);
        region->area_px /= MAX(region->n_present, 1);
    }
}

/** Where a region ends up when those that it joins join others; in a circle nothing joins. */
static int end_of(const int *into, guint n, int region)
{
    int r = region;
    for (guint k = 0; k < n && into[r] != r; k++)
        r = into[r];
    return into[r] == r ? r : region;
}

/** Joins a region whose rule says merge_with to the region of that name. */
static void merge_regions(FlScan *scan, GArray *groups, const FlRegionRule *rules)
{
    g_auto(GStrv) names = fl_name_groups(scan, groups, rules);
    g_autofree int *into = g_new(int, groups->len + 1);
    for (guint r = 0; r < groups->len; r++) {
        const int rule = g_array_index(groups, FlGroup, r).rule;
        const char *wish = rule >= 0 ? rules[rule].merge_with : NULL;
        into[r] = (int)r;
        for (guint q = 0; wish && q < groups->len; q++)
            if (q != r && strcmp(names[q], wish) == 0)
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
            g_array_index(groups, FlGroup, kept++) = g_array_index(groups, FlGroup, r);
    }
    for (int t = 0; t < scan->n_frames && kept < groups->len; t++)
        for (guint i = 0; i < scan->frame[t].seen->len; i++) {
            int *region = &g_array_index(scan->frame[t].seen, FlSeen, i).region;
            if (*region >= 0)
                *region = number[end[*region]];
        }
    g_array_set_size(groups, kept);
}

static void remember(FlFilm *film, FlScan *scan)
{
    film->frame = g_new0(FlFilmFrame, scan->n_frames);
    for (int t = 0; t < scan->n_frames; t++) {
        const GArray *seen = scan->frame[t].seen;
        FlFilmFrame *frame = &film->frame[t];
        frame->page_width = scan->frame[t].page_width;
        frame->page_height = scan->frame[t].page_height;
        frame->canvas = scan->frame[t].canvas;
        frame->whole = g_steal_pointer(&scan->frame[t].whole);
        frame->step = g_new0(FlStep, seen->len + 1);
        for (guint i = 0; i < seen->len; i++) {
            const FlSeen *s = &g_array_index(seen, FlSeen, i);
            if (s->region < 0)
                continue;
            FlStep *step = &frame->step[frame->n++];
            *step = (FlStep){.leaf = s->leaf,
                             .region = (int16_t)s->region,
                             .part = (uint8_t)s->part,
                             .flat = s->kind == FL_PAINT_FLAT,
                             .rgb = {s->rgb[0], s->rgb[1], s->rgb[2]},
                             .alpha = s->peak,
                             .drawn = s->peak,
                             .mix = (uint8_t)s->mix};
            memcpy(step->box, s->box, sizeof step->box);
        }
    }
}

/** Gives regions that no rule made to the rules that are about them by name. */
static void apply_names(const FlScan *scan, GArray *groups, const FlRegionRule *rules, int n)
{
    g_auto(GStrv) names = fl_name_groups(scan, groups, rules);
    for (guint r = 0; r < groups->len; r++) {
        FlGroup *group = &g_array_index(groups, FlGroup, r);
        for (int i = 0; i < n && group->rule < 0; i++)
            if (rules[i].by_name && strcmp(rules[i].name, names[r]) == 0)
                group->rule = i;
    }
}

static FlFilm *make_film(const FlFilmOptions *options, FlSequence *sequence, FlScan *scan,
                         GError **error)
{
    g_autoptr(GArray) groups = fl_identify(scan, options);
    apply_names(scan, groups, options->rules, options->n_rules);
    merge_regions(scan, groups, options->rules);
    if (groups->len > INT16_MAX) {
        g_set_error(error, FL_ERROR, FL_ERROR_LIMIT,
                    "%s: %u regions, at most %d are handled; choose another --key",
                    sequence->file[0], groups->len, INT16_MAX);
        return NULL;
    }
    FlFilm *film = g_new0(FlFilm, 1);
    *film = (FlFilm){.sequence = sequence,
                     .dpi = scan->svg.dpi,
                     .width = scan->width,
                     .height = scan->height,
                     .regions = g_array_new(FALSE, TRUE, sizeof(FlRegion))};
    g_array_set_clear_func(film->regions, region_clear);
    describe(film, scan, groups, options->rules);
    measure(film, scan);
    remember(film, scan);
    return film;
}

FlFilm *fl_film_open(const FlFilmOptions *options, FlWarnings *warnings, GError **error)
{
    if (!fl_rules_check(options->rules, options->n_rules, error))
        return NULL;
    g_autoptr(FlSequence) sequence = fl_sequence_open(
        options->inputs, options->n_inputs, options->range, options->missing, warnings, error);
    if (!sequence)
        return NULL;
    FlScan scan;
    FlFilm *film = NULL;
    if (fl_scan_init(&scan, sequence, options, warnings, error))
        film = make_film(options, sequence, &scan, error);
    if (film)
        g_steal_pointer(&sequence);
    fl_scan_clear(&scan);
    return film;
}

static void free_frame(FlFilmFrame *frame)
{
    g_free(frame->step);
    g_strfreev(frame->whole);
}

void fl_film_free(FlFilm *film)
{
    if (!film)
        return;
    for (int t = 0; t < film->sequence->n; t++)
        free_frame(&film->frame[t]);
    g_free(film->frame);
    fl_sequence_free(film->sequence);
    g_array_unref(film->regions);
    g_free(film);
}
