#include "style/measure.h"

#include "base/surface.h"
#include "io/contact_sheet.h"
#include "io/png.h"

#include <math.h>

/* The sheet is SIDE wide; rows of pictures, then plots beside the text. All in px. */
enum {
    SIDE = 1240,
    GAP = 16,
    LINE = 17,
    COLUMNS = 3,
    CELL = (SIDE - (COLUMNS + 1) * GAP) / COLUMNS,
    PLOT_WIDTH = 300,
    PLOT_HEIGHT = 110,
    ARROWS = 22, // along the longer side of a picture
};

/* Okabe and Ito's colours, which the colour-blind tell apart. */
static const double OUTLINE[3] = {0.84, 0.37, 0}, BORDER[3] = {0, 0.45, 0.70};
static const double ARROW[3] = {0, 0.6, 0.5}, INK[3] = {0.1, 0.1, 0.1}, WARN[3] = {0.75, 0.1, 0.1};

typedef struct Page {
    const FlCheckSheet *sheet;
    cairo_t *cr;
    double scale; // screen px per style px in the pictures
    FlGuides guides;
} Page;

static void colour(cairo_t *cr, const double rgb[3])
{
    cairo_set_source_rgb(cr, rgb[0], rgb[1], rgb[2]);
}

static void write_line(cairo_t *cr, double x, double y, const double rgb[3], const char *text)
{
    colour(cr, rgb);
    cairo_move_to(cr, x, y);
    cairo_show_text(cr, text);
}

/* The position between two pixels at which the distance crosses `level`. */
static double crossing(float a, float b, float level)
{
    return (level - a) / (double)(b - a);
}

/* The iso-line of the distance, by marching squares. */
static void draw_level(const Page *page, float level, const double rgb[3])
{
    const FlGuides *g = &page->guides;
    cairo_t *cr = page->cr;
    for (int y = 0; y + 1 < g->height; y++)
        for (int x = 0; x + 1 < g->width; x++) {
            const float *d = g->distance + (size_t)y * g->width + x;
            const float corner[5] = {d[0], d[1], d[g->width + 1], d[g->width], d[0]};
            const double px[5] = {x, x + 1, x + 1, x, x}, py[5] = {y, y, y + 1, y + 1, y};
            int points = 0;
            for (int k = 0; k < 4; k++) {
                if ((corner[k] < level) == (corner[k + 1] < level))
                    continue;
                const double t = crossing(corner[k], corner[k + 1], level);
                const double cx = 0.5 + px[k] + t * (px[k + 1] - px[k]);
                const double cy = 0.5 + py[k] + t * (py[k + 1] - py[k]);
                (points++ % 2 ? cairo_line_to : cairo_move_to)(cr, cx, cy);
            }
        }
    colour(cr, rgb);
    cairo_set_line_width(cr, 1.3 / page->scale);
    cairo_stroke(cr);
}

static void draw_arrow(const Page *page, double x, double y, double u, double v)
{
    cairo_t *cr = page->cr;
    const double length = hypot(u, v), head = MIN(length / 2, 4 / page->scale);
    if (length * page->scale < 1) {
        cairo_arc(cr, x, y, 0.8 / page->scale, 0, 2 * G_PI);
        cairo_fill(cr);
        return;
    }
    const double ux = u / length, uy = v / length;
    cairo_move_to(cr, x, y);
    cairo_line_to(cr, x + u, y + v);
    cairo_move_to(cr, x + u - head * (ux + 0.6 * uy), y + v - head * (uy - 0.6 * ux));
    cairo_line_to(cr, x + u, y + v);
    cairo_line_to(cr, x + u - head * (ux - 0.6 * uy), y + v - head * (uy + 0.6 * ux));
    cairo_stroke(cr);
}

/* Four times the motion from frame to frame; a dot where paint rests. */
static void draw_flow(const Page *page)
{
    const FlGuides *g = &page->guides;
    const int step = MAX(2, MAX(g->width, g->height) / ARROWS);
    colour(page->cr, ARROW);
    cairo_set_line_width(page->cr, 1.2 / page->scale);
    for (int y = step / 2; y < g->height; y += step)
        for (int x = step / 2; x < g->width; x += step) {
            const size_t p = (size_t)y * g->width + x;
            if (g->mask[p] >= FL_INSIDE)
                draw_arrow(page, x + 0.5, y + 0.5, 4 * g->flow[2 * p], 4 * g->flow[2 * p + 1]);
        }
}

typedef enum Overlay { PLAIN, OUTLINES, FLOW } Overlay;

