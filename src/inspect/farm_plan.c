#include "base/each.h"
#include "base/error.h"
#include "base/json.h"
#include "job/plan.h"
#include "params/options.h"
#include <string.h>

/* A task: regions that are painted by one process. */
typedef struct Task {
    GString *regions; // with commas between
    double share;     // of the whole work
} Task;

/* The data of a printed plan. */
typedef struct Farm {
    const FlPlan *plan;
    const char *shot;           // the drawing's name
    char *folder, *paint;       // the working directory; the files between tasks and merge
    const char *const *command; // the render's
    GArray *tasks;              // of Task, largest first
    int n_parts;                // of the merge
    bool film;                  // a film is encoded from the frames after the parts
} Farm;

static void clear_task(Task *task)
{
    g_string_free(task->regions, TRUE);
}

/* ---- tasks ---------------------------------------------------------------------------------- */

/* Time follows the painted area, and a small region takes as long as if it were a few thousandths
 * of the page larger: measured, with its guides, 0.1 to 0.5 %. What is held is painted that much
 * less often. */
static double work_of(const FlPlan *plan, int p)
{
    const FlShapes *shapes = &plan->shapes;
    const FlRegionPlan *painted = &shapes->painted[p];
    const FlRegion *region = fl_drawing_region(shapes->drawing, painted->region);
    const double page = (double)shapes->width * shapes->height;
    return (region->area_px + page / 256) * region->n_present / painted->settings.hold;
}

static int larger_first(const void *a, const void *b, void *plan)
{
    const int p = *(const int *)a, q = *(const int *)b;
    const double x = work_of(plan, p), y = work_of(plan, q);
    return x != y ? (x < y) - (x > y) : p - q;
}

static int larger_share_first(const void *a, const void *b)
{
    const Task *x = a, *y = b;
    return (x->share < y->share) - (x->share > y->share);
}

static void add_task(Farm *farm, int p, double share)
{
    const Task task = {g_string_new(farm->plan->shapes.painted[p].name), share};
    g_array_append_val(farm->tasks, task);
}

/* Returns: true if a task has a region, in all its styles; p is its first one. */
static bool is_painted(const FlPlan *plan, int p)
{
    const int region = plan->shapes.painted[p].region;
    return plan->shapes.painted_of[region] == p && !fl_shapes_hide(&plan->shapes, region);
}

static int count_painted(const FlPlan *plan)
{
    int n = 0;
    for (int p = 0; p < plan->shapes.n_painted; p++)
        n += is_painted(plan, p);
    return n;
}

/* Every task reads the whole drawing, so each has at least a quarter of the largest region's work
 * and a sixty-fourth of the whole work: small regions share one. Regions that are hidden in all
 * frames are left out. */
static void make_tasks(Farm *farm)
{
    const FlPlan *plan = farm->plan;
    const FlShapes *shapes = &plan->shapes;
    int n = 0;
    g_autofree int *order = g_new(int, shapes->n_painted);
    double total = 0, filled = 0;
    for (int p = 0; p < shapes->n_painted; p++) {
        if (is_painted(plan, p))
            order[n++] = p, total += work_of(plan, p);
    }
    g_qsort_with_data(order, n, sizeof *order, larger_first, (void *)(uintptr_t)plan);
    const double least = MAX(work_of(plan, order[0]) / 4, total / 64);
    for (int k = 0; k < n; k++) {
        const double work = work_of(plan, order[k]);
        if (k == 0 || filled >= least) {
            add_task(farm, order[k], work / total);
            filled = work;
            continue;
        }
        Task *task = &g_array_index(farm->tasks, Task, farm->tasks->len - 1);
        g_string_append_printf(task->regions, ",%s", shapes->painted[order[k]].name);
        task->share += work / total;
        filled += work;
    }
    g_array_sort(farm->tasks, larger_share_first);
}

/* A part reads the whole drawing and makes a sheet of paper, which takes as long as composing ten
 * to twenty frames of 480 px. Statistics, and films without their frames, are one file. */
static int count_parts(const FlPlan *plan)
{
    enum { WHOLE = 11, FRAMES_OF_PART = 24, MOST = 16 };
    const int n = plan->shapes.n_frames;
    return plan->out.format->film || plan->out.stats || n <= WHOLE
               ? 1
               : CLAMP(n / FRAMES_OF_PART, 2, MOST);
}

