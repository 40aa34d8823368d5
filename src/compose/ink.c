#include "compose/ink.h"
#include "base/density.h"
#include "base/error.h"
#include "base/rect.h"

#include <string.h>

/** A histogram of amounts. */
typedef struct Counts {
    uint64_t count[FL_AMOUNTS]; // weights
    uint64_t total;             // of the weights
    uint64_t seen;              // of the pixels, 255 each
} Counts;

/** Counts a pixel, of which 0..255 is seen, with a weight. */
static void count_amount(Counts *counts, int amount, uint32_t weight, uint8_t seen)
{
    counts->count[amount] += weight, counts->total += weight, counts->seen += seen;
}

#define ENOUGH 64 // pixels that are trusted with an exposure

#define INSIDE 128

/*
 * Exemplars of paint that pools reach six times their median. Such cores would turn any fill into
 * its darkest shade, so where the exemplar's 98th percentile exceeds PEAK, amounts above one bend
 * towards an end such that this percentile arrives at PEAK. Most of the spread of log density lies
 * below the median: its standard deviation stays above 80 % of the exemplar's (84 % for a drop on
 * dry paper, 95 % for a wash into wet paper; at 1.75 the first would be 79 %).
 */
#define PEAK (FL_AMOUNT_ONE * 9 / 4)
#define PEAK_PERCENT 98

/*
 * A mask ends where paint gets hard to see, not where it ends. Of paint that fades out, a remainder
 * lies at the contour, the amount that RIM_PERCENT of the interior stay below; a dark fill would
 * show it as a hard edge around the fringe. So amounts near it bend down to nothing, the more fully
 * the softer the rim: from HARD_RIM on, paint is meant to end at the contour and keeps its edge.
 */
#define RIM_PERCENT 5
#define SOFT_RIM (FL_AMOUNT_ONE / 5)
#define HARD_RIM (FL_AMOUNT_ONE * 2 / 5)

/** The amount below which `percent` of the pixels lie, at least 1. */
static int percentile(const Counts *h, int percent)
{
    const uint64_t rank = h->total * (uint64_t)percent / 100;
    uint64_t below = 0;
    int amount = 0;
    while (amount < FL_AMOUNTS - 1 && below + h->count[amount] <= rank)
        below += h->count[amount++];
    return MAX(amount, 1);
}

static uint8_t median_level(const uint8_t *rgb, const uint8_t *mask, size_t n, int channel)
{
    size_t count[256] = {0}, total = 0, below = 0;
    for (size_t i = 0; i < n; i++)
        if (mask[i] >= INSIDE)
            count[rgb[3 * i + channel]]++, total++;
    int level = 0;
    while (level < 255 && below + count[level] <= total / 2)
        below += count[level++];
    return (uint8_t)level;
}

/** Sets the levels' parts so that a colour of density `median` has amount `one`. */
static void set_parts(FlInk *ink, const int32_t median[3], int one)
{
    int64_t square = 0;
    for (int c = 0; c < 3; c++)
        square += (int64_t)median[c] * median[c];
    for (int c = 0; c < 3; c++)
        for (int s = 0; s < 256; s++) {
            const int64_t d = fl_density((uint8_t)s) - fl_density(ink->paper[c]);
            ink->part[c][s] = (int32_t)(d * median[c] * one / square);
        }
}

static void count_amounts(const FlInk *ink, const uint8_t *rgb, const uint8_t *mask, size_t n,
                          Counts *h)
{
    memset(h, 0, sizeof *h);
    for (size_t i = 0; i < n; i++)
        if (mask[i] >= INSIDE)
            count_amount(h, fl_ink_amount(ink, rgb + 3 * i), 1, 255);
}

static int mean_amount(const Counts *h)
{
    uint64_t sum = 0;
    for (uint64_t a = 0; a < FL_AMOUNTS; a++)
        sum += a * h->count[a];
    return h->total ? (int)(sum / h->total) : 0;
}

