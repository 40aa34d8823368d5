#include "apart.h"

#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <glib.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#define MOST_SECONDS 30        // of processor time, for one input
#define MOST_MIB 2000          // resident
#define LOOK_MS 50             // between looks at a child's time and memory
#define LEAKS 64               // one in so many replayed inputs is searched for leaks
#define RUNS 512               // of one child
#define LARGEST (64 << 20)     // bytes of an input
#define ALARM SIGUSR1          // to a child that takes too much
enum { OURS = 97, BELOW = 98 }; // how a child ends

/* ---- what clang gives us, absent elsewhere --------------------------------------------------- */

extern uint8_t __start___sancov_cntrs[] __attribute__((weak));
extern uint8_t __stop___sancov_cntrs[] __attribute__((weak));
extern const uintptr_t __start___sancov_pcs[] __attribute__((weak));
extern const uintptr_t __stop___sancov_pcs[] __attribute__((weak));
int __lsan_do_recoverable_leak_check(void) __attribute__((weak));
void __sanitizer_set_death_callback(void (*callback)(void)) __attribute__((weak));
void __sanitizer_print_stack_trace(void) __attribute__((weak));

static size_t n_counters(void)
{
    return (size_t)(__stop___sancov_cntrs - __start___sancov_cntrs);
}

/* ---- whose fault ---------------------------------------------------------------------------- */

/** Whether an address in this program is of our functions: the sanitizers' have no counters. */
static bool is_counted(uintptr_t address)
{
    uintptr_t first = UINTPTR_MAX, last = 0;
    for (const uintptr_t *pc = __start___sancov_pcs; pc < __stop___sancov_pcs; pc += 2) {
        first = MIN(first, pc[0]);
        last = MAX(last, pc[0]);
    }
    return first == UINTPTR_MAX || (address >= first && address <= last);
}

/** Whether the innermost function that can be at fault is one of a library below us. */
static bool is_below(void)
{
    static const char *const innocent[] = {"libc.so", "libglib-2", "libasan",  "libubsan", "ld-linux",
                                           "libm.so", "libgcc_s",  "linux-vdso", NULL};
    void *frame[64];
    Dl_info self, info;
    const int n = backtrace(frame, G_N_ELEMENTS(frame));
    dladdr((void *)(uintptr_t)fuzz_apart, &self);
    bool interrupted = false; // behind the frame from which the C library calls the handler
    for (int i = 0; i < n; i++) {
        if (!dladdr(frame[i], &info) || !info.dli_fname)
            continue;
        bool skipped = !interrupted;
        interrupted = interrupted || strstr(info.dli_fname, "libc.so");
        for (int k = 0; innocent[k] && !skipped; k++)
            skipped = strstr(info.dli_fname, innocent[k]) != NULL;
        if (info.dli_fbase == self.dli_fbase && !is_counted((uintptr_t)frame[i]))
            skipped = true;
        if (!skipped)
            return info.dli_fbase != self.dli_fbase;
    }
    return false;
}

/* ---- the child ------------------------------------------------------------------------------ */

/** What both processes see. */
typedef struct Shared {
    size_t size; // of the input
    bool leaks;  // are to be looked for
    uint8_t input[LARGEST];
    uint8_t counters[];
} Shared;

static Shared *shared;

/** Ends the child, without a word if a library is at fault. */
static void on_signal(int number)
{
    if (is_below())
        _exit(BELOW);
    fprintf(stderr, "in our own functions: %s\n", g_strsignal(number));
    if (number == ALARM)
        fprintf(stderr, "more than %d s or %d MiB\n", MOST_SECONDS, MOST_MIB);
    if (__sanitizer_print_stack_trace)
        __sanitizer_print_stack_trace();
    _exit(OURS);
}

static void catch_signals(void)
{
    static const int signals[] = {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, ALARM};
    static uint8_t room[1 << 18];
    const stack_t stack = {.ss_sp = room, .ss_size = sizeof room};
    void *frame[4];
    backtrace(frame, G_N_ELEMENTS(frame)); // loads what it needs now rather than in a handler
    sigaltstack(&stack, NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(signals); i++) {
        const struct sigaction action = {.sa_handler = on_signal,
                                         .sa_flags = SA_ONSTACK | SA_NODEFER};
        sigaction(signals[i], &action, NULL);
    }
    if (__sanitizer_set_death_callback)
        __sanitizer_set_death_callback(NULL); // libFuzzer's would keep the first input
}

static void settle(void)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int score = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
    if (score >= 0 && write(score, "1000", 4) == 4)
        close(score);
#ifdef _OPENMP
    omp_set_num_threads(1);
#endif
    catch_signals();
}

