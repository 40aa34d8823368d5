/* The config file of a render, fluidy-svg.conf(5): rules that say which leaves are painted how. */
#pragma once

#include "base/digest.h"
#include "params/options.h"
#include "params/region_settings.h"
#include <fluidy/render.h>

/**
 * A [region NAME] section. It matches a leaf if every list that is not NULL has an item that does;
 * with match = * all of them are NULL. Without a match key it is for the region that has its name
 * without any rule.
 *
 * Lists are NULL-terminated; items are globs of * and ?, ignoring case. A fill or stroke is
 * a CSS colour, "any", "none", "gradient" or "image".
 */
typedef struct FlRule {
    const char *name;  // of the section; unique
    const char *place; // FILE:LINE of the section
    bool by_name;      // no match key: for regions whose names, without any rule, match this one
    bool match_all;    // match = *
    const char *const *match_fill, *const *match_stroke;
    const char *const *match_id, *const *match_class, *const *match_label;
    const char *const *match_layer; // any of the names in the leaf's label path
    float match_tolerance;          // of colours, CIE76, 0..100; 0: 1
    FlOverrides overrides;
    /* Of the overrides, those that decide which regions there are. */
    const char *merge_with; // the region into which this one is merged; NULL: not merged
    FlPassthrough passthrough;
} FlRule;

/** A config in memory. Rules are in the order of the file, those of included files after its own:
 * the first that matches wins. */
typedef struct FlConfig {
    char *path;              // for messages; NULL: no file
    FlRenderOptions project; // of [project]; its strings are in `strings`
    FlOverrides defaults;    // of [defaults]
    int n_rules;
    FlRule *rules;
    FlOverrides given; // of the caller, fl_config_give()
    GPtrArray *files;  // char *: those that were read
    GPtrArray *strings;
} FlConfig;

/**
 * Reads fl_options_configs(path), files or pipes such as the shell's <(…), of which later ones
 * override earlier ones, and those that they include; path NULL gives an empty config.
 * `caller`, who may be NULL, is told of the files, and can stop the wait for a pipe.
 *
 * Returns: to be freed with fl_config_free(); NULL with FL_ERROR_USAGE (or an error of
 * fl_file_read()), which names file, line, the mistake and what was expected.
 */
FlConfig *fl_config_load(const char *path, const FlRenderOptions *caller, GError **error);

/** The rule of a region: the one that matched its leaves, -1 if none did, else the first for its
 * name; -1: no rule. */
int fl_config_rule(const FlConfig *config, int matched, const char *region);

/** Adds all that decides which regions the rules make of a drawing. */
void fl_config_add_rules(const FlConfig *config, FlDigest *digest);

void fl_config_free(FlConfig *config); // NULL is fine

/**
 * Completes unset options from [project], else with the defaults; output stays NULL if it is set
 * nowhere. The strings stay the config's.
 */
void fl_config_complete(const FlConfig *config, FlRenderOptions *options);

/** Copies the n settings that a caller gives, FlRenderOptions.settings, in the place of earlier
 * ones. Returns: false with FL_ERROR_USAGE. */
bool fl_config_give(FlConfig *config, const FlSetting *setting, size_t n, GError **error);

/**
 * Decides how a region is painted: defaults, then `first`, then [defaults], then the rule, then the
 * given settings for every region, then those for this one.
 *
 * first: what a style says; NULL: nothing.
 * rule is an index into config->rules; -1 without a rule. Initialises `settings`.
 */
void fl_config_region_settings(const FlConfig *config, int rule, const char *region,
                               const FlOverrides *first, FlRegionSettings *settings);

/** Appends the match keys of a rule as lines. */
void fl_rule_append_matches(const FlRule *rule, GString *text);

/** What stands for a value that may name files, of an option and from a folder, which may be NULL.
 * Returns: to be freed; NULL with the error set. */
typedef char *(*FlConfigPath)(const FlOption *option, const char *value, const char *folder,
                              void *data, GError **error);

/**
 * Writes a config that paints as `config` does, given settings included, with the options over it,
 * in one file: whatever says how to paint, but for control maps. The options are not completed with
 * the defaults.
 * Returns: to be freed; NULL with an error of `path` or FL_ERROR_USAGE.
 */
char *fl_config_text(const FlConfig *config, const FlRenderOptions *options, FlConfigPath path,
                     void *data, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlConfig, fl_config_free)
