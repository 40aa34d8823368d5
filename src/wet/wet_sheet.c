#include "wet/wet_sheet.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "base/row_kernels.h"
#include <math.h>
#include <string.h>

#define FRONT_FRAMES 2.2f // in which a front dries
#define GONE_FRAMES 36    // after which a stain is gone
#define STRENGTH 0.9f     // of absorbances on the paper
#define FRAYED_PX 14      // px of the page to which the sides of a stain break up, at most

/** The grain of the paper, once for the film: the pictures have the sheet's. */
static void find_grain(FlWetSheet *sheet)
{
    const int width = sheet->width, height = sheet->height;
    const float px = sheet->px * (float)sheet->cell_px;
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
    if (!(sheet->cell = fl_alloc(n, sizeof *sheet->cell, "the paper's marks", error)))
        return false;
    if (sheet->grain)
        return true;
    if (!(sheet->grain = fl_alloc_unset(pixels, sizeof *sheet->grain, "paper", error)))
        return false;
    find_grain(sheet);
    return true;
}

void fl_wet_sheet_begin(FlWetSheet *sheet)
{
    memset(sheet->cell, 0, fl_rect_pixels(sheet->page) * sizeof *sheet->cell);
    sheet->wet = (FlRect){0};
    sheet->fibres.place = FL_AFFINE_NONE;
    sheet->shift_x = sheet->shift_y = 0;
}

void fl_wet_sheet_clear(FlWetSheet *sheet)
{
    free(sheet->cell);
    free(sheet->grain);
    *sheet = (FlWetSheet){0};
}

static int wrapped(double x, int size)
{
    const int rest = (int)floor(x) % size;
    return rest < 0 ? rest + size : rest;
}

/** The grain at a px of the cells, which moves and turns with the paper. */
static FlPaperGrains grain_at(const FlWetSheet *sheet, int x, int y)
{
    const FlAffine *place = &sheet->fibres.place;
    const double c = sheet->cell_px;
    const int column = wrapped(place->xx * x + place->xy * y + c * place->x0, sheet->width);
    const int row = wrapped(place->yx * x + place->yy * y + c * place->y0, sheet->height);
    return sheet->grain[(size_t)row * (size_t)sheet->width + (size_t)column];
}

FlPaperGrains fl_wet_sheet_grain(const FlWetSheet *sheet, int32_t at)
{
    const int c = sheet->cell_px;
    return grain_at(sheet, c * (at % sheet->page.width) + c / 2,
                    c * (at / sheet->page.width) + c / 2);
}

/** The contents of a cell, so that they can be mixed by shares. */
typedef enum Channel {
    FRONTS, // 1 where there is a front
    FRONT,
    EDGE,
    LINE,   // times the front
    STAINS, // 1 where there is a stain
    STAIN,
    FILM,
    DEPTH,
    AGE,         // times stain and film
    GRANULATION, // times all paint, and so are
    INK,         // three
    N_CHANNELS = INK + 3,
} Channel;

static void read_cell(const FlWetCell *cell, float to[N_CHANNELS])
{
    const float stain = cell->stain + cell->film, paint = stain + cell->front;
    to[FRONTS] = cell->front > 0, to[STAINS] = stain > 0;
    to[FRONT] = cell->front, to[EDGE] = cell->front > 0 ? cell->edge : -1;
    to[LINE] = cell->front * cell->line;
    to[STAIN] = cell->stain, to[FILM] = cell->film;
    to[DEPTH] = stain > 0 ? cell->depth : -1;
    to[AGE] = stain * cell->age, to[GRANULATION] = paint * cell->granulation;
    for (int c = 0; c < 3; c++)
        to[INK + c] = paint * cell->ink[c];
}

