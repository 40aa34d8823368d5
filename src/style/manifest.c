#include "style/manifest.h"

#include "base/error.h"

/* A flag says which guess a value replaces. */
static const FlTableKey style_keys[] = {
    {"name", FL_KEY_OF(TEXT, FlStyle, name)},
    {"character", FL_KEY_OF(TEXT, FlStyle, character)},
    {"author", FL_KEY_OF(TEXT, FlStyle, author)},
    {"licence", FL_KEY_OF(TEXT, FlStyle, licence)},
    {"made-by", FL_KEY_OF(TEXT, FlStyle, made_by)},
    {"missing-orientations", FL_KEY_OF(TEXT, FlStyle, missing_orientations)},
    {"fps", FL_KEY_OF(NUMBER, FlStyle, fps), 0.01, 1000, .flag = FL_GUESS_FPS},
    {"border", FL_KEY_OF(NUMBER, FlStyle, border_px), 0.5, 1000, .flag = FL_GUESS_BORDER},
    {"scale", FL_KEY_OF(NUMBER, FlStyle, scale), 0.01, 100},
    {"granulation", FL_KEY_OF(NUMBER, FlStyle, granulation), -1, 1},
    {"melt", FL_KEY_OF(NUMBER, FlStyle, melt), 0, 1},
    {"medium", FL_KEY_OF(WORD, FlStyle, medium), .words = FL_MEDIUM_WORDS},
    {"marks", FL_KEY_OF(WORD, FlStyle, marks), .words = FL_MARKS_WORDS},
    {"fluid", FL_KEY_OF(WORD, FlStyle, fluid), FL_FLUID_NONE, .words = FL_FLUID_KINDS},
    {"paper", FL_KEY_OF(COLOUR, FlStyle, paper), .flag = FL_GUESS_PAPER},
};

static const FlTableKey front_keys[] = {
    {"width", FL_KEY_OF(NUMBER, FlFrontStyle, width), 0, 1},
    {"stain", FL_KEY_OF(NUMBER, FlFrontStyle, stain), 0, 1},
    {"film", FL_KEY_OF(NUMBER, FlFrontStyle, film), 0, 1},
    {"soft", FL_KEY_OF(NUMBER, FlFrontStyle, soft), 0, 1},
    {"base", FL_KEY_OF(NUMBER, FlFrontStyle, base), 0, 1},
    {"line", FL_KEY_OF(NUMBER, FlFrontStyle, line), 0, 1},
    {"fingers", FL_KEY_OF(NUMBER, FlFrontStyle, fingers), 0, 1},
    {"granulation", FL_KEY_OF(NUMBER, FlFrontStyle, granulation), 0, 1},
    {"bleed", FL_KEY_OF(NUMBER, FlFrontStyle, bleed), 0, 1},
};

static const FlTableKey wash_keys[] = {
    {"wash", FL_KEY_OF(NUMBER, FlWashStyle, wash), 0, 2},
    {"passes", FL_KEY_OF(NUMBER, FlWashStyle, passes), 0, 2},
    {"tide", FL_KEY_OF(NUMBER, FlWashStyle, tide), 0, 2},
    {"pool", FL_KEY_OF(NUMBER, FlWashStyle, pool), 0, 2},
    {"blooms", FL_KEY_OF(NUMBER, FlWashStyle, blooms), 0, 2},
    {"calm", FL_KEY_OF(NUMBER, FlWashStyle, calm), 0, 1},
    {"heart", FL_KEY_OF(NUMBER, FlWashStyle, heart), 0, 1},
    {"hue", FL_KEY_OF(NUMBER, FlWashStyle, hue), 0, 12},
};

static const FlTableKey sheet_keys[] = {
    {"grain", FL_KEY_OF(NUMBER, FlSheetStyle, grain), 0.5, 50},
    {"stretch", FL_KEY_OF(NUMBER, FlSheetStyle, stretch), 0.2, 5},
    {"tooth", FL_KEY_OF(NUMBER, FlSheetStyle, tooth), 0, 4},
    {"fibre", FL_KEY_OF(NUMBER, FlSheetStyle, fibre), 0, 4},
    {"relief", FL_KEY_OF(NUMBER, FlSheetStyle, relief), 0, 4},
};

const FlKeyTable fl_style_table = {style_keys, G_N_ELEMENTS(style_keys)};
const FlKeyTable fl_front_table = {front_keys, G_N_ELEMENTS(front_keys)};
const FlKeyTable fl_wash_table = {wash_keys, G_N_ELEMENTS(wash_keys)};
const FlKeyTable fl_sheet_table = {sheet_keys, G_N_ELEMENTS(sheet_keys)};

/* A setting of regions that have this style. */
static bool take_setting(void *settings, const char *name, const char *value, GError **error)
{
    static const char *const others[] = {"style", "fluid", "passthrough", "merge-with", NULL};
    g_autoptr(GError) reason = NULL;
    if (g_strv_contains(others, name) || g_str_has_prefix(name, FL_MAP_OPTION)) // files of a film
        return fl_fail(error, FL_ERROR_STYLE, "%s: a style does not say that of its regions", name);
    return fl_overrides_add(settings, NULL, name, value, NULL, &reason) ||
           fl_fail(error, FL_ERROR_STYLE, "%s", reason->message);
}

bool fl_manifest_read(FlStyle *style, const char *path, GError **error)
{
    FlKeySection sections[] = {{"style", &fl_style_table, style, FL_ERROR_STYLE},
                               {"front", &fl_front_table, &style->front, FL_ERROR_STYLE},
                               {"wash", &fl_wash_table, &style->wash, FL_ERROR_STYLE},
                               {"sheet", &fl_sheet_table, &style->sheet, FL_ERROR_STYLE},
                               {"region", NULL, &style->settings, FL_ERROR_STYLE, take_setting}};
    if (!fl_key_sections_read(path, sections, G_N_ELEMENTS(sections), error))
        return false;
    for (size_t i = 0; i < G_N_ELEMENTS(style_keys); i++)
        style->guessed &= ~(sections[0].n_values[i] > 0 ? style_keys[i].flag : 0);
    return true;
}

/* A section of numbers, unless all of them are as usual. */
static void append_section(const FlKeyTable *table, const void *object, const void *usual,
                           const char *name, GString *text)
{
    g_autoptr(GString) unusual = g_string_new(NULL);
    fl_key_table_write(table, object, usual, 0, unusual);
    if (unusual->len == 0)
        return;
    g_string_append_printf(text, "\n[%s]\n", name);
    fl_key_table_write(table, object, NULL, 0, text);
}

char *fl_manifest_text(const FlStyle *style)
{
    g_autoptr(FlStyle) plain = fl_style_new();
    plain->scale = plain->fps = plain->border_px = -1; // so that they are always written
    GString *text = g_string_new("[style]\n");
    fl_key_table_write(&fl_style_table, style, plain, style->guessed, text);
    append_section(&fl_front_table, &style->front, &plain->front, "front", text);
    append_section(&fl_wash_table, &style->wash, &plain->wash, "wash", text);
    append_section(&fl_sheet_table, &style->sheet, &plain->sheet, "sheet", text);
    for (int k = 0; k < style->settings.n; k++)
        g_string_append_printf(text, "%s%s = %s\n", k == 0 ? "\n[region]\n" : "",
                               style->settings.override[k].key, style->settings.override[k].value);
    return g_string_free(text, FALSE);
}
