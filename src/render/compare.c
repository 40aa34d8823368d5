/* Sheets and pages: a drawing painted in several styles or by several methods; all styles. */
#include <fluidy/compare.h>
#include <fluidy/style.h>

#include "base/alloc.h"
#include "base/error.h"
#include "base/suggest.h"
#include "drawing/drawing.h"
#include "io/atomic_file.h"
#include "io/contact_sheet.h"
#include "io/pattern.h"
#include "io/png.h"
#include "job/plan.h"
#include "params/options.h"
#include "params/text.h"
#include "render/frames.h"
#include "style/style_folder.h"
#include <string.h>

#define SHOWN_PX 320 // larger side of a frame on the sheet
#define STYLE_COLUMNS 4
#define FRAMES_MOST 4 // of more frames, the sheet has three and a slice

#define SETTINGS_MOST 8 // of a row

/* The settings of one row. They follow the caller's settings and override them. */
typedef struct Variant {
    const char *name; // of the row
    const char *says; // description on the page, in HTML; "" without a page
    int n;
    FlSetting setting[SETTINGS_MOST];
} Variant;

/* A kind of comparison. */
typedef struct Kind {
    const char *noun, *tail; // in the note; of the name of the sheet
    bool has_page;           // beside the sheet
} Kind;

static const Kind styles_kind = {"style", "_styles.png", false};
static const Kind methods_kind = {"method", "_methods.png", true};

/* A comparison: the drawing and the sheet. */
typedef struct Comparison {
    const Kind *kind;
    FlRenderOptions options; // complete
    FlCaller caller;         // of them
    FlConfig *config;
    FlDrawing *drawing;
    FlContactSheet contact;
    char *path;     // of the sheet
    char *page;     // beside it; NULL: no page
    int row, frame; // place of the next painted frame
    int n_frames;
    uint8_t *slice; // of the row that is painted: of each frame the line in the middle, RGBA
} Comparison;

static void comparison_clear(Comparison *c)
{
    fl_drawing_free(c->drawing);
    fl_config_free(c->config);
    fl_contact_sheet_clear(&c->contact);
    free(c->slice);
    g_free(c->path);
    g_free(c->page);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Comparison, comparison_clear)

static bool may_write(const Comparison *c, const char *path, GError **error)
{
    return !path || c->options.overwrite == FL_OVERWRITE_YES || fl_check_not_exists(path, error);
}

/* The files of the sheet and the page beside it, free if they must be, before the drawing is read.
 */
static bool name_files(Comparison *c, const FlRenderOptions *complete, GError **error)
{
    g_autoptr(FlSequence) sequence = fl_sequence_from_options(complete, error);
    if (!sequence)
        return false;
    c->path = fl_output_of_film(c->options.output, c->kind->tail, sequence->name, false);
    if (!fl_png_named(c->path, "sheets are", error))
        return false;
    g_autofree char *stem = g_strndup(c->path, strlen(c->path) - strlen(".png"));
    c->page = c->kind->has_page ? g_strconcat(stem, ".html", NULL) : NULL;
    return may_write(c, c->path, error) && may_write(c, c->page, error);
}

static bool has_slice(const Comparison *c)
{
    return c->n_frames > FRAMES_MOST;
}

/* The frame in a column of the sheet; -1: the slice. */
static int frame_in_column(const Comparison *c, int column)
{
    if (!has_slice(c))
        return column;
    return column < 3 ? column * (c->n_frames - 1) / 2 : -1;
}

static int n_columns(const Comparison *c)
{
    return has_slice(c) ? 4 : c->n_frames;
}

