/* The record of a render: what it was made from and how far it has come. Beside unfinished frames
 * it is a file, from which the render resumes; in the store it says that all is done. */
#pragma once

#include "keep/facts.h"
#include "keep/store.h"

typedef struct FlRecord {
    FlDigest request; // of what was asked for, before any file was read
    FlFacts *facts;   // all that decides the frames
    FlFacts *inputs;  // the digests of the files that were read, by path
    FlFacts *found;   // the folders of styles, by the names under which they were found
    int done;         // frames that are painted
    bool overwrite;   // the render may replace files that it has not written
} FlRecord;

FlRecord *fl_record_new(void);
void fl_record_free(FlRecord *record); // NULL is fine

/** Writes the record as a file, completely or not at all. FL_ERROR_OUTPUT. */
bool fl_record_save(const FlRecord *record, const char *path, GError **error);

/** Reads the file. Returns: NULL with FL_ERROR_CHANGED if it is missing or damaged. */
FlRecord *fl_record_load(const char *path, GError **error);

/** Keeps the record in the store. */
void fl_record_keep(const FlRecord *record, FlStore *store, FlDigest name);

/** Reads a record's bytes, which need not be trusted. Returns: NULL if they are damaged. */
FlRecord *fl_record_parse(GBytes *bytes);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlRecord, fl_record_free)
