#include "inspect/report.h"

#include "inspect/exemplar_use.h"
#include "inspect/flicker.h"
#include "inspect/followed_point.h"
#include "inspect/guide_pictures.h"
#include "inspect/page_script.h"
#include "inspect/stats.h"
#include "io/atomic_file.h"
#include "style/resample.h"
#include <errno.h>
#include <fluidy/fluidy.h>
#include <math.h>
#include <string.h>

#define MAX_SIDE 480       // px of a picture in the page
#define GOOD_SIDE 240      // the page grows rather than go below
#define MIN_SIDE 120       // frames are left out rather than go below
#define PAGE_PIXELS (6e6)  // of all painted pictures together: a page of about 12 MB
#define MOST_PIXELS (24e6) // the same of long films: decoded, 300 MB in a browser
#define GUIDE_FRAMES 3     // frames whose guides are shown

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
    FlFlicker *flicker;      // by painter
    FlFollowedPoint *point;  // by painter
    double *painter_seconds; // by painter: sum
    FlExemplarUse *use;      // by recording; those with style NULL are unused
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
    report->flicker = g_new0(FlFlicker, MAX(shapes->n_painted, 1));
    report->point = g_new0(FlFollowedPoint, MAX(shapes->n_painted, 1));
    report->painter_seconds = g_new0(double, MAX(shapes->n_painted, 1));
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
        fl_flicker_clear(&report->flicker[p]);
        fl_exemplar_use_clear(&report->use[p]);
    }
    g_free(report->flicker);
    g_free(report->point);
    g_free(report->use);
    g_free(report->painter_seconds);
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
        report->flicker[p].change = 0;
        return true;
    }
    fl_followed_point_move(&report->point[p], painted->rect, guides);
    bool done = true;
    if (shows_guides(report, frame)) {
        g_mutex_lock(&report->lock);
        fl_guide_view_add(&report->view, p, painted, guides);
        done = add_use(report, painted, error);
        g_mutex_unlock(&report->lock);
    }
    return done && fl_flicker_measure(&report->flicker[p], painted, guides, error);
}

/* ---- a frame -------------------------------------------------------------------------------- */

static bool write_scaled(FlReport *report, const FlPicture *whole, bool opaque, GError **error)
{
    g_autoptr(FlPicture) small = fl_picture_resize(whole, report->width, report->height, error);
    return small && fl_script_picture(report->out, small, opaque, error);
}

static bool write_pictures(FlReport *report, const FlComposite *composite, GError **error)
{
    FILE *out = report->out;
    const FlShapes *shapes = report->shapes;
    const FlPicture after = {shapes->page_width, shapes->page_height, composite->rgba};
    g_autoptr(FlPicture) drawn = fl_picture_new(shapes->width, shapes->height, error);
    if (!drawn)
        return false;
    fputs(",after:", out);
    if (!write_scaled(report, &after, report->background->opaque, error))
        return false;
    fl_draw_list_flat(composite->draws, drawn->width, drawn->height, drawn->rgba);
    fputs(",before:", out);
    if (!write_scaled(report, drawn, false, error))
        return false;
    fl_draw_list_map(shapes->drawing, composite->draws, drawn->rgba);
    fputs(",map:", out);
    return write_scaled(report, drawn, false, error);
}

/* [energy, change, seconds] of each painter. */
static void write_painters(FlReport *report, const FlReportFrame *frame)
{
    FILE *out = report->out;
    fputs(",painters:[", out);
    for (int p = 0; p < report->shapes->n_painted; p++) {
        const FlPaintedRegion *painted = frame->painted[p];
        const bool searched = painted->stats.n_levels > 0 && painted->stats.level[0].pixels > 0;
        fputs(p > 0 ? ",[" : "[", out);
        fl_script_number(out, searched ? painted->stats.level[0].energy : NAN);
        fputc(',', out);
        const bool held = frame->frame % painted->settings->hold != 0 ||
                          fl_drawing_shown(report->shapes->drawing, frame->frame) != frame->frame;
        fl_script_number(out, held ? 0 : report->flicker[p].change);
        fputc(',', out);
        fl_script_number(out, held ? 0 : painted->seconds);
        report->painter_seconds[p] += held ? 0 : painted->seconds;
        fputc(']', out);
    }
    fputc(']', out);
}

/* [x, y, turn, found] of each painter's point, or null. In a frame without pictures the points only
 * move; `found` is kept for the next picture. */
