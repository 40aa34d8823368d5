#include "watercolour/recipe.h"

#include "base/each.h"
#include "base/error.h"
#include "base/limits.h"
#include "params/key_table.h"
#include "style/manifest.h"

#include <string.h>

static FlRecipe *defaults(void)
{
    FlRecipe *recipe = g_new0(FlRecipe, 1);
    *recipe = (FlRecipe){
        .style = fl_style_new(),
        .oversample = 2,
        .steps = {60},
        .warm_up = 1,
        .seed = 1,
        .mask_threshold = 0.02f,
        .mask_blur = 1,
        .paper = {.grain_px = 4,
                  .roughness = 0.6f,
                  .stretch = 1.3f,
                  .fibre_px = 30,
                  .fibre_curl = 1,
                  .capacity = {0.6f, 0.9f},
                  .patchiness = 0.5f,
                  .patch_px = 40,
                  .pinning = 0.3f,
                  .shading = 0.03f},
        .flow = {.sigma = 0.1f, .conduct = 1, .mobility = 1, .settle = 0.2f, .thickness = 2.5f},
        .dust = {.speed_px = 1.5f,
                 .scatter = 0.5f,
                 .swirl = 0.5f,
                 .swirl_px = 30,
                 .catch_rate = 0.3f,
                 .weight = 0.3f,
                 .rim_px = 12},
    };
    FlStyle *style = recipe->style;
    static const uint8_t paper[] = {244, 239, 228};
    style->name = g_strdup("Untitled");
    style->author = g_strdup("fluidy-svg");
    style->licence = g_strdup("CC0-1.0");
    style->missing_orientations = g_strdup("none");
    style->fps = 24, style->border_px = 15;
    memcpy(style->paper, paper, sizeof paper);
    return recipe;
}

void fl_recipe_free(FlRecipe *recipe)
{
    if (!recipe)
        return;
    fl_style_free(recipe->style);
    g_free(recipe);
}

static const FlTableKey recipe_keys[] = {
    {"size", FL_KEY_OF(INTEGER, FlRecipe, width), 16, 4096, 2, 2},
    {"frames", FL_KEY_OF(INTEGER, FlRecipe, frames), 1, 10000},
    {"steps", FL_KEY_OF(INTEGER, FlRecipe, steps), 1, 100000, 1, 2},
    {"warm-up", FL_KEY_OF(INTEGER, FlRecipe, warm_up), 1, 1000000},
    {"oversample", FL_KEY_OF(INTEGER, FlRecipe, oversample), 1, 3},
    {"seed", FL_KEY_OF(INTEGER, FlRecipe, seed), 0, 1 << 24},
    {"mask-threshold", FL_KEY_OF(NUMBER, FlRecipe, mask_threshold), 1e-4, 10},
    {"mask-blur", FL_KEY_OF(NUMBER, FlRecipe, mask_blur), 0, 50},
};

/* size sets both. */
G_STATIC_ASSERT(offsetof(FlRecipe, height) == offsetof(FlRecipe, width) + sizeof(int));

static const FlTableKey paper_keys[] = {
    {"grain", FL_KEY_OF(NUMBER, FlPaper, grain_px), 0.5, 100},
    {"roughness", FL_KEY_OF(NUMBER, FlPaper, roughness), 0, 1},
    {"stretch", FL_KEY_OF(NUMBER, FlPaper, stretch), 0.1, 10},
    {"fibres", FL_KEY_OF(NUMBER, FlPaper, fibres), 0, 100},
    {"fibre-length", FL_KEY_OF(NUMBER, FlPaper, fibre_px), 1, 1000},
    {"fibre-curl", FL_KEY_OF(NUMBER, FlPaper, fibre_curl), 0, 1},
    {"fibre-pull", FL_KEY_OF(NUMBER, FlPaper, fibre_pull), 0, 0.95},
    {"capacity", FL_KEY_OF(NUMBER, FlPaper, capacity), 0.01, 10, 2, 2},
    {"patchiness", FL_KEY_OF(NUMBER, FlPaper, patchiness), 0, 0.95},
    {"patch-size", FL_KEY_OF(NUMBER, FlPaper, patch_px), 1, 1000},
    {"pinning", FL_KEY_OF(NUMBER, FlPaper, pinning), 0, 1},
    {"shading", FL_KEY_OF(NUMBER, FlPaper, shading), 0, 0.2},
};

