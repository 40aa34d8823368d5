/* The config of a film that is being tried out: the user's file and command line, and the choices
 * made in the page. */
#ifndef FLUIDY_CLI_LIVE_CONFIG_H
#define FLUIDY_CLI_LIVE_CONFIG_H

#include "args.h"

typedef struct FlLiveConfig FlLiveConfig;

/**
 * Reads the config file without changing the file, and adds the options of the command line. args
 * must outlive the result. FL_ERROR_INPUT. Returns: to be freed with fl_live_config_free().
 */
FlLiveConfig *fl_live_config_new(const FlArgs *args, GError **error);

/** Reads the file again; the choices stay. */
bool fl_live_config_reload(FlLiveConfig *config, GError **error);

/**
 * Makes a choice: a key of the table of options in "project", "defaults" or "region NAME"; ""
 * leaves it to the file. Returns: false with FL_ERROR_USAGE; the value itself is checked by the
 * render.
 */
bool fl_live_config_choose(FlLiveConfig *config, const char *section, const char *key,
                           const char *value, GError **error);

/** The file to keep. Borrowed until the next change. */
const char *fl_live_config_text(const FlLiveConfig *config);

/** The same for a file in any folder, without the names of outputs. To be freed. */
char *fl_live_config_portable(const FlLiveConfig *config);

/** Appends {"section":{"key":"value",…},…}. */
void fl_live_config_json(const FlLiveConfig *config, GString *json);

/** The available choices, from the table of options: {"options":[…],"styles":[…]}. To be freed. */
char *fl_live_config_options(void);

void fl_live_config_free(FlLiveConfig *config); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlLiveConfig, fl_live_config_free)

#endif
