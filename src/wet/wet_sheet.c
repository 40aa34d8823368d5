#include "wet/wet_sheet.h"

#include "base/alloc.h"
#include "wet/curves.h"
#include <math.h>

#define FRONT_FRAMES 2.2f // in which a front dries
#define GONE_FRAMES 36    // after which a stain is gone
#define STRENGTH 0.9f     // of absorbances on the paper
#define LEAST 0.002f      // of a mark that is seen

/** The grain of the paper, once for the film: the pictures have the sheet's. */
static void find_grain(FlWetSheet *sheet)
{
    const int width = sheet->width, height = sheet->height;
    const float px = sheet->px * (float)width / (float)sheet->page.width;
#pragma omp parallel for schedule(static)
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const float i = ((float)x + 0.5f) / px, j = ((float)y + 0.5f) / px;
            FlPaperGrains *grain = &sheet->grain[(size_t)y * (size_t)width + (size_t)x];
            grain->hollow = (uint8_t)(255 * fl_fibres_hollow(&sheet->fibres, i, j) + 0.5f);
            grain->spot = (uint8_t)(255 * fl_fibres_spot(&sheet->fibres, i, j) + 0.5f);
        }
}

bool fl_wet_sheet_init(FlWetSheet *sheet, GError **error)
{
    const size_t n = fl_rect_pixels(sheet->page);
    const size_t pixels = (size_t)sheet->width * (size_t)sheet->height;
    sheet->wet = (FlRect){0, 0, 0, 0};
    if (!(sheet->cell = fl_alloc(n, sizeof *sheet->cell, "the paper's marks", error)) ||
        !(sheet->grain = fl_alloc_unset(pixels, sizeof *sheet->grain, "paper", error)))
        return false;
    find_grain(sheet);
    return true;
}

void fl_wet_sheet_clear(FlWetSheet *sheet)
{
    free(sheet->cell);
    free(sheet->grain);
    *sheet = (FlWetSheet){0};
}

static int wrapped(int x, int size)
{
    return x < 0 ? x + size : x < size ? x : x - size;
}

/** The grain at a px of the picture, which moves with the paper. */
static FlPaperGrains grain_at(const FlWetSheet *sheet, int x, int y)
{
    const int i = wrapped(x - sheet->moved_x, sheet->width);
    const int j = wrapped(y - sheet->moved_y, sheet->height);
    return sheet->grain[(size_t)j * (size_t)sheet->width + (size_t)i];
}

FlPaperGrains fl_wet_sheet_grain(const FlWetSheet *sheet, int32_t at)
{
    const float scale = (float)sheet->width / (float)sheet->page.width;
    const int x = (int)(scale * ((float)(at % sheet->page.width) + 0.5f));
    const int y = (int)(scale * ((float)(at / sheet->page.width) + 0.5f));
    return grain_at(sheet, MIN(x, sheet->width - 1), MIN(y, sheet->height - 1));
}

static void place_paper(FlWetSheet *sheet, float x, float y)
{
    const float scale = (float)sheet->width / (float)sheet->page.width;
    sheet->fibres.x = x, sheet->fibres.y = y;
    sheet->moved_x = (int)(scale * x) % sheet->width;
    sheet->moved_y = (int)(scale * y) % sheet->height;
}

void fl_wet_sheet_restore(FlWetSheet *sheet, FlRect wet, const FlWetCell *cells, float moved_x,
                          float moved_y)
{
    place_paper(sheet, moved_x, moved_y);
    sheet->wet = wet;
    fl_rect_copy(cells, wet, sheet->cell, sheet->page, sizeof *cells);
}

bool fl_wet_sheet_move(FlWetSheet *sheet, int dx, int dy, GError **error)
{
    const FlRect page = sheet->page, to = {dx, dy, page.width, page.height};
    if (dx == 0 && dy == 0)
        return true;
    FlWetCell *moved = fl_alloc(fl_rect_pixels(page), sizeof *moved, "the paper's marks", error);
    if (!moved)
        return false;
    fl_rect_copy(sheet->cell, to, moved, page, sizeof *moved);
    free(sheet->cell);
    sheet->cell = moved;
    place_paper(sheet, sheet->fibres.x + (float)dx, sheet->fibres.y + (float)dy);
    sheet->wet = fl_rect_and(
        (FlRect){sheet->wet.x + dx, sheet->wet.y + dy, sheet->wet.width, sheet->wet.height}, page);
    return true;
}

static float share_of(uint8_t value)
{
    return (float)value / 255;
}

/** Frames in which a stain fades to a third: pigment stays in hollows. */
static float fading_frames(const FlWetSheet *sheet, float hollow)
{
    return sheet->stain_time * (0.45f + 1.1f * hollow);
}

/** The share of a stain's pigment that is left. */
static float left_of(const FlWetSheet *sheet, float age, float hollow)
{
    return fl_fall(age / fading_frames(sheet, hollow)) *
           (1 - fl_ease(0.67f * GONE_FRAMES, GONE_FRAMES, age));
}

