/* Records of renders come back as they were saved, and damaged ones do not. */
#include "keep/record.h"
#include <fluidy/error.h>

#include "scratch.h"
#include <string.h>

static FlRecord *new_record(void)
{
    FlRecord *record = fl_record_new();
    record->request = (FlDigest){1, 2};
    fl_facts_add(record->facts, "seed", "7");
    fl_facts_add_digest(record->inputs, "walk_1.svg", (FlDigest){3, 4});
    fl_facts_add(record->found, "01", "/styles/01");
    record->done = 3;
    return record;
}

static void assert_same_facts(const FlFacts *a, const FlFacts *b)
{
    g_assert_null(fl_facts_difference(a, b));
    g_assert_cmpint(a->list->len, ==, 1);
}

static void a_record_comes_back_as_it_was_saved(void)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path = g_build_filename(folder, "state", NULL);
    g_autoptr(FlRecord) record = new_record();
    g_assert_true(fl_record_save(record, path, &error));
    g_autoptr(FlRecord) back = fl_record_load(path, &error);
    g_assert_no_error(error);
    g_assert_cmpint(back->done, ==, 3);
    g_assert_cmpint(back->request.a, ==, 1);
    g_assert_cmpint(back->request.b, ==, 2);
    assert_same_facts(record->facts, back->facts);
    assert_same_facts(record->inputs, back->inputs);
    assert_same_facts(record->found, back->found);
}

/* Every byte that is changed, and every length, is seen by the seal; what is behind the seal is
 * read without trust. */
static void a_damaged_record_is_refused(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path = g_build_filename(folder, "state", NULL), *data = NULL;
    g_autoptr(FlRecord) record = new_record();
    gsize bytes;
    g_assert_true(fl_record_save(record, path, NULL));
    g_assert_true(g_file_get_contents(path, &data, &bytes, NULL));
    for (gsize k = 0; k < bytes; k++) {
        g_autoptr(GError) error = NULL;
        data[k] ^= 1;
        g_assert_true(g_file_set_contents(path, data, (gssize)bytes, NULL));
        data[k] ^= 1;
        g_assert_null(fl_record_load(path, &error));
        g_assert_error(error, FL_ERROR, FL_ERROR_CHANGED);
        g_autoptr(GBytes) cut = g_bytes_new(data + 16, bytes - 16 > k ? k : bytes - 16);
        g_autoptr(FlRecord) short_one = fl_record_parse(cut);
        g_assert_true(!short_one || g_bytes_get_size(cut) == bytes - 16);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/record/a-record-comes-back-as-it-was-saved",
                    a_record_comes_back_as_it_was_saved);
    g_test_add_func("/record/a-damaged-record-is-refused", a_damaged_record_is_refused);
    return g_test_run();
}
