#include "base/json.h"
#include "job/plan.h"
#include <fluidy/inspect.h>
#include <string.h>

/* A task: regions that are painted by one process. */
typedef struct Task {
    GString *regions; // with commas between
    double share;     // of the whole work
} Task;

/* What a plan is printed from. */
typedef struct Farm {
    const FlPlan *plan;
    char *folder, *paint;       // the working directory; the files between tasks and merge
    const char *const *command; // the render's
    GArray *tasks;              // of Task, largest first
} Farm;

static void clear_task(Task *task)
{
    g_string_free(task->regions, TRUE);
}

/* ---- tasks ---------------------------------------------------------------------------------- */

/* Time follows the painted area; a region that is held is painted that much less often. */
static double work_of(const FlPlan *plan, int p)
{
    const FlRegionPlan *painted = &plan->painted[p];
    const FlRegion *region = fl_drawing_region(plan->drawing, painted->region);
    return region->area_px * region->n_present / painted->settings.hold;
}

static int larger_first(const void *a, const void *b, void *plan)
{
    const int p = *(const int *)a, q = *(const int *)b;
    const double x = work_of(plan, p), y = work_of(plan, q);
    return x != y ? (x < y) - (x > y) : p - q;
}

static void add_task(Farm *farm, int p, double share)
{
    const Task task = {g_string_new(farm->plan->painted[p].name), share};
    g_array_append_val(farm->tasks, task);
}

/* Every task reads the whole drawing, so none is smaller than a quarter of the largest region or a
 * sixty-fourth of the work: small regions share one. */
static void make_tasks(Farm *farm)
{
    const FlPlan *plan = farm->plan;
    const int n = plan->n_painted;
    g_autofree int *order = g_new(int, n);
    double total = 0, filled = 0;
    for (int p = 0; p < n; p++)
        order[p] = p, total += work_of(plan, p);
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
        g_string_append_printf(task->regions, ",%s", plan->painted[order[k]].name);
        task->share += work / total;
        filled += work;
    }
}

/* ---- commands ------------------------------------------------------------------------------- */

/* How many words from here on are of the merge alone: what it writes, and what exists of that. */
static int words_of_merge(const char *const *word)
{
    static const char *const values[] = {"-o", "--output", "--layers", "--stats", NULL};
    static const char *const flags[] = {"-y", "--overwrite", "--no-clobber", "--resume", NULL};
    g_autofree char *name = g_strndup(*word, strcspn(*word, "="));
    if (g_strv_contains(flags, *word) || (strchr(*word, '=') && g_strv_contains(values, name)))
        return 1;
    return g_strv_contains(values, *word) && word[1] ? 2 : 0;
}

/* The words of a command; `regions`: those of a task, NULL: the merge. To be freed. */
static GPtrArray *words_of(const Farm *farm, const char *regions)
{
    const char *const task[] = {"--region", regions, "--no-frames", "--no-clobber", NULL};
    const char *const merge[] = {"--merge", NULL};
    GPtrArray *words = g_ptr_array_new_with_free_func(g_free);
    const char *const *more = regions ? task : merge;
    g_ptr_array_add(words, g_strdup(farm->command[0]));
    for (; *more; more++)
        g_ptr_array_add(words, g_strdup(*more));
    g_ptr_array_add(words, g_strdup("--paint"));
    g_ptr_array_add(words, g_strdup(farm->paint));
    for (const char *const *word = farm->command + 1; *word;) {
        const int skipped = regions ? words_of_merge(word) : 0;
        if (skipped == 0)
            g_ptr_array_add(words, g_strdup(*word));
        word += MAX(skipped, 1);
    }
    return words;
}

static void add_words(GString *text, const Farm *farm, const char *regions, bool shell)
{
    g_autoptr(GPtrArray) words = words_of(farm, regions);
    for (guint k = 0; k < words->len; k++) {
        const char *word = words->pdata[k];
        const bool variable = regions && shell && word == words->pdata[2]; // "$regions"
        g_autofree char *quoted = variable ? g_strdup("\"$regions\"") : g_shell_quote(word);
        if (k > 0)
            g_string_append(text, shell ? " " : ", ");
        if (shell)
            g_string_append(text, quoted);
        else
            fl_json_string(text, word);
    }
}