/* ---- commands ------------------------------------------------------------------------------- */

/* The number of words, from here on, of an option that only the merge gets: for outputs and for
 * existing files. */
static int words_of_merge(const char *const *word)
{
    static const char *const values[] = {"-o", "--output", "--layers", "--stats", NULL};
    static const char *const flags[] = {"-y", "--overwrite", "--no-clobber", "--resume", NULL};
    g_autofree char *name = g_strndup(*word, strcspn(*word, "="));
    if (g_strv_contains(flags, *word) || (strchr(*word, '=') && g_strv_contains(values, name)))
        return 1;
    return g_strv_contains(values, *word) && word[1] ? 2 : 0;
}

/* The steps in order; the commands of a step differ in one word. */
typedef enum Step {
    STEP_PAINT, // by the regions of a task
    STEP_MERGE, // by part
    STEP_FILM,
} Step;

static int n_commands(const Farm *farm, Step step)
{
    const int n[] = {[STEP_PAINT] = (int)farm->tasks->len,
                     [STEP_MERGE] = farm->n_parts,
                     [STEP_FILM] = farm->film ? 1 : 0};
    return n[step];
}

/* The words in which the commands of a step differ; to be freed. */
static GPtrArray *variables_of(const Farm *farm, Step step)
{
    GPtrArray *words = g_ptr_array_new_with_free_func(g_free);
    for (int k = 0; k < n_commands(farm, step); k++)
        g_ptr_array_add(
            words, step == STEP_PAINT  ? g_strdup(g_array_index(farm->tasks, Task, k).regions->str)
                   : step == STEP_FILM ? g_strdup("film")
                                       : g_strdup_printf("%d/%d", k + 1, farm->n_parts));
    return words;
}

static void add_all(GPtrArray *words, const char *const *more)
{
    for (; *more; more++)
        g_ptr_array_add(words, g_strdup(*more));
}

#define VARIABLE 2 // index of the word in which commands differ

/* The words of a command. A part keeps frames that exist, as of an earlier try, unless they are to
 * be replaced. To be freed. */
static GPtrArray *words_of(const Farm *farm, Step step, const char *variable)
{
    const bool paints = step == STEP_PAINT, in_parts = farm->n_parts > 1;
    const bool keeps =
        step == STEP_MERGE && in_parts && farm->plan->out.overwrite == FL_OVERWRITE_REFUSE;
    GPtrArray *words = g_ptr_array_new_with_free_func(g_free);
    add_all(words, (const char *const[]){farm->command[0], NULL});
    if (paints)
        add_all(words, (const char *const[]){"--region", variable, "--no-frames", "--no-clobber",
                                             "--paint-area=region", NULL});
    else if (in_parts)
        add_all(words, (const char *const[]){"--part", variable, NULL});
    add_all(words, (const char *const[]){"--paint", farm->paint, NULL});
    if (!paints)
        add_all(words, (const char *const[]){"--merge", keeps ? "--no-clobber" : NULL, NULL});
    for (const char *const *word = farm->command + 1; *word;) {
        const int skipped = paints ? words_of_merge(word) : 0;
        if (skipped == 0)
            g_ptr_array_add(words, g_strdup(*word));
        word += MAX(skipped, 1);
    }
    return words;
}

/* The words from `first` up to `end`, each as `add` writes it. */
static char *join(const GPtrArray *words, guint first, guint end,
                  void (*add)(GString *text, const char *word), const char *separator)
{
    GString *text = g_string_new(NULL);
    for (guint k = first; k < end; k++) {
        g_string_append(text, k > first ? separator : "");
        add(text, words->pdata[k]);
    }
    return g_string_free(text, FALSE);
}

/* ---- JSON ----------------------------------------------------------------------------------- */

static bool is_text(const char *word)
{
    return g_utf8_validate(word, -1, NULL);
}

static bool refuse_word(const char *word, const char *dialect, GError **error)
{
    g_autofree char *shown = g_strescape(word, NULL);
    return fl_fail(error, FL_ERROR_USAGE,
                   "“%s”: %s cannot hold this name; rename it, or plan for another scheduler",
                   shown, dialect);
}

