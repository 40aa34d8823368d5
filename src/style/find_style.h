/* The search for styles by name. */
#ifndef FLUIDY_STYLE_FIND_STYLE_H
#define FLUIDY_STYLE_FIND_STYLE_H

#include <fluidy/style.h>

/** Whether a folder has a `frames` folder in it, which is all that makes it a style. */
bool fl_is_style(const char *folder);

#endif