/** Runs one input after the other, until the parent closes its end. */
G_GNUC_NORETURN static void be_child(void (*run)(const uint8_t *data, size_t size), int from,
                                     int to)
{
    char sign;
    settle();
    while (read(from, &sign, 1) == 1) {
        g_autofree uint8_t *data = g_malloc(shared->size + 1); // its end is known to ASan
        memcpy(data, shared->input, shared->size);
        if (n_counters() > 0)
            memset(__start___sancov_cntrs, 0, n_counters());
        run(data, shared->size);
        if (n_counters() > 0)
            memcpy(shared->counters, __start___sancov_cntrs, n_counters());
        if (shared->leaks && __lsan_do_recoverable_leak_check && __lsan_do_recoverable_leak_check())
            _exit(OURS);
        if (write(to, &sign, 1) != 1)
            break;
    }
    _exit(0);
}

/* ---- the parent ----------------------------------------------------------------------------- */

/** A child that waits for inputs. */
typedef struct Child {
    pid_t id; // 0: none
    int to, from;
    int n_runs;
} Child;

static Child start(void (*run)(const uint8_t *data, size_t size))
{
    int down[2], up[2];
    g_assert_true(pipe(down) == 0 && pipe(up) == 0);
    fflush(NULL);
    const pid_t id = fork();
    g_assert_cmpint(id, >=, 0);
    if (id == 0) {
        close(down[1]);
        close(up[0]);
        be_child(run, down[0], up[1]);
    }
    close(down[0]);
    close(up[1]);
    return (Child){id, down[1], up[0], 0};
}

/** Lets it end. Returns: how it did. */
static int finish(Child *one)
{
    int status = 0;
    close(one->to);
    close(one->from);
    while (waitpid(one->id, &status, 0) < 0 && errno == EINTR)
        ;
    one->id = 0;
    return status;
}

static double seconds_of(pid_t process)
{
    clockid_t clock;
    struct timespec time = {0};
    if (clock_getcpuclockid(process, &clock) == 0)
        clock_gettime(clock, &time);
    return (double)time.tv_sec + (double)time.tv_nsec * 1e-9;
}

static double mebibytes_of(pid_t process)
{
    char path[40];
    g_autofree char *text = NULL;
    double pages = 0;
    g_snprintf(path, sizeof path, "/proc/%d/statm", (int)process);
    if (g_file_get_contents(path, &text, NULL, NULL))
        sscanf(text, "%*f %lf", &pages);
    return pages * (double)sysconf(_SC_PAGESIZE) / (1 << 20);
}

/** Has the child run the input. Returns: whether it ended well. */
static bool run_one(const Child *one)
{
    char sign = '.';
    bool told = false;
    const double begin = seconds_of(one->id);
    struct pollfd answer = {.fd = one->from, .events = POLLIN};
    if (write(one->to, &sign, 1) != 1)
        return false;
    while (poll(&answer, 1, LOOK_MS) <= 0) // also when libFuzzer's clock ticks
        if (!told && (seconds_of(one->id) - begin > MOST_SECONDS ||
                      mebibytes_of(one->id) > MOST_MIB))
            told = kill(one->id, ALARM) == 0;
    return read(one->from, &sign, 1) == 1;
}

static Child child;
static int n_runs, n_below;

static void end(void)
{
    if (child.id)
        finish(&child);
    fprintf(stderr, "%d of %d inputs ended a library below us\n", n_below, n_runs);
}

static void init(void)
{
    shared = mmap(NULL, sizeof *shared + n_counters(), PROT_READ | PROT_WRITE,
                  MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    g_assert_true(shared != MAP_FAILED);
    signal(SIGPIPE, SIG_IGN);
    atexit(end);
}

void fuzz_apart(void (*run)(const uint8_t *data, size_t size), const uint8_t *data, size_t size)
{
    if (!shared)
        init();
    if (!child.id)
        child = start(run);
    g_assert_cmpint(size, <=, LARGEST);
    memcpy(shared->input, data, size);
    shared->size = size;
    // libFuzzer's stacks end at libraries without frame pointers, whose leaks are then not known
    shared->leaks = ++n_runs % LEAKS == 0 && n_counters() == 0;
    if (run_one(&child)) {
        if (n_counters() > 0)
            memcpy(__start___sancov_cntrs, shared->counters, n_counters());
        if (++child.n_runs == RUNS)
            finish(&child);
        return;
    }
    const int status = finish(&child);
    if (WIFEXITED(status) && WEXITSTATUS(status) == BELOW) {
        n_below++;
        return;
    }
    fprintf(stderr, "a find: the child ended with %s %d\n",
            WIFEXITED(status) ? "exit status" : "signal",
            WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status));
    abort();
}
