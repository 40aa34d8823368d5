/* The network that moves ink: its integers, and files that are broken. */
#include "bundled_style.h"
#include "transport/network.h"

#include <glib/gstdio.h>
#include <string.h>
#include <zlib.h>

#define CASE_WIDTH 64
#define CASE_HEIGHT 48
#define CASE_PLANE ((size_t)CASE_WIDTH * CASE_HEIGHT)

/* Inputs, and what the training script's own integers make of them. */
static int16_t *stored_case(void)
{
    const size_t heads = CASE_PLANE / 4 + CASE_PLANE / 16 + CASE_PLANE / 64;
    const size_t n = FL_NETWORK_INPUTS * CASE_PLANE + heads;
    g_autofree char *path =
        g_build_filename(g_getenv("FLUIDY_FIXTURES"), "transport", "network.case", NULL);
    g_autofree uint8_t *bytes = NULL;
    size_t size;
    g_assert_true(g_file_get_contents(path, (char **)&bytes, &size, NULL));
    g_assert_cmpuint(size, ==, 2 * n);
    int16_t *values = g_new(int16_t, n);
    for (size_t i = 0; i < n; i++)
        values[i] = (int16_t)(bytes[2 * i] | bytes[2 * i + 1] << 8);
    return values;
}

static void the_network_is_that_of_its_training(void)
{
    g_autofree char *folder = bundled_style(BATIK);
    g_autofree int16_t *values = stored_case(), *found = g_new(int16_t, CASE_PLANE);
    g_autoptr(FlNetwork) network = fl_network_load(folder, NULL);
    g_assert_nonnull(network);
    int16_t *heads[FL_NETWORK_HEADS] = {found, found + CASE_PLANE / 4,
                                        found + CASE_PLANE / 4 + CASE_PLANE / 16};
    g_assert_true(fl_network_run(network, values, CASE_WIDTH, CASE_HEIGHT, heads, NULL));
    const size_t n = CASE_PLANE / 4 + CASE_PLANE / 16 + CASE_PLANE / 64;
    g_assert_cmpmem(found, 2 * n, values + FL_NETWORK_INPUTS * CASE_PLANE, 2 * n);
}

/* Whether a file with these bytes is read; if not, with one line that names it. */
static bool reads(const char *folder, const uint8_t *bytes, size_t size)
{
    g_autofree char *path = g_build_filename(folder, "transport.net", NULL);
    g_autoptr(GError) error = NULL;
    g_assert_true(g_file_set_contents(path, (const char *)bytes, (gssize)size, NULL));
    g_autoptr(FlNetwork) network = fl_network_load(folder, &error);
    if (!network) {
        g_assert_error(error, FL_ERROR, FL_ERROR_STYLE);
        g_assert_nonnull(strstr(error->message, path));
        g_assert_null(strchr(error->message, '\n'));
    }
    return network;
}

static void sign(uint8_t *bytes, size_t size)
{
    const uint32_t crc = (uint32_t)crc32(0, bytes + 8, (uInt)(size - 12));
    for (int i = 0; i < 4; i++)
        bytes[size - 4 + (size_t)i] = (uint8_t)(crc >> 8 * i);
}

static void hostile_networks_are_rejected(void)
{
    g_autofree char *folder = bundled_style(BATIK), *temporary = g_dir_make_tmp("net-XXXXXX", NULL);
    g_autofree char *path = g_build_filename(folder, "transport.net", NULL);
    g_autofree char *written = g_build_filename(temporary, "transport.net", NULL);
    g_autofree uint8_t *bytes = NULL;
    size_t size;
    g_assert_true(g_file_get_contents(path, (char **)&bytes, &size, NULL));
    g_assert_true(reads(temporary, bytes, size));
    g_assert_false(reads(temporary, bytes, size - 1));
    g_assert_false(reads(temporary, bytes, 11));
    g_assert_false(reads(temporary, bytes, 0));
    bytes[size / 2] ^= 1; // damage
    g_assert_false(reads(temporary, bytes, size));
    bytes[size / 2] ^= 1;
    for (size_t at = 8; at < 20; at++) { // signed, but its sizes or the shift are wrong
        const uint8_t before = bytes[at];
        bytes[at] = at == 10 ? 13 : 255;
        sign(bytes, size);
        g_assert_false(reads(temporary, bytes, size));
        bytes[at] = before;
    }
    const size_t weights = 8 + 8 + 4 + 4 * 12;
    for (size_t i = 0; i < 100; i++) // sums that could overflow
        bytes[weights + 2 * i] = 0xff, bytes[weights + 2 * i + 1] = 0x7f;
    sign(bytes, size);
    g_assert_false(reads(temporary, bytes, size));
    g_unlink(written), g_rmdir(temporary);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/network/" #name, name)
    TEST(the_network_is_that_of_its_training);
    TEST(hostile_networks_are_rejected);
    return g_test_run();
}
