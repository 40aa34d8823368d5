#include "wait.h"

#include <glib.h>
#include <unistd.h>

void fl_wait_asleep(char **argv)
{
#ifdef _OPENMP
    static const char *const words[] = {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT", "KMP_BLOCKTIME"};
    for (size_t i = 0; i < G_N_ELEMENTS(words); i++)
        if (g_getenv(words[i]))
            return; // set by the user, or by the first start
    g_autofree char *program = g_file_read_link("/proc/self/exe", NULL);
    if (program && g_setenv("OMP_WAIT_POLICY", "passive", TRUE))
        execv(program, argv);
#endif
}
