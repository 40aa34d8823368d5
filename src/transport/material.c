#include "transport/material.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "guides/blur.h"
#include <math.h>
#include <string.h>

#define UNSTRAINED 1.35f // factors by which a pattern may be stretched or squeezed
#define STRAINED 1.9f
#define MOST_STRETCHED 2.0f // factor by which the motion of ink follows
#define LEAST_LENGTH 1e-6f
#define WHOLE 0.75f // of factors, how far from 1 a pixel's is
#define TORN 1.5f
#define SHARED 0.1f // change of a share by px
#define ENDED 0.3f
#define LEAST_INSIDE 0.01f // share of the surroundings of a pixel

void fl_material_clear(FlMaterial *material)
{
    free(material->shift);
    *material = (FlMaterial){0};
}

bool fl_material_motion(const FlGuides *guides, int x, int y, float motion[2])
{
    const size_t p = (size_t)y * (size_t)guides->width + (size_t)x;
    const bool known = guides->has_motion
                           ? guides->mask[p] > 0 && guides->motion[2 * p] != FL_MOTION_UNKNOWN
                           : guides->mask[p] >= FL_INSIDE;
    for (size_t c = 0; motion && c < 2; c++)
        motion[c] = !known               ? 0
                    : guides->has_motion ? (float)guides->motion[2 * p + c] / FL_MOTION_ONE
                                         : guides->flow[2 * p + c];
    return known;
}

/* ---- measuring ---------------------------------------------------------------------------------
 */

/* The gradient of the material at a pixel of the rectangle: the columns of d(material) / d(pixel),
 * by central differences. */
static void gradient(const FlMaterial *material, int x, int y, float f[2][2])
{
    const int width = material->rect.width, height = material->rect.height;
    const int left = MAX(x - 1, 0), right = MIN(x + 1, width - 1);
    const int up = MAX(y - 1, 0), down = MIN(y + 1, height - 1);
    const float across = (float)MAX(right - left, 1), along = (float)MAX(down - up, 1);
    for (int c = 0; c < 2; c++) {
        const float *s = material->shift + c;
        f[c][0] = (s[2 * (y * width + right)] - s[2 * (y * width + left)]) / across + (c == 0);
        f[c][1] = (s[2 * (down * width + x)] - s[2 * (up * width + x)]) / along + (c == 1);
    }
}

/* Of a factor, which is below 0 for what is turned over; near 0 ink stays. */
static float inverse_of(float factor)
{
    return factor / fmaxf(factor * factor, 1 / (MOST_STRETCHED * MOST_STRETCHED));
}

/* A matrix is the sum of a turn with a factor and of a mirroring with one, whose lengths have the
 * singular values as their sum and difference. */
void fl_material_inverse(const FlMaterial *material, int x, int y, float inverse[2][2])
{
    float f[2][2];
    gradient(material, x, y, f);
    const float a = 0.5f * (f[0][0] + f[1][1]), b = 0.5f * (f[1][0] - f[0][1]);
    const float c = 0.5f * (f[0][0] - f[1][1]), d = 0.5f * (f[1][0] + f[0][1]);
    const float turned = sqrtf(a * a + b * b), mirrored = sqrtf(c * c + d * d);
    const float most = inverse_of(turned - mirrored);
    const float least = inverse_of(turned + mirrored);
    const float t = 0.5f * (most + least) / fmaxf(turned, LEAST_LENGTH);
    const float m = 0.5f * (most - least) / fmaxf(mirrored, LEAST_LENGTH);
    inverse[0][0] = t * a - m * c, inverse[1][1] = t * a + m * c;
    inverse[0][1] = t * b - m * d, inverse[1][0] = -t * b - m * d;
}

bool fl_material_is_inside(const FlMaterial *material, const FlGuides *guides, int x, int y)
{
    const FlRect r = material->rect;
    return guides->mask[(size_t)(y + r.y) * (size_t)guides->width + (size_t)(x + r.x)] >= FL_INSIDE;
}

/* The largest and the smallest factor by which the pattern is squeezed; below 0: it is mirrored. */
static void factors_of(float f[2][2], float *most, float *least)
{
    const float det = f[0][0] * f[1][1] - f[0][1] * f[1][0];
    const float square =
        f[0][0] * f[0][0] + f[0][1] * f[0][1] + f[1][0] * f[1][0] + f[1][1] * f[1][1];
    const float sum = sqrtf(square + 2 * det), difference = sqrtf(fmaxf(square - 2 * det, 0));
    *most = 0.5f * (sum + difference), *least = 0.5f * (sum - difference);
}

