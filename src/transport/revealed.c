#include "transport/revealed.h"

#include "base/alloc.h"
#include <math.h>
#include <string.h>

#define APART 0.1f // px that two shapes move differently at least

void fl_revealed_clear(FlRevealed *revealed)
{
    fl_material_clear(&revealed->motion);
    free(revealed->apart);
    *revealed = (FlRevealed){0};
}

static float distance_of(const float *u, const float *v)
{
    return hypotf(u[0] - v[0], u[1] - v[1]);
}

static void read_motion(const FlGuides *guides, FlMaterial *motion)
{
    const FlRect r = motion->rect;
    for (int y = 0; y < r.height; y++)
        for (int x = 0; x < r.width; x++)
            fl_material_motion(guides, x + r.x, y + r.y,
                               motion->shift + 2 * ((size_t)y * (size_t)r.width + (size_t)x));
}

/* ---- the owner of a place ------------------------------------------------------------------- */

/* The source pixels of a pixel in the frame before: the first column and row, and the numbers of
 * columns and rows, within the rectangle. */
static FlRect source_of(const FlMaterial *before, const FlMaterial *now, int x, int y)
{
    const FlRect b = before->rect;
    const float *u = now->shift + 2 * ((size_t)y * (size_t)now->rect.width + (size_t)x);
    const float sx = fminf(fmaxf((float)(x + now->rect.x - b.x) - u[0], 0), (float)(b.width - 1));
    const float sy = fminf(fmaxf((float)(y + now->rect.y - b.y) - u[1], 0), (float)(b.height - 1));
    const int x0 = (int)sx, y0 = (int)sy;
    return (FlRect){x0, y0, 1 + (sx > (float)x0), 1 + (sy > (float)y0)};
}

/* For each place of the frame before: the motion of the claimant that is nearest to the motion at
 * that place. */
typedef struct Claims {
    const FlMaterial *before, *now;
    const FlGuides *guides;
    float *owner, *change; // interleaved motion, and its distance; HUGE_VALF: unclaimed
} Claims;

static const float *motion_now(const Claims *claims, int x, int y)
{
    return claims->now->shift + 2 * ((size_t)y * (size_t)claims->now->rect.width + (size_t)x);
}

static void claim(const Claims *claims, int x, int y)
{
    const float *u = motion_now(claims, x, y);
    const FlRect s = source_of(claims->before, claims->now, x, y);
    for (int j = s.y; j < s.y + s.height; j++)
        for (int i = s.x; i < s.x + s.width; i++) {
            const size_t q = (size_t)j * (size_t)claims->before->rect.width + (size_t)i;
            const float change = distance_of(u, claims->before->shift + 2 * q);
            if (change < claims->change[q]) {
                claims->change[q] = change;
                memcpy(claims->owner + 2 * q, u, 2 * sizeof *u);
            }
        }
}

/* The difference in motion to the next pixel of the same shape, on the more similar side. */
static float step_of(const Claims *claims, int x, int y, int dx, int dy)
{
    const FlRect r = claims->now->rect;
    float least = HUGE_VALF;
    for (int side = -1; side <= 1; side += 2) {
        const int i = x + side * dx, j = y + side * dy;
        if (i >= 0 && j >= 0 && i < r.width && j < r.height &&
            fl_material_motion(claims->guides, i + r.x, j + r.y, NULL))
            least = fminf(least, distance_of(motion_now(claims, x, y), motion_now(claims, i, j)));
    }
    return least < HUGE_VALF ? least : 0;
}

/* The difference in motion to the owner of a pixel's place, if that is another shape; else 0. Those
 * who claim one place are at most two pixels apart, which differ as well in a shape that turns. */
static float apart_of(const Claims *claims, int x, int y)
{
    const float *u = motion_now(claims, x, y);
    const FlRect s = source_of(claims->before, claims->now, x, y);
    const float alike = APART + 2 * (step_of(claims, x, y, 1, 0) + step_of(claims, x, y, 0, 1));
    float most = 0;
    for (int j = s.y; j < s.y + s.height; j++)
        for (int i = s.x; i < s.x + s.width; i++) {
            const size_t q = (size_t)j * (size_t)claims->before->rect.width + (size_t)i;
            const float apart = distance_of(u, claims->owner + 2 * q);
            const float change = distance_of(u, claims->before->shift + 2 * q);
            if (apart > alike && change > 2 * claims->change[q] + APART)
                most = fmaxf(most, apart);
        }
    return most;
}

