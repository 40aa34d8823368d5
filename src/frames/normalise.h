/* Rewrites a document so that each of its shapes can be rendered alone, and it still looks alike.
 */
#ifndef FLUIDY_FRAMES_NORMALISE_H
#define FLUIDY_FRAMES_NORMALISE_H

#include "frames/document.h"

/** The attribute that keeps the id of what a <use> copied: the copy itself has none. */
#define FL_COPIED_ID "data-fl-id"

/**
 * Makes each <switch> a <g> with its first eligible child, and each <use> a <g> with a deep copy of
 * what it shows (a <symbol> becomes a nested <svg>). A circle of <use> draws nothing, with a
 * warning.
 *
 * Returns: false with FL_ERROR_LIMIT if the copies are too many or too deep.
 */
bool fl_document_normalise(xmlDoc *doc, const char *path, int number, FlWarnings *warnings,
                           GError **error);

/** Whether children of node are drawn only when something refers to them: <defs>, <mask>, … */
bool fl_is_undrawn(const xmlNode *node);

#endif
