#include "base/schedule.h"

/** Which items were done. */
typedef struct Done {
    int n;
    bool item[8];
} Done;

static bool do_item(void *data, int index, int thread, GError **error)
{
    Done *done = data;
    g_assert_cmpint(thread, >=, 0);
    g_assert_cmpint(thread, <, fl_schedule_threads());
    g_assert_false(done->item[index]);
    done->item[index] = true;
    __atomic_fetch_add(&done->n, 1, __ATOMIC_RELAXED);
    return true;
}

/** How many of n items two threads do together; the costs are in falling order. */
static int together_of(const double *cost, int n, int n_alone)
{
    FlWorkItem items[8];
    Done done = {0};
    int n_together = 0;
    const int before = fl_schedule_set_threads(2);
    for (int k = 0; k < n; k++)
        items[k] = (FlWorkItem){k, cost[k], .alone = k >= n - n_alone};
    g_assert_true(fl_schedule_run(items, n, do_item, &done, NULL));
    (void)fl_schedule_set_threads(before);
    g_assert_cmpint(done.n, ==, n);
    for (int k = 0; k < n; k++) {
        n_together += items[k].together;
        g_assert_true(k == 0 || items[k].together <= items[k - 1].together);
        g_assert_true(items[k].together || !items[k].alone);
    }
    return n_together;
}

static void all_threads_do_together_what_one_would_be_left_with(void)
{
    const double alike[] = {10, 10, 10, 10, 10, 10, 10, 10}, one[] = {100};
    const double large[] = {100, 10, 10, 10, 10}, two[] = {540, 130, 30, 10};
    const int before = fl_schedule_set_threads(2), threads = fl_schedule_threads();
    (void)fl_schedule_set_threads(before);
    if (threads < 2) {
        g_test_skip("a build without threads");
        return;
    }
    g_assert_cmpint(together_of(alike, 8, 0), ==, 0);
    g_assert_cmpint(together_of(one, 1, 0), ==, 1);
    g_assert_cmpint(together_of(large, 5, 0), ==, 1);
    g_assert_cmpint(together_of(two, 4, 0), >=, 2); // the second would run while the other waits
    g_assert_cmpint(together_of(alike, 8, 3), ==, 3);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/schedule/all-threads-do-together-what-one-would-be-left-with",
                    all_threads_do_together_what_one_would_be_left_with);
    return g_test_run();
}