/* Of one pixel, from the larger of the factors by which its pattern is stretched and squeezed. */
static float strain_of(float f[2][2])
{
    float most, least;
    factors_of(f, &most, &least);
    if (least <= 1 / STRAINED)
        return 1;
    return fl_smooth((fmaxf(most, 1 / least) - UNSTRAINED) / (STRAINED - UNSTRAINED));
}

/* The tear between a pixel and its neighbours: the gradient's excess over theirs. */
static float tear_of(float f[2][2])
{
    float most, least;
    factors_of(f, &most, &least);
    return fl_smooth((fmaxf(most - 1, 1 - least) - WHOLE) / (TORN - WHOLE));
}

/* Less the gradient of the side that is more alike. Returns: whether a side is in the region. */
static bool excess_of(const FlMaterial *material, const FlGuides *guides, const int side[2][2],
                      float f[2][2])
{
    float least = HUGE_VALF, excess[2][2] = {{1, 0}, {0, 1}};
    for (int k = 0; k < 2; k++) {
        const int x = side[k][0], y = side[k][1];
        float g[2][2], more[2][2], square = 0;
        if (x < 0 || y < 0 || x >= material->rect.width || y >= material->rect.height ||
            !fl_material_is_inside(material, guides, x, y))
            continue;
        gradient(material, x, y, g);
        for (int c = 0; c < 4; c++) {
            const float d = f[c / 2][c % 2] - g[c / 2][c % 2];
            more[c / 2][c % 2] = d + (c == 0 || c == 3);
            square += d * d;
        }
        if (square < least)
            least = square, memcpy(excess, more, sizeof excess);
    }
    memcpy(f, excess, sizeof excess);
    return least < HUGE_VALF;
}

/* The tear at a pixel, large where two shapes with different material meet. A shape that is
 * squeezed as a whole has a similar gradient within `reach` px and is not torn. */
static float tear_at(const FlMaterial *material, const FlGuides *guides, int x, int y, int reach)
{
    float f[2][2], across[2][2], along[2][2];
    gradient(material, x, y, f);
    if (tear_of(f) == 0)
        return 0;
    memcpy(across, f, sizeof f), memcpy(along, f, sizeof f);
    const bool beside =
        excess_of(material, guides, (const int[2][2]){{x - reach, y}, {x + reach, y}}, across);
    const bool above =
        excess_of(material, guides, (const int[2][2]){{x, y - reach}, {x, y + reach}}, along);
    return beside || above ? fminf(fmaxf(tear_of(across), tear_of(along)), tear_of(f)) : tear_of(f);
}

/* The same of shares, where a layer ends. */
static float end_of(const FlMaterial *share, int x, int y)
{
    float f[2][2];
    gradient(share, x, y, f);
    return fl_smooth((hypotf(f[1][0], f[1][1] - 1) - SHARED) / (ENDED - SHARED));
}

static void find_tears(const FlMaterial *material, const FlMaterial *share, const FlGuides *guides,
                       int reach, float *tear)
{
    const FlRect r = material->rect;
    for (int y = 0; y < r.height; y++)
        for (int x = 0; x < r.width; x++) {
            if (!fl_material_is_inside(material, guides, x, y))
                continue;
            tear[(size_t)y * (size_t)r.width + (size_t)x] = fmaxf(
                tear_at(material, guides, x, y, reach), share->shift ? end_of(share, x, y) : 0);
        }
}

/* True at the edge of a torn area: the pixels around are not torn as much. */
static bool is_rim(const float *tear, FlRect r, int x, int y)
{
    const float *at = tear + (size_t)y * (size_t)r.width + (size_t)x;
    return x == 0 || y == 0 || x == r.width - 1 || y == r.height - 1 || at[-1] < *at ||
           at[1] < *at || at[-r.width] < *at || at[r.width] < *at || at[-r.width - 1] < *at ||
           at[-r.width + 1] < *at || at[r.width - 1] < *at || at[r.width + 1] < *at;
}

static void spread_tear(FlRect r, int x, int y, float tear, float reach_px, float *whole)
{
    const int reach = (int)reach_px;
    for (int j = MAX(y - reach, 0); j <= MIN(y + reach, r.height - 1); j++)
        for (int i = MAX(x - reach, 0); i <= MIN(x + reach, r.width - 1); i++) {
            const float dx = (float)(i - x), dy = (float)(j - y);
            const float away = sqrtf(dx * dx + dy * dy) / reach_px;
            float *at = whole + (size_t)j * (size_t)r.width + (size_t)i;
            *at = fminf(*at, 1 - tear * (1 - fl_smooth(away)));
        }
}

