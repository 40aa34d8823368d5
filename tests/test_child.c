/* Other programs, fed and read: how they are waited for. */
#include "io/child_process.h"
#include <fluidy/limits.h>
#include <glib.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static FlChild *start(const char *script, FlChildStream stream, const FlPatience *patience)
{
    g_autoptr(GError) error = NULL;
    const char *const arguments[] = {"sh", "-c", script, NULL};
    FlChild *child = fl_child_start(arguments, stream, -1, patience, &error);
    g_assert_no_error(error);
    return child;
}

static void what_a_child_writes_is_read_to_its_end(void)
{
    g_autoptr(FlChild) child = start("echo one; sleep 0.1; echo two", FL_CHILD_OUTPUT, NULL);
    g_autoptr(GError) error = NULL;
    char text[32] = "";
    size_t got = 0;
    g_assert_true(fl_child_read(child, text, sizeof text, &got, &error));
    g_assert_cmpstr(text, ==, "one\ntwo\n");
    g_assert_cmpuint(got, ==, 8);
    g_assert_true(fl_child_finish(child, &error));
}

static void a_dying_child_is_quoted_in_one_line(void)
{
    g_autoptr(FlChild) child =
        start("echo first >&2; echo ' the last ' >&2; exit 3", FL_CHILD_OUTPUT, NULL);
    g_autoptr(GError) error = NULL;
    g_assert_false(fl_child_finish(child, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_INPUT);
    g_assert_cmpstr(error->message, ==, "sh stopped:  the last");
}

/* Every way to wait for a child that does nothing. */
static void assert_ends(const FlPatience *patience, int fed_code, int read_code)
{
    static const char much[1 << 20];
    char byte;
    size_t got;
    for (int way = 0; way < 4; way++) {
        const bool fed = way % 2;
        g_autoptr(GError) error = NULL;
        g_autoptr(FlChild) child =
            start("exec sleep 60", fed ? FL_CHILD_INPUT : FL_CHILD_OUTPUT, patience);
        const gint64 before = g_get_monotonic_time();
        g_assert_false(way >= 2 ? fl_child_finish(child, &error)
                       : fed    ? fl_child_write(child, much, sizeof much, &error)
                                : fl_child_read(child, &byte, 1, &got, &error));
        const int code = fed ? fed_code : read_code;
        g_assert_error(error, FL_ERROR, code);
        g_assert_null(strchr(error->message, '\n'));
        g_assert_cmpint(g_get_monotonic_time() - before, <, 20 * G_USEC_PER_SEC);
    }
}

static void a_child_that_hangs_is_ended(void)
{
    assert_ends(&(FlPatience){.limit_s = 0.2}, FL_ERROR_OUTPUT, FL_ERROR_INPUT);
}

static void as_long_as_the_limit_says(void)
{
    g_assert_true(fl_limit_set("seconds=1", NULL));
    assert_ends(NULL, FL_ERROR_OUTPUT, FL_ERROR_INPUT);
    g_assert_true(fl_limit_set("seconds=60", NULL));
}

static bool soon(void *data)
{
    return ++*(int *)data % 3 == 0;
}

static void a_wait_can_be_interrupted(void)
{
    int asked = 0;
    assert_ends(&(FlPatience){.stopped = soon, .data = &asked}, FL_ERROR_INTERRUPTED,
                FL_ERROR_INTERRUPTED);
    g_assert_cmpint(asked, ==, 12);
}

static void a_child_that_computes_is_waited_for(void)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(FlChild) child = start("n=0; while [ $n -lt 700000 ]; do n=$((n + 1)); done",
                                     FL_CHILD_INPUT, &(FlPatience){.limit_s = 0.7});
    fl_child_finish(child, &error);
    g_assert_no_error(error);
}

static void a_child_opens_the_file_that_it_is_given(void)
{
    g_autofree char *name = NULL;
    const int fd = g_file_open_tmp("fluidy-test-XXXXXX", &name, NULL);
    g_assert_cmpint(unlink(name), ==, 0);
    const char *const arguments[] = {"sh", "-c", "echo found >" FL_CHILD_FILE, NULL};
    g_autoptr(GError) error = NULL;
    g_autoptr(FlChild) child = fl_child_start(arguments, FL_CHILD_INPUT, fd, NULL, &error);
    g_assert_no_error(error);
    g_assert_true(fl_child_finish(child, &error));
    struct stat status;
    g_assert_cmpint(fstat(fd, &status), ==, 0);
    g_assert_cmpint(status.st_size, ==, 6);
    close(fd);
}

/* A program that reads a stranger's file, as a child of a process that ends. */
static void a_confined_child_ends_with_its_parent(void)
{
    const char *const arguments[] = {"sh", "-c", "exec sleep 5", NULL};
    g_assert_cmpint(prctl(PR_SET_CHILD_SUBREAPER, 1), ==, 0);
    const pid_t parent = fork();
    if (parent == 0) {
        FlChild *child = fl_child_start_reader(arguments, "/dev/null", NULL);
        _exit(child ? 0 : 1);
    }
    int status = 0;
    g_assert_cmpint(waitpid(parent, &status, 0), ==, parent);
    g_assert_cmpint(status, ==, 0);
    g_assert_cmpint(waitpid(-1, &status, 0), >, 0);
    g_assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/child/" #name, name)
    TEST(what_a_child_writes_is_read_to_its_end);
    TEST(a_dying_child_is_quoted_in_one_line);
    TEST(a_child_that_hangs_is_ended);
    TEST(as_long_as_the_limit_says);
    TEST(a_wait_can_be_interrupted);
    TEST(a_child_that_computes_is_waited_for);
    TEST(a_child_opens_the_file_that_it_is_given);
    TEST(a_confined_child_ends_with_its_parent);
    return g_test_run();
}
