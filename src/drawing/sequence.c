#include "drawing/sequence.h"

#include "base/error.h"
#include "base/file.h"
#include "base/suggest.h"
#include "io/pattern.h"
#include "worker/workers.h"
#include <fnmatch.h>
#include <string.h>

static void found_clear(void *data)
{
    g_free(((FlSequenceFrame *)data)->file);
}

static void found_add(GArray *found, int number, const char *folder, const char *name)
{
    const bool here = strcmp(folder, ".") == 0;
    const FlSequenceFrame f = {here ? g_strdup(name) : g_build_filename(folder, name, NULL),
                               number};
    g_array_append_val(found, f);
}

static bool is_svg(const char *name)
{
    g_autofree char *lower = g_ascii_strdown(name, -1);
    return name[0] != '.' && (g_str_has_suffix(lower, ".svg") || g_str_has_suffix(lower, ".svgz"));
}

/** A sequence among the names of a folder: those that differ in their number only. */
typedef struct Group {
    FlPattern pattern;
    int n;
} Group;

static void group_clear(void *data)
{
    fl_pattern_clear(&((Group *)data)->pattern);
}

static GArray *group_names(const GPtrArray *names)
{
    GArray *groups = fl_array_of(Group, group_clear);
    for (guint i = 0; i < names->len; i++) {
        const char *name = names->pdata[i];
        g_auto(FlPattern) p = {0};
        int number = 0;
        if (!is_svg(name) || !fl_pattern_of_name(name, &p, &number))
            continue;
        guint g = 0;
        while (g < groups->len &&
               (strcmp(g_array_index(groups, Group, g).pattern.prefix, p.prefix) != 0 ||
                strcmp(g_array_index(groups, Group, g).pattern.suffix, p.suffix) != 0))
            g++;
        if (g == groups->len) {
            const Group group = {p, 0};
            p = (FlPattern){0};
            g_array_append_val(groups, group);
        } else {
            FlPattern *known = &g_array_index(groups, Group, g).pattern;
            known->width = MAX(known->width, p.width);
        }
        g_array_index(groups, Group, g).n++;
    }
    return groups;
}

/** "; did you mean walk_%04d.svg (44 files)?", or a name that is near; names stays as it is. */
static char *suggestion(GPtrArray *names, const char *wanted)
{
    g_autoptr(GArray) groups = group_names(names);
    g_autofree char *best = NULL;
    int best_distance = G_MAXINT, best_n = 0;
    FL_EACH (const Group, group, groups) {
        g_autofree char *text = fl_pattern_text(&group->pattern);
        const int distance = fl_edit_distance(wanted, text);
        if (distance < best_distance) {
            g_free(best);
            best = g_steal_pointer(&text);
            best_distance = distance;
            best_n = group->n;
        }
    }
    if (!best) {
        g_ptr_array_add(names, NULL);
        char *near = fl_did_you_mean(wanted, (const char *const *)names->pdata);
        g_ptr_array_remove_index(names, names->len - 1);
        if (*near)
            return near;
        g_free(near);
        return g_strdup("; its folder holds no numbered .svg files");
    }
    return g_strdup_printf("; did you mean %s (%d file%s)?", best, best_n, best_n == 1 ? "" : "s");
}

/** Returns: true if a name matches a pattern with a number, or if that is NULL, a glob. */
static bool fits(const char *name, const FlPattern *pattern, const char *wildcards, int *number)
{
    return pattern ? fl_pattern_match(pattern, name, number)
                   : is_svg(name) && fnmatch(wildcards, name, FNM_PERIOD) == 0;
}

static bool add_fitting(GArray *found, const char *input, const FlPattern *pattern, GError **error)
{
    g_autofree char *folder = g_path_get_dirname(input), *base = g_path_get_basename(input);
    g_autoptr(GPtrArray) names = fl_folder_names(folder, error);
    if (!names)
        return false;
    for (guint i = 0; i < names->len; i++) {
        int number = 0;
        if (fits(names->pdata[i], pattern, base, &number))
            found_add(found, number, folder, names->pdata[i]);
    }
    if (found->len == 0) {
        g_autofree char *hint = suggestion(names, base);
        fl_fail(error, FL_ERROR_INPUT, "%s: matches no file%s", input, hint);
    }
    return found->len > 0;
}

