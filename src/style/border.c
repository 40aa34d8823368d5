#include "style/estimate.h"

#include "base/alloc.h"
#include "guides/distance.h"

#include <math.h>

enum { DEEPEST = 255 };

/* Sums of colour by depth in whole pixels, of all frames together. */
typedef struct Profile {
    double sum[DEEPEST + 1][3];
    uint64_t n[DEEPEST + 1];
} Profile;

static void add_frame(Profile *profile, const uint8_t *rgb, const uint8_t *mask, const float *depth,
                      size_t pixels)
{
    for (size_t i = 0; i < pixels; i++) {
        if (mask[i] < FL_INSIDE)
            continue;
        const int d = (int)MIN(depth[i], DEEPEST);
        profile->n[d]++;
        for (int c = 0; c < 3; c++)
            profile->sum[d][c] += rgb[3 * i + c];
    }
}

/* The mean colour of the depths `from` … `to`. Returns: false without such pixels. */
static bool mean_colour(const Profile *profile, int from, int to, double mean[3])
{
    double sum[3] = {0}, n = 0;
    for (int d = from; d <= to; d++) {
        n += (double)profile->n[d];
        for (int c = 0; c < 3; c++)
            sum[c] += profile->sum[d][c];
    }
    for (int c = 0; c < 3 && n > 0; c++)
        mean[c] = sum[c] / n;
    return n > 0;
}

/* The depth below which nine tenths of the paint lie: deeper means are those of few pixels. */
static int useful_depth(const Profile *profile)
{
    uint64_t all = 0, sum = 0;
    for (int d = 0; d < DEEPEST; d++)
        all += profile->n[d];
    for (int d = 0; d < DEEPEST; d++)
        if (10 * (sum += profile->n[d]) >= 9 * all)
            return d;
    return 0;
}

static double colour_distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

static float settled_depth(const Profile *profile, int shorter_side)
{
    const int deepest = useful_depth(profile);
    const float limit = (float)shorter_side / 6, least = MIN(3, limit);
    double interior[3] = {0}, mean[3] = {0}, change[DEEPEST + 1] = {0}, most = 0;
    if (deepest < 3 || !mean_colour(profile, deepest * 2 / 3, deepest, interior))
        return limit;
    for (int d = 0; d <= deepest; d++) {
        if (mean_colour(profile, MAX(0, d - 1), d + 1, mean))
            change[d] = colour_distance(mean, interior);
        most = MAX(most, change[d]);
    }
    int settled = deepest;
    while (settled > 0 && change[settled - 1] <= most / 6)
        settled--;
    return CLAMP((float)settled, least, limit);
}

bool fl_border_estimate(const FlClip *clip, const uint8_t *mask, float *border_px, GError **error)
{
    const size_t pixels = (size_t)clip->width * clip->height;
    g_autofree float *depth = fl_alloc(pixels, sizeof(float), "a distance map", error);
    g_autofree Profile *profile = fl_alloc(1, sizeof(Profile), "a profile", error);
    if (!depth || !profile)
        return false;
    for (int frame = 0; frame < clip->n_frames; frame++) {
        if (!fl_distance(mask + frame * pixels, clip->width, clip->height, depth, error))
            return false;
        add_frame(profile, clip->rgb + frame * pixels * 3, mask + frame * pixels, depth, pixels);
    }
    *border_px = settled_depth(profile, MIN(clip->width, clip->height));
    return true;
}
