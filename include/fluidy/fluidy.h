/** @file
 * libfluidy paints SVG frame sequences with moving paint. This header includes all others. Each
 * says which threads may call its functions.
 */
#ifndef FLUIDY_FLUIDY_H
#define FLUIDY_FLUIDY_H

#include <fluidy/compare.h>
#include <fluidy/error.h>
#include <fluidy/film.h>
#include <fluidy/inspect.h>
#include <fluidy/limits.h>
#include <fluidy/paint.h>
#include <fluidy/render.h>
#include <fluidy/style.h>
#include <fluidy/version.h>
#include <fluidy/watercolour.h>

G_BEGIN_DECLS

/** The library's version, such as "0.1.0"; static storage. */
FL_API const char *fl_version(void);

G_END_DECLS

#endif
