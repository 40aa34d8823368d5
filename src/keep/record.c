#include "keep/record.h"

#include "base/reader.h"
#include "io/atomic_file.h"
#include "keep/sealed.h"
#include <errno.h>

#define MAGIC "fluidy-svg record 2"
// magic, request, facts, inputs, found, done, overwrite, sizes of the states
#define TYPE "(s(tt)" FL_FACTS_TYPE FL_FACTS_TYPE FL_FACTS_TYPE "ibat)"

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

/* All but the states. */
static GVariant *pack(const FlRecord *record, guint n_states)
{
    GVariantBuilder sizes;
    g_variant_builder_init(&sizes, G_VARIANT_TYPE("at"));
    for (guint k = 0; k < n_states; k++)
        g_variant_builder_add(&sizes, "t", (guint64)g_bytes_get_size(record->states->pdata[k]));
    return g_variant_ref_sink(
        g_variant_new("(s(tt)@a(ss)@a(ss)@a(ss)ibat)", MAGIC, record->request.a, record->request.b,
                      fl_facts_pack(record->facts), fl_facts_pack(record->inputs),
                      fl_facts_pack(record->found), record->done, record->overwrite, &sizes));
}

static FlSpan span_of(GBytes *bytes)
{
    size_t size;
    const void *data = g_bytes_get_data(bytes, &size);
    return (FlSpan){(void *)(uintptr_t)data, size}; // it is only read
}

/* The size of the packed part, the packed part, and the states, which may be large and are not
 * copied. */
static GArray *parts_of(const FlRecord *record, GVariant *packed, const uint64_t *size)
{
    GArray *parts = g_array_new(FALSE, FALSE, sizeof(FlSpan));
    const FlSpan front[] = {{(void *)(uintptr_t)size, sizeof *size},
                            {(void *)(uintptr_t)g_variant_get_data(packed), *size}};
    g_array_append_vals(parts, front, G_N_ELEMENTS(front));
    for (gsize k = 0; k < record->states->len; k++) {
        const FlSpan state = span_of(record->states->pdata[k]);
        g_array_append_val(parts, state);
    }
    return parts;
}

bool fl_record_save(const FlRecord *record, const char *path, GError **error)
{
    g_autoptr(GVariant) packed = pack(record, record->states->len);
    const uint64_t size = g_variant_get_size(packed);
    g_autoptr(GArray) parts = parts_of(record, packed, &size);
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
    g_autoptr(GVariant) packed = pack(record, 0);
    uint64_t size = g_variant_get_size(packed);
    const FlSpan parts[] = {{&size, sizeof size},
                            {(void *)(uintptr_t)g_variant_get_data(packed), size}};
    fl_store_put(store, FL_KEPT_RECORD, name, parts, G_N_ELEMENTS(parts));
}

/* ---- reading --------------------------------------------------------------------------------- */

/* The states in a row, which are all that follows. */
static bool take_states(FlRecord *record, GVariant *sizes, GBytes *bytes, FlReader *reader)
{
    for (gsize k = 0; k < g_variant_n_children(sizes); k++) {
        guint64 size;
        const size_t at = g_bytes_get_size(bytes) - reader->left;
        g_variant_get_child(sizes, k, "t", &size);
        if (!fl_reader_take(reader, size, 1))
            return false;
        g_ptr_array_add(record->states, g_bytes_new_from_bytes(bytes, at, size));
    }
    return fl_reader_ends(reader);
}

static FlFacts *take_facts(GVariant *packed, gsize child)
{
    g_autoptr(GVariant) facts = g_variant_get_child_value(packed, child);
    return fl_facts_unpack(facts);
}

FlRecord *fl_record_parse(GBytes *bytes)
{
    FlReader reader = fl_reader_of(bytes);
    const size_t size = fl_reader_count(&reader, reader.left);
    if (!fl_reader_take(&reader, size, 1))
        return NULL;
    g_autoptr(GBytes) front = g_bytes_new_from_bytes(bytes, sizeof(uint64_t), size);
    g_autoptr(GVariant) packed =
        g_variant_ref_sink(g_variant_new_from_bytes(G_VARIANT_TYPE(TYPE), front, FALSE));
    if (!g_variant_is_normal_form(packed))
        return NULL;
    const char *magic;
    gboolean overwrite;
    g_autoptr(GVariant) sizes = NULL;
    g_autoptr(FlRecord) record = g_new0(FlRecord, 1);
    record->facts = take_facts(packed, 2);
    record->inputs = take_facts(packed, 3);
    record->found = take_facts(packed, 4);
    record->states = g_ptr_array_new_with_free_func((GDestroyNotify)g_bytes_unref);
    g_variant_get(packed, "(&s(tt)@a(ss)@a(ss)@a(ss)ib@at)", &magic, &record->request.a,
                  &record->request.b, NULL, NULL, NULL, &record->done, &overwrite, &sizes);
    record->overwrite = overwrite;
    const bool good = g_str_equal(magic, MAGIC) && record->done >= 0 &&
                      take_states(record, sizes, bytes, &reader);
    return good ? g_steal_pointer(&record) : NULL;
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
