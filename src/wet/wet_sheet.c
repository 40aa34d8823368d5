#include "wet/wet_sheet.h"

#include "base/alloc.h"
#include "base/cpu.h"
#include "base/curves.h"
#include <math.h>
#include <string.h>

#define FRONT_FRAMES 2.2f // in which a front dries
#define GONE_FRAMES 36    // after which a stain is gone
#define STRENGTH 0.9f     // of absorbances on the paper
#define BODY 0.85f        // least opacity of marks, by their cover
#define FRAYED_PX 14      // px of the page to which the sides of a stain break up, at most

bool fl_wet_sheet_init(FlWetSheet *sheet, GError **error)
{
    const size_t n = fl_rect_pixels(sheet->page);
    const size_t pixels = (size_t)sheet->width * (size_t)sheet->height;
    if (!(sheet->cell = fl_alloc(n, sizeof *sheet->cell, "the paper's marks", error)))
        return false;
    if (sheet->grain)
        return true;
    return (sheet->grain = fl_alloc_scratch(pixels, sizeof *sheet->grain, "paper", error)) != NULL;
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
    const int whole = (int)floor(x), rest = whole >= 0 && whole < size ? whole : whole % size;
    return rest < 0 ? rest + size : rest;
}

/** The grain at a px of the paper, found where it is asked for: most of a page stays dry. */
static FlPaperGrains find_grain(const FlWetSheet *sheet, int x, int y)
{
    uint16_t *known = &sheet->grain[(size_t)y * (size_t)sheet->width + (size_t)x];
    uint16_t grain = __atomic_load_n(known, __ATOMIC_RELAXED);
    if (grain == 0) {
        const float px = sheet->px * (float)sheet->cell_px;
        const float i = ((float)x + 0.5f) / px, j = ((float)y + 0.5f) / px;
        const int hollow = (int)(255 * fl_fibres_hollow(&sheet->fibres, i, j) + 0.5f);
        const int spot = (int)(255 * fl_fibres_spot(&sheet->fibres, i, j) + 0.5f);
        grain = (uint16_t)(hollow << 8 | spot);
        __atomic_store_n(known, grain, __ATOMIC_RELAXED);
    }
    return (FlPaperGrains){(uint8_t)(grain >> 8), (uint8_t)grain};
}

