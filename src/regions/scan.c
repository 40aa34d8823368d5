#include "regions/scan.h"

#include "base/limits.h"
#include "frames/normalise.h"
#include "regions/raster.h"
#include "regions/register.h"
#include "regions/selfcheck.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_SIDE 32767 // px; cairo's limit
#define THICK 0.03f  // width of a stroke, share of the page's longer side, that is no line any more
#define MOST_WHOLE 8 // groups of a frame that are taken as one, each after another look
#define LOOK_PX 256  // longest side of the small pictures on which a frame is looked over

int fl_strings_add(FlStrings *strings, const char *text)
{
    if (!strings->text) {
        strings->text = g_ptr_array_new_with_free_func(g_free);
        strings->number = g_hash_table_new(g_str_hash, g_str_equal);
        fl_strings_add(strings, "");
    }
    gpointer known = NULL;
    if (g_hash_table_lookup_extended(strings->number, text, NULL, &known))
        return GPOINTER_TO_INT(known);
    const int number = (int)strings->text->len;
    char *copy = g_strdup(text);
    g_ptr_array_add(strings->text, copy);
    g_hash_table_insert(strings->number, copy, GINT_TO_POINTER(number));
    return number;
}

const char *fl_strings_get(const FlStrings *strings, int number)
{
    return g_ptr_array_index(strings->text, number);
}

/** A part being looked at: as FlSeen, but its strings still belong to the frame. */
typedef struct Look {
    FlSeen seen;
    const FlLeaf *leaf;
    char *paint;
    FlBox box; // px of the small picture
} Look;

static void look_clear(void *data)
{
    g_free(((Look *)data)->paint);
}

/** What one thread needs for one frame. */
typedef struct Frame {
    FlSvg *svg;
    double width, height; // of the page in the small picture
    double factor;        // px of the picture per px of the small one
    cairo_surface_t *coverage;
    cairo_surface_t *full; // in the picture's own size; made when first needed
    int full_width, full_height;
    FlBox all;
    GArray *looks;
    FlSelfCheck *check;
} Frame;

/** Draws a part into the frame's coverage. Returns: its box; the caller wipes it. */
static bool cover(Frame *f, const FlLeaf *leaf, FlPart part, FlBox *box, GError **error)
{
    cairo_t *cr = cairo_create(f->coverage);
    const bool drawn = fl_svg_draw(f->svg, leaf, part, cr, f->width, f->height, error);
    cairo_destroy(cr);
    *box = fl_surface_ink(f->coverage, f->all);
    return drawn;
}

static float sum_of(cairo_surface_t *coverage, FlBox box)
{
    const unsigned char *data = cairo_image_surface_get_data(coverage);
    const int stride = cairo_image_surface_get_stride(coverage);
    int64_t sum = 0;
    for (int y = box.y0; y < box.y1; y++)
        for (int x = box.x0; x < box.x1; x++)
            sum += data[(size_t)y * stride + x];
    return (float)sum / 255.0f;
}

/**
 * The box of a part whose look on the small picture does not tell: text, which is shaped anew at
 * each scale, and what is too small to be seen there. Drawn in full size; px of the small picture.
 */
static bool box_in_full(Frame *f, const FlLeaf *leaf, FlPart part, FlBox *box, float *area_px,
                        GError **error)
{
    const FlBox all = {0, 0, f->full_width, f->full_height};
    if (!f->full)
        f->full = fl_surface_new(CAIRO_FORMAT_A8, all.x1, all.y1, error);
    if (!f->full)
        return false;
    cairo_t *cr = cairo_create(f->full);
    const bool drawn =
        fl_svg_draw(f->svg, leaf, part, cr, f->width * f->factor, f->height * f->factor, error);
    cairo_destroy(cr);
    const FlBox ink = fl_surface_ink(f->full, all);
    *area_px = sum_of(f->full, ink);
    fl_surface_wipe(f->full, ink);
    *box = ink.x1 > 0 ? (FlBox){(int)floor(ink.x0 / f->factor), (int)floor(ink.y0 / f->factor),
                                (int)ceil(ink.x1 / f->factor), (int)ceil(ink.y1 / f->factor)}
                      : ink;
    return drawn;
}

/**
 * Widens the box of a stroke by where it is in full size: the pen that cairo draws thick lines of
 * next to no length with has so few corners on a small picture that their caps are cut off.
 */