void fl_wet_sheet_dry(FlWetSheet *sheet, float frames)
{
    FlRect wet = {0, 0, 0, 0};
    const FlRect page = sheet->page, part = sheet->wet;
    for (int y = part.y; y < part.y + part.height; y++) {
        FlColumns found = {page.width, 0};
        for (int x = part.x; x < part.x + part.width; x++) {
            const size_t at = (size_t)y * (size_t)page.width + (size_t)x;
            FlWetCell *cell = &sheet->cell[at];
            const FlPaperGrains grain = fl_wet_sheet_grain(sheet, (int32_t)at);
            if (cell->front > 0)
                cell->front *= fl_fall(frames / (FRONT_FRAMES * (0.5f + share_of(grain.hollow))));
            cell->age += frames;
            cell->front = cell->front > 0.01f * frames ? cell->front - 0.01f * frames : 0;
            if (cell->age > GONE_FRAMES)
                cell->stain = cell->film = 0;
            if (cell->front > 0 || cell->stain > 0 || cell->film > 0)
                found = (FlColumns){MIN(found.first, x), x + 1};
        }
        wet = fl_rect_or(wet, fl_rect_between(found.first, y, found.last, y + 1));
    }
    sheet->wet = wet;
}

void fl_wet_sheet_fade(FlWetSheet *sheet, float share)
{
    const FlRect part = sheet->wet;
    for (int y = part.y; y < part.y + part.height; y++)
        for (int x = part.x; x < part.x + part.width; x++) {
            FlWetCell *cell = &sheet->cell[(size_t)y * (size_t)sheet->page.width + (size_t)x];
            cell->front *= share, cell->stain *= share, cell->film *= share;
        }
}

/** The rectangle grows by a cell. */
static FlWetCell *cell_at(FlWetSheet *sheet, int32_t at)
{
    const FlRect one = {at % sheet->page.width, at / sheet->page.width, 1, 1};
    sheet->wet = fl_rect_or(sheet->wet, one);
    return &sheet->cell[at];
}

static float between(float a, float b, float weight)
{
    return a + (b - a) * weight;
}

/** A cell has one stain, the stronger: the weaker leaves no trace. */
static void stain_cell(const FlWetSheet *sheet, const FlFrontStyle *style, const FlStainMark *mark,
                       FlWetCell *cell)
{
    const float hollow = share_of(fl_wet_sheet_grain(sheet, mark->at).hollow);
    const float old = cell->stain * left_of(sheet, cell->age, hollow);
    const float stain = style->stain * mark->charge;
    cell->front *= 1 - mark->lost;
    if (stain * left_of(sheet, mark->age, hollow) <= old)
        return;
    cell->stain = stain, cell->film = style->film * mark->charge;
    cell->age = mark->age;
    cell->granulation = style->granulation;
    memcpy(cell->ink, mark->ink, sizeof cell->ink);
}

void fl_wet_sheet_stain(FlWetSheet *sheet, const FlFrontStyle *style, const GArray *stains)
{
    for (guint i = 0; i < stains->len; i++) {
        const FlStainMark *mark = &g_array_index(stains, FlStainMark, i);
        stain_cell(sheet, style, mark, cell_at(sheet, mark->at));
    }
}

void fl_wet_sheet_wet(FlWetSheet *sheet, float frames, const GArray *fronts)
{
    const float share = 1 - fl_fall(1.05f * frames); // 0.65 in a frame
    for (guint i = 0; i < fronts->len; i++) {
        const FlFrontMark *mark = &g_array_index(fronts, FlFrontMark, i);
        FlWetCell *cell = cell_at(sheet, mark->at);
        const float more = share * (mark->density - cell->front);
        if (more <= 0)
            continue;
        for (int c = 0; c < 3; c++)
            cell->front_ink[c] =
                between(cell->front_ink[c], mark->ink[c], more / (cell->front + more));
        cell->front += more;
    }
}

/** The density of a cell's stain at a place of the cell. */
static float stain_at(const FlWetSheet *sheet, const FlWetCell *cell, float hollow, float spot)
{
    if (cell->stain <= 0 && cell->film <= 0)
        return 0;
    const float late = 0.5f * (hollow + spot), g = cell->granulation;
    const float film = cell->film * fl_ease(0, 0.9f, (1.2f + 3.6f * late - cell->age) / 1.6f);
    const float grain = 1 - 0.55f * g + 1.1f * g * (hollow - 0.5f);
    const float stain = cell->stain * left_of(sheet, cell->age, hollow) * CLAMP(grain, 0.1f, 1.4f);
    return film + stain - film * stain;
}

