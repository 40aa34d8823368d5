#include "job/plan.h"
#include "job/region_plan.h"

#include "io/pattern.h"
#include "io/picture_file.h"

/* ---- files ----------------------------------------------------------------------------------- */

/* The folder of a film may move; the names in it may not. */
static void add_file(FlFacts *facts, FlInputs *inputs, const char *path)
{
    g_autofree char *name = g_path_get_basename(path);
    fl_facts_add_digest(facts, name, fl_inputs_digest(inputs, path));
}

static void add_style(FlFacts *facts, FlInputs *inputs, const char *path)
{
    g_autofree char *base = g_path_get_basename(path);
    g_autofree char *name = g_strconcat("style ", base, NULL);
    fl_facts_add_digest(facts, name, fl_inputs_digest_of_style(inputs, path));
}

static bool frames_share_a_file(const FlDrawing *drawing)
{
    return fl_drawing_frames(drawing) > 1 &&
           g_str_equal(fl_drawing_file(drawing, 0), fl_drawing_file(drawing, 1));
}

/* The files of the frames, and those that they refer to. */
static void add_drawings(FlFacts *facts, const FlPlan *plan)
{
    const FlDrawing *drawing = plan->shapes.drawing;
    g_autofree const char **linked = fl_drawing_linked_files(drawing);
    fl_facts_add_number(facts, "the number of frames", fl_drawing_frames(drawing));
    for (int f = 0; f < fl_drawing_frames(drawing); f++)
        add_file(facts, plan->inputs, fl_drawing_file(drawing, f));
    for (const char **path = linked; *path; path++)
        add_file(facts, plan->inputs, *path);
    if (frames_share_a_file(drawing)) // they may be moments of it
        fl_facts_add_number(facts, "fps", plan->out.fps);
}

/* The files of the frames before the first one, which wet the paper and move fluids. */
static void add_earlier(FlFacts *facts, const FlPlan *plan)
{
    for (int k = fl_plan_earliest(plan); k < fl_drawing_earlier(plan->shapes.drawing); k++)
        add_file(facts, plan->inputs, fl_drawing_found_files(plan->shapes.drawing)[k]);
}

/* The files of an option that may name one for each frame; what is missing is told when it is
 * opened. */
static void add_pattern(FlFacts *facts, const FlShapes *shapes, FlInputs *inputs,
                        const char *pattern, const char *region)
{
    const bool each = fl_input_is_pattern(pattern);
    FlDigest sum = {0};
    for (int f = 0; f < (each ? shapes->n_frames : 1); f++) {
        g_autofree char *file =
            each ? fl_output_name(pattern, fl_drawing_number(shapes->drawing, f), region, NULL)
                 : g_strdup(pattern);
        const FlDigest digest = file ? fl_inputs_digest(inputs, file) : (FlDigest){0};
        fl_digest_add(&sum, &digest, sizeof digest);
    }
    fl_facts_add_digest(facts, pattern, sum);
}

/* ---- the whole plan -------------------------------------------------------------------------- */

void fl_facts_add_options(FlFacts *facts, FlOptionScope scope, const void *object,
                          const char *region, bool of_frames)
{
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (option->scope != scope ||
            (option->bytes != FL_BYTES_VALUE && !(of_frames && option->bytes == FL_BYTES_FRAME)))
            continue;
        g_autofree char *value = fl_option_get(option, object);
        // the folder of a style may move; its contents may not change
        const bool moves = option->type == FL_OPTION_STYLE || option->type == FL_OPTION_MAP;
        g_autofree char *base = value && moves ? g_path_get_basename(value) : NULL;
        g_autofree char *name =
            region ? g_strdup_printf("%s of region %s", option->name, region) : NULL;
        fl_facts_add(facts, name ? name : option->name, base ? base : value);
    }
}

/* The pictures of a region's control maps: of all, or of those that decide its paint. */
static void add_maps(FlFacts *facts, const FlRegionPlan *painted, FlInputs *inputs, bool of_frames)
{
    for (int k = 0; k < FL_MAPS; k++) {
        FlDigest sum = {0};
        if (!painted->map[k] || (!of_frames && k != FL_MAP_CARRY && k != FL_MAP_STRENGTH))
            continue;
        for (const char *const *file = fl_control_map_files(painted->map[k]); *file; file++) {
            const FlDigest digest = fl_inputs_digest(inputs, *file);
            g_autofree char *name = g_path_get_basename(*file); // its number is in it
            fl_digest_add_text(&sum, name);
            fl_digest_add(&sum, &digest, sizeof digest);
        }
        g_autofree char *base = g_path_get_basename(painted->settings.map[k]);
        fl_facts_add_digest(facts, base, sum);
    }
}

