#include "watercolour/recipe.h"

#include "base/limits.h"
#include "params/text.h"
#include "style/style_folder.h"
#include "watercolour/keylines.h"

#include <string.h>

static FlRecipe *defaults(void)
{
    FlRecipe *recipe = g_new0(FlRecipe, 1);
    *recipe = (FlRecipe){
        .name = g_strdup("Untitled"),
        .author = g_strdup("fluidy-svg"),
        .licence = g_strdup("CC0-1.0"),
        .medium = g_strdup("auto"),
        .missing = g_strdup("none"),
        .oversample = 2,
        .fps = 24,
        .border = 15,
        .scale = 1,
        .granulation = FL_GRANULATION,
        .front = FL_FRONT_DEFAULTS,
        .wash = FL_WASH_DEFAULTS,
        .steps = {60, 60},
        .warm_up = 1,
        .seed = 1,
        .mask_threshold = 0.02f,
        .mask_margin = 3,
        .mask_blur = 1,
        .paper = {.colour = {244, 239, 228},
                  .grain_px = 4,
                  .roughness = 0.6f,
                  .stretch = 1.3f,
                  .fibre_px = 30,
                  .fibre_curl = 1,
                  .capacity = {0.6f, 0.9f},
                  .patchiness = 0.5f,
                  .patch_px = 40,
                  .pinning = 0.3f,
                  .shading = 0.03f},
        .flow = {.viscosity = 0.1f,
                 .drag = 0.01f,
                 .slope = 1,
                 .relaxation = 0.1f,
                 .tolerance = 0.01f,
                 .sweeps = 50,
                 .delta = -0.01f,
                 .sigma = 0.1f,
                 .diffusions = 1,
                 .conduct = 1,
                 .mobility = 1,
                 .carry = 1,
                 .settle = 0.2f,
                 .thickness = 2.5f},
        .dust = {.speed_px = 1.5f,
                 .scatter = 0.5f,
                 .swirl = 0.5f,
                 .swirl_px = 30,
                 .catch_rate = 0.3f,
                 .weight = 0.3f,
                 .rim_px = 12},
    };
    return recipe;
}

void fl_recipe_free(FlRecipe *recipe)
{
    if (!recipe)
        return;
    g_free(recipe->name);
    g_free(recipe->character);
    g_free(recipe->author);
    g_free(recipe->licence);
    g_free(recipe->medium);
    g_free(recipe->missing);
    g_free(recipe);
}

static void read_recipe(FlKeyLines *lines, FlRecipe *recipe)
{
    fl_keylines_string(lines, "name", &recipe->name);
    fl_keylines_string(lines, "character", &recipe->character);
    fl_keylines_string(lines, "author", &recipe->author);
    fl_keylines_string(lines, "licence", &recipe->licence);
    fl_keylines_string(lines, "medium", &recipe->medium);
    fl_keylines_string(lines, "missing-orientations", &recipe->missing);
    g_autofree char *word = g_strdup(fl_marks_word(FL_MARKS_AUTO));
    int medium = 0, marks = 0;
    fl_keylines_string(lines, "marks", &word);
    if (!fl_text_choice(word, FL_MARKS_WORDS, &marks))
        fl_keylines_complain(lines, "marks",
                             "marks: “%s”: expected auto, off, charcoal, pastel or brush", word);
    recipe->marks = (FlMarks)marks;
    if (!fl_text_choice(recipe->medium, FL_MEDIUM_WORDS, &medium))
        fl_keylines_complain(lines, "medium",
                             "medium: “%s”: expected auto, transparent, opaque or body",
                             recipe->medium);
    float size[2] = {0}, steps[2];
    if (fl_keylines_floats(lines, "size", 2, 2, 16, 4096, size) == 0)
        fl_keylines_complain(lines, "size", "size: expected width and height, such as 400 120");
    recipe->width = (int)size[0], recipe->height = (int)size[1];
    fl_keylines_int(lines, "frames", 1, 10000, &recipe->frames);
    if (recipe->frames == 0)
        fl_keylines_complain(lines, "frames", "frames: expected a whole number from 1 to 10000");
    const double millions = (double)recipe->width * recipe->height * recipe->frames / 1e6;
    g_autoptr(GError) problem = NULL;
    if (!fl_limit_check(FL_LIMIT_STYLE, millions, "size", &problem))
        fl_keylines_complain(lines, "size", "%s", problem->message);
    const int n = fl_keylines_floats(lines, "steps", 1, 2, 1, 100000, steps);
    for (int i = 0; n > 0 && i < 2; i++)
        recipe->steps[i] = (int)steps[n == 2 ? i : 0];
    fl_keylines_int(lines, "warm-up", 1, 1000000, &recipe->warm_up);
    fl_keylines_int(lines, "oversample", 1, 3, &recipe->oversample);
    int seed = 1;
    fl_keylines_int(lines, "seed", 0, 1 << 24, &seed);
    recipe->seed = (uint64_t)seed;
    fl_keylines_float(lines, "fps", 1, 240, &recipe->fps);
    fl_keylines_float(lines, "border", 1, 1000, &recipe->border);
    fl_keylines_float(lines, "scale", 0.01f, 100, &recipe->scale);
    fl_keylines_float(lines, "granulation", -1, 1, &recipe->granulation);
    fl_keylines_float(lines, "melt", 0, 1, &recipe->melt);
    fl_keylines_float(lines, "mask-threshold", 1e-4f, 10, &recipe->mask_threshold);
    fl_keylines_float(lines, "mask-blur", 0, 50, &recipe->mask_blur);
    fl_keylines_float(lines, "mask-margin", 0, 50, &recipe->mask_margin);
}

