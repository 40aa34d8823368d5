#include "inspect/dump.h"

#include "base/alloc.h"
#include "base/colour_map.h"
#include "guides/flow_file.h"
#include "guides/half_guides.h"
#include "io/atomic_file.h"
#include "io/png.h"
#include <math.h>
#include <string.h>

/* A plane of n floats per pixel, of the guides or of the frame. */
typedef struct Plane {
    const char *name;
    float *values;
    int n;
    float low, high; // drawn as black and white
    bool lengths;    // px of the guides
} Plane;

/* The destination of a frame's dump. */
typedef struct Dump {
    const char *folder;
    const FlPaintedRegion *painted;
    int number;
    int px; // of the frame per px of the guides
} Dump;

static char *file_of(const Dump *dump, const char *name, const char *suffix)
{
    g_autofree char *leaf = g_strdup_printf("%s_%04d%s", name, dump->number, suffix);
    return g_build_filename(dump->folder, dump->painted->name, leaf, NULL);
}

/* The rectangle of the guides, in px of them. */
static FlRect guided(const Dump *dump)
{
    return dump->px == 2 ? fl_rect_halved(dump->painted->rect) : dump->painted->rect;
}

/* Extends a plane of the guides to the whole frame. */
static float *extend_to_frame(const Dump *dump, const Plane *plane, GError **error)
{
    const FlPaintedRegion *painted = dump->painted;
    const FlRect rect = painted->rect, page = {0, 0, painted->width, painted->height};
    const size_t n = (size_t)plane->n, values = n * fl_rect_pixels(page);
    g_autofree float *part = fl_alloc(n * fl_rect_pixels(rect), sizeof *part, "a picture", error);
    float *out = part ? fl_alloc(values, sizeof *out, "a picture", error) : NULL;
    if (!out)
        return NULL;
    fl_plane_repeat(plane->values, rect.width, rect.height, n * sizeof *part, dump->px, part);
    fl_rect_copy(part, rect, out, page, n * sizeof *out);
    for (size_t k = 0; k < values && plane->lengths; k++)
        out[k] *= (float)dump->px;
    return out;
}

static bool write_raw(const Dump *dump, const Plane *plane, GError **error)
{
    const size_t values = (size_t)plane->n * dump->painted->width * dump->painted->height;
    g_autofree char *path = file_of(dump, plane->name, ".f32");
    g_auto(FlAtomicFile) file = {0};
    if (!fl_atomic_open(&file, path, true, error))
        return false;
    fwrite(plane->values, sizeof(float), values, file.stream);
    return fl_atomic_commit(&file, error);
}

static uint8_t grey(float value, float low, float high)
{
    const float share = high > low ? (value - low) / (high - low) : 0;
    return (uint8_t)(CLAMP(share, 0, 1) * 255 + 0.5f);
}

static bool write_picture(const Dump *dump, const Plane *plane, GError **error)
{
    const int width = dump->painted->width, height = dump->painted->height;
    const size_t pixels = (size_t)width * height;
    g_autofree uint8_t *rgb = fl_alloc(3 * pixels, 1, "a picture", error);
    if (!rgb)
        return false;
    for (size_t p = 0; p < pixels; p++) {
        const float *v = plane->values + p * plane->n;
        if (plane->n == 2)
            fl_colour_wheel(v[0], v[1], plane->high, rgb + 3 * p);
        else
            for (int c = 0; c < 3; c++)
                rgb[3 * p + c] = grey(v[plane->n == 1 ? 0 : c], plane->low, plane->high);
    }
    g_autofree char *path = file_of(dump, plane->name, ".png");
    g_autofree char *folder = g_path_get_dirname(path);
    g_mkdir_with_parents(folder, 0777);
    return fl_png_write(path, rgb, width, height, 3, error);
}

static bool write_plane(const Dump *dump, const Plane *plane, GError **error)
{
    Plane shown = *plane;
    g_autofree float *values = shown.values = extend_to_frame(dump, plane, error);
    return values && write_raw(dump, &shown, error) && write_picture(dump, &shown, error);
}

static bool write_flo(const Dump *dump, const Plane *plane, GError **error)
{
    g_autofree char *flo = file_of(dump, plane->name, ".flo");
    g_autofree float *flow = extend_to_frame(dump, plane, error);
    return flow && fl_flow_save(flo, dump->painted->width, dump->painted->height, flow, error);
}

static float largest(const float *values, size_t n)
{
    float most = 0;
    for (size_t k = 0; k < n; k++)
        most = MAX(most, fabsf(values[k]));
    return most;
}

static bool dump_guides(const Dump *dump, const FlGuides *guides, GError **error)
{
    const size_t pixels = (size_t)guides->width * guides->height;
    g_autofree float *mask = fl_alloc(pixels, sizeof(float), "a picture", error);
    if (!mask)
        return false;
    for (size_t p = 0; p < pixels; p++)
        mask[p] = guides->mask[p] / 255.0f;
    const float b = dump->painted->style->border_px, px = (float)dump->px;
    const Plane planes[] = {
        {"mask", mask, 1, 0, 1},
        {"distance", guides->distance, 1, -b, 2 * b, true},
        {"depth", guides->depth, 1, -b, 2 * b, true},
        {"flow", guides->flow, 2, 0, px * largest(guides->flow, 2 * pixels), true},
        {"ext-plus", guides->ext_plus, 1, 0, px * largest(guides->ext_plus, pixels), true},
        {"ext-minus", guides->ext_minus, 1, 0, px * largest(guides->ext_minus, pixels), true},
    };
    for (size_t k = 0; k < G_N_ELEMENTS(planes); k++)
        if (!write_plane(dump, &planes[k], error))
            return false;
    return write_flo(dump, &planes[3], error);
}

