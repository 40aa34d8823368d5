/* The part of a wash that follows from its shapes: masks, light and shadow, pools. */
#include "base/alloc.h"
#include "base/cpu.h"
#include "compose/wash_field.h"

#include <math.h>
#include <string.h>

/* ---- blur ------------------------------------------------------------------------------------ */

/* Means over 2 * radius + 1 rows; beyond the plane all is 0. */
static void box_rows(const float *plane, int width, int height, int radius, float *means)
{
    const size_t w = (size_t)width;
    const float share = 1 / (float)(2 * radius + 1);
    g_autofree float *sum = g_new0(float, w);
    for (int y = 0; y < MIN(radius, height); y++)
        for (size_t x = 0; x < w; x++)
            sum[x] += plane[(size_t)y * w + x];
    for (int y = 0; y < height; y++) {
        const float *in = y + radius < height ? plane + (size_t)(y + radius) * w : NULL;
        const float *out = y > radius ? plane + (size_t)(y - radius - 1) * w : NULL;
        for (size_t x = 0; in && x < w; x++)
            sum[x] += in[x];
        for (size_t x = 0; out && x < w; x++)
            sum[x] -= out[x];
        for (size_t x = 0; x < w; x++)
            means[(size_t)y * w + x] = sum[x] * share;
    }
}

/* Two boxes, nearly as a Gaussian of sigma rows; room: as large as the plane. */
static void blur_rows(float *plane, int width, int height, float sigma, float *room)
{
    const int radius = (int)(.5f * (sqrtf(6 * sigma * sigma + 1) - 1) + .5f);
    box_rows(plane, width, height, radius, room);
    box_rows(room, width, height, radius, plane);
}

static void transpose(const float *plane, int width, int height, float *turned)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            turned[x * height + y] = plane[y * width + x];
}

/* ---- masks ----------------------------------------------------------------------------------- */

void fl_field_clear(FlWashField *field)
{
    g_free(field->part);
    free(field->planes);
    *field = (FlWashField){0};
}

bool fl_field_alloc(FlWashField *field, GError **error)
{
    FlWash *wash = field->wash;
    const size_t n = fl_wash_points(wash);
    float *own = fl_alloc(n * FL_WASH_PLANES, sizeof *own, "a wash", error);
    for (int k = 0; k < FL_WASH_PLANES; k++)
        wash->plane[k] = own ? own + (size_t)k * n : NULL;
    const size_t own_planes = 8 + FL_WASH_ROOMS;
    float *planes =
        own ? fl_alloc(n * (own_planes + (size_t)field->n_parts), sizeof *planes, "a wash", error)
            : NULL;
    if (!(field->planes = planes))
        return false;
    field->mask = planes, field->side = planes + n, field->around = planes + 2 * n;
    field->turned = planes + 3 * n;
    field->light_at[0] = planes + 6 * n, field->light_at[1] = planes + 7 * n;
    for (size_t k = 0; k < FL_WASH_ROOMS; k++)
        field->room[k] = planes + (8 + k) * n;
    for (int k = 0; k < field->n_parts; k++)
        field->part[k].weight = planes + (own_planes + (size_t)k) * n;
    return true;
}

void fl_field_blur(const FlWashField *field, float *plane, float sigma_px)
{
    const int width = field->wash->width, height = field->wash->height;
    const float sigma = sigma_px * field->input->paper_px / (float)field->wash->step;
    float *turned = field->turned, *room = field->turned + fl_wash_points(field->wash);
    blur_rows(plane, width, height, sigma, room);
    transpose(plane, width, height, turned);
    blur_rows(turned, height, width, sigma, room);
    transpose(turned, height, width, plane);
}

#define LEAK .05f // of what is spread from a point within a shape to one beside it

/* Spreads values from a row into the one beside it: a share goes on as far as points of both lie in
 * a shape. Rows lie apart, so that the compiler vectorises this. */
