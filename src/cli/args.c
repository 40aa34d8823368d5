#include "args.h"

#include "base/suggest.h"
#include "words.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* An option whose value is a number in FlArgs; the range is inclusive. */
static const struct Number {
    const char *name;
    size_t offset;
    enum { AS_INT, AS_DOUBLE, AS_UINT64 } type;
    double min, max;
    const char *unit;
} numbers[] = {
    {"--width", offsetof(FlArgs, render.width), AS_INT, 1, 32767, " px"},
    {"--height", offsetof(FlArgs, render.height), AS_INT, 1, 32767, " px"},
    {"--scale", offsetof(FlArgs, render.scale), AS_DOUBLE, 0.001, 1000, ""},
    {"--dpi", offsetof(FlArgs, render.dpi), AS_DOUBLE, 1, 100000, " px per inch"},
    {"--fps", offsetof(FlArgs, render.fps), AS_DOUBLE, 0.01, 1000, " frames per second"},
    {"--seed", offsetof(FlArgs, render.seed), AS_UINT64, 1, 9007199254740991.0, ""},
    {"--gap", offsetof(FlArgs, render.gap), AS_DOUBLE, 0, 32, " px"},
    {"--feather", offsetof(FlArgs, render.feather), AS_DOUBLE, 0, 32, " px"},
    {"--threads", offsetof(FlArgs, render.threads), AS_INT, 1, 1024, ""},
};

/* An option whose value is a word; the words have the values first, first + 1, … of an enum. */
static const struct Choice {
    const char *name;
    size_t offset;
    int first;
    const char *words[8];
} choices[] = {
    {"--missing", offsetof(FlArgs, render.missing), FL_MISSING_ERROR, {"error", "hold", "skip"}},
    {"--key",
     offsetof(FlArgs, render.key),
     FL_KEY_AUTO,
     {"auto", "fill", "id", "class", "label", "tree"}},
    {"--stroke", offsetof(FlArgs, render.stroke), FL_STROKES_KEEP, {"keep", "paint", "drop"}},
    {"--blend", offsetof(FlArgs, render.blend), FL_BLEND_SRGB, {"srgb", "linear"}},
    {"--progress",
     offsetof(FlArgs, progress),
     FL_PROGRESS_AUTO,
     {"auto", "bar", "plain", "json", "none"}},
};

static const struct Path {
    const char *name;
    size_t offset;
} paths[] = {
    {"--config", offsetof(FlArgs, render.config)},
    {"--frames", offsetof(FlArgs, render.frames)},
    {"--canvas", offsetof(FlArgs, render.canvas)},
    {"--flow", offsetof(FlArgs, render.flow)},
    {"--output", offsetof(FlArgs, render.output)},
    {"--layers", offsetof(FlArgs, render.layers)},
    {"--paint", offsetof(FlArgs, render.paint)},
    {"--background", offsetof(FlArgs, render.background)},
    {"--region", offsetof(FlArgs, render.only_region)},
    {"--report", offsetof(FlArgs, render.report)},
    {"--stats", offsetof(FlArgs, render.stats)},
    {"--dump", offsetof(FlArgs, render.dump)},
};

/* GOption hands a short option to its callback as "-W": these are the long ones. */
static const char *const shorts[][2] = {
    {"-s", "--style"}, {"-c", "--config"}, {"-f", "--frames"},     {"-o", "--output"},
    {"-W", "--width"}, {"-H", "--height"}, {"-b", "--background"}, {"-j", "--threads"},
};

static const char *long_name(const char *name)
{
    for (size_t i = 0; i < G_N_ELEMENTS(shorts); i++)
        if (strcmp(shorts[i][0], name) == 0)
            return shorts[i][1];
    return name;
}

static const char *keep(FlArgs *args, const char *text)
{
    char *copy = g_strdup(text);
    g_ptr_array_add(args->strings, copy);
    return copy;
}

static gboolean read_number(const char *name, const char *value, gpointer data, GError **error)
{
    const struct Number *n = numbers;
    while (strcmp(n->name, long_name(name)) != 0)
        n++;
    char *end = NULL;
    const double number = g_ascii_strtod(value, &end);
    const bool whole = n->type == AS_DOUBLE || number == floor(number);
    if (end == value || *end || !(number >= n->min && number <= n->max) || !whole) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "%s: “%s” is not %s from %g to %.16g%s", name,
                    value, n->type == AS_DOUBLE ? "a number" : "an integer", n->min, n->max,
                    n->unit);
        return FALSE;
    }
    void *const field = (char *)data + n->offset;
    if (n->type == AS_INT)
        *(int *)field = (int)number;
    else if (n->type == AS_DOUBLE)
        *(double *)field = number > 0 ? number : -1; // 0 is said, and wins over the config
    else
        *(uint64_t *)field = (uint64_t)number;
    return TRUE;
}