static void read_front(FlKeyLines *lines, FlRecipe *recipe)
{
    FlFrontStyle *front = &recipe->front;
    fl_keylines_float(lines, "width", 0, 1, &front->width);
    fl_keylines_float(lines, "stain", 0, 1, &front->stain);
    fl_keylines_float(lines, "film", 0, 1, &front->film);
    fl_keylines_float(lines, "soft", 0, 1, &front->soft);
    fl_keylines_float(lines, "base", 0, 1, &front->base);
    fl_keylines_float(lines, "line", 0, 1, &front->line);
    fl_keylines_float(lines, "fingers", 0, 1, &front->fingers);
    fl_keylines_float(lines, "granulation", 0, 1, &front->granulation);
}

static void read_wash(FlKeyLines *lines, FlRecipe *recipe)
{
    FlWashStyle *wash = &recipe->wash;
    fl_keylines_float(lines, "wash", 0, 2, &wash->wash);
    fl_keylines_float(lines, "passes", 0, 2, &wash->passes);
    fl_keylines_float(lines, "tide", 0, 2, &wash->tide);
    fl_keylines_float(lines, "pool", 0, 2, &wash->pool);
    fl_keylines_float(lines, "blooms", 0, 2, &wash->blooms);
    fl_keylines_float(lines, "hue", 0, 12, &wash->hue);
}

static void read_paper(FlKeyLines *lines, FlRecipe *recipe)
{
    FlPaper *paper = &recipe->paper;
    fl_keylines_colour(lines, "colour", paper->colour);
    fl_keylines_float(lines, "grain", 0.5f, 100, &paper->grain_px);
    fl_keylines_float(lines, "roughness", 0, 1, &paper->roughness);
    fl_keylines_float(lines, "stretch", 0.1f, 10, &paper->stretch);
    fl_keylines_float(lines, "fibres", 0, 100, &paper->fibres);
    fl_keylines_float(lines, "fibre-length", 1, 1000, &paper->fibre_px);
    fl_keylines_float(lines, "fibre-curl", 0, 1, &paper->fibre_curl);
    fl_keylines_float(lines, "fibre-pull", 0, 0.95f, &paper->fibre_pull);
    fl_keylines_floats(lines, "capacity", 2, 2, 0.01f, 10, paper->capacity);
    fl_keylines_float(lines, "patchiness", 0, 0.95f, &paper->patchiness);
    fl_keylines_float(lines, "patch-size", 1, 1000, &paper->patch_px);
    fl_keylines_float(lines, "pinning", 0, 1, &paper->pinning);
    fl_keylines_float(lines, "shading", 0, 0.2f, &paper->shading);
}

