#include "base/parallel_error.h"

void fl_parallel_error_keep(GError **first, GError *failure)
{
    static GMutex mutex;
    g_mutex_lock(&mutex);
    if (!*first)
        *first = g_steal_pointer(&failure);
    g_mutex_unlock(&mutex);
    g_clear_error(&failure);
}

bool fl_parallel_error_propagate(GError **error, GError *first)
{
    if (first)
        g_propagate_error(error, first);
    return first == NULL;
}
