/* A temporary file of numbered blocks, for data of a long film that should not stay in memory. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>
#include <stddef.h>

/** Blocks are compressed into an unlinked file in $TMPDIR, which all spills of the process share
 * and which vanishes with the process. */
typedef struct FlSpill FlSpill;

/** For blocks 0 … n_blocks - 1. Returns: NULL with FL_ERROR_OUTPUT set. */
FlSpill *fl_spill_new(size_t n_blocks, GError **error);

void fl_spill_free(FlSpill *spill); // NULL is fine

/** Stores or replaces a block. One thread at a time. */
bool fl_spill_put(FlSpill *spill, size_t block, const void *data, size_t bytes, GError **error);

/** Reads a block of exactly `bytes` bytes, as stored. Several threads may read. */
bool fl_spill_get(const FlSpill *spill, size_t block, void *data, size_t bytes, GError **error);

/** The bytes of a stored block. */
size_t fl_spill_bytes(const FlSpill *spill, size_t block);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlSpill, fl_spill_free)
