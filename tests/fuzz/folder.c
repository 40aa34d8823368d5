#include "folder.h"

#include <glib.h>
#include <glib/gstdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char *folder;

void fuzz_empty(const char *path, int keep)
{
    GDir *dir = g_dir_open(path, 0, NULL);
    for (const char *name; dir && (name = g_dir_read_name(dir));) {
        g_autofree char *child = g_build_filename(path, name, NULL);
        if (g_unlink(child) != 0)
            fuzz_empty(child, 0);
    }
    if (dir)
        g_dir_close(dir);
    if (!keep)
        g_rmdir(path);
}

static void remove_folder(void)
{
    fuzz_empty(folder, 0);
    g_clear_pointer(&folder, g_free);
}

const char *fuzz_folder(void)
{
    if (folder)
        return folder;
    const char *memory = "/dev/shm";
    folder = g_build_filename(access(memory, W_OK) == 0 ? memory : g_get_tmp_dir(),
                              "fluidy-fuzz-XXXXXX", NULL);
    g_assert_nonnull(g_mkdtemp(folder));
    atexit(remove_folder);
    return folder;
}

int fuzz_write_pngs(const uint8_t *data, size_t size, const char *to, int most, char **line)
{
    static const uint8_t mark[] = {0x89, 'P', 'N', 'G'};
    const uint8_t *end = data + size, *at = memmem(data, size, mark, sizeof mark);
    int n = 0;
    *line = g_strndup((const char *)data, (size_t)((at ? at : end) - data));
    (*line)[strcspn(*line, "\n")] = '\0';
    while (at && n < most) {
        const uint8_t *next = memmem(at + 1, (size_t)(end - at - 1), mark, sizeof mark);
        g_autofree char *path = g_strdup_printf("%s/%d.png", to, ++n);
        FILE *file = g_fopen(path, "w");
        g_assert_nonnull(file);
        fwrite(at, 1, (size_t)((next ? next : end) - at), file);
        fclose(file);
        at = next;
    }
    return n;
}
