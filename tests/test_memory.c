#include "base/memory.h"

#include <glib.h>
#include <glib/gstdio.h>
#include <string.h>

/* A made-up root: files and what is in them, NULL at the end. */
static int64_t memory_of(const char *const *files)
{
    g_autofree char *root = g_dir_make_tmp("fluidy-memory-XXXXXX", NULL);
    g_autoptr(GPtrArray) made = g_ptr_array_new_with_free_func(g_free);
    for (; *files; files += 2) {
        char *path = g_build_filename(root, files[0], NULL);
        for (char *end = path + strlen(root); (end = strchr(end + 1, '/'));) {
            g_ptr_array_add(made, g_strndup(path, (gsize)(end - path)));
            g_mkdir(g_ptr_array_index(made, made->len - 1), 0777);
        }
        g_assert_true(g_file_set_contents(path, files[1], -1, NULL));
        g_ptr_array_add(made, path);
    }
    const int64_t mib = fl_memory_mib(root);
    for (guint k = made->len; k > 0; k--)
        g_remove(g_ptr_array_index(made, k - 1));
    g_assert_cmpint(g_rmdir(root), ==, 0);
    return mib;
}

static int64_t machine(void)
{
    return memory_of((const char *const[]){NULL});
}

#define MEMORY_OF(...) memory_of((const char *const[]){__VA_ARGS__, NULL})
#define GROUP "proc/self/cgroup"
#define V2 "sys/fs/cgroup/"
#define V1 "sys/fs/cgroup/memory/"

static void the_least_limit_on_the_path_of_a_group_counts(void)
{
    g_assert_cmpint(MEMORY_OF(GROUP, "0::/a/b/c\n", V2 "a/b/c/memory.max", "max\n",
                              V2 "a/b/memory.max", "67108864\n", V2 "a/memory.max", "134217728\n"),
                    ==, 64);
    g_assert_cmpint(MEMORY_OF(GROUP, "0::/\n", V2 "memory.max", "33554432\n"), ==, 32);
    g_assert_cmpint(MEMORY_OF(GROUP, "0::/a\n", V2 "b/memory.max", "33554432\n"), ==, machine());
}

static void groups_of_version_1_count_too(void)
{
    g_assert_cmpint(MEMORY_OF(GROUP, "5:cpu,memory:/a\n3:pids:/b\n0::/\n", //
                              V1 "a/memory.limit_in_bytes", "67108864\n",  //
                              V1 "b/memory.limit_in_bytes", "1048576\n", V1 "memory.limit_in_bytes",
                              "9223372036854771712\n"),
                    ==, 64);
    // a container that is told the path outside
    g_assert_cmpint(
        MEMORY_OF(GROUP, "4:memory:/docker/12\n", V1 "memory.limit_in_bytes", "67108864\n"), ==,
        64);
}

static void what_is_no_number_is_no_limit(void)
{
    static const char *const words[] = {
        "max\n", "", "\n", "12x\n", "-1\n", "9223372036854771712\n", "99999999999999999999999\n"};
    g_assert_cmpint(machine(), >, 100);
    for (size_t i = 0; i < G_N_ELEMENTS(words); i++)
        g_assert_cmpint(MEMORY_OF(GROUP, "0::/a\n", V2 "a/memory.max", words[i]), ==, machine());
    for (size_t i = 0; i < G_N_ELEMENTS(words); i++)
        g_assert_cmpint(MEMORY_OF(GROUP, words[i], V2 "memory.max", "1048576\n"), ==, machine());
    g_assert_cmpint(MEMORY_OF(GROUP, ":::::\n::\n0:\n/\n\n", V2 "a/memory.max", "1048576\n"), ==,
                    machine());
}

static void there_always_is_a_mebibyte(void)
{
    g_assert_cmpint(MEMORY_OF(GROUP, "0::/\n", V2 "memory.max", "0\n"), ==, 1);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/memory/the-least-limit-on-the-path-of-a-group-counts",
                    the_least_limit_on_the_path_of_a_group_counts);
    g_test_add_func("/memory/groups-of-version-1-count-too", groups_of_version_1_count_too);
    g_test_add_func("/memory/what-is-no-number-is-no-limit", what_is_no_number_is_no_limit);
    g_test_add_func("/memory/there-always-is-a-mebibyte", there_always_is_a_mebibyte);
    return g_test_run();
}
