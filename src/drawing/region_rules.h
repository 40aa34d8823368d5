/* Rules that assign leaves to regions by paint and name. */
#ifndef FLUIDY_DRAWING_REGION_RULES_H
#define FLUIDY_DRAWING_REGION_RULES_H

#include "params/region_settings.h"
#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/**
 * A section [region NAME] of a config. A leaf belongs to the first rule whose match_* lists each
 * have an item that matches. NULL is no condition; a rule without conditions matches every leaf.
 * A leaf whose paint changes matches if it does in any frame.
 *
 * Lists are NULL-terminated. Globs know * and ?, and ignore case.
 */
typedef struct FlRegionRule {
    const char *name;              // of the region
    const char *const *match_fill; // CSS colours "#c25", "red"; "any", "none", "gradient", "image"
    const char *const *match_stroke; // the same, of strokes
    const char *const *match_id;     // globs over ids of the leaf and the groups around it
    const char *const *match_class;  // globs over class words, likewise
    const char *const *match_label;  // globs over labels, likewise
    const char *const *match_layer;  // globs over layers; without layers over the outermost group
    float tolerance;                 // of colours, CIE76; 0: 1
    const char *merge_with;          // the region into which this one is merged; NULL: not merged
    FlPassthrough passthrough;
    bool by_name; // matches no leaf, but regions whose names, without any rule, match this glob
} FlRegionRule;

/** The leaf that a rule is matched against; lists are joined with '\n'. */
typedef struct FlRuleSubject {
    const char *ids, *classes, *labels, *layers;
    bool stroke;        // a stroke, else a fill
    bool has_fill;      // the shape it belongs to has a fill
    bool has_stroke;    // the shape it belongs to has a stroke
    const char *paint;  // "#rrggbb", "gradient", "image" or "mixed"
    const uint8_t *rgb; // of a flat paint
} FlRuleSubject;

/**
 * Checks the colours of the rules and that merge_with names a rule or any region.
 * Returns: false with FL_ERROR_USAGE, naming rule and value.
 */
bool fl_rules_check(const FlRegionRule *rules, int n, GError **error);

/** Returns: the index of the first rule that matches; -1 if no rule does. */
int fl_rules_match(const FlRegionRule *rules, int n, const FlRuleSubject *subject);

#endif
