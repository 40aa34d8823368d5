#include "io/prefix_code.h"

#include <glib.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/** A symbol and how often it comes. */
typedef struct Leaf {
    uint32_t count;
    int symbol;
} Leaf;

static int compare(const void *a, const void *b)
{
    const Leaf *x = a, *y = b;
    return x->count != y->count ? (x->count > y->count) - (x->count < y->count)
                                : x->symbol - y->symbol;
}

/** The symbols that are used, the rarest first. Returns: how many. */
static int list_leaves(const uint32_t *count, Leaf *leaf)
{
    int n = 0;
    for (int s = 0; s < FL_CODE_SYMBOLS; s++)
        if (count[s] > 0)
            leaf[n++] = (Leaf){count[s], s};
    qsort(leaf, (size_t)n, sizeof *leaf, compare);
    return n;
}

/** Huffman's tree: the two rarest nodes get a parent, again and again. Nodes 0 … n - 1 are the
 * leaves, the last one, 2 n - 2, is the root. */
static void find_parents(const Leaf *leaf, int n, int *parent)
{
    uint32_t weight[2 * FL_CODE_SYMBOLS];
    int next_leaf = 0, next_inner = n;
    for (int k = 0; k < n; k++)
        weight[k] = leaf[k].count;
    for (int made = n; made < 2 * n - 1; made++) {
        weight[made] = 0;
        for (int child = 0; child < 2; child++) {
            const bool is_leaf =
                next_leaf < n && (next_inner == made || weight[next_leaf] <= weight[next_inner]);
            const int node = is_leaf ? next_leaf++ : next_inner++;
            weight[made] += weight[node];
            parent[node] = made;
        }
    }
}

/** How many leaves lie at each depth; those below the limit at it. */
static void count_lengths(int n, const int *parent, int *n_of_length)
{
    int depth[2 * FL_CODE_SYMBOLS];
    depth[2 * n - 2] = 0;
    memset(n_of_length, 0, (FL_CODE_BITS + 1) * sizeof *n_of_length);
    for (int k = 2 * n - 3; k >= 0; k--) {
        depth[k] = depth[parent[k]] + 1;
        if (k < n)
            n_of_length[MIN(depth[k], FL_CODE_BITS)]++;
    }
}

/** Makes room in the code for those that were too deep: a leaf of the deepest level above goes one
 * further down, where it and one of them are siblings, until all have a place [RFC 1951 §3.2.2]. */
static void limit_lengths(int *n_of_length)
{
    uint32_t taken = 0; // of 2^FL_CODE_BITS
    for (int l = 1; l <= FL_CODE_BITS; l++)
        taken += (uint32_t)n_of_length[l] << (FL_CODE_BITS - l);
    for (; taken > 1U << FL_CODE_BITS; taken--) {
        int above = FL_CODE_BITS - 1;
        while (n_of_length[above] == 0)
            above--;
        n_of_length[above]--;
        n_of_length[above + 1] += 2;
        n_of_length[FL_CODE_BITS]--;
    }
}

static uint16_t reversed(unsigned bits, int n)
{
    unsigned out = 0;
    for (int k = 0; k < n; k++)
        out |= (bits >> k & 1) << (n - 1 - k);
    return (uint16_t)out;
}

/** Codes of one length are numbers one after the other, in the order of their symbols. */
static void assign_bits(FlPrefixCode *code, const int *n_of_length)
{
    unsigned next[FL_CODE_BITS + 2] = {0};
    for (int l = 1; l <= FL_CODE_BITS; l++)
        next[l + 1] = (next[l] + (unsigned)n_of_length[l]) << 1;
    for (int s = 0; s < FL_CODE_SYMBOLS; s++)
        if (code->length[s] > 0)
            code->bits[s] = reversed(next[code->length[s]]++, code->length[s]);
}

void fl_prefix_code_init(FlPrefixCode *code, const uint32_t count[FL_CODE_SYMBOLS])
{
    Leaf leaf[FL_CODE_SYMBOLS];
    int parent[2 * FL_CODE_SYMBOLS], n_of_length[FL_CODE_BITS + 1];
    const int n = list_leaves(count, leaf);
    g_assert(n >= 2);
    find_parents(leaf, n, parent);
    count_lengths(n, parent, n_of_length);
    limit_lengths(n_of_length);
    *code = (FlPrefixCode){0};
    for (int l = FL_CODE_BITS, k = 0; l > 0; l--) // the rarest are the longest
        for (int i = 0; i < n_of_length[l]; i++)
            code->length[leaf[k++].symbol] = (uint8_t)l;
    assign_bits(code, n_of_length);
}
