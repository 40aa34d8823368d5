#include "compose/colourise.h"
#include "base/density.h"
#include "base/row_kernels.h"
#include "compose/colour_law.h"
#include "compose/layer_blend.h"
#include "compose/unevenness.h"

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
    if (medium == FL_MEDIUM_OPAQUE) // 1 - 2^-4a: FL_AMOUNT_ONE * 256 is four octaves
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
    int32_t turn[3]; // density that each channel gains where the second pigment prevails by one
    uint8_t least[FL_AMOUNTS / LEAST_STEP]; // the greatest of the least alphas up to a step
    int n_least;                            // of them are known: most paint is far from the last
    int turn_at;                            // the amount at which channels turn
    uint8_t least_there;                    // the least alpha at turn_at
} Fill;

/* Only the middle channel moves, so that orange goes to yellow and red, sky blue to cyan and
 * violet: brightness and purity stay. Greys go from warm to cold. */
static void turns_of(const uint8_t rgb[3], float pigments, int32_t turn[3])
{
    static const float of_grey[3] = {-.28f, 0, .34f};
    const int most = MAX(MAX(rgb[0], rgb[1]), rgb[2]), least = MIN(MIN(rgb[0], rgb[1]), rgb[2]);
    const float range = (float)(most - least);
    const float grey = CLAMP(1 - 3 * range / (float)MAX(most, 1), 0, 1);
    for (int c = 0; c < 3; c++) {
        const float middle =
            range > 0 ? 5 * (float)(most - rgb[c]) * (float)(rgb[c] - least) / (range * range) : 0;
        const float turned = (1 - grey) * middle + grey * of_grey[c];
        turn[c] = (int32_t)lrintf(pigments * turned * 1.442695f * FL_DENSITY_ONE);
    }
}

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
    turns_of(rgb, colouring->pigments, fill->turn);
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

/* Thick paint shows the second pigment more. play: in 1 / FL_PLAY_ONE. */
static void turn_hue(const Fill *fill, int amount, int play, uint8_t colour[3])
{
    const int thick = CLAMP(amount - FL_AMOUNT_ONE, -FL_AMOUNT_ONE, FL_AMOUNT_ONE * 3 / 2);
    const int n = CLAMP(play + thick * 22 / FL_AMOUNT_ONE, -102, 102); // .35, 1.6 of FL_PLAY_ONE
    const int64_t share = (int64_t)n * MIN(amount, FL_AMOUNT_ONE * 6 / 5);
    for (int c = 0; c < 3; c++) {
        const int64_t density = fill->turn[c] * share / (FL_PLAY_ONE * FL_AMOUNT_ONE);
        const int factor = fl_density_level((int32_t)(FL_DENSITY_ONE + density)); // 128 * 255: one
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

static void colour_look(const Fill *fill, const FlColouring *colouring, const FlTransfer *scale,
                        Look look, int amount, int play, uint8_t rgba[4])
{
    if (colouring->play)
        turn_hue(fill, amount, play, look.colour);
    fl_unblend(scale, look.colour, colouring->paper, look.opacity, rgba);
}

static void colour_amount(Fill *fill, const FlColouring *colouring, const FlTransfer *scale,
                          int amount, int play, uint8_t rgba[4])
{
    colour_look(fill, colouring, scale, look_of(fill, colouring, scale, amount), amount, play,
                rgba);
}

/** One fill for the whole region: each amount that it has is looked up. */
static void colour_flat(const FlInk *ink, const FlColouring *colouring, const FlTransfer *scale,
                        const int16_t *amounts, const FlArea *area, uint8_t *rgba)
{
    const size_t width = (size_t)area->box.width;
    g_autofree uint32_t *colours = g_new(uint32_t, FL_AMOUNTS);
    g_autofree bool *used = g_new0(bool, FL_AMOUNTS);
    Fill fill;
    for (int y = 0; y < area->box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const int16_t *row = amounts + (size_t)y * width;
        for (int x = span.first; x < span.last; x++)
            if (row[x] >= 0)
                used[row[x]] = true;
    }
    fill_init(&fill, ink, colouring, scale, colouring->fill);
    for (int amount = 0; amount < FL_AMOUNTS; amount++) {
        uint8_t rgba_of[4];
        if (!used[amount])
            continue;
        colour_amount(&fill, colouring, scale, amount, 0, rgba_of);
        memcpy(&colours[amount], rgba_of, 4);
    }
    for (int y = 0; y < area->box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const size_t first = (size_t)y * width + (size_t)span.first;
        fl_row_kernels()->look_up(amounts + first, colours, (uint32_t *)(void *)rgba + first,
                                  span.last - span.first);
    }
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

#define PLAYS 64 // as many plays of pigments are told apart: one in four

/** The same where pigments play: each pair of an amount and a play is looked up once it was met. */
static void colour_flat_play(const FlInk *ink, const FlColouring *colouring,
                             const FlTransfer *scale, const int16_t *amounts, const FlArea *area,
                             uint8_t *rgba)
{
    const size_t n_amounts = (size_t)(most_amount(amounts, area) + 1);
    const size_t n = n_amounts * PLAYS;
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
            const int play = (colouring->play[i] + 128) * PLAYS / 256;
            const size_t at = (size_t)play * n_amounts + (size_t)amounts[i];
            if (!met[at]) {
                uint8_t of[4];
                Look *look = &looks[amounts[i]];
                if (!seen[amounts[i]])
                    *look = look_of(&fill, colouring, scale, amounts[i]);
                seen[amounts[i]] = true;
                colour_look(&fill, colouring, scale, *look, amounts[i], play * 256 / PLAYS - 126,
                            of);
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
    else if (colouring->play)
        colour_flat_play(ink, colouring, &scale, amounts, area, rgba);
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
