#include "style_commands.h"

#include "words.h"

#include <stdio.h>
#include <string.h>

static struct Options {
    char *output, *frames, *crop, *masks, *name, *author, *licence, *paper;
    double scale, border, fps;
    int size;
    gboolean no_flatten, no_stabilise, whole, overwrite, quiet, no_sheet, strict, paths;
} options;

static const GOptionEntry import_entries[] = {
    {"output", 'o', 0, G_OPTION_ARG_FILENAME, &options.output, "style to make", "DIR"},
    {"frames", 'f', 0, G_OPTION_ARG_STRING, &options.frames, "frames of the source to use (all)",
     "A-B[xSTEP]"},
    {"crop", 'c', 0, G_OPTION_ARG_STRING, &options.crop, "part of the picture to use", "WxH[+X+Y]"},
    {"scale", 's', 0, G_OPTION_ARG_DOUBLE, &options.scale, "size of the frames (1; at most 640 px)",
     "FACTOR"},
    {"masks", 'm', 0, G_OPTION_ARG_FILENAME, &options.masks,
     "masks, white where the paint is (found)", "SOURCE"},
    {"paper", 0, 0, G_OPTION_ARG_STRING, &options.paper, "colour of the paper (found)", "#RRGGBB"},
    {"border", 0, 0, G_OPTION_ARG_DOUBLE, &options.border, "width of the border (found)", "PX"},
    {"fps", 0, 0, G_OPTION_ARG_DOUBLE, &options.fps, "frames per second (the video's, or 25)", "N"},
    {"whole", 0, 0, G_OPTION_ARG_NONE, &options.whole, "paint fills the whole frame", NULL},
    {"no-flatten", 0, 0, G_OPTION_ARG_NONE, &options.no_flatten, "keep uneven light", NULL},
    {"no-stabilise", 0, 0, G_OPTION_ARG_NONE, &options.no_stabilise, "keep camera shake", NULL},
    {"name", 0, 0, G_OPTION_ARG_STRING, &options.name, "name of the style (the folder's)", "TEXT"},
    {"author", 0, 0, G_OPTION_ARG_STRING, &options.author, "who made the recording", "TEXT"},
    {"licence", 0, 0, G_OPTION_ARG_STRING, &options.licence, "licence of the recording", "TEXT"},
    {"overwrite", 'y', 0, G_OPTION_ARG_NONE, &options.overwrite, "replace a style in DIR", NULL},
    {"quiet", 'q', 0, G_OPTION_ARG_NONE, &options.quiet, "print errors only", NULL},
    {NULL},
};

/* A letter is enough for what needs no value. */
static char *flag_of(const char *name, void *entries)
{
    for (const GOptionEntry *e = entries; e && e->long_name; e++)
        if (strcmp(e->long_name, name) == 0)
            return e->short_name && !e->arg_description ? g_strdup_printf("-%c", e->short_name)
                                                        : g_strconcat("--", name, NULL);
    return strcmp(name, "limit") == 0 ? g_strdup("--limit") : NULL;
}

char *fl_style_command_translate(const GOptionEntry *entries, const char *message)
{
    return fl_words_translate(message, flag_of, (gpointer)entries);
}

static bool usage(GError **error, const char *what, const char *given)
{
    g_set_error(error, FL_ERROR, FL_ERROR_USAGE, what, given);
    return false;
}

/* A-B, A-BxSTEP, or one number; numbers are at most nine digits. */
static bool parse_frames(const char *text, FlStyleImport *import, GError **error)
{
    int n[3] = {0, 0, 1}, end = 0;
    if (!(sscanf(text, "%9d-%9dx%9d%n", &n[0], &n[1], &n[2], &end) == 3 && !text[end]) &&
        !(sscanf(text, "%9d-%9d%n", &n[0], &n[1], &end) == 2 && !text[end])) {
        if (sscanf(text, "%9d%n", &n[0], &end) != 1 || text[end])
            return usage(error, "--frames %s: expected a range such as 10-40 or 10-100x3", text);
        n[1] = n[0];
        n[2] = 1;
    }
    if (n[0] < 0 || n[1] < n[0] || n[2] < 1)
        return usage(error, "--frames %s: an empty range", text);
    import->first = n[0];
    import->last = n[1];
    import->step = n[2];
    return true;
}

