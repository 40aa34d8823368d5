#include "compose/colourise.h"
#include "base/density.h"
#include "base/row_kernels.h"
#include "compose/layer_blend.h"

#include <string.h>

/*
 * A fill's channel is at least this level. A channel of 0 has no density, and near it all contrast
 * drowns in black; real black paint is no darker. Pure black moves by less than 2 in CIEDE2000.
 */
#define FLOOR 12

/**
 * Paint has full body, and opaque paint is opaque, from this amount on. At half the median small
 * shapes over large ones (a hat's band, a smile) drowned in the colour below; at a fifth they stay
 * and the line of paper around them is gone.
 */
#define OPAQUE_AMOUNT (FL_AMOUNT_ONE / 5)

/** The density of a channel of the paper; it is never quite black. */
static int32_t base_of(uint8_t paper)
{
    return fl_density(MAX(paper, 1));
}

/** The density of a channel of the fill beyond that of the paper. */
static int32_t step_of(uint8_t fill, uint8_t paper)
{
    const uint8_t floor = paper > FLOOR ? FLOOR : MAX(paper, 1);
    return fl_density(MAX(fill, floor)) - base_of(paper);
}

/** The level of paper of density `base` with `amount` times a density `step` on it. */
static uint8_t painted_level(int32_t base, int32_t step, int amount)
{
    const int32_t density = base + (int32_t)((int64_t)step * amount / FL_AMOUNT_ONE);
    return (uint8_t)((fl_density_level(density) + 128) >> 8);
}

static int body_of(int amount)
{
    return MIN(amount, OPAQUE_AMOUNT) * 255 / OPAQUE_AMOUNT;
}

static int opacity_of(FlMedium medium, int amount)
{
    return medium == FL_MEDIUM_OPAQUE ? body_of(amount) : 0;
}

/** One fill for the whole region: each amount that it has is looked up. */
static void colour_flat(const FlColouring *how, const FlScale *scale, const int16_t *amounts,
                        const FlArea *area, uint8_t *rgba)
{
    const size_t width = (size_t)area->box.width;
    g_autofree uint32_t *look = g_new(uint32_t, FL_AMOUNTS);
    g_autofree bool *used = g_new0(bool, FL_AMOUNTS);
    int32_t base[3], step[3];
    for (int y = 0; y < area->box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const int16_t *row = amounts + (size_t)y * width;
        for (int x = span.first; x < span.last; x++)
            if (row[x] >= 0)
                used[row[x]] = true;
    }
    for (int c = 0; c < 3; c++)
        base[c] = base_of(how->paper[c]), step[c] = step_of(how->fill[c], how->paper[c]);
    for (int amount = 0; amount < FL_AMOUNTS; amount++) {
        uint8_t colour[3], rgba_of[4];
        if (!used[amount])
            continue;
        for (int c = 0; c < 3; c++)
            colour[c] = painted_level(base[c], step[c], amount);
        fl_lift(scale, colour, how->paper, opacity_of(how->medium, amount), rgba_of);
        memcpy(&look[amount], rgba_of, 4);
    }
    for (int y = 0; y < area->box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const size_t first = (size_t)y * width + (size_t)span.first;
        fl_row_kernels()->look_up(amounts + first, look, (uint32_t *)(void *)rgba + first,
                                  span.last - span.first);
    }
}

/** What each level of a per-pixel source adds to the paper's density, per channel. */
typedef struct Steps {
    int32_t base[3];
    int32_t step[3][256];
} Steps;

static void steps_init(Steps *steps, const FlInk *ink, const FlColouring *how)
{
    const uint8_t *from = how->tint == FL_TINT_KEEP ? ink->paper : how->paper;
    for (int c = 0; c < 3; c++) {
        steps->base[c] = base_of(how->paper[c]);
        for (int s = 0; s < 256; s++)
            steps->step[c][s] = step_of((uint8_t)s, from[c]);
    }
}

/** Row y of an area's box in what has been painted. */
static const uint8_t *painted_row(const FlPaintedPart *painted, FlRect box, int y)
{
    const size_t row = (size_t)(box.y + y - painted->box.y) * (size_t)painted->box.width;
    return painted->rgb + 3 * (row + (size_t)(box.x - painted->box.x));
}

/** Colours a row of the box from the painted pixels themselves, or from the picture. */
static void colour_row(const FlColouring *how, const FlScale *scale, const Steps *steps,
                       const uint8_t *row, size_t pixel_bytes, const int16_t *amounts,
                       FlColumns span, uint8_t *rgba)
{
    for (int x = span.first; x < span.last; x++) {
        const uint8_t *source = row + pixel_bytes * (size_t)x;
        if (amounts[x] < 0)
            continue;
        const int amount = how->tint == FL_TINT_KEEP ? FL_AMOUNT_ONE : amounts[x];
        uint8_t colour[3];
        for (int c = 0; c < 3; c++)
            colour[c] = painted_level(steps->base[c], steps->step[c][source[c]], amount);
        fl_lift(scale, colour, how->paper, opacity_of(how->medium, amounts[x]), rgba + 4 * x);
    }
}

static void colour_pixels(const FlInk *ink, const FlColouring *how, const FlScale *scale,
                          const FlPaintedPart *painted, const int16_t *amounts, const FlArea *area,
                          uint8_t *rgba)
{
    const FlRect box = area->box;
    const bool keep = how->tint == FL_TINT_KEEP;
    Steps steps;
    steps_init(&steps, ink, how);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < box.height; y++) {
        const size_t row = (size_t)y * box.width;
        const uint8_t *source = keep ? painted_row(painted, box, y) : how->picture + 4 * row;
        colour_row(how, scale, &steps, source, keep ? 3 : 4, amounts + row, fl_area_row(area, y),
                   rgba + 4 * row);
    }
}

void fl_colourise(const FlInk *ink, const FlColouring *how, const FlPaintedPart *painted,
                  const int16_t *amounts, const FlArea *area, uint8_t *rgba)
{
    FlScale scale;
    fl_scale_init(&scale, how->linear);
    if (how->tint != FL_TINT_KEEP && !how->picture)
        colour_flat(how, &scale, amounts, area, rgba);
    else
        colour_pixels(ink, how, &scale, painted, amounts, area, rgba);
}

void fl_colourise_amounts(const FlInk *ink, int exposure, const FlPaintedPart *painted,
                          const uint8_t *coverage, const FlArea *area, int16_t *amounts)
{
    const FlRect box = area->box;
    g_autofree int16_t *toned = g_new(int16_t, FL_AMOUNTS);
    for (int i = 0; i < FL_AMOUNTS; i++)
        toned[i] = (int16_t)fl_ink_exposed(ink, i, exposure);
    memset(amounts, 0xff, fl_rect_pixels(box) * sizeof *amounts); // -1
    for (int y = 0; y < box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const uint8_t *rgb = painted_row(painted, box, y);
        const size_t row = (size_t)y * (size_t)box.width;
        for (int x = span.first; x < span.last; x++)
            if (coverage[row + x])
                amounts[row + x] = toned[fl_ink_amount(ink, rgb + 3 * (size_t)x)];
    }
}

void fl_colourise_knockout(const int16_t *amounts, const FlArea *area, uint8_t *knockout)
{
    for (int y = 0; y < area->box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const size_t row = (size_t)y * area->box.width;
        for (int x = span.first; x < span.last; x++)
            knockout[row + x] = (uint8_t)body_of(MAX(amounts[row + x], 0));
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
