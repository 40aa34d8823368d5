#include "keep/record.h"

#include "io/atomic_file.h"
#include "keep/sealed.h"
#include <errno.h>
#include <string.h>

#define MAGIC "fluidy-svg record 4"

FlRecord *fl_record_new(void)
{
    FlRecord *record = g_new0(FlRecord, 1);
    record->facts = fl_facts_new();
    record->inputs = fl_facts_new();
    record->found = fl_facts_new();
    return record;
}

void fl_record_free(FlRecord *record)
{
    if (!record)
        return;
    fl_facts_free(record->facts);
    fl_facts_free(record->inputs);
    fl_facts_free(record->found);
    g_free(record);
}

/* ---- writing --------------------------------------------------------------------------------- */

static GByteArray *bytes_of(const FlRecord *record)
{
    GByteArray *out = g_byte_array_new();
    fl_put_text(out, MAGIC);
    fl_put(out, &record->request, sizeof record->request);
    fl_facts_put(out, record->facts);
    fl_facts_put(out, record->inputs);
    fl_facts_put(out, record->found);
    fl_put_int(out, record->done);
    fl_put_int(out, record->overwrite);
    return out;
}

bool fl_record_save(const FlRecord *record, const char *path, GError **error)
{
    g_autoptr(GByteArray) bytes = bytes_of(record);
    g_auto(FlAtomicFile) file = {0};
    if (!fl_atomic_open(&file, path, true, error))
        return false;
    if (!fl_sealed_write(fileno(file.stream), &(FlSpan){bytes->data, bytes->len}, 1)) {
        fl_output_error(error, path, errno);
        return false;
    }
    return fl_atomic_commit(&file, error);
}

void fl_record_keep(const FlRecord *record, FlStore *store, FlDigest name)
{
    g_autoptr(GByteArray) bytes = bytes_of(record);
    fl_store_put(store, FL_KEPT_RECORD, name, &(FlSpan){bytes->data, bytes->len}, 1);
}

/* ---- reading --------------------------------------------------------------------------------- */

FlRecord *fl_record_parse(GBytes *bytes)
{
    FlReader reader = fl_reader_of(bytes);
    g_autoptr(FlRecord) record = g_new0(FlRecord, 1);
    fl_take_check(&reader, strcmp(fl_take_text(&reader), MAGIC) == 0);
    fl_reader_copy(&reader, &record->request, sizeof record->request);
    record->facts = fl_facts_take(&reader);
    record->inputs = fl_facts_take(&reader);
    record->found = fl_facts_take(&reader);
    record->done = fl_take_in(&reader, 0, G_MAXINT);
    record->overwrite = fl_take_in(&reader, 0, 1) != 0;
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
