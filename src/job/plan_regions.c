#include "base/error.h"

#include "base/limits.h"
#include "base/page.h"
#include "base/suggest.h"
#include "io/png.h"
#include "job/plan.h"
#include "params/keys.h"
#include "params/options.h"
#include "style/style_folder.h"
#include <math.h>
#include <string.h>

static bool no_such_region(const FlPlan *plan, const char *name, GError **error)
{
    g_autoptr(GPtrArray) names = g_ptr_array_new();
    for (int r = 0; r < fl_drawing_regions(plan->shapes.drawing); r++)
        g_ptr_array_add(names, fl_drawing_region(plan->shapes.drawing, r)->name);
    g_ptr_array_add(names, NULL);
    g_autofree char *list = g_strjoinv(", ", (char **)names->pdata);
    g_autofree char *hint = fl_did_you_mean(name, (const char *const *)names->pdata);
    if (*hint)
        fl_fail(error, FL_ERROR_USAGE, "no region “%s”%s", name, hint);
    else
        fl_fail(error, FL_ERROR_USAGE, "no region “%s”; the regions are: %s", name, list);
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
    const FlOverrides *given = &plan->config->given;
    const int n = given->n + (int)g_strv_length(only);
    for (int i = 0; i < n; i++) {
        const char *name = i < given->n ? given->override[i].region : only[i - given->n];
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
static bool is_said(const FlConfig *config, int rule, const char *region, const char *key)
{
    return (rule >= 0 && fl_overrides_find(&config->rules[rule].overrides, NULL, key)) ||
           fl_overrides_find(&config->given, region, key);
}

/* The settings in the names of layers, such as “hat style=gouache”, of which inner ones override
 * outer ones; those that are said for the region alone are left out. label: the layers, with /
 * between; NULL: none. */
static bool read_label(const FlConfig *config, int rule, const char *region, const char *label,
                       FlOverrides *settings, GError **error)
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
        if (!fl_option_find(FL_SCOPE_REGION, *word) || is_said(config, rule, region, *word))
            continue;
        if (strcmp(*word, "merge-with") == 0 || strcmp(*word, "passthrough") == 0)
            return fl_fail(error, FL_ERROR_USAGE,
                           "layer “%s”: %s decides which regions there are; say it in a config",
                           label, *word);
        if (fl_overrides_add(settings, NULL, *word, value, NULL, error))
            continue;
        g_prefix_error(error, "layer “%s”: ", label);
        return false;
    }
    return true;
}

