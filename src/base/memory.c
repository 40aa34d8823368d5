#include "base/memory.h"

#include <glib.h>
#include <string.h>
#include <unistd.h>

/* A number of MiB in a file of bytes; "max", and whatever else is no number, is no limit. */
static int64_t read_mib(const char *path)
{
    g_autofree char *text = NULL;
    guint64 bytes = 0;
    if (g_file_get_contents(path, &text, NULL, NULL) &&
        g_ascii_string_to_unsigned(g_strchomp(text), 10, 0, G_MAXUINT64, &bytes, NULL))
        return (int64_t)(bytes >> 20);
    return INT64_MAX;
}

/* The least of a group and of those that it is in. A container may be told the path of its group
 * from outside, but see the group as the root. Cuts `group` down. */
static int64_t least_on_path(const char *mount, char *group, const char *name)
{
    int64_t least = INT64_MAX;
    for (char *end = group + strlen(group); end; end = strrchr(group, '/')) {
        *end = '\0';
        g_autofree char *path = g_build_filename(mount, group, name, NULL);
        least = MIN(least, read_mib(path));
    }
    return least;
}

/* Of a line "number:controllers:/group"; version 2 has no controllers there. */
static int64_t group_mib(const char *root, const char *line)
{
    g_auto(GStrv) field = g_strsplit(line, ":", 3);
    g_auto(GStrv) controllers = g_strsplit(field[0] && field[1] ? field[1] : "-", ",", -1);
    g_autofree char *mount = g_build_filename(root, "sys/fs/cgroup", NULL);
    g_autofree char *first = g_build_filename(mount, "memory", NULL);
    if (g_strv_length(field) < 3)
        return INT64_MAX;
    if (g_strv_contains((const char *const *)controllers, "memory"))
        return least_on_path(first, field[2], "memory.limit_in_bytes");
    return *field[1] ? INT64_MAX : least_on_path(mount, field[2], "memory.max");
}

int64_t fl_memory_mib(const char *root)
{
    int64_t least = (int64_t)sysconf(_SC_PHYS_PAGES) / 1024 * sysconf(_SC_PAGESIZE) / 1024;
    g_autofree char *path = g_build_filename(root, "proc/self/cgroup", NULL);
    g_autofree char *text = NULL;
    if (!g_file_get_contents(path, &text, NULL, NULL))
        return least;
    g_auto(GStrv) line = g_strsplit(text, "\n", -1);
    for (int i = 0; line[i]; i++)
        least = MIN(least, group_mib(root, line[i]));
    return MAX(least, 1);
}
