/* Sheets of styles: a drawing painted in several, and all that are installed. */
#include <fluidy/compare.h>
#include <fluidy/style.h>

#include "base/alloc.h"
#include "base/exists.h"
#include "drawing/open_drawing.h"
#include "io/contact_sheet.h"
#include "io/pattern.h"
#include "io/png.h"
#include "render/render_frames.h"
#include "style/style_folder.h"
#include <string.h>

#define SHOWN_PX 320 // larger side of a frame on the sheet
#define STYLE_COLUMNS 4

/* A comparison: the drawing and the sheet. */
typedef struct Comparison {
    FlRenderOptions options; // complete
    FlConfig *config;
    FlDrawing *drawing;
    FlContactSheet contact;
    char *path;      // of the sheet
    int row, column; // where the next painted frame goes
} Comparison;

static void comparison_clear(Comparison *c)
{
    fl_drawing_free(c->drawing);
    fl_config_free(c->config);
    fl_contact_sheet_clear(&c->contact);
    g_free(c->path);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Comparison, comparison_clear)

/* The sheet's file, free if it must be, before the drawing is read. */
static bool name_sheet(Comparison *c, const FlRenderOptions *complete, GError **error)
{
    const char *wanted = c->options.output;
    g_autoptr(FlSequence) sequence = fl_sequence_from_options(complete, error);
    if (!sequence)
        return false;
    c->path = fl_output_of_film(wanted ? wanted : "fluidy/{name}_styles.png", sequence->name);
    return fl_png_named(c->path, "sheets are", error) &&
           (c->options.overwrite == FL_OVERWRITE_YES || fl_exists_not(c->path, error));
}

static bool comparison_init(Comparison *c, const FlRenderOptions *options, int n_styles,
                            GError **error)
{
    *c = (Comparison){.options = *options};
    if (!c->options.frames)
        c->options.frames = "~1";
    if (!(c->config = fl_config_load(options->config, error)))
        return false;
    FlRenderOptions complete = c->options;
    fl_config_complete(c->config, &complete);
    complete.warning = NULL, complete.note = NULL; // the renders repeat them
    if (!name_sheet(c, &complete, error) ||
        !(c->drawing = fl_drawing_from_options(&complete, c->config, error)))
        return false;
    const int width = fl_drawing_width(c->drawing), height = fl_drawing_height(c->drawing);
    const double scale = MIN(1, (double)SHOWN_PX / MAX(width, height));
    return fl_contact_sheet_init(&c->contact, fl_drawing_frames(c->drawing), 1 + n_styles,
                                 MAX((int)(width * scale), 1), MAX((int)(height * scale), 1),
                                 error);
}

static bool show_drawing(const Comparison *c, GError **error)
{
    const int width = fl_drawing_width(c->drawing), height = fl_drawing_height(c->drawing);
    g_autofree uint8_t *rgba = fl_alloc((size_t)width * height, 4, "a picture", error);
    for (int f = 0; rgba && f < fl_drawing_frames(c->drawing); f++) {
        g_autoptr(FlDrawList) draws = fl_drawing_draw_list(c->drawing, f, error);
        if (!draws)
            return false;
        g_autofree char *name = g_strdup_printf("frame %d", fl_drawing_number(c->drawing, f));
        fl_draw_list_flat(draws, width, height, rgba);
        g_autoptr(cairo_surface_t) picture = fl_surface_of(rgba, 4, width, height, error);
        if (!picture)
            return false;
        fl_contact_sheet_put(&c->contact, f, 0, picture);
        fl_contact_sheet_name_column(&c->contact, f, name);
    }
    fl_contact_sheet_name_row(&c->contact, 0, fl_drawing_name(c->drawing), "the drawing");
    return rgba != NULL;
}

static bool show_frame(void *taker, const FlSinkFrame *frame, int width, int height, GError **error)
{
    Comparison *c = taker;
    g_autoptr(cairo_surface_t) surface = fl_surface_of(frame->rgba, 4, width, height, error);
    if (surface)
        fl_contact_sheet_put(&c->contact, c->column++, c->row, surface);
    return surface != NULL;
}

/* Paints all frames in a style, which comes after the caller's settings and so overrides them. */
static bool paint(Comparison *c, const char *style, int row, GError **error)
{
    g_autofree char *line = g_strdup_printf("style %s", style);
    if (c->options.note)
        c->options.note(line, c->options.data);
    const size_t n = c->options.n_settings;
    g_autofree FlSetting *settings = g_new0(FlSetting, n + 1);
    memcpy(settings, c->options.settings, n * sizeof *settings);
    settings[n] = (FlSetting){.name = "style", .value = style};
    FlRenderOptions options = c->options;
    options.settings = settings, options.n_settings = n + 1;
    options.note = NULL;
    if (row > 1)
        options.warning = NULL; // the drawing's, reported once
    c->row = row, c->column = 0;
    if (!fl_render_frames(&options, show_frame, c, error))
        return false;
    g_autofree char *name = g_path_get_basename(style);
    fl_contact_sheet_name_row(&c->contact, row, name, "");
    return true;
}

bool fl_compare_styles(const FlRenderOptions *options, const char *const *styles, GError **error)
{
    g_auto(Comparison) c = {0};
    const int n = (int)g_strv_length((char **)styles);
    for (int k = 0; k < n; k++) { // find a mistyped one before painting the others
        g_autofree char *path = fl_style_find(styles[k], error);
        if (!path)
            return false;
    }
    if (!comparison_init(&c, options, n, error) || !show_drawing(&c, error))
        return false;
    for (int k = 0; k < n; k++)
        if (!paint(&c, styles[k], k + 1, error))
            return false;
    if (!fl_contact_sheet_save(&c.contact, c.path, options->overwrite == FL_OVERWRITE_YES, error))
        return false;
    g_autofree char *line = g_strdup_printf("%d styles: %s", n, c.path);
    if (options->note)
        options->note(line, options->data);
    return true;
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
    g_autofree char *lines = g_strdup_printf(
        "%s\n%dx%d, %d frames%s%s", style->character ? style->character : "", style->width,
        style->height, style->n_frames, style->medium == FL_MEDIUM_AUTO ? "" : ", ",
        style->medium == FL_MEDIUM_AUTO ? "" : fl_medium_word(style->medium));
    fl_contact_sheet_name_row(contact, row, name, lines);
    return true;
}

bool fl_style_sheet(const char *path, bool overwrite, GError **error)
{
    g_autoptr(GPtrArray) styles = fl_style_list();
    if (!fl_png_named(path, "sheets are", error) || (!overwrite && !fl_exists_not(path, error)))
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
