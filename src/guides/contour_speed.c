#include "guides/contour_speed.h"

#include "base/alloc.h"
#include "guides/blur.h"
#include "guides/guides.h"
#include <math.h>
#include <string.h>

#define MOST_GROWTH 0.05f    // of the page's larger side, in a frame
#define MOST_SPEED 0.12f     // likewise
#define ALONG_UNITS 3.0f     // sigma of the Gaussian along the contour
#define AROUND_UNITS 2.0f    // sigma of the blur of the plane
#define MEMORY 0.45f         // of the speed of the frame before
#define LEAST_PX 0.02f       // slower is at rest
#define LEAST_GRADIENT 0.25f // below it a gradient has no direction

/* A pixel of the contour. */
typedef struct Point {
    int x, y;        // in the frame
    float normal[2]; // outwards
    float speed;     // before it is smoothed
} Point;

/* The contour in the rectangle that has a speed. */
typedef struct Contour {
    const FlContourStep *step;
    FlRect rect;
    GArray *points;   // of Point, row by row
    int32_t *nearest; // of rect: the point next to each pixel; -1: no point is near
} Contour;

static void contour_clear(Contour *contour)
{
    if (contour->points)
        g_array_unref(contour->points);
    g_free(contour->nearest);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Contour, contour_clear)

FlRect fl_contour_rect(const FlOutline *outline, float unit_px)
{
    const FlRect frame = {0, 0, outline->frame_width, outline->frame_height};
    return fl_rect_grown(outline->box, (int)ceilf(FL_CONTOUR_REACH * unit_px), frame);
}

/* The distance of an outline at a place between pixels. */
static float distance_at(const FlOutline *outline, float x, float y)
{
    const int width = outline->frame_width;
    const float cx = CLAMP(x, 0, (float)(width - 1));
    const float cy = CLAMP(y, 0, (float)(outline->frame_height - 1));
    const int x0 = (int)cx, y0 = (int)cy;
    const int x1 = MIN(x0 + 1, width - 1), y1 = MIN(y0 + 1, outline->frame_height - 1);
    const float fx = cx - (float)x0, fy = cy - (float)y0;
    const float *above = outline->distance + (size_t)y0 * (size_t)width;
    const float *below = outline->distance + (size_t)y1 * (size_t)width;
    return (1 - fy) * ((1 - fx) * above[x0] + fx * above[x1]) +
           fy * ((1 - fx) * below[x0] + fx * below[x1]);
}

/* The drawing's motion at a pixel of the contour, px; 0 where it is unknown. */
static void motion_at(const FlContourStep *step, int x, int y, float u[2])
{
    const FlRect box = step->now->box;
    const size_t p = (size_t)(y - box.y) * (size_t)box.width + (size_t)(x - box.x);
    for (int c = 0; c < 2; c++) {
        const int32_t fixed = step->motion ? step->motion[2 * p + (size_t)c] : 0;
        u[c] = fixed == FL_MOTION_UNKNOWN ? 0 : (float)fixed / FL_MOTION_ONE;
    }
}

static float last_at(const FlContourStep *step, float x, float y)
{
    const int width = step->now->frame_width, height = step->now->frame_height;
    const int px = CLAMP((int)floorf(x + 0.5f), 0, width - 1);
    const int py = CLAMP((int)floorf(y + 0.5f), 0, height - 1);
    return step->last ? step->last[(size_t)py * (size_t)width + (size_t)px] : 0;
}

/* The speed of a pixel of the contour, if the contour has a direction at the pixel. */
static bool measure(const FlContourStep *step, Point *point)
{
    const FlOutline *now = step->now;
    const float side = FL_CONTOUR_UNITS * step->unit_px;
    float g[2], u[2];
    fl_distance_gradient(now->distance, now->frame_width, now->frame_height, point->x, point->y, g);
    const float length = sqrtf(g[0] * g[0] + g[1] * g[1]);
    if (length < LEAST_GRADIENT)
        return false;
    const float nx = point->normal[0] = -g[0] / length, ny = point->normal[1] = -g[1] / length;
    motion_at(step, point->x, point->y, u);
    const float from_x = (float)point->x - u[0], from_y = (float)point->y - u[1];
    const size_t p = (size_t)point->y * (size_t)now->frame_width + (size_t)point->x;
    const float growth = now->distance[p] - distance_at(step->before, from_x, from_y);
    const float speed =
        u[0] * nx + u[1] * ny + CLAMP(growth, -MOST_GROWTH * side, MOST_GROWTH * side);
    point->speed = (1 - MEMORY) * CLAMP(speed, -MOST_SPEED * side, MOST_SPEED * side) +
                   MEMORY * last_at(step, from_x, from_y);
    return true;
}

/* Lists the contour, and makes each of its pixels the nearest to itself. */
static void find_points(Contour *contour)
{
    const FlRect box = contour->step->now->box, rect = contour->rect;
    for (int y = box.y; y < box.y + box.height; y++)
        for (int x = box.x; x < box.x + box.width; x++) {
            Point point = {.x = x, .y = y};
            if (!fl_outline_is_contour(contour->step->now, x, y) || !measure(contour->step, &point))
                continue;
            contour->nearest[(size_t)(y - rect.y) * (size_t)rect.width + (size_t)(x - rect.x)] =
                (int32_t)contour->points->len;
            g_array_append_val(contour->points, point);
        }
}

