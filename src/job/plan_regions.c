#include "base/error.h"
#include "job/plan.h"

#include "base/limits.h"
#include "base/suggest.h"
#include "io/png.h"
#include "params/keys.h"
#include "params/options.h"
#include "style/style_folder.h"
#include <string.h>

static FlGiven given_of(const FlPlan *plan)
{
    return (FlGiven){plan->options.settings, plan->options.n_settings};
}

static bool no_such_region(const FlPlan *plan, const char *name, GError **error)
{
    g_autoptr(GPtrArray) names = g_ptr_array_new();
    for (int r = 0; r < fl_drawing_regions(plan->shapes.drawing); r++)
        g_ptr_array_add(names, fl_drawing_region(plan->shapes.drawing, r)->name);
    g_ptr_array_add(names, NULL);
    g_autofree char *list = g_strjoinv(", ", (char **)names->pdata);
    g_autofree char *hint = fl_did_you_mean(name, (const char *const *)names->pdata);
    if (*hint)
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "no region “%s”%s", name, hint);
    else
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "no region “%s”; the regions are: %s", name,
                    list);
    return false;
}

static bool has_region(const FlPlan *plan, const char *name)
{
    bool found = false;
    for (int r = 0; !found && r < fl_drawing_regions(plan->shapes.drawing); r++)
        found = g_str_equal(fl_drawing_region(plan->shapes.drawing, r)->name, name);
    return found;
}

static bool check_region_names(const FlPlan *plan, GError **error)
{
    const char *only_region = plan->options.only_region;
    g_auto(GStrv) only = g_strsplit(only_region ? only_region : "", ",", -1);
    const FlGiven given = given_of(plan);
    const size_t n = given.n + g_strv_length(only);
    for (size_t i = 0; i < n; i++) {
        const char *name = i < given.n ? given.setting[i].region : only[i - given.n];
        if (name && !has_region(plan, name))
            return no_such_region(plan, name, error);
    }
    return true;
}

/* Checks the neighbours that a region calls wet. */
static bool check_wet_with(const FlPlan *plan, const FlRegionSettings *settings, GError **error)
{
    g_auto(GStrv) names = g_strsplit(settings->wet_with ? settings->wet_with : "", ",", -1);
    for (char **name = names; *name; name++)
        if (!g_str_equal(*name, "all") && !has_region(plan, *name)) {
            no_such_region(plan, *name, error);
            g_prefix_error(error, "wet-with: ");
            return false;
        }
    return true;
}

/* Paper that is left around a region would be wider where it has no rim. */
static FlEdge edge_limit_of(bool gap, const FlRegionSettings *settings, bool painted)
{
    if (!painted)
        return FL_EDGE_NONE;
    if (settings->edges == FL_EDGES_SOFT)
        return FL_EDGE_FREE;
    const bool apart = gap || settings->stacking == FL_STACKING_GLAZE;
    return apart ? FL_EDGE_SAME_COLOUR : FL_EDGE_ADJACENT;
}

/* True unless `region` names a region. */
static bool is_left_out(const FlPlan *plan, const char *name)
{
    const char *only = plan->options.only_region;
    g_auto(GStrv) names = only ? g_strsplit(only, ",", -1) : NULL;
    return only && !g_strv_contains((const char *const *)names, name);
}

/* Chooses the k-th of the keyed styles of a painted region's settings. */
static bool choose_key(FlPlan *plan, FlRegionPlan *painted, int k, GError **error)
{
    const FlOption *option = fl_option_find(FL_SCOPE_REGION, "style");
    const FlKeys *keys = fl_option_keys(option, &painted->settings);
    const FlKey *key = &g_array_index(keys->key, FlKey, k);
    g_autofree char *style = g_strdup(key->value);
    if (k > 0) {
        char *name = g_strdup_printf("%s@%d", painted->name, key->frame);
        g_ptr_array_add(plan->config->strings, name);
        painted->name = name;
    }
    painted->style_key = k;
    painted->styles = fl_keys_read(option, true, keys->text, error);
    return painted->styles &&
           fl_region_settings_set(&painted->settings, "style", style, NULL, error);
}