static gboolean read_choice(const char *name, const char *value, gpointer data, GError **error)
{
    const struct Choice *c = choices;
    while (strcmp(c->name, name) != 0)
        c++;
    for (int i = 0; c->words[i]; i++)
        if (strcmp(c->words[i], value) == 0) {
            *(int *)((char *)data + c->offset) = c->first + i;
            return TRUE;
        }
    g_autofree char *words = g_strjoinv(", ", (char **)c->words);
    g_autofree char *hint = fl_did_you_mean(value, c->words);
    g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "%s: “%s” is not one of %s%s", name, value, words,
                hint);
    return FALSE;
}

static gboolean read_path(const char *name, const char *value, gpointer data, GError **error)
{
    const struct Path *p = paths;
    while (strcmp(p->name, long_name(name)) != 0)
        p++;
    if (!*value) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "%s: the value is missing", name);
        return FALSE;
    }
    *(const char **)((char *)data + p->offset) = keep(data, value);
    return TRUE;
}

/* Of the list of regions, or else of the output; the library knows the latter. */
static gboolean read_format(const char *name, const char *value, gpointer data, GError **error)
{
    FlArgs *args = data;
    if (strcmp(value, "table") == 0)
        args->listing = FL_LISTING_TABLE;
    else if (strcmp(value, "config") == 0)
        args->listing = FL_LISTING_CONFIG;
    else
        args->render.format = keep(args, value);
    return TRUE;
}

/* What a [region] section could say as well; the library checks it, as it checks the config. */
static gboolean read_setting(const char *name, const char *value, gpointer data, GError **error)
{
    FlArgs *args = data;
    const FlSetting setting = {.name = keep(args, long_name(name) + 2), .value = keep(args, value)};
    g_array_append_val(args->settings, setting);
    return TRUE;
}

static gboolean read_limit(const char *name, const char *value, gpointer data, GError **error)
{
    return fl_limit_set(value, error);
}

/* A number of frames around one, drafts of which the next preview may replace. */
static gboolean read_preview(const char *name, const char *value, gpointer data, GError **error)
{
    FlArgs *args = data;
    char *end = NULL;
    const gint64 number = g_ascii_strtoll(value, &end, 10);
    if (!g_ascii_isdigit(*value) || *end || number > G_MAXINT / 2) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "%s: “%s” is not the number of a frame", name,
                    value);
        return FALSE;
    }
    g_autofree char *range = g_strdup_printf("%s~1", value);
    args->preview = keep(args, range);
    return TRUE;
}

static gboolean read_styles(const char *name, const char *value, gpointer data, GError **error)
{
    FlArgs *args = data;
    g_strfreev(args->styles);
    args->styles = NULL;
    args->task = FL_COMMAND_COMPARE;
    if (strcmp(value, "all") == 0)
        return TRUE;
    args->styles = g_strsplit(value, ",", -1);
    for (int i = 0; args->styles[i] && *value; i++)
        if (!*args->styles[i])
            value = "";
    if (!*value)
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "%s: expected names with commas between, such as 01,03, or all", name);
    return *value != '\0';
}

static gboolean read_flag(const char *name, const char *value, gpointer data, GError **error)
{
    FlArgs *args = data;
    static const struct {
        const char *name;
        FlCommand task;
    } tasks[] = {
        {"-h", FL_COMMAND_HELP},
        {"--help", FL_COMMAND_HELP},
        {"--help-all", FL_COMMAND_HELP_ALL},
        {"--list-regions", FL_COMMAND_LIST_REGIONS},
        {"--list-styles", FL_COMMAND_LIST_STYLES},
        {"--check", FL_COMMAND_CHECK},
        {"-V", FL_COMMAND_VERSION},
        {"--version", FL_COMMAND_VERSION},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(tasks); i++)
        if (strcmp(tasks[i].name, name) == 0)
            args->task = tasks[i].task;
    if (strcmp(name, "-q") == 0 || strcmp(name, "--quiet") == 0)
        args->quiet = true;
    if (strcmp(name, "-v") == 0 || strcmp(name, "--verbose") == 0)
        args->render.verbose = true;
    if (strcmp(name, "--dry-run") == 0)
        args->render.dry_run = true;
    if (strcmp(name, "--no-frames") == 0)
        args->render.no_frames = true;
    if (strcmp(name, "--merge") == 0)
        args->render.merge = true;
    if (strcmp(name, "--loop") == 0)
        args->render.loop = true;
    if (strcmp(name, "--register") == 0)
        args->render.registration = FL_REGISTRATION_ON;
    if (strcmp(name, "--strict") == 0)
        args->render.strict = true;
    if (strcmp(name, "--resume") == 0)
        args->render.resume = true;
    return TRUE;
}

