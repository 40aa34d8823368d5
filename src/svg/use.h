/* <use>, which shows a copy of another element. */
#pragma once

#include "svg/css_value.h"
#include "svg/document.h"

/** The attribute with the id of the element that a <use> copied: the copy itself has no id. */
#define FL_COPIED_ID "data-fl-id"

/** Returns: false if a side of 0 hides what a <use> shows. */
bool fl_use_is_drawn(const xmlNode *use);

/**
 * Gives each <use> a copy of what it shows as its last child, so that the copy inherits from the
 * <use>, variables included. Elements of a copy have in _private the element that was written, for
 * which selectors are matched. A <use> that shows itself gets no copy, and none in a clip path
 * does, which may have no groups: librsvg resolves those.
 *
 * Returns: each <use> with its copy; NULL with FL_ERROR_LIMIT if the copies are too many or too
 * large.
 */
GHashTable *fl_uses_copy(xmlDoc *doc, const char *path, GError **error);

/** Gives a copy the size that its <use> says; a <symbol> becomes a nested <svg>. */
void fl_use_give_size(xmlNode *use, xmlNode *copy);

/** Moves what a <use> shows by its x and y, which come after its transform. */
void fl_use_place(xmlNode *use, const FlCssUnits *units);

/** Makes each <use> with a copy a group that shows only the copy. */
void fl_uses_make_groups(GHashTable *copies);
