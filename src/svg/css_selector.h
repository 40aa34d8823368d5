/* Selectors [Selectors 4, without :has], and whether an element matches one. */
#pragma once

#include "svg/document.h"

/** One complex selector, such as "g.arm > path:not(.line)". */
typedef struct FlSelector {
    GArray *compound;
    unsigned specificity; // ids count 0x10000, classes and the like 0x100, names of elements 1
    char *key; // of a match a necessary condition: "#id", ".class", the name of an element, or "*"
} FlSelector;

/**
 * Reads a list of selectors separated by commas.
 *
 * Returns: an array of FlSelector that owns them; NULL if any part is unknown or wrong, as a
 * browser then ignores the whole rule.
 */
GPtrArray *fl_selectors_parse(const char *text);

/** The work of matching, over a whole document. */
typedef struct FlSelectorWork {
    const xmlNode *top;     // an element that has nothing around or beside it; or NULL
    const xmlNode *sibling; // the last element that was counted
    int index;              // its place among its siblings, from 1
    int steps;              // comparisons so far
} FlSelectorWork;

/** Limit of comparisons for a document, about ten seconds; after these no selector matches. */
#define FL_SELECTOR_STEPS 200000000

/** Returns: true if `node`, an element, matches. */
bool fl_selector_matches(const FlSelector *selector, const xmlNode *node, FlSelectorWork *work);