static gboolean read_overwrite(const char *name, const char *value, gpointer data, GError **error)
{
    FlArgs *args = data;
    const FlOverwrite wanted =
        strcmp(name, "--no-clobber") == 0 ? FL_OVERWRITE_KEEP : FL_OVERWRITE_YES;
    if (args->render.overwrite != FL_OVERWRITE_REFUSE && args->render.overwrite != wanted) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "--overwrite and --no-clobber contradict each other");
        return FALSE;
    }
    args->render.overwrite = wanted;
    return TRUE;
}

/* ---- the options ------------------------------------------------------------------------- */

// Values stay the bytes that were typed, whatever the locale.
#define VALUE(reader) G_OPTION_FLAG_FILENAME, G_OPTION_ARG_CALLBACK, (gpointer)(reader)
#define FLAG(reader) G_OPTION_FLAG_NO_ARG, G_OPTION_ARG_CALLBACK, (gpointer)(reader)

static const GOptionEntry common[] = {
    {"style", 's', VALUE(read_setting), "paint every region with this exemplar", "NAME|DIR"},
    {"config", 'c', VALUE(read_path), "which region is painted how", "FILE"},
    {"frames", 'f', VALUE(read_path), "such as 1001-1096, 1-96x2 or 1,5,9 (all)", "RANGE"},
    {"output", 'o', VALUE(read_path), "(fluidy/{name}_%04d.png); or a film, .mov …",
     "PATTERN|FILE"},
    {"width", 'W', VALUE(read_number), "width of the output, aspect kept", "PX"},
    {"background", 'b', VALUE(read_path), "#RRGGBB, none or an image (the paper)", "COLOUR|FILE"},
    {"fps", 0, VALUE(read_number), "frames per second of a film (24)", "RATE"},
    {"hold", 0, VALUE(read_setting), "paint every n-th frame; 2: on twos (1)", "N"},
    {"loop", 0, FLAG(read_flag), "let the end lead into the beginning", NULL},
    {"detail", 0, VALUE(read_setting), "draft, normal or fine (normal)", "WORD"},
    {"preview", 0, VALUE(read_preview), "draft of frame N and those beside it", "N"},
    {"styles", 0, VALUE(read_styles), "a sheet of several styles: 01,03 or all", "NAME,…"},
    {"report", 0, VALUE(read_path), "also write a page to look at, DIR/index.html", "DIR"},
    {"overwrite", 'y', FLAG(read_overwrite), "replace files that exist", NULL},
    {"list-regions", 0, FLAG(read_flag), "print what the drawing is made of", NULL},
    {"list-styles", 0, FLAG(read_flag), "print the styles; -o FILE.png draws them", NULL},
    {"check", 0, FLAG(read_flag), "write maps of the regions instead of paint", NULL},
    {"dry-run", 0, FLAG(read_flag), "check everything, paint nothing", NULL},
    {"quiet", 'q', FLAG(read_flag), "errors only", NULL},
    {"help", 'h', FLAG(read_flag), "this page", NULL},
    {"help-all", 0, FLAG(read_flag), "all options", NULL},
    {NULL},
};

static const GOptionEntry input[] = {
    {"missing", 0, VALUE(read_choice), "a gap in the numbers: error, hold or skip (error)", "WORD"},
    {"canvas", 0, VALUE(read_path), "size of drawings that have none", "WxH[+X+Y]"},
    {"register", 0, FLAG(read_flag), "move frames back that begin at 0,0, as OpenToonz writes them",
     NULL},
    {"dpi", 0, VALUE(read_number), "pixels per inch of drawings sized in mm or in (96)", "N"},
    {"key", 0, VALUE(read_choice),
     "what makes leaves one region: auto, fill, id, class, label or tree (auto)", "WORD"},
    {"flow", 0, VALUE(read_path), "flow fields instead of those made from the masks", "PATTERN"},
    {"limit", 0, VALUE(read_limit), "how much a file may ask for; see TRUST in fluidy-svg(1)",
     "NAME=N"},
    {"strict", 0, FLAG(read_flag), "a warning is an error", NULL},
    {NULL},
};