/* Fails if a dialect cannot express a name exactly, since it would be read as another name. */
static bool words_fit(const Farm *farm, const char *dialect, bool (*fits)(const char *),
                      GError **error)
{
    if (!is_text(farm->folder))
        return refuse_word(farm->folder, dialect, error);
    for (Step step = STEP_PAINT; step <= STEP_FILM; step++) {
        g_autoptr(GPtrArray) words = words_of(farm, step, "");
        for (guint k = 0; k < words->len; k++)
            if (!fits(words->pdata[k]))
                return refuse_word(words->pdata[k], dialect, error);
    }
    return true;
}

static char *json_list(const GPtrArray *words)
{
    return join(words, 0, words->len, fl_json_string, ", ");
}

static void add_json_step(GString *text, const char *name, const Farm *farm, Step step)
{
    g_autoptr(GPtrArray) variables = variables_of(farm, step);
    fl_json_begin(text, name, '[');
    for (guint k = 0; k < variables->len; k++) {
        g_autoptr(GPtrArray) words = words_of(farm, step, variables->pdata[k]);
        g_autofree char *command = json_list(words);
        fl_json_begin(text, NULL, '{');
        fl_json_text(text, step == STEP_PAINT ? "regions" : "part", variables->pdata[k]);
        if (step == STEP_PAINT)
            fl_json_number(text, "share", g_array_index(farm->tasks, Task, k).share, true);
        g_string_append_printf(text, ",\"command\":[%s]}", command);
    }
    g_string_append_c(text, ']');
}

static char *print_json(const Farm *farm, GError **error)
{
    if (!words_fit(farm, "JSON", is_text, error))
        return NULL;
    GString *text = g_string_new("{");
    fl_json_text(text, "shot", farm->shot);
    fl_json_text(text, "folder", farm->folder);
    fl_json_number(text, "frames", farm->plan->shapes.n_frames, true);
    fl_json_number(text, "again_status", 75, true);
    add_json_step(text, "tasks", farm, STEP_PAINT);
    add_json_step(text, "merge", farm, STEP_MERGE);
    add_json_step(text, "film", farm, STEP_FILM);
    return g_string_free(g_string_append(text, "}\n"), FALSE);
}

/* ---- Slurm ---------------------------------------------------------------------------------- */

/**
 * Adds a word of bash that stands for exactly these bytes. All but harmless ASCII is an octal
 * escape, so that no name ends a line, a here-document or a quotation.
 */
static void add_bash_word(GString *text, const char *word)
{
    static const char *const harmless = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                        "0123456789_./,:@%+-";
    if (*word && word[strspn(word, harmless)] == '\0') {
        g_string_append(text, word);
        return;
    }
    g_string_append(text, "$'");
    for (; *word; word++)
        if (strchr(harmless, *word) || strchr(" ={}()[]", *word))
            g_string_append_c(text, *word);
        else
            g_string_append_printf(text, "\\%03o", (unsigned char)*word);
    g_string_append_c(text, '\'');
}

static const struct {
    const char *variable, *label, *end;
} slurm_steps[] = {[STEP_PAINT] = {"tasks", "", "TASKS"},
                   [STEP_MERGE] = {"merge", "merge ", "MERGE"},
                   [STEP_FILM] = {"film", "", "FILM"}};

/* The command of a step, with $what for the word in which the commands differ. */
static char *slurm_command(const Farm *farm, Step step)
{
    g_autoptr(GPtrArray) words = words_of(farm, step, "");
    if (step == STEP_MERGE && farm->n_parts == 1)
        return join(words, 0, words->len, add_bash_word, " ");
    g_autofree char *before = join(words, 0, VARIABLE, add_bash_word, " ");
    g_autofree char *after = join(words, VARIABLE + 1, words->len, add_bash_word, " ");
    return g_strdup_printf("%s \"$what\" %s", before, after);
}

/* The other options of sbatch for a step: its commands are an array, and another step comes first.
 */
static char *slurm_options(const Farm *farm, Step step)
{
    const int n = n_commands(farm, step);
    g_autofree char *array =
        step == STEP_PAINT || n > 1 ? g_strdup_printf(" --array=0-%d", n - 1) : g_strdup("");
    return step > STEP_PAINT ? g_strdup_printf("%s --dependency=afterok:\"${%s%%%%;*}\"", array,
                                               slurm_steps[step - 1].variable)
                             : g_steal_pointer(&array);
}