static void read_flow(FlKeyLines *lines, FlRecipe *recipe)
{
    FlFlow *flow = &recipe->flow;
    fl_keylines_bool(lines, "shallow-water", &flow->shallow);
    fl_keylines_float(lines, "viscosity", 0, 0.24f, &flow->viscosity);
    fl_keylines_float(lines, "drag", 0, 1, &flow->drag);
    fl_keylines_float(lines, "slope", 0, 10, &flow->slope);
    fl_keylines_float(lines, "relaxation", 0, 0.24f, &flow->relaxation);
    fl_keylines_float(lines, "tolerance", 0, 1, &flow->tolerance);
    fl_keylines_int(lines, "sweeps", 0, 1000, &flow->sweeps);
    fl_keylines_float(lines, "edge-darkening", 0, 1, &flow->edge_darkening);
    fl_keylines_float(lines, "absorb", 0, 1, &flow->absorb);
    fl_keylines_float(lines, "epsilon", 0, 1, &flow->epsilon);
    fl_keylines_float(lines, "delta", -1, 1, &flow->delta);
    fl_keylines_float(lines, "sigma", 0, 1, &flow->sigma);
    fl_keylines_int(lines, "diffusions", 0, 100, &flow->diffusions);
    fl_keylines_float(lines, "conduct", 0, 1, &flow->conduct);
    fl_keylines_int(lines, "mobility", 0, 4, &flow->mobility);
    fl_keylines_float(lines, "carry", 0, 1, &flow->carry);
    fl_keylines_float(lines, "settle", 0, 10, &flow->settle);
    fl_keylines_float(lines, "evaporation", 0, 1, &flow->evaporation);
    fl_keylines_float(lines, "rim-evaporation", 0, 1, &flow->rim_evaporation);
    fl_keylines_float(lines, "thickness", 0, 100, &flow->thickness);
}

static void read_dust(FlKeyLines *lines, FlRecipe *recipe)
{
    FlDust *dust = &recipe->dust;
    fl_keylines_int(lines, "grains", 0, 10000000, &dust->grains);
    fl_keylines_float(lines, "speed", 0, 20, &dust->speed_px);
    fl_keylines_float(lines, "swirl", 0, 1, &dust->swirl);
    fl_keylines_float(lines, "swirl-size", 1, 1000, &dust->swirl_px);
    fl_keylines_float(lines, "scatter", 0, 10, &dust->scatter);
    fl_keylines_float(lines, "lumps", 0, 1, &dust->lumps);
    fl_keylines_float(lines, "catch", 0, 1, &dust->catch_rate);
    fl_keylines_float(lines, "weight", 0, 10, &dust->weight);
    fl_keylines_float(lines, "rim", 0, 1000, &dust->rim_px);
}

/* A pigment of the table, by the name of the group, or one with K and S of its own. */
static void read_pigment(FlKeyLines *lines, FlRecipe *recipe, const char *name)
{
    if (recipe->n_pigments == FL_MAX_PIGMENTS) {
        fl_keylines_complain(lines, "pigment", "more than %d pigments", FL_MAX_PIGMENTS);
        return;
    }
    FlPigment *pigment = &recipe->pigments[recipe->n_pigments++];
    const FlPigment *known = fl_pigment_find(name);
    *pigment = known ? *known : (FlPigment){.density = .03f, .staining = 3, .granulation = .5f};
    const int n = fl_keylines_floats(lines, "absorption", 3, 3, 0, 100, pigment->absorption) +
                  fl_keylines_floats(lines, "scattering", 3, 3, 0, 100, pigment->scattering);
    if (!known && n != 6)
        fl_keylines_complain(lines, "absorption",
                             "is not a known pigment: expected absorption and scattering, three "
                             "numbers each");
    fl_keylines_float(lines, "density", 0, 1, &pigment->density);
    fl_keylines_float(lines, "staining", 0.01f, 1000, &pigment->staining);
    fl_keylines_float(lines, "granulation", 0, 1, &pigment->granulation);
    fl_keylines_float(lines, "diffusion", 0, 0.2f, &pigment->diffusion);
}

