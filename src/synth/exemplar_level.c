#include "synth/exemplar_level.h"

#include "base/alloc.h"
#include "synth/spline.h"
#include <math.h>
#include <string.h>

/* True if a pixel of the interior has hardly any paint. These pixels occur at the ends of deep
 * dents in a ragged rim. Copied into a target they make holes, which spread when shapes merge. */
static bool is_bare(const FlPyramid *pyramid, size_t p, const FlPacking *packing)
{
    float apart = 0;
    for (int c = 0; c < 3; c++)
        apart += fabsf(pyramid->plane[FL_PLANE_R + c][p] - packing->paper[c] / 255.0f);
    return apart < packing->bare;
}

static FlTexel pack(const FlPyramid *pyramid, size_t p, const FlPacking *packing)
{
    FlTexel out;
    const float ext_scale = packing->ext_scale * FL_EXT_UNIT;
    for (int c = 0; c < 3; c++)
        out.c[FL_CH_R + c] = fl_texel_channel(pyramid->plane[FL_PLANE_R + c][p]);
    out.c[FL_CH_SHAPE] = fl_texel_channel(pyramid->plane[FL_PLANE_SHAPE][p]);
    out.c[FL_CH_EXT_PLUS] = fl_texel_channel(pyramid->plane[FL_PLANE_EXT_PLUS][p] * ext_scale);
    out.c[FL_CH_EXT_MINUS] = fl_texel_channel(pyramid->plane[FL_PLANE_EXT_MINUS][p] * ext_scale);
    out.c[FL_CH_ANGLE] = fl_pyramid_angle(pyramid, p);
    out.c[FL_CH_SEGMENT] = (uint8_t)fl_segment_of(pyramid->plane[FL_PLANE_INSIDE][p] >= 0.5f,
                                                  pyramid->plane[FL_PLANE_DISTANCE][p],
                                                  packing->border_px, packing->separate);
    return out;
}

/* Takes patches that have bare pixels out of the interior. */
static void leave_bare(FlExemplarLevel *level, const FlPyramid *pyramid, const FlPacking *packing,
                       int t)
{
    const int r = FL_PATCH_RADIUS;
    for (int y = 0; y < level->height && packing->bare > 0; y++)
        for (int x = 0; x < level->width; x++) {
            const size_t p = (size_t)y * level->width + x;
            if (pyramid->plane[FL_PLANE_DISTANCE][p] < packing->border_px ||
                !is_bare(pyramid, p, packing))
                continue;
            for (int ny = MAX(y - r, 0); ny <= MIN(y + r, level->height - 1); ny++)
                for (int nx = MAX(x - r, 0); nx <= MIN(x + r, level->width - 1); nx++) {
                    FlTexel *pixel = (FlTexel *)fl_exemplar_at(level, nx, ny, t);
                    if (pixel->c[FL_CH_SEGMENT] == FL_SEGMENT_INTERIOR)
                        pixel->c[FL_CH_SEGMENT] = FL_SEGMENT_BORDER;
                }
        }
}

/* Padding repeats the nearest pixel but belongs to no segment. */
static void pack_frame(FlExemplarLevel *level, const FlPyramid *pyramid, const FlPacking *packing,
                       int t)
{
    FlTexel *frame = level->pixels + t * level->frame_pixels;
    for (int y = -FL_PAD; y < level->height + FL_PAD; y++) {
        for (int x = -FL_PAD; x < level->width + FL_PAD; x++) {
            const int sx = CLAMP(x, 0, level->width - 1), sy = CLAMP(y, 0, level->height - 1);
            FlTexel packed = pack(pyramid, (size_t)sy * level->width + sx, packing);
            if (sx != x || sy != y)
                packed.c[FL_CH_SEGMENT] = FL_SEGMENT_OUTSIDE;
            frame[(size_t)(y + FL_PAD) * level->pitch + x + FL_PAD] = packed;
        }
    }
}

/* The colours' spline coefficients; planes: scratch for three. */
static void pack_colour(FlExemplarLevel *level, const FlPyramid *pyramid, int t, float *planes)
{
    const size_t pixels = (size_t)level->width * level->height;
    float *const plane[3] = {planes, planes + pixels, planes + 2 * pixels};
    for (int c = 0; c < 3; c++)
        memcpy(plane[c], pyramid->plane[FL_PLANE_R + c], pixels * sizeof(float));
    fl_spline_prefilter(plane, 3, level->width, level->height,
                        level->colour + t * level->frame_pixels + FL_PAD * level->pitch + FL_PAD,
                        (int)level->pitch);
}

