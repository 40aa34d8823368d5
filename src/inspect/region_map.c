/* The regions of a drawing as a table, a config or maps. */
#include <fluidy/inspect.h>

#include "base/alloc.h"
#include "base/error.h"
#include "base/json.h"
#include "base/surface.h"
#include "drawing/drawing.h"
#include "io/pattern.h"
#include "io/png.h"
#include "job/plan.h"
#include "params/options.h"
#include <fluidy/style.h>

#include <string.h>

/* A drawing with its options. */
typedef struct Subject {
    FlRenderOptions options; // complete
    FlCaller caller;         // of them
    FlConfig *config;
    FlDrawing *drawing;
} Subject;

static void subject_clear(Subject *subject)
{
    fl_drawing_free(subject->drawing);
    fl_config_free(subject->config);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Subject, subject_clear)

static bool subject_configure(Subject *subject, const FlRenderOptions *options, GError **error)
{
    const FlRenderOptions *o = &subject->options;
    if (!fl_options_take(options, &subject->options, error) ||
        !(subject->config = fl_config_load(o->config, o, error)))
        return false;
    fl_config_complete(subject->config, &subject->options);
    subject->caller = fl_caller_of(o);
    return true;
}

static bool subject_read(Subject *subject, GError **error)
{
    subject->drawing =
        fl_drawing_from_options(&subject->options, subject->config, &subject->caller, error);
    return subject->drawing != NULL;
}

/* ---- data ---------------------------------------------------------------------------------- */

static FlRegionInfo *region_info(const Subject *subject, const FlRegion *r)
{
    FlRegionInfo *info = g_new(FlRegionInfo, 1);
    const char *section = r->rule >= 0 ? subject->config->rules[r->rule].name : NULL;
    const int first = r->n_present > 0 ? fl_drawing_number(subject->drawing, r->first_frame) : 0;
    *info = (FlRegionInfo){.name = g_strdup(r->name),
                           .paint = g_strdup(r->paint),
                           .layer = g_strdup(r->label),
                           .section = g_strdup(section),
                           .n_frames = r->n_present,
                           .first_frame = first,
                           .n_shapes = r->n_leaves,
                           .area_px = r->area_px,
                           .painted = r->paintable};
    return info;
}

static FlRegionList *list_of(const Subject *subject)
{
    const FlDrawing *drawing = subject->drawing;
    const int n = fl_drawing_regions(drawing);
    FlRegionInfo **region = g_new0(FlRegionInfo *, MAX(n, 1));
    for (int r = 0; r < n; r++)
        region[r] = region_info(subject, fl_drawing_region(drawing, r));
    FlRegionList *list = g_new(FlRegionList, 1);
    *list = (FlRegionList){fl_drawing_width(drawing), fl_drawing_height(drawing),
                           fl_drawing_frames(drawing), n, region};
    return list;
}

FlRegionList *fl_region_list_new(const FlRenderOptions *options, GError **error)
{
    g_auto(Subject) subject = {0};
    const bool read = subject_configure(&subject, options, error) && subject_read(&subject, error);
    return read ? list_of(&subject) : NULL;
}

void fl_region_list_free(FlRegionList *list)
{
    for (int r = 0; list && r < list->n_regions; r++) {
        FlRegionInfo *info = list->region[r];
        g_free(info->name);
        g_free(info->paint);
        g_free(info->layer);
        g_free(info->section);
        g_free(info);
    }
    if (list)
        g_free((void *)list->region);
    g_free(list);
}

/* ---- tables ------------------------------------------------------------------------------- */

enum { FRAMES = 2, AREA = 3, SHAPES = 4, N_COLUMNS = 8 };

