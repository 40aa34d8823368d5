/* A film as the options and the config ask for it. */
#ifndef FLUIDY_REGIONS_OPENING_H
#define FLUIDY_REGIONS_OPENING_H

#include "params/config.h"
#include "regions/film.h"

/**
 * Opens the film of options, which fl_config_complete() has completed, with the config's rules.
 *
 * What is odd, sections that hold for nothing included, goes to options->warning.
 *
 * Returns: to be freed with fl_film_free(); NULL with an error as of fl_film_open(), or with
 * FL_ERROR_INPUT if there was a warning and the options are strict.
 */
FlFilm *fl_film_of_options(const FlRenderOptions *options, const FlConfig *config, GError **error);

#endif
