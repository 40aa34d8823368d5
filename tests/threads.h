/* The number of threads that a test's teams have, in builds with and without OpenMP. */
#ifndef FLUIDY_TESTS_THREADS_H
#define FLUIDY_TESTS_THREADS_H

#ifdef _OPENMP
#include <omp.h>
#else
static inline void omp_set_num_threads(int n)
{
    (void)n;
}

static inline int omp_get_max_threads(void)
{
    return 1;
}
#endif

#endif