void fl_exemplar_level_pack(FlExemplarLevel *level, const FlPyramid *pyramid,
                            const FlPacking *packing, int t, float *planes)
{
    pack_frame(level, pyramid, packing, t);
    leave_bare(level, pyramid, packing, t);
    pack_colour(level, pyramid, t, planes);
}

/* Rotated offsets to the nearest pixel; half a turn negates them. */
static void rotate_offsets(FlExemplarLevel *level)
{
    for (int a = 0; a < FL_ANGLES / 2; a++)
        for (int p = 0; p < FL_PATCH_PIXELS; p += 2) {
            int x, y;
            fl_unrotate((uint8_t)a, fl_patch_offsets[p][0], fl_patch_offsets[p][1], &x, &y);
            const int offset = ((y + 8) >> 4) * (int)level->pitch + ((x + 8) >> 4);
            level->offsets[a][p] = level->offsets[a + FL_ANGLES / 2][p + 1] = (int16_t)offset;
            level->offsets[a][p + 1] = level->offsets[a + FL_ANGLES / 2][p] = (int16_t)-offset;
        }
}

bool fl_exemplar_level_init(FlExemplarLevel *level, int width, int height, int n_frames, int window,
                            GError **error)
{
    level->width = width, level->height = height;
    level->n_frames = n_frames, level->window = window;
    level->pitch = (size_t)width + 2 * FL_PAD;
    level->frame_pixels = level->pitch * ((size_t)height + 2 * FL_PAD);
    const size_t n = level->frame_pixels * (size_t)n_frames;
    if (!(level->pixels = fl_alloc_lazy(n, sizeof *level->pixels, "an exemplar", error)) ||
        !(level->colour = fl_alloc_lazy(n, sizeof *level->colour, "an exemplar", error)) ||
        !(level->offsets = fl_alloc(FL_ANGLES, sizeof *level->offsets, "an exemplar", error)))
        return false;
    rotate_offsets(level);
    return true;
}

static FlSegment segment_at(const FlExemplarLevel *level, int x, int y, int t)
{
    return fl_exemplar_at(level, x, y, t)->c[FL_CH_SEGMENT];
}

void fl_exemplar_level_count(const FlExemplarLevel *level, int t, size_t count[FL_SEGMENTS])
{
    for (int y = 0; y < level->height; y++)
        for (int x = 0; x < level->width; x++)
            count[segment_at(level, x, y, t)]++;
}

void fl_exemplar_level_merge(FlExemplarLevel *level, int t)
{
    for (int y = 0; y < level->height; y++)
        for (int x = 0; x < level->width; x++) {
            FlTexel *pixel = (FlTexel *)fl_exemplar_at(level, x, y, t);
            if (pixel->c[FL_CH_SEGMENT] == FL_SEGMENT_INTERIOR)
                pixel->c[FL_CH_SEGMENT] = FL_SEGMENT_BORDER;
        }
}

bool fl_exemplar_level_list(FlExemplarLevel *level, GError **error)
{
    const int end = level->first + level->window;
    size_t count[FL_SEGMENTS] = {0};
    for (int t = level->first; t < end; t++)
        fl_exemplar_level_count(level, t, count);
    for (FlSegment s = FL_SEGMENT_BORDER; s < FL_SEGMENTS; s++) {
        free(level->valid[s]);
        level->n_valid[s] = 0;
        if (!(level->valid[s] = fl_alloc(count[s], sizeof(uint32_t), "an exemplar", error)))
            return false;
    }
    for (int t = level->first; t < end; t++)
        for (int y = 0; y < level->height; y++)
            for (int x = 0; x < level->width; x++) {
                const FlSegment s = segment_at(level, x, y, t);
                if (s != FL_SEGMENT_OUTSIDE)
                    level->valid[s][level->n_valid[s]++] =
                        (uint32_t)(((size_t)t * level->height + y) * level->width + x);
            }
    return true;
}

void fl_exemplar_level_clear(FlExemplarLevel *level)
{
    free(level->pixels);
    free(level->colour);
    free(level->offsets);
    for (int s = 0; s < FL_SEGMENTS; s++)
        free(level->valid[s]);
    *level = (FlExemplarLevel){0};
}