/**
 * Submits a step that starts after the previous one. Its log lines begin with shot and regions. A
 * task that is told to stop ends with 75 and is queued again while Slurm calls it "RUNNING": a
 * cancelled task is not, and one that Slurm requeues by itself waits already.
 */
static void add_slurm_step(GString *text, const Farm *farm, Step step)
{
    g_autoptr(GPtrArray) variables = variables_of(farm, step);
    g_autofree char *command = slurm_command(farm, step), *options = slurm_options(farm, step);
    g_autofree char *all = join(variables, 0, variables->len, add_bash_word, "\n");
    g_autoptr(GString) shot = g_string_new(NULL);
    add_bash_word(shot, farm->shot);
    g_string_append_printf(
        text,
        "%s=$(sbatch --parsable --requeue --open-mode=append --signal=B:TERM@60 --job-name=%s%s "
        "\"$@\" <<'%s'\n"
        "#!/bin/bash\n"
        "shot=%s\n"
        "all=(\n%s\n)\n"
        "what=${all[${SLURM_ARRAY_TASK_ID:-0}]}\n"
        "label=\"$(printf %%q \"$shot\") %s$what\"\n"
        "exec > >(while IFS= read -r line || [ -n \"$line\" ]; do\n"
        "    printf '%%s: %%s\\n' \"$label\" \"$line\"\n"
        "done) 2>&1\n"
        "%s --progress plain &\n"
        "job=$! stopped=\n"
        "trap 'stopped=yes; kill -TERM $job' TERM INT\n"
        "wait $job; status=$?\n"
        "[ -z \"$stopped\" ] || { wait $job; status=$?; }\n"
        "if [ $status = 75 ]; then\n"
        "    case $(squeue -h -j \"$SLURM_JOB_ID\" -o %%T) in\n"
        "    RUNNING | '') scontrol requeue \"$SLURM_JOB_ID\" ;;\n"
        "    esac\n"
        "fi\n"
        "exit $status\n"
        "%s\n)\n",
        slurm_steps[step].variable, shot->str, options, slurm_steps[step].end, shot->str, all,
        slurm_steps[step].label, command, slurm_steps[step].end);
}

static char *print_slurm(const Farm *farm, GError **error)
{
    (void)error; // bash holds every name
    GString *text = g_string_new("#!/bin/bash\n");
    g_string_append_printf(text,
                           "# %d regions in %u tasks, largest first, and then a merge of %d "
                           "part%s%s.\n"
                           "# Run it with bash; its arguments are handed on to sbatch.\n"
                           "set -eu\ncd ",
                           count_painted(farm->plan), farm->tasks->len, farm->n_parts,
                           farm->n_parts > 1 ? "s" : "", farm->film ? ", and the film" : "");
    add_bash_word(text, farm->folder);
    g_string_append_c(text, '\n');
    Step last = STEP_PAINT;
    for (Step step = STEP_PAINT; step <= STEP_FILM; step++)
        if (n_commands(farm, step) > 0)
            add_slurm_step(text, farm, step), last = step;
    g_string_append_printf(text, "echo \"$%s\"\n", slurm_steps[last].variable);
    return g_string_free(text, FALSE);
}

/* ---- Open Job Description ------------------------------------------------------------------- */

static const struct {
    const char *name, *parameter, *after;
} openjd_steps[] = {
    [STEP_PAINT] = {"Paint", "Regions", ""},
    [STEP_MERGE] = {"Merge", "Part", ",\"dependencies\":[{\"dependsOn\":\"Paint\"}]"},
    [STEP_FILM] = {"Film", "Part", ",\"dependencies\":[{\"dependsOn\":\"Merge\"}]"}};

/* The schema takes double braces as references, allows no control characters in an argument, and
 * knows no escapes. */
static bool is_argument(const char *word)
{
    if (!is_text(word) || strstr(word, "{{") || strstr(word, "}}"))
        return false;
    for (; *word; word = g_utf8_next_char(word))
        if (g_unichar_iscntrl(g_utf8_get_char(word)))
            return false;
    return true;
}

