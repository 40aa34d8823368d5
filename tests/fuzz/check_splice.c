/* The splicing mutator: what it makes of well-formed drawings is mostly well-formed, and new. usage:
 * check_splice FILE... */
#include "splice.h"
#include <libxml/parser.h>
#include <stdbool.h>
#include <string.h>

enum { ROUNDS = 300 };

/** Instead of libFuzzer's. */
static size_t overwrite(uint8_t *data, size_t n, size_t most)
{
    if (n > 0)
        data[n / 2] = '7';
    return n;
}

/** Whether all frames of a text are well-formed. */
static bool is_well_formed(const GString *text)
{
    g_auto(GStrv) frames = g_strsplit(text->str, FRAME_MARK, -1);
    bool good = true;
    for (int i = 0; frames[i]; i++) {
        xmlDoc *doc = xmlReadMemory(frames[i], (int)strlen(frames[i]), "x.svg", NULL,
                                    XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_NONET);
        good = good && doc;
        xmlFreeDoc(doc);
    }
    return good;
}

static GString *read_file(const char *path)
{
    char *contents;
    gsize size;
    g_assert_true(g_file_get_contents(path, &contents, &size, NULL));
    GString *text = g_string_new_len(contents, (gssize)size);
    g_free(contents);
    return text;
}

/** Counts changes and well-formed results of one of the two functions. */
static void count(const GString *text, const GString *other, unsigned seed, int *formed, int *new)
{
    g_autoptr(GString) changed = g_string_new_len(text->str, (gssize)text->len);
    g_autoptr(GString) again = g_string_new_len(text->str, (gssize)text->len);
    if (other) {
        splice_cross(changed, other, seed);
        splice_cross(again, other, seed);
    } else {
        splice_mutate(changed, seed, overwrite);
        splice_mutate(again, seed, overwrite);
    }
    g_assert_true(g_string_equal(changed, again)); // by chance, but by the seed's
    *formed += is_well_formed(changed);
    *new += !g_string_equal(changed, text);
}

static void expect(const char *what, int n, int all, double share)
{
    if (n < share * all)
        g_error("%s: %d of %d, expected %g of them", what, n, all, share);
}

int main(int argc, char **argv)
{
    int formed[2] = {0, 0}, new[2] = {0, 0}, n = 0;
    for (int i = 1; i < argc; i++) {
        g_autoptr(GString) text = read_file(argv[i]), other = read_file(argv[i % (argc - 1) + 1]);
        g_assert_true(is_well_formed(text));
        for (unsigned seed = 0; seed < ROUNDS; seed++, n++) {
            count(text, NULL, seed, &formed[0], &new[0]);
            count(text, other, seed, &formed[1], &new[1]);
        }
    }
    expect("well-formed mutations", formed[0], n, 0.9);
    expect("mutations that change something", new[0], n, 0.9);
    expect("well-formed splices", formed[1], n, 0.9);
    expect("splices that change something", new[1], n, 0.9);
    g_print("1..1\nok 1 - %d %d mutations and %d %d splices of %d are well-formed and new\n",
            formed[0], new[0], formed[1], new[1], n);
    return 0;
}
