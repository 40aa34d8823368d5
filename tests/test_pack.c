/* Packed bytes: they come back, and what is not whole is known. */
#include "base/compress.h"
#include "base/rng.h"
#include <glib.h>
#include <string.h>

enum { ONE = 70000, TWO = 0, THREE = 300000 };

/** Something that packs well, nothing, and noise, which does not. */
static void fill(uint8_t *one, uint8_t *three)
{
    memset(one, 7, ONE);
    for (int i = 0; i < THREE; i++)
        three[i] = (uint8_t)fl_key(1, (uint64_t)i);
}

static uint8_t one[ONE], three[THREE];
static uint8_t one_back[ONE + 1], three_back[THREE + 1];

static uint8_t *packed(size_t *used)
{
    const FlSpan spans[] = {{one, ONE}, {NULL, TWO}, {three, THREE}};
    fill(one, three);
    g_autoptr(GBytes) all = fl_pack(NULL, 0, spans, 3, NULL);
    uint8_t *bytes = g_memdup2(g_bytes_get_data(all, NULL), g_bytes_get_size(all));
    *used = g_bytes_get_size(all);
    g_assert_cmpint(*used, >, THREE);
    g_assert_cmpint(*used, <, THREE + ONE / 10);
    return bytes;
}

static bool unpacks(const uint8_t *bytes, size_t used, size_t first, size_t last)
{
    const FlSpan spans[] = {{one_back, first}, {NULL, TWO}, {three_back, last}};
    return fl_unpack(bytes, used, spans, 3);
}

static void spans_come_back_as_they_were(void)
{
    size_t used;
    g_autofree uint8_t *bytes = packed(&used);
    g_assert_true(unpacks(bytes, used, ONE, THREE));
    g_assert_cmpmem(one_back, ONE, one, ONE);
    g_assert_cmpmem(three_back, THREE, three, THREE);
}

static void bytes_cut_short_or_too_many_are_refused(void)
{
    size_t used;
    g_autofree uint8_t *bytes = packed(&used);
    for (size_t n = 0; n < used; n += 1 + used / 50)
        g_assert_false(unpacks(bytes, n, ONE, THREE));
    g_assert_false(unpacks(bytes, used - 1, ONE, THREE));
    bytes = g_realloc(bytes, used + 1);
    g_assert_false(unpacks(bytes, used + 1, ONE, THREE));
}

static void spans_of_other_sizes_are_refused(void)
{
    size_t used;
    g_autofree uint8_t *bytes = packed(&used);
    g_assert_false(unpacks(bytes, used, ONE, THREE - 1));
    g_assert_false(unpacks(bytes, used, ONE, THREE + 1));
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define CASE(test) g_test_add_func("/pack/" #test, test)
    CASE(spans_come_back_as_they_were);
    CASE(bytes_cut_short_or_too_many_are_refused);
    CASE(spans_of_other_sizes_are_refused);
    return g_test_run();
}
