/* Frame-sized buffers: an allocation that fails is an error, not an abort. Free them with free() or
 * g_autofree: g_free() is free() since GLib 2.46. */
#pragma once

#include "base/memory.h"
#include <fluidy/error.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>

/** Sets FL_ERROR_NO_MEMORY. Returns: NULL. */
static inline void *fl_alloc_error(size_t count, size_t element_bytes, const char *what,
                                   GError **error)
{
    g_set_error(error, FL_ERROR, FL_ERROR_NO_MEMORY,
                "not enough memory for %s (%zu elements of %zu bytes)", what, count, element_bytes);
    return NULL;
}

/**
 * count elements of element_bytes, aligned to 64 bytes, for what is written before it is read; to
 * be freed with free().
 *
 * Returns: NULL with FL_ERROR_NO_MEMORY set, which names `what`.
 */
static inline void *fl_alloc_unset(size_t count, size_t element_bytes, const char *what,
                                   GError **error)
{
    size_t bytes = 0;
    void *memory = NULL;
    if (!__builtin_mul_overflow(count, element_bytes, &bytes) && bytes <= SIZE_MAX - 64)
        memory = aligned_alloc(64, (bytes + 64) / 64 * 64);
    if (memory && fl_headroom_left())
        return memory;
    free(memory);
    return fl_alloc_error(count, element_bytes, what, error);
}

/** The same, zeroed. */
static inline void *fl_alloc(size_t count, size_t element_bytes, const char *what, GError **error)
{
    void *memory = fl_alloc_unset(count, element_bytes, what, error);
    return memory ? __builtin_memset(memory, 0, count * element_bytes) : NULL;
}

/**
 * The same, aligned to 16 bytes, for scratch as large as the largest frame: pages take memory when
 * they are first written to, and most regions need a part of them.
 */
static inline void *fl_alloc_scratch(size_t count, size_t element_bytes, const char *what,
                                     GError **error)
{
    void *memory = fl_headroom_left() ? calloc(MAX(count, 1), element_bytes) : NULL;
    if (!memory)
        fl_alloc_error(count, element_bytes, what, error);
    return memory;
}

#define FL_PAGE ((size_t)64 << 10) // a multiple of every machine's

/**
 * As fl_alloc_unset(), for a table of which only a part is used at a time: pages take memory when
 * they are first written to, until fl_release().
 */
static inline void *fl_alloc_lazy(size_t count, size_t element_bytes, const char *what,
                                  GError **error)
{
    size_t bytes = 0;
    void *memory = NULL;
    if (!__builtin_mul_overflow(count, element_bytes, &bytes) && bytes <= SIZE_MAX - FL_PAGE)
        memory = aligned_alloc(FL_PAGE, (bytes + FL_PAGE) / FL_PAGE * FL_PAGE);
    if (memory && fl_headroom_left())
        return memory;
    free(memory);
    return fl_alloc_error(count, element_bytes, what, error);
}

/** Returns the whole pages of a part of such a table to the system; the part becomes undefined. */
static inline void fl_release(void *part, size_t bytes)
{
#ifdef MADV_DONTNEED
    const uintptr_t from = ((uintptr_t)part + FL_PAGE - 1) / FL_PAGE * FL_PAGE;
    const uintptr_t to = ((uintptr_t)part + bytes) / FL_PAGE * FL_PAGE;
    if (to > from)
        (void)madvise((void *)from, to - from, MADV_DONTNEED);
#endif
}