/* The cells of a region; no text has a tab. To be freed with g_strfreev(). */
static char **cells_of(const FlRegionList *list, const FlRegionInfo *r)
{
    g_autofree char *name = fl_one_line(r->name), *paint = fl_one_line(r->paint);
    g_autofree char *section = fl_one_line(r->section ? r->section : "-");
    g_autofree char *layer = fl_one_line(*r->layer ? r->layer : "-");
    g_autofree char *row = g_strdup_printf("%s\t%s\t%d/%d\t%.0f\t%d\t%s\t%s\t%s", name, paint,
                                           r->n_frames, list->n_frames, r->area_px, r->n_shapes,
                                           r->painted ? "yes" : "no", section, layer);
    return g_strsplit(row, "\t", N_COLUMNS);
}

/* Numbers are right-aligned. */
static void append_row(GString *text, char *const *cell, const int widths[N_COLUMNS])
{
    for (int c = 0; c < N_COLUMNS; c++) {
        const int gap = widths[c] - (int)g_utf8_strlen(cell[c], -1);
        const bool right = c == FRAMES || c == AREA || c == SHAPES;
        if (c == N_COLUMNS - 1)
            g_string_append_printf(text, "%s\n", cell[c]);
        else
            g_string_append_printf(text, "%*s%s%*s  ", right ? gap : 0, "", cell[c],
                                   right ? 0 : gap, "");
    }
}

static char *table(const FlRegionList *list)
{
    g_autoptr(GPtrArray) rows = g_ptr_array_new_with_free_func((GDestroyNotify)g_strfreev);
    g_ptr_array_add(rows,
                    g_strsplit("REGION PAINT FRAMES AREA SHAPES PAINTED SECTION LAYER", " ", -1));
    for (int r = 0; r < list->n_regions; r++)
        g_ptr_array_add(rows, cells_of(list, list->region[r]));
    int widths[N_COLUMNS] = {0};
    for (guint i = 0; i < rows->len; i++)
        for (int c = 0; c < N_COLUMNS; c++)
            widths[c] = MAX(widths[c], (int)g_utf8_strlen(((char **)rows->pdata[i])[c], -1));
    GString *text = g_string_new(NULL);
    for (guint i = 0; i < rows->len; i++)
        append_row(text, rows->pdata[i], widths);
    return g_string_free(text, FALSE);
}

/* ---- configs ------------------------------------------------------------------------------ */

static const char *style_option(const Subject *subject)
{
    for (size_t i = subject->options.n_settings; i > 0; i--)
        if (!subject->options.settings[i - 1].region &&
            strcmp(subject->options.settings[i - 1].name, "style") == 0)
            return subject->options.settings[i - 1].value;
    return NULL;
}

/* The style of a new config: the option's, else 01, else the first style found, else NULL. */
static char *initial_style(const Subject *subject)
{
    const char *option = style_option(subject);
    g_autoptr(GPtrArray) found = option ? NULL : fl_style_list();
    const char *name = option;
    for (guint i = 0; found && i < found->len; i++) {
        const FlStyleEntry *entry = g_ptr_array_index(found, i);
        if (!name || strcmp(entry->name, "01") == 0)
            name = entry->name;
    }
    return g_strdup(name);
}

/* The part of a region's name that its label makes: what follows is its paint. NULL: no label. */
static char *label_part(const FlRegion *r)
{
    g_autofree char *paint = g_strdup_printf("-%s", r->paint + (r->paint[0] == '#'));
    const char *end = g_strrstr(r->name, paint);
    if (!end && strcmp(r->paint, "image") == 0)
        end = g_strrstr(r->name, "-group");
    return *r->label && end ? g_strndup(r->name, (gsize)(end - r->name)) : NULL;
}

/* A glob of the names with this label, or, if `numbered`, with one that differs in its numbers. */
static char *glob_of(const char *label, bool numbered)
{
    GString *glob = g_string_new(NULL);
    for (const char *c = label; *c; c++)
        if (!numbered || !g_ascii_isdigit(*c))
            g_string_append_c(glob, *c);
        else if (glob->len == 0 || glob->str[glob->len - 1] != '*')
            g_string_append_c(glob, '*');
    const bool ends = glob->len > 0 && glob->str[glob->len - 1] == '*';
    return g_string_free(g_string_append(glob, ends ? "" : "-*"), FALSE);
}

