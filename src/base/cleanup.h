/* Declares g_autoptr for the types of cairo and librsvg, since those libraries do not. */
#ifndef FLUIDY_BASE_CLEANUP_H
#define FLUIDY_BASE_CLEANUP_H

#include <cairo.h>
#include <librsvg/rsvg.h>

G_DEFINE_AUTOPTR_CLEANUP_FUNC(cairo_t, cairo_destroy)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(RsvgHandle, g_object_unref)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(cairo_surface_t, cairo_surface_destroy)

#endif