static bool parse_crop(const char *text, int crop[4], GError **error)
{
    int end = 0;
    crop[0] = crop[1] = 0;
    if ((sscanf(text, "%9dx%9d+%9d+%9d%n", &crop[2], &crop[3], &crop[0], &crop[1], &end) == 4 &&
         !text[end]) ||
        (sscanf(text, "%9dx%9d%n", &crop[2], &crop[3], &end) == 2 && !text[end]))
        if (crop[2] > 0 && crop[3] > 0)
            return true;
    return usage(error, "--crop %s: expected a part such as 400x300+20+10", text);
}

static bool run_import(char **words, GError **error)
{
    FlStyleImport import = FL_STYLE_IMPORT_DEFAULTS;
    if (!words[0] || words[1])
        return usage(error, "import takes one %s", "video, picture, pattern or folder");
    if (!options.output)
        return usage(error, "import needs -o %s, the style to make", "DIR");
    if ((options.frames && !parse_frames(options.frames, &import, error)) ||
        (options.crop && !parse_crop(options.crop, import.crop, error)))
        return false;
    import.source = words[0];
    import.folder = options.output;
    import.masks = options.masks;
    import.scale = options.scale;
    import.flatten = !options.no_flatten;
    import.stabilise = !options.no_stabilise;
    import.whole = options.whole;
    import.overwrite = options.overwrite;
    import.name = options.name;
    import.author = options.author;
    import.licence = options.licence;
    import.paper = options.paper;
    import.border_px = options.border;
    import.fps = options.fps;
    g_autoptr(GPtrArray) notes = g_ptr_array_new_with_free_func(g_free);
    const bool done = fl_style_import(&import, notes, error);
    for (guint i = 0; i < notes->len && !options.quiet; i++) {
        g_autofree char *note = fl_style_command_translate(import_entries, notes->pdata[i]);
        g_autofree char *line = fl_one_line(note);
        fprintf(stderr, "fluidy-style: %s\n", line);
    }
    return done;
}

static bool written(GError **error)
{
    if (fflush(stdout) == 0 && !ferror(stdout))
        return true;
    g_set_error_literal(error, FL_ERROR, FL_ERROR_OUTPUT, "standard output cannot be written");
    return false;
}

static const GOptionEntry check_entries[] = {
    {"output", 'o', 0, G_OPTION_ARG_FILENAME, &options.output,
     "picture sheet to write (NAME-check.png)", "FILE"},
    {"no-sheet", 0, 0, G_OPTION_ARG_NONE, &options.no_sheet, "print the report, write no sheet",
     NULL},
    {"strict", 0, 0, G_OPTION_ARG_NONE, &options.strict, "exit with 1 if there are problems", NULL},
    {"overwrite", 'y', 0, G_OPTION_ARG_NONE, &options.overwrite, "overwrite the sheet", NULL},
    {NULL},
};

static char *sheet_name(const char *style)
{
    g_autofree char *absolute = g_canonicalize_filename(style, NULL);
    g_autofree char *base = g_path_get_basename(absolute);
    return g_strconcat(base, "-check.png", NULL);
}

static bool check_one(const char *style, int *n_problems, GError **error)
{
    g_autofree char *sheet = options.no_sheet ? NULL
                             : options.output ? g_strdup(options.output)
                                              : sheet_name(style);
    g_autoptr(FlStyleReport) report = fl_style_check(style, sheet, options.overwrite, error);
    if (!report)
        return false;
    *n_problems += report->n_problems;
    printf("%s", report->text);
    if (sheet)
        printf("sheet      %s\n", sheet);
    return true;
}

static bool run_check(char **words, GError **error)
{
    int n_problems = 0;
    if (!words[0])
        return usage(error, "check needs a %s, by name or folder", "style");
    if (words[1] && options.output)
        return usage(error, "-o %s is one sheet, but there are several styles", options.output);
    for (int i = 0; words[i]; i++) {
        if (i > 0)
            printf("\n");
        if (!check_one(words[i], &n_problems, error))
            return false;
    }
    if (!written(error))
        return false;
    if (!options.strict || n_problems == 0)
        return true;
    g_set_error(error, FL_ERROR, FL_ERROR_STYLE, "%d problem%s", n_problems,
                n_problems == 1 ? "" : "s");
    return false;
}

static bool show_progress(int frame, int n_frames, void *data)
{
    if (!options.quiet)
        fprintf(stderr, "fluidy-style: frame %d of %d%s\n", frame, n_frames,
                frame < n_frames ? "" : "; writing the files");
    return true;
}