/* Returns: true if a glob matches `region`, and others only if their labels differ in numbers
 * alone. */
static bool tells_apart(const Subject *subject, const char *glob, int region)
{
    const FlRegion *r = fl_drawing_region(subject->drawing, region);
    g_autofree char *label = label_part(r), *stem = glob_of(label, true);
    g_autoptr(GHashTable) labels = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    for (int k = 0; k < fl_drawing_regions(subject->drawing); k++) {
        const FlRegion *other = fl_drawing_region(subject->drawing, k);
        g_autofree char *own = label_part(other), *own_stem = own ? glob_of(own, true) : NULL;
        if (!g_pattern_match_simple(glob, other->name))
            continue;
        if (!own || strcmp(own_stem, stem) != 0 || other->paintable != r->paintable ||
            other->rule >= 0 || !g_hash_table_add(labels, g_steal_pointer(&own)))
            return false; // two of one label differ in their paint alone
    }
    return true;
}

/*
 * The name of a section should survive edits of the drawing: it is a label or a class; a paint only
 * if no label or class distinguishes the region. Returns: the name; *match: another line of the
 * section, or NULL.
 */
static char *section_of(const Subject *subject, int region, char **match)
{
    const FlRegion *r = fl_drawing_region(subject->drawing, region);
    g_autofree char *label = label_part(r);
    for (int numbered = 1; label && numbered >= 0 && r->rule < 0; numbered--) {
        g_autofree char *glob = glob_of(label, numbered);
        if (tells_apart(subject, glob, region))
            return g_steal_pointer(&glob);
    }
    if (!label && r->class_word && r->rule < 0 && !strpbrk(r->class_word, ",;*?[]#")) {
        *match = g_strdup_printf("match-class = %s\n", r->class_word);
        return g_strdup(r->class_word);
    }
    return g_strdup(r->name);
}

static void append_section(GString *text, const Subject *subject, int region, GHashTable *done)
{
    const FlRegion *r = fl_drawing_region(subject->drawing, region);
    g_autofree char *match = NULL, *name = section_of(subject, region, &match);
    const bool is_glob = strchr(name, '*') != NULL;
    if (g_hash_table_contains(done, name))
        return;
    g_string_append_printf(text, "\n[region %s]\n", name);
    for (int k = region; k < fl_drawing_regions(subject->drawing); k++) {
        const FlRegion *one = fl_drawing_region(subject->drawing, k);
        if (k != region && !(is_glob && g_pattern_match_simple(name, one->name)))
            continue;
        g_autofree char *label = fl_one_line(one->label);
        g_string_append_printf(text, "# %s%s%s, %d of %d frames, %.0f px\n", one->paint,
                               *label ? " in layer " : "", label, one->n_present,
                               fl_drawing_frames(subject->drawing), one->area_px);
    }
    g_string_append(text, match ? match : "");
    g_string_append(text, r->paintable ? "# style = 01\n# tint = fill\n"
                                       : "# drawn as it is; passthrough = off paints it\n");
    g_hash_table_add(done, g_steal_pointer(&name));
}

static char *config_text(const Subject *subject)
{
    g_autofree char *style = initial_style(subject);
    GString *text = g_string_new("# How the regions are painted; see fluidy-svg.conf(5).\n");
    g_string_append_printf(text,
                           "# Lines that start with # are comments.\n\n"
                           "[project]\nversion = 1\n# background = #ffffff\n\n"
                           "[defaults]\n%sstyle = %s\n",
                           style ? "" : "# ", style ? style : "01");
    g_autoptr(GHashTable) done = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    for (int r = 0; r < fl_drawing_regions(subject->drawing); r++)
        append_section(text, subject, r, done);
    return g_string_free(text, FALSE);
}

/* ---- JSON --------------------------------------------------------------------------------- */