/** The grain at a px of the cells, which moves and turns with the paper. */
static FlPaperGrains grain_at(const FlWetSheet *sheet, int x, int y)
{
    const FlAffine *place = &sheet->fibres.place;
    const double c = sheet->cell_px;
    const int column = wrapped(place->xx * x + place->xy * y + c * place->x0, sheet->width);
    const int row = wrapped(place->yx * x + place->yy * y + c * place->y0, sheet->height);
    return find_grain(sheet, column, row);
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

static bool is_wet(const FlWetCell *cell)
{
    return cell->front > 0 || cell->stain > 0 || cell->film > 0;
}

/** The sums of the contents around a place between cells, by shares; beyond the page all is dry. */
static void mix_cells(const FlWetSheet *sheet, FlPoint at, float sum[N_CHANNELS])
{
    const int x = (int)floor(at.x), y = (int)floor(at.y);
    const float right = (float)(at.x - x), below = (float)(at.y - y);
    memset(sum, 0, N_CHANNELS * sizeof *sum);
    for (int k = 0; k < 4; k++) {
        const int column = x + k % 2, row = y + k / 2;
        const float share = (k % 2 ? right : 1 - right) * (k / 2 ? below : 1 - below);
        if (share <= 0)
            continue;
        const bool there =
            column >= 0 && row >= 0 && column < sheet->page.width && row < sheet->page.height;
        const FlWetCell *cell =
            there ? &sheet->cell[(size_t)row * (size_t)sheet->page.width + (size_t)column] : NULL;
        if (!cell || !is_wet(cell)) {
            sum[EDGE] -= share, sum[DEPTH] -= share;
            continue;
        }
        float own[N_CHANNELS];
        read_cell(cell, own);
        for (int c = 0; c < N_CHANNELS; c++)
            sum[c] += share * own[c];
    }
}

/** The paint at a place between cells. */
static FlWetCell cell_between(const FlWetSheet *sheet, FlPoint at)
{
    float sum[N_CHANNELS];
    mix_cells(sheet, at, sum);
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
    sheet->fibres.place = fl_affine_multiply(sheet->fibres.place, *from);
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
            if (is_wet(cell))
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

/** The share of a cell's earlier stain that passing paint leaves: the new stain breaks up towards
 * its sides, and the earlier one is seen between its pieces. */
static float seen_between(const FlWetSheet *sheet, const FlStainMark *mark, const FlWetCell *cell)
{
    if (mark->depth <= 0)
        return 1;
    const FlPaperGrains grain = fl_wet_sheet_grain(sheet, mark->at);
    const float fray = frayed_to(sheet, share_of(grain.hollow), share_of(grain.spot));
    return fl_ease(-sheet->px, sheet->px, fray - mark->depth) *
           fl_ease(0, 2 * sheet->px, cell->depth - mark->depth);
}

void fl_wet_sheet_take_up(FlWetSheet *sheet, const GArray *stains)
{
    for (guint i = 0; i < stains->len; i++) {
        const FlStainMark *mark = &g_array_index(stains, FlStainMark, i);
        FlWetCell *cell = cell_at(sheet, mark->at);
        const float stays = 1 - mark->lost * (1 - seen_between(sheet, mark, cell));
        cell->front *= 1 - mark->lost;
        cell->stain *= stays, cell->film *= stays;
    }
}

/** A cell has one stain: the stronger, into which the weaker turns as their strengths meet. */
static void stain_cell(const FlWetSheet *sheet, const FlFrontStyle *style, const FlStainMark *mark,
                       FlWetCell *cell)
{
    const float hollow = share_of(fl_wet_sheet_grain(sheet, mark->at).hollow);
    const float seen = seen_between(sheet, mark, cell);
    const float stain = style->stain * mark->charge, film = style->film * mark->charge;
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

#define BATCH 256 // px that are found side by side

/** The contents of some px of a row, the paper there, and the light that they let through. */
typedef struct Batch {
    int n, px[BATCH];
    float contents[N_CHANNELS][BATCH], hollow[BATCH], spot[BATCH], through[3][BATCH], cover[BATCH];
} Batch;

/** Finds the light of each px. A front is as sharp as the px: it ends where its edge is 0. A stain
 * breaks up towards its sides with the paper's grain, but not where a front is still wet. */
static inline void shine_through(const FlWetSheet *on, Batch *restrict batch)
{
    const FlWetSheet own = *on, *sheet = &own; // apart from what is written
    const float cell_px = (float)sheet->cell_px;
    const float soft = 0.3f * FRAYED_PX * sheet->px * cell_px;
#pragma omp simd
    for (int i = 0; i < batch->n; i++) {
        float(*const m)[BATCH] = batch->contents;
        const float hollow = batch->hollow[i], spot = batch->spot[i];
        const float fronts = MAX(m[FRONTS][i], 1e-6f), stains = MAX(m[STAINS][i], 1e-6f);
        const float wet = MAX(m[STAIN][i] + m[FILM][i], 1e-9f);
        const float paint = m[FRONT][i] + wet;
        const float g = m[GRANULATION][i] / paint, age = m[AGE][i] / wet;
        const float grain = 0.86f + 0.5f * g * (hollow - 0.5f) + 0.2f * spot;
        const float tip = m[LINE][i] * fl_bell(1.3f * (m[EDGE][i] - 0.6f));
        const float front =
            MIN(fl_ease(0, 1, m[EDGE][i]) * (m[FRONT][i] * grain + tip) / fronts, 1);
        const float inside = m[DEPTH][i] / stains / (FRAYED_PX * sheet->px);
        const float late = 0.2f * hollow + 0.6f * spot + 0.2f * inside;
        const float dry = 1.2f + 4.6f * late; // frames
        const float film = m[FILM][i] * (1 - fl_ease(0.2f * dry, dry, age));
        const float coarse = CLAMP(1 - 0.55f * g + 1.1f * g * (hollow - 0.5f), 0.1f, 1.4f);
        const float pigment = m[STAIN][i] * left_of(sheet, age, hollow) * coarse;
        const float frayed = frayed_to(sheet, hollow, spot) * (1 - MIN(3 * front, 1));
        const float sides = fl_ease(-0.5f, soft, (m[DEPTH][i] - frayed) * cell_px) / stains;
        const float stain = MIN(sides * (film + pigment - film * pigment / stains), 1);
        batch->cover[i] = 1 - (1 - stain) * (1 - front);
        const float dense = STRENGTH * batch->cover[i] / paint;
        batch->through[0][i] = fl_fall(dense * m[INK][i]);
        batch->through[1][i] = fl_fall(dense * m[INK + 1][i]);
        batch->through[2][i] = fl_fall(dense * m[INK + 2][i]);
    }
}

FL_FOR_EACH_CPU(find_light, shine_through, (const FlWetSheet *sheet, Batch *batch), (sheet, batch))

/** The light that marks let through, as straight RGBA over the paper. Pale marks have the paper's
 * colour and a body, which lightens a dark ground. Returns: true if any light is missing. */
static bool write_px(const float through[3], float cover, const uint8_t paper[3], uint8_t *rgba)
{
    const float least = MIN(MIN(through[0], through[1]), through[2]);
    const int alpha = (int)(255 * MAX(1 - least, BODY * cover) + 0.75f);
    const float shown = 255 / (float)MAX(alpha, 1);
    for (int c = 0; c < 3 && alpha > 0; c++) {
        const float own = (float)paper[c] * (1 - (1 - through[c]) * shown);
        rgba[c] = (uint8_t)(CLAMP(own, 0, 255) + 0.5f);
    }
    rgba[3] = (uint8_t)MAX(alpha, 0);
    return alpha > 0;
}

/** The place of a px on one axis of the cells, which go on beyond the page as at its edge. */
static float place_of(const FlWetSheet *sheet, int px, int n_cells)
{
    const float at = ((float)px + 0.5f) / (float)sheet->cell_px - 0.5f;
    return CLAMP(at, 0, (float)(n_cells - 1));
}

/** Adds px of row y to a batch, from px `first` on, until it is full. Returns: the next px. */
static int fill_batch(const FlWetSheet *sheet, float (*cells)[N_CHANNELS], int y, int first,
                      int end, Batch *batch)
{
    const FlRect page = sheet->page, near = fl_rect_grown(sheet->wet, 1, page);
    int px = first;
    for (batch->n = 0; px < end && batch->n < BATCH; px++) {
        const float x = place_of(sheet, px - sheet->shift_x, page.width);
        const int left = CLAMP((int)x, near.x, near.x + near.width - 1);
        const float *a = cells[left], *b = cells[MIN(left + 1, near.x + near.width - 1)];
        if (a[FRONTS] + a[STAINS] + b[FRONTS] + b[STAINS] <= 0)
            continue;
        const FlPaperGrains grain = grain_at(sheet, px - sheet->shift_x, y - sheet->shift_y);
        const int i = batch->n++;
        for (int c = 0; c < N_CHANNELS; c++)
            batch->contents[c][i] = fl_wet_between(a[c], b[c], CLAMP(x - (float)left, 0, 1));
        batch->px[i] = px;
        batch->hollow[i] = share_of(grain.hollow), batch->spot[i] = share_of(grain.spot);
    }
    return px;
}

/** A row of px of the layer. Returns: true if any is marked. */
static bool layer_row(const FlWetSheet *sheet, float (*cells)[N_CHANNELS], FlRect row,
                      const uint8_t paper[3], uint8_t *rgba)
{
    const FlRect page = sheet->page, near = fl_rect_grown(sheet->wet, 1, page);
    const float y = place_of(sheet, row.y - sheet->shift_y, page.height);
    const int end = row.x + row.width;
    bool any = false;
    Batch batch;
    for (int x = near.x; x < near.x + near.width; x++)
        mix_cells(sheet, (FlPoint){x, (double)y}, cells[x]);
    for (int px = row.x; px < end;) {
        px = fill_batch(sheet, cells, row.y, px, end, &batch);
        find_light(sheet, &batch);
        for (int i = 0; i < batch.n; i++) {
            const float through[3] = {batch.through[0][i], batch.through[1][i],
                                      batch.through[2][i]};
            uint8_t *const to = rgba + 4 * (size_t)(batch.px[i] - row.x);
            any = write_px(through, batch.cover[i], paper, to) || any;
        }
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
        float(*cells)[N_CHANNELS] = g_malloc_n((gsize)sheet->page.width, sizeof *cells);
#pragma omp for schedule(static)
        for (int y = box.y; y < box.y + box.height; y++)
            found += layer_row(sheet, cells, (FlRect){box.x, y, box.width, 1}, paper,
                               layer->rgba + 4 * (size_t)(y - box.y) * (size_t)box.width);
        g_free(cells);
    }
    if (found == 0)
        g_clear_pointer(&layer->rgba, free);
    return true;
}
