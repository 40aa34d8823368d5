#include "base/error.h"
#include "job/plan.h"

#include "base/page.h"
#include "style/style_folder.h"
#include <math.h>
#include <string.h>

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
    if (!painted->style)
        return false;
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

/* The option that a region names by an older word; NULL: by none. */
static const char *older_word(const FlRegionSettings *settings)
{
    return settings->older_preset   ? "the preset “fluid” is called “lazyfluids-steady” now"
           : !isnan(settings->load) ? "‘load’ is ‘wash’ now, which is five times as much"
           : !isnan(settings->pigments) ? "‘pigments’ is ‘hue’ now, which is 72 times as much"
                                        : NULL;
}

/* Names an older word once. */
static void note_older_word(const FlPlan *plan)
{
    const FlShapes *shapes = &plan->shapes;
    for (int p = 0; p < shapes->n_painted; p++) {
        const char *word = older_word(&shapes->painted[p].settings);
        if (!word)
            continue;
        fl_note(&plan->caller, "region %s: %s; the older word goes with the next release",
                shapes->painted[p].name, word);
        return;
    }
}

bool fl_plan_choose_styles(FlPlan *plan, GError **error)
{
    FlShapes *shapes = &plan->shapes;
    const int n_regions = fl_drawing_regions(shapes->drawing);
    g_free(shapes->ground);
    shapes->ground = g_new0(bool, MAX(n_regions, 1));
    for (int r = 0; r < n_regions; r++)
        shapes->ground[r] = fl_shapes_share_of_page(shapes, r) > FL_GROUND_SHARE;
    shapes->surround =
        fl_surround_new(n_regions, shapes->n_frames, shapes->width, shapes->height, error);
    shapes->masks = shapes->surround ? fl_surround_masks(shapes->surround) : NULL;
    for (int p = 0; shapes->surround && p < shapes->n_painted; p++)
        if (!choose_style(plan, &shapes->painted[p], error))
            return false;
    if (!check_maps(shapes, error) || !warn_of_borders(plan, error))
        return false;
    note_older_word(plan);
    memset(plan->paper, 255, sizeof plan->paper);
    if (shapes->n_painted > 0 && shapes->surround)
        memcpy(plan->paper, shapes->painted[0].style->paper, sizeof plan->paper);
    return shapes->surround != NULL;
}