static void come_from(const float *restrict beside, const float *restrict mask_beside,
                      const float *restrict mask, int n, float share, float *restrict come)
{
    for (int x = 0; x < n; x++) {
        const float own = mask[x], its = mask_beside[x], least = own < its ? own : its;
        come[x] = share * (least > LEAK ? least : LEAK) * beside[x];
    }
}

static void add_row(float *restrict row, const float *restrict more, int n)
{
    for (int x = 0; x < n; x++)
        row[x] += more[x];
}

/* Spreads a plane down and up its rows. room: as large as the plane; come: as long as a row. */
static inline void spread_plane(float *plane, const float *mask, int width, int height, float share,
                                float *room, float *come)
{
    const int n = width * height;
    memcpy(room, plane, (size_t)n * sizeof *room);
    for (int i = width; i < n; i += width) {
        come_from(plane + i - width, mask + i - width, mask + i, width, share, come);
        add_row(plane + i, come, width);
    }
    for (int i = n - 2 * width; i >= 0; i -= width) {
        come_from(room + i + width, mask + i + width, mask + i, width, share, come);
        add_row(plane + i, come, width);
        add_row(room + i, come, width);
    }
}

FL_FOR_EACH_CPU(spread_rows, spread_plane,
                (float *plane, const float *mask, int width, int height, float share, float *room,
                 float *come),
                (plane, mask, width, height, share, room, come))

/* The recursive filter of [GO11] with a deviation of sigma_px of the page, not normalised. */
static void spread(const FlWashField *field, float *plane, float sigma_px)
{
    const int width = field->wash->width, height = field->wash->height;
    const float sigma = sigma_px * field->input->paper_px / (float)field->wash->step;
    float *turned = field->turned, *mask = turned + fl_wash_points(field->wash),
          *room = mask + fl_wash_points(field->wash);
    g_autofree float *come = g_new(float, MAX(width, height));
    transpose(field->mask, width, height, mask);
    for (int k = 0; k < 3; k++) {
        const float share = fl_fall(1.62f * (float)(1 << k) / sigma);
        spread_rows(plane, field->mask, width, height, share, room, come);
        transpose(plane, width, height, turned);
        spread_rows(turned, mask, height, width, share, room, come);
        transpose(turned, height, width, plane);
    }
}

/* The mean of a plane over what a shape holds around each point; around: the mask, spread alike. */
static void mean_inside(const FlWashField *field, float *plane, float sigma_px, const float *around)
{
    const size_t n = fl_wash_points(field->wash);
    for (size_t i = 0; i < n; i++)
        plane[i] *= field->mask[i];
    spread(field, plane, sigma_px);
    for (size_t i = 0; i < n; i++)
        plane[i] /= MAX(around[i], 1e-12f);
}

void fl_field_centre(const FlWashField *field, const float *all, const float *share, float *plane)
{
    const size_t n = fl_wash_points(field->wash);
    float *mean = field->room[0], *around = field->around;
    for (size_t i = 0; i < n; i++)
        mean[i] = all[i], around[i] = field->mask[i] * share[i];
    spread(field, around, 4 * field->size);
    mean_inside(field, mean, 4 * field->size, around);
    for (size_t i = 0; i < n; i++)
        plane[i] -= share[i] * mean[i];
}

/* Adds the coverage of a draw in the square of a step around each point to a plane, 0..1. */
static void add_coverage(const FlWashField *field, const FlDraw *draw, float *plane)
{
    const FlWash *wash = field->wash;
    const FlRect box = draw->area.box;
    const int step = wash->step, half = step / 2;
    const float one = 1 / (255.f * (float)(step * step));
    for (int y = 0; y < box.height; y++) {
        const FlColumns span = fl_area_row(&draw->area, y);
        const uint8_t *row = draw->coverage + (size_t)y * (size_t)box.width;
        const int j = (box.y + y - wash->box.y + half) / step;
        float *to = plane + (size_t)j * (size_t)wash->width;
        for (int x = span.first; x < span.last;) {
            const int i = (box.x + x - wash->box.x + half) / step;
            const int end = MIN(span.last, (i + 1) * step - half - box.x + wash->box.x);
            int sum = 0;
            for (; x < end; x++)
                sum += row[x];
            to[i] += (float)sum * one;
        }
    }
}