static const GOptionEntry paint[] = {
    {"tint", 0, VALUE(read_setting), "fill, keep or #RRGGBB (fill)", "TINT"},
    {"stacking", 0, VALUE(read_setting), "knockout or glaze what lies below (knockout)", "WORD"},
    {"edges", 0, VALUE(read_setting), "paint closed or soft at edges that shapes share (closed)",
     "WORD"},
    {"stroke", 0, VALUE(read_choice), "keep, paint or drop line art (keep)", "WORD"},
    {"gap", 0, VALUE(read_number), "paper left around a region that hides others (0)", "PX"},
    {"feather", 0, VALUE(read_number), "fade paint towards such a region (0)", "PX"},
    {"blend", 0, VALUE(read_choice), "layers in srgb or in linear light (srgb)", "WORD"},
    {"region", 0, VALUE(read_path), "paint this region alone", "NAME"},
    {"seed", 0, VALUE(read_number), "same seed, same bytes (1)", "N"},
    {NULL},
};

static const GOptionEntry output[] = {
    {"format", 0, VALUE(read_format), "as png16, exr, ora, mov; of that list: config", "WORD"},
    {"no-frames", 0, FLAG(read_flag), "write a film without keeping its frames", NULL},
    {"layers", 0, VALUE(read_path), "also one file per {region} and frame", "PATTERN"},
    {"paint", 0, VALUE(read_path), "also the paint of each {region}, before colours", "PATTERN"},
    {"merge", 0, FLAG(read_flag), "compose the files of --paint instead of painting", NULL},
    {"height", 'H', VALUE(read_number), "height of the output, aspect kept", "PX"},
    {"scale", 0, VALUE(read_number), "output pixels per drawing pixel (1)", "FACTOR"},
    {"no-clobber", 0, FLAG(read_overwrite), "keep files that exist", NULL},
    {"resume", 0, FLAG(read_flag), "go on with an interrupted render, also with -y", NULL},
    {"stats", 0, VALUE(read_path), "JSON lines about every frame, region and level", "FILE"},
    {"dump", 0, VALUE(read_path), "guides and fields as pictures and raw data", "DIR"},
    {NULL},
};

static const GOptionEntry running[] = {
    {"threads", 'j', VALUE(read_number), "(one per processor)", "N"},
    {"verbose", 'v', FLAG(read_flag), "say what is being done", NULL},
    {"progress", 0, VALUE(read_choice), "auto, bar, plain, json or none (auto)", "WORD"},
    {"version", 'V', FLAG(read_flag), "name and version", NULL},
    {NULL},
};

static const GOptionEntry presets[] = {
    {"preset", 0, VALUE(read_setting),
     "set all of the parameters below: default, fluidymation or thesis (default)", "WORD"},
    {NULL},
};

static char *parameter_help(const FlParamInfo *info)
{
    if (info->type == FL_PARAM_BOOL)
        return g_strdup_printf("%s (%s)", info->help, info->preset_default);
    return g_strdup_printf("%s (%s; %g to %g%s%s)", info->help, info->preset_default, info->min,
                           info->max, *info->unit ? " " : "", info->unit);
}

/* One entry per line of params.def; the strings live as long as the program. */
static const GOptionEntry *parameter_entries(void)
{
    static const char *const values[] = {"N", "X", "on|off", "N,…"};
    static GOptionEntry *entries;
    if (entries)
        return entries;
    entries = g_new0(GOptionEntry, fl_param_count() + 1);
    for (int i = 0; i < fl_param_count(); i++) {
        const FlParamInfo *info = fl_param_info(i);
        g_autofree char *help = parameter_help(info);
        entries[i] = (GOptionEntry){info->name, 0, VALUE(read_setting), g_intern_string(help),
                                    values[info->type]};
    }
    return entries;
}

const FlArgGroup *fl_args_groups(void)
{
    static FlArgGroup groups[] = {{"Options", common},
                                  {"More about the input", input},
                                  {"More about the paint", paint},
                                  {"More about the output", output},
                                  {"Running", running},
                                  {"Presets of the parameters of the synthesis", presets},
                                  {"Parameters of the synthesis", NULL},
                                  {NULL, NULL}};
    groups[G_N_ELEMENTS(groups) - 2].entries = parameter_entries();
    return groups;
}

static GOptionContext *new_context(FlArgs *args)
{
    GOptionContext *context = g_option_context_new(NULL);
    GOptionGroup *all = g_option_group_new("", "", "", args, NULL);
    g_option_context_set_help_enabled(context, FALSE);
    for (const FlArgGroup *g = fl_args_groups(); g->entries; g++)
        g_option_group_add_entries(all, g->entries);
    g_option_context_set_main_group(context, all);
    return context;
}

