/* Scans the text of style sheets and values [CSS Syntax 3] without building tokens. */
#pragma once

#include <glib.h>
#include <stdbool.h>

#define FL_CSS_SPACE " \t\r\n\f"

/** Skips white space. */
const char *fl_css_space(const char *s);

/** Returns: true if a word is among those of a text, between white space. */
bool fl_css_has_word(const char *text, const char *word);

/**
 * Finds the first character of `stops` outside strings, escapes and brackets. A closing bracket
 * that was not opened ends the search as well.
 *
 * Returns: a pointer to that character, or to the terminating NUL.
 */
const char *fl_css_find(const char *s, const char *stops);

/** Likewise, but passes closing brackets that were not opened. */
const char *fl_css_find_past(const char *s, const char *stops);

/**
 * Reads a number of SVG or CSS, without a unit, and skips it.
 *
 * Returns: false if *s begins with none, or one that is not finite; *s is as it was then.
 */
bool fl_number_read(const char **s, double *value);

/** Reads a list of plain numbers, with a comma between two at most. Returns: how many; -1 if there
 * are more, or other things. */
int fl_numbers_read(const char *text, double *v, int most);

/** The length in bytes of the identifier at the start of `s`, escapes included; 0 if it has no
 * identifier. */
size_t fl_css_identifier(const char *s);

/** A copy of n bytes with escapes resolved: "a\3a b" is "a:b". To be freed with g_free(). */
char *fl_css_unescape(const char *s, size_t n);

/** A copy without comments, <!-- and -->; each becomes a space. To be freed with g_free(). */
char *fl_css_without_comments(const char *css);

/**
 * Splits at a separator outside strings and brackets: ',' or ' ', which stands for any white space.
 * Parts are trimmed and never empty. To be freed with g_strfreev().
 */
char **fl_css_split(const char *text, char separator);

/**
 * Reads a function call that is all of `text`: "calc( 1px + 2px )" gives the name "calc", in lower
 * case, and the arguments "1px + 2px". Returns: false if `text` is not a call; both strings are to
 * be freed.
 */
bool fl_css_call(const char *text, char **name, char **arguments);

/** The text of a string, url("…") or url(…); NULL if `text` is neither. To be freed. */
char *fl_css_string_or_url(const char *text);

/** Likewise of the url(…) that *s begins with, which is skipped. */
char *fl_css_take_url(const char **s);
