/* "Did you mean": the known word that is nearest to one that was mistyped. */
#pragma once

#include <stdbool.h>

/**
 * Letters to insert, delete, replace or swap with their neighbour to turn `a` into `b`.
 *
 * Case does not count, and '-', '_' and ' ' are equal. Bytes are letters. Each word may have 255 at
 * most; a longer one is far from everything (INT_MAX).
 */
int fl_edit_distance(const char *a, const char *b);

/** Returns: true if at most a third of the letters of `known`, or one letter, would have to change.
 */
bool fl_resembles(const char *word, const char *known);

/**
 * The word of the NULL-terminated list `words` that replaced `word` in this release, or is nearest
 * to it, the first of equals.
 *
 * Returns: an element of `words`; NULL if no word is similar.
 */
const char *fl_suggest(const char *word, const char *const *words);

/**
 * The tail of an error message: "; did you mean “w-temp”?", or "" if no word is similar.
 *
 * Returns: to be freed with g_free(); never NULL.
 */
char *fl_did_you_mean(const char *word, const char *const *words);
