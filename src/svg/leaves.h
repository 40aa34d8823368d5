/* The leaves of a normalised document: what is drawn, one shape at a time, from the bottom up. */
#pragma once

#include "svg/document.h"

/**
 * One thing to draw: a shape, a text, an image; or a group that is drawn as one.
 *
 * Lists are joined with '\n', outermost first, and "" if empty. All strings are set; they belong to
 * FlLeaves.text.
 */
typedef struct FlLeaf {
    char *id;      // in the normalised document, unique
    char *layer;   // id of the outermost group around with a mask, else id
    int mask;      // index of the leaf's mask in FlLeaves.mask; -1: no mask, or the leaf is `layer`
                   // itself
    char *name;    // the authored id, or ""
    char *labels;  // of it and its groups: layer labels, meaningful ids
    char *layers;  // the layers among them; without layers, the outermost group
    char *ids;     // every authored id, its own last
    char *groups;  // ids, in the document, of the groups around it and of itself if it is one
    char *classes; // every class word
    char *tree;    // child indices from the root, "0/3/1"
    int unit;      // index of the group that may be drawn as one, with this leaf; -1: no group
    bool text;     // has text, whose shape depends on the scale
    bool all;      // the whole document, drawn as one
    bool whole; // has markers, text or images, or is in `whole`: fill and stroke are not separated
} FlLeaf;

/**
 * A group with opacity, a mask, a filter, a blend mode or isolation: more than one shape in it
 * cannot be drawn one by one where they overlap.
 */
typedef struct FlGroupUnit {
    FlLeaf leaf;
    int first, n;     // its leaves
    bool inseparable; // the group or its content has a filter or blend mode: drawn as one even
                      // without overlap
    bool isolated;    // its content blends within the group alone
} FlGroupUnit;

/** A group with a mask, of two or more leaves, which are drawn without it and masked then. */
typedef struct FlGroupMask {
    char *group; // its id
    int around;  // index of the next mask outwards, -1 at the outermost
    int depth;   // number of masks outwards
} FlGroupMask;

typedef struct FlLeaves {
    GArray *leaf;       // FlLeaf
    GArray *unit;       // FlGroupUnit
    GArray *mask;       // FlGroupMask
    GStringChunk *text; // of all these
    GHashTable *ids;    // of the document: id -> xmlNode, the first of that id
} FlLeaves;

/** The name of a leaf in a list of what is drawn as one, see fl_leaves_new(); to be freed. */
char *fl_leaf_key(const FlLeaf *leaf);

/**
 * Lists the leaves and gives each an id if it lacks one. Content with display: none is left out.
 * Elements of `whole`, see fl_is_whole(), are leaves; shapes in such an element, see fl_leaf_key(),
 * have one part. Takes over `ids`, the elements of the document.
 */
FlLeaves *fl_leaves_new(xmlDoc *doc, const char *const *whole, GHashTable *ids);

void fl_leaves_free(FlLeaves *leaves); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlLeaves, fl_leaves_free)
