/* Arrays whose items are freed with them, and loops over items. */
#pragma once

#include <glib.h>

/** An array of Type; clear() frees what an item holds, as it leaves the array. To be unref'd. */
#define fl_array_of(Type, clear) fl_array_new(sizeof(Type), (GDestroyNotify)(clear))

static inline GArray *fl_array_new(guint bytes, GDestroyNotify clear)
{
    GArray *array = g_array_new(FALSE, FALSE, bytes);
    g_array_set_clear_func(array, clear);
    return array;
}

/** Visits the items of a GArray of Type; the array keeps its length meanwhile. */
#define FL_EACH(Type, item, array)                                                                 \
    for (Type *item = (Type *)(void *)(array)->data;                                               \
         item - (Type *)(void *)(array)->data < (gssize)(array)->len; item++)