static const FlTableKey flow_keys[] = {
    {"sigma", FL_KEY_OF(NUMBER, FlFlow, sigma), 0, 1},
    {"conduct", FL_KEY_OF(NUMBER, FlFlow, conduct), 0, 1},
    {"mobility", FL_KEY_OF(INTEGER, FlFlow, mobility), 0, 4},
    {"settle", FL_KEY_OF(NUMBER, FlFlow, settle), 0, 10},
    {"thickness", FL_KEY_OF(NUMBER, FlFlow, thickness), 0, 100},
};

static const FlTableKey dust_keys[] = {
    {"grains", FL_KEY_OF(INTEGER, FlDust, grains), 0, 10000000},
    {"speed", FL_KEY_OF(NUMBER, FlDust, speed_px), 0, 20},
    {"swirl", FL_KEY_OF(NUMBER, FlDust, swirl), 0, 1},
    {"swirl-size", FL_KEY_OF(NUMBER, FlDust, swirl_px), 1, 1000},
    {"scatter", FL_KEY_OF(NUMBER, FlDust, scatter), 0, 10},
    {"lumps", FL_KEY_OF(NUMBER, FlDust, lumps), 0, 1},
    {"catch", FL_KEY_OF(NUMBER, FlDust, catch_rate), 0, 1},
    {"weight", FL_KEY_OF(NUMBER, FlDust, weight), 0, 10},
    {"rim", FL_KEY_OF(NUMBER, FlDust, rim_px), 0, 1000},
};

static const FlTableKey pigment_keys[] = {
    {"absorption", FL_KEY_OF(NUMBER, FlPigment, absorption), 0, 100, 3, 3},
    {"scattering", FL_KEY_OF(NUMBER, FlPigment, scattering), 0, 100, 3, 3},
    {"density", FL_KEY_OF(NUMBER, FlPigment, density), 0, 1},
    {"staining", FL_KEY_OF(NUMBER, FlPigment, staining), 0.01, 1000},
    {"granulation", FL_KEY_OF(NUMBER, FlPigment, granulation), 0, 1},
    {"diffusion", FL_KEY_OF(NUMBER, FlPigment, diffusion), 0, 0.2},
};

static const FlTableKey event_keys[] = {
    {"points", FL_KEY_OF(NUMBER, FlEvent, points), -10000, 10000, 2, 2 * FL_MAX_POINTS},
    {"radius", FL_KEY_OF(NUMBER, FlEvent, radius), 0.5, 10000},
    {"wobble", FL_KEY_OF(NUMBER, FlEvent, wobble), 0, 1000},
    {"wobble-size", FL_KEY_OF(NUMBER, FlEvent, wobble_px), 1, 1000},
    {"growth", FL_KEY_OF(NUMBER, FlEvent, growth), 0, 100},
    {"crinkle", FL_KEY_OF(NUMBER, FlEvent, crinkle), 0, 1},
    {"hand", FL_KEY_OF(INTEGER, FlEvent, hand), 0, 1000},
    {"sweep", FL_KEY_OF(NUMBER, FlEvent, sweep), 0, 2},
    {"sweep-depth", FL_KEY_OF(NUMBER, FlEvent, sweep_px), 1, 1000},
    {"sweep-rim", FL_KEY_OF(NUMBER, FlEvent, sweep_rim_px), 0, 1000},
    {"from", FL_KEY_OF(NUMBER, FlEvent, from), 0, 10000},
    {"until", FL_KEY_OF(NUMBER, FlEvent, until), 0, 10000},
    {"water", FL_KEY_OF(NUMBER, FlEvent, water), 0, 1},
    {"rate", FL_KEY_OF(NUMBER, FlEvent, rate), 0, 1},
    {"load", FL_KEY_OF(NUMBER, FlEvent, load), 0, 10, 1, FL_MAX_PIGMENTS},
    {"streaks", FL_KEY_OF(NUMBER, FlEvent, streaks), 0, 1},
    {"streak-size", FL_KEY_OF(NUMBER, FlEvent, streak_px), 1, 1000},
    {"play", FL_KEY_OF(NUMBER, FlEvent, play), 0, 1},
    {"bristles", FL_KEY_OF(NUMBER, FlEvent, bristles), 0, 1},
    {"bristle-size", FL_KEY_OF(NUMBER, FlEvent, bristle_px), 0.5, 1000, 2, 2},
    {"dry", FL_KEY_OF(NUMBER, FlEvent, dry), 0, 1, 2, 2},
    {"dry-depth", FL_KEY_OF(NUMBER, FlEvent, dry_px), 0.5, 1000},
};

