#include "compose/colourise.h"
#include "base/density.h"
#include "compose/colour_law.h"
#include "compose/layer_blend.h"
#include "compose/wash.h"

#include <math.h>
#include <string.h>

/*
 * A channel of the exemplar is at least this level. A channel of 0 has no density, and near it all
 * contrast drowns in black.
 */
#define FLOOR 12

/** Paint has full body from this amount on. At half the median small shapes over large ones (a
 * hat's band, a smile) drowned in the colour below; at a fifth they stay and the line of paper
 * around them is gone.
 */
#define BODY_AMOUNT (FL_AMOUNT_ONE / 5)

static int body_of(int amount)
{
    return MIN(amount, BODY_AMOUNT) * 255 / BODY_AMOUNT;
}

/** The alpha that paint has at least, whatever its colour. */
static int opacity_of(FlMedium medium, int amount)
{
    if (medium == FL_MEDIUM_AUTO ||
        medium == FL_MEDIUM_OPAQUE) // 1 - 2^-4a: FL_AMOUNT_ONE * 256 is four octaves
        return 255 - fl_density_level(256 * amount) / 256;
    if (medium == FL_MEDIUM_SOLID)
        return 255;
    return medium == FL_MEDIUM_BODY ? body_of(amount) : 0;
}

/*
 * Alpha never falls as the amount rises: the least one does so where a channel crosses the paper's
 * level, and light paint over dark would be mottled. A channel turns at one amount if anywhere, so
 * that it is enough to look back at that and at the steps below.
 */
#define LEAST_STEP (FL_AMOUNT_ONE / 4)

/** A fill on the output's paper. */
typedef struct Fill {
    uint8_t rgb[3];
    bool known; // of an entry in a table of them
    FlColourLaw law;
    uint8_t least[FL_AMOUNTS / LEAST_STEP]; // the greatest of the least alphas up to a step
    int n_least;                            // of them are known: most paint is far from the last
    int turn_at;                            // the amount at which channels turn
    uint8_t least_there;                    // the least alpha at turn_at
} Fill;

static uint8_t least_alpha_at(const Fill *fill, const FlColouring *colouring,
                              const FlTransfer *scale, int amount)
{
    uint8_t colour[3];
    fl_colour_law_at(&fill->law, amount, colour);
    return (uint8_t)fl_least_alpha(scale, colour, colouring->paper);
}

static void fill_init(Fill *fill, const FlInk *ink, const FlColouring *colouring,
                      const FlTransfer *scale, const uint8_t rgb[3])
{
    memcpy(fill->rgb, rgb, 3);
    fill->known = true;
    fill->n_least = 0;
    fl_colour_law_init(&fill->law, rgb, colouring->paper, ink->spread);
    fill->turn_at = fl_colour_law_turn(&fill->law);
    fill->least_there = least_alpha_at(fill, colouring, scale, fill->turn_at);
}

/* The greatest of the least alphas up to a step. */
static int least_up_to(Fill *fill, const FlColouring *colouring, const FlTransfer *scale, int step)
{
    for (int i = fill->n_least; i <= step; i++) {
        const uint8_t own = least_alpha_at(fill, colouring, scale, i * LEAST_STEP);
        fill->least[i] = i > 0 ? MAX(fill->least[i - 1], own) : own;
        fill->n_least = i + 1;
    }
    return fill->least[step];
}

/* play: in 1 / FL_PLAY_ONE; thin paint shows little of it. */
static void turn_hue(const FlColouring *colouring, int amount, int play, uint8_t colour[3])
{
    const float share = (float)(play * MIN(amount, FL_AMOUNT_ONE * 13 / 10)) /
                        (FL_PLAY_ONE * FL_AMOUNT_ONE) * 1.442695f * FL_DENSITY_ONE *
                        colouring->reach[play > 0];
    for (int c = 0; c < 3; c++) {
        const int32_t density = FL_DENSITY_ONE + (int32_t)lrintf(colouring->turn[c] * share);
        const int factor = fl_density_level(density); // 128 * 255: one
        colour[c] = (uint8_t)MIN((colour[c] * factor + 64 * 255) / (128 * 255), 255);
    }
}

/** The look of an amount of paint on the paper, before pigments play. */
typedef struct Look {
    uint8_t colour[3];
    uint8_t opacity; // alpha, at least
} Look;

static Look look_of(Fill *fill, const FlColouring *colouring, const FlTransfer *scale, int amount)
{
    Look look;
    fl_colour_law_at(&fill->law, amount, look.colour);
    int opacity = MAX(opacity_of(colouring->medium, amount),
                      least_up_to(fill, colouring, scale, amount / LEAST_STEP));
    if (amount > fill->turn_at)
        opacity = MAX(opacity, fill->least_there);
    look.opacity = (uint8_t)opacity;
    return look;
}

static void colour_look(const FlColouring *colouring, const FlTransfer *scale, Look look,
                        int amount, int play, uint8_t rgba[4])
{
    if (colouring->play)
        turn_hue(colouring, amount, play, look.colour);
    fl_unblend(scale, look.colour, colouring->paper, look.opacity, rgba);
}