/* ---- Slurm ---------------------------------------------------------------------------------- */

/**
 * Log lines say shot and region; a task that is told to stop ends with 75 and is queued again,
 * unless it is no more "RUNNING": who cancelled it does not want it back, and what Slurm requeues
 * waits already.
 */
static void add_slurm_body(GString *text, const Farm *farm, bool merge)
{
    g_string_append(text, "exec > >(sed -u \"s|^|$shot $regions: |\") 2>&1\n");
    add_words(text, farm, merge ? NULL : "", true);
    g_string_append(text, " --progress plain &\n"
                          "job=$! stopped=\n"
                          "trap 'stopped=yes; kill -TERM $job' TERM INT\n"
                          "wait $job; status=$?\n"
                          "[ -z \"$stopped\" ] || { wait $job; status=$?; }\n"
                          "if [ $status = 75 ]; then\n"
                          "    case $(squeue -h -j \"$SLURM_JOB_ID\" -o %T) in\n"
                          "    RUNNING | '') scontrol requeue \"$SLURM_JOB_ID\" ;;\n"
                          "    esac\n"
                          "fi\n"
                          "exit $status\n");
}

static char *print_slurm(const Farm *farm)
{
    const char *name = fl_drawing_name(farm->plan->drawing);
    g_autofree char *shot = g_shell_quote(name), *folder = g_shell_quote(farm->folder);
    GString *text = g_string_new("#!/bin/bash\n");
    g_string_append_printf(text,
                           "# %s: %d regions in %u tasks, largest first, and then the merge.\n"
                           "# Run it with bash; its arguments are handed on to sbatch.\n"
                           "set -eu\ncd %s\n"
                           "tasks=$(sbatch --parsable --requeue --open-mode=append "
                           "--signal=B:TERM@60 --array=0-%u --job-name=%s \"$@\" <<'TASKS'\n"
                           "#!/bin/bash\nshot=%s\nall=(\n",
                           name, farm->plan->n_painted, farm->tasks->len, folder,
                           farm->tasks->len - 1, shot, shot);
    for (guint k = 0; k < farm->tasks->len; k++)
        g_string_append_printf(text, "%s\n", g_array_index(farm->tasks, Task, k).regions->str);
    g_string_append(text, ")\nregions=${all[$SLURM_ARRAY_TASK_ID]}\n");
    add_slurm_body(text, farm, false);
    g_string_append_printf(
        text,
        "TASKS\n)\n"
        "sbatch --parsable --requeue --open-mode=append --signal=B:TERM@60 "
        "--dependency=afterok:\"${tasks%%%%;*}\" --job-name=%s \"$@\" <<'MERGE'\n"
        "#!/bin/bash\nshot=%s regions=merge\n",
        shot, shot);
    add_slurm_body(text, farm, true);
    g_string_append(text, "MERGE\n");
    return g_string_free(text, FALSE);
}

/* ---- JSON ----------------------------------------------------------------------------------- */

static char *print_json(const Farm *farm)
{
    GString *text = g_string_new("{");
    fl_json_text(text, "shot", fl_drawing_name(farm->plan->drawing));
    fl_json_text(text, "folder", farm->folder);
    fl_json_number(text, "frames", fl_drawing_frames(farm->plan->drawing), true);
    fl_json_number(text, "again_status", 75, true);
    g_string_append(text, ",\n \"tasks\": [");
    for (guint k = 0; k < farm->tasks->len; k++) {
        const Task *task = &g_array_index(farm->tasks, Task, k);
        g_string_append(text, k > 0 ? ",\n  {" : "\n  {");
        fl_json_text(text, "regions", task->regions->str);
        fl_json_number(text, "share", task->share, true);
        g_string_append(text, ", \"command\": [");
        add_words(text, farm, task->regions->str, false);
        g_string_append(text, "]}");
    }
    g_string_append(text, "],\n \"merge\": {\"command\": [");
    add_words(text, farm, NULL, false);
    g_string_append(text, "]}\n}\n");
    return g_string_free(text, FALSE);
}