/** All groups of a folder as text, for the message that asks to choose. */
static char *group_list(const GArray *groups)
{
    GString *text = g_string_new(NULL);
    for (guint i = 0; i < MIN(groups->len, 4); i++) {
        const Group *group = &g_array_index(groups, Group, i);
        g_autofree char *name = fl_pattern_text(&group->pattern);
        g_string_append_printf(text, "%s%s (%d)", i ? ", " : "", name, group->n);
    }
    if (groups->len > 4)
        g_string_append(text, ", …");
    return g_string_free(text, FALSE);
}

static bool add_folder(GArray *found, const char *folder, FlWarnings *warnings, GError **error)
{
    g_autoptr(GPtrArray) names = fl_folder_names(folder, error);
    if (!names)
        return false;
    g_autoptr(GArray) groups = group_names(names);
    int n_svg = 0;
    for (guint i = 0; i < names->len; i++)
        n_svg += is_svg(names->pdata[i]);
    if (n_svg == 0 || groups->len > 1) {
        g_autofree char *list = group_list(groups);
        return fl_fail(
            error, FL_ERROR_INPUT, "%s: %s%s", folder,
            n_svg ? "several sequences; name one of them: " : "no .svg files in this folder", list);
    }
    for (guint i = 0; i < names->len; i++) {
        int number = 0;
        const char *name = names->pdata[i];
        g_auto(FlPattern) p = {0};
        if (!is_svg(name))
            continue;
        if (fl_pattern_of_name(name, &p, &number) || (groups->len == 0 && n_svg == 1))
            found_add(found, number, folder, name);
        else if (groups->len == 1)
            fl_warnings_add(warnings, folder, -1, NULL, "%s has no number and is left out", name);
        else
            found_add(found, (int)found->len + 1, folder, name);
    }
    return true;
}

/** Gives files named one by one their numbers; 1 … n where a name has none or stems differ. */
static void number_files(GArray *found)
{
    g_auto(FlPattern) first = {0};
    bool numbered = true;
    for (guint i = 0; i < found->len; i++) {
        FlSequenceFrame *f = &g_array_index(found, FlSequenceFrame, i);
        g_autofree char *base = g_path_get_basename(f->file);
        g_auto(FlPattern) p = {0};
        numbered = numbered && fl_pattern_of_name(base, &p, &f->number);
        if (!numbered)
            break;
        if (i == 0) {
            first = p;
            p = (FlPattern){0};
        } else {
            numbered = strcmp(p.prefix, first.prefix) == 0 && strcmp(p.suffix, first.suffix) == 0;
        }
    }
    for (guint i = 0; !numbered && i < found->len; i++)
        g_array_index(found, FlSequenceFrame, i).number = (int)i + 1;
}

static bool add_file(GArray *found, const char *input, GError **error)
{
    if (!g_file_test(input, G_FILE_TEST_EXISTS)) {
        g_autofree char *folder = g_path_get_dirname(input), *base = g_path_get_basename(input);
        g_autoptr(GPtrArray) names = fl_folder_names(folder, error);
        if (!names)
            return false;
        g_autofree char *hint = suggestion(names, base);
        return fl_fail(error, FL_ERROR_INPUT, "%s: no such file%s", input, hint);
    }
    const FlSequenceFrame f = {g_strdup(input)};
    g_array_append_val(found, f);
    return true;
}

/** Fails for files of other kinds, whose name tells the way from them to drawings. */
static bool check_kind(const char *input, GError **error)
{
    static const struct {
        const char *ends, *what;
    } kinds[] = {
        {".json .lottie", "a Lottie animation: fluidy-frames writes its frames as SVG"},
        {".html .htm", "a web page: fluidy-frames writes the frames of the SVG that moves in it"},
        {".blend", "a scene of Blender: the add-on “fluidy-svg” writes its frames as SVG"},
        {".mp4 .mov .webm .mkv .avi .gif .png .jpg .jpeg .webp",
         "pixels, not shapes: expected SVG drawings; ‘fluidy-style import’ makes a style of them"},
        {".fla .swf .ai .psd .fig .sketch .tnz .kra .xopp .pdf",
         "a file of another program: export its frames as SVG"},
    };
    g_autofree char *lower = g_ascii_strdown(input, -1);
    const char *end = strrchr(lower, '.');
    for (size_t i = 0; end && i < G_N_ELEMENTS(kinds); i++) {
        g_auto(GStrv) ends = g_strsplit(kinds[i].ends, " ", -1);
        if (!g_strv_contains((const char *const *)ends, end))
            continue;
        return fl_fail(error, FL_ERROR_INPUT, "%s: is %s; see fluidy-exports(7)", input,
                       kinds[i].what);
    }
    return true;
}

