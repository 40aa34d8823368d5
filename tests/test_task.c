#include "base/schedule.h"
#include <fluidy/error.h>

static bool count(void *data, GError **error)
{
    (void)error;
    ++*(int *)data;
    return true;
}

static bool fail(void *data, GError **error)
{
    g_set_error(error, FL_ERROR, FL_ERROR_OUTPUT, "%s", (const char *)data);
    return false;
}

static void work_is_done_when_it_has_been_waited_for(void)
{
    g_autoptr(GError) error = NULL;
    FlTask task = {0};
    int n = 0;
    g_assert_true(fl_task_wait(&task, &error)); // of nothing
    for (int beside = 0; beside < 2; beside++) {
        fl_task_start(&task, count, &n, beside);
        g_assert_true(fl_task_wait(&task, &error));
        g_assert_cmpint(n, ==, beside + 1);
    }
}

static void the_error_of_work_is_told_once(void)
{
    for (int beside = 0; beside < 2; beside++) {
        g_autoptr(GError) error = NULL;
        char disk[] = "the disk is full";
        FlTask task = {0};
        fl_task_start(&task, fail, disk, beside);
        g_assert_false(fl_task_wait(&task, &error));
        g_assert_error(error, FL_ERROR, FL_ERROR_OUTPUT);
        g_assert_cmpstr(error->message, ==, disk);
        g_assert_true(fl_task_wait(&task, NULL));
        fl_task_start(&task, fail, disk, beside);
        fl_task_clear(&task);
        g_assert_true(fl_task_wait(&task, NULL));
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/task/work-is-done-when-it-has-been-waited-for",
                    work_is_done_when_it_has_been_waited_for);
    g_test_add_func("/task/the-error-of-work-is-told-once", the_error_of_work_is_told_once);
    return g_test_run();
}