bool fl_material_whole(const FlMaterial *material, const FlMaterial *share, const FlGuides *guides,
                       float reach_px, float *whole, GError **error)
{
    const FlRect r = material->rect;
    g_autofree float *tear = fl_alloc(fl_rect_pixels(r), sizeof *tear, "a taper", error);
    if (!tear)
        return false;
    find_tears(material, share, guides, MAX((int)reach_px, 1), tear);
    for (size_t p = 0; p < fl_rect_pixels(r); p++)
        whole[p] = 1 - tear[p];
    for (int y = 0; y < r.height; y++)
        for (int x = 0; x < r.width; x++) {
            const float torn = tear[(size_t)y * (size_t)r.width + (size_t)x];
            if (torn > 0 && is_rim(tear, r, x, y))
                spread_tear(r, x, y, torn, reach_px, whole);
        }
    return true;
}

bool fl_material_strain(const FlMaterial *material, const FlGuides *guides, int reach_px,
                        float *strain, GError **error)
{
    const FlRect rect = material->rect;
    const size_t n = fl_rect_pixels(rect);
    g_autofree float *inside = fl_alloc(n, sizeof(float), "a strain", error);
    const float sigma = (float)reach_px / sqrtf(3); // as much spread as a square of that reach
    if (!inside)
        return false;
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t p = (size_t)y * (size_t)rect.width + (size_t)x;
            float f[2][2];
            gradient(material, x, y, f);
            inside[p] = fl_material_is_inside(material, guides, x, y);
            strain[p] = inside[p] > 0 ? strain_of(f) : 0;
        }
    if (!fl_blur(inside, rect.width, rect.height, sigma, error) ||
        !fl_blur(strain, rect.width, rect.height, sigma, error))
        return false;
    for (size_t p = 0; p < n; p++)
        strain[p] /= fmaxf(inside[p], LEAST_INSIDE);
    return true;
}

/* The rigid motion that fits a material best: it puts (u, v) of the material on (x, y) of the
 * frame, turned around that point. */
typedef struct Rigid {
    double cosine, sine, x, y, u, v;
} Rigid;

/* The best fit of the region's pixels, in order, so that the sums are reproducible; without pixels
 * as the material lies in a first frame. */
static Rigid fit_of(const FlMaterial *material, const FlGuides *guides)
{
    const FlRect r = material->rect;
    double n = 0, sx = 0, sy = 0, su = 0, sv = 0, dots = 0, crosses = 0;
    for (int j = 0; j < r.height; j++)
        for (int i = 0; i < r.width; i++)
            if (fl_material_is_inside(material, guides, i, j)) {
                const size_t p = (size_t)j * (size_t)r.width + (size_t)i;
                const double x = i + r.x, y = j + r.y;
                const double u = x + (double)material->shift[2 * p];
                const double v = y + (double)material->shift[2 * p + 1];
                n++, sx += x, sy += y, su += u, sv += v;
                dots += x * u + y * v, crosses += x * v - y * u;
            }
    n = n > 0 ? n : 1;
    const double x = sx / n, y = sy / n, u = su / n, v = sv / n;
    const double dot = dots - n * (x * u + y * v), cross = crosses - n * (x * v - y * u);
    const double length = sqrt(dot * dot + cross * cross);
    return (Rigid){length > 0 ? dot / length : 1, length > 0 ? cross / length : 0, x, y, u, v};
}

bool fl_material_relaxed(const FlMaterial *material, const FlGuides *guides, FlMaterial *relaxed,
                         GError **error)
{
    const FlRect r = material->rect;
    const Rigid lies = fit_of(material, guides);
    *relaxed = (FlMaterial){r, fl_alloc(2 * fl_rect_pixels(r), sizeof(float), "a material", error)};
    if (!relaxed->shift)
        return false;
    for (int j = 0; j < r.height; j++)
        for (int i = 0; i < r.width; i++) {
            float *shift = relaxed->shift + 2 * ((size_t)j * (size_t)r.width + (size_t)i);
            const double x = i + r.x - lies.x, y = j + r.y - lies.y;
            shift[0] = (float)(lies.u + lies.cosine * x - lies.sine * y - (i + r.x));
            shift[1] = (float)(lies.v + lies.sine * x + lies.cosine * y - (j + r.y));
        }
    return true;
}