static bool add_input(GArray *found, const char *input, FlWarnings *warnings, GError **error)
{
    if (g_file_test(input, G_FILE_TEST_IS_DIR))
        return add_folder(found, input, warnings, error);
    if (!check_kind(input, error))
        return false;
    if (g_file_test(input, G_FILE_TEST_EXISTS)) { // also a file with # or * in its name
        add_file(found, input, NULL);
        number_files(found);
        return true;
    }
    g_autofree char *base = g_path_get_basename(input);
    g_auto(FlPattern) pattern = {0};
    if (!fl_pattern_parse(base, &pattern, error))
        return false;
    if (pattern.width > 0)
        return add_fitting(found, input, &pattern, error);
    if (!strpbrk(base, "*?["))
        return add_file(found, input, error);
    if (!add_fitting(found, input, NULL, error))
        return false;
    number_files(found);
    return true;
}

/** Adds the folders of a file, and itself if it is a link: it leads to another folder. */
static void add_paths(GPtrArray *paths, GHashTable *known, const char *file)
{
    g_autofree char *folder = g_path_get_dirname(file);
    if (!g_hash_table_contains(known, folder)) { // adding it again would replace the key
        g_hash_table_add(known, folder);
        g_ptr_array_add(paths, g_steal_pointer(&folder));
    }
    if (g_file_test(file, G_FILE_TEST_IS_SYMLINK))
        g_ptr_array_add(paths, g_strdup(file));
}

char **fl_paths_of(const char *const *files)
{
    GPtrArray *paths = g_ptr_array_new();
    g_autoptr(GHashTable) known = g_hash_table_new(g_str_hash, g_str_equal);
    for (; *files; files++)
        add_paths(paths, known, *files);
    g_ptr_array_add(paths, NULL);
    return (char **)g_ptr_array_free(paths, FALSE);
}

/** Asks a worker for the frames in a file. Returns: false with an error. */
static bool ask_for_frames(const char *file, const FlSequenceOptions *options,
                           FlInnerFrames *frames, GError **error)
{
    const FlRequest request = {.verb = FL_VERB_COUNT,
                               .file = file,
                               .number = 1,
                               .svg = {.from = options->from},
                               .moments = options->moments};
    g_auto(GStrv) paths = fl_paths_of((const char *const[]){file, NULL});
    g_autoptr(FlWorkers) workers =
        fl_workers_new((const char *const *)paths, options->sandbox, true, error);
    g_auto(FlAnswer) answer = {0};
    if (!workers || !fl_workers_ask(workers, &request, NULL, &answer, error))
        return false;
    return fl_inner_frames_unpack(&answer.reader, frames) || fl_answer_set_damaged(file, error);
}

static void warn_of_length(const char *file, const FlInnerFrames *frames, FlWarnings *warnings)
{
    if (frames->cut)
        fl_warnings_add(warnings, file, -1, NULL,
                        "its loops meet after more than %.0f s; the film is the longest of them, "
                        "%.3g s",
                        FL_LONGEST_LOOP, frames->seconds);
}

/** Puts the frames in the only file in its place, if there are several. */
static bool split(GArray *found, const FlSequenceOptions *options, FlInnerFrames *frames,
                  FlWarnings *warnings, GError **error)
{
    *frames = (FlInnerFrames){.from = FL_FRAMES_FILES, .n = 1};
    if (options->from == FL_FRAMES_FILES || (options->from <= FL_FRAMES_AUTO && found->len != 1))
        return true;
    if (found->len != 1) {
        static const char *const words[] = {"", "auto", "files", "layers", "pages", "time"};
        return fl_fail(error, FL_ERROR_USAGE,
                       "‘frames-from’ %s: %u files; expected one that holds all frames",
                       words[options->from], found->len);
    }
    g_autofree char *path = g_strdup(g_array_index(found, FlSequenceFrame, 0).file);
    if (!ask_for_frames(path, options, frames, error))
        return false;
    if (frames->from == FL_FRAMES_FILES)
        return true;
    warn_of_length(path, frames, warnings);
    g_array_set_size(found, 0);
    for (int layer = 1; layer <= frames->n; layer++) {
        const FlSequenceFrame f = {.file = g_strdup(path), .number = layer, .layer = layer};
        g_array_append_val(found, f);
    }
    return true;
}