static void widen(Frame *f, const FlLeaf *leaf, FlBox *box)
{
    const RsvgRectangle r =
        fl_svg_extents(f->svg, leaf, f->width * f->factor, f->height * f->factor);
    const FlBox at =
        fl_box_and(f->all, (FlBox){(int)floor(r.x / f->factor), (int)floor(r.y / f->factor),
                                   (int)ceil((r.x + r.width) / f->factor),
                                   (int)ceil((r.y + r.height) / f->factor)});
    if (box->x1 == 0 || at.x1 == 0)
        return;
    box->x0 = MIN(box->x0, at.x0), box->x1 = MAX(box->x1, at.x1);
    box->y0 = MIN(box->y0, at.y0), box->y1 = MAX(box->y1, at.y1);
}

/** Tells the parts of one leaf, from `first` on, of each other; a fill of no area is no part. */
static void relate_parts(GArray *looks, guint first)
{
    bool fill = false, stroke = false;
    for (guint i = first; i < looks->len; i++) {
        const Look *look = &g_array_index(looks, Look, i);
        *(look->seen.stroke ? &stroke : &fill) = true;
    }
    for (guint i = first; i < looks->len; i++) {
        FlSeen *seen = &g_array_index(looks, Look, i).seen;
        seen->has_fill = fill;
        seen->has_stroke = stroke;
        seen->thick = seen->thick && !fill;
    }
}

static bool look_at(Frame *f, const FlLeaf *leaf, int index, FlWarnings *warnings, const char *file,
                    int number, GError **error)
{
    const guint first = f->looks->len;
    FlPainted parts[FL_MOST_PARTS];
    const int n = fl_svg_paint(f->svg, leaf, parts, error);
    bool good = n >= 0;
    for (int i = 0; i < n; i++) {
        const FlPainted *p = &parts[i];
        Look look = {.leaf = leaf, .paint = p->paint.key};
        look.seen = (FlSeen){.leaf = index,
                             .part = p->part,
                             .stroke = p->stroke,
                             .thick = p->stroke && p->width >= THICK,
                             .kind = p->paint.kind,
                             .alpha = p->paint.alpha,
                             .peak = p->paint.peak,
                             .mix = p->mix,
                             .unit = index < 0 ? -index : 0,
                             .region = -1};
        memcpy(look.seen.rgb, p->paint.rgb, 3);
        good = good && cover(f, leaf, p->part, &look.box, error);
        const float opacity = MAX(p->paint.peak, 1) / 255.0f;
        look.seen.area_px =
            (float)(sum_of(f->coverage, look.box) / opacity * f->factor * f->factor);
        fl_surface_wipe(f->coverage, look.box);
        if (good && (leaf->text || look.box.x1 == 0)) {
            good = box_in_full(f, leaf, p->part, &look.box, &look.seen.area_px, error);
            look.seen.area_px /= opacity;
        }
        if (p->width > 0)
            widen(f, leaf, &look.box);
        if (good && look.box.x1 > 0 && p->paint.alpha > 0)
            g_array_append_val(f->looks, look);
        else
            g_free(look.paint);
    }
    relate_parts(f->looks, first);
    return good;
}

/** Whether any two of the parts from `first` on overlap. */
static bool overlap(const GArray *looks, guint first)
{
    for (guint i = first; i < looks->len; i++)
        for (guint j = i + 1; j < looks->len; j++)
            if (fl_boxes_meet(g_array_index(looks, Look, i).box, g_array_index(looks, Look, j).box))
                return true;
    return false;
}

/** Whether the parts from `first` on, all of a unit, can be drawn one by one: 1, 0, -1 an error. */
static int is_separable(Frame *f, const FlUnit *unit, guint first, GError **error)
{
    if (unit->inseparable)
        return 0;
    if (!overlap(f->looks, first))
        return 1;
    const guint n = f->looks->len - first;
    g_autofree FlPiece *piece = g_new(FlPiece, n);
    for (guint i = 0; i < n; i++) {
        const Look *look = &g_array_index(f->looks, Look, first + i);
        piece[i] = (FlPiece){look->leaf, look->seen.part, look->seen.mix};
    }
    return fl_looks_alike(f->svg, &unit->leaf, piece, (int)n, f->all.x1, f->all.y1, f->width,
                          f->height, error);
}

