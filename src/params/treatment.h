/* How a region is treated: what the config and the command line say of it, and what that comes to.
 */
#ifndef FLUIDY_PARAMS_TREATMENT_H
#define FLUIDY_PARAMS_TREATMENT_H

#include "params/params.h"
#include <stdint.h>

/** What a region does to the regions below it. */
typedef enum FlStacking {
    FL_STACKING_KNOCKOUT, // they are not there: paper under the paint
    FL_STACKING_GLAZE,    // its density adds to theirs, as a wash over dry paint
} FlStacking;

/** What paint does at an edge that its shape shares with others. */
typedef enum FlEdges {
    FL_EDGES_CLOSED, // it goes on up to the edge: neither a line of paper nor a double rim
    FL_EDGES_SOFT,   // as at any other edge
} FlEdges;

/** The colour of the paint. */
typedef enum FlTint {
    FL_TINT_FILL, // the drawing's fill or any other: the picture if there is one, else the flat one
    FL_TINT_KEEP, // the exemplar's own colours
} FlTint;

/** Whether a region is painted at all. */
typedef enum FlPassthrough {
    FL_PASSTHROUGH_AUTO, // strokes and shading are not
    FL_PASSTHROUGH_NO,   // it is
    FL_PASSTHROUGH_YES,  // it is drawn as it is
} FlPassthrough;

/** How one region is painted, everything decided. */
typedef struct FlTreatment {
    char *style; // a name or a path; NULL: nobody said
    FlTint tint;
    bool has_colour;   // with FL_TINT_FILL: `colour` instead of the drawing's fill
    uint8_t colour[3]; // sRGB
    FlDetail detail;
    FlStacking stacking;
    FlEdges edges;
    int hold; // frames, 1..1000
    bool reverse;
    FlPassthrough passthrough;
    char *merge_with; // another region's name; NULL: none
    FlParams params;
} FlTreatment;

void fl_treatment_init(FlTreatment *treatment); // the defaults
void fl_treatment_clear(FlTreatment *treatment);

/**
 * Sets one thing from text: a key of settings.def or params.def, or "preset". "scale" is read as
 * style-scale.
 *
 * A relative path of a style is taken from `folder`; NULL: the working directory.
 * Returns: false with FL_ERROR_USAGE; the treatment is then unchanged.
 */
bool fl_treatment_set(FlTreatment *treatment, const char *key, const char *value,
                      const char *folder, GError **error);

/** All keys that fl_treatment_set() knows, NULL-terminated; static storage. */
const char *const *fl_treatment_keys(void);

/** What is said of a region: keys and values in the order of the file, known to be right. */
typedef struct FlWish {
    char *key, *value;
} FlWish;

typedef struct FlWishes {
    int n;
    FlWish *wish;
    char *folder; // relative paths start here; NULL: the working directory
} FlWishes;

/** Adds a copy; a key said twice keeps its last value. Errors as fl_treatment_set(). */
bool fl_wishes_add(FlWishes *wishes, const char *key, const char *value, GError **error);

void fl_wishes_clear(FlWishes *wishes);

/** Applies them all, a preset first, then the detail. They were checked when they were added. */
void fl_wishes_apply(const FlWishes *wishes, FlTreatment *treatment);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlTreatment, fl_treatment_clear)
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlWishes, fl_wishes_clear)

#endif