static bool comparison_init(Comparison *c, const Kind *kind, const FlRenderOptions *options,
                            int n_rows, GError **error)
{
    *c = (Comparison){.kind = kind, .options = *options, .caller = fl_caller_of(options)};
    if (!c->options.frames && !kind->has_page)
        c->options.frames = "~1";
    if (!(c->config = fl_config_load(options->config, options, error)))
        return false;
    FlRenderOptions complete = c->options;
    fl_config_complete(c->config, &complete);
    FlCaller silent = fl_caller_of(&complete);
    silent.warning = NULL, silent.note = NULL; // the renders repeat them
    if (!name_files(c, &complete, error) ||
        !(c->drawing = fl_drawing_from_options(&complete, c->config, &silent, error)) ||
        !fl_guard_pictures(c->drawing, c->config, &complete, c->path, error) ||
        (c->page && !fl_guard_pictures(c->drawing, c->config, &complete, c->page, error)))
        return false;
    const int width = fl_drawing_width(c->drawing), height = fl_drawing_height(c->drawing);
    const double scale = MIN(1, (double)SHOWN_PX / MAX(width, height));
    c->n_frames = fl_drawing_frames(c->drawing);
    return fl_contact_sheet_init(&c->contact, n_columns(c), 1 + n_rows,
                                 MAX((int)(width * scale), 1), MAX((int)(height * scale), 1),
                                 error);
}

/* Keeps the middle line of a frame. The width is the same for all frames of a row. */
static bool add_to_slice(Comparison *c, const uint8_t *rgba, int width, int height, GError **error)
{
    const size_t line = 4 * (size_t)width;
    if (!c->slice && !(c->slice = fl_alloc(line, (size_t)c->n_frames, "a slice", error)))
        return false;
    memcpy(c->slice + (size_t)c->frame * line, rgba + (size_t)(height / 2) * line, line);
    return true;
}

/* Puts the slice on the sheet, time downwards, as high as a frame, and begins another. */
static bool put_slice(Comparison *c, int width, int height, GError **error)
{
    const size_t line = 4 * (size_t)width;
    g_autofree uint8_t *rgba = fl_alloc(line, (size_t)height, "a slice", error);
    for (int y = 0; rgba && y < height; y++)
        memcpy(rgba + (size_t)y * line, c->slice + (size_t)(y * c->n_frames / height) * line, line);
    g_autoptr(cairo_surface_t) picture = rgba ? fl_surface_of(rgba, 4, width, height, error) : NULL;
    if (picture)
        fl_contact_sheet_put(&c->contact, 3, c->row, picture);
    g_clear_pointer(&c->slice, free);
    return picture != NULL;
}

/* Puts the next frame of a row where it belongs; after the last one the row is complete. */
static bool put_frame(Comparison *c, const uint8_t *rgba, int width, int height, GError **error)
{
    g_autoptr(cairo_surface_t) picture = fl_surface_of(rgba, 4, width, height, error);
    if (!picture)
        return false;
    for (int column = 0; column < n_columns(c); column++)
        if (frame_in_column(c, column) == c->frame)
            fl_contact_sheet_put(&c->contact, column, c->row, picture);
    if (has_slice(c) && !add_to_slice(c, rgba, width, height, error))
        return false;
    c->frame++;
    return c->frame < c->n_frames || !has_slice(c) || put_slice(c, width, height, error);
}

static void name_columns(const Comparison *c)
{
    for (int column = 0; column < n_columns(c); column++) {
        const int frame = frame_in_column(c, column);
        g_autofree char *name =
            frame < 0 ? g_strdup("the middle line, time downwards")
                      : g_strdup_printf("frame %d", fl_drawing_number(c->drawing, frame));
        fl_contact_sheet_name_column(&c->contact, column, name);
    }
}

static bool show_drawing(Comparison *c, GError **error)
{
    const int width = fl_drawing_width(c->drawing), height = fl_drawing_height(c->drawing);
    g_autofree uint8_t *rgba = fl_alloc((size_t)width * height, 4, "a picture", error);
    while (rgba && c->frame < c->n_frames) {
        g_autoptr(FlDrawList) draws = fl_drawing_draw_list(c->drawing, c->frame, error);
        if (!draws)
            return false;
        fl_draw_list_flat(draws, width, height, rgba);
        if (!put_frame(c, rgba, width, height, error))
            return false;
    }
    name_columns(c);
    fl_contact_sheet_name_row(&c->contact, 0, fl_drawing_name(c->drawing), "the drawing");
    return rgba != NULL;
}