static bool look_at_leaves(Frame *f, FlWarnings *warnings, const char *file, int number,
                           GError **error)
{
    const FlLeaves *leaves = fl_svg_leaves(f->svg);
    guint unit = 0;
    for (guint i = 0; i < leaves->leaf->len; i++) {
        const guint before = f->looks->len;
        const FlUnit *u =
            unit < leaves->unit->len ? &g_array_index(leaves->unit, FlUnit, unit) : NULL;
        guint end = i + 1;
        if (u && (guint)u->first == i)
            end = i + (guint)u->n;
        else
            u = NULL;
        for (; i < end; i++)
            if (!look_at(f, &g_array_index(leaves->leaf, FlLeaf, i), (int)i, warnings, file, number,
                         error))
                return false;
        i--;
        if (!u)
            continue;
        const int separable = is_separable(f, u, before, error);
        if (separable < 0)
            return false;
        if (!separable) {
            if (u->inseparable)
                g_array_set_size(f->looks, before);
            for (guint k = before; k < f->looks->len; k++)
                g_array_index(f->looks, Look, k).seen.unit = 1 + (int)unit;
            if (!look_at(f, &u->leaf, -1 - (int)unit, warnings, file, number, error))
                return false;
        }
        unit++;
    }
    return true;
}

/** Stacks the parts once more: how much of each lies over others, and the self-check. */
static bool stack(Frame *f, GError **error)
{
    const float page = (float)(f->width * f->height * f->factor * f->factor);
    g_autoptr(cairo_surface_t) below = fl_surface_new(CAIRO_FORMAT_A8, f->all.x1, f->all.y1, error);
    if (!below)
        return false;
    unsigned char *under = cairo_image_surface_get_data(below);
    const unsigned char *mine = cairo_image_surface_get_data(f->coverage);
    const int stride = cairo_image_surface_get_stride(below);
    for (guint i = 0; i < f->looks->len; i++) {
        Look *look = &g_array_index(f->looks, Look, i);
        FlBox box;
        if (look->seen.unit > 0 && look->seen.leaf >= 0)
            continue; // the unit comes after its leaves
        if (!cover(f, look->leaf, look->seen.part, &box, error))
            return false;
        const bool fills_page = look->seen.area_px > 0.95f * page;
        int64_t sum = 0, covered = 0;
        for (int y = box.y0; y < box.y1; y++)
            for (int x = box.x0; x < box.x1; x++) {
                const size_t p = (size_t)y * stride + x;
                sum += mine[p];
                covered += mine[p] * under[p];
                if (!fills_page)
                    under[p] = fl_over(mine[p], under[p]);
            }
        look->seen.covers = sum ? (float)covered / (255.0f * (float)sum) : 0;
        if (!fl_self_check_add(f->check, f->svg, look->leaf, &look->seen, f->coverage, box,
                               f->width, f->height, error))
            return false;
        fl_surface_wipe(f->coverage, box);
    }
    return true;
}

static void keep(FlScan *scan, int t, const Frame *f)
{
    FlStrings *s = &scan->strings;
    GArray *seen = g_array_sized_new(FALSE, FALSE, sizeof(FlSeen), f->looks->len);
    for (guint i = 0; i < f->looks->len; i++) {
        const Look *look = &g_array_index(f->looks, Look, i);
        FlSeen one = look->seen;
        one.paint = fl_strings_add(s, look->paint);
        one.name = fl_strings_add(s, look->leaf->name);
        one.labels = fl_strings_add(s, look->leaf->labels);
        one.layers = fl_strings_add(s, look->leaf->layers);
        one.ids = fl_strings_add(s, look->leaf->ids);
        one.classes = fl_strings_add(s, look->leaf->classes);
        one.tree = fl_strings_add(s, look->leaf->tree);
        const int corner[4] = {look->box.x0 - 1, look->box.y0 - 1, look->box.x1 + 1,
                               look->box.y1 + 1};
        for (int c = 0; c < 4; c++)
            one.box[c] = (float)(corner[c] * f->factor);
        g_array_append_val(seen, one);
    }
    scan->frame[t].seen = seen;
}

static void frame_clear(Frame *f)
{
    if (f->looks)
        g_array_unref(f->looks);
    fl_svg_free(f->svg);
    if (f->coverage)
        cairo_surface_destroy(f->coverage);
    if (f->full)
        cairo_surface_destroy(f->full);
    fl_self_check_free(f->check);
}
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Frame, frame_clear)

