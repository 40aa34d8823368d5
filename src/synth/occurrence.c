#include "synth/occurrence.h"

#include "base/alloc.h"
#include <string.h>

#define TENT_SUM 64 // of [1 2 1] along three axes

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
    const double cell_pixels = FL_CELL * FL_CELL * (double)MIN(frames_per_cell, level->window);
    for (int s = FL_SEGMENT_BORDER; s < FL_SEGMENTS; s++) {
        if (!(map->count[s] = fl_alloc(cells, sizeof(int32_t), "an occurrence map", error)) ||
            !(map->filtered[s] = fl_alloc(cells, sizeof(int32_t), "an occurrence map", error)))
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
    }
    *map = (FlOccurrence){0};
}

void fl_occurrence_count(FlOccurrence *map, const FlNnf *nnf, const FlTargetLevel *target)
{
    const size_t cells = (size_t)map->columns * map->rows * map->slices;
    for (int s = FL_SEGMENT_BORDER; s < FL_SEGMENTS; s++)
        memset(map->count[s], 0, cells * sizeof(int32_t));
    for (size_t p = 0; p < (size_t)nnf->width * nnf->height; p++)
        if (nnf->match[p].frame != FL_NO_MATCH)
            map->count[target->segment[p]]
                      [fl_occurrence_index(map, fl_occurrence_cell(map, nnf->match[p]))]++;
    fl_occurrence_refresh(map);
}

void fl_occurrence_move(FlOccurrence *map, FlSegment segment, FlMatch from, FlMatch to)
{
    const size_t old = fl_occurrence_index(map, fl_occurrence_cell(map, from));
    const size_t new = fl_occurrence_index(map, fl_occurrence_cell(map, to));
    if (old == new)
        return;
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

void fl_occurrence_refresh(FlOccurrence *map)
{
    const size_t slice = (size_t)map->columns * map->rows, cells = slice * map->slices;
    g_autofree int32_t *before = g_new(int32_t, slice);
    for (int s = FL_SEGMENT_BORDER; s < FL_SEGMENTS; s++) {
        if (map->price[s] == 0)
            continue;
        int32_t *f = map->filtered[s];
        memcpy(f, map->count[s], cells * sizeof *f);
        filter_lines(f, (size_t)map->rows * map->slices, map->columns, map->columns, 1);
        for (int t = 0; t < map->slices; t++)
            filter_rows(f + t * slice, map->rows, map->columns, before);
        filter_rows(f, map->slices, slice, before);
    }
}