/* The motion of the drawing, where it is known. */
static bool dump_motion(const Dump *dump, const FlGuides *guides, GError **error)
{
    const size_t pixels = (size_t)guides->width * guides->height;
    if (!guides->has_motion)
        return true;
    g_autofree float *motion = fl_alloc(2 * pixels, sizeof(float), "a picture", error);
    if (!motion)
        return false;
    for (size_t k = 0; k < 2 * pixels; k++)
        motion[k] = guides->motion[k] == FL_MOTION_UNKNOWN
                        ? NAN
                        : (float)guides->motion[k] * (1.0f / FL_MOTION_ONE);
    return write_flo(dump, &(Plane){"motion", motion, 2, .lengths = true}, error);
}

/* The field in px of the frame; `doubled` has room for one of twice the size. */
static const FlNnf *field_of(const Dump *dump, const FlNnf *nnf, FlNnf *doubled, GError **error)
{
    const FlEnlargement *enlargement = dump->painted->style->exemplar->enlargement;
    g_auto(FlBlocks) all = {0};
    if (!enlargement)
        return nnf;
    if (!fl_nnf_init(doubled, 2 * nnf->width, 2 * nnf->height, error))
        return NULL;
    fl_blocks_init_full(&all, doubled->width, doubled->height);
    fl_nnf_upscale(nnf, fl_enlargement_level(enlargement), &all, doubled);
    return doubled;
}

/* Writes the field in the frame's size and as a picture: x, y and frame as red, green, blue. */
static bool dump_field(const Dump *dump, const FlSynthView *view, GError **error)
{
    const int width = dump->painted->width, height = dump->painted->height;
    const FlExemplarLevel *full = &dump->painted->style->exemplar->level[0];
    const float px = (float)dump->px;
    const FlRect part = dump->painted->rect, r = view->rect;
    const FlRect box = {dump->px * r.x, dump->px * r.y, dump->px * r.width, dump->px * r.height};
    const FlRect rect = fl_rect_and(box, (FlRect){0, 0, part.width, part.height});
    const size_t pixels = (size_t)width * height;
    g_autofree float *field = fl_alloc(4 * pixels, sizeof(float), "a picture", error);
    g_autofree float *shown =
        field ? fl_alloc(3 * pixels, sizeof(float), "a picture", error) : NULL;
    g_auto(FlNnf) doubled = {0};
    const FlNnf *nnf = shown ? field_of(dump, view->nnf, &doubled, error) : NULL;
    if (!nnf)
        return false;
    for (size_t k = 0; k < 4 * pixels; k++)
        field[k] = -1;
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const FlMatch m = nnf->match[(size_t)y * nnf->width + x];
            const size_t p = (size_t)(part.y + rect.y + y) * width + part.x + rect.x + x;
            if (m.frame == FL_NO_MATCH)
                continue;
            field[4 * p] = m.frame;
            field[4 * p + 1] = m.x_16 / 16.0f, field[4 * p + 2] = m.y_16 / 16.0f;
            field[4 * p + 3] = m.theta * (float)(2 * G_PI / FL_ANGLES);
            shown[3 * p] = field[4 * p + 1] / (px * (float)full->width);
            shown[3 * p + 1] = field[4 * p + 2] / (px * (float)full->height);
            shown[3 * p + 2] = field[4 * p] / (float)full->n_frames;
        }
    const Plane raw = {"field", field, 4, 0, 1}, picture = {"field", shown, 3, 0, 1};
    return write_raw(dump, &raw, error) && write_picture(dump, &picture, error);
}

static bool dump_temporal(const Dump *dump, const FlSynthView *view, GError **error)
{
    const FlRect part = guided(dump);
    const size_t pixels = fl_rect_pixels(part);
    g_autofree float *weight = fl_alloc(pixels, sizeof(float), "a picture", error);
    g_autofree float *colour =
        weight ? fl_alloc(3 * pixels, sizeof(float), "a picture", error) : NULL;
    if (!colour)
        return false;
    for (int y = 0; y < view->rect.height; y++) {
        const size_t from = (size_t)y * view->rect.width, row = (size_t)view->rect.width;
        const size_t to = (size_t)(view->rect.y + y) * part.width + view->rect.x;
        memcpy(weight + to, view->temporal_weight + from, row * sizeof(float));
        memcpy(colour + 3 * to, view->temporal + 3 * from, 3 * row * sizeof(float));
    }
    const Plane planes[] = {{"temporal", colour, 3, 0, 1}, {"temporal-weight", weight, 1, 0, 1}};
    return write_plane(dump, &planes[0], error) && write_plane(dump, &planes[1], error);
}

bool fl_dump_frame(const char *folder, const FlPaintedRegion *painted, const FlGuides *guides,
                   int number, GError **error)
{
    const Dump dump = {folder, painted, number, fl_field_px(painted->style->exemplar)};
    if (!dump_guides(&dump, guides, error) || !dump_motion(&dump, guides, error))
        return false;
    if (painted->view.nnf && !dump_field(&dump, &painted->view, error))
        return false;
    return !painted->view.temporal || dump_temporal(&dump, &painted->view, error);
}