/* "fill|keep|#RRGGBB" as "fill keep"; NULL if no word is left. */
static char *words_of(const char *form)
{
    g_auto(GStrv) parts = g_strsplit(form, "|", -1);
    g_autoptr(GString) words = g_string_new(NULL);
    for (char **part = parts; *part && parts[1]; part++)
        if (g_ascii_islower(**part))
            g_string_append_printf(words, "%s%s", words->len ? " " : "", *part);
    return words->len ? g_string_free(g_steal_pointer(&words), FALSE) : NULL;
}

char *fl_args_words(const char *long_name)
{
#define FL_SETTING(type, field, form, preset, help) {#field, form},
    static const char *const forms[][2] = {
#include "params/settings.def"
        {"preset", "default|fluidymation|thesis"},
        {"format", "png|png16|exr|ora|mov|webm|mkv|mp4|gif|apng|table|config"},
    };
#undef FL_SETTING
    for (size_t i = 0; i < G_N_ELEMENTS(choices); i++)
        if (strcmp(choices[i].name + 2, long_name) == 0)
            return g_strjoinv(" ", (char **)choices[i].words);
    for (size_t i = 0; i < G_N_ELEMENTS(forms); i++)
        if (strcmp(forms[i][0], long_name) == 0)
            return words_of(forms[i][1]);
    const int p = fl_param_find(long_name);
    return p >= 0 && fl_param_info(p)->type == FL_PARAM_BOOL ? g_strdup("on off") : NULL;
}

/* ---- reading ------------------------------------------------------------------------------ */

/* GOption reads "-j 4" but not "-j4". Returns: to be freed with g_strfreev(). */
static char **split_values(int argc, char **argv)
{
    GPtrArray *words = g_ptr_array_new();
    bool options = true;
    for (int i = 0; i < argc; i++) {
        const char *word = argv[i];
        options = options && strcmp(word, "--") != 0;
        bool joined = false;
        for (size_t k = 0; options && i > 0 && k < G_N_ELEMENTS(shorts); k++)
            joined |= strncmp(word, shorts[k][0], 2) == 0 && word[2] != '\0';
        if (joined)
            g_ptr_array_add(words, g_strndup(word, 2));
        g_ptr_array_add(words, g_strdup(joined ? word + 2 : word));
    }
    g_ptr_array_add(words, NULL);
    return (char **)g_ptr_array_free(words, FALSE);
}

static bool needs_input(FlCommand task)
{
    return task == FL_COMMAND_RENDER || task == FL_COMMAND_LIST_REGIONS ||
           task == FL_COMMAND_CHECK || task == FL_COMMAND_COMPARE;
}

/* What is tried out is painted fast, and replaces what was tried out before. */
static bool make_preview(FlArgs *args, GError **error)
{
    const FlSetting draft = {.name = "detail", .value = "draft"};
    g_array_prepend_val(args->settings, draft); // so that --detail wins
    if (args->preview && args->render.frames) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "--preview and --frames contradict each other");
        return false;
    }
    if (args->preview)
        args->render.frames = args->preview;
    if (args->render.output)
        return true;
    args->render.overwrite = FL_OVERWRITE_YES;
    if (args->task == FL_COMMAND_RENDER && !args->render.format)
        args->render.output = "fluidy/{name}_preview_%04d.png";
    return true;
}

bool fl_args_parse(FlArgs *args, int argc, char **argv, GError **error)
{
    *args = (FlArgs){.settings = g_array_new(FALSE, TRUE, sizeof(FlSetting)),
                     .strings = g_ptr_array_new_with_free_func(g_free)};
    g_autoptr(GOptionContext) context = new_context(args);
    args->inputs = split_values(argc, argv); // GOption takes out what it knows
    GError *problem = NULL;
    if (!g_option_context_parse_strv(context, &args->inputs, &problem)) {
        if (g_error_matches(problem, G_OPTION_ERROR, G_OPTION_ERROR_UNKNOWN_OPTION))
            fl_args_suggest(&problem);
        g_propagate_error(error, problem);
        return false;
    }
    fl_words_drop_separator(args->inputs);
    args->render.inputs = (const char *const *)args->inputs + 1;
    if ((args->preview || args->task == FL_COMMAND_COMPARE) && !make_preview(args, error))
        return false;
    args->render.settings = (const FlSetting *)(const void *)args->settings->data;
    args->render.n_settings = args->settings->len;
    if (needs_input(args->task) && !args->render.inputs[0]) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "no input; expected SVG frames such as walk_%%04d.svg (see --help)");
        return false;
    }
    return true;
}

void fl_args_clear(FlArgs *args)
{
    g_strfreev(args->inputs);
    g_strfreev(args->styles);
    g_array_unref(args->settings);
    g_ptr_array_unref(args->strings);
}