static int compare_found(const void *a, const void *b)
{
    const int x = ((const FlSequenceFrame *)a)->number, y = ((const FlSequenceFrame *)b)->number;
    return (x > y) - (x < y);
}

static bool no_number_twice(const GArray *found, GError **error)
{
    for (guint i = 1; i < found->len; i++) {
        const FlSequenceFrame *a = &g_array_index(found, FlSequenceFrame, i - 1), *b = a + 1;
        if (a->number == b->number)
            return fl_fail(error, FL_ERROR_INPUT, "%s and %s are both frame %d", a->file, b->file,
                           a->number);
    }
    return true;
}

/** The file of a number; with hold, if it is missing, that of the nearest number before, else
 * after. */
static const FlSequenceFrame *look_up(const GArray *found, int number, bool hold)
{
    const FlSequenceFrame *before = NULL;
    FL_EACH (const FlSequenceFrame, f, found) {
        if (f->number == number)
            return f;
        if (f->number > number)
            return !hold ? NULL : before ? before : f;
        before = f;
    }
    return hold ? before : NULL;
}

static char *shared_name(const FlSequenceFrame *first)
{
    g_autofree char *base = g_path_get_basename(first->file);
    g_auto(FlPattern) p = {0};
    int number = 0;
    char *name = NULL;
    if (fl_pattern_of_name(base, &p, &number)) {
        name = g_strdup(p.prefix);
    } else {
        const char *dot = strrchr(base, '.');
        name = g_strndup(base, dot ? (gsize)(dot - base) : strlen(base));
    }
    for (size_t n = strlen(name); n > 0 && strchr("_-. (", name[n - 1]); n--)
        name[n - 1] = '\0';
    if (name[0])
        return name;
    g_free(name);
    g_autofree char *absolute = g_canonicalize_filename(first->file, NULL);
    g_autofree char *folder = g_path_get_dirname(absolute);
    name = g_path_get_basename(folder);
    if (name[0] == G_DIR_SEPARATOR) {
        g_free(name);
        name = g_strdup("frame");
    }
    return name;
}

/** The found files as a pattern with its folder, for messages. */
static char *pattern_text(const FlSequenceFrame *first)
{
    g_autofree char *folder = g_path_get_dirname(first->file);
    g_autofree char *base = g_path_get_basename(first->file);
    g_auto(FlPattern) p = {0};
    int number = 0;
    if (!fl_pattern_of_name(base, &p, &number))
        return g_strdup(first->file);
    g_autofree char *text = fl_pattern_text(&p);
    return strcmp(folder, ".") == 0 ? g_steal_pointer(&text) : g_build_filename(folder, text, NULL);
}

static GArray *numbers_of(const GArray *found)
{
    GArray *numbers = g_array_new(FALSE, FALSE, sizeof(int));
    for (guint i = 0; i < found->len; i++)
        g_array_append_val(numbers, g_array_index(found, FlSequenceFrame, i).number);
    return numbers;
}

static char **files_of(const GArray *found)
{
    char **files = g_new0(char *, found->len + 1);
    for (guint i = 0; i < found->len; i++)
        files[i] = g_strdup(g_array_index(found, FlSequenceFrame, i).file);
    return files;
}

