#include "base/first_error.h"

void fl_keep_first_error(GError **first, GError *mine)
{
    static GMutex mutex;
    g_mutex_lock(&mutex);
    if (!*first)
        *first = g_steal_pointer(&mine);
    g_mutex_unlock(&mutex);
    g_clear_error(&mine);
}

bool fl_tell_first_error(GError **error, GError *first)
{
    if (first)
        g_propagate_error(error, first);
    return first == NULL;
}
