/* Changes the text of a config file, fluidy-svg.conf(5), and leaves the rest of it as it was
 * written. */
#ifndef FLUIDY_CLI_CONFIG_EDIT_H
#define FLUIDY_CLI_CONFIG_EDIT_H

#include <glib.h>

/** A key of a section, "project", "defaults" or "region NAME". Returns: its new value, to be freed;
 * NULL: the line is dropped. */
typedef char *(*FlConfigValue)(const char *section, const char *key, const char *value, void *data);

/** The text with every value replaced by the result of `map`. Returns: to be freed. */
char *fl_config_edit_map(const char *text, FlConfigValue map, void *data);

/**
 * The text with a key set; "" removes the key. A missing section is added at the end.
 *
 * No argument contains a line feed, and the section contains no bracket. Returns: to be freed.
 */
char *fl_config_edit_set(const char *text, const char *section, const char *key, const char *value);

#endif