/* True if a setting is for this region alone. */
static bool is_said(const FlConfig *config, int rule, const char *region, FlGiven given,
                    const char *key)
{
    const FlOverrides *own = rule >= 0 ? &config->rules[rule].overrides : NULL;
    bool said = false;
    for (int k = 0; own && k < own->n; k++)
        said = said || strcmp(own->override[k].key, key) == 0;
    for (size_t k = 0; k < given.n; k++)
        said = said || (g_strcmp0(given.setting[k].region, region) == 0 &&
                        strcmp(given.setting[k].name, key) == 0);
    return said;
}

/* The settings in the names of layers, such as “hat style=gouache”, of which inner ones override
 * outer ones; those that are said for the region alone are left out. label: the layers, with /
 * between; NULL: none. */
static bool read_label(const FlConfig *config, int rule, const char *region, const char *label,
                       FlGiven given, FlOverrides *settings, GError **error)
{
    g_auto(GStrv) words = g_strsplit_set(label ? label : "", " \t/", -1);
    for (char **word = words; *word; word++) {
        char *value = strchr(*word, '=');
        if (!value)
            continue;
        *value++ = '\0';
        if (g_str_has_prefix(*word, FL_MAP_OPTION))
            return fl_fail(error, FL_ERROR_USAGE, "layer “%s”: %s names a file; say it in a config",
                           label, *word);
        if (!fl_option_find(FL_SCOPE_REGION, *word) || is_said(config, rule, region, given, *word))
            continue;
        if (strcmp(*word, "merge-with") == 0 || strcmp(*word, "passthrough") == 0)
            return fl_fail(error, FL_ERROR_USAGE,
                           "layer “%s”: %s decides which regions there are; say it in a config",
                           label, *word);
        if (fl_overrides_add(settings, *word, value, NULL, error))
            continue;
        g_prefix_error(error, "layer “%s”: ", label);
        return false;
    }
    return true;
}

bool fl_plan_region_settings(const FlConfig *config, int matched, const char *region,
                             const char *label, FlGiven given, FlRegionSettings *settings,
                             GError **error)
{
    const int rule = fl_config_rule(config, matched, region);
    g_auto(FlOverrides) of_label = {0}, of_style = {0};
    if (!read_label(config, rule, region, label, given, &of_label, error) ||
        !fl_config_region_settings(config, rule, region, given, NULL, settings, error))
        return false;
    fl_overrides_apply(&of_label, settings);
    if (settings->style)
        fl_style_settings(settings->style, &of_style);
    if (of_style.n == 0)
        return true;
    fl_region_settings_clear(settings);
    if (!fl_config_region_settings(config, rule, region, given, &of_style, settings, error))
        return false;
    fl_overrides_apply(&of_label, settings);
    return true;
}

/* Splits the region that was planned last into a painted region for each of its keyed styles. */
static bool add_styles(FlPlan *plan, int region, GError **error)
{
    FlShapes *shapes = &plan->shapes;
    const FlRegion *r = fl_drawing_region(shapes->drawing, region);
    const FlKeys *keys = fl_option_keys(fl_option_find(FL_SCOPE_REGION, "style"),
                                        &shapes->painted[shapes->n_painted - 1].settings);
    const int n = keys ? (int)keys->key->len : 0;
    const int room = shapes->n_painted + fl_drawing_regions(shapes->drawing) + n;
    if (n == 0)
        return true;
    shapes->painted = g_renew(FlRegionPlan, shapes->painted, room);
    memset(shapes->painted + shapes->n_painted, 0,
           (size_t)(room - shapes->n_painted) * sizeof *shapes->painted);
    for (int k = 0; k < n; k++) {
        FlRegionPlan *painted = &shapes->painted[shapes->n_painted - 1];
        if (!choose_key(plan, painted, k, error))
            return false;
        if (k + 1 == n)
            break;
        painted->more = true;
        painted++;
        if (!fl_plan_region_settings(plan->config, r->rule, r->name, r->label, given_of(plan),
                                     &painted->settings, error))
            return false;
        painted->region = region, painted->name = r->name;
        shapes->n_painted++;
    }
    return true;
}

