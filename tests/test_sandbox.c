/* What a child process can no longer do in the sandbox. */
#include "base/sandbox.h"

#include "drawing/confined.h"
#include "scratch.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MIB = 64, SKIPPED = 77 };

static char *inside, *outside; // folders with a file each

/** The exit status of a child that tries something in a sandbox which gives up `needs`. */
static int try_in_sandbox(unsigned needs, bool (*refused)(void))
{
    const pid_t child = fork();
    if (child == 0) {
        const char *const paths[] = {inside, NULL};
        const unsigned given_up = fl_sandbox_enter(paths, MIB);
        _exit((given_up & needs) != needs ? SKIPPED : !refused());
    }
    int status = 0;
    g_assert_cmpint(waitpid(child, &status, 0), ==, child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

static void assert_refused(unsigned needs, bool (*refused)(void))
{
    const int status = fl_confined_may_fork() ? try_in_sandbox(needs, refused) : SKIPPED;
    if (status == SKIPPED)
        g_test_skip("this kernel or build has no such means");
    else
        g_assert_cmpint(status, ==, 0);
}

static bool can_open(const char *folder, const char *name, int flags)
{
    g_autofree char *path = g_build_filename(folder, name, NULL);
    const int file = open(path, flags, 0600);
    if (file >= 0)
        close(file);
    return file >= 0;
}

static bool reads_own_folder_only(void)
{
    return can_open(inside, "file", O_RDONLY) && !can_open(outside, "file", O_RDONLY) &&
           !can_open("/etc", "passwd", O_RDONLY) && can_open("/usr", "lib", O_RDONLY);
}

static bool writes_nothing(void)
{
    g_autofree char *path = g_build_filename(inside, "file", NULL);
    return !can_open(inside, "file", O_WRONLY) && !can_open(inside, "new", O_WRONLY | O_CREAT) &&
           g_unlink(path) != 0;
}

static bool calls_nobody(void)
{
    const bool connects =
        socket(AF_INET, SOCK_STREAM, 0) >= 0 || socket(AF_UNIX, SOCK_DGRAM, 0) >= 0;
    execl("/bin/false", "false", NULL); // its status would fail the test
    const bool refused = errno == EACCES;
    return !connects && refused && kill(getppid(), 0) != 0;
}

static bool takes_no_more_memory(void)
{
    const int private = MAP_PRIVATE | MAP_ANONYMOUS;
    return mmap(NULL, MIB / 2 << 20, PROT_WRITE, private, -1, 0) != MAP_FAILED &&
           mmap(NULL, MIB << 20, PROT_WRITE, private, -1, 0) == MAP_FAILED;
}

static void the_sandbox_reads_its_folders_only(void)
{
    assert_refused(FL_SANDBOX_FILES, reads_own_folder_only);
}

static void the_sandbox_writes_no_file(void)
{
    assert_refused(FL_SANDBOX_FILES, writes_nothing);
}

static void the_sandbox_reaches_no_network_program_or_process(void)
{
    assert_refused(FL_SANDBOX_CALLS, calls_nobody);
}

static void the_sandbox_has_a_limit_of_memory(void)
{
    assert_refused(FL_SANDBOX_MEMORY, takes_no_more_memory);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_autoptr(Scratch) in = scratch_make(), out = scratch_make();
    inside = in, outside = out;
    g_free(scratch_write(in, "file", "x"));
    g_free(scratch_write(out, "file", "x"));
    g_test_add_func("/sandbox/reads-its-folders-only", the_sandbox_reads_its_folders_only);
    g_test_add_func("/sandbox/writes-no-file", the_sandbox_writes_no_file);
    g_test_add_func("/sandbox/reaches-no-network-program-or-process",
                    the_sandbox_reaches_no_network_program_or_process);
    g_test_add_func("/sandbox/has-a-limit-of-memory", the_sandbox_has_a_limit_of_memory);
    return g_test_run();
}