/** Selects the wanted numbers among the found files. */
static FlSequence *choose(const GArray *found, const GArray *wanted, FlMissing missing,
                          FlWarnings *warnings, GError **error)
{
    const FlSequenceFrame *first = &g_array_index(found, FlSequenceFrame, 0);
    g_autofree char *pattern = pattern_text(first);
    g_autoptr(GArray) gaps = g_array_new(FALSE, FALSE, sizeof(int));
    g_autoptr(FlSequence) s = g_new0(FlSequence, 1);
    s->frame = g_new0(FlSequenceFrame, wanted->len + 1);
    s->name = shared_name(first);
    s->found = files_of(found);
    for (guint i = 0; i < wanted->len; i++) {
        const int number = g_array_index(wanted, int, i);
        const FlSequenceFrame *f = look_up(found, number, missing == FL_MISSING_HOLD);
        if (!f || f->number != number)
            g_array_append_val(gaps, number);
        if (f)
            s->frame[s->n++] = (FlSequenceFrame){.file = s->found[f - first],
                                                 .number = number,
                                                 .stand_in = f->number != number,
                                                 .layer = f->layer};
    }
    g_autofree char *list = fl_range_text(gaps);
    if (s->n == 0) {
        g_autoptr(GArray) numbers = numbers_of(found);
        g_autofree char *there = fl_range_text(numbers);
        return fl_none(error, FL_ERROR_INPUT, "%s: no file for frame%s %s; expected some of %s",
                       pattern, gaps->len > 1 ? "s" : "", list, there);
    }
    if (gaps->len > 0 && missing <= FL_MISSING_ERROR)
        return fl_none(error, FL_ERROR_INPUT,
                       "%s: no file for frame%s %s; use ‘missing’ hold or skip to go on without",
                       pattern, gaps->len > 1 ? "s" : "", list);
    if (gaps->len > 0)
        fl_warnings_add(warnings, pattern, -1, NULL, "no file for frame%s %s: %s",
                        gaps->len > 1 ? "s" : "", list,
                        missing == FL_MISSING_HOLD ? "the one before is held" : "left out");
    return g_steal_pointer(&s);
}

/** The moments of frames, in seconds. */
static void set_moments(FlSequence *sequence, const FlInnerFrames *frames, const FlMoments *moments)
{
    sequence->from = frames->from;
    for (int i = 0; frames->from == FL_FRAMES_TIME && i < sequence->n; i++)
        sequence->frame[i].seconds = moments->from + (sequence->frame[i].layer - 1) / moments->fps;
}

FlSequence *fl_sequence_open(const FlSequenceOptions *options, FlWarnings *warnings, GError **error)
{
    const char *const *inputs = options->inputs;
    const int n_inputs = options->n_inputs;
    g_assert(n_inputs >= 1);
    g_autoptr(GArray) found = fl_array_of(FlSequenceFrame, found_clear);
    if (n_inputs == 1) {
        if (!add_input(found, inputs[0], warnings, error))
            return NULL;
    } else {
        for (int i = 0; i < n_inputs; i++) {
            if (g_file_test(inputs[i], G_FILE_TEST_IS_DIR))
                return fl_none(error, FL_ERROR_INPUT,
                               "%s: is a folder; expected one folder or several files", inputs[i]);
            if (!add_file(found, inputs[i], error))
                return NULL;
        }
        number_files(found);
    }
    FlInnerFrames frames;
    if (!split(found, options, &frames, warnings, error))
        return NULL;
    g_array_sort(found, compare_found);
    if (!no_number_twice(found, error))
        return NULL;
    const int first = g_array_index(found, FlSequenceFrame, 0).number;
    const int last = g_array_index(found, FlSequenceFrame, found->len - 1).number;
    g_autofree char *all = g_strdup_printf("%d-%d", first, last);
    g_autoptr(GArray) wanted =
        fl_range_parse(options->range ? options->range : all, first, last, error);
    FlSequence *sequence = wanted ? choose(found, wanted, options->missing, warnings, error) : NULL;
    while (sequence && g_array_index(found, FlSequenceFrame, sequence->n_earlier).number <
                           sequence->frame[0].number)
        sequence->n_earlier++;
    if (sequence)
        set_moments(sequence, &frames, &options->moments);
    return sequence;
}

FlRequest fl_sequence_request(const FlSequence *sequence, int t, FlVerb verb, FlSvgOptions svg)
{
    const FlSequenceFrame *frame = &sequence->frame[t];
    svg.from = sequence->from, svg.layer = frame->layer, svg.seconds = frame->seconds;
    return (FlRequest){
        .verb = verb, .file = frame->file, .number = frame->number, .frame = t, .svg = svg};
}

bool fl_sequence_same(const FlSequence *sequence, int a, int b)
{
    return sequence->frame[a].layer == sequence->frame[b].layer &&
           strcmp(sequence->frame[a].file, sequence->frame[b].file) == 0;
}

void fl_sequence_free(FlSequence *sequence)
{
    if (!sequence)
        return;
    g_free(sequence->frame);
    g_free(sequence->name);
    g_strfreev(sequence->found);
    g_free(sequence);
}
