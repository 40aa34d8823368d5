#include "lazy/cost_table.h"

#include "base/bits.h"
#include "base/rng.h"

#define NEAREST 16 // a row is looked through once for so many
#define NO_TARGET UINT32_MAX

bool fl_cost_table_init(FlCostTable *table, uint32_t n_rows, uint32_t n_columns, uint64_t key,
                        GError **error)
{
    const char *what = "distances";
    *table = (FlCostTable){.n_rows = n_rows, .n_columns = n_columns, .key = key};
    if (!(table->cost = fl_alloc_scratch((size_t)n_rows * n_columns, 4, what, error)) ||
        !(table->target = fl_alloc(n_columns, sizeof *table->target, what, error)) ||
        !(table->nearest =
              fl_alloc_scratch((size_t)n_rows * NEAREST, sizeof *table->nearest, what, error)) ||
        !(table->next = fl_alloc(n_rows, 1, what, error)))
        return false;
    for (uint32_t row = 0; row < n_rows; row++)
        table->next[row] = NEAREST;
    return true;
}

void fl_cost_table_clear(FlCostTable *table)
{
    free(table->cost);
    free(table->target);
    free(table->nearest);
    free(table->next);
}

static bool is_before(const FlCostTable *table, uint32_t row, FlOffer a, FlOffer b)
{
    const uint32_t key = (uint32_t)table->key ^ fl_hash32(row);
    return a.cost != b.cost ? a.cost < b.cost
                            : fl_hash32(a.target ^ key) < fl_hash32(b.target ^ key);
}

/* Puts an offer in its place among n; the last of a full list is dropped. */
static int insert(const FlCostTable *table, uint32_t row, FlOffer offer, FlOffer *list, int n)
{
    int k = n < NEAREST ? n++ : NEAREST - 1;
    for (; k > 0 && is_before(table, row, offer, list[k - 1]); k--)
        list[k] = list[k - 1];
    list[k] = offer;
    return n;
}

static void find_nearest(FlCostTable *table, uint32_t row, const uint64_t *is_free)
{
    const uint32_t *cost = table->cost + (size_t)row * table->n_columns;
    FlOffer *list = table->nearest + (size_t)row * NEAREST;
    int n = 0;
    for (uint32_t k = 0; k < table->n_columns; k++) {
        const FlOffer offer = {table->target[k], cost[k]};
        if ((n == NEAREST && cost[k] > list[NEAREST - 1].cost) || !fl_bit(is_free, offer.target))
            continue;
        if (n < NEAREST || is_before(table, row, offer, list[NEAREST - 1]))
            n = insert(table, row, offer, list, n);
    }
    for (; n < NEAREST; n++)
        list[n].target = NO_TARGET;
    table->next[row] = 0;
}

FlOffer fl_cost_table_nearest(FlCostTable *table, uint32_t row, const uint64_t *is_free)
{
    const FlOffer *list = table->nearest + (size_t)row * NEAREST;
    for (;;) {
        uint8_t *next = &table->next[row];
        while (*next < NEAREST && list[*next].target != NO_TARGET &&
               !fl_bit(is_free, list[*next].target))
            (*next)++;
        if (*next < NEAREST && list[*next].target != NO_TARGET)
            return list[*next];
        find_nearest(table, row, is_free);
    }
}
