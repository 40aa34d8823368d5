/* Loops over the items of arrays. */
#pragma once

#include <glib.h>

/** Visits the items of a GArray of Type; the array keeps its length meanwhile. */
#define FL_EACH(Type, item, array)                                                                 \
    for (Type *item = (Type *)(void *)(array)->data;                                               \
         item - (Type *)(void *)(array)->data < (gssize)(array)->len; item++)