bool fl_plan_region_settings(const FlConfig *config, int matched, const char *region,
                             const char *label, FlRegionSettings *settings, GError **error)
{
    const int rule = fl_config_rule(config, matched, region);
    g_auto(FlOverrides) of_label = {0}, of_style = {0};
    if (!read_label(config, rule, region, label, &of_label, error))
        return false;
    fl_config_region_settings(config, rule, region, NULL, settings);
    fl_overrides_apply(&of_label, NULL, settings);
    if (settings->style)
        fl_style_settings(settings->style, &of_style);
    if (of_style.n == 0)
        return true;
    fl_region_settings_clear(settings);
    fl_config_region_settings(config, rule, region, &of_style, settings);
    fl_overrides_apply(&of_label, NULL, settings);
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
        if (!fl_plan_region_settings(plan->config, r->rule, r->name, r->label, &painted->settings,
                                     error))
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
    if (!fl_plan_region_settings(plan->config, r->rule, r->name, r->label, settings, error))
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

/* ---- their styles -----------------------------------------------------------------------------
 */

/* Warns about a style, once, for the first of its regions. */
static bool warn_of_style(const FlPlan *plan, const FlRegionPlan *painted, GError **error)
{
    enum { MUCH_BEYOND = 10 };  // percent
    const float coarse = 1.25f; // below it enlarged pictures do not look soft
    const FlStyleInstance *style = painted->style;
    for (const FlRegionPlan *p = plan->shapes.painted; p < painted; p++)
        if (p->style == style)
            return true;
    if (painted->engine->plays && style->exemplar->level[0].n_frames == 1 &&
        painted->settings.fluid <= FL_FLUID_NONE &&
        !fl_warn(&plan->caller, error, FL_ERROR_STYLE,
                 "%s: one frame is used: its paint does not flow", style->path))
        return false;
    if (painted->engine->plays && style->enlarged > coarse &&
        painted->settings.params.style_by_page &&
        !fl_warn(
            &plan->caller, error, FL_ERROR_STYLE,
            "%s: its pictures are enlarged %.2g times and look soft; a page as large as this one "
            "wants a larger recording, with a scale below 1 in its style.ini",
            style->path, style->enlarged))
        return false;
    return style->ink->beyond < MUCH_BEYOND || painted->settings.tint != FL_TINT_FILL ||
           fl_warn(
               &plan->caller, error, FL_ERROR_STYLE,
               "%s: %d %% of the paint is lighter than the paper where most is darker (or the "
               "reverse) and will show as bare paper; use ‘tint’ keep for the recording's colours",
               style->path, style->ink->beyond);
}

/* The deepest pixel of a region, were it a disc: no shape of that area has a deeper one. */
static double deepest(const FlRegionPlan *painted)
{
    return sqrt(painted->area_px / G_PI);
}

/* Warns, by the largest one, of regions that are border all over since the borders of their presets
 * are in pixels: a larger page has room for an interior. */
static bool warn_of_borders(const FlPlan *plan, GError **error)
{
    const FlShapes *shapes = &plan->shapes;
    const FlRegionPlan *largest = NULL;
    int n = 0;
    for (const FlRegionPlan *p = shapes->painted; p < shapes->painted + shapes->n_painted; p++) {
        const FlParams *params = &p->settings.params;
        if (params->style_by_page || params->border <= deepest(p))
            continue;
        n++;
        if (!largest || deepest(p) > deepest(largest))
            largest = p;
    }
    if (!largest || !(largest->area_px > 0))
        return true;
    const double border = (double)largest->settings.params.border;
    return fl_warn(
        &plan->caller, error, FL_ERROR_STYLE,
        "%d of %d regions are narrower than the border of their preset; the largest, “%s”, "
        "has an interior from a width of %.0f px on, or with a ‘border’ below %.0f px",
        n, shapes->n_painted, largest->name, ceil(shapes->width * border / deepest(largest)),
        ceil(deepest(largest)));
}

/* Px of the drawing as it is painted per px of a region's sizes. */
static float texture_px(const FlPlan *plan, const FlParams *params)
{
    if (params->style_by_page)
        return fl_page_scale(plan->shapes.width, plan->shapes.height);
    return plan->half ? .5f : 1;
}

/* Checks that the engine has the pairs of guides that are exported to ebsynth. */
static bool check_export(const FlPlan *plan, const FlRegionPlan *painted, GError **error)
{
    if (!plan->out.ebsynth || plan->out.merge || painted->engine->guide_pairs)
        return true;
    return fl_fail(
        error, FL_ERROR_USAGE,
        "region %s: the engine %s has no guides for ‘ebsynth’; use another, or ‘region’ to "
        "leave it out",
        painted->name, painted->engine->name);
}

/* Two layers are mixed while a style replaces another: both must have the shape of the region,
 * which paint that is cut out has not. */
static bool check_keyed(const FlRegionPlan *painted, GError **error)
{
    const FlEngine *engine = painted->engine;
    if (!painted->styles || !engine->reach ||
        engine->reach(painted->style, &painted->settings.params) <= 0)
        return true;
    return fl_fail(error, FL_ERROR_USAGE,
                   "region %s: the paint of %s is cut out, and so it can be no keyed style",
                   painted->name, painted->style->path);
}

/* Lists the files of a region's style before they are read, so that a broken style can be watched.
 */
static void list_style(FlPlan *plan, const char *name)
{
    g_autofree char *path = name ? fl_style_find(name, NULL) : NULL;
    if (path)
        fl_inputs_add_style(plan->inputs, path);
}

bool fl_plan_choose_fluid(FlRegionPlan *painted, bool flow, GError **error)
{
    FlRegionSettings *settings = &painted->settings;
    const bool elsewhere = settings->motion == FL_MOTION_MASKS || flow;
    if (elsewhere && settings->fluid > FL_FLUID_NONE) {
        return fl_fail(error, FL_ERROR_USAGE,
                       "region %s: ‘fluid’ and ‘%s’ both say how paint moves; use one of them",
                       painted->name, flow ? "flow" : "motion masks");
    }
    if (settings->fluid == FL_FLUID_STYLE)
        settings->fluid = elsewhere ? FL_FLUID_NONE : MAX(painted->style->fluid, FL_FLUID_NONE);
    if (isnan(settings->wetness)) // patches, which keep to the paper, get blurred by all of it
        settings->wetness = painted->engine->enlarges ? .5 : 1;
    return true;
}

static const char *const map_names[FL_MAPS] = {"map-carry", "map-strength", "map-wash",
                                               "map-calm",  "map-front",    "map-stain"};

/* The map of a region's dial: that of a pattern with {region} may be missing, which leaves the
 * dial as it is. */
static bool open_map(FlPlan *plan, FlRegionPlan *painted, int k, GError **error)
{
    g_auto(GStrv) parts = g_strsplit(painted->settings.map[k], "{region}", -1);
    g_autofree char *pattern = g_strjoinv(painted->name, parts);
    FlControlMap *map = g_hash_table_lookup(plan->maps, pattern);
    g_autoptr(GError) problem = NULL;
    fl_inputs_add(plan->inputs, pattern); // pictures may come and go
    if (!map && (map = fl_control_map_open(pattern, &problem)))
        g_hash_table_insert(plan->maps, g_strdup(pattern), map);
    if (!map && !(parts[1] && g_error_matches(problem, FL_ERROR, FL_ERROR_INPUT))) {
        g_propagate_prefixed_error(error, g_steal_pointer(&problem),
                                   "region %s: ‘%s’: ", painted->name, map_names[k]);
        return false;
    }
    for (const char *const *file = map ? fl_control_map_files(map) : NULL; file && *file; file++)
        fl_inputs_add(plan->inputs, *file);
    painted->map[k] = map;
    return true;
}

/* Finds the control maps of a region, whose engine must read them. */
static bool open_maps(FlPlan *plan, FlRegionPlan *painted, GError **error)
{
    const FlRegionSettings *settings = &painted->settings;
    const FlEngine *engine = painted->engine;
    const bool misses[FL_MAPS] = {
        [FL_MAP_CARRY] = !engine->enlarges, [FL_MAP_STRENGTH] = engine->plays};
    for (int k = 0; k < FL_MAPS; k++) {
        if (!settings->map[k])
            continue;
        if (misses[k])
            return fl_fail(error, FL_ERROR_USAGE,
                           "region %s: ‘%s’: the engine %s has no such dial; expected %s",
                           painted->name, map_names[k], engine->name,
                           k == FL_MAP_CARRY ? "patch" : "transport");
        if (!open_map(plan, painted, k, error))
            return false;
    }
    return true;
}

/* Checks that a pattern with {region} has the pictures of some region. */
static bool check_maps(const FlShapes *shapes, GError **error)
{
    for (int k = 0; k < FL_MAPS; k++) {
        const char *wanted = NULL;
        bool found = false;
        for (int p = 0; p < shapes->n_painted; p++) {
            wanted =
                shapes->painted[p].settings.map[k] ? shapes->painted[p].settings.map[k] : wanted;
            found = found || shapes->painted[p].map[k];
        }
        if (wanted && !found)
            return fl_fail(error, FL_ERROR_INPUT,
                           "%s: no region has such a picture; expected that of some region",
                           wanted);
    }
    return true;
}

static bool choose_style(FlPlan *plan, FlRegionPlan *painted, GError **error)
{
    const FlRegion *r = fl_drawing_region(plan->shapes.drawing, painted->region);
    painted->area_px = r->area_px;
    painted->flow_files = plan->options.flow;
    painted->paint_files = plan->out.merge ? plan->out.paint : NULL;
    painted->loops = plan->options.loop && !painted->paint_files;
    const float px = texture_px(plan, &painted->settings.params);
    fl_params_scale_lengths(&painted->settings.params, px);
    list_style(plan, painted->settings.style);
    painted->style = fl_style_cache_get(plan->styles, &painted->settings, px, error);
    if (!painted->style) {
        g_autofree char *word = g_strconcat("style=", painted->settings.style, NULL);
        if (r->label && strstr(r->label, word))
            g_prefix_error(error, "layer “%s”: ", r->label);
        return false;
    }
    if (fl_field_px(painted->style->exemplar) == 2)
        fl_params_scale_lengths(&painted->settings.params, .5f);
    painted->engine = fl_engine_choose(painted->settings.engine, painted->style->path);
    if (!fl_plan_choose_fluid(painted, plan->options.flow, error) || !check_keyed(painted, error) ||
        !open_maps(plan, painted, error) || !check_export(plan, painted, error) ||
        !warn_of_style(plan, painted, error))
        return false;
    if (plan->options.verbose)
        fl_note(&plan->caller, "region %s: style %s, engine %s", r->name, painted->style->path,
                painted->engine->name);
    return true;
}

bool fl_plan_choose_styles(FlPlan *plan, GError **error)
{
    FlShapes *shapes = &plan->shapes;
    const int n_regions = fl_drawing_regions(shapes->drawing);
    if (!fl_shapes_find_ground(shapes, plan->options.camera, error))
        return false;
    shapes->surround =
        fl_surround_new(n_regions, shapes->n_frames, shapes->width, shapes->height, error);
    shapes->masks = shapes->surround ? fl_surround_masks(shapes->surround) : NULL;
    for (int p = 0; shapes->surround && p < shapes->n_painted; p++)
        if (!choose_style(plan, &shapes->painted[p], error))
            return false;
    if (!check_maps(shapes, error) || !warn_of_borders(plan, error))
        return false;
    memset(plan->paper, 255, sizeof plan->paper);
    plan->sheet = (FlSheetStyle)FL_SHEET_DEFAULTS;
    if (shapes->n_painted > 0 && shapes->surround) {
        plan->sheet = shapes->painted[0].style->sheet;
        memcpy(plan->paper, shapes->painted[0].style->paper, sizeof plan->paper);
    }
    return shapes->surround != NULL;
}
