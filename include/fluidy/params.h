/** @file
 * The parameters of the synthesis: names, units, ranges and defaults, for programs and people.
 * Threads: any thread may call these functions; one FlParams belongs to one thread at a time.
 */
#ifndef FLUIDY_PARAMS_H
#define FLUIDY_PARAMS_H

#include <fluidy/error.h>
#include <stdbool.h>

G_BEGIN_DECLS

/** The type of a parameter's value. */
typedef enum FlParamType {
    FL_PARAM_INT,
    FL_PARAM_FLOAT,
    FL_PARAM_BOOL, /**< written on or off; true, yes, 1, false, no, 0 are read as well */
    FL_PARAM_LIST, /**< one to eight integers with commas between, such as "6,4" */
    FL_PARAM_DIAL, /**< a float that may be keyed: fluidy-svg.conf(5) */
} FlParamType;

/** The presets, by their names. */
typedef enum FlPreset {
    FL_PRESET_DEFAULT,
    FL_PRESET_FLUIDYMATION, /**< "fluidymation": its table 1, 2021 */
    FL_PRESET_THESIS, /**< "thesis": the thesis on which the paper is based, 2021, section 4.5 */
    FL_PRESET_LAZYFLUIDS, /**< "lazyfluids": LazyFluids, 2015, section 5 */
    /** "lazyfluids-steady": the same method with what pictures are better for; "fluid" before 0.2
     */
    FL_PRESET_LAZYFLUIDS_STEADY,
    FL_PRESETS
} FlPreset;

/** The description of a parameter; all strings are static. */
typedef struct FlParamInfo {
    const char *name; /**< with dashes, as on the command line and in config files: "w-temp" */
    FlParamType type; /**< of its value */
    const char *unit; /**< "px", "frames", …; "" for a plain number */
    double min;       /**< inclusive; of each item for a list; 0 for a bool */
    double max;       /**< likewise; 1 for a bool */
    const char *preset[FL_PRESETS]; /**< in the syntax of fl_params_set() */
    const char *help;               /**< one line, no full stop */
} FlParamInfo;

/** Returns: how many parameters there are. */
FL_API int fl_param_count(void);

/** index is 0 … fl_param_count() - 1; the order is the documentation's. */
FL_API const FlParamInfo *fl_param_info(int index);

/** Returns: the index of the parameter of this name; -1 if the name is unknown. '_' is read as
 * '-'. */
FL_API int fl_param_find(const char *name);

/** A value for each parameter. */
typedef struct FlParams FlParams;

/** Returns: the defaults, to be freed with fl_params_free(). */
FL_API FlParams *fl_params_new(void);

/** Returns: to be freed with fl_params_free(). */
FL_API FlParams *fl_params_copy(const FlParams *params);

FL_API void fl_params_free(FlParams *params); /**< NULL is fine */

/** Sets all parameters to a preset by its name. FL_ERROR_USAGE. */
FL_API bool fl_params_preset(FlParams *params, const char *word, GError **error);

/**
 * Sets one parameter from text; decimal point is '.', whatever the locale.
 *
 * Returns: false with FL_ERROR_USAGE, which names the parameter, the text and the range or the
 * nearest known name; params is then unchanged.
 */
FL_API bool fl_params_set(FlParams *params, const char *name, const char *value, GError **error);

/** Returns: the value in the syntax of fl_params_set(), to be freed with g_free(); NULL: no such
 * name. */
FL_API char *fl_params_get(const FlParams *params, const char *name);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlParams, fl_params_free)

G_END_DECLS

#endif
