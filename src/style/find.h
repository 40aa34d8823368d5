/* Where styles are looked for. */
#ifndef FLUIDY_STYLE_FIND_H
#define FLUIDY_STYLE_FIND_H

#include <glib.h>

/**
 * The folders of styles in the order in which they are searched [DESIGN §5]: those in
 * $FLUIDY_STYLES (separated as in $PATH), the user's and the system's data folders, the installed
 * one, the source tree's. Some may not exist. NULL-terminated.
 */
char **fl_style_folders(void);

/** Whether a folder has a `frames` folder in it, which is all that makes it a style. */
gboolean fl_is_style(const char *folder);

#endif