#define TABLE(keys)                                                                                \
    {                                                                                              \
        keys, G_N_ELEMENTS(keys)                                                                   \
    }

static const FlKeyTable recipe_table = TABLE(recipe_keys), paper_table = TABLE(paper_keys),
                        flow_table = TABLE(flow_keys), dust_table = TABLE(dust_keys),
                        pigment_table = TABLE(pigment_keys), event_table = TABLE(event_keys);

/* A section of the file. */
typedef struct Section {
    FlKeySection keys;
    int line;
    char *name; // of keys
} Section;

typedef struct Reader {
    FlRecipe *recipe;
    GArray *sections;
} Reader;

static void clear_section(void *section)
{
    g_free(((Section *)section)->name);
}

/* A pigment of the table, by its name, or one with K and S of its own. */
static FlPigment *begin_pigment(FlRecipe *recipe, const char *name, GError **error)
{
    if (recipe->n_pigments == FL_MAX_PIGMENTS)
        return fl_none(error, FL_ERROR_INPUT, "more than %d pigments", FL_MAX_PIGMENTS);
    FlPigment *pigment = &recipe->pigments[recipe->n_pigments++];
    const FlPigment *known = fl_pigment_find(name);
    *pigment = known ? *known : (FlPigment){.density = .03f, .staining = 3, .granulation = .5f};
    return pigment;
}

static FlEvent *begin_event(FlRecipe *recipe, GError **error)
{
    if (recipe->n_events == FL_MAX_EVENTS)
        return fl_none(error, FL_ERROR_INPUT, "more than %d events", FL_MAX_EVENTS);
    FlEvent *event = &recipe->events[recipe->n_events++];
    *event = (FlEvent){.radius = 10,
                       .wobble_px = 20,
                       .rate = 1,
                       .streak_px = 20,
                       .bristle_px = {4, 60},
                       .dry_px = 10,
                       .sweep_px = 20};
    return event;
}

static bool begin_section(void *data, const char *name, int line, GError **error)
{
    Reader *reader = data;
    FlRecipe *recipe = reader->recipe;
    FlStyle *style = recipe->style;
    const FlKeySection single[] = {
        {"recipe", &recipe_table, recipe},         {"style", &fl_style_table, style},
        {"front", &fl_front_table, &style->front}, {"wash", &fl_wash_table, &style->wash},
        {"sheet", &fl_sheet_table, &style->sheet}, {"paper", &paper_table, &recipe->paper},
        {"flow", &flow_table, &recipe->flow},      {"dust", &dust_table, &recipe->dust}};
    FlKeySection keys = {0};
    for (size_t i = 0; i < G_N_ELEMENTS(single); i++)
        if (strcmp(name, single[i].name) == 0)
            keys = single[i];
    keys.mistake = FL_ERROR_INPUT;
    if (g_str_has_prefix(name, "pigment "))
        keys.table = &pigment_table,
        keys.object = begin_pigment(recipe, name + strlen("pigment "), error);
    else if (g_str_has_prefix(name, "event "))
        keys.table = &event_table, keys.object = begin_event(recipe, error);
    else if (!keys.table)
        return fl_fail(error, FL_ERROR_INPUT,
                       "[%s] is not a group of a recipe: expected recipe, style, front, wash, "
                       "sheet, paper, flow, dust, pigment NAME or event NAME",
                       name);
    const Section section = {keys, line, g_strdup(name)};
    g_array_append_val(reader->sections, section);
    return keys.object != NULL;
}

