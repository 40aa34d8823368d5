/* The help, suggestions for unknown options, and option names in messages. */
#pragma once

#include "params/options.h"

/** An option in GOption's terms, without the function that reads its value. The strings live as
 * long as the program. */
GOptionEntry fl_help_entry(const FlOption *option);

/** The text of --help, or of --help-all; to be freed with g_free(). */
char *fl_help_text(bool all);

/** Turns GOption's error about an unknown option into ours, with the option that is nearest. */
void fl_help_suggest(GError **error);

/** A message of the library in the words of the command line: ‘canvas’ as --canvas. To be freed. */
char *fl_help_translate(const char *message);