static void read_event(FlKeyLines *lines, FlRecipe *recipe)
{
    if (recipe->n_events == FL_MAX_EVENTS) {
        fl_keylines_complain(lines, "event", "more than %d events", FL_MAX_EVENTS);
        return;
    }
    FlEvent *event = &recipe->events[recipe->n_events++];
    *event = (FlEvent){.radius = 10,
                       .wobble_px = 20,
                       .rate = 1,
                       .streak_px = 20,
                       .bristle_px = {4, 60},
                       .dry_px = 10,
                       .sweep_px = 20};
    float flat[2 * FL_MAX_POINTS];
    const int n = fl_keylines_floats(lines, "points", 2, 2 * FL_MAX_POINTS, -10000, 10000, flat);
    if (n == 0 || n % 2 != 0)
        fl_keylines_complain(lines, "points", "points: expected pairs of x and y");
    event->n_points = n / 2;
    memcpy(event->points, flat, sizeof(float) * (size_t)(n / 2 * 2));
    fl_keylines_float(lines, "radius", 0.5f, 10000, &event->radius);
    fl_keylines_float(lines, "wobble", 0, 1000, &event->wobble);
    fl_keylines_float(lines, "wobble-size", 1, 1000, &event->wobble_px);
    fl_keylines_float(lines, "growth", 0, 100, &event->growth);
    fl_keylines_float(lines, "crinkle", 0, 1, &event->crinkle);
    fl_keylines_int(lines, "hand", 0, 1000, &event->hand);
    fl_keylines_float(lines, "sweep", 0, 2, &event->sweep);
    fl_keylines_float(lines, "sweep-depth", 1, 1000, &event->sweep_px);
    fl_keylines_float(lines, "sweep-rim", 0, 1000, &event->sweep_rim_px);
    fl_keylines_float(lines, "from", 0, 10000, &event->from);
    event->until = event->from;
    fl_keylines_float(lines, "until", event->from, 10000, &event->until);
    fl_keylines_float(lines, "water", 0, 1, &event->water);
    fl_keylines_float(lines, "rate", 0, 1, &event->rate);
    fl_keylines_floats(lines, "load", 1, FL_MAX_PIGMENTS, 0, 10, event->load);
    fl_keylines_floats(lines, "deposit", 1, FL_MAX_PIGMENTS, 0, 10, event->deposit);
    fl_keylines_float(lines, "streaks", 0, 1, &event->streaks);
    fl_keylines_float(lines, "streak-size", 1, 1000, &event->streak_px);
    fl_keylines_float(lines, "play", 0, 1, &event->play);
    fl_keylines_float(lines, "bristles", 0, 1, &event->bristles);
    fl_keylines_floats(lines, "bristle-size", 2, 2, 0.5f, 1000, event->bristle_px);
    fl_keylines_floats(lines, "dry", 2, 2, 0, 1, event->dry);
    fl_keylines_float(lines, "dry-depth", 0.5f, 1000, &event->dry_px);
    fl_keylines_float(lines, "pressure", 0, 10, &event->pressure);
}

static bool read_group(FlKeyLines *lines, int group, FlRecipe *recipe, GError **error)
{
    const char *name = fl_keylines_group(lines, group);
    fl_keylines_begin(lines, group);
    if (strcmp(name, "recipe") == 0)
        read_recipe(lines, recipe);
    else if (strcmp(name, "front") == 0)
        read_front(lines, recipe);
    else if (strcmp(name, "wash") == 0)
        read_wash(lines, recipe);
    else if (strcmp(name, "paper") == 0)
        read_paper(lines, recipe);
    else if (strcmp(name, "flow") == 0)
        read_flow(lines, recipe);
    else if (strcmp(name, "dust") == 0)
        read_dust(lines, recipe);
    else if (g_str_has_prefix(name, "pigment "))
        read_pigment(lines, recipe, name + strlen("pigment "));
    else if (g_str_has_prefix(name, "event "))
        read_event(lines, recipe);
    else
        fl_keylines_complain(lines, "",
                             "is not a group of a recipe: expected recipe, front, wash, paper, "
                             "flow, dust, pigment NAME or event NAME");
    return fl_keylines_end(lines, error);
}

FlRecipe *fl_recipe_load(const char *path, GError **error)
{
    g_autoptr(FlKeyLines) lines = fl_keylines_load(path, error);
    if (!lines)
        return NULL;
    g_autoptr(FlRecipe) recipe = defaults();
    for (int i = 0; i < fl_keylines_n_groups(lines); i++)
        if (!read_group(lines, i, recipe, error))
            return NULL;
    if (recipe->width == 0 || recipe->n_pigments == 0 || recipe->n_events == 0) {
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT,
                    "%s: expected a [recipe] with a size, a [pigment NAME] and an [event NAME]",
                    path);
        return NULL;
    }
    return g_steal_pointer(&recipe);
}