static void colour_amount(Fill *fill, const FlColouring *colouring, const FlTransfer *scale,
                          int amount, int play, uint8_t rgba[4])
{
    colour_look(colouring, scale, look_of(fill, colouring, scale, amount), amount, play, rgba);
}

/** The most paint that a pixel of an area has; -1: no pixel has paint. */
static int most_amount(const int16_t *amounts, const FlArea *area)
{
    int most = -1;
    for (int y = 0; y < area->box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const int16_t *row = amounts + (size_t)y * (size_t)area->box.width;
        for (int x = span.first; x < span.last; x++)
            most = MAX(most, row[x]);
    }
    return most;
}

#define PLAYS 128 // as many plays of pigments are told apart: one in two
#define AS_ONE 4  // amounts that look alike where pigments play

/** One fill for the whole region: each pair of an amount and a play is found once it is met. */
static void colour_flat(const FlInk *ink, const FlColouring *colouring, const FlTransfer *scale,
                        const int16_t *amounts, const FlArea *area, uint8_t *rgba)
{
    const bool plays = colouring->play != NULL;
    const int as_one = plays ? AS_ONE : 1;
    const size_t n_amounts = (size_t)(most_amount(amounts, area) / as_one + 1);
    const size_t n = n_amounts * (plays ? PLAYS : 1);
    g_autofree uint32_t *colours = g_new(uint32_t, n); // set for the pairs in `met`
    g_autofree bool *met = g_new0(bool, n);
    g_autofree Look *looks = g_new(Look, n_amounts);
    g_autofree bool *seen = g_new0(bool, n_amounts); // looks that are known
    Fill fill;
    fill_init(&fill, ink, colouring, scale, colouring->fill);
    for (int y = 0; y < area->box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const size_t row = (size_t)y * (size_t)area->box.width;
        for (size_t i = row + (size_t)span.first; i < row + (size_t)span.last; i++) {
            if (amounts[i] < 0)
                continue;
            const int play = plays ? (colouring->play[i] + 128) * PLAYS / 256 : 0;
            const int some = amounts[i] / as_one, amount = some * as_one;
            const size_t at = (size_t)play * n_amounts + (size_t)some;
            if (!met[at]) {
                uint8_t of[4];
                if (!seen[some])
                    looks[some] = look_of(&fill, colouring, scale, amount);
                seen[some] = true;
                colour_look(colouring, scale, looks[some], amount, play * 256 / PLAYS - 128, of);
                memcpy(&colours[at], of, 4);
                met[at] = true;
            }
            memcpy(rgba + 4 * i, &colours[at], 4);
        }
    }
}

/** The index, in the painted part, of row y of an area's box. */
static size_t painted_at(const FlPaintedPart *painted, FlRect box, int y)
{
    const size_t row = (size_t)(box.y + y - painted->box.y) * (size_t)painted->box.width;
    return row + (size_t)(box.x - painted->box.x);
}

static const uint8_t *painted_row(const FlPaintedPart *painted, FlRect box, int y)
{
    return painted->rgb + 3 * painted_at(painted, box, y);
}

/** The exemplar's own colours on the output's paper. */
typedef struct Kept {
    int32_t paper[3];     // density
    int32_t step[3][256]; // density that a level of a channel adds
} Kept;

static void kept_init(Kept *kept, const FlInk *ink, const uint8_t paper[3])
{
    for (int c = 0; c < 3; c++) {
        const uint8_t bare = MAX(ink->paper[c], 1), floor = MIN(bare, FLOOR);
        kept->paper[c] = fl_density(MAX(paper[c], 1));
        for (int s = 0; s < 256; s++)
            kept->step[c][s] = fl_density((uint8_t)MAX(s, floor)) - fl_density(bare);
    }
}

static void keep_colours(const FlInk *ink, const FlColouring *colouring, const FlTransfer *scale,
                         const FlPaintedPart *painted, const int16_t *amounts, const FlArea *area,
                         uint8_t *rgba)
{
    Kept kept;
    kept_init(&kept, ink, colouring->paper);
#pragma omp parallel for schedule(dynamic, 8)
    for (int y = 0; y < area->box.height; y++) {
        const size_t row = (size_t)y * area->box.width;
        const FlColumns span = fl_area_row(area, y);
        const uint8_t *source = painted_row(painted, area->box, y);
        for (int x = span.first; x < span.last; x++) {
            const int amount = amounts[row + x];
            uint8_t colour[3];
            if (amount < 0)
                continue;
            for (int c = 0; c < 3; c++)
                colour[c] =
                    (uint8_t)((fl_density_level(kept.paper[c] + kept.step[c][source[3 * x + c]]) +
                               128) >>
                              8);
            fl_unblend(scale, colour, colouring->paper, opacity_of(colouring->medium, amount),
                       rgba + 4 * (row + x));
        }
    }
}