static bool draw_frame(Page *page, double x, double y, int frame, Overlay overlay, GError **error)
{
    const FlStyle *style = page->sheet->style;
    cairo_t *cr = page->cr;
    const uint8_t *rgb = style->rgb + 3 * (size_t)style->width * style->height * frame;
    g_autoptr(cairo_surface_t) surface = fl_surface_of(rgb, 3, style->width, style->height, error);
    if (!surface || !fl_guide_sequence_get(page->sheet->guides, frame, &page->guides, error))
        return false;
    cairo_save(cr);
    cairo_translate(cr, x, y);
    cairo_scale(cr, page->scale, page->scale);
    cairo_rectangle(cr, 0, 0, style->width, style->height);
    cairo_clip(cr);
    cairo_set_source_surface(cr, surface, 0, 0);
    cairo_paint_with_alpha(cr, overlay == FLOW ? 0.45 : 1);
    if (overlay != PLAIN)
        draw_level(page, 0, OUTLINE);
    if (overlay == OUTLINES)
        draw_level(page, style->border_px, BORDER);
    if (overlay == FLOW)
        draw_flow(page);
    cairo_restore(cr);
    return true;
}

/* The frame in a column: the first, one in the middle, the last. */
static int column_frame(const FlStyle *style, int column)
{
    return (style->n_frames - 1) * column / (COLUMNS - 1);
}

static bool draw_rows(Page *page, double *y, GError **error)
{
    static const char *const titles[] = {
        "frame %d", "frame %d: outline of the mask (orange), end of the border (blue)",
        "frame %d: four times the flow"};
    const FlStyle *style = page->sheet->style;
    for (Overlay overlay = PLAIN; overlay <= FLOW; overlay++) {
        for (int column = 0; column < COLUMNS; column++) {
            const double x = GAP + column * (CELL + GAP);
            const int frame = column_frame(style, column);
            g_autofree char *title = overlay == PLAIN      ? g_strdup_printf(titles[0], frame + 1)
                                     : overlay == OUTLINES ? g_strdup_printf(titles[1], frame + 1)
                                                           : g_strdup_printf(titles[2], frame + 1);
            write_line(page->cr, x, *y + LINE - 5, INK, title);
            if (!draw_frame(page, x, *y + LINE, frame, overlay, error))
                return false;
        }
        *y += LINE + page->scale * style->height + GAP;
    }
    return true;
}

/* Draws a plot's frame and title and moves the origin to its lower left corner. */
static void begin_plot(const Page *page, double x, double y, const char *title)
{
    cairo_t *cr = page->cr;
    write_line(cr, x, y + LINE - 5, INK, title);
    cairo_rectangle(cr, x + 0.5, y + LINE + 0.5, PLOT_WIDTH, PLOT_HEIGHT);
    cairo_set_source_rgb(cr, 0.97, 0.97, 0.97);
    cairo_fill_preserve(cr);
    cairo_set_source_rgb(cr, 0.7, 0.7, 0.7);
    cairo_set_line_width(cr, 1);
    cairo_stroke(cr);
}

static void draw_bars(const Page *page, double x, double y, const char *title, const float *value,
                      int n)
{
    float most = 1e-6f;
    for (int i = 0; i < n; i++)
        most = MAX(most, value[i]);
    begin_plot(page, x, y, title);
    const double step = (double)PLOT_WIDTH / n;
    for (int i = 0; i < n; i++) {
        const double height = value[i] / most * (PLOT_HEIGHT - 8);
        cairo_rectangle(page->cr, x + i * step + 1, y + LINE + PLOT_HEIGHT - height, step - 1,
                        height);
    }
    colour(page->cr, BORDER);
    cairo_fill(page->cr);
}

static void draw_curve(const Page *page, double x, double y, size_t field, double most,
                       const double rgb[3])
{
    const FlMeasures *m = page->sheet->measures;
    for (int i = 0; i < m->n_frames; i++) {
        const float value = *(const float *)((const char *)&m->frame[i] + field);
        const double height = MIN(1, value / most) * PLOT_HEIGHT;
        cairo_line_to(page->cr, x + (i + 0.5) * PLOT_WIDTH / m->n_frames,
                      y + LINE + PLOT_HEIGHT - height);
    }
    colour(page->cr, rgb);
    cairo_set_line_width(page->cr, 2);
    cairo_stroke(page->cr);
}

static void draw_rose(const Page *page, double x, double y)
{
    const FlMeasures *m = page->sheet->measures;
    cairo_t *cr = page->cr;
    begin_plot(page, x, y, "which way the outline faces");
    const double cx = x + PLOT_WIDTH / 2.0, cy = y + LINE + PLOT_HEIGHT / 2.0;
    float most = 1e-6f;
    for (int i = 0; i < FL_OCTANTS; i++)
        most = MAX(most, m->orientation[i]);
    for (int i = 0; i < FL_OCTANTS; i++) {
        const double radius = sqrt(m->orientation[i] / most) * (PLOT_HEIGHT / 2.0 - 4);
        cairo_move_to(cr, cx, cy);
        cairo_arc(cr, cx, cy, radius, (i - 0.45) * G_PI_4, (i + 0.45) * G_PI_4);
        cairo_close_path(cr);
    }
    colour(cr, BORDER);
    cairo_fill(cr);
}

