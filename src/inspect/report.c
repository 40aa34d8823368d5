#include "inspect/report.h"

#include "base/json.h"
#include "inspect/guide_pictures.h"
#include "inspect/page_script.h"
#include "inspect/region_watch.h"
#include "inspect/stats.h"
#include "io/atomic_file.h"
#include "params/text.h"
#include "style/resample.h"
#include <fluidy/fluidy.h>
#include <math.h>

#define MAX_SIDE 480       // px of a picture in the page
#define GOOD_SIDE 240      // the page grows rather than go below
#define MIN_SIDE 120       // frames are left out rather than go below
#define PAGE_PIXELS (6e6)  // of all painted pictures together: a page of about 12 MB
#define MOST_PIXELS (24e6) // the same of long films: decoded, 300 MB in a browser
#define GUIDE_FRAMES 3     // frames whose guides are shown

/* Facts of a painter. */
typedef struct Painter {
    FlFlicker flicker;
    FlFollowedPoint point;
    double seconds; // sum
} Painter;

struct FlReport {
    const FlShapes *shapes;
    const FlOutputs *outputs;
    const FlBackground *background;
    FlAtomicFile file;
    FILE *out;         // its stream
    int width, height; // of the pictures, px
    int every;         // every n-th frame has pictures
    double seconds[3]; // paint, compose, write: sums
    GMutex lock;       // of view and use
    FlGuideView view;
    Painter *painter;
    FlExemplarUse *use; // by recording; those with style NULL are unused
};

/* Chooses the size of the pictures, and how many frames have them, within MOST_PIXELS. */
static void choose_size(FlReport *report)
{
    const int width = report->shapes->page_width, height = report->shapes->page_height;
    const int n = fl_drawing_frames(report->shapes->drawing), larger = MAX(width, height);
    const double smaller = (double)MIN(width, height) / larger;
    const double side = MAX(sqrt(PAGE_PIXELS / (n * smaller)), GOOD_SIDE);
    const double most_side = MIN(sqrt(MOST_PIXELS / (n * smaller)), MAX_SIDE);
    const double shown = MIN(MAX(MIN(side, most_side), MIN_SIDE), larger);
    report->width = MAX((int)(width * shown / larger + 0.5), 1);
    report->height = MAX((int)(height * shown / larger + 0.5), 1);
    const double most = MOST_PIXELS / ((double)report->width * report->height);
    report->every = MAX((int)ceil(n / most), 1);
}

static void write_part(FILE *out, FlPagePart part)
{
    g_autoptr(GBytes) text = fl_page_part(part);
    gsize n = 0;
    const char *data = g_bytes_get_data(text, &n);
    fwrite(data, 1, n, out);
}

static bool begin(FlReport *report, GError **error)
{
    g_autofree char *path = g_build_filename(report->outputs->report, "index.html", NULL);
    if (!fl_atomic_open(&report->file, path, report->outputs->overwrite != FL_OVERWRITE_REFUSE,
                        error))
        return false;
    report->out = report->file.stream;
    write_part(report->out, FL_PAGE_HEAD);
    return true;
}

FlReport *fl_report_new(const FlShapes *shapes, const FlOutputs *outputs,
                        const FlBackground *background, GError **error)
{
    g_autoptr(FlReport) report = g_new0(FlReport, 1);
    report->shapes = shapes, report->outputs = outputs, report->background = background;
    g_mutex_init(&report->lock);
    report->painter = g_new0(Painter, MAX(shapes->n_painted, 1));
    report->use = g_new0(FlExemplarUse, MAX(shapes->n_painted, 1));
    choose_size(report);
    if (!fl_guide_view_init(&report->view, report->width, report->height, error) ||
        !begin(report, error))
        return NULL;
    return g_steal_pointer(&report);
}

void fl_report_free(FlReport *report)
{
    if (!report)
        return;
    for (int p = 0; p < report->shapes->n_painted; p++) {
        fl_flicker_clear(&report->painter[p].flicker);
        fl_exemplar_use_clear(&report->use[p]);
    }
    g_free(report->painter);
    g_free(report->use);
    fl_guide_view_clear(&report->view);
    fl_atomic_clear(&report->file);
    g_mutex_clear(&report->lock);
    g_free(report);
}

/* Returns: true at the middles of equal parts of the film, rounded down to a painted frame. */
static bool shows_guides(const FlReport *report, int frame)
{
    const int n = fl_drawing_frames(report->shapes->drawing);
    for (int k = 0; k < GUIDE_FRAMES; k++) {
        const int middle = (2 * k + 1) * n / (2 * GUIDE_FRAMES);
        if (frame ==
            fl_drawing_shown(report->shapes->drawing, middle - middle % report->shapes->hold))
            return true;
    }
    return false;
}