/* The results of options, then their values. */
static void add_options(FlFacts *facts, const FlPlan *plan)
{
    const FlShapes *shapes = &plan->shapes;
    fl_facts_add(facts, "the format", plan->out.format->name);
    fl_facts_add_number(facts, "the first frame's number", fl_drawing_number(shapes->drawing, 0));
    fl_facts_add_number(facts, "the width", shapes->page_width);
    fl_facts_add_number(facts, "the height", shapes->page_height);
    fl_facts_add_number(facts, "the hold", shapes->hold);
    fl_facts_add_options(facts, FL_SCOPE_RENDER, &plan->options, NULL, true);
}

static void add_painted(FlFacts *facts, const FlPlan *plan)
{
    const FlShapes *shapes = &plan->shapes;
    for (int p = 0; p < shapes->n_painted; p++) {
        const FlRegionPlan *painted = &shapes->painted[p];
        fl_facts_add_options(facts, FL_SCOPE_REGION, &painted->settings, painted->name, true);
        add_maps(facts, painted, plan->inputs, true);
        if (painted->flow_files)
            add_pattern(facts, shapes, plan->inputs, painted->flow_files, painted->name);
        if (painted->paint_files)
            add_pattern(facts, shapes, plan->inputs, painted->paint_files, painted->name);
        bool known = false;
        for (int q = 0; q < p; q++)
            known = known || g_str_equal(shapes->painted[q].style->path, painted->style->path);
        if (!known)
            add_style(facts, plan->inputs, painted->style->path);
    }
}

/* The figures of a region show of which leaves it is made. */
static void add_leaves(FlFacts *facts, const FlRegion *region)
{
    char area[G_ASCII_DTOSTR_BUF_SIZE];
    g_autofree char *name = g_strdup_printf("what region %s is made of", region->name);
    g_autofree char *value =
        g_strdup_printf("%s, %s, %d leaves in %d frames from %d on, %s px", region->label,
                        region->paint, region->n_leaves, region->n_present, region->first_frame,
                        g_ascii_dtostr(area, sizeof area, region->area_px));
    fl_facts_add(facts, name, value);
}

static void add_regions(FlFacts *facts, const FlPlan *plan)
{
    const FlShapes *shapes = &plan->shapes;
    for (int r = 0; r < fl_drawing_regions(shapes->drawing); r++) {
        const FlRegion *region = fl_drawing_region(shapes->drawing, r);
        g_autofree char *name = g_strdup_printf("what becomes of region %s", region->name);
        add_leaves(facts, region);
        fl_facts_add(facts, name,
                     shapes->painted_of[r] >= 0                   ? "painted"
                     : shapes->painted_of[r] == FL_DRAWN_AS_IT_IS ? "drawn"
                                                                  : "left out");
        const FlRegionHand hand = shapes->hands[r];
        g_autofree char *line = g_strdup_printf("line and line-boil of region %s", region->name);
        g_autofree char *drawn = g_strdup_printf("%d, %d", hand.line, hand.boil);
        if (hand.line != FL_LINE_PLAIN)
            fl_facts_add(facts, line, drawn);
    }
}

FlFacts *fl_plan_facts(const FlPlan *plan)
{
    FlFacts *facts = fl_facts_new();
    const char *background = plan->options.background, *paper = plan->options.paper;
    fl_facts_add_versions(facts);
    add_options(facts, plan);
    add_drawings(facts, plan);
    add_regions(facts, plan); // last of the drawing, so that a changed file is named as the cause
    add_earlier(facts, plan);
    if (paper && g_file_test(paper, G_FILE_TEST_IS_REGULAR))
        add_file(facts, plan->inputs, paper);
    if (plan->options.directions)
        add_file(facts, plan->inputs, plan->options.directions);
    add_painted(facts, plan);
    if (background && fl_picture_named(background))
        add_pattern(facts, &plan->shapes, plan->inputs, background, NULL);
    return facts;
}

/* ---- the paint of one region ---------------------------------------------------------------- */

/* The build id stands for the code of the method. */
static void add_method(FlFacts *facts, const FlShapes *shapes, const FlRegionPlan *painted)
{
    fl_facts_add_build(facts);
    fl_facts_add_versions(facts);
    fl_facts_add(facts, "the engine", painted->engine->name);
    fl_facts_add_number(facts, "the seed", (double)shapes->seed);
    fl_facts_add(facts, "the region's name", painted->name);
    fl_facts_add_number(facts, "the number of frames", shapes->n_frames);
    fl_facts_add_number(facts, "the width of the paint", shapes->width);
    fl_facts_add_number(facts, "the height of the paint", shapes->height);
}

