/* The folders of the styles that come with the program. */
#ifndef FLUIDY_TESTS_BUNDLED_STYLE_H
#define FLUIDY_TESTS_BUNDLED_STYLE_H

#include <glib.h>

/** To be freed with g_free(). */
static inline char *bundled_style(const char *number)
{
    return g_build_filename(g_getenv("FLUIDY_FIXTURES"), "styles", number, NULL);
}

#endif
