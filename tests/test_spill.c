#include "base/spill.h"
#include <string.h>

static void a_block_comes_back_as_it_was_stored(void)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(FlSpill) spill = fl_spill_new(3, &error);
    g_assert_no_error(error);
    unsigned char data[1000], back[1000];
    for (int block = 2; block >= 0; block--) {
        memset(data, block + 1, sizeof data);
        g_assert_true(fl_spill_put(spill, block, data, sizeof data, &error));
    }
    for (int block = 0; block < 3; block++) {
        memset(data, block + 1, sizeof data);
        g_assert_true(fl_spill_get(spill, block, back, sizeof back, &error));
        g_assert_cmpmem(back, sizeof back, data, sizeof data);
    }
}

static void a_block_stored_again_replaces_the_first(void)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(FlSpill) spill = fl_spill_new(1, &error);
    int value = 0;
    for (int i = 1; i <= 2; i++)
        g_assert_true(fl_spill_put(spill, 0, &i, sizeof i, &error));
    g_assert_true(fl_spill_get(spill, 0, &value, sizeof value, &error));
    g_assert_cmpint(value, ==, 2);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/spill/a-block-comes-back-as-it-was-stored",
                    a_block_comes_back_as_it_was_stored);
    g_test_add_func("/spill/a-block-stored-again-replaces-the-first",
                    a_block_stored_again_replaces_the_first);
    return g_test_run();
}
