/* The command line of fluidy-svg as a struct. */
#pragma once

#include "params/options.h"
#include <fluidy/fluidy.h>

typedef enum FlCommand {
    FL_COMMAND_RENDER,
    FL_COMMAND_HELP,
    FL_COMMAND_HELP_ALL,
    FL_COMMAND_VERSION,
    FL_COMMAND_LIST_REGIONS,
    FL_COMMAND_PRINT_CONFIG,
    FL_COMMAND_LIST_STYLES,
    FL_COMMAND_CHECK,
    FL_COMMAND_FLAT,
    FL_COMMAND_COMPARE,
    FL_COMMAND_PLAN,
    FL_COMMAND_SAVE_LOOK,
    FL_COMMAND_METHODS,
    FL_COMMAND_SERVE,
    FL_COMMAND_WINDOW,
} FlCommand;

typedef enum FlProgressMode {
    FL_PROGRESS_AUTO, // a bar on a terminal, else plain
    FL_PROGRESS_BAR,
    FL_PROGRESS_PLAIN,
    FL_PROGRESS_JSON,
    FL_PROGRESS_NONE,
} FlProgressMode;

typedef struct FlArgs {
    FlCommand task;
    FlRenderOptions render; // its strings belong to this struct
    FlProgressMode progress;
    const char *preview; // a range of frames; NULL: no preview
    char **variants;     // of FL_COMMAND_COMPARE, styles; NULL: all there are; or _METHODS
    FlFarm farm;         // of FL_COMMAND_PLAN
    const char *look;    // of FL_COMMAND_SAVE_LOOK
    char **command;      // likewise: the words without --plan
    GPtrArray *limits;   // char *: NAME=N, as they were given
    int port;            // of FL_COMMAND_SERVE; 0: any that is free
    bool quiet;          // no warnings, notes or progress
    char **inputs;
    GArray *settings;   // FlSetting
    GPtrArray *strings; // whatever else is owned
} FlArgs;

/**
 * Reads the command line. `args` is not initialised before; clear it in any case.
 *
 * Returns: false with FL_ERROR_USAGE or G_OPTION_ERROR, one line with a suggestion where one is
 * near.
 */
bool fl_args_parse(FlArgs *args, int argc, char **argv, GError **error);

void fl_args_clear(FlArgs *args);