/* The mean speed of the contour around a point, of what faces the same way. */
static float smoothed(const Contour *contour, const Point *point, const float *weight, int radius)
{
    const FlRect rect = contour->rect;
    const int x0 = MAX(point->x - radius, rect.x);
    const int x1 = MIN(point->x + radius, rect.x + rect.width - 1);
    const int y0 = MAX(point->y - radius, rect.y);
    const int y1 = MIN(point->y + radius, rect.y + rect.height - 1);
    float sum = 0, norm = 0;
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            const int32_t at =
                contour->nearest[(size_t)(y - rect.y) * (size_t)rect.width + (size_t)(x - rect.x)];
            const Point *other = at < 0 ? point : &g_array_index(contour->points, Point, at);
            const float facing =
                point->normal[0] * other->normal[0] + point->normal[1] * other->normal[1];
            if (at < 0 || facing <= 0)
                continue;
            const float w = facing * weight[abs(x - point->x)] * weight[abs(y - point->y)];
            sum += w * other->speed, norm += w;
        }
    return norm > 0 ? sum / norm : point->speed;
}

/* Smooths along the contour; `nearest` has its pixels alone. Returns: the speeds of the points. */
static float *smooth_points(const Contour *contour, GError **error)
{
    const float sigma = MAX(ALONG_UNITS * contour->step->unit_px, 0.5f);
    const int radius = (int)(2 * sigma + 0.5f), n = (int)contour->points->len;
    g_autofree float *weight = g_new(float, radius + 1);
    float *speed = fl_alloc_unset((size_t)n + 1, sizeof *speed, "a contour", error);
    for (int k = 0; k <= radius; k++)
        weight[k] = expf(-(float)(k * k) / (2 * sigma * sigma));
#pragma omp parallel for schedule(static)
    for (int k = 0; k < (speed ? n : 0); k++)
        speed[k] = smoothed(contour, &g_array_index(contour->points, Point, k), weight, radius);
    return speed;
}

/* Takes the nearest point of a neighbour where that is nearer. */
static void take_nearer(Contour *contour, int x, int y, int dx, int dy)
{
    const FlRect rect = contour->rect;
    const int nx = x + dx, ny = y + dy;
    if (nx < 0 || ny < 0 || nx >= rect.width || ny >= rect.height)
        return;
    int32_t *own = &contour->nearest[(size_t)y * (size_t)rect.width + (size_t)x];
    const int32_t other = contour->nearest[(size_t)ny * (size_t)rect.width + (size_t)nx];
    const int32_t both[2] = {*own, other};
    int apart[2] = {INT_MAX, INT_MAX};
    for (int k = 0; k < 2; k++)
        if (both[k] >= 0) {
            const Point *point = &g_array_index(contour->points, Point, both[k]);
            const int px = point->x - rect.x - x, py = point->y - rect.y - y;
            apart[k] = px * px + py * py;
        }
    if (apart[1] < apart[0])
        *own = other;
}

/* The nearest point of every pixel: two passes over the rectangle, each row forth and back. */
static void spread(Contour *contour)
{
    const int width = contour->rect.width, height = contour->rect.height;
    for (int pass = 0; pass < 2; pass++)
        for (int row = 0; row < height; row++) {
            const int y = pass == 0 ? row : height - 1 - row, dy = pass == 0 ? -1 : 1;
            for (int x = 0; x < width; x++) {
                for (int dx = -1; dx <= 1; dx++)
                    take_nearer(contour, x, y, dx, dy);
                take_nearer(contour, x, y, -1, 0);
            }
            for (int x = width - 1; x >= 0; x--)
                take_nearer(contour, x, y, 1, 0);
        }
}

/* Writes the speed of the nearest point where that is near enough. Returns: whether any moves. */
static bool write_speeds(const Contour *contour, const float *speed, float *plane)
{
    const FlRect rect = contour->rect;
    const float reach = FL_CONTOUR_REACH * contour->step->unit_px;
    bool moves = false;
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t p = (size_t)y * (size_t)rect.width + (size_t)x;
            const int32_t at = contour->nearest[p];
            plane[p] = 0;
            if (at < 0 || fabsf(speed[at]) < LEAST_PX)
                continue;
            const Point *point = &g_array_index(contour->points, Point, at);
            const float px = (float)(point->x - rect.x - x), py = (float)(point->y - rect.y - y);
            if (px * px + py * py > reach * reach)
                continue;
            plane[p] = speed[at];
            moves = true;
        }
    return moves;
}

bool fl_contour_speed(const FlContourStep *step, float *speed, bool *moves, GError **error)
{
    const FlOutline *now = step->now;
    const FlRect frame = {0, 0, now->frame_width, now->frame_height};
    memset(speed, 0, fl_rect_pixels(frame) * sizeof *speed);
    *moves = false;
    if (now->empty || !step->before || step->before->empty)
        return true;
    g_auto(Contour) contour = {.step = step, .rect = fl_contour_rect(now, step->unit_px)};
    const size_t n = fl_rect_pixels(contour.rect);
    contour.points = g_array_new(false, false, sizeof(Point));
    contour.nearest = fl_alloc_unset(n, sizeof *contour.nearest, "a contour", error);
    g_autofree float *plane = fl_alloc_unset(n, sizeof *plane, "a contour", error);
    if (!contour.nearest || !plane)
        return false;
    memset(contour.nearest, -1, n * sizeof *contour.nearest);
    find_points(&contour);
    g_autofree float *of_points = smooth_points(&contour, error);
    if (!of_points)
        return false;
    spread(&contour);
    *moves = write_speeds(&contour, of_points, plane);
    if (!*moves)
        return true;
    if (!fl_blur(plane, contour.rect.width, contour.rect.height, AROUND_UNITS * step->unit_px,
                 error))
        return false;
    fl_rect_copy(plane, contour.rect, speed, frame, sizeof *speed);
    return true;
}
