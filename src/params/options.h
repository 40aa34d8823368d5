/* The table of options, made from options.def and params.def: name, values, the field it sets and
 * whether it decides the bytes of a render. */
#pragma once

#include "base/error.h"
#include "params/region_settings.h"
#include <fluidy/render.h>
#include <stddef.h>

typedef enum FlOptionScope {
    FL_SCOPE_RENDER,  // FlRenderOptions
    FL_SCOPE_REGION,  // FlRegionSettings
    FL_SCOPE_PROGRAM, // the command line alone
} FlOptionScope;

/** See options.def, and params.def. */
typedef enum FlOptionType {
    FL_OPTION_FLAG,
    FL_OPTION_SWITCH,
    FL_OPTION_INT,
    FL_OPTION_DIAL,
    FL_OPTION_FIXED,
    FL_OPTION_COUNT,
    FL_OPTION_REAL,
    FL_OPTION_WORD,
    FL_OPTION_TEXT,
    FL_OPTION_PATH,
    FL_OPTION_GROUND,
    FL_OPTION_CHOICE,
    FL_OPTION_BOOL,
    FL_OPTION_STYLE,
    FL_OPTION_TINT,
    FL_OPTION_NAME,
    FL_OPTION_MAP,
    FL_OPTION_PRESET,
    FL_OPTION_FLOAT,
    FL_OPTION_WEIGHT,
    FL_OPTION_LIST,
    FL_OPTION_COMMAND,
    FL_OPTION_READ,
} FlOptionType;

typedef enum FlOptionSection {
    FL_SECTION_NONE,
    FL_SECTION_PROJECT,
    FL_SECTION_REGION, // and [defaults]
} FlOptionSection;

/** The effect of an option on the painted bytes: after a change a render cannot be resumed. */
typedef enum FlOptionBytes {
    FL_BYTES_NEVER,
    FL_BYTES_VALUE,  // its value is a fact of the render
    FL_BYTES_FRAME,  // likewise, but paint does not depend on it
    FL_BYTES_RESULT, // facts that follow from its value are
} FlOptionBytes;

typedef enum FlOptionGroup {
    FL_GROUP_COMMON, // those of --help
    FL_GROUP_INPUT,
    FL_GROUP_PAINT,
    FL_GROUP_OUTPUT,
    FL_GROUP_RUNNING,
    FL_GROUP_PRESETS,
    FL_GROUP_PARAMETERS,
    FL_GROUP_CONFIG_ONLY, // not on the command line
} FlOptionGroup;

/** A line of the table; strings are static. */
typedef struct FlOption {
    const char *name; // with dashes; unique in its scope
    char letter;      // of the command line; 0: no letter
    FlOptionScope scope;
    FlOptionType type;
    size_t offset;     // of its field in the struct of its scope
    size_t size;       // of that field, bytes
    const char *value; // words with | between, or placeholders in capitals; "": no value
    const char *unit;
    double min, max; // inclusive, of numbers
    const char *default_value;
    FlOptionSection section;
    FlOptionBytes bytes;
    FlOptionGroup group;
    const char *help;
    const char *const *preset; // of a parameter: its values by FlPreset, else NULL
} FlOption;

int fl_option_count(void);

/** index is 0 … fl_option_count() - 1: the order of options.def, then of params.def. */
const FlOption *fl_option_at(int index);

/** The option with a name, or NULL. "scale" is an option of a render as well as a key of a region.
 */
const FlOption *fl_option_find(FlOptionScope scope, const char *name);

/** Returns: true if a region's option may be keyed in time. */
bool fl_option_can_be_keyed(const FlOption *option);

/** The option of the command line: "width" or the letter "W"; NULL if unknown. */
const FlOption *fl_option_find_argument(const char *name);

/** Returns: true if a value follows on the command line. */
bool fl_option_takes_value(const FlOption *option);

/** The words that the value may be, such as "draft normal fine"; NULL: no word. To be freed. */
char *fl_option_words(const FlOption *option);

/** The word that stands for a number which is not given, such as auto; NULL: there is none. */
const char *fl_option_nan(const FlOption *option);

/** The line of the help, with words and default. To be freed. */
char *fl_option_help(const FlOption *option);

/** Sets FL_ERROR_USAGE: the value and what the option expects. Returns: false. */
bool fl_option_reject(const FlOption *option, const char *value, GError **error);

/** Reads a flag, a number, a list or a word into its field. Returns: false if the text is not
 * a value of the option; the field is then unchanged. */
bool fl_option_read(const FlOption *option, const char *text, void *field);

/** The field of an option in the struct of its scope. */
void *fl_option_field(const FlOption *option, const void *object);

/* ---- options of a render --------------------------------------------------------------------- */

/**
 * Reads a value into the field of an option of FL_SCOPE_RENDER.
 *
 * Relative paths start in `folder`; NULL: as they are. Texts are copied, and the copies given to
 * `strings`. An explicit 0 is kept as -1, so that it overrides the config.
 * Returns: false with FL_ERROR_USAGE without the option's name; the field is then unchanged.
 */
bool fl_option_set(const FlOption *option, const char *value, const char *folder,
                   FlRenderOptions *options, GPtrArray *strings, GError **error);

/** Copies the options of a caller, whose struct may have fewer or more fields. FL_ERROR_USAGE. */
bool fl_options_take(const FlRenderOptions *given, FlRenderOptions *known, GError **error);

/** The files that FlRenderOptions.config names: one that has this name, else several, separated by
 * semicolons; NULL names none. To be freed with g_strfreev(). */
char **fl_options_configs(const char *config);

/** The caller of a render that begins now. */
FlCaller fl_caller_of(const FlRenderOptions *options);

/** Makes an explicit 0, kept as -1, a 0 again: the option has overridden what it may. */
void fl_option_drop_marker(const FlOption *option, FlRenderOptions *options);

/** Returns: true if the field is not zero. */
bool fl_option_is_set(const FlOption *option, const FlRenderOptions *options);

void fl_option_copy(const FlOption *option, const FlRenderOptions *from, FlRenderOptions *to);

/* ---- options of a render or a region --------------------------------------------------------- */

/** The keys of a region's option, borrowed; NULL: it is not keyed. */
const struct FlKeys *fl_option_keys(const FlOption *option, const FlRegionSettings *settings);

/** The value as text: `object` is the struct of its scope. NULL: not set. To be freed. */
char *fl_option_get(const FlOption *option, const void *object);

/* ---- of the programs alone ------------------------------------------------------------------- */

/** Which scheduler a plan is printed for. */
typedef enum FlFarm {
    FL_FARM_SLURM,  /**< a script for bash that calls sbatch */
    FL_FARM_OPENJD, /**< an Open Job Description template, 2023-09 */
    FL_FARM_JSON,   /**< commands as lists of words, for everything else */
} FlFarm;

/**
 * A render as tasks for several machines: each paints some regions into files of paint, the largest
 * first, and a merge composes them. Reads the drawing and checks the options; writes nothing.
 *
 * command: the words of the command line of the whole render, NULL-terminated.
 * Returns: to be freed with g_free(); NULL with an error of FL_ERROR.
 */
FL_API char *fl_farm_plan(const FlRenderOptions *options, FlFarm farm, const char *const *command,
                          GError **error);

/**
 * The page of a report that is live, HTML: a list of regions, controls, and the film. It connects
 * to `pictures` beside its own address, a WebSocket; see inspect/live.html.
 *
 * Returns: to be freed with g_bytes_unref().
 */
FL_API GBytes *fl_live_page(void);