/* A task runs in the folder of the plan, a parameter that the scheduler may map to another path. */
static void add_openjd_step(GString *text, const Farm *farm, Step step)
{
    const char *parameter = openjd_steps[step].parameter;
    g_autofree char *variable = g_strdup_printf("{{Task.Param.%s}}", parameter);
    g_autoptr(GPtrArray) words = words_of(farm, step, variable);
    g_autoptr(GPtrArray) variables = variables_of(farm, step);
    g_autofree char *args = json_list(words), *range = json_list(variables);
    fl_json_begin(text, NULL, '{');
    fl_json_text(text, "name", openjd_steps[step].name);
    g_string_append_printf(
        text,
        "%s,\n \"parameterSpace\":{\"taskParameterDefinitions\":["
        "{\"name\":\"%s\",\"type\":\"STRING\",\"range\":[%s]}]},\n "
        "\"script\":{\"actions\":{\"onRun\":"
        "{\"command\":\"bash\",\"args\":[\"-c\",\"cd -- \\\"$0\\\" && exec \\\"$@\\\"\","
        "\"{{Param.Folder}}\",%s]}}}}",
        openjd_steps[step].after, parameter, range, args);
}

/* The name of a job has 128 characters at most. */
static char *print_openjd(const Farm *farm, GError **error)
{
    if (!words_fit(farm, "Open Job Description", is_argument, error))
        return NULL;
    g_autofree char *name =
        g_utf8_substring(farm->shot, 0, MIN(128, g_utf8_strlen(farm->shot, -1)));
    GString *text = g_string_new("{");
    fl_json_text(text, "specificationVersion", "jobtemplate-2023-09");
    fl_json_text(text, "name", name);
    g_string_append(text, ",\n\"parameterDefinitions\":[{\"name\":\"Folder\",\"type\":\"PATH\","
                          "\"objectType\":\"DIRECTORY\",\"dataFlow\":\"INOUT\"");
    fl_json_text(text, "default", farm->folder);
    g_string_append(text, "}]");
    fl_json_begin(text, "steps", '[');
    for (Step step = STEP_PAINT; step <= STEP_FILM; step++)
        if (n_commands(farm, step) > 0)
            add_openjd_step(text, farm, step);
    return g_string_free(g_string_append(text, "]}\n"), FALSE);
}

/* ---- the plan ------------------------------------------------------------------------------- */

static char *(*const printers[])(const Farm *, GError **) = {
    [FL_FARM_SLURM] = print_slurm, [FL_FARM_OPENJD] = print_openjd, [FL_FARM_JSON] = print_json};

/* A pattern for the files between tasks and merge: of the options, or beside the usual frames. */
static char *paint_pattern(const FlPlan *plan)
{
    if (plan->options.paint)
        return g_strdup(plan->out.paint);
    g_autoptr(GString) name = g_string_new(fl_drawing_name(plan->shapes.drawing));
    g_string_replace(name, "%", "%%", 0);
    return g_strdup_printf("fluidy/%s_paint/{region}_%%04d.png", name->str);
}

char *fl_farm_plan(const FlRenderOptions *options, FlFarm farm, const char *const *command,
                   GError **error)
{
    FlRenderOptions whole = *options;
    whole.dry_run = true; // only plans
    whole.cache = NULL;
    whole.merge = true; // the merge's visible regions are painted
    whole.paint = options->paint ? options->paint : "{region}_%04d.png";
    if (options->only_region || options->merge || options->part || options->report ||
        options->dump || options->ebsynth)
        return fl_none(error, FL_ERROR_USAGE,
                       "a plan is of all regions and their merge; leave out ‘region’, ‘merge’, "
                       "‘part’, ‘report’, ‘dump’ and ‘ebsynth’");
    g_autoptr(FlPlan) plan = fl_plan_new(&whole, error);
    if (!plan)
        return NULL;
    if (count_painted(plan) == 0)
        return fl_none(error, FL_ERROR_USAGE,
                       "%s: no region is painted, so that there is "
                       "nothing to plan",
                       fl_drawing_name(plan->shapes.drawing));
    Farm all = {.plan = plan,
                .shot = fl_drawing_name(plan->shapes.drawing),
                .folder = g_get_current_dir(),
                .paint = paint_pattern(plan),
                .command = command,
                .n_parts = count_parts(plan),
                .tasks = fl_array_of(Task, clear_task)};
    all.film = all.n_parts > 1 && plan->out.movie;
    make_tasks(&all);
    char *text = printers[farm](&all, error);
    g_array_unref(all.tasks);
    g_free(all.paint);
    g_free(all.folder);
    return text;
}
