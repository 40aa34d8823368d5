#include "words.h"

#include "base/suggest.h"
#include <fluidy/error.h>
#include <string.h>

void fl_words_unknown(const char *const *names, const char *help, GError **error)
{
    const char *word = strstr((*error)->message, " -"); // the one that starts with a dash
    if (!word)
        return;
    g_autofree char *unknown = g_strdup(word + 1);
    *strchrnul(unknown, '=') = '\0';
    const char *near = fl_suggest(unknown + strspn(unknown, "-"), names);
    g_clear_error(error);
    if (near)
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "there is no option %s; did you mean --%s?",
                    unknown, near);
    else
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "there is no option %s; see %s", unknown,
                    help);
}

void fl_words_drop_separator(char **words)
{
    while (*words && strcmp(*words, "--") != 0)
        words++;
    if (!*words)
        return;
    g_free(*words);
    for (; *words; words++)
        words[0] = words[1];
}
