/* What both programs do about the words of their command lines beside GOption. */
#ifndef FLUIDY_CLI_WORDS_H
#define FLUIDY_CLI_WORDS_H

#include <glib.h>

/**
 * Turns GOption's error about an unknown option into one of ours, which says what may have been
 * meant or else where to look: `help`. Other errors stay as they are. names: of all long options.
 */
void fl_words_unknown(const char *const *names, const char *help, GError **error);

/** GOption keeps "--" before a word that begins with a dash; it has served its purpose. */
void fl_words_drop_separator(char **words);

#endif
