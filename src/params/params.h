/* The parameters of the synthesis as a plain struct, made from params.def. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>

#define FL_LIST_LONGEST 8

/** A value per pyramid level, the coarsest first; the last goes for all finer levels. n >= 1. */
typedef struct FlIntList {
    int n;
    int value[FL_LIST_LONGEST];
} FlIntList;

#define FL_C_TYPE_INT int
#define FL_C_TYPE_FLOAT float
#define FL_C_TYPE_WEIGHT float
#define FL_C_TYPE_BOOL bool
#define FL_C_TYPE_LIST FlIntList

/** Fields, units and ranges are those of params.def. */
typedef struct FlParams {
#define FL_PARAM(type, field, ...) FL_C_TYPE_##type field;
#include "params/params.def"
#undef FL_PARAM
} FlParams;

void fl_params_defaults(FlParams *params);

/** Sets all parameters to a preset by its name. FL_ERROR_USAGE. */
bool fl_params_preset(FlParams *params, const char *word, GError **error);

/** Sets a parameter of that name. FL_ERROR_USAGE without the name; params is then unchanged. */
bool fl_params_set(FlParams *params, const char *name, const char *value, GError **error);

/** The trade of quality for time. */
typedef enum FlDetail {
    FL_DETAIL_DRAFT,
    FL_DETAIL_NORMAL,
    FL_DETAIL_FINE,
    FL_DETAIL_FINEST
} FlDetail;

/**
 * Sets the most expensive parameters: rounds and sweeps of the search, and half sizes.
 * FL_DETAIL_NORMAL sets their defaults.
 */
void fl_params_detail(FlParams *params, FlDetail detail);

/** Makes the lengths px of what is painted, of which `px` are one of theirs. */
void fl_params_scale_lengths(FlParams *params, float px);

/** The value for a level `from_coarsest` steps finer than the coarsest; >= 0. */
static inline int fl_list_at(const FlIntList *list, int from_coarsest)
{
    return list->value[from_coarsest < list->n ? from_coarsest : list->n - 1];
}

/** The names of the presets, NULL-terminated; static storage. */
extern const char *const fl_preset_names[];