static bool show_frame(void *taker, const FlSinkFrame *frame, int width, int height, GError **error)
{
    return put_frame(taker, frame->rgba, width, height, error);
}

/* Paints all frames of a row. */
static bool paint(Comparison *c, const Variant *variant, int row, GError **error)
{
    g_auto(GStrv) parts = g_strsplit(variant->name, ":", 2); // the name, and what stands below it
    g_autofree char *said = g_strjoinv(" ", parts);
    fl_note(&c->caller, "%s %s", c->kind->noun, said);
    const size_t n = c->options.n_settings;
    const size_t own = (size_t)variant->n;
    g_autofree FlSetting *settings = g_new0(FlSetting, n + own);
    memcpy(settings, c->options.settings, n * sizeof *settings);
    memcpy(settings + n, variant->setting, own * sizeof *settings);
    FlRenderOptions options = c->options;
    options.settings = settings, options.n_settings = n + own;
    options.note = NULL;
    if (row > 1)
        options.warning = NULL; // the drawing's, reported once
    c->row = row, c->frame = 0;
    if (!fl_render_frames(&options, show_frame, c, error))
        return false;
    const char *lines = parts[1] ? g_strdelimit(parts[1], ":", '\n') : "";
    fl_contact_sheet_name_row(&c->contact, row, parts[0], lines);
    return true;
}

/* Appends a line with the caller's settings, which hold for all rows. */
static void append_settings(GString *page, const FlRenderOptions *options)
{
    for (size_t k = 0; k < options->n_settings; k++) {
        g_autofree char *text = g_markup_printf_escaped(
            " <code>--%s %s</code>", options->settings[k].name, options->settings[k].value);
        g_string_append(page, text);
    }
}

/* The page beside the sheet: what each row is. */
static bool write_page(const Comparison *c, const Variant *variants, int n, GError **error)
{
    g_autofree char *sheet = g_path_get_basename(c->path);
    g_autofree char *name = g_markup_escape_text(fl_drawing_name(c->drawing), -1);
    g_autofree char *picture = g_markup_escape_text(sheet, -1);
    g_autoptr(GString) page = g_string_new(NULL);
    g_string_printf(page,
                    "<!doctype html>\n<meta charset=\"utf-8\">\n<title>%s, by %d methods</title>\n"
                    "<h1>%s, by %d methods</h1>\n<p>%d frames; the same for all rows:",
                    name, n, name, n, c->n_frames);
    append_settings(page, &c->options);
    g_string_append_printf(page, "</p>\n<img src=\"%s\" alt=\"a row for each method\">\n<dl>\n",
                           picture);
    for (int k = 0; k < n; k++)
        g_string_append_printf(page, "<dt><b>%s</b></dt><dd>%s</dd>\n", variants[k].name,
                               variants[k].says);
    g_string_append(page, "</dl>\n");
    g_auto(FlAtomicFile) file = {0};
    if (!fl_atomic_open(&file, c->page, c->options.overwrite == FL_OVERWRITE_YES, error))
        return false;
    (void)fwrite(page->str, 1, page->len, file.stream); // a full disk fails the commit
    return fl_atomic_commit(&file, error);
}

static bool compare(const Kind *kind, const FlRenderOptions *given, const Variant *variants, int n,
                    GError **error)
{
    g_auto(Comparison) c = {0};
    FlRenderOptions options;
    if (!fl_options_take(given, &options, error) ||
        !comparison_init(&c, kind, &options, n, error) || !show_drawing(&c, error))
        return false;
    for (int k = 0; k < n; k++)
        if (!paint(&c, &variants[k], k + 1, error))
            return false;
    if (!fl_contact_sheet_save(&c.contact, c.path, options.overwrite == FL_OVERWRITE_YES, error) ||
        (kind->has_page && !write_page(&c, variants, n, error)))
        return false;
    fl_note(&c.caller, "%d %s%s: %s", n, kind->noun, n == 1 ? "" : "s", c.path);
    return true;
}