static bool read_key(void *data, const char *key, const char *value, int line, GError **error)
{
    const Reader *reader = data;
    const guint n = reader->sections->len;
    if (n == 0)
        return fl_fail(error, FL_ERROR_INPUT, "“%s” stands above the first [group]", key);
    Section *section = &g_array_index(reader->sections, Section, n - 1);
    return fl_key_section_set(&section->keys, key, value, error) != NULL;
}

static bool check_recipe(const FlKeySection *keys, GError **error)
{
    FlRecipe *recipe = keys->object;
    const double millions = (double)recipe->width * recipe->height * recipe->frames / 1e6;
    if (!fl_key_section_count(keys, "size"))
        return fl_fail(error, FL_ERROR_INPUT, "size: expected width and height, such as 400 120");
    if (!fl_key_section_count(keys, "frames"))
        return fl_fail(error, FL_ERROR_INPUT, "frames: expected a whole number from 1 to 10000");
    if (recipe->steps[1] == 0)
        recipe->steps[1] = recipe->steps[0];
    return fl_limit_check(FL_LIMIT_STYLE, millions, "size", error);
}

static bool check_pigment(const FlKeySection *keys, const char *name, GError **error)
{
    return fl_pigment_find(name) ||
           (fl_key_section_count(keys, "absorption") && fl_key_section_count(keys, "scattering")) ||
           fl_fail(error, FL_ERROR_INPUT,
                   "is not a known pigment: expected absorption and scattering, three numbers "
                   "each");
}

static bool check_event(const FlKeySection *keys, GError **error)
{
    FlEvent *event = keys->object;
    const int n = fl_key_section_count(keys, "points");
    if (n == 0 || n % 2 != 0)
        return fl_fail(error, FL_ERROR_INPUT, "points: expected pairs of x and y");
    event->n_points = n / 2;
    if (!fl_key_section_count(keys, "until"))
        event->until = event->from;
    return event->until >= event->from ||
           fl_fail(error, FL_ERROR_INPUT, "until: expected a number from %g to 10000",
                   (double)event->from);
}

/* Checks the keys of a section together. */
static bool check_section(const Section *section, const char *path, GError **error)
{
    const FlKeySection *keys = &section->keys;
    const bool good = keys->table == &recipe_table ? check_recipe(keys, error)
                      : keys->table == &pigment_table
                          ? check_pigment(keys, strchr(section->name, ' ') + 1, error)
                      : keys->table == &event_table ? check_event(keys, error)
                                                    : true;
    if (!good)
        g_prefix_error(error, "%s:%d: [%s] ", path, section->line, section->name);
    return good;
}

FlRecipe *fl_recipe_load(const char *path, GError **error)
{
    g_autoptr(FlRecipe) recipe = defaults();
    g_autoptr(GArray) sections = fl_array_of(Section, clear_section);
    Reader reader = {recipe, sections};
    const FlKeyReader calls = {begin_section, read_key, &reader, FL_ERROR_INPUT, NULL};
    if (!fl_key_file_read(path, &calls, error))
        return NULL;
    for (guint i = 0; i < sections->len; i++)
        if (!check_section(&g_array_index(sections, Section, i), path, error))
            return NULL;
    if (recipe->width == 0 || recipe->n_pigments == 0 || recipe->n_events == 0)
        return fl_none(error, FL_ERROR_INPUT,
                       "%s: expected a [recipe] with a size, a [pigment NAME] and an [event NAME]",
                       path);
    return g_steal_pointer(&recipe);
}
