#include "svg/reference.h"

#include <gio/gio.h>
#include <stdlib.h>
#include <string.h>

char *fl_reference_file(const char *from, const char *href, bool *is_there)
{
    g_autoptr(GFile) file = g_file_new_for_path(from);
    g_autoptr(GFile) folder = g_file_get_parent(file);
    g_autofree char *base = folder ? g_file_get_uri(folder) : g_strdup("file:///");
    g_autofree char *slash = g_strconcat(base, "/", NULL);
    g_autofree char *bare = g_strndup(href, strcspn(href, "#"));
    g_autofree char *uri = g_uri_resolve_relative(slash, bare, G_URI_FLAGS_PARSE_RELAXED, NULL);
    g_autofree char *path = uri ? g_filename_from_uri(uri, NULL, NULL) : NULL;
    char *real = path ? realpath(path, NULL) : NULL;
    *is_there = real != NULL;
    return !path || real ? real : g_canonicalize_filename(path, NULL);
}

bool fl_reference_is_inside(const char *drawing, const char *file)
{
    g_autofree char *real = realpath(drawing, NULL);
    g_autofree char *folder = real ? g_path_get_dirname(real) : NULL;
    const size_t n = folder ? strlen(folder) : 0;
    return n > 0 && strncmp(file, folder, n) == 0 && (file[n] == '/' || folder[n - 1] == '/');
}