/* Adds the numbers of frames; without a drawing they count from 1 in every render. */
static void add_numbers(FlFacts *facts, const FlDrawing *drawing)
{
    for (int f = 0; drawing && f < fl_drawing_frames(drawing); f++)
        fl_facts_add_number(facts, "the number of a frame", fl_drawing_number(drawing, f));
}

/* The edges that paint crosses: a guide of depth may reach into all these shapes. */
static void add_edges(FlFacts *facts, const FlShapes *shapes)
{
    g_autoptr(GString) limits = g_string_new(NULL);
    for (int r = 0; r < fl_drawing_regions(shapes->drawing); r++)
        g_string_append_c(limits, (char)('0' + shapes->edge_limits[r]));
    fl_facts_add(facts, "which edges are shared", limits->str);
}

FlFacts *fl_region_facts(const FlShapes *shapes, const FlRegionPlan *region, FlInputs *inputs)
{
    FlFacts *facts = fl_facts_new();
    add_method(facts, shapes, region);
    if (region->styles) {
        fl_facts_add(facts, "the keys of its style", region->styles->text);
        fl_facts_add_number(facts, "which of them it is", region->style_key);
    }
    if (region->settings.keyed || region->styles || region->map[FL_MAP_CARRY] ||
        region->map[FL_MAP_STRENGTH])
        add_numbers(facts, shapes->drawing);
    fl_facts_add_options(facts, FL_SCOPE_REGION, &region->settings, NULL, false);
    add_style(facts, inputs, region->style->path);
    add_maps(facts, region, inputs, false);
    return facts;
}

FlFacts *fl_plan_facts_of_paint(const FlPlan *plan)
{
    FlFacts *facts = fl_facts_new();
    const FlShapes *shapes = &plan->shapes;
    bool flows = false;
    for (int p = 0; p < shapes->n_painted; p++)
        flows = flows || shapes->painted[p].settings.fluid > FL_FLUID_NONE;
    if (flows)
        add_earlier(facts, plan);
    add_drawings(facts, plan);
    add_numbers(facts, shapes->drawing); // by which layers of one file differ
    fl_facts_add_options(facts, FL_SCOPE_RENDER, &plan->options, NULL, false);
    fl_facts_add_number(facts, "the hold", shapes->hold);
    add_edges(facts, shapes);
    for (int r = 0; r < fl_drawing_regions(shapes->drawing); r++)
        add_leaves(facts, fl_drawing_region(shapes->drawing, r));
    return facts;
}

void fl_region_facts_add_flow(FlFacts *facts, const FlShapes *shapes, int p, FlInputs *inputs)
{
    const FlRegionPlan *painted = &shapes->painted[p];
    if (painted->flow_files)
        add_pattern(facts, shapes, inputs, painted->flow_files, painted->name);
}

/* ---- the request ------------------------------------------------------------------------------
 */

/* Those that decide bytes in whatever way; not how frames become a film. */
static void add_requested(FlFacts *facts, const FlPlan *plan)
{
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (option->scope != FL_SCOPE_RENDER || option->bytes == FL_BYTES_NEVER ||
            g_str_equal(option->name, "format") || g_str_equal(option->name, "fps") ||
            g_str_has_prefix(option->name, "audio"))
            continue;
        g_autofree char *value = fl_option_get(option, &plan->options);
        fl_facts_add(facts, option->name, value);
    }
    for (size_t i = 0; i < plan->options.n_settings; i++) {
        const FlSetting *setting = &plan->options.settings[i];
        fl_facts_add(facts, "region", setting->region);
        fl_facts_add(facts, setting->name, setting->value);
    }
}

FlDigest fl_request_digest(const FlPlan *plan, const FlSequence *sequence)
{
    g_autoptr(FlFacts) facts = fl_facts_new();
    g_autofree char *folder = g_get_current_dir(); // relative names begin here
    fl_facts_add_build(facts);
    fl_facts_add_versions(facts);
    fl_facts_add(facts, "the working directory", folder);
    fl_facts_add(facts, "the format", plan->out.format->name);
    add_requested(facts, plan);
    for (int f = 0; f < sequence->n; f++) {
        fl_facts_add_number(facts, sequence->frame[f].file, sequence->frame[f].number);
        fl_facts_add_number(facts, "whether it stands in", sequence->frame[f].stand_in);
        fl_facts_add_number(facts, "the layer", sequence->frame[f].layer);
        fl_facts_add_number(facts, "the moment", sequence->frame[f].seconds);
    }
    return fl_facts_digest(facts);
}
