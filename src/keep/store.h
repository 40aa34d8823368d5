/* The store: things that a render keeps for later ones, named by the digest of all that they are
 * made from. Pictures in memory, and a folder of sealed files. */
#pragma once

#include "base/compress.h"
#include "base/digest.h"
#include <glib.h>
#include <stdbool.h>

/**
 * A store in use. Any thread may use it, and several processes may share a folder: files appear
 * whole or not at all, and a file that another process removes is made again. Problems are not
 * errors: fl_store_warn() gives the first one to options->warning.
 */
typedef struct FlStore FlStore;

/** A digest names one thing of each kind. */
typedef enum FlKept {
    FL_KEPT_PICTURE, // a region's paint in one frame, and its engine's state after the frame
    FL_KEPT_FILM,    // the digests of all pictures of a region
    FL_KEPT_RECORD,  // of a finished render: FlRecord
    FL_KEPT_FACTS,   // the facts that decided the paint of a region when it was painted last
} FlKept;

/** The options of a store; copied but for data. */
typedef struct FlStoreOptions {
    const char *folder; // "auto": in the user's cache; "off" or NULL: none
    int mib;            // of its files; 0: 8192
    size_t memory;      // bytes that pictures in memory may take
    void (*warning)(const char *message, void *data); // may be NULL
    void *data;
} FlStoreOptions;

/** Returns: NULL if there is neither a folder nor memory. */
FlStore *fl_store_open(const FlStoreOptions *options);

/** Removes the least recently used files until the limit is met. NULL is fine. */
void fl_store_close(FlStore *store);

/** True if it is in memory, or in a file, which may still be damaged. */
bool fl_store_has(FlStore *store, FlKept kind, FlDigest name);

/** Returns: to be freed with g_bytes_unref(); NULL: it is missing, or was damaged and is gone. */
GBytes *fl_store_get(FlStore *store, FlKept kind, FlDigest name);

/** Keeps the parts in a row. After the first failure to write, calls are ignored. */
void fl_store_put(FlStore *store, FlKept kind, FlDigest name, const FlSpan *parts, int n);

void fl_store_drop(FlStore *store, FlKept kind, FlDigest name);

/** Warns of the first problem, once; call it in the thread that the options want. NULL is fine. */
void fl_store_warn(FlStore *store);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlStore, fl_store_close)
