/* The costs between the last sources and targets of a retrieval, all of them. */
#ifndef FLUIDY_LAZY_COST_TABLE_H
#define FLUIDY_LAZY_COST_TABLE_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/** A target and what it costs a source. */
typedef struct FlOffer {
    uint32_t target, cost;
} FlOffer;

/** Rows are sources, columns are targets. */
typedef struct FlCostTable {
    uint32_t n_rows, n_columns;
    uint32_t *cost;   // n_rows * n_columns, filled by the caller
    uint32_t *target; // by column, filled by the caller
    uint64_t key;     // settles ties
    FlOffer *nearest; // by row: the next few that are nearest, in order
    uint8_t *next;    // by row: how many of these are over
} FlCostTable;

/** Makes a table without costs. Returns: false with FL_ERROR_NO_MEMORY set. */
bool fl_cost_table_init(FlCostTable *table, uint32_t n_rows, uint32_t n_columns, uint64_t key,
                        GError **error);
void fl_cost_table_clear(FlCostTable *table);

/**
 * The nearest free target of a row, of equals one by hash. is_free has a bit for each target, and
 * one of the table's targets must be; those that are not never become free again.
 */
FlOffer fl_cost_table_nearest(FlCostTable *table, uint32_t row, const uint64_t *is_free);

#endif
