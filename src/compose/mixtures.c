/* Finds the mixture of two pigments that is nearest to a fill, and the drift of its hue when one of
 * them prevails. */
#include "base/colour_difference.h"
#include "compose/kubelka_munk.h"
#include "compose/pigments.h"

#include <glib.h>
#include <math.h>
#include <stdbool.h>

#define SHARES 9
#define THICKNESSES 24
#define THINNEST .03
#define THICKEST 6.0
#define OF_COMPLEMENTS 12 // of the distance
#define DRIFT .12         // of the share, to both sides
#define MOST_TURN .035f   // of a channel, by one CIE76

typedef struct Candidate {
    uint8_t pigment[2], share, thickness;
    float lab[3];
} Candidate;

/* On the paper of most styles: pigments are chosen as for white paper, whatever paint lies on. */
static const uint8_t paper[3] = {245, 240, 230};

/* The mixtures of all fills so far, for all films and threads. */
static GMutex mutex;
static Candidate *candidates;
static int n_candidates;
static GHashTable *found; // FlMixture by fill

/* Reflectances are taken as sRGB levels, as the pigments' K and S were fitted [C97]. */
static void colour_of(const FlPigment *const pigment[2], double share, double thickness,
                      float level[3])
{
    for (int c = 0; c < 3; c++) {
        const double k = (1 - share) * (double)pigment[0]->absorption[c] +
                         share * (double)pigment[1]->absorption[c];
        const double s = (1 - share) * (double)pigment[0]->scattering[c] +
                         share * (double)pigment[1]->scattering[c];
        const FlKmLayer ground = {paper[c] / 255.0, 0};
        level[c] = (float)(255 * fl_km_over(fl_km_layer(k, s, thickness), ground).reflectance);
    }
}

static double share_of(int i)
{
    return i / (SHARES - 1.0);
}

static double thickness_of(int i)
{
    return THINNEST * pow(THICKEST / THINNEST, i / (THICKNESSES - 1.0));
}

static void add_pair(const FlPigment *pigments, int a, int b)
{
    const FlPigment *const two[2] = {&pigments[a], &pigments[b]};
    for (int i = 0; i < SHARES * THICKNESSES; i++) {
        Candidate *candidate = &candidates[n_candidates++];
        float level[3];
        *candidate = (Candidate){.pigment = {(uint8_t)a, (uint8_t)b},
                                 .share = (uint8_t)(i / THICKNESSES),
                                 .thickness = (uint8_t)(i % THICKNESSES)};
        colour_of(two, share_of(candidate->share), thickness_of(candidate->thickness), level);
        fl_lab(level, candidate->lab);
    }
}

/* Pigments of interference absorb next to no light. */
static bool has_hue(const FlPigment *pigment)
{
    const float *k = pigment->absorption;
    return MAX(MAX(k[0], k[1]), k[2]) > .2f;
}

static void fill_candidates(void)
{
    const FlPigment *pigments;
    const int n = fl_pigments(&pigments);
    candidates = g_new(Candidate, n * (n - 1) / 2 * SHARES * THICKNESSES);
    for (int a = 0; a < n; a++)
        for (int b = a + 1; b < n; b++)
            if (has_hue(&pigments[a]) && has_hue(&pigments[b]))
                add_pair(pigments, a, b);
}

/* The cosine between the hues of a mixture's two pigments. */
static float harmony_of(const Candidate *candidate)
{
    const Candidate *first = candidate - candidate->share * THICKNESSES;
    const Candidate *second = first + (SHARES - 1) * THICKNESSES;
    const float *a = first->lab + 1, *b = second->lab + 1;
    return (a[0] * b[0] + a[1] * b[1]) / (hypotf(a[0], a[1]) * hypotf(b[0], b[1]) + 1);
}

/* The distance of a mixture: errors of hue weigh most, then lightness. Pure pigments, which cannot
 * drift to both sides, and complements, which drift through grey, are a little farther. */
static float distance_of(const Candidate *candidate, const float fill[3])
{
    const float *lab = candidate->lab;
    const float chroma = sqrtf(lab[1] * lab[1] + lab[2] * lab[2]);
    const float wanted = sqrtf(fill[1] * fill[1] + fill[2] * fill[2]);
    const float da = lab[1] - fill[1], db = lab[2] - fill[2], dl = 1.15f * (lab[0] - fill[0]);
    const float all = da * da + db * db, dc = chroma - wanted;
    const float hue = wanted > 4 ? MAX(all - dc * dc, 0) : all; // squared
    const float pure = fabsf(2 * (float)share_of(candidate->share) - 1);
    return dl * dl + .7f * dc * dc + 4.84f * hue + 2.5f * pure * pure * pure * pure +
           OF_COMPLEMENTS * (1 - harmony_of(candidate));
}

