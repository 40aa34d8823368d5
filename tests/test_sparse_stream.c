/* Zlib streams of runs, read by two other programs' libraries. */
#include "io/prefix_code.h"
#include "io/sparse_stream.h"

#include <libdeflate.h>
#include <string.h>
#include <zlib.h>

/* A stream, and what it is to hold. */
typedef struct Fixture {
    GByteArray *packed, *bytes;
    FlSparseStream *stream;
    size_t most; // bytes that it may take; 0: any number
} Fixture;

static void begin(Fixture *fixture, gconstpointer data)
{
    *fixture = (Fixture){.packed = g_byte_array_new(), .bytes = g_byte_array_new()};
    g_byte_array_append(fixture->packed, (const uint8_t *)"head", 4);
    fixture->stream = fl_sparse_stream_new(fixture->packed);
}

static void put(Fixture *fixture, const uint8_t *bytes, size_t n)
{
    fl_sparse_stream_put(fixture->stream, bytes, n);
    g_byte_array_append(fixture->bytes, bytes, (guint)n);
}

static void run(Fixture *fixture, uint8_t value, size_t n)
{
    const guint before = fixture->bytes->len;
    fl_sparse_stream_run(fixture->stream, value, n);
    g_byte_array_set_size(fixture->bytes, before + (guint)n);
    if (n > 0) // else there may be no bytes yet, not even an address
        memset(fixture->bytes->data + before, value, n);
}

/* Ends the stream; both libraries read it, and its checksum. */
static void end(Fixture *fixture, gconstpointer data)
{
    fl_sparse_stream_end(fixture->stream);
    const size_t n = fixture->bytes->len, n_packed = fixture->packed->len - 4;
    const uint8_t *packed = fixture->packed->data + 4;
    g_autofree uint8_t *read = g_malloc(n + 1);
    g_assert_true(fixture->most == 0 || n_packed <= fixture->most);
    g_assert_true(memcmp(fixture->packed->data, "head", 4) == 0);
    uLongf n_read = n + 1;
    g_assert_cmpint(uncompress(read, &n_read, packed, n_packed), ==, Z_OK);
    g_assert_cmpuint(n_read, ==, n);
    g_assert_true(n == 0 || memcmp(read, fixture->bytes->data, n) == 0);
    memset(read, 0, n);
    struct libdeflate_decompressor *other = libdeflate_alloc_decompressor();
    g_assert_cmpint(libdeflate_zlib_decompress(other, packed, n_packed, read, n, NULL), ==,
                    LIBDEFLATE_SUCCESS);
    g_assert_true(n == 0 || memcmp(read, fixture->bytes->data, n) == 0);
    libdeflate_free_decompressor(other);
    g_byte_array_unref(fixture->packed);
    g_byte_array_unref(fixture->bytes);
}

static void nothing_is_a_stream(Fixture *fixture, gconstpointer data)
{
}

static void one_byte_is_a_stream(Fixture *fixture, gconstpointer data)
{
    put(fixture, (const uint8_t *)"x", 1);
}

static void runs_of_every_length_come_back(Fixture *fixture, gconstpointer data)
{
    for (size_t n = 0; n < 700; n++) {
        run(fixture, 1 + n % 2, n);
        put(fixture, (const uint8_t *)"ab\0\0\0\0", n % 7);
        run(fixture, 0, n % 5); // some go on where others end
    }
}

static void pieces_of_every_length_come_back(Fixture *fixture, gconstpointer data)
{
    uint8_t bytes[40];
    for (size_t n = 0; n < sizeof bytes; n++)
        for (size_t same = 0; same <= n; same++) { // at the end, as the run that follows
            for (size_t i = 0; i < n; i++)
                bytes[i] = i + same < n ? (uint8_t)(i % 3) : 9;
            put(fixture, bytes, n);
            run(fixture, same % 2 ? 9 : 0, same);
        }
}

static void long_runs_take_next_to_no_room(Fixture *fixture, gconstpointer data)
{
    run(fixture, 0, 5 << 20);
    run(fixture, 255, 5 << 20);
    fixture->most = 12 << 10;
}

static void noise_grows_by_little(Fixture *fixture, gconstpointer data)
{
    enum { N = 300000 };
    g_autoptr(GRand) random = g_rand_new_with_seed(7);
    g_autofree uint8_t *noise = g_malloc(N);
    for (int i = 0; i < N; i++)
        noise[i] = (uint8_t)g_rand_int(random);
    put(fixture, noise, N);
    fixture->most = N + N / 50;
}

/* Each byte comes twice as often as the next one, so that some of a block come once. */
static void rare_bytes_have_long_codes(Fixture *fixture, gconstpointer data)
{
    enum { N = 1 << 18 };
    g_autofree uint8_t *bytes = g_malloc(N);
    for (int i = 0; i < N; i++)
        bytes[i] = (uint8_t)(3 * g_bit_nth_lsf((gulong)(i | N), -1));
    put(fixture, bytes, N);
}

/* Kraft's sum of a code that leaves nothing over. */
static void expect_complete(const uint32_t *count)
{
    FlPrefixCode code;
    fl_prefix_code_init(&code, count);
    uint32_t taken = 0;
    for (int s = 0; s < FL_CODE_SYMBOLS; s++) {
        g_assert_true((count[s] > 0) == (code.length[s] > 0));
        g_assert_cmpint(code.length[s], <=, FL_CODE_BITS);
        taken += code.length[s] > 0 ? 1U << (FL_CODE_BITS - code.length[s]) : 0;
        for (int t = 0; t < FL_CODE_SYMBOLS; t++) // what comes more often is not longer
            g_assert_true(count[t] == 0 || count[s] <= count[t] ||
                          code.length[s] <= code.length[t]);
    }
    g_assert_cmpuint(taken, ==, 1U << FL_CODE_BITS);
}

static void a_code_is_complete_whatever_is_counted(void)
{
    g_autoptr(GRand) random = g_rand_new_with_seed(3);
    for (int round = 0; round < 200; round++) {
        uint32_t count[FL_CODE_SYMBOLS] = {[0] = 1, [285] = 1};
        const int n = g_rand_int_range(random, 0, FL_CODE_SYMBOLS);
        for (int k = 0; k < n; k++)
            count[k] = 1U << g_rand_int_range(random, 0, 1 + round % 23);
        expect_complete(count);
    }
    uint32_t fibonacci[FL_CODE_SYMBOLS] = {1, 1}; // the deepest tree there is
    for (int k = 2; k < 40; k++)
        fibonacci[k] = fibonacci[k - 1] + fibonacci[k - 2];
    expect_complete(fibonacci);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define ADD(name, test) g_test_add("/sparse-stream/" name, Fixture, NULL, begin, test, end)
    ADD("nothing-is-a-stream", nothing_is_a_stream);
    ADD("one-byte-is-a-stream", one_byte_is_a_stream);
    ADD("runs-of-every-length-come-back", runs_of_every_length_come_back);
    ADD("pieces-of-every-length-come-back", pieces_of_every_length_come_back);
    ADD("long-runs-take-next-to-no-room", long_runs_take_next_to_no_room);
    ADD("noise-grows-by-little", noise_grows_by_little);
    ADD("rare-bytes-have-long-codes", rare_bytes_have_long_codes);
#undef ADD
    g_test_add_func("/sparse-stream/a-code-is-complete-whatever-is-counted",
                    a_code_is_complete_whatever_is_counted);
    return g_test_run();
}