bool fl_report_wants_view(const FlReport *report, int frame)
{
    return report && shows_guides(report, frame);
}

/* Counts the matches of a region in its recording. */
static bool add_use(FlReport *report, const FlPaintedRegion *painted, GError **error)
{
    FlExemplarUse *use = report->use;
    while (use->style && use->style != painted->style)
        use++;
    if (!use->style && !fl_exemplar_use_init(use, painted->style, error))
        return false;
    fl_exemplar_use_add(use, painted);
    return true;
}

bool fl_report_guides(FlReport *report, int p, const FlPaintedRegion *painted, int frame,
                      const FlGuides *guides, GError **error)
{
    if (!report)
        return true;
    if (frame % painted->settings->hold != 0) { // the picture is the last one
        report->painter[p].flicker.change = 0;
        return true;
    }
    const FlRect rect = painted->rect;
    const bool halved = fl_field_px(painted->style->exemplar) == 2;
    fl_followed_point_move(&report->painter[p].point, halved ? fl_rect_halved(rect) : rect, guides);
    bool done = true;
    if (shows_guides(report, frame)) {
        g_mutex_lock(&report->lock);
        fl_guide_view_add(&report->view, p, painted, guides);
        done = add_use(report, painted, error);
        g_mutex_unlock(&report->lock);
    }
    return done && fl_flicker_measure(&report->painter[p].flicker, painted, guides, error);
}

/* ---- a frame -------------------------------------------------------------------------------- */

static bool write_scaled(const FlReport *report, GString *json, const char *name,
                         const FlPicture *whole, bool opaque, GError **error)
{
    g_autoptr(FlPicture) small = fl_picture_resize(whole, report->width, report->height, error);
    return small && fl_script_picture(json, name, small, opaque, error);
}

static bool write_pictures(const FlReport *report, GString *json, const FlComposite *composite,
                           GError **error)
{
    const FlShapes *shapes = report->shapes;
    const FlPicture after = {shapes->page_width, shapes->page_height, composite->rgba};
    g_autoptr(FlPicture) drawn = fl_picture_new(shapes->width, shapes->height, error);
    if (!drawn || !write_scaled(report, json, "after", &after, report->background->opaque, error))
        return false;
    fl_draw_list_flat(composite->draws, drawn->width, drawn->height, drawn->rgba);
    if (!write_scaled(report, json, "before", drawn, false, error))
        return false;
    fl_draw_list_map(shapes->drawing, composite->draws, drawn->rgba);
    return write_scaled(report, json, "map", drawn, false, error);
}

/* [energy, change, seconds] of each painter. */
static void write_painters(FlReport *report, GString *json, const FlReportFrame *frame)
{
    fl_json_begin(json, "painters", '[');
    for (int p = 0; p < report->shapes->n_painted; p++) {
        const FlPaintedRegion *painted = frame->painted[p];
        const bool searched = painted->stats.n_levels > 0 && painted->stats.level[0].pixels > 0;
        const bool held = frame->frame % painted->settings->hold != 0 ||
                          fl_drawing_shown(report->shapes->drawing, frame->frame) != frame->frame;
        const double seconds = held ? 0 : painted->seconds;
        fl_json_begin(json, NULL, '[');
        fl_json_number(json, NULL, painted->stats.level[0].energy, searched);
        fl_json_number(json, NULL, held ? 0 : report->painter[p].flicker.change, true);
        fl_json_number(json, NULL, seconds, true);
        g_string_append_c(json, ']');
        report->painter[p].seconds += seconds;
    }
    g_string_append_c(json, ']');
}

/* [x, y, turn, found] of each painter's point, or null. In a frame without pictures the points only
 * move; `found` is kept for the next picture. */
static void write_points(FlReport *report, GString *json, bool pictures)
{
    fl_json_begin(json, "points", '[');
    for (int p = 0; p < report->shapes->n_painted; p++) {
        FlFollowedPoint *point = &report->painter[p].point;
        const float px = (float)fl_field_px(report->shapes->painted[p].style->exemplar);
        const float values[] = {px * point->x, px * point->y, point->turn, point->found};
        if (!point->here) {
            fl_json_text(json, NULL, NULL);
            continue;
        }
        fl_json_begin(json, NULL, '[');
        for (size_t k = 0; k < G_N_ELEMENTS(values); k++)
            fl_json_number(json, NULL, (double)values[k], true);
        g_string_append_c(json, ']');
        point->found &= !pictures;
    }
    g_string_append_c(json, ']');
}

