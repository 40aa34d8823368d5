/* Records of renders come back as they were saved, and damaged ones do not. */
#include "keep/record.h"
#include <fluidy/error.h>

#include "scratch.h"
#include <string.h>

static FlRecord *record_of(const int *bytes, int n)
{
    FlRecord *record = fl_record_new();
    record->request = (FlDigest){1, 2};
    fl_facts_add(record->facts, "seed", "7");
    fl_facts_add_digest(record->inputs, "walk_1.svg", (FlDigest){3, 4});
    fl_facts_add(record->found, "01", "/styles/01");
    record->done = 3;
    for (int i = 0; i < n; i++) {
        uint8_t *data = g_malloc(bytes[i]); // NULL for none
        if (data)
            memset(data, i + 1, bytes[i]);
        g_ptr_array_add(record->states, g_bytes_new_take(data, bytes[i]));
    }
    return record;
}

static void assert_same_facts(const FlFacts *a, const FlFacts *b)
{
    g_assert_null(fl_facts_difference(a, b));
    g_assert_cmpint(a->list->len, ==, 1);
}

static void check_saved(const int *bytes, int n)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path = g_build_filename(folder, "state", NULL);
    g_autoptr(FlRecord) record = record_of(bytes, n);
    g_assert_true(fl_record_save(record, path, &error));
    g_autoptr(FlRecord) back = fl_record_load(path, &error);
    g_assert_no_error(error);
    g_assert_cmpint(back->done, ==, 3);
    g_assert_cmpint(back->request.a, ==, 1);
    g_assert_cmpint(back->request.b, ==, 2);
    assert_same_facts(record->facts, back->facts);
    assert_same_facts(record->inputs, back->inputs);
    assert_same_facts(record->found, back->found);
    g_assert_cmpint(back->states->len, ==, n);
    for (int i = 0; i < n; i++)
        g_assert_true(g_bytes_equal(back->states->pdata[i], record->states->pdata[i]));
}

static void states_of_any_size_come_back_as_they_were_saved(void)
{
    static int many[300];
    for (int i = 0; i < 300; i++)
        many[i] = i % 3;
    check_saved(NULL, 0);
    check_saved((const int[]){0}, 1);
    check_saved((const int[]){5, 0, 90}, 3);
    check_saved((const int[]){40000, 0, 30000}, 3);
    check_saved(many, 300);
    for (int size = 100; size < 260; size += 7)
        check_saved(&size, 1);
}

/* Every byte that is changed, and every length, is seen by the seal; what is behind the seal is
 * read without trust. */
static void a_damaged_record_is_refused(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path = g_build_filename(folder, "state", NULL), *data = NULL;
    g_autoptr(FlRecord) record = record_of((const int[]){5, 0, 9}, 3);
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
    g_test_add_func("/record/states-of-any-size-come-back-as-they-were-saved",
                    states_of_any_size_come_back_as_they_were_saved);
    g_test_add_func("/record/a-damaged-record-is-refused", a_damaged_record_is_refused);
    return g_test_run();
}
