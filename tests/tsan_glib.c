/* GLib is not built for ThreadSanitizer, which so does not see what its mutexes order. Preloaded, this
 * tells it. */
#include <dlfcn.h>
#include <glib.h>

void __tsan_acquire(void *address);
void __tsan_release(void *address);

void g_mutex_lock(GMutex *mutex)
{
    static void (*real)(GMutex *);
    if (!real)
        *(void **)&real = dlsym(RTLD_NEXT, "g_mutex_lock");
    real(mutex);
    __tsan_acquire(mutex);
}

void g_mutex_unlock(GMutex *mutex)
{
    static void (*real)(GMutex *);
    if (!real)
        *(void **)&real = dlsym(RTLD_NEXT, "g_mutex_unlock");
    __tsan_release(mutex);
    real(mutex);
}