/** Opens a frame and sets its page in the picture. */
static bool open_frame(FlScan *scan, int t, Frame *f, FlWarnings *warnings, GError **error)
{
    const char *file = scan->sequence->file[t];
    const int number = scan->sequence->number[t];
    double width, height;
    FlScanFrame *frame = &scan->frame[t];
    const FlSvgOptions options = {frame->canvas, scan->svg.dpi, (const char *const *)frame->whole};
    f->svg = fl_svg_open(file, number, &options, warnings, error);
    if (!f->svg || !fl_svg_size(f->svg, &width, &height, error))
        return false;
    frame->page_width = width * scan->scale;
    frame->page_height = height * scan->scale;
    f->factor = MAX(1, (double)MAX(scan->width, scan->height) / LOOK_PX);
    f->full_width = scan->width;
    f->full_height = scan->height;
    f->width = frame->page_width / f->factor;
    f->height = frame->page_height / f->factor;
    f->all = (FlBox){0, 0, MAX(1, (int)ceil(scan->width / f->factor)),
                     MAX(1, (int)ceil(scan->height / f->factor))};
    f->looks = g_array_new(FALSE, FALSE, sizeof(Look));
    g_array_set_clear_func(f->looks, look_clear);
    f->coverage = fl_surface_new(CAIRO_FORMAT_A8, f->all.x1, f->all.y1, error);
    f->check = f->coverage ? fl_self_check_new(f->all.x1, f->all.y1, error) : NULL;
    return f->check != NULL;
}

/** Draws a frame leaf by leaf and looks whether it is the drawing; see fl_self_check_finish(). */
static FlVerdict try_frame(FlScan *scan, int t, Frame *f, FlWarnings *warnings, char **group,
                           const char **leaf, GError **error)
{
    const char *file = scan->sequence->file[t];
    const int number = scan->sequence->number[t];
    if (!open_frame(scan, t, f, warnings, error) ||
        !look_at_leaves(f, warnings, file, number, error) || !stack(f, error))
        return FL_VERDICT_ERROR;
    return fl_self_check_finish(f->check, f->svg, f->width, f->height, group, leaf, error);
}

/** Takes one more group of a frame as one leaf. */
static void keep_whole(FlScanFrame *frame, const char *group)
{
    const guint n = frame->whole ? g_strv_length(frame->whole) : 0;
    frame->whole = g_renew(char *, frame->whole, n + 2);
    frame->whole[n] = g_strdup(group);
    frame->whole[n + 1] = NULL;
}

static void warn_of_whole(FlWarnings *warnings, const char *file, int number, const char *group)
{
    const bool made = g_str_has_prefix(group, FL_GROUP_ID);
    const int nth = made ? atoi(group + strlen(FL_GROUP_ID)) + 1 : 0;
    g_autofree char *which =
        made ? g_strdup_printf("no. %d of the groups without an id, ", nth) : g_strdup("");
    fl_warnings_add(warnings, file, number, made ? NULL : group,
                    "%sdrawn shape by shape it does not look like the drawing: taken as one",
                    which);
}

/** Looks at a frame, anew for each group that has to stay in one piece [DESIGN §4]. */
static bool scan_frame(FlScan *scan, int t, Frame *f, FlWarnings *warnings, GError **error)
{
    const char *file = scan->sequence->file[t];
    const int number = scan->sequence->number[t];
    FlScanFrame *frame = &scan->frame[t];
    for (int tries = 0;; tries++) {
        g_autofree char *group = NULL;
        const char *leaf = NULL;
        const FlVerdict verdict = try_frame(scan, t, f, warnings, &group, &leaf, error);
        if (verdict == FL_VERDICT_ERROR)
            return false;
        if (verdict == FL_VERDICT_DIFFERS && group && tries < MOST_WHOLE) {
            warn_of_whole(warnings, file, number, group);
            keep_whole(frame, group);
            frame_clear(f);
            *f = (Frame){0};
            continue;
        }
        if (verdict == FL_VERDICT_DIFFERS)
            fl_warnings_add(warnings, file, number, leaf,
                            "drawn leaf by leaf the frame does not look quite like the drawing");
        break;
    }
    if (fabs(frame->page_width - scan->page_width) > 0.5 ||
        fabs(frame->page_height - scan->page_height) > 0.5)
        fl_warnings_add(warnings, file, number, NULL,
                        "its page is not as large as the first frame's; it keeps its scale");
    return true;
}