void fl_field_fill_masks(const FlWashField *field, const FlWashes *washes, int w,
                         const FlDrawList *draws)
{
    const size_t n = fl_wash_points(field->wash);
    float *own = field->room[0];
    for (int r = draws->n - 1; r >= 0; r--) {
        if (washes->of_draw[r] != w)
            continue;
        memset(own, 0, n * sizeof *own);
        add_coverage(field, &draws->draw[r], own);
        for (size_t i = 0; i < n; i++) {
            own[i] = MIN(own[i], 1 - field->mask[i]);
            field->mask[i] += own[i];
        }
        for (int k = 0; k < field->n_parts; k++)
            for (size_t i = 0; field->part[k].region == draws->draw[r].region && i < n; i++)
                field->part[k].weight[i] += own[i];
    }
    for (int k = 0; field->n_parts > 1 && k < field->n_parts; k++)
        fl_field_blur(field, field->part[k].weight, FL_WASH_JOINT_PX);
}

/* Divides a limb's weights by its distance from each point, in units of the limb's own spread: of
 * parts that touch the nearest one counts most. */
static void weigh_limb(const FlWashField *field, const FlLimb *limb, float *weight)
{
    const FlWash *wash = field->wash;
    const float joint = FL_WASH_JOINT_PX * field->input->paper_px, room = joint * joint / 4;
    const float xx = limb->spread[0] + room, yy = limb->spread[1] + room;
    const float xy = limb->spread[2], area = xx * yy - xy * xy;
    for (int y = 0; y < wash->height; y++)
        for (int x = 0; x < wash->width; x++) {
            const float dx = (float)(wash->box.x + x * wash->step) - limb->x;
            const float dy = (float)(wash->box.y + y * wash->step) - limb->y;
            const float far = .25f * (yy * dx * dx - 2 * xy * dx * dy + xx * dy * dy) / area;
            weight[y * wash->width + x] /= 1e-3f + far * far * far * far * far;
        }
}

void fl_field_divide(const FlWashField *field)
{
    for (int k = 0; k < field->n_parts; k++)
        if (field->part[k].limb)
            weigh_limb(field, field->part[k].limb, field->part[k].weight);
    for (size_t i = 0; field->n_parts > 1 && i < fl_wash_points(field->wash); i++) {
        float all = 0;
        for (int k = 0; k < field->n_parts; k++)
            all += field->part[k].weight[i];
        for (int k = 0; all > 0 && k < field->n_parts; k++)
            field->part[k].weight[i] /= all; // tiny where all limbs are far
    }
}

/* ---- light and shadow, pools ----------------------------------------------------------------- */

void fl_field_find_light(const FlWashField *field)
{
    for (size_t i = 0; i < fl_wash_points(field->wash); i++) {
        float all = 1e-6f, x = all * field->light[0], y = all * field->light[1];
        for (int k = 0; k < field->n_parts; k++) {
            const FlWashPart *part = &field->part[k];
            x += part->weight[i] * part->light[0], y += part->weight[i] * part->light[1];
            all += part->weight[i];
        }
        field->light_at[0][i] = x / all, field->light_at[1][i] = y / all;
    }
}

void fl_field_find_side(const FlWashField *field)
{
    const FlWash *wash = field->wash;
    const float px = (float)wash->step / field->input->paper_px;
    float *along = field->side, *mean = field->room[0], *square = field->room[1];
    const size_t n = fl_wash_points(wash);
    for (size_t i = 0; i < n; i++) {
        const int x = (int)(i % (size_t)wash->width), y = (int)(i / (size_t)wash->width);
        along[i] = px * (field->light_at[0][i] * (float)(x - wash->width / 2) +
                         field->light_at[1][i] * (float)(y - wash->height / 2));
        mean[i] = along[i], square[i] = along[i] * along[i];
    }
    memcpy(field->around, field->mask, n * sizeof *mean);
    spread(field, field->around, field->size);
    mean_inside(field, mean, field->size, field->around);
    mean_inside(field, square, field->size, field->around);
    for (size_t i = 0; i < n; i++) {
        const float strength = hypotf(field->light_at[0][i], field->light_at[1][i]) + 1e-6f;
        const float spread = sqrtf(MAX(square[i] - mean[i] * mean[i], 0)) / strength;
        along[i] = fl_clamp((along[i] - mean[i]) / (1.9f * spread + 2), -1.4f, 1.4f);
    }
}