/** Percent of the pixels whose amount would be below minus a tenth of the median. */
static int percent_beyond(const FlInk *ink, const uint8_t *rgb, const uint8_t *mask, size_t n)
{
    size_t beyond = 0, total = 0;
    for (size_t i = 0; i < n; i++)
        if (mask[i] >= INSIDE) {
            beyond += fl_ink_signed_amount(ink, rgb + 3 * i) < -FL_AMOUNT_ONE / 10;
            total++;
        }
    return total ? (int)(100 * beyond / total) : 0;
}

static int32_t shoulder_for(int peak)
{
    const int excess = peak - FL_AMOUNT_ONE, wanted = PEAK - FL_AMOUNT_ONE;
    return excess > wanted ? (int32_t)((int64_t)wanted * excess / (excess - wanted)) : 0;
}

static void set_toe(FlInk *ink, int rim)
{
    const int softness = CLAMP(HARD_RIM - rim, 0, HARD_RIM - SOFT_RIM);
    ink->toe = MIN(rim * 3, FL_AMOUNT_ONE * 9 / 10);
    ink->toe_end = rim * 2 / 5;
    ink->toe_share = FL_AMOUNT_ONE * softness / (HARD_RIM - SOFT_RIM);
}

FlInk *fl_ink_new(const uint8_t paper[3], const uint8_t *rgb, const uint8_t *mask, size_t n_pixels,
                  GError **error)
{
    g_autoptr(FlInk) ink = g_new0(FlInk, 1);
    g_autofree Counts *h = g_new0(Counts, 1);
    int32_t median[3];
    int64_t square = 0;
    memcpy(ink->paper, paper, 3);
    for (int c = 0; c < 3; c++) {
        median[c] = fl_density(median_level(rgb, mask, n_pixels, c)) - fl_density(paper[c]);
        square += (int64_t)median[c] * median[c];
    }
    const int64_t least = FL_DENSITY_ONE / 50; // 1.4 % of light: about three levels
    if (square < least * least)
        return fl_none(error, FL_ERROR_STYLE,
                       "the paint inside the masks has the paper's colour #%02x%02x%02x; expected "
                       "paint that differs from it",
                       paper[0], paper[1], paper[2]);
    set_parts(ink, median, FL_AMOUNT_ONE * 256);
    count_amounts(ink, rgb, mask, n_pixels, h);
    /* The median of the projections is not the projection of the channels' medians. */
    const int one = FL_AMOUNT_ONE * FL_AMOUNT_ONE / percentile(h, 50);
    set_parts(ink, median, CLAMP(one, FL_AMOUNT_ONE / 4, FL_AMOUNT_ONE * 4) * 256);
    count_amounts(ink, rgb, mask, n_pixels, h);
    memcpy(ink->density, median, sizeof ink->density);
    ink->mean = mean_amount(h);
    ink->beyond = percent_beyond(ink, rgb, mask, n_pixels);
    ink->spread = (percentile(h, 84) - percentile(h, 16)) / 2;
    ink->shoulder = shoulder_for(percentile(h, PEAK_PERCENT));
    set_toe(ink, percentile(h, RIM_PERCENT));
    return g_steal_pointer(&ink);
}

FlInk *fl_ink_of_style(const FlStyle *style, GError **error)
{
    const size_t n = (size_t)style->n_frames * (size_t)style->height * (size_t)style->width;
    FlInk *ink = fl_ink_new(style->paper, style->rgb, style->mask, n, error);
    if (!ink)
        g_prefix_error(error, "%s: ", style->path);
    return ink;
}

void fl_ink_free(FlInk *ink)
{
    g_free(ink);
}

/** Counts a row of n pixels: fully where `inner` is set, less where `near` is set. */
static void count_row(const FlInk *ink, const uint8_t *rgb, const uint8_t *coverage,
                      const uint8_t *near, const uint8_t *inner, int n, Counts *h)
{
    for (FlColumns run = fl_next_run(coverage, 0, n); run.first < run.last;
         run = fl_next_run(coverage, run.last, n))
        for (int x = run.first; x < run.last; x++)
            if (coverage[x])
                count_amount(h, fl_ink_amount(ink, rgb + 3 * x),
                             256u * inner[x] + 16u * near[x] + coverage[x], coverage[x]);
}

