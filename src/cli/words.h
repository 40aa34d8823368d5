/* Command-line helpers of both programs, beside GOption. */
#pragma once

#include <glib.h>

/**
 * Turns GOption's error about an unknown option into one of ours, which suggests a similar option
 * or else `help`. Other errors stay as they are. names: of all long options.
 */
void fl_words_unknown(const char *const *names, const char *help, GError **error);

/**
 * Replaces ‘name’, an option in a message of the library, by its command-line form.
 *
 * flag returns "--name" or NULL, if the program has no such option: the text then stays as it is.
 * Returns: to be freed with g_free().
 */
char *fl_words_translate(const char *message, char *(*flag)(const char *name, void *data),
                         void *data);

/** GOption keeps "--" before a word that begins with a dash; it has served its purpose. */
void fl_words_drop_separator(char **words);

/**
 * Has OpenMP's threads sleep while they wait, unless the environment says otherwise: busy waiting
 * takes the processors from other jobs. gcc's libgomp reads the policy before main() and no
 * function can change it, so the program executes itself again; if that fails, threads wait busily.
 * Call this before all other functions.
 */
void fl_wait_asleep(char **argv);
