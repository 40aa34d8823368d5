#include "words.h"

#include "base/suggest.h"
#include <fluidy/error.h>
#include <string.h>
#include <unistd.h>

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
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "unknown option %s; did you mean --%s?",
                    unknown, near);
    else
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "unknown option %s; see %s", unknown, help);
}

char *fl_words_translate(const char *message, char *(*flag)(const char *name, void *data),
                         void *data)
{
    static const char open[] = "‘", close[] = "’";
    GString *text = g_string_new(NULL);
    for (const char *begin; (begin = strstr(message, open));) {
        g_string_append_len(text, message, begin - message);
        begin += strlen(open);
        const size_t n = strspn(begin, "abcdefghijklmnopqrstuvwxyz-");
        g_autofree char *name = g_strndup(begin, n);
        g_autofree char *words =
            g_str_has_prefix(begin + n, close) && n > 0 ? flag(name, data) : NULL;
        g_string_append(text, words ? words : open);
        message = words ? begin + n + strlen(close) : begin;
    }
    g_string_append(text, message);
    return g_string_free(text, FALSE);
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

void fl_wait_asleep(char **argv)
{
#ifdef _OPENMP
    static const char *const words[] = {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT", "KMP_BLOCKTIME"};
    for (size_t i = 0; i < G_N_ELEMENTS(words); i++)
        if (g_getenv(words[i]))
            return; // set by the user, or by the first start
    g_autofree char *program = g_file_read_link("/proc/self/exe", NULL);
    if (program && g_setenv("OMP_WAIT_POLICY", "passive", TRUE))
        execv(program, argv);
#endif
}
