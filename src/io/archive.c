#include "io/archive.h"

#include <string.h>
#include <zip.h>

#define DOS_EPOCH 315532800 // 1980-01-01: the same bytes on any day

bool fl_archive_open(FlArchive *archive)
{
    archive->parts = g_ptr_array_new_with_free_func((GDestroyNotify)g_bytes_unref);
    archive->memory = zip_source_buffer_create(NULL, 0, 0, NULL);
    if (!archive->memory)
        return false;
    zip_source_keep(archive->memory);
    archive->zip = zip_open_from_source(archive->memory, ZIP_TRUNCATE, NULL);
    return archive->zip != NULL;
}

void fl_archive_clear(FlArchive *archive)
{
    if (archive->zip)
        zip_discard(archive->zip);
    if (archive->memory)
        zip_source_free(archive->memory);
    g_ptr_array_unref(archive->parts);
}

bool fl_archive_add(FlArchive *archive, const char *name, GBytes *bytes)
{
    g_ptr_array_add(archive->parts, bytes);
    zip_source_t *source =
        zip_source_buffer(archive->zip, g_bytes_get_data(bytes, NULL), g_bytes_get_size(bytes), 0);
    const zip_int64_t index =
        source ? zip_file_add(archive->zip, name, source, ZIP_FL_ENC_UTF_8) : -1;
    if (source && index < 0)
        zip_source_free(source);
    return index >= 0 &&
           zip_set_file_compression(archive->zip, (zip_uint64_t)index, ZIP_CM_STORE, 0) == 0 &&
           zip_file_set_mtime(archive->zip, (zip_uint64_t)index, DOS_EPOCH, 0) == 0;
}

bool fl_archive_add_text(FlArchive *archive, const char *name, const char *text)
{
    return fl_archive_add(archive, name, g_bytes_new(text, strlen(text)));
}

bool fl_archive_store(FlArchive *archive, FILE *stream)
{
    char block[65536];
    zip_int64_t n = 0;
    if (zip_close(archive->zip) != 0)
        return false;
    archive->zip = NULL;
    if (zip_source_open(archive->memory) != 0)
        return false;
    while ((n = zip_source_read(archive->memory, block, sizeof block)) > 0)
        if (fwrite(block, 1, (size_t)n, stream) != (size_t)n)
            break;
    zip_source_close(archive->memory);
    return n == 0;
}