static void draw_plots(const Page *page, double x, double y)
{
    const FlMeasures *m = page->sheet->measures;
    const double next = LINE + PLOT_HEIGHT + GAP / 2.0;
    draw_bars(page, x, y, "paint by speed, 0 to 6 px/frame and faster", m->speed, FL_SPEED_BINS);
    begin_plot(page, x, y + next, "front, 0 to 4 px/frame, over time");
    draw_curve(page, x, y + next, offsetof(FlFrameMeasure, front), FL_TOO_FAST_PX, OUTLINE);
    begin_plot(page, x, y + 2 * next, "of the paint: at rest (blue), moving (orange)");
    draw_curve(page, x, y + 2 * next, offsetof(FlFrameMeasure, resting), 1, BORDER);
    draw_curve(page, x, y + 2 * next, offsetof(FlFrameMeasure, moving), 1, OUTLINE);
    begin_plot(page, x + PLOT_WIDTH + GAP, y, "share of the frame that is paint, over time");
    draw_curve(page, x + PLOT_WIDTH + GAP, y, offsetof(FlFrameMeasure, paint), 1, ARROW);
    begin_plot(page, x + PLOT_WIDTH + GAP, y + next, "change of lightness, 0 to 20 levels");
    draw_curve(page, x + PLOT_WIDTH + GAP, y + next, offsetof(FlFrameMeasure, change), 20, ARROW);
    draw_rose(page, x + PLOT_WIDTH + GAP, y + 2 * next);
}

/* Cuts a line into pieces of at most `width` px at spaces and writes them; returns the next y. */
static double write_wrapped(cairo_t *cr, double x, double y, double width, const double rgb[3],
                            const char *text)
{
    const double indent = width / 16;
    for (const char *rest = text; *rest; y += LINE) {
        const double in = rest == text ? 0 : indent;
        g_autofree char *words = fl_take_words(cr, width - in, &rest);
        write_line(cr, x + in, y, rgb, words);
    }
    return y;
}

static double write_texts(const Page *page, double x, double y)
{
    const FlCheckSheet *sheet = page->sheet;
    const double width = SIDE - GAP - x;
    y += LINE;
    cairo_select_font_face(page->cr, "monospace", CAIRO_FONT_SLANT_NORMAL,
                           CAIRO_FONT_WEIGHT_NORMAL);
    for (guint i = 0; i < sheet->facts->len; i++)
        y = write_wrapped(page->cr, x, y, width, INK, g_ptr_array_index(sheet->facts, i));
    for (guint i = 0; i < sheet->problems->len; i++) {
        g_autofree char *line =
            g_strdup_printf("problem    %s", (char *)g_ptr_array_index(sheet->problems, i));
        y = write_wrapped(page->cr, x, y, width, WARN, line);
    }
    return y;
}

/* Enough for every row: texts may wrap into three lines each. */
static int page_height(const FlCheckSheet *sheet, double scale)
{
    const int lines = 3 * (int)(sheet->facts->len + sheet->problems->len) + 2;
    const int below = MAX(3 * (LINE + PLOT_HEIGHT + GAP), lines * LINE);
    return (int)(3 * (LINE + scale * sheet->style->height + GAP)) + below + 3 * GAP;
}

static bool draw_page(Page *page, double *end, GError **error)
{
    double y = GAP / 2.0;
    cairo_set_source_rgb(page->cr, 1, 1, 1);
    cairo_paint(page->cr);
    cairo_select_font_face(page->cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(page->cr, 12);
    if (!draw_rows(page, &y, error))
        return false;
    draw_plots(page, GAP, y);
    const double text_end = write_texts(page, GAP + 2 * (PLOT_WIDTH + GAP), y);
    *end = MAX(text_end, y + 3 * (LINE + PLOT_HEIGHT + GAP)) + GAP / 2.0;
    return true;
}

bool fl_check_sheet_write(const FlCheckSheet *sheet, const char *path, GError **error)
{
    const FlStyle *style = sheet->style;
    const double scale = MIN((double)CELL / style->width, (double)CELL / style->height);
    const int height = page_height(sheet, scale);
    double end = height;
    g_autoptr(cairo_surface_t) surface = fl_surface_new(CAIRO_FORMAT_RGB24, SIDE, height, error);
    g_autoptr(cairo_t) cr = surface ? cairo_create(surface) : NULL;
    Page page = {sheet, cr, scale, {0}};
    if (!cr || !fl_guides_init(&page.guides, style->width, style->height, error))
        return false;
    const bool drawn = draw_page(&page, &end, error);
    const int used = MIN(height, (int)ceil(end));
    fl_guides_clear(&page.guides);
    g_autofree uint8_t *rgb = drawn ? fl_surface_bytes(surface, 3, used, error) : NULL;
    return rgb && fl_png_write(path, rgb, SIDE, used, 3, error);
}