/** The exemplar's own colours as they are. */
static void copy_colours(const FlPaintedPart *painted, const int16_t *amounts, const FlArea *area,
                         uint8_t *rgba)
{
    for (int y = 0; y < area->box.height; y++) {
        const size_t row = (size_t)y * (size_t)area->box.width;
        const FlColumns span = fl_area_row(area, y);
        const uint8_t *source = painted_row(painted, area->box, y);
        for (int x = span.first; x < span.last; x++)
            if (amounts[row + (size_t)x] >= 0)
                memcpy(rgba + 4 * (row + (size_t)x), source + 3 * (size_t)x, 3);
    }
}

/** As transparent as the paint itself is. */
static void take_alpha(const FlPaintedPart *painted, const int16_t *amounts, const FlArea *area,
                       uint8_t *rgba)
{
    for (int y = 0; y < area->box.height; y++) {
        const size_t row = (size_t)y * (size_t)area->box.width;
        const FlColumns span = fl_area_row(area, y);
        const uint8_t *alpha = painted->alpha + painted_at(painted, area->box, y);
        for (int x = span.first; x < span.last; x++)
            if (amounts[row + (size_t)x] >= 0)
                rgba[4 * (row + (size_t)x) + 3] = alpha[x];
    }
}

/** Fills that have been met, each at the place of its colour; a later fill replaces an earlier
 * one. */
#define FILLS 1024

static Fill *find_fill(Fill *fills, const FlInk *ink, const FlColouring *colouring,
                       const FlTransfer *scale, const uint8_t *rgb)
{
    const uint32_t colour = (uint32_t)(rgb[0] << 16 | rgb[1] << 8 | rgb[2]);
    Fill *fill = &fills[(colour * 2654435761u >> 16) % FILLS];
    if (!fill->known || memcmp(fill->rgb, rgb, 3) != 0)
        fill_init(fill, ink, colouring, scale, rgb);
    return fill;
}

/** Each pixel has a fill of its own. */
static void colour_picture(const FlInk *ink, const FlColouring *colouring, const FlTransfer *scale,
                           const int16_t *amounts, const FlArea *area, uint8_t *rgba)
{
#pragma omp parallel
    {
        g_autofree Fill *fills = g_new0(Fill, FILLS);
#pragma omp for schedule(dynamic, 8)
        for (int y = 0; y < area->box.height; y++) {
            const FlColumns span = fl_area_row(area, y);
            const size_t row = (size_t)y * area->box.width;
            for (size_t i = row + (size_t)span.first; i < row + (size_t)span.last; i++)
                if (amounts[i] >= 0)
                    colour_amount(
                        find_fill(fills, ink, colouring, scale, colouring->picture + 4 * i),
                        colouring, scale, amounts[i], colouring->play ? colouring->play[i] : 0,
                        rgba + 4 * i);
        }
    }
}

void fl_colourise(const FlInk *ink, const FlColouring *colouring, const FlPaintedPart *painted,
                  const int16_t *amounts, const FlArea *area, uint8_t *rgba)
{
    FlTransfer scale;
    fl_transfer_init(&scale, colouring->linear);
    if (colouring->tint == FL_TINT_KEEP && painted->alpha)
        copy_colours(painted, amounts, area, rgba);
    else if (colouring->tint == FL_TINT_KEEP)
        keep_colours(ink, colouring, &scale, painted, amounts, area, rgba);
    else if (colouring->picture)
        colour_picture(ink, colouring, &scale, amounts, area, rgba);
    else
        colour_flat(ink, colouring, &scale, amounts, area, rgba);
    if (painted && painted->alpha)
        take_alpha(painted, amounts, area, rgba);
}

void fl_colourise_amounts(const FlInk *ink, int exposure, const FlPaintedPart *painted,
                          const uint8_t *coverage, const FlArea *area, int16_t *amounts)
{
    const FlRect box = area->box;
    g_autofree int16_t *exposed = g_new(int16_t, FL_AMOUNTS); // -1: not met yet
    memset(exposed, 0xff, FL_AMOUNTS * sizeof *exposed);
    memset(amounts, 0xff, fl_rect_pixels(box) * sizeof *amounts); // -1
    for (int y = 0; y < box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const uint8_t *rgb = painted_row(painted, box, y);
        const size_t row = (size_t)y * (size_t)box.width;
        for (int x = span.first; x < span.last; x++)
            if (coverage[row + x]) {
                const int amount = fl_ink_amount(ink, rgb + 3 * (size_t)x);
                if (exposed[amount] < 0)
                    exposed[amount] = (int16_t)fl_ink_exposed(ink, amount, exposure);
                amounts[row + x] = exposed[amount];
            }
    }
}

void fl_colourise_plain(const uint8_t *picture, const uint8_t flat[3], const uint8_t *coverage,
                        const FlArea *area, uint8_t *rgba)
{
    for (int y = 0; y < area->box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const size_t row = (size_t)y * (size_t)area->box.width;
        for (size_t i = row + (size_t)span.first; i < row + (size_t)span.last; i++) {
            if (!coverage[i])
                continue;
            memcpy(rgba + 4 * i, picture ? picture + 4 * i : flat, 3);
            rgba[4 * i + 3] = 255;
        }
    }
}
