/* Packed bytes: they come back, and what is not whole is known. */
#include "base/compress.h"
#include "base/rng.h"
#include "compose/painted_region.h"
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

/** A bare sheet with some noise on it, and alpha behind it. */
static void fill_picture(FlPaintedRegion *painted)
{
    const size_t pixels = fl_rect_pixels(painted->rect);
    memset(painted->painted, 240, 3 * pixels);
    for (size_t i = 0; i < 900; i++)
        painted->painted[3 * pixels / 2 + i] = (uint8_t)fl_key(2, i);
    memset(painted->alpha, 200, pixels);
}

static void a_picture_waits_packed(void)
{
    g_autoptr(GError) error = NULL;
    FlPaintedRegion painted = {.rect = {3, 4, 100, 80}, .reach_px = 1};
    g_assert_true(fl_painted_open(&painted, &error));
    fill_picture(&painted);
    const size_t bytes = fl_painted_bytes(&painted);
    g_autofree uint8_t *picture = g_memdup2(painted.painted, bytes);
    g_assert_true(fl_painted_pack(&painted, &error));
    g_assert_null(painted.painted);
    g_assert_null(painted.alpha);
    g_assert_cmpint(g_bytes_get_size(painted.packed), <, 2000);
    g_auto(FlPaintedReader) look = {0};
    g_assert_true(fl_painted_read(&painted, &look, &error));
    g_assert_true(memcmp(look.region.painted, picture, bytes) == 0);
    g_assert_true(look.region.alpha == look.region.painted + 3 * 100 * 80);
    g_assert_true(fl_painted_pack(&painted, &error)); // it is already
    g_assert_true(fl_painted_open(&painted, &error));
    g_assert_null(painted.packed);
    g_assert_true(memcmp(painted.painted, picture, bytes) == 0);
    g_assert_no_error(error);
    fl_painted_clear(&painted);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define CASE(test) g_test_add_func("/pack/" #test, test)
    CASE(spans_come_back_as_they_were);
    CASE(bytes_cut_short_or_too_many_are_refused);
    CASE(spans_of_other_sizes_are_refused);
    CASE(a_picture_waits_packed);
    return g_test_run();
}
