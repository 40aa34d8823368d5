/* Looks: a config with its styles, paper and a thumbnail in one file, to be given away. A look is a
 * ZIP archive of look.conf, thumbnail.png and files below styles/ and files/. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>

#define FL_LOOK_SUFFIX ".fluidy"
#define FL_LOOK_CONFIG "look.conf"

/** Returns: true if a file's name ends as that of a look. Inline, for the programs too. */
static inline bool fl_look_named(const char *path)
{
    g_autofree char *lower = g_ascii_strdown(path, -1);
    return g_str_has_suffix(lower, FL_LOOK_SUFFIX);
}

/**
 * Unpacks a look, which need not be trusted, into a folder of the user's cache that is named by its
 * contents, unless it is there already.
 *
 * Returns: the folder, to be freed; NULL with FL_ERROR_INPUT for a file that is no look or has a
 * name that is not one of those above, FL_ERROR_LIMIT if it is too large, or FL_ERROR_OUTPUT.
 */
char *fl_look_unpack(const char *path, GError **error);
