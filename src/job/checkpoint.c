#include "job/checkpoint.h"

#include "base/alloc.h"
#include "io/atomic_file.h"
#include <errno.h>
#include <libdeflate.h>
#include <string.h>

#define MAGIC "fluidy-svg state 3"
#define TYPE "(sa(ss)ibaay)" // magic, facts, done, overwrite, painters

FlCheckpoint *fl_checkpoint_new(void)
{
    FlCheckpoint *state = g_new0(FlCheckpoint, 1);
    state->painter = g_ptr_array_new_with_free_func((GDestroyNotify)g_bytes_unref);
    return state;
}

void fl_checkpoint_free(FlCheckpoint *state)
{
    if (!state)
        return;
    fl_fingerprint_free(state->print);
    g_ptr_array_unref(state->painter);
    g_free(state);
}

/* The file's variant without painters. */
static GVariant *to_variant(const FlCheckpoint *state)
{
    GVariantBuilder facts;
    g_variant_builder_init(&facts, G_VARIANT_TYPE("a(ss)"));
    for (guint i = 0; i < state->print->facts->len; i++) {
        const FlFact *fact = &g_array_index(state->print->facts, FlFact, i);
        g_variant_builder_add(&facts, "(ss)", fact->name, fact->value);
    }
    return g_variant_ref_sink(
        g_variant_new(TYPE, MAGIC, &facts, state->done, state->overwrite, NULL));
}

uint32_t fl_checkpoint_sum(const void *data, size_t bytes)
{
    return GUINT32_TO_LE(libdeflate_crc32(0, data, bytes));
}

/* The file as far as it is written. */
typedef struct Output {
    FILE *stream;
    uint32_t sum; // in this machine's byte order
    bool good;
} Output;

static void put(Output *out, const void *data, size_t bytes)
{
    if (bytes == 0) // data may be NULL, with which a sum begins anew
        return;
    out->sum = libdeflate_crc32(out->sum, data, bytes);
    out->good = out->good && fwrite(data, 1, bytes, out->stream) == bytes;
}

/* A container of GVariant's format ends with `n` offsets, of as few bytes as can count them all. */
static size_t offset_bytes(size_t body, size_t n)
{
    size_t bytes = 1;
    while (bytes < 8 && body + n * bytes > UINT64_MAX >> (64 - 8 * bytes))
        bytes *= 2;
    return bytes;
}

static void put_offset(Output *out, size_t offset, size_t bytes)
{
    const uint64_t value = GUINT64_TO_LE((uint64_t)offset);
    put(out, &value, bytes);
}

static size_t get_offset(const uint8_t *from, size_t bytes)
{
    uint64_t value = 0;
    memcpy(&value, from, bytes);
    return (size_t)GUINT64_FROM_LE(value);
}

/* The painters as an array of arrays of bytes. Returns: its size. */
static size_t put_painters(Output *out, const GPtrArray *painter)
{
    size_t body = 0, end = 0;
    for (guint i = 0; i < painter->len; i++)
        body += g_bytes_get_size(painter->pdata[i]);
    const size_t each = offset_bytes(body, painter->len);
    for (guint i = 0; i < painter->len; i++) {
        size_t bytes;
        const void *data = g_bytes_get_data(painter->pdata[i], &bytes);
        put(out, data, bytes);
    }
    for (guint i = 0; i < painter->len; i++)
        put_offset(out, end += g_bytes_get_size(painter->pdata[i]), each);
    return body + painter->len * each;
}

#define ENDS 2 // offsets of the whole: where magic and facts end

/* The variant, to which the painters are written one by one: a copy of all would take as much
 * memory as they do. They are its last member, behind which only its offsets follow. */
static bool put_state(Output *out, const FlCheckpoint *state, GError **error)
{
    g_autoptr(GVariant) variant = to_variant(state);
    const size_t bytes = g_variant_get_size(variant);
    g_autofree uint8_t *data = fl_alloc(bytes, 1, "a saved state", error);
    if (!data)
        return false;
    g_variant_store(variant, data);
    const size_t short_each = offset_bytes(bytes, 0), body = bytes - ENDS * short_each;
    put(out, data, body);
    const size_t painters = put_painters(out, state->painter);
    const size_t each = offset_bytes(body + painters, ENDS);
    for (size_t k = 0; k < ENDS; k++)
        put_offset(out, get_offset(data + body + k * short_each, short_each), each);
    return true;
}

bool fl_checkpoint_save(const FlCheckpoint *state, const char *path, GError **error)
{
    g_auto(FlAtomicFile) file = {0};
    if (!fl_atomic_open(&file, path, true, error))
        return false;
    Output out = {.stream = file.stream, .good = true};
    if (!put_state(&out, state, error))
        return false;
    const uint32_t sum = GUINT32_TO_LE(out.sum);
    put(&out, &sum, sizeof sum);
    if (!out.good) {
        fl_output_error(error, path, errno);
        return false;
    }
    return fl_atomic_commit(&file, error);
}

static FlCheckpoint *from_variant(GVariant *variant)
{
    const char *magic, *name, *value;
    gboolean overwrite;
    g_autoptr(GVariantIter) facts = NULL, painters = NULL;
    g_autoptr(FlCheckpoint) state = fl_checkpoint_new();
    g_variant_get(variant, "(&sa(ss)ibaay)", &magic, &facts, &state->done, &overwrite, &painters);
    if (!g_str_equal(magic, MAGIC) || state->done < 0)
        return NULL;
    state->overwrite = overwrite;
    state->print = fl_fingerprint_new_empty();
    while (g_variant_iter_next(facts, "(&s&s)", &name, &value))
        fl_fingerprint_add(state->print, name, value);
    for (GVariant *one; (one = g_variant_iter_next_value(painters)); g_variant_unref(one))
        g_ptr_array_add(state->painter, g_variant_get_data_as_bytes(one));
    return g_steal_pointer(&state);
}

FlCheckpoint *fl_checkpoint_parse(GBytes *bytes, const char *path, GError **error)
{
    size_t size;
    const uint8_t *data = g_bytes_get_data(bytes, &size);
    uint32_t sum;
    FlCheckpoint *state = NULL;
    if (size >= sizeof sum) {
        sum = fl_checkpoint_sum(data, size - sizeof sum);
        g_autoptr(GBytes) payload = g_bytes_new_from_bytes(bytes, 0, size - sizeof sum);
        g_autoptr(GVariant) variant =
            g_variant_ref_sink(g_variant_new_from_bytes(G_VARIANT_TYPE(TYPE), payload, FALSE));
        if (memcmp(&sum, data + size - sizeof sum, sizeof sum) == 0 &&
            g_variant_is_normal_form(variant))
            state = from_variant(variant);
    }
    if (!state)
        g_set_error(
            error, FL_ERROR, FL_ERROR_CHANGED,
            "%s: the state of an earlier render cannot be read; use ‘overwrite’ to start anew",
            path);
    return state;
}

FlCheckpoint *fl_checkpoint_load(const char *path, GError **error)
{
    char *contents = NULL;
    size_t size = 0;
    g_autoptr(GError) problem = NULL;
    if (!g_file_get_contents(path, &contents, &size, &problem)) {
        g_set_error(error, FL_ERROR, FL_ERROR_CHANGED, "%s", problem->message);
        return NULL;
    }
    g_autoptr(GBytes) bytes = g_bytes_new_take(contents, size);
    return fl_checkpoint_parse(bytes, path, error);
}