/* ---- styles ---------------------------------------------------------------------------------- */

/* Returns a row's name for the style in folder `path`: the word that selects it and, on a line of
 * its own, its title. */
static char *style_row_name(const char *style, const char *path, const GPtrArray *entries)
{
    g_autofree char *word = g_path_get_basename(style);
    for (guint k = 0; k < entries->len; k++) {
        const FlStyleEntry *entry = entries->pdata[k];
        if (strcmp(entry->path, path) == 0 && entry->title &&
            g_ascii_strcasecmp(entry->title, word) != 0)
            return g_strdup_printf("%s:%s", word, entry->title);
    }
    return g_steal_pointer(&word);
}

bool fl_compare_styles(const FlRenderOptions *options, const char *const *styles, GError **error)
{
    const int n = (int)g_strv_length((char **)styles);
    g_autofree Variant *variants = g_new0(Variant, n + 1);
    g_autoptr(GPtrArray) names = g_ptr_array_new_with_free_func(g_free);
    g_autoptr(GPtrArray) entries = fl_style_list();
    for (int k = 0; k < n; k++) { // find a mistyped one before painting the others
        g_autofree char *path = fl_style_find(styles[k], error);
        if (!path)
            return false;
        g_ptr_array_add(names, style_row_name(styles[k], path, entries));
        variants[k] = (Variant){names->pdata[k], "", 1, {{.name = "style", .value = styles[k]}}};
    }
    return compare(&styles_kind, options, variants, n, error);
}

/* ---- methods --------------------------------------------------------------------------------- */

#define PRESET(word)                                                                               \
    1,                                                                                             \
    {                                                                                              \
        {                                                                                          \
            .name = "preset", .value = word                                                        \
        }                                                                                          \
    }

static const Variant methods[] = {
    {"default",
     "Patches of the recording, which follow its time and ride on the drawing's own motion.",
     PRESET("default")},
    {"fluidymation",
     "Fluidymation, 2021, table 1: motion from the masks; the recording's frames are chosen by how "
     "far contours move.",
     PRESET("fluidymation")},
    {"thesis",
     "The thesis behind it, section 4.5: the same from the first 50 frames of the recording.",
     PRESET("thesis")},
    {"lazyfluids",
     "LazyFluids, 2015, section 5: motion from the masks carries the last picture; every patch is "
     "used equally often; the recording goes in step with the film and begins again after its end.",
     PRESET("lazyfluids")},
    {"lazyfluids-steady",
     "The same with the drawing's own motion, a firmer hold on the last picture and a sharper "
     "vote.",
     PRESET("lazyfluids-steady")},
    {"transport",
     "Transport: each region moves its own ink until it looks like the style, Pools unless another "
     "one is given, and keeps its amount.",
     2,
     {{.name = "engine", .value = "transport"}, {.name = "style", .value = "pools"}}},
};

static const Variant *find_method(const char *name, GError **error)
{
    const char *names[G_N_ELEMENTS(methods) + 1] = {NULL};
    for (size_t k = 0; k < G_N_ELEMENTS(methods); k++) {
        names[k] = methods[k].name;
        if (strcmp(name, methods[k].name) == 0)
            return &methods[k];
    }
    g_autofree char *hint = fl_did_you_mean(name, names);
    g_autofree char *all = g_strjoinv(", ", (char **)names);
    return fl_none(error, FL_ERROR_USAGE, "no method is called “%s”; there are %s%s", name, all,
                   hint);
}

/* NAME, or NAME:KEY=VALUE… for a method with something changed; `parts` keeps the strings. */
static bool read_method(const char *text, char **parts, Variant *variant, GError **error)
{
    const Variant *method = find_method(parts[0], error);
    if (!method)
        return false;
    *variant = *method;
    variant->name = text;
    for (int k = 1; parts[k]; k++) {
        char *value = strchr(parts[k], '=');
        if (!value || variant->n == SETTINGS_MOST)
            return fl_fail(error, FL_ERROR_USAGE,
                           "%s: expected at most %d of KEY=VALUE after the method, such as "
                           "lazyfluids:w-uni=0",
                           text, SETTINGS_MOST - 1);
        *value++ = '\0';
        variant->setting[variant->n++] = (FlSetting){.name = parts[k], .value = value};
    }
    return true;
}