/** The paint at a place between cells. */
static FlWetCell cell_between(const FlWetSheet *sheet, FlPoint at)
{
    const int x = (int)floor(at.x), y = (int)floor(at.y);
    const float right = (float)(at.x - x), below = (float)(at.y - y);
    float sum[N_CHANNELS] = {0}, own[N_CHANNELS];
    for (int k = 0; k < 4; k++) {
        const int column = x + k % 2, row = y + k / 2;
        const float share = (k % 2 ? right : 1 - right) * (k / 2 ? below : 1 - below);
        const bool there =
            column >= 0 && row >= 0 && column < sheet->page.width && row < sheet->page.height;
        const size_t cell = (size_t)row * (size_t)sheet->page.width + (size_t)column;
        read_cell(there ? &sheet->cell[cell] : &(FlWetCell){0}, own);
        for (int c = 0; c < N_CHANNELS; c++)
            sum[c] += share * own[c];
    }
    const float wet = MAX(sum[STAIN] + sum[FILM], 1e-9f), paint = MAX(sum[FRONT] + wet, 1e-9f);
    return (FlWetCell){.front = sum[FRONT],
                       .edge = sum[EDGE],
                       .line = sum[LINE] / MAX(sum[FRONT], 1e-9f),
                       .stain = sum[STAIN],
                       .film = sum[FILM],
                       .age = sum[AGE] / wet,
                       .depth = sum[DEPTH],
                       .granulation = sum[GRANULATION] / paint,
                       .ink = {sum[INK] / paint, sum[INK + 1] / paint, sum[INK + 2] / paint}};
}

