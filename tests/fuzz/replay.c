/* Runs a fuzz target over files and folders of files; speaks TAP. usage: replay_X PATH… */
#include "fuzz.h"

static int n;

static void replay_file(const char *path)
{
    g_autofree char *contents = NULL;
    size_t size = 0;
    if (!g_file_get_contents(path, &contents, &size, NULL))
        return;
    LLVMFuzzerTestOneInput((const uint8_t *)contents, size);
    g_print("ok %d - %s ends well\n", ++n, path);
}

static void replay(const char *path)
{
    g_autoptr(GDir) dir = g_dir_open(path, 0, NULL);
    if (!dir) {
        replay_file(path);
        return;
    }
    for (const char *name; (name = g_dir_read_name(dir));) {
        g_autofree char *child = g_build_filename(path, name, NULL);
        replay(child);
    }
}

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; i++)
        replay(argv[i]);
    g_print("1..%d\n", n);
    return n > 0 ? 0 : 1;
}
