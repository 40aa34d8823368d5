/* GLib is not built for ThreadSanitizer, which so does not see what its mutexes and what is made
 * once order. Preloaded, this tells it. */
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

gboolean(g_once_init_enter)(volatile void *location)
{
    static gboolean (*real)(volatile void *);
    if (!real)
        *(void **)&real = dlsym(RTLD_NEXT, "g_once_init_enter");
    const gboolean first = real(location);
    __tsan_acquire((void *)location);
    return first;
}

void(g_once_init_leave)(volatile void *location, gsize result)
{
    static void (*real)(volatile void *, gsize);
    if (!real)
        *(void **)&real = dlsym(RTLD_NEXT, "g_once_init_leave");
    __tsan_release((void *)location);
    real(location, result);
}