/* The share of a blur, at each of n points from `first` on of a line, that lies on the page. */
static void find_on_page(const FlWashField *field, int first, int n, int page_px, float sigma_px,
                         float *share)
{
    const int step = field->wash->step, all = page_px / step + 1;
    g_autofree float *line = g_new(float, all);
    g_autofree float *room = g_new(float, all);
    for (int i = 0; i < all; i++)
        line[i] = 1;
    blur_rows(line, 1, all, sigma_px * field->input->paper_px / (float)step, room);
    for (int i = 0; i < n; i++)
        share[i] = line[MIN(first / step + i, all - 1)];
}

/* The mask, blurred; what lies beyond the page is as what lies on it. */
static void blur_mask(const FlWashField *field, float sigma, float *plane)
{
    const FlWash *wash = field->wash;
    const int width = wash->width, height = wash->height;
    g_autofree float *across = g_new(float, width);
    g_autofree float *down = g_new(float, height);
    find_on_page(field, wash->box.x, width, field->input->width, sigma, across);
    find_on_page(field, wash->box.y, height, field->input->height, sigma, down);
    memcpy(plane, field->mask, fl_wash_points(wash) * sizeof *plane);
    fl_field_blur(field, plane, sigma);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            plane[y * width + x] /= MAX(across[x] * down[y], .1f);
}

void fl_field_find_heart(const FlWashField *field, float *heart)
{
    blur_mask(field, .22f * field->size, heart);
    for (size_t i = 0; i < fl_wash_points(field->wash); i++)
        heart[i] = fl_smooth((heart[i] - .6f) / .35f);
}

void fl_field_find_pools(const FlWashField *field, float *pool)
{
    const int width = field->wash->width, height = field->wash->height;
    float *inside = field->room[0];
    blur_mask(field, 1.2f * fl_clamp(.09f * field->size, 5, 20), inside);
    memset(pool, 0, fl_wash_points(field->wash) * sizeof *pool);
    for (int y = 1; y < height - 1; y++)
        for (int x = 1; x < width - 1; x++) {
            const int i = y * width + x;
            const float gx = inside[i + 1] - inside[i - 1],
                        gy = inside[i + width] - inside[i - width];
            const float steep = sqrtf(gx * gx + gy * gy) + 1e-3f;
            const float face =
                (-.6f * field->light_at[0][i] * gx - field->light_at[1][i] * gy) / steep;
            const float edge = fl_clamp(2 - 2 * inside[i], 0, 1);
            pool[i] = fl_clamp(face, 0, 1) * sqrtf(fl_clamp(face, 0, 1)) * edge * edge;
        }
}

void fl_field_find_breadth(const FlWashField *field, float *breadth)
{
    const size_t n = fl_wash_points(field->wash);
    memcpy(breadth, field->mask, n * sizeof *breadth);
    fl_field_blur(field, breadth, 16);
    memcpy(field->room[0], field->mask, n * sizeof *breadth);
    spread(field, field->room[0], 16);
    mean_inside(field, breadth, 16, field->room[0]);
    for (size_t i = 0; i < n; i++)
        breadth[i] = fl_smooth((breadth[i] - .2f) / .35f);
}

void fl_field_find_middle(const FlWashField *field, float *middle)
{
    const size_t n = fl_wash_points(field->wash);
    memcpy(middle, field->mask, n * sizeof *middle);
    fl_field_blur(field, middle, 12);
    for (size_t i = 0; i < n; i++)
        middle[i] = fl_smooth((middle[i] - .9f) / .1f);
}
