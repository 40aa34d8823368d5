/* The config of a film that is being tried out: the user's file and command line, and the choices
 * made in the page. */
#pragma once

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
 * Makes a choice: the value of an option in "project", "defaults" or "region NAME"; "" removes the
 * value. Choices that were taken back are dropped, and those before the last 256 hold. Returns:
 * false with FL_ERROR_USAGE, which names the expected values.
 */
bool fl_live_config_choose(FlLiveConfig *config, const char *section, const char *key,
                           const char *value, GError **error);

/** The text of the config. Borrowed until the next change. */
const char *fl_live_config_text(const FlLiveConfig *config);

/** The user's config file; without one, fluidy-svg.conf beside the drawing. Borrowed. */
const char *fl_live_config_path(const FlLiveConfig *config);

/** Writes the text there. replace: an existing file is replaced. Returns: false with
 * FL_ERROR_EXISTS or an error of the file. */
bool fl_live_config_save(FlLiveConfig *config, bool replace, GError **error);

/** The choices so far are good ones. */
void fl_live_config_keep(FlLiveConfig *config);

/** Drops the choices since fl_live_config_keep(). Returns: how many. */
guint fl_live_config_revert(FlLiveConfig *config);

/** The last choice that holds, by -1, or the next one that was taken back, by 1: section, key and
 * value. Borrowed; NULL: none. */
char **fl_live_config_choice(const FlLiveConfig *config, int by);

/** Takes that choice back, or makes it again. Returns: false if there is none. */
bool fl_live_config_step(FlLiveConfig *config, int by);

/** The available choices: {"controls":{"options":[…],"styles":[…]}}. To be freed. */
char *fl_live_config_options(void);

void fl_live_config_free(FlLiveConfig *config); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlLiveConfig, fl_live_config_free)