/* A mistyped setting is found before anything is painted. */
static bool check_settings(const Variant *variant, GError **error)
{
    g_auto(FlRegionSettings) scratch;
    fl_region_settings_init(&scratch);
    for (int k = 0; k < variant->n; k++)
        if (!fl_region_settings_set(&scratch, variant->setting[k].name, variant->setting[k].value,
                                    NULL, error))
            return false;
    return true;
}

bool fl_compare_methods(const FlRenderOptions *options, const char *const *names, GError **error)
{
    const int n = (int)g_strv_length((char **)names);
    g_autofree Variant *variants = g_new0(Variant, n + 1);
    g_autoptr(GPtrArray) texts = g_ptr_array_new_with_free_func((GDestroyNotify)g_strfreev);
    for (int k = 0; k < n; k++) {
        char **parts = g_strsplit(names[k], ":", -1);
        g_ptr_array_add(texts, parts);
        if (!read_method(names[k], parts, &variants[k], error) ||
            !check_settings(&variants[k], error))
            return false;
    }
    return compare(&methods_kind, options, variants, n, error);
}

/* ---- installed styles ----------------------------------------------------------------------- */

/* STYLE_COLUMNS frames at equal steps, up to the last. */
static bool show_recording(const FlContactSheet *contact, const FlStyleEntry *entry,
                           const FlStyle *style, int row, GError **error)
{
    const size_t pixels = (size_t)style->width * style->height;
    for (int k = 0; k < STYLE_COLUMNS; k++) {
        const int frame = (k + 1) * style->n_frames / STYLE_COLUMNS - 1;
        const uint8_t *rgb = style->rgb + 3 * pixels * (size_t)MAX(frame, 0);
        g_autoptr(cairo_surface_t) picture =
            fl_surface_of(rgb, 3, style->width, style->height, error);
        if (!picture)
            return false;
        fl_contact_sheet_put(contact, k, row, picture);
    }
    g_autofree char *name =
        g_strdup_printf("%s  %s", entry->name, entry->title ? entry->title : "");
    g_autofree char *medium = fl_text_word(FL_MEDIUM_WORDS, (int)style->medium);
    const bool is_auto = style->medium == FL_MEDIUM_AUTO;
    g_autofree char *lines = g_strdup_printf(
        "%s\n%dx%d, %d frames%s%s", style->character ? style->character : "", style->width,
        style->height, style->n_frames, is_auto ? "" : ", ", is_auto ? "" : medium);
    fl_contact_sheet_name_row(contact, row, name, lines);
    return true;
}

bool fl_style_sheet(const char *path, bool overwrite, GError **error)
{
    g_autoptr(GPtrArray) styles = fl_style_list();
    if (!fl_png_named(path, "sheets are", error) ||
        (!overwrite && !fl_check_not_exists(path, error)))
        return false;
    for (guint k = styles->len; k > 0; k--)
        if (((FlStyleEntry *)styles->pdata[k - 1])->hidden)
            g_ptr_array_remove_index(styles, k - 1);
    g_auto(FlContactSheet) contact = {0};
    if (!fl_contact_sheet_init(&contact, STYLE_COLUMNS, MAX((int)styles->len, 1), 240, 110, error))
        return false;
    for (guint k = 0; k < styles->len; k++) {
        const FlStyleEntry *entry = styles->pdata[k];
        g_autoptr(GError) problem = NULL;
        g_autoptr(FlStyle) style = fl_style_load(entry->path, &problem);
        if (style && !show_recording(&contact, entry, style, (int)k, error))
            return false;
        if (!style)
            fl_contact_sheet_name_row(&contact, (int)k, entry->name, problem->message);
    }
    return fl_contact_sheet_save(&contact, path, overwrite, error);
}
