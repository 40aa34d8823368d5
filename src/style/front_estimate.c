#include "style/estimate.h"

#include "base/alloc.h"
#include "guides/distance.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DEPTHS 16      // px from the outline for which there are sums
#define INNER_PX 16    // deeper paint is like that of the interior
#define DETAIL_PX 2    // coarser differences are no grain
#define DRY_GRAIN .11f // relative grain of paint that is wholly dry
#define WET_GRAIN .07f // and at most of paint that is wholly wet

/* Sums over paint of some frames: of its density by depth, and in the interior. */
typedef struct Profile {
    double n[DEPTHS], sum[DEPTHS], squares[DEPTHS];
    double n_inner, inner, detail; // detail: of squares
} Profile;

/* The density of paint in levels: its mean difference from the paper. */
static void find_density(const FlStyle *style, int frame, float *density)
{
    const size_t n = (size_t)style->width * (size_t)style->height;
    const uint8_t *rgb = style->rgb + 3 * n * (size_t)frame;
    for (size_t p = 0; p < n; p++) {
        int sum = 0;
        for (int c = 0; c < 3; c++)
            sum += abs(rgb[3 * p + (size_t)c] - style->paper[c]);
        density[p] = (float)sum / 3;
    }
}

static bool add_frame(Profile *profile, const FlStyle *style, int frame, GError **error)
{
    const size_t n = (size_t)style->width * (size_t)style->height;
    g_autofree float *distance = fl_alloc_unset(n, sizeof *distance, "a distance", error);
    g_autofree float *density = distance ? fl_alloc_unset(n, sizeof(float), "paint", error) : NULL;
    g_autofree float *coarse = density ? fl_alloc_unset(n, sizeof(float), "paint", error) : NULL;
    if (!coarse ||
        !fl_distance(style->mask + n * (size_t)frame, style->width, style->height, distance, error))
        return false;
    find_density(style, frame, density);
    memcpy(coarse, density, n * sizeof *coarse);
    if (!fl_blur_recording(coarse, style->width, style->height, DETAIL_PX, error))
        return false;
    for (size_t p = 0; p < n; p++) {
        const double value = (double)density[p], fine = value - (double)coarse[p];
        if (distance[p] >= INNER_PX)
            profile->n_inner++, profile->inner += value, profile->detail += fine * fine;
        else if (distance[p] > 0) {
            const int d = (int)distance[p];
            profile->n[d]++, profile->sum[d] += value, profile->squares[d] += value * value;
        }
    }
    return true;
}

/* Mean and deviation of the density at depths from `first` to before `end`, as shares of the
 * interior's. */
static float density_at(const Profile *profile, int first, int end, float *deviation)
{
    double n = 0, sum = 0, squares = 0;
    for (int d = first; d < end; d++)
        n += profile->n[d], sum += profile->sum[d], squares += profile->squares[d];
    const double mean = sum / MAX(n, 1), inner = profile->inner / MAX(profile->n_inner, 1);
    if (deviation)
        *deviation = (float)(sqrt(MAX(squares / MAX(n, 1) - mean * mean, 0)) / MAX(inner, 1));
    return (float)(mean / MAX(inner, 1));
}

/* The depth from which on paint has a share of the interior's density. */
static float depth_of(const Profile *profile, float share)
{
    float before = 0;
    for (int d = 0; d < DEPTHS; d++) {
        const float now = density_at(profile, d, d + 1, NULL);
        if (now >= share)
            return d == 0 ? 0 : (float)d - (now - share) / MAX(now - before, 1e-3f);
        before = now;
    }
    return DEPTHS;
}

/* The densest depth of the rim. */
static float ridge_of(const Profile *profile)
{
    float most = 0;
    for (int d = 0; d < 10; d++)
        most = MAX(most, density_at(profile, d, d + 1, NULL));
    return most;
}

static float hundredths(float value, float least, float most)
{
    return roundf(100 * CLAMP(value, least, most)) / 100;
}

/* The factors were fitted to the bundled styles, whose numbers were chosen by eye. */
static FlFrontStyle front_of(const Profile *fresh, const Profile *dry)
{
    const float grain = (float)(sqrt(dry->detail / MAX(dry->n_inner, 1)) /
                                MAX(dry->inner / MAX(dry->n_inner, 1), 1));
    const float wet = CLAMP((DRY_GRAIN - grain) / (DRY_GRAIN - WET_GRAIN), 0, 1);
    const float tip = density_at(fresh, 2, 5, NULL);
    const float edge = (depth_of(fresh, .75f) - depth_of(fresh, .25f) + depth_of(dry, .75f) -
                        depth_of(dry, .25f)) /
                       2;
    float uneven;
    density_at(dry, 4, 8, &uneven);
    return (FlFrontStyle){.width = hundredths(wet, 0, 1),
                          .stain = hundredths(.12f + .3f * wet, 0, 1),
                          .film = hundredths(wet * CLAMP(.15f + .75f * tip, .15f, .45f), 0, 1),
                          .soft = hundredths(.14f * (edge - .4f), .06f, .8f),
                          .base = hundredths(.95f - 1.3f * tip, .45f, .9f),
                          .line = hundredths(wet * MAX(1.3f * (ridge_of(dry) - 1), 0), 0, .5f),
                          .fingers = hundredths(.4f + .75f * uneven, .3f, .8f),
                          .granulation = hundredths(.33f + 5 * grain, .3f, .95f)};
}

bool fl_front_estimate(const FlStyle *style, FlFrontStyle *front, GError **error)
{
    const int n = style->n_frames, some = MAX(n / 4, 1);
    Profile fresh = {0}, dry = {0};
    for (int f = 0; f < some; f++)
        if (!add_frame(&fresh, style, f, error) || !add_frame(&dry, style, n - 1 - f, error))
            return false;
    *front = fresh.n_inner > 0 && dry.n_inner > 0 ? front_of(&fresh, &dry)
                                                  : (FlFrontStyle)FL_FRONT_DEFAULTS;
    return true;
}