/** The light that marks let through, as straight RGBA over the paper. */
static bool pixel_of(const float ink[3], float cover, const uint8_t paper[3], uint8_t rgba[4])
{
    float through[3], least = 1;
    for (int c = 0; c < 3; c++) {
        through[c] = fl_fall(STRENGTH * cover * ink[c]);
        least = MIN(least, through[c]);
    }
    const int alpha = (int)ceilf(255 * (1 - least) - 0.25f);
    if (alpha <= 0)
        return false;
    const float hidden = (float)alpha / 255;
    for (int c = 0; c < 3; c++) {
        const float own = (float)paper[c] * (through[c] - 1 + hidden) / hidden;
        rgba[c] = (uint8_t)(CLAMP(own, 0, 255) + 0.5f);
    }
    rgba[3] = (uint8_t)alpha;
    return true;
}

/** Four cells around a place, by their shares. */
static FlWetCell mix_cells(const FlWetSheet *sheet, float x, float y)
{
    const FlRect page = sheet->page;
    const float cx = CLAMP(x, 0, (float)page.width - 1), cy = CLAMP(y, 0, (float)page.height - 1);
    const int ix = (int)cx, iy = (int)cy;
    FlWetCell mixed = {0};
    float front = 0, stain = 0;
    for (int k = 0; k < 4; k++) {
        const int column = MIN(ix + k % 2, page.width - 1), row = MIN(iy + k / 2, page.height - 1);
        const float tx = cx - (float)ix, ty = cy - (float)iy;
        const float share = (k % 2 ? tx : 1 - tx) * (k / 2 ? ty : 1 - ty);
        const FlWetCell *cell = &sheet->cell[(size_t)row * (size_t)page.width + (size_t)column];
        const float of_front = share * cell->front, of_stain = share * (cell->stain + cell->film);
        mixed.front += of_front;
        mixed.stain += share * cell->stain, mixed.film += share * cell->film;
        front += of_front, stain += of_stain;
        mixed.age += of_stain * cell->age, mixed.granulation += of_stain * cell->granulation;
        for (int c = 0; c < 3; c++) {
            mixed.front_ink[c] += of_front * cell->front_ink[c];
            mixed.ink[c] += of_stain * cell->ink[c];
        }
    }
    for (int c = 0; c < 3; c++) {
        mixed.front_ink[c] /= MAX(front, 1e-9f);
        mixed.ink[c] /= MAX(stain, 1e-9f);
    }
    mixed.age /= MAX(stain, 1e-9f), mixed.granulation /= MAX(stain, 1e-9f);
    return mixed;
}

static bool mark_pixel(const FlWetSheet *sheet, int px, int py, const uint8_t paper[3],
                       uint8_t rgba[4])
{
    const float scale = (float)sheet->width / (float)sheet->page.width;
    const bool same = sheet->width == sheet->page.width;
    const FlWetCell cell = same ? sheet->cell[(size_t)py * (size_t)sheet->width + (size_t)px]
                                : mix_cells(sheet, ((float)px + 0.5f) / scale - 0.5f,
                                            ((float)py + 0.5f) / scale - 0.5f);
    if (cell.front + cell.stain + cell.film < LEAST)
        return false;
    const FlPaperGrains grain = grain_at(sheet, px, py);
    const float stain = stain_at(sheet, &cell, share_of(grain.hollow), share_of(grain.spot));
    const float sum = stain + cell.front;
    float ink[3];
    for (int c = 0; c < 3; c++)
        ink[c] = (stain * cell.ink[c] + cell.front * cell.front_ink[c]) / MAX(sum, 1e-6f);
    return pixel_of(ink, 1 - (1 - MIN(stain, 1)) * (1 - cell.front), paper, rgba);
}

bool fl_wet_sheet_layer(const FlWetSheet *sheet, const uint8_t paper[3], FlStainLayer *layer,
                        GError **error)
{
    const float scale = (float)sheet->width / (float)sheet->page.width;
    const FlRect wet = sheet->wet, frame = {0, 0, sheet->width, sheet->height};
    const int x0 = (int)(scale * (float)(wet.x - 1)), y0 = (int)(scale * (float)(wet.y - 1));
    const int x1 = (int)ceilf(scale * (float)(wet.x + wet.width + 1));
    const int y1 = (int)ceilf(scale * (float)(wet.y + wet.height + 1));
    const FlRect box = fl_rect_and(fl_rect_between(MAX(x0, 0), MAX(y0, 0), x1, y1), frame);
    *layer = (FlStainLayer){.box = box};
    if (wet.width == 0 || box.width == 0)
        return true;
    if (!(layer->rgba = fl_alloc(4 * fl_rect_pixels(box), 1, "the paper's marks", error)))
        return false;
    int found = 0;
#pragma omp parallel for schedule(static) reduction(+ : found)
    for (int y = 0; y < box.height; y++)
        for (int x = 0; x < box.width; x++) {
            uint8_t *rgba = layer->rgba + 4 * ((size_t)y * (size_t)box.width + (size_t)x);
            found += mark_pixel(sheet, box.x + x, box.y + y, paper, rgba);
        }
    if (found == 0)
        g_clear_pointer(&layer->rgba, free);
    return true;
}