static void write_points(FlReport *report, bool pictures)
{
    FILE *out = report->out;
    fputs(",points:[", out);
    for (int p = 0; p < report->shapes->n_painted; p++) {
        FlFollowedPoint *point = &report->point[p];
        const float values[] = {point->x, point->y, point->turn, point->found};
        fputs(p > 0 ? "," : "", out);
        for (size_t k = 0; k < G_N_ELEMENTS(values) && point->here; k++) {
            fputc(k > 0 ? ',' : '[', out);
            fl_script_number(out, (double)values[k]);
        }
        fputs(point->here ? "]" : "null", out);
        point->found &= !pictures;
    }
    fputc(']', out);
}

static void write_seconds(FlReport *report, const FlReportFrame *frame)
{
    const double seconds[] = {frame->paint_s, frame->compose_s, frame->write_s};
    fputs(",seconds:[", report->out);
    for (size_t k = 0; k < G_N_ELEMENTS(seconds); k++) {
        report->seconds[k] += seconds[k];
        fputs(k > 0 ? "," : "", report->out);
        fl_script_number(report->out, seconds[k]);
    }
    fputc(']', report->out);
}

bool fl_report_frame(FlReport *report, const FlReportFrame *frame, GError **error)
{
    if (!report)
        return true;
    FILE *out = report->out;
    fprintf(out, "<script>frames.push({number:%d",
            fl_drawing_number(report->shapes->drawing, frame->frame));
    write_seconds(report, frame);
    write_painters(report, frame);
    const bool pictures = frame->frame % report->every == 0;
    write_points(report, pictures);
    if (pictures && !write_pictures(report, frame->composite, error))
        return false;
    if (fl_report_wants_view(report, frame->frame)) {
        fputs(",guides:", out);
        if (!fl_guide_view_write(&report->view, out, error))
            return false;
        fl_guide_view_reset(&report->view);
    }
    fputs("});</script>\n", out);
    return true;
}

/* ---- the whole ------------------------------------------------------------------------------ */

static void write_region(const FlReport *report, int r)
{
    FILE *out = report->out;
    const FlShapes *shapes = report->shapes;
    const FlRegion *region = fl_drawing_region(shapes->drawing, r);
    const int p = shapes->painted_of[r];
    uint8_t rgb[3];
    fl_region_colour(shapes->drawing, r, rgb);
    fputs("{name:", out);
    fl_script_string(out, region->name);
    fputs(",label:", out);
    fl_script_string(out, region->label);
    fputs(",paint:", out);
    fl_script_string(out, region->paint);
    fputs(",colour:", out);
    fl_script_colour(out, rgb);
    fputs(",area:", out);
    fl_script_number(out, region->area_px);
    fprintf(out, ",present:%d,painter:%d", region->n_present, p);
    if (p >= 0) {
        g_autofree char *style = g_path_get_basename(shapes->painted[p].style->path);
        fputs(",style:", out);
        fl_script_string(out, style);
        fputs(",change:", out);
        fl_script_number(out, fl_flicker_of_exemplar(shapes->painted[p].style->exemplar));
        fputs(",seconds:", out);
        fl_script_number(out, report->painter_seconds[p]);
    }
    fputs("}", out);
}

static void write_regions(const FlReport *report)
{
    fputs("regions:[", report->out);
    for (int r = 0; r < fl_drawing_regions(report->shapes->drawing); r++) {
        fputs(r > 0 ? "," : "", report->out);
        write_region(report, r);
    }
    fputs("]", report->out);
}

static bool write_uses(const FlReport *report, GError **error)
{
    FILE *out = report->out;
    const char *comma = "";
    fputs(",uses:[", out);
    for (int k = 0; k < report->shapes->n_painted; k++) {
        if (report->use[k].total == 0)
            continue;
        fputs(comma, out);
        if (!fl_exemplar_use_write(&report->use[k], out, error))
            return false;
        comma = ",";
    }
    fputs("]", out);
    return true;
}

static bool write_film(const FlReport *report, GError **error)
{
    FILE *out = report->out;
    const FlShapes *shapes = report->shapes;
    const double fps = report->outputs->fps;
    fputs("<script>film={name:", out);
    fl_script_string(out, fl_drawing_name(shapes->drawing));
    fputs(",output:", out);
    fl_script_string(out, report->outputs->output);
    fputs(",version:", out);
    fl_script_string(out, fl_version());
    fputs(",paper:", out);
    fl_script_colour(out, report->background->flat);
    fprintf(out,
            ",width:%d,height:%d,drawn:%d,shown:[%d,%d],every:%d,measured:true,"
            "transparent:%s,fps:",
            shapes->page_width, shapes->page_height, shapes->width, report->width, report->height,
            report->every, report->background->none ? "true" : "false");
    fl_script_number(out, fps > 0 ? fps : 24);
    fputs(",peak:", out);
    fl_script_number(out, fl_peak_mib());
    fputs(",", out);
    write_regions(report);
    const bool done = write_uses(report, error);
    fputs("};</script>\n", out);
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
