#include "synth/occurrence.h"

#include "base/alloc.h"
#include <string.h>

#define TENT_SUM 64       // of [1 2 1] along three axes
#define CELLS_PER_MOVE 96 // that are filtered in the time of a move's two tents

bool fl_occurrence_init(FlOccurrence *map, const FlExemplarLevel *level,
                        const FlTargetLevel *target, const FlParams *params,
                        const FlCostScale *scale, GError **error)
{
    const int frames_per_cell = params->uni_radius + 1;
    *map = (FlOccurrence){.first = level->first};
    map->columns = level->width / FL_CELL + 1;
    map->rows = level->height / FL_CELL + 1;
    map->slice_factor = (uint16_t)((32768 + frames_per_cell - 1) / frames_per_cell);
    map->slices = fl_occurrence_slice(map, level->first + level->window - 1) + 1;
    const size_t cells = (size_t)map->columns * map->rows * map->slices;
    map->most_moves = (int)(cells / CELLS_PER_MOVE);
    const double cell_pixels = FL_CELL * FL_CELL * (double)MIN(frames_per_cell, level->window);
    for (int s = FL_SEGMENT_BORDER; s < FL_SEGMENTS; s++) {
        if (!(map->count[s] = fl_alloc(cells, sizeof(int32_t), "an occurrence map", error)) ||
            !(map->filtered[s] = fl_alloc(cells, sizeof(int32_t), "an occurrence map", error)) ||
            !(map->moves[s] = fl_alloc(cells / CELLS_PER_MOVE + 1, sizeof(FlCellMove),
                                       "an occurrence map", error)))
            return false;
        const double even = TENT_SUM * cell_pixels * MAX(target->n_inside[s], 1) /
                            (double)MAX(level->n_valid[s], 1);
        map->price[s] = (float)(params->w_uni * scale->unit / even);
    }
    return true;
}

void fl_occurrence_clear(FlOccurrence *map)
{
    for (int s = 0; s < FL_SEGMENTS; s++) {
        free(map->count[s]);
        free(map->filtered[s]);
        free(map->moves[s]);
    }
    *map = (FlOccurrence){0};
}

static void count_block(FlOccurrence *map, const FlNnf *nnf, const FlTargetLevel *target,
                        FlRect block)
{
    for (int y = block.y; y < block.y + block.height; y++)
        for (int x = block.x; x < block.x + block.width; x++) {
            const size_t p = (size_t)y * (size_t)nnf->width + (size_t)x;
            const FlMatch m = nnf->match[p];
            if (m.frame != FL_NO_MATCH)
                map->count[target->segment[p]]
                          [fl_occurrence_index(map, fl_occurrence_cell(map, m))]++;
        }
}

void fl_occurrence_count(FlOccurrence *map, const FlNnf *nnf, const FlTargetLevel *target)
{
    const size_t cells = (size_t)map->columns * map->rows * map->slices;
    for (int s = FL_SEGMENT_BORDER; s < FL_SEGMENTS; s++)
        memset(map->count[s], 0, cells * sizeof(int32_t));
    for (int k = 0; k < target->blocks.n; k++)
        count_block(map, nnf, target, target->blocks.block[k]);
    for (int s = FL_SEGMENT_BORDER; s < FL_SEGMENTS; s++)
        map->n_moves[s] = map->most_moves + 1;
    fl_occurrence_refresh(map);
}

void fl_occurrence_move(FlOccurrence *map, FlSegment segment, FlMatch from, FlMatch to)
{
    const size_t old = fl_occurrence_index(map, fl_occurrence_cell(map, from));
    const size_t new = fl_occurrence_index(map, fl_occurrence_cell(map, to));
    if (old == new)
        return;
    if (__atomic_load_n(&map->n_moves[segment], __ATOMIC_RELAXED) <= map->most_moves) {
        const int k = __atomic_fetch_add(&map->n_moves[segment], 1, __ATOMIC_RELAXED);
        if (k < map->most_moves)
            map->moves[segment][k] = (FlCellMove){(uint32_t)old, (uint32_t) new};
    }
    __atomic_fetch_sub(&map->count[segment][old], 1, __ATOMIC_RELAXED);
    __atomic_fetch_add(&map->count[segment][new], 1, __ATOMIC_RELAXED);
}

/* [1 2 1] along one axis; the map is padded with zeros. `n` values that are `step` apart. */
static void filter_lines(int32_t *line, size_t n_lines, size_t line_step, int n, size_t step)
{
    for (size_t k = 0; k < n_lines; k++) {
        int32_t *v = line + k * line_step, before = 0;
        for (int i = 0; i < n; i++) {
            const int32_t here = v[i * step], after = i + 1 < n ? v[(i + 1) * step] : 0;
            v[i * step] = before + 2 * here + after;
            before = here;
        }
    }
}

/* Along an outer axis whole rows are filtered at once, so that the compiler can use vectors. */
static void filter_rows(int32_t *first, int n, size_t row, int32_t *before)
{
    memset(before, 0, row * sizeof *before);
    for (int i = 0; i < n; i++) {
        int32_t *here = first + i * row;
        const int32_t *after = i + 1 < n ? here + row : NULL;
        for (size_t k = 0; k < row; k++) {
            const int32_t value = here[k];
            here[k] = before[k] + 2 * value + (after ? after[k] : 0);
            before[k] = value;
        }
    }
}

static void filter_all(FlOccurrence *map, FlSegment segment)
{
    const size_t slice = (size_t)map->columns * map->rows, cells = slice * map->slices;
    g_autofree int32_t *before = g_new(int32_t, slice);
    int32_t *f = map->filtered[segment];
    memcpy(f, map->count[segment], cells * sizeof *f);
    filter_lines(f, (size_t)map->rows * map->slices, map->columns, map->columns, 1);
    for (int t = 0; t < map->slices; t++)
        filter_rows(f + t * slice, map->rows, map->columns, before);
    filter_rows(f, map->slices, slice, before);
}

/* Adds `times` the tent around a cell. */
static void add_tent(FlOccurrence *map, FlSegment segment, uint32_t cell, int times)
{
    const int x = (int)cell % map->columns, y = (int)cell / map->columns % map->rows,
              t = (int)cell / map->columns / map->rows;
    for (int v = MAX(t - 1, 0); v <= MIN(t + 1, map->slices - 1); v++)
        for (int w = MAX(y - 1, 0); w <= MIN(y + 1, map->rows - 1); w++) {
            int32_t *row =
                map->filtered[segment] + fl_occurrence_index(map, (FlCell){.y = w, .t = v});
            for (int u = MAX(x - 1, 0); u <= MIN(x + 1, map->columns - 1); u++)
                row[u] += times * (2 - abs(u - x)) * (2 - abs(w - y)) * (2 - abs(v - t));
        }
}

void fl_occurrence_refresh(FlOccurrence *map)
{
    for (FlSegment s = FL_SEGMENT_BORDER; s < FL_SEGMENTS; s++) {
        if (map->price[s] == 0)
            continue;
        if (map->n_moves[s] > map->most_moves)
            filter_all(map, s);
        else
            for (int k = 0; k < map->n_moves[s]; k++) {
                add_tent(map, s, map->moves[s][k].from, -1);
                add_tent(map, s, map->moves[s][k].to, 1);
            }
        map->n_moves[s] = 0;
    }
}
