#include "job/checkpoint.h"
#include <glib/gstdio.h>
#include <string.h>

static FlCheckpoint *state_of(const int *bytes, int n)
{
    FlCheckpoint *state = fl_checkpoint_new();
    state->print = fl_fingerprint_new_empty();
    fl_fingerprint_add(state->print, "seed", "7");
    state->done = 3;
    for (int i = 0; i < n; i++) {
        uint8_t *data = g_malloc(bytes[i]); // NULL for none
        if (data)
            memset(data, i + 1, bytes[i]);
        g_ptr_array_add(state->painter, g_bytes_new_take(data, bytes[i]));
    }
    return state;
}

static void check_saved(const int *bytes, int n)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *folder = g_dir_make_tmp("fluidy-XXXXXX", &error);
    g_autofree char *path = g_build_filename(folder, "state", NULL);
    g_autoptr(FlCheckpoint) state = state_of(bytes, n);
    g_assert_true(fl_checkpoint_save(state, path, &error));
    g_autoptr(FlCheckpoint) back = fl_checkpoint_load(path, &error);
    g_assert_no_error(error);
    g_assert_cmpint(back->done, ==, 3);
    g_assert_null(fl_fingerprint_difference(state->print, back->print));
    g_assert_cmpint(back->painter->len, ==, n);
    for (int i = 0; i < n; i++)
        g_assert_true(g_bytes_equal(back->painter->pdata[i], state->painter->pdata[i]));
    g_remove(path);
    g_rmdir(folder);
}

static void painters_of_any_size_come_back_as_they_were_saved(void)
{
    static int many[300];
    for (int i = 0; i < 300; i++)
        many[i] = i % 3;
    check_saved(NULL, 0);
    check_saved((const int[]){0}, 1);
    check_saved((const int[]){5, 0, 90}, 3);
    check_saved((const int[]){100, 150}, 2); // offsets of one byte no longer do
    check_saved((const int[]){40000, 0, 30000}, 3); // nor of two
    check_saved(many, 300);
    for (int size = 100; size < 260; size++)
        check_saved(&size, 1);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/checkpoint/painters-of-any-size-come-back-as-they-were-saved",
                    painters_of_any_size_come_back_as_they_were_saved);
    return g_test_run();
}