static void append_region(GString *json, const FlRegionInfo *r)
{
    fl_json_begin(json, NULL, '{');
    fl_json_text(json, "region", r->name);
    fl_json_text(json, "paint", r->paint);
    fl_json_number(json, "frames", r->n_frames, true);
    fl_json_number(json, "first_frame", r->first_frame, r->n_frames > 0);
    fl_json_number(json, "area_px", r->area_px, true);
    fl_json_number(json, "shapes", r->n_shapes, true);
    fl_json_bool(json, "painted", r->painted);
    fl_json_text(json, "section", r->section);
    fl_json_text(json, "layer", *r->layer ? r->layer : NULL);
    g_string_append_c(json, '}');
}

static char *json_text(const FlDrawing *drawing, const FlRegionList *list)
{
    GString *json = g_string_new("{");
    fl_json_text(json, "drawing", fl_drawing_name(drawing));
    fl_json_number(json, "width", list->width, true);
    fl_json_number(json, "height", list->height, true);
    fl_json_begin(json, "frames", '[');
    for (int f = 0; f < list->n_frames; f++)
        fl_json_number(json, NULL, fl_drawing_number(drawing, f), true);
    g_string_append_c(json, ']');
    fl_json_begin(json, "regions", '[');
    for (int r = 0; r < list->n_regions; r++)
        append_region(json, list->region[r]);
    g_string_append(json, "]}\n");
    return g_string_free(json, FALSE);
}

char *fl_list_regions(const FlRenderOptions *options, FlListing listing, GError **error)
{
    g_auto(Subject) subject = {0};
    if (!subject_configure(&subject, options, error) || !subject_read(&subject, error))
        return NULL;
    g_autoptr(FlRegionList) list = list_of(&subject);
    return listing == FL_LISTING_CONFIG ? config_text(&subject)
           : listing == FL_LISTING_JSON ? json_text(subject.drawing, list)
                                        : table(list);
}

/* ---- maps --------------------------------------------------------------------------------- */

#define LINE_PX 20
#define LEGEND_PX 280

/* The legend at the right of the map: a line per painted region. */
static void draw_legend(cairo_t *cr, const FlDrawing *drawing, int left)
{
    cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, 12);
    int line = 0;
    for (int r = 0; r < fl_drawing_regions(drawing); r++) {
        const FlRegion *region = fl_drawing_region(drawing, r);
        if (!region->paintable)
            continue;
        uint8_t rgb[3];
        fl_region_colour(drawing, r, rgb);
        const double y = 8 + LINE_PX * line++;
        cairo_set_source_rgb(cr, rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0);
        cairo_rectangle(cr, left + 8, y, 14, 14);
        cairo_fill(cr);
        cairo_set_source_rgb(cr, 0, 0, 0);
        cairo_move_to(cr, left + 30, y + 11);
        cairo_show_text(cr, region->name);
    }
}

static int legend_height(const FlDrawing *drawing)
{
    int lines = 0;
    for (int r = 0; r < fl_drawing_regions(drawing); r++)
        lines += fl_drawing_region(drawing, r)->paintable;
    return 16 + LINE_PX * lines;
}

static bool write_map(const Subject *subject, int frame, const char *pattern, GError **error)
{
    const FlDrawing *drawing = subject->drawing;
    const int width = fl_drawing_width(drawing), height = fl_drawing_height(drawing);
    const int all_width = width + LEGEND_PX, all_height = MAX(height, legend_height(drawing));
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, frame, error);
    g_autofree uint8_t *map = draws ? fl_alloc((size_t)width * height, 4, "a map", error) : NULL;
    if (!map)
        return false;
    fl_draw_list_map(drawing, draws, map);
    g_autoptr(cairo_surface_t) picture = fl_surface_of(map, 4, width, height, error);
    g_autoptr(cairo_surface_t) surface =
        picture ? fl_surface_new(CAIRO_FORMAT_RGB24, all_width, all_height, error) : NULL;
    if (!surface)
        return false;
    g_autoptr(cairo_t) cr = cairo_create(surface);
    cairo_set_source_rgb(cr, 1, 1, 1);
    cairo_paint(cr);
    cairo_set_source_surface(cr, picture, 0, 0);
    cairo_paint(cr);
    draw_legend(cr, drawing, width);
    g_autofree uint8_t *rgba = fl_surface_bytes(surface, 4, all_height, error);
    g_autofree char *path = fl_output_name(pattern, fl_drawing_number(drawing, frame), NULL, error);
    const FlPng png = {.width = all_width, .height = all_height, .rgba = rgba, .opaque = true};
    const bool overwrite = subject->options.overwrite == FL_OVERWRITE_YES;
    return rgba && path && fl_png_save(&png, path, overwrite, error);
}

