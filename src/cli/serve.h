/* --serve: a page for a browser on this machine in which a film is tried out. */
#pragma once

#include "args.h"
#include <signal.h>

/**
 * Serves the page at 127.0.0.1 and paints the film by its choices, until *stop is set. Prints the
 * page's address. Writes temporary files, the cache of paint, and the config if a page saves it.
 *
 * Returns: false with an error before anything is served: FL_ERROR_USAGE about the command line,
 * errors of reading the drawing, FL_ERROR_OUTPUT if the port is in use.
 */
bool fl_serve(const FlArgs *args, const volatile sig_atomic_t *stop, GError **error);