static const GOptionEntry simulate_entries[] = {
    {"output", 'o', 0, G_OPTION_ARG_FILENAME, &options.output, "style to make", "DIR"},
    {"size", 0, 0, G_OPTION_ARG_INT, &options.size, "1, 2 or 4 times the recipe's size (1)", "N"},
    {"overwrite", 'y', 0, G_OPTION_ARG_NONE, &options.overwrite, "replace a style in DIR", NULL},
    {"quiet", 'q', 0, G_OPTION_ARG_NONE, &options.quiet, "print errors only", NULL},
    {NULL},
};

static bool run_simulate(char **words, GError **error)
{
    const int size = options.size ? options.size : 1;
    if (!words[0] || words[1])
        return usage(error, "simulate takes one %s", "recipe");
    if (!options.output)
        return usage(error, "simulate needs -o %s, the style to make", "DIR");
    if (size != 1 && size != 2 && size != 4) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "--size %d: expected 1, 2 or 4", size);
        return false;
    }
    return fl_watercolour_simulate(words[0], options.output, size, options.overwrite, show_progress,
                                   NULL, error);
}

static const GOptionEntry transport_entries[] = {
    {"overwrite", 'y', 0, G_OPTION_ARG_NONE, &options.overwrite, "replace its transport.png", NULL},
    {"quiet", 'q', 0, G_OPTION_ARG_NONE, &options.quiet, "print errors only", NULL},
    {NULL},
};

static bool show_loss(void *data, int done, int total, float loss)
{
    if (!options.quiet && (done % 20 == 0 || done == total))
        fprintf(stderr, "fluidy-style: iteration %d of %d, loss %.4f\n", done, total, loss);
    return true;
}

static bool run_transport(char **words, GError **error)
{
    if (!words[0] || words[1])
        return usage(error, "transport takes one %s, by name or folder", "style");
    return fl_style_transport(words[0], options.overwrite, show_loss, NULL, error);
}

static const GOptionEntry list_entries[] = {
    {"paths", 'p', 0, G_OPTION_ARG_NONE, &options.paths, "print the folders searched as well",
     NULL},
    {"output", 'o', 0, G_OPTION_ARG_FILENAME, &options.output, "draw every style on a sheet",
     "FILE"},
    {"overwrite", 'y', 0, G_OPTION_ARG_NONE, &options.overwrite, "overwrite the sheet", NULL},
    {NULL},
};

static bool run_list(char **words, GError **error)
{
    if (words[0])
        return usage(error, "list takes no arguments, such as %s", words[0]);
    if (options.output && !fl_style_sheet(options.output, options.overwrite, error))
        return false;
    g_auto(GStrv) folders = fl_style_folders();
    for (int i = 0; options.paths && folders[i]; i++)
        printf("# %s%s\n", folders[i],
               g_file_test(folders[i], G_FILE_TEST_IS_DIR) ? "" : " (not there)");
    g_autoptr(GPtrArray) entries = fl_style_list();
    for (guint i = 0; i < entries->len; i++) {
        const FlStyleEntry *entry = g_ptr_array_index(entries, i);
        printf("%s\t%s\t%s\t%s%s\n", entry->name, entry->title ? entry->title : "",
               entry->character ? entry->character : "", entry->path,
               entry->hidden ? "\t(hidden by the one above)" : "");
    }
    return written(error);
}

const FlStyleCommand fl_style_commands[] = {
    {"import", "SOURCE -o DIR", "make a style from a recording",
     "SOURCE is a video, a still picture, a pattern such as paint_%04d.png, or a folder of "
     "numbered\npictures. Masks beside the pictures (mask_0001.png …) and alpha channels are "
     "kept.\n",
     import_entries, run_import},
    {"check", "STYLE ...", "report on styles, and draw picture sheets",
     "STYLE is a name that fluidy-style list shows, or a folder.\n", check_entries, run_check},
    {"simulate", "RECIPE -o DIR", "make a style by simulating paint", NULL, simulate_entries,
     run_simulate},
    {"transport", "STYLE", "solve the tile by which a style moves ink",
     "STYLE is a name that fluidy-style list shows, or a folder; its first frame is what ink shall "
     "look\nlike, the section [transport] of its style.ini says how it may move.\n",
     transport_entries, run_transport},
    {"list", "[-o FILE]", "list styles, and draw them on a sheet",
     "Prints one style a line, with tabs between: number or folder's name, name, character, "
     "folder.\n",
     list_entries, run_list},
    {NULL},
};