/* Saves the picture of a frame; false with an error. */
typedef bool WriteFrame(const Subject *subject, int frame, const char *pattern, GError **error);

/* The names of the pictures, free if they must be: known before the drawing is read. */
static char *pattern_of(const Subject *subject, const char *what, GError **error)
{
    g_autoptr(FlSequence) sequence = fl_sequence_from_options(&subject->options, error);
    if (!sequence)
        return NULL;
    g_autofree char *tail = g_strdup_printf("_%s_%%04d.png", what);
    g_autofree char *are = g_strdup_printf("%ss are", what);
    g_autofree char *pattern =
        fl_output_of_film(subject->options.output, tail, sequence->name, true);
    if (!fl_png_named(pattern, are, error))
        return NULL;
    for (int f = 0; subject->options.overwrite != FL_OVERWRITE_YES && f < sequence->n; f++) {
        g_autofree char *file = fl_output_name(pattern, sequence->frame[f].number, NULL, error);
        if (!file || !fl_check_not_exists(file, error))
            return NULL;
    }
    return g_steal_pointer(&pattern);
}

/* Saves a picture of every frame; `what`, "map", names one. */
static bool write_frames(const FlRenderOptions *options, const char *what, WriteFrame *write,
                         GError **error)
{
    g_auto(Subject) subject = {0};
    if (!subject_configure(&subject, options, error))
        return false;
    g_autofree char *pattern = pattern_of(&subject, what, error);
    if (!pattern || !subject_read(&subject, error) ||
        !fl_guard_pictures(subject.drawing, subject.config, &subject.options, pattern, error))
        return false;
    const int n = fl_drawing_frames(subject.drawing);
    for (int f = 0; f < n; f++)
        if (!write(&subject, f, pattern, error))
            return false;
    g_autofree char *gaps = fl_drawing_left_out(subject.drawing, subject.options.missing);
    fl_note(&subject.caller, "%d %s%s: %s", n, what, n == 1 ? "" : "s", pattern);
    if (gaps)
        fl_note(&subject.caller, "%s", gaps);
    return true;
}

bool fl_map_regions(const FlRenderOptions *options, GError **error)
{
    return write_frames(options, "map", write_map, error);
}

/* ---- flat pictures ------------------------------------------------------------------------ */

static bool write_flat(const Subject *subject, int frame, const char *pattern, GError **error)
{
    const FlDrawing *drawing = subject->drawing;
    const int width = fl_drawing_width(drawing), height = fl_drawing_height(drawing);
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, frame, error);
    g_autofree uint8_t *flat =
        draws ? fl_alloc((size_t)width * height, 4, "a flat picture", error) : NULL;
    g_autofree char *path =
        flat ? fl_output_name(pattern, fl_drawing_number(drawing, frame), NULL, error) : NULL;
    if (!path)
        return false;
    fl_draw_list_flat(draws, width, height, flat);
    const FlPng png = {.width = width, .height = height, .rgba = flat};
    return fl_png_save(&png, path, subject->options.overwrite == FL_OVERWRITE_YES, error);
}

bool fl_flatten(const FlRenderOptions *options, GError **error)
{
    return write_frames(options, "flat", write_flat, error);
}
