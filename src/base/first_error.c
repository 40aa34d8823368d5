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
