#include "keep/record.h"

#include "io/atomic_file.h"
#include "keep/sealed.h"
#include <errno.h>
#include <string.h>

#define MAGIC "fluidy-svg record 3"

FlRecord *fl_record_new(void)
{
    FlRecord *record = g_new0(FlRecord, 1);
    record->facts = fl_facts_new();
    record->inputs = fl_facts_new();
    record->found = fl_facts_new();
    record->states = g_ptr_array_new_with_free_func((GDestroyNotify)g_bytes_unref);
    return record;
}

void fl_record_free(FlRecord *record)
{
    if (!record)
        return;
    fl_facts_free(record->facts);
    fl_facts_free(record->inputs);
    fl_facts_free(record->found);
    g_ptr_array_unref(record->states);
    g_free(record);
}

/* ---- writing --------------------------------------------------------------------------------- */

/* All but the states, and the sizes of n of them. */
static GByteArray *front_of(const FlRecord *record, guint n_states)
{
    GByteArray *out = g_byte_array_new();
    fl_put_text(out, MAGIC);
    fl_put(out, &record->request, sizeof record->request);
    fl_facts_put(out, record->facts);
    fl_facts_put(out, record->inputs);
    fl_facts_put(out, record->found);
    fl_put_int(out, record->done);
    fl_put_int(out, record->overwrite);
    fl_put_int(out, (int)n_states);
    for (guint k = 0; k < n_states; k++) {
        const uint64_t size = g_bytes_get_size(record->states->pdata[k]);
        fl_put(out, &size, sizeof size);
    }
    return out;
}

bool fl_record_save(const FlRecord *record, const char *path, GError **error)
{
    g_autoptr(GByteArray) front = front_of(record, record->states->len);
    g_autoptr(GArray) parts = g_array_new(FALSE, FALSE, sizeof(FlSpan));
    g_array_append_val(parts, ((const FlSpan){front->data, front->len}));
    for (gsize k = 0; k < record->states->len; k++) { // they may be large and are not copied
        size_t size;
        const void *data = g_bytes_get_data(record->states->pdata[k], &size);
        g_array_append_val(parts, ((const FlSpan){(void *)(uintptr_t)data, size})); // only read
    }
    g_auto(FlAtomicFile) file = {0};
    if (!fl_atomic_open(&file, path, true, error))
        return false;
    if (!fl_sealed_write(fileno(file.stream), (const FlSpan *)(const void *)parts->data,
                         (int)parts->len)) {
        fl_output_error(error, path, errno);
        return false;
    }
    return fl_atomic_commit(&file, error);
}

void fl_record_keep(const FlRecord *record, FlStore *store, FlDigest name)
{
    g_autoptr(GByteArray) front = front_of(record, 0);
    fl_store_put(store, FL_KEPT_RECORD, name, &(FlSpan){front->data, front->len}, 1);
}

/* ---- reading --------------------------------------------------------------------------------- */

FlRecord *fl_record_parse(GBytes *bytes)
{
    int n = 0;
    FlReader reader = fl_reader_of(bytes);
    g_autoptr(FlRecord) record = g_new0(FlRecord, 1);
    fl_take_check(&reader, strcmp(fl_take_text(&reader), MAGIC) == 0);
    fl_reader_copy(&reader, &record->request, sizeof record->request);
    record->facts = fl_facts_take(&reader);
    record->inputs = fl_facts_take(&reader);
    record->found = fl_facts_take(&reader);
    record->done = fl_take_in(&reader, 0, G_MAXINT);
    record->overwrite = fl_take_in(&reader, 0, 1) != 0;
    record->states = g_ptr_array_new_with_free_func((GDestroyNotify)g_bytes_unref);
    g_autofree uint64_t *size = fl_take_items(&reader, sizeof *size, &n);
    for (int k = 0; k < n && !reader.failed; k++) {
        const size_t at = g_bytes_get_size(bytes) - reader.left;
        if (fl_reader_take(&reader, size[k], 1))
            g_ptr_array_add(record->states, g_bytes_new_from_bytes(bytes, at, size[k]));
    }
    return fl_reader_ends(&reader) ? g_steal_pointer(&record) : NULL;
}

FlRecord *fl_record_load(const char *path, GError **error)
{
    g_autoptr(GBytes) bytes = fl_sealed_read(path, NULL);
    FlRecord *record = bytes ? fl_record_parse(bytes) : NULL;
    if (!record)
        g_set_error(
            error, FL_ERROR, FL_ERROR_CHANGED,
            "%s: the state of an earlier render cannot be read; use ‘overwrite’ to start anew",
            path);
    return record;
}