bool fl_wet_sheet_turn(FlWetSheet *sheet, const FlAffine *from, GError **error)
{
    const FlRect page = sheet->page;
    FlWetCell *moved = fl_alloc(fl_rect_pixels(page), sizeof *moved, "the paper's marks", error);
    FlRect wet = {0, 0, 0, 0};
    if (!moved)
        return false;
    for (int y = 0; y < page.height; y++)
        for (int x = 0; x < page.width; x++) {
            const FlPoint at = fl_affine_apply(from, (FlPoint){x, y});
            const FlRect near = {(int)floor(at.x), (int)floor(at.y), 2, 2};
            if (!fl_rect_meet(near, sheet->wet))
                continue;
            moved[(size_t)y * (size_t)page.width + (size_t)x] = cell_between(sheet, at);
            wet = fl_rect_or(wet, (FlRect){x, y, 1, 1});
        }
    free(sheet->cell);
    sheet->cell = moved;
    sheet->wet = wet;
    sheet->fibres.place = fl_affine_multiply(&sheet->fibres.place, from);
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

/** Mixes paint that comes to a cell with the cell's own: ink and granulation by their amounts. */
static void add_ink(FlWetCell *cell, float more, const float ink[3], float granulation)
{
    const float share = more / (cell->front + cell->stain + cell->film + more);
    for (int c = 0; c < 3; c++)
        cell->ink[c] = fl_wet_between(cell->ink[c], ink[c], share);
    cell->granulation = fl_wet_between(cell->granulation, granulation, share);
}

/** The depth to which a stain breaks up from its sides, cells. */
static float frayed_to(const FlWetSheet *sheet, float hollow, float spot)
{
    return FRAYED_PX * sheet->px * (1 - 0.3f * hollow - 0.7f * spot);
}

/** The share of an earlier stain that passing paint leaves: the new stain breaks up towards its
 * sides, and the earlier one is seen between its pieces. */
static float seen_between(const FlWetSheet *sheet, const FlStainMark *mark, FlPaperGrains grain,
                          const FlWetCell *cell)
{
    const float fray = frayed_to(sheet, share_of(grain.hollow), share_of(grain.spot));
    return fl_ease(-sheet->px, sheet->px, fray - mark->depth) *
           fl_ease(0, 2 * sheet->px, cell->depth - mark->depth);
}

/** Paint that passes takes up the stain in its way. A cell has one stain: the stronger, into which
 * the weaker turns as their strengths meet. */
static void stain_cell(const FlWetSheet *sheet, const FlFrontStyle *style, const FlStainMark *mark,
                       FlWetCell *cell)
{
    const FlPaperGrains grain = fl_wet_sheet_grain(sheet, mark->at);
    const float hollow = share_of(grain.hollow);
    const float seen = mark->depth > 0 ? seen_between(sheet, mark, grain, cell) : 1;
    const float stain = style->stain * mark->charge, film = style->film * mark->charge;
    const float stays = 1 - mark->lost * (1 - seen);
    cell->front *= 1 - mark->lost;
    cell->stain *= stays, cell->film *= stays;
    const float old = cell->depth > 0 ? cell->stain * left_of(sheet, cell->age, hollow) : 0;
    const float fresh = stain * left_of(sheet, mark->age, hollow);
    const float own = (1 - seen * MIN(4 * old / MAX(fresh, 1e-9f), 1)) *
                      fl_ease(0.6f, 1, fresh / MAX(old, 1e-9f));
    if (own <= 0 || (mark->depth <= 0 && old > 0))
        return;
    cell->stain *= 1 - own, cell->film *= 1 - own;
    add_ink(cell, own * (stain + film), mark->ink, style->granulation);
    cell->stain += own * stain, cell->film += own * film;
    cell->age = fl_wet_between(cell->age, mark->age, own);
    cell->depth = fl_wet_between(cell->depth, mark->depth, own);
}

void fl_wet_sheet_stain(FlWetSheet *sheet, const FlFrontStyle *style, const GArray *stains)
{
    for (guint i = 0; i < stains->len; i++) {
        const FlStainMark *mark = &g_array_index(stains, FlStainMark, i);
        stain_cell(sheet, style, mark, cell_at(sheet, mark->at));
    }
}

void fl_wet_sheet_wet(FlWetSheet *sheet, const FlFrontStyle *style, float frames,
                      const GArray *fronts)
{
    const float share = 1 - fl_fall(1.05f * frames); // 0.65 in a frame
    for (guint i = 0; i < fronts->len; i++) {
        const FlFrontMark *mark = &g_array_index(fronts, FlFrontMark, i);
        FlWetCell *cell = cell_at(sheet, mark->at);
        const float more = share * (mark->density - cell->front);
        if (cell->front <= 0)
            cell->edge = -1;
        cell->edge += share * MAX(mark->edge - cell->edge, 0);
        if (more <= 0)
            continue;
        const float fresh = more / (more + 4 * cell->front); // a front that has faded hardly counts
        cell->edge += fresh * MIN(mark->edge - cell->edge, 0);
        const float seen = 0.02f + 0.98f * fl_ease(-0.5f, 1, cell->edge); // a stain keeps its ink
        add_ink(cell, seen * more, mark->ink, style->granulation);
        cell->line = fl_wet_between(cell->line, mark->line, more / (cell->front + more));
        cell->front += more;
    }
}

/* ---- the layer ------------------------------------------------------------------------------ */

/** Room for a thread: rows of cells, with two more at both ends. A row of px is done in turns: px 0
 * of all cells, then px 1. */
typedef struct LayerRows {
    int at;        // of the lower row of cells; -1: none is read
    FlColumns wet; // cells in which the two rows are
    float *upper[N_CHANNELS], *lower[N_CHANNELS], *mixed[N_CHANNELS];
    float *px[N_CHANNELS], *hollow, *spot;
    float *through[3]; // light that the marks let through
    float *room;
} LayerRows;

static void layer_rows_init(LayerRows *rows, const FlWetSheet *sheet)
{
    const size_t n = (size_t)sheet->page.width + 4;
    float **const list[] = {rows->upper, rows->lower, rows->mixed, rows->px};
    float **const more[] = {&rows->hollow, &rows->spot, &rows->through[0], &rows->through[1],
                            &rows->through[2]};
    float *next = rows->room = g_new(float, n *(4 * N_CHANNELS + G_N_ELEMENTS(more)));
    for (size_t k = 0; k < G_N_ELEMENTS(list); k++)
        for (int c = 0; c < N_CHANNELS; c++, next += n)
            list[k][c] = next + 2;
    for (size_t k = 0; k < G_N_ELEMENTS(more); k++, next += n)
        *more[k] = next + 2;
    rows->at = -1;
}

/** Reads a row of cells, and what lies beyond both ends. Returns: those that are wet. */
static FlColumns read_cells(const FlWetSheet *sheet, int y, float *const *to)
{
    const int n = sheet->page.width;
    const FlRect near = fl_rect_grown(sheet->wet, 3, (FlRect){-2, 0, n + 4, sheet->page.height});
    const FlWetCell *cells = sheet->cell + (size_t)y * (size_t)n;
    FlColumns wet = {n, 0};
    for (int x = near.x; x < near.x + near.width; x++) {
        float own[N_CHANNELS];
        read_cell(&cells[CLAMP(x, 0, n - 1)], own);
        for (int c = 0; c < N_CHANNELS; c++)
            to[c][x] = own[c];
        if (own[FRONTS] > 0 || own[STAINS] > 0)
            wet = (FlColumns){MIN(wet.first, x), x + 1};
    }
    return (FlColumns){MAX(wet.first - 1, -1), MIN(wet.last + 1, n + 1)};
}

/** Mixes what two planes have by a share of the second. */
static void mix(float *const *a, float *const *b, int right, float share, FlColumns columns,
                float *const *to)
{
    for (int c = 0; c < N_CHANNELS; c++) {
        const float *one = a[c], *other = b[c] + right;
        float *mixed = to[c];
        for (int x = columns.first; x < columns.last; x++)
            mixed[x] = one[x] + share * (other[x] - one[x]);
    }
}

/** The cell before a px of those of a cell, 0 or -1 from that, and the share of the one after. */
static int cell_before(const FlWetSheet *sheet, int px, float *share)
{
    const float at = ((float)px + 0.5f) / (float)sheet->cell_px - 0.5f;
    *share = at < 0 ? at + 1 : at;
    return at < 0 ? -1 : 0;
}

/** The grain of px x of each cell, in row y of the px of cells. */
static void read_grain(const FlWetSheet *sheet, int x, int y, FlColumns columns,
                       const LayerRows *rows)
{
    for (int i = columns.first; i < columns.last; i++) {
        const FlPaperGrains own = grain_at(sheet, sheet->cell_px * i + x, y);
        rows->hollow[i] = share_of(own.hollow), rows->spot[i] = share_of(own.spot);
    }
}

/** A front is as sharp as the px: it ends where its edge is 0. A stain breaks up towards its sides
 * with the paper's grain, but not where a front is still wet. */
static inline void shine_in_columns(const FlWetSheet *on, FlColumns columns, const LayerRows *rows)
{
    const FlWetSheet own = *on, *sheet = &own; // apart from what is written
    float *const *m = rows->px;
    const float cell_px = (float)sheet->cell_px;
    const float soft = 0.3f * FRAYED_PX * sheet->px * cell_px;
#pragma omp simd
    for (int x = columns.first; x < columns.last; x++) {
        const float hollow = rows->hollow[x], spot = rows->spot[x];
        const float fronts = MAX(m[FRONTS][x], 1e-6f), stains = MAX(m[STAINS][x], 1e-6f);
        const float wet = MAX(m[STAIN][x] + m[FILM][x], 1e-9f);
        const float paint = m[FRONT][x] + wet;
        const float g = m[GRANULATION][x] / paint, age = m[AGE][x] / wet;
        const float grain = 0.86f + 0.5f * g * (hollow - 0.5f) + 0.2f * spot;
        const float tip = m[LINE][x] * fl_bell(1.3f * (m[EDGE][x] - 0.6f));
        const float front =
            MIN(fl_ease(0, 1, m[EDGE][x]) * (m[FRONT][x] * grain + tip) / fronts, 1);
        const float inside = m[DEPTH][x] / stains / (FRAYED_PX * sheet->px);
        const float late = 0.3f * (hollow + spot) + 0.4f * inside;
        const float film = m[FILM][x] * fl_ease(0, 0.9f, (1.2f + 3.6f * late - age) / 1.6f);
        const float coarse = CLAMP(1 - 0.55f * g + 1.1f * g * (hollow - 0.5f), 0.1f, 1.4f);
        const float pigment = m[STAIN][x] * left_of(sheet, age, hollow) * coarse;
        const float frayed = frayed_to(sheet, hollow, spot) * (1 - MIN(3 * front, 1));
        const float sides = fl_ease(-0.5f, soft, (m[DEPTH][x] - frayed) * cell_px) / stains;
        const float stain = MIN(sides * (film + pigment - film * pigment / stains), 1);
        const float dense = STRENGTH * (1 - (1 - stain) * (1 - front)) / paint;
        rows->through[0][x] = fl_fall(dense * m[INK][x]);
        rows->through[1][x] = fl_fall(dense * m[INK + 1][x]);
        rows->through[2][x] = fl_fall(dense * m[INK + 2][x]);
    }
}

FL_FOR_EACH_CPU(shine_through, shine_in_columns,
                (const FlWetSheet *sheet, FlColumns columns, const LayerRows *rows),
                (sheet, columns, rows))

/** The light that marks let through, as straight RGBA over the paper. Returns: true if any is
 * missing. */
static bool write_px(const FlWetSheet *sheet, const LayerRows *rows, int x, FlColumns columns,
                     const uint8_t paper[3], FlColumns part, uint8_t *rgba)
{
    bool any = false;
    for (int i = columns.first; i < columns.last; i++) {
        const float through[3] = {rows->through[0][i], rows->through[1][i], rows->through[2][i]};
        const float least = MIN(MIN(through[0], through[1]), through[2]);
        const int alpha = (int)(255 * (1 - least) + 0.75f);
        const int px = sheet->cell_px * i + x + sheet->shift_x;
        if (alpha <= 0 || px < part.first || px >= part.last)
            continue;
        const float shown = 255 / (float)alpha;
        uint8_t *to = rgba + 4 * (px - part.first);
        for (int c = 0; c < 3; c++) {
            const float own = (float)paper[c] * (1 - (1 - through[c]) * shown);
            to[c] = (uint8_t)(CLAMP(own, 0, 255) + 0.5f);
        }
        to[3] = (uint8_t)alpha;
        any = true;
    }
    return any;
}

/** A row of px of the layer. Returns: true if any is marked. */
static bool layer_row(const FlWetSheet *sheet, LayerRows *rows, int y, FlColumns part,
                      const uint8_t paper[3], uint8_t *rgba)
{
    const int cell_px = sheet->cell_px, last = sheet->page.height - 1;
    float share;
    const int place = y - sheet->shift_y + cell_px; // of the cell above the page it would be 0
    const int at = place / cell_px + cell_before(sheet, place % cell_px, &share);
    if (at != rows->at) {
        const FlColumns upper = read_cells(sheet, CLAMP(at - 1, 0, last), rows->upper);
        const FlColumns lower = read_cells(sheet, CLAMP(at, 0, last), rows->lower);
        rows->wet = (FlColumns){MIN(upper.first, lower.first), MAX(upper.last, lower.last)};
        rows->at = at;
    }
    const FlColumns wet = rows->wet, around = {wet.first - 1, wet.last + 1};
    bool any = false;
    if (wet.first >= wet.last)
        return false;
    mix(rows->upper, rows->lower, 0, share, around, rows->mixed);
    for (int x = 0; x < cell_px; x++) {
        const int left = cell_before(sheet, x, &share);
        if (left < 0)
            mix(rows->mixed, rows->mixed, -1, 1 - share, wet, rows->px);
        else
            mix(rows->mixed, rows->mixed, 1, share, wet, rows->px);
        read_grain(sheet, x, y - sheet->shift_y, wet, rows);
        shine_through(sheet, wet, rows);
        any = write_px(sheet, rows, x, wet, paper, part, rgba) || any;
    }
    return any;
}

bool fl_wet_sheet_layer(const FlWetSheet *sheet, const uint8_t paper[3], FlStainLayer *layer,
                        GError **error)
{
    const FlRect wet = sheet->wet, frame = {0, 0, sheet->width, sheet->height};
    const int c = sheet->cell_px;
    const FlRect near = {c * (wet.x - 1) + sheet->shift_x, c * (wet.y - 1) + sheet->shift_y,
                         c * (wet.width + 2), c * (wet.height + 2)};
    const FlRect box = fl_rect_and(near, frame);
    *layer = (FlStainLayer){.box = box};
    if (wet.width == 0 || box.width == 0)
        return true;
    if (!(layer->rgba = fl_alloc(4 * fl_rect_pixels(box), 1, "the paper's marks", error)))
        return false;
    int found = 0;
#pragma omp parallel reduction(+ : found)
    {
        LayerRows rows;
        layer_rows_init(&rows, sheet);
#pragma omp for schedule(static)
        for (int y = box.y; y < box.y + box.height; y++)
            found += layer_row(sheet, &rows, y, (FlColumns){box.x, box.x + box.width}, paper,
                               layer->rgba + 4 * (size_t)(y - box.y) * (size_t)box.width);
        g_free(rows.room);
    }
    if (found == 0)
        g_clear_pointer(&layer->rgba, free);
    return true;
}
