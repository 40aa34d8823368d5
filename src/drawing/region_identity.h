/* Groups the leaves of all frames into regions: tracks of leaves, their nesting, and the names. */
#pragma once

#include "drawing/survey.h"

/** A region before it has a name. */
typedef struct FlRegionIdentity {
    int label;          // label path without frame numbers, a number in FlSurvey.strings
    int rule;           // -1: none
    bool stroke, shade; // of strokes that are not painted; a translucent overlay
    FlPaintKind kind;   // of the paint that covers most
    uint8_t rgb[3];     // its colour
    int paint;          // its key, a number in FlSurvey.strings
} FlRegionIdentity;

/**
 * Sets FlSurveyPart.region of every part; strokes that are dropped get -1.
 *
 * Regions are numbered by their first frame, and there bottom up. Returns: an array of
 * FlRegionIdentity.
 */
GArray *fl_region_identities_find(FlSurvey *survey, const FlDrawingOptions *options);

/** For every string that is a list of labels, the same without frame numbers; survey->strings
 * grows.
 */
int *fl_clean_labels(FlSurvey *survey);

/** One leaf through the drawing. */
typedef struct FlTrack {
    FlSurveyPart last; // in the last frame that has it
    int last_frame;
    int rule;       // the first that it matches in any frame; -1: none
    int depth;      // see fl_find_nesting()
    int twin;       // the first track whose paints change as its own do
    bool is_hair;   // a stroke that is a hairline in all frames
    bool is_limb;   // a stroke that is thick in one of them
    bool varies;    // its paint changed
    uint8_t rgb[3]; // of the first frame that has it
    float drift;    // largest CIE76 distance of its paint from this colour
    GArray *paints; // int pairs: frame, paint (a string number); ascending frames
} FlTrack;

/**
 * Finds the tracks and sets FlSurveyPart.nth to that of each part. label_of maps
 * FlSurveyPart.labels to clean labels.
 *
 * Returns: an array of FlTrack. Two leaves with the same label and paint may swap tracks; that does
 * not matter.
 */
GArray *fl_leaf_tracks_find(const FlSurvey *survey, const int *label_of);

/**
 * Finds the nesting depth of each track in others of its paint: 0: not nested, nested only in some
 * frames, or small. As one region such leaves would hide each other in the whole-shape mask.
 */
void fl_find_nesting(const FlSurvey *survey, const int *label_of, GArray *tracks);

/**
 * A name for every group, unique, of [a-z0-9-]: that of its rule, else the innermost label and the
 * colour, or without a label a word for the colour. What all labels share is not repeated.
 *
 * Returns: a NULL-terminated list of groups->len names, to be freed with g_strfreev().
 */
char **fl_name_groups(const FlSurvey *survey, const GArray *groups, const FlRule *rules);

/** The leaf that a rule is matched against; lists are joined with '\n'. */
typedef struct FlRuleSubject {
    const char *ids, *classes, *labels, *layers;
    bool stroke;        // a stroke, else a fill
    bool has_fill;      // the shape it belongs to has a fill
    bool has_stroke;    // the shape it belongs to has a stroke
    const char *paint;  // "#rrggbb", "gradient", "image" or "mixed"
    const uint8_t *rgb; // of a flat paint
} FlRuleSubject;

/** Checks the colours of the rules. Returns: false with FL_ERROR_USAGE, naming rule and value. */
bool fl_rules_check(const FlRule *rules, int n, GError **error);

/** Returns: the index of the first rule that matches; -1 if no rule does. */
int fl_rules_match(const FlRule *rules, int n, const FlRuleSubject *subject);
