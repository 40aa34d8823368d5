#include "base/suggest.h"

#include <glib.h>
#include <limits.h>
#include <string.h>

#define LONGEST 255 // as of file names

static char folded(char c)
{
    return c == '_' || c == ' ' ? '-' : g_ascii_tolower(c);
}

/* The optimal string alignment distance: three rows of the usual table suffice. */
int fl_edit_distance(const char *a, const char *b)
{
    const size_t a_bytes = strlen(a), b_bytes = strlen(b);
    if (a_bytes > LONGEST || b_bytes > LONGEST)
        return INT_MAX;
    int rows[3][LONGEST + 1] = {0};
    int *before = rows[0], *above = rows[1], *row = rows[2];
    for (size_t j = 0; j <= b_bytes; j++)
        above[j] = (int)j;
    for (size_t i = 1; i <= a_bytes; i++) {
        row[0] = (int)i;
        for (size_t j = 1; j <= b_bytes; j++) {
            const char ca = folded(a[i - 1]), cb = folded(b[j - 1]);
            row[j] = MIN(MIN(above[j], row[j - 1]) + 1, above[j - 1] + (ca != cb));
            if (i > 1 && j > 1 && ca == folded(b[j - 2]) && folded(a[i - 2]) == cb)
                row[j] = MIN(row[j], before[j - 2] + 1);
        }
        int *const spare = before;
        before = above, above = row, row = spare;
    }
    return above[b_bytes];
}

static int most_typos(const char *known)
{
    return MAX(1, (int)strlen(known) / 3);
}

bool fl_resembles(const char *word, const char *known)
{
    return fl_edit_distance(word, known) <= most_typos(known);
}

/* Says if a known word took the place of one of an earlier release. */
static bool replaces(const char *known, const char *word)
{
    static const char *const renamed[][2] = {
        {"load", "wash"}, {"pigments", "hue"}, {"fluid", "lazyfluids-steady"}};
    for (size_t i = 0; i < G_N_ELEMENTS(renamed); i++)
        if (strcmp(known, renamed[i][1]) == 0 && fl_edit_distance(word, renamed[i][0]) == 0)
            return true;
    return false;
}

const char *fl_suggest(const char *word, const char *const *words)
{
    const char *nearest = NULL;
    int least = INT_MAX;
    for (; *words; words++) {
        const int distance = replaces(*words, word) ? 0 : fl_edit_distance(word, *words);
        if (distance < least && distance <= most_typos(*words))
            least = distance, nearest = *words;
    }
    return nearest;
}

char *fl_did_you_mean(const char *word, const char *const *words)
{
    const char *nearest = fl_suggest(word, words);
    return nearest ? g_strdup_printf("; did you mean “%s”?", nearest) : g_strdup("");
}