static void write_seconds(FlReport *report, GString *json, const FlReportFrame *frame)
{
    const double seconds[] = {frame->paint_s, frame->compose_s, frame->write_s};
    fl_json_begin(json, "seconds", '[');
    for (size_t k = 0; k < G_N_ELEMENTS(seconds); k++) {
        report->seconds[k] += seconds[k];
        fl_json_number(json, NULL, seconds[k], true);
    }
    g_string_append_c(json, ']');
}

bool fl_report_frame(FlReport *report, const FlReportFrame *frame, GError **error)
{
    if (!report)
        return true;
    g_autoptr(GString) json = g_string_new("{");
    const bool pictures = frame->frame % report->every == 0;
    fl_json_number(json, "number", fl_drawing_number(report->shapes->drawing, frame->frame), true);
    write_seconds(report, json, frame);
    write_painters(report, json, frame);
    write_points(report, json, pictures);
    if (pictures && !write_pictures(report, json, frame->composite, error))
        return false;
    if (fl_report_wants_view(report, frame->frame)) {
        if (!fl_guide_view_write(&report->view, json, error))
            return false;
        fl_guide_view_reset(&report->view);
    }
    fl_script_write(report->out, "frames.push(", json, "});");
    return true;
}

/* ---- the whole ------------------------------------------------------------------------------ */

static void write_region(const FlReport *report, GString *json, int r)
{
    const FlShapes *shapes = report->shapes;
    const FlRegion *region = fl_drawing_region(shapes->drawing, r);
    const int p = shapes->painted_of[r];
    uint8_t rgb[3];
    fl_region_colour(shapes->drawing, r, rgb);
    g_autofree char *colour = fl_text_of_colour(rgb);
    fl_json_begin(json, NULL, '{');
    fl_json_text(json, "name", region->name);
    fl_json_text(json, "label", region->label);
    fl_json_text(json, "paint", region->paint);
    fl_json_text(json, "colour", colour);
    fl_json_number(json, "area", region->area_px, true);
    fl_json_number(json, "present", region->n_present, true);
    fl_json_number(json, "painter", p, true);
    if (p >= 0) {
        const FlStyleInstance *style = shapes->painted[p].style;
        g_autofree char *name = g_path_get_basename(style->path);
        fl_json_text(json, "style", name);
        fl_json_number(json, "change", fl_flicker_of_exemplar(style->exemplar), true);
        fl_json_number(json, "seconds", report->painter[p].seconds, true);
    }
    g_string_append_c(json, '}');
}

static void write_size(GString *json, const char *name, int width, int height)
{
    fl_json_begin(json, name, '[');
    fl_json_number(json, NULL, width, true);
    fl_json_number(json, NULL, height, true);
    g_string_append_c(json, ']');
}

static bool write_film(const FlReport *report, GError **error)
{
    const FlShapes *shapes = report->shapes;
    const double fps = report->outputs->fps;
    bool done = true;
    g_autofree char *paper = fl_text_of_colour(report->background->flat);
    g_autoptr(GString) json = g_string_new("{");
    fl_json_text(json, "name", fl_drawing_name(shapes->drawing));
    fl_json_text(json, "output", report->outputs->output);
    fl_json_text(json, "version", fl_version());
    fl_json_text(json, "paper", paper);
    fl_json_number(json, "width", shapes->page_width, true);
    fl_json_number(json, "height", shapes->page_height, true);
    fl_json_number(json, "drawn", shapes->width, true);
    write_size(json, "shown", report->width, report->height);
    fl_json_number(json, "every", report->every, true);
    fl_json_bool(json, "measured", true);
    fl_json_bool(json, "transparent", report->background->none);
    fl_json_number(json, "fps", fps > 0 ? fps : 24, true);
    fl_json_number(json, "peak", fl_peak_mib(), true);
    fl_json_begin(json, "regions", '[');
    for (int r = 0; r < fl_drawing_regions(shapes->drawing); r++)
        write_region(report, json, r);
    g_string_append_c(json, ']');
    fl_json_begin(json, "uses", '[');
    for (int k = 0; k < shapes->n_painted && done; k++)
        if (report->use[k].total > 0)
            done = fl_exemplar_use_write(&report->use[k], json, error);
    g_string_append_c(json, ']');
    fl_script_write(report->out, "film=", json, "};");
    return done;
}

bool fl_report_finish(FlReport *report, GError **error)
{
    if (!report)
        return true;
    if (!write_film(report, error))
        return false;
    write_part(report->out, FL_PAGE_REST);
    return fl_atomic_commit(&report->file, error);
}