/* Makes the purer pigment the second one, which prevails in the shadow: grey shadows look dirty. */
static void swap_pigments(FlMixture *mixture)
{
    const FlPigment *first = mixture->pigment[0];
    mixture->pigment[0] = mixture->pigment[1], mixture->pigment[1] = first;
    mixture->share = 1 - mixture->share;
    for (int c = 0; c < 3; c++)
        mixture->turn[c] = -mixture->turn[c];
}

#define MOST_LIGHT .01f // of a channel, as the lighter pigment prevails by one CIE76

/* The density that turns the hue by one CIE76 towards the second pigment, with half of the light by
 * which the two differ: at one light an orange would turn olive. */
static void find_turn(FlMixture *mixture)
{
    static const float light[3] = {.2126f, .7152f, .0722f};
    float before[3], after[3], level[3], moved[3], lab[3], turned[3], weight = 0, mean = 0,
                                                                      most = 0;
    colour_of(mixture->pigment, MAX(mixture->share - DRIFT, 0), mixture->thickness, before);
    colour_of(mixture->pigment, MIN(mixture->share + DRIFT, 1), mixture->thickness, after);
    for (int c = 0; c < 3; c++) {
        level[c] = MAX((before[c] + after[c]) / 2, 2);
        mixture->turn[c] = logf(MAX(before[c], 2) / MAX(after[c], 2));
        const float y = light[c] * level[c] * level[c]; // nearly the light that a level is
        mean += mixture->turn[c] * y, weight += y;
    }
    for (int c = 0; c < 3; c++) {
        mixture->turn[c] -= mean / weight;
        most = MAX(most, fabsf(mixture->turn[c]));
    }
    for (int c = 0; c < 3; c++) {
        mixture->turn[c] *= .02f / MAX(most, 1e-6f);
        moved[c] = level[c] * expf(-mixture->turn[c]);
    }
    fl_lab(level, lab);
    fl_lab(moved, turned);
    const float by = hypotf(turned[1] - lab[1], turned[2] - lab[2]);
    const float one = MIN(1 / MAX(by, .05f), MOST_TURN / .02f);
    const float lighter = .5f * mean / weight * .02f / MAX(most, 1e-6f) * one;
    for (int c = 0; c < 3; c++)
        mixture->turn[c] = one * mixture->turn[c] + CLAMP(lighter, -MOST_LIGHT, MOST_LIGHT);
    if (hypotf(turned[1], turned[2]) < hypotf(lab[1], lab[2]))
        swap_pigments(mixture);
}

static FlMixture *search(const uint8_t fill[3])
{
    const float level[3] = {fill[0], fill[1], fill[2]};
    const FlPigment *pigments;
    float lab[3], least = INFINITY, mixed[3];
    if (!candidates)
        fill_candidates();
    const Candidate *best = candidates;
    fl_pigments(&pigments);
    fl_lab(level, lab);
    for (int i = 0; i < n_candidates; i++) {
        const float distance = distance_of(&candidates[i], lab);
        if (distance < least)
            least = distance, best = &candidates[i];
    }
    FlMixture *mixture = g_new0(FlMixture, 1);
    mixture->pigment[0] = &pigments[best->pigment[0]];
    mixture->pigment[1] = &pigments[best->pigment[1]];
    mixture->share = share_of(best->share), mixture->thickness = thickness_of(best->thickness);
    colour_of(mixture->pigment, mixture->share, mixture->thickness, mixed);
    for (int c = 0; c < 3; c++)
        mixture->rgb[c] = (uint8_t)CLAMP(mixed[c] + .5f, 0, 255);
    find_turn(mixture);
    return mixture;
}

FlMixture fl_mixture_of(const uint8_t fill[3])
{
    const gpointer key =
        GUINT_TO_POINTER(1u << 24 | (guint)fill[0] << 16 | (guint)fill[1] << 8 | (guint)fill[2]);
    g_mutex_lock(&mutex);
    if (!found)
        found = g_hash_table_new_full(NULL, NULL, NULL, g_free);
    FlMixture *mixture = g_hash_table_lookup(found, key);
    if (!mixture)
        g_hash_table_insert(found, key, mixture = search(fill));
    const FlMixture copy = *mixture;
    g_mutex_unlock(&mutex);
    return copy;
}
