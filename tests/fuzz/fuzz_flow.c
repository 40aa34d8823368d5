/* Flow files of 4 x 4 pixels: the first byte says which format. */
#include "fuzz.h"
#include "guides/flow_file.h"
#include <math.h>
#include <stdlib.h>

static void check(const char *path)
{
    float flow[2 * 4 * 4];
    g_autoptr(GError) error = NULL;
    const bool read = fl_flow_load(path, 4, 4, 0, flow, &error);
    g_assert_true(read == (error == NULL));
    for (int k = 0; read && k < 32; k++)
        g_assert_true(isfinite(flow[k]));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size == 0)
        return 0;
    g_autofree char *folder = g_dir_make_tmp("fluidy-fuzz-XXXXXX", NULL);
    g_autofree char *path = g_build_filename(folder, data[0] % 2 ? "a.flo" : "a.raw", NULL);
    g_assert_true(g_file_set_contents(path, (const char *)data + 1, (gssize)size - 1, NULL));
    check(path);
    unlink(path);
    rmdir(folder);
    return 0;
}
