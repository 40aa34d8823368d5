#include "compose/visibility.h"

#include <math.h>
#include <string.h>

typedef struct Gradient {
    int x, y;
} Gradient;

/** A plane of a part of a frame; 0 beyond the part, but beyond the frame it goes on as it ends. */
typedef struct Plane {
    const uint8_t *value;
    FlRect box;
    int width, height; // of the frame
} Plane;

static int at(const Plane *plane, int x, int y)
{
    x = CLAMP(x, 0, plane->width - 1) - plane->box.x;
    y = CLAMP(y, 0, plane->height - 1) - plane->box.y;
    const bool inside = x >= 0 && y >= 0 && x < plane->box.width && y < plane->box.height;
    return inside ? plane->value[(size_t)y * plane->box.width + x] : 0;
}

/** Sobel's, eight times the slope. */
static Gradient gradient(const Plane *p, int x, int y)
{
    const int nw = at(p, x - 1, y - 1), ne = at(p, x + 1, y - 1);
    const int sw = at(p, x - 1, y + 1), se = at(p, x + 1, y + 1);
    const int w = at(p, x - 1, y), e = at(p, x + 1, y);
    const int n = at(p, x, y - 1), s = at(p, x, y + 1);
    return (Gradient){ne + 2 * e + se - nw - 2 * w - sw, sw + 2 * s + se - nw - 2 * n - ne};
}

/** The cosine of the angle between two gradients, in 1/256; 0 if one of them is 0. */
static int cosine(Gradient a, Gradient b)
{
    const int64_t dot = (int64_t)a.x * b.x + (int64_t)a.y * b.y;
    const int64_t squares =
        ((int64_t)a.x * a.x + (int64_t)a.y * a.y) * ((int64_t)b.x * b.x + (int64_t)b.y * b.y);
    /* A square root and a quotient are correctly rounded on every CPU. */
    return squares > 0 ? (int)((double)(dot * 256) / sqrt((double)squares)) : 0;
}

static int mixed_edge(int covered, int above, int cosine256)
{
    const int chance = (covered * (255 - above) + 127) / 255;
    const int beside = MIN(covered, 255 - above), behind = MAX(covered - above, 0);
    return cosine256 < 0 ? chance + (beside - chance) * -cosine256 / 256
                         : chance + (behind - chance) * cosine256 / 256;
}

/** Returns: true if an edge runs through a pixel. */
static bool is_partial(uint8_t value)
{
    return (uint8_t)(value - 1) < 254;
}

/** Pixels but for those through which both edges run, which are marked. */
static void see_plain(const uint8_t *coverage, const uint8_t *above, int n,
                      uint8_t *restrict visible, uint8_t *restrict mixed)
{
    for (int x = 0; x < n; x++) {
        const uint8_t c = coverage[x], u = above[x];
        const uint8_t of_full = c == 255 ? 255 - u : 0;
        visible[x] = u == 0 ? c : of_full;
        mixed[x] = (uint8_t)is_partial(c) & (uint8_t)is_partial(u);
    }
}

void fl_visibility_row(const FlVisibleShape *shape, const uint8_t *above, int width, int height,
                       int row, FlColumns columns, uint8_t *visible)
{
    enum { SOME = 256 }; // pixels at a time
    const FlRect box = shape->area->box;
    const Plane lower = {shape->coverage, box, width, height};
    const Plane upper = {above, {0, 0, width, height}, width, height};
    const int y = box.y + row;
    const uint8_t *coverage = shape->coverage + (size_t)row * (size_t)box.width;
    const uint8_t *hidden = above + (size_t)y * (size_t)width + box.x;
    for (int from = columns.first; from < columns.last; from += SOME) {
        uint8_t mixed[SOME];
        const int n = MIN(SOME, columns.last - from);
        see_plain(coverage + from, hidden + from, n, visible + from, mixed);
        for (FlColumns run = fl_next_run(mixed, 0, n); run.first < run.last;
             run = fl_next_run(mixed, run.last, n))
            for (int column = from + run.first; column < from + run.last; column++)
                if (mixed[column - from]) {
                    const int x = box.x + column;
                    const int angle = cosine(gradient(&lower, x, y), gradient(&upper, x, y));
                    visible[column] = (uint8_t)mixed_edge(coverage[column], hidden[column], angle);
                }
    }
}

/** A square of factors 0..255 around a pixel that belongs to the shape. */
typedef struct Brush {
    int radius;
    uint8_t factor[(2 * FL_SPREAD_MAX_PX + 3) * (2 * FL_SPREAD_MAX_PX + 3)];
} Brush;

/** Full up to gap_px, then an edge one pixel wide. */
static void brush_init(Brush *brush, float gap_px)
{
    brush->radius = MIN((int)ceilf(gap_px + 1.0f), FL_SPREAD_MAX_PX + 1);
    const int side = 2 * brush->radius + 1;
    for (int i = 0; i < side * side; i++) {
        const float x = (float)(i % side - brush->radius), y = (float)(i / side - brush->radius);
        const float t = CLAMP(sqrtf(x * x + y * y) - gap_px, 0.0f, 1.0f);
        brush->factor[i] = (uint8_t)lrintf(255 * (1 - t * t * (3 - 2 * t)));
    }
}

/** Only pixels of the shape with a neighbour that is not full can reach beyond it. */
static bool is_rim(const Plane *plane, int x, int y)
{
    return at(plane, x, y) > 0 && (at(plane, x - 1, y) < 255 || at(plane, x + 1, y) < 255 ||
                                   at(plane, x, y - 1) < 255 || at(plane, x, y + 1) < 255);
}

static void dab(const Brush *brush, int strength, int x, int y, int width, int height,
                uint8_t *matte)
{
    const int r = brush->radius, side = 2 * r + 1;
    for (int yy = MAX(y - r, 0); yy <= MIN(y + r, height - 1); yy++)
        for (int xx = MAX(x - r, 0); xx <= MIN(x + r, width - 1); xx++) {
            const int f = brush->factor[(yy - y + r) * side + xx - x + r] * strength / 255;
            uint8_t *m = matte + (size_t)yy * width + xx;
            *m = (uint8_t)MAX(*m, f);
        }
}

void fl_visibility_spread(const FlVisibleShape *shape, int width, int height, float gap_px,
                          uint8_t *matte)
{
    Brush brush;
    const FlRect box = shape->area->box;
    const Plane plane = {shape->coverage, box, width, height};
    memset(matte, 0, (size_t)width * height);
    fl_rect_copy(shape->coverage, box, matte, (FlRect){0, 0, width, height}, 1);
    brush_init(&brush, gap_px);
    for (int y = box.y; y < box.y + box.height; y++)
        for (int x = box.x; x < box.x + box.width; x++)
            if (is_rim(&plane, x, y))
                dab(&brush, at(&plane, x, y), x, y, width, height, matte);
}