static bool find(const FlMaterial *before, const FlGuides *guides, FlRevealed *revealed,
                 GError **error)
{
    const FlRect r = revealed->motion.rect;
    const size_t n = fl_rect_pixels(before->rect);
    g_autofree float *owner = fl_alloc(2 * n, sizeof(float), "what is revealed", error);
    g_autofree float *change = fl_alloc(n, sizeof(float), "what is revealed", error);
    if (!owner || !change)
        return false;
    const Claims claims = {before, &revealed->motion, guides, owner, change};
    for (size_t q = 0; q < n; q++)
        change[q] = HUGE_VALF;
    for (int y = 0; y < r.height; y++)
        for (int x = 0; x < r.width; x++)
            if (fl_material_motion(guides, x + r.x, y + r.y, NULL))
                claim(&claims, x, y);
    for (int y = 0; y < r.height; y++)
        for (int x = 0; x < r.width; x++)
            if (fl_material_motion(guides, x + r.x, y + r.y, NULL))
                revealed->apart[(size_t)y * (size_t)r.width + (size_t)x] = apart_of(&claims, x, y);
    return true;
}

bool fl_revealed_find(const FlMaterial *before, const FlGuides *guides, FlRect rect,
                      FlRevealed *revealed, GError **error)
{
    const size_t n = fl_rect_pixels(rect);
    FlMaterial *motion = &revealed->motion;
    *revealed = (FlRevealed){.motion.rect = rect};
    if (!(motion->shift = fl_alloc(2 * n, sizeof(float), "what is revealed", error)) ||
        !(revealed->apart = fl_alloc(n, sizeof(float), "what is revealed", error)))
        return false;
    if (!guides->has_motion)
        return true;
    read_motion(guides, motion);
    return !before->shift || find(before, guides, revealed, error);
}

/* ---- what it is --------------------------------------------------------------------------------
 */

/* The mean shift of the pixels around one that are not waiting and move alike. */
static bool mean_around(const FlRevealed *revealed, const FlGuides *guides, const bool *waits,
                        const float *shift, size_t p, float mean[2])
{
    const FlRect r = revealed->motion.rect;
    const int x = (int)(p % (size_t)r.width), y = (int)(p / (size_t)r.width);
    int n = 0;
    mean[0] = mean[1] = 0;
    for (int j = MAX(y - 1, 0); j <= MIN(y + 1, r.height - 1); j++)
        for (int i = MAX(x - 1, 0); i <= MIN(x + 1, r.width - 1); i++) {
            const size_t q = (size_t)j * (size_t)r.width + (size_t)i;
            const float *u = revealed->motion.shift;
            if (waits[q] || !fl_material_motion(guides, i + r.x, j + r.y, NULL) ||
                distance_of(u + 2 * p, u + 2 * q) > 0.5f * revealed->apart[p])
                continue;
            mean[0] += shift[2 * q], mean[1] += shift[2 * q + 1], n++;
        }
    if (n > 0)
        mean[0] /= (float)n, mean[1] /= (float)n;
    return n > 0;
}

/* Fills one ring around what is known; it counts as known from then on. `list` keeps the rest.
 * Returns: the number of the rest. */
static size_t fill_ring(const FlRevealed *revealed, const FlGuides *guides, size_t *list, size_t n,
                        bool *waits, float *shift)
{
    size_t left = 0, filled = 0;
    for (size_t k = 0; k < n; k++) {
        float mean[2];
        const size_t p = list[k];
        if (mean_around(revealed, guides, waits, shift, p, mean)) {
            memcpy(shift + 2 * p, mean, sizeof mean); // not read while it waits
            list[n + filled++] = p;
        } else
            list[left++] = p;
    }
    for (size_t k = 0; k < filled; k++)
        waits[list[n + k]] = false;
    return left;
}

bool fl_revealed_fill(const FlRevealed *revealed, const FlGuides *guides, float *shift,
                      GError **error)
{
    const size_t pixels = fl_rect_pixels(revealed->motion.rect);
    size_t n = 0;
    for (size_t p = 0; p < pixels; p++)
        n += revealed->apart[p] > 0;
    if (n == 0)
        return true;
    g_autofree bool *waits = fl_alloc(pixels, sizeof *waits, "what is revealed", error);
    g_autofree size_t *list = fl_alloc(2 * n, sizeof *list, "what is revealed", error);
    if (!waits || !list)
        return false;
    n = 0;
    for (size_t p = 0; p < pixels; p++)
        if ((waits[p] = revealed->apart[p] > 0))
            list[n++] = p;
    for (size_t left; n > 0; n = left)
        if ((left = fill_ring(revealed, guides, list, n, waits, shift)) == n)
            break;
    return true;
}