/* The settings of a region, and whether it is painted. */
static bool plan_region(FlPlan *plan, int region, GError **error)
{
    FlShapes *shapes = &plan->shapes;
    const FlRegion *r = fl_drawing_region(shapes->drawing, region);
    FlRegionPlan *chosen = &shapes->painted[shapes->n_painted];
    FlRegionSettings *settings = &chosen->settings;
    const bool left_out = is_left_out(plan, r->name);
    if (!fl_plan_region_settings(plan->config, r->rule, r->name, r->label, given_of(plan), settings,
                                 error))
        return false;
    const bool painted = r->paintable && settings->passthrough != FL_PASSTHROUGH_YES;
    plan->half &= !painted || settings->params.half_size;
    shapes->edge_limits[region] = edge_limit_of(plan->options.gap > 0, settings, painted);
    if (!painted)
        shapes->hands[region] = (FlRegionHand){settings->line, settings->line_boil};
    shapes->painted_of[region] = left_out ? FL_LEFT_OUT : FL_DRAWN_AS_IT_IS;
    if (!painted || left_out) {
        fl_region_settings_clear(settings);
        return true;
    }
    chosen->region = region;
    chosen->name = r->name;
    shapes->painted_of[region] = shapes->n_painted++; // from here on, fl_plan_free() clears it
    if (!check_wet_with(plan, settings, error))
        return false;
    if (settings->style)
        return add_styles(plan, region, error);
    return fl_fail(error, FL_ERROR_USAGE,
                   "no style for region “%s”; use ‘style’ NAME, or style = NAME in a config",
                   r->name);
}

/* All regions have half the size or none, including those left out this time, since they are
 * composed together. */
static bool plan_regions(FlPlan *plan, GError **error)
{
    FlShapes *shapes = &plan->shapes;
    const int n = fl_drawing_regions(shapes->drawing);
    shapes->painted = g_new0(FlRegionPlan, MAX(n, 1));
    shapes->painted_of = g_new0(int, MAX(n, 1));
    shapes->edge_limits = g_new0(FlEdge, MAX(n, 1));
    shapes->hands = g_new0(FlRegionHand, MAX(n, 1));
    plan->half = true;
    for (int r = 0; r < n; r++)
        if (!plan_region(plan, r, error))
            return false;
    shapes->hold_of = g_new0(int, MAX(n, 1));
    for (int r = 0; r < n; r++)
        shapes->hold_of[r] = shapes->painted_of[r] >= 0
                                 ? shapes->painted[shapes->painted_of[r]].settings.hold
                                 : shapes->hold;
    plan->half &= shapes->n_painted > 0;
    plan->by_page = shapes->n_painted == 0;
    for (int p = 0; p < shapes->n_painted; p++)
        plan->by_page |= shapes->painted[p].settings.params.style_by_page;
    for (int p = 0; p < shapes->n_painted; p++)
        shapes->painted[p].settings.params.half_size = plan->half;
    return fl_limit_check(FL_LIMIT_REGIONS, shapes->n_painted, fl_drawing_name(shapes->drawing),
                          error);
}

/* Layers and paint are PNG files, whatever the frames are. */
static bool check_is_png(const char *pattern, GError **error)
{
    return !pattern || fl_png_named(pattern, "layers and paint are", error);
}

/* With one name for all regions, each layer would replace the last. */
static bool check_regions_file(const FlPlan *plan, const char *pattern, GError **error)
{
    const char *brace = pattern ? strchr(pattern, '{') : NULL;
    if (brace && strchr(brace, '}') && !strstr(pattern, "{region}"))
        return fl_fail(error, FL_ERROR_USAGE, "%s: “%.*s” is not understood; expected %s", pattern,
                       (int)(strchr(brace, '}') + 1 - brace), brace, "{region}");
    if (!pattern || plan->shapes.n_painted < 2 || strstr(pattern, "{region}"))
        return true;
    return fl_fail(error, FL_ERROR_USAGE,
                   "%s: one file for %d regions; expected {region} in the name", pattern,
                   plan->shapes.n_painted);
}

bool fl_plan_find_regions(FlPlan *plan, GError **error)
{
    return check_region_names(plan, error) && plan_regions(plan, error) &&
           check_regions_file(plan, plan->out.layers, error) &&
           check_is_png(plan->out.layers, error) &&
           check_regions_file(plan, plan->out.paint, error) &&
           (plan->out.merge || check_is_png(plan->out.paint, error));
}