static void keep_least(uint8_t *restrict row, const uint8_t *other, int n)
{
    for (int x = 0; x < n; x++)
        row[x] = MIN(row[x], other[x]);
}

/**
 * Row y of what lies inside a width * height mask, 0..255, with a margin: inner[x], of width bytes,
 * becomes the least of the mask at the pixel and at the corners and sides of a square margin_px
 * around. Beyond the mask it is taken to go on.
 */
static void interior_row(const uint8_t *mask, int width, int height, int y, int margin_px,
                         uint8_t *inner)
{
    const int above = y - margin_px, below = y + margin_px, n = MAX(width - margin_px, 0);
    g_autofree uint8_t *rows = g_memdup2(mask + (size_t)y * width, (size_t)width);
    if (above >= 0)
        keep_least(rows, mask + (size_t)above * width, width);
    if (below < height)
        keep_least(rows, mask + (size_t)below * width, width);
    memcpy(inner, rows, (size_t)width);
    keep_least(inner + margin_px, rows, n);
    keep_least(inner, rows + margin_px, n);
}

/** The exposure that brings the median of what was counted to one; fewer pixels than
 * ENOUGH lean to FL_EXPOSURE_ONE. Returns: FL_EXPOSURE_MIN … FL_EXPOSURE_MAX. */
static int exposure_of(const Counts *h)
{
    if (h->total == 0)
        return FL_EXPOSURE_ONE;
    const int64_t exposure = FL_EXPOSURE_ONE * FL_AMOUNT_ONE / percentile(h, 50);
    const int64_t enough = 255 * ENOUGH, sure = (int64_t)MIN(h->seen, 255u * ENOUGH);
    return (int)((CLAMP(exposure, FL_EXPOSURE_MIN, FL_EXPOSURE_MAX) * sure +
                  FL_EXPOSURE_ONE * (enough - sure)) /
                 enough);
}

int fl_ink_exposure(const FlInk *ink, const uint8_t *painted, const uint8_t *coverage, int width,
                    int height)
{
    g_autofree Counts *h = g_new0(Counts, 1);
    g_autofree uint8_t *near = g_malloc(2 * (size_t)width);
    uint8_t *inner = near + width;
    for (int y = 0; y < height; y++) {
        const size_t row = (size_t)y * (size_t)width;
        if (fl_is_blank(coverage + row, (size_t)width)) // as most rows are
            continue;
        interior_row(coverage, width, height, y, 1, near);
        interior_row(coverage, width, height, y, 2, inner);
        count_row(ink, painted + 3 * row, coverage + row, near, inner, width, h);
    }
    return exposure_of(h);
}

/** The cubic that is 0 at toe_end with slope 0 and meets the identity at toe, slope included. */
static int64_t bent(const FlInk *ink, int64_t amount)
{
    const int64_t one = FL_AMOUNT_ONE, width = ink->toe - ink->toe_end;
    if (amount >= ink->toe || ink->toe_share == 0)
        return amount;
    const int64_t u = MAX(amount - ink->toe_end, 0) * one / width;
    const int64_t square = 3 * one - width * one / ink->toe; // the cubic's other part: one - square
    const int64_t bend = // one division, so that it cannot fall: < 2^52 / 2^40
        ink->toe * u * u * (square * one + (one - square) * u) / (one * one * one * one);
    return (amount * (one - ink->toe_share) + bend * ink->toe_share) / one;
}

int fl_ink_exposed(const FlInk *ink, int amount, int exposure)
{
    int64_t exposed = bent(ink, (int64_t)amount * exposure / FL_EXPOSURE_ONE);
    const int64_t excess = exposed - FL_AMOUNT_ONE;
    if (excess > 0 && ink->shoulder > 0)
        exposed = FL_AMOUNT_ONE + excess * ink->shoulder / (excess + ink->shoulder);
    return (int)MIN(exposed, FL_AMOUNTS - 1);
}
