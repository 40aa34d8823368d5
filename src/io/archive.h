/* ZIP archives that are written: OpenRaster files and looks. */
#pragma once

#include <glib.h>
#include <stdbool.h>
#include <stdio.h>

/** An archive that grows in memory, from zeroed. Functions return false if memory or the disk is
 * full. */
typedef struct FlArchive {
    struct zip_source *memory;
    struct zip *zip;
    GPtrArray *parts; // GBytes
} FlArchive;

bool fl_archive_open(FlArchive *archive);
void fl_archive_clear(FlArchive *archive);

/** Stores a part as it is, since pictures are deflated already; takes `bytes`. */
bool fl_archive_add(FlArchive *archive, const char *name, GBytes *bytes);
bool fl_archive_add_text(FlArchive *archive, const char *name, const char *text);

/** Completes the archive and writes it to the stream. */
bool fl_archive_store(FlArchive *archive, FILE *stream);