/* ---- Open Job Description ------------------------------------------------------------------- */

static void add_action(GString *text, const Farm *farm, const char *regions)
{
    g_autoptr(GPtrArray) words = words_of(farm, regions);
    g_string_append(text, "\"script\": {\"actions\": {\"onRun\": {");
    fl_json_text(text, "command", words->pdata[0]);
    g_string_append(text, ", \"args\": [");
    for (guint k = 1; k < words->len; k++) {
        g_string_append(text, k > 1 ? ", " : "");
        fl_json_string(text, words->pdata[k]);
    }
    g_string_append(text, "]}}}");
}

/* Tasks start in the folder in which the template was made, which Open Job Description knows not
 * how to say: relative names want a session that starts there. */
static char *print_openjd(const Farm *farm)
{
    GString *text = g_string_new("{");
    fl_json_text(text, "specificationVersion", "jobtemplate-2023-09");
    fl_json_text(text, "name", fl_drawing_name(farm->plan->drawing));
    g_string_append(text, ",\n \"steps\": [\n  {\"name\": \"Paint\", \"parameterSpace\": "
                          "{\"taskParameterDefinitions\": [{\"name\": \"Regions\", \"type\": "
                          "\"STRING\", \"range\": [");
    for (guint k = 0; k < farm->tasks->len; k++) {
        g_string_append(text, k > 0 ? ", " : "");
        fl_json_string(text, g_array_index(farm->tasks, Task, k).regions->str);
    }
    g_string_append(text, "]}]},\n   ");
    add_action(text, farm, "{{Task.Param.Regions}}");
    g_string_append(text, "},\n  {\"name\": \"Merge\", \"dependencies\": [{\"dependsOn\": "
                          "\"Paint\"}],\n   ");
    add_action(text, farm, NULL);
    g_string_append(text, "}\n ]\n}\n");
    return g_string_free(text, FALSE);
}

/* ---- the plan ------------------------------------------------------------------------------- */

static char *(*const printers[])(const Farm *) = {
    [FL_FARM_SLURM] = print_slurm, [FL_FARM_OPENJD] = print_openjd, [FL_FARM_JSON] = print_json};

/* A pattern for the files between tasks and merge: that of ‘paint’, or beside the usual frames. */
static char *paint_pattern(const FlPlan *plan)
{
    if (plan->options.paint)
        return g_strdup(plan->options.paint);
    g_autoptr(GString) name = g_string_new(fl_drawing_name(plan->drawing));
    g_string_replace(name, "%", "%%", 0);
    return g_strdup_printf("fluidy/%s_paint/{region}_%%04d.png", name->str);
}

char *fl_farm_plan(const FlRenderOptions *options, FlFarm farm, const char *const *command,
                   GError **error)
{
    FlRenderOptions whole = *options;
    whole.dry_run = true; // nothing is written
    whole.cache = NULL;
    if (options->only_region || options->merge || options->report || options->dump ||
        options->ebsynth) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "a plan is of all regions and their merge; leave out ‘region’, ‘merge’, "
                    "‘report’, ‘dump’ and ‘ebsynth’");
        return NULL;
    }
    g_autoptr(FlPlan) plan = fl_plan_new(&whole, error);
    if (!plan)
        return NULL;
    if (plan->n_painted == 0) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "%s: no region is painted, so that there is "
                    "nothing to plan",
                    fl_drawing_name(plan->drawing));
        return NULL;
    }
    Farm all = {.plan = plan,
                .folder = g_get_current_dir(),
                .paint = paint_pattern(plan),
                .command = command,
                .tasks = g_array_new(FALSE, FALSE, sizeof(Task))};
    g_array_set_clear_func(all.tasks, (GDestroyNotify)clear_task);
    make_tasks(&all);
    char *text = printers[farm](&all);
    g_array_unref(all.tasks);
    g_free(all.paint);
    g_free(all.folder);
    return text;
}
