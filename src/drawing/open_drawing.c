#include "drawing/drawing.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/suggest.h"
#include <string.h>

#define MOST_LISTED 20 // unmatched sections with a warning each

/* Marks the rules that made a region. Returns: how many are not marked. */
static int mark_used(const FlDrawing *drawing, const FlRule *rules, int n, bool *used)
{
    int unused = 0;
    for (int r = 0; r < fl_drawing_regions(drawing); r++)
        if (fl_drawing_region(drawing, r)->rule >= 0)
            used[fl_drawing_region(drawing, r)->rule] = true;
    for (int i = 0; i < n; i++) {
        used[i] |= rules[i].merge_with != NULL; // its region has become another one
        unused += !used[i];
    }
    return unused;
}

/* A section may match in frames outside the range: checks all. An unreadable file is an error only
 * when it is within the range. */
static int mark_used_elsewhere(const FlDrawingOptions *options, bool *used)
{
    FlDrawingOptions all = *options;
    all.frames.range = NULL, all.reading = NULL;
    g_autoptr(FlDrawing) drawing = fl_drawing_open(&all, NULL, NULL);
    return drawing ? mark_used(drawing, options->rules, options->n_rules, used) : 0;
}

/* A section that matches no region mostly has a mistyped name or colour. */
static void warn_of_unused(const FlDrawing *drawing, const FlConfig *config,
                           const FlDrawingOptions *options, FlWarnings *warnings)
{
    g_autofree bool *used = g_new0(bool, MAX(config->n_rules, 1));
    int unused = mark_used(drawing, options->rules, config->n_rules, used), listed = 0;
    if (unused > 0 && options->frames.range)
        unused = mark_used_elsewhere(options, used);
    g_autoptr(GPtrArray) names = g_ptr_array_new();
    for (int r = 0; r < fl_drawing_regions(drawing); r++)
        g_ptr_array_add(names, fl_drawing_region(drawing, r)->name);
    g_ptr_array_add(names, NULL);
    for (int i = 0; i < config->n_rules && unused > 0 && listed < MOST_LISTED; i++) {
        if (used[i])
            continue;
        listed++;
        const FlRule *rule = &config->rules[i];
        g_autofree char *hint = rule->by_name
                                    ? fl_did_you_mean(rule->name, (const char *const *)names->pdata)
                                    : g_strdup("");
        fl_warnings_add(warnings, rule->place, -1, NULL, "[region %s] matches no region%s",
                        rule->name, hint);
    }
    if (unused > listed && listed > 0)
        fl_warnings_add(warnings, config->path, -1, NULL, "%d more sections match no region",
                        unused - listed);
}

/* A drawing without shapes is mostly the wrong file. */
static void warn_of_nothing(const FlDrawing *drawing, FlWarnings *warnings)
{
    for (int r = 0; r < fl_drawing_regions(drawing); r++)
        if (fl_drawing_region(drawing, r)->paintable)
            return;
    fl_warnings_add(warnings, fl_drawing_file(drawing, 0), -1, NULL,
                    "there is nothing to paint in the drawing%s",
                    fl_drawing_frames(drawing) > 1 ? ", nor in the other frames" : "");
}

/* Counts the warnings of each text, about any element. */
static GHashTable *count_texts(const FlWarnings *warnings)
{
    GHashTable *counts = g_hash_table_new(g_str_hash, g_str_equal);
    for (int i = 0; i < fl_warnings_count(warnings); i++) {
        char *text = fl_warnings_get(warnings, i)->text;
        const int n = GPOINTER_TO_INT(g_hash_table_lookup(counts, text));
        g_hash_table_insert(counts, text, GINT_TO_POINTER(n + 1));
    }
    return counts;
}

static bool report(const FlWarnings *warnings, const FlCaller *caller, GError **error)
{
    const int n = fl_warnings_count(warnings);
    g_autoptr(GHashTable) counts = count_texts(warnings);
    for (int i = 0; i < n; i++) {
        const char *text = fl_warnings_get(warnings, i)->text;
        const int n_alike = GPOINTER_TO_INT(g_hash_table_lookup(counts, text));
        if (!g_hash_table_remove(counts, text))
            continue;
        g_autofree char *first = fl_warning_line(fl_warnings_get(warnings, i));
        g_autofree char *line = n_alike == 1
                                    ? g_strdup(first)
                                    : g_strdup_printf("%s; and so for %d more element%s", first,
                                                      n_alike - 1, n_alike == 2 ? "" : "s");
        if (caller->strict)
            return fl_fail(error, FL_ERROR_INPUT, "%s (%d warning%s under ‘strict’)", line, n,
                           n == 1 ? "" : "s");
        (void)fl_warn(caller, NULL, FL_ERROR_INPUT, "%s", line);
    }
    return true;
}

/* Mentions a config beside the drawing, which is used on request only. */
static void offer_config(const FlDrawing *drawing, bool given, const FlCaller *caller)
{
    g_autofree char *folder = g_path_get_dirname(fl_drawing_file(drawing, 0));
    g_autofree char *path = strcmp(folder, ".") == 0
                                ? g_strdup("fluidy-svg.conf")
                                : g_build_filename(folder, "fluidy-svg.conf", NULL);
    if (!given && g_file_test(path, G_FILE_TEST_IS_REGULAR))
        fl_note(caller, "%s is not used; ‘config’ %s paints by it", path, path);
}

static bool tell_reading(void *data, const FlSequence *sequence, int done)
{
    const FlCaller *caller = data;
    const FlProgress progress = {.stage = "read",
                                 .region_index = -1,
                                 .frame = sequence->frame[done - 1].number,
                                 .done = done,
                                 .total = sequence->n,
                                 .elapsed_s = fl_seconds_since(caller->start),
                                 .remaining_s = -1};
    return caller->progress(&progress, caller->data);
}

FlDrawing *fl_drawing_open_for(const FlDrawingOptions *options, const FlConfig *config,
                               const FlCaller *caller, GError **error)
{
    if (!fl_headroom_check(error))
        return NULL;
    FlDrawingOptions wanted = *options;
    wanted.reading = caller->progress ? tell_reading : NULL;
    wanted.data = (void *)(uintptr_t)caller;
    wanted.rules = config->rules, wanted.n_rules = config->n_rules;
    g_autoptr(FlWarnings) warnings = fl_warnings_new();
    g_autoptr(FlDrawing) drawing = fl_drawing_open(&wanted, warnings, error);
    if (!drawing)
        return NULL;
    offer_config(drawing, config->path, caller);
    warn_of_nothing(drawing, warnings);
    warn_of_unused(drawing, config, &wanted, warnings);
    if (wanted.frames.missing > FL_MISSING_ERROR &&
        !fl_drawing_leave_out_bad(drawing, wanted.frames.missing, warnings, error))
        return NULL;
    return report(warnings, caller, error) ? g_steal_pointer(&drawing) : NULL;
}