/**
 * The scale with which the page leaves no column or row of the picture partly bare: one that is
 * would be a contour, with the rim of the paint along it. Less than a pixel of the page is cut off.
 */
static double cover_scale(double scale, double width, double height, double w, double h)
{
    const double rounding = 5e-4; // px; librsvg's own page sizes are off by less
    return width * scale > w - rounding && height * scale > h - rounding
               ? scale
               : MAX(w / width, h / height);
}

/** Decides the size of the picture from the first frame. */
static bool set_size(FlScan *scan, const FlFilmOptions *o, GError **error)
{
    double width, height;
    const FlSvgOptions options = {scan->frame[0].canvas, scan->svg.dpi, NULL};
    g_autoptr(FlSvg) svg =
        fl_svg_open(scan->sequence->file[0], scan->sequence->number[0], &options, NULL, error);
    if (!svg || !fl_svg_size(svg, &width, &height, error))
        return false;
    if (o->scale < 0 || o->width < 0 || o->height < 0 ||
        (o->scale > 0 && (o->width > 0 || o->height > 0))) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "size: expected a width and a height, or a scale, above 0");
        return false;
    }
    scan->scale = o->scale > 0 ? o->scale : 1;
    if (o->width > 0 || o->height > 0)
        scan->scale = MIN(o->width > 0 ? o->width / width : INFINITY,
                          o->height > 0 ? o->height / height : INFINITY);
    const double w = MAX(1, round(width * scan->scale)), h = MAX(1, round(height * scan->scale));
    if (!(w <= MOST_SIDE && h <= MOST_SIDE)) {
        g_set_error(error, FL_ERROR, FL_ERROR_LIMIT,
                    "%s: a picture of %.0f x %.0f px; at most %d px on each side can be drawn",
                    scan->sequence->file[0], w, h, MOST_SIDE);
        return false;
    }
    if (!fl_limit_check(FL_LIMIT_FRAME, w * h / 1e6, scan->sequence->file[0], error))
        return false;
    scan->scale = cover_scale(scan->scale, width, height, w, h);
    scan->page_width = width * scan->scale;
    scan->page_height = height * scan->scale;
    scan->width = (int)w;
    scan->height = (int)h;
    return true;
}

bool fl_scan_init(FlScan *scan, const FlSequence *sequence, const FlFilmOptions *options,
                  FlWarnings *warnings, GError **error)
{
    *scan = (FlScan){.sequence = sequence,
                     .svg = {options->canvas, options->dpi},
                     .n_frames = sequence->n,
                     .frame = g_new0(FlScanFrame, sequence->n)};
    fl_strings_add(&scan->strings, "");
    for (int t = 0; t < scan->n_frames; t++)
        scan->frame[t].canvas = options->canvas;
    if ((options->registered && !fl_register(scan, warnings, error)) ||
        !set_size(scan, options, error))
        return false;
    bool good = true;
#pragma omp parallel for ordered schedule(static, 1)
    for (int t = 0; t < scan->n_frames; t++) {
        g_auto(Frame) frame = {0};
        g_autoptr(FlWarnings) remarks = fl_warnings_new();
        GError *reason = NULL;
        const bool scanned = scan_frame(scan, t, &frame, remarks, &reason);
#pragma omp ordered
        {
            if (scanned)
                keep(scan, t, &frame);
            if (good)
                fl_warnings_append(warnings, remarks);
            if (!scanned && good)
                g_propagate_error(error, reason);
            else
                g_clear_error(&reason);
            good = good && scanned;
        }
    }
    return good;
}

void fl_scan_clear(FlScan *scan)
{
    for (int t = 0; t < scan->n_frames && scan->frame; t++) {
        if (scan->frame[t].seen)
            g_array_unref(scan->frame[t].seen);
        g_strfreev(scan->frame[t].whole);
    }
    g_free(scan->frame);
    if (scan->strings.text) {
        g_hash_table_unref(scan->strings.number);
        g_ptr_array_unref(scan->strings.text);
    }
    *scan = (FlScan){0};
}
