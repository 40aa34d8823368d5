#include "job/guard.h"

#include "base/style_parts.h"
#include "io/pattern.h"
#include "job/paint_files.h"
#include "params/options.h"
#include <string.h>
#include <sys/stat.h>

/* A file whatever its name, as a key; to be freed. */
static char *key_of(const struct stat *status)
{
    return g_strdup_printf("%ju:%ju", (uintmax_t)status->st_dev, (uintmax_t)status->st_ino);
}

static void add_style(GPtrArray *inputs, const char *folder)
{
    static const char *const parts[] = {FL_STYLE_PARTS};
    for (size_t k = 0; k < G_N_ELEMENTS(parts); k++) {
        char *part = g_build_filename(folder, parts[k], NULL);
        g_ptr_array_add(inputs, part);
        g_autoptr(GDir) dir = g_dir_open(part, 0, NULL);
        const char *name;
        while (dir && (name = g_dir_read_name(dir)))
            g_ptr_array_add(inputs, g_build_filename(part, name, NULL));
    }
}

/* The files of an option that may name one per frame; region: NULL for those of none. */
static void add_frames(GPtrArray *inputs, const FlDrawing *drawing, const char *region,
                       const char *pattern)
{
    if (pattern)
        g_ptr_array_add(inputs, g_strdup(pattern));
    for (int f = 0; pattern && f < fl_drawing_frames(drawing); f++) {
        char *path = fl_output_name(pattern, fl_drawing_number(drawing, f), region, NULL);
        if (path)
            g_ptr_array_add(inputs, path);
    }
}

/* The same where the name may be that of a region as well. */
static void add_named(GPtrArray *inputs, const FlPlan *plan, const char *pattern)
{
    for (int p = 0; p < MAX(plan->n_painted, 1); p++)
        add_frames(inputs, plan->drawing, p < plan->n_painted ? plan->painted[p].name : NULL,
                   pattern);
}

static void add_linked(GPtrArray *inputs, const FlDrawing *drawing)
{
    GHashTableIter at;
    gpointer path;
    g_hash_table_iter_init(&at, fl_drawing_linked_files(drawing));
    while (g_hash_table_iter_next(&at, &path, NULL))
        g_ptr_array_add(inputs, g_strdup(path));
}

GPtrArray *fl_guard_list_inputs(const FlPlan *plan)
{
    const FlRenderOptions *o = &plan->options;
    GPtrArray *inputs = g_ptr_array_new_with_free_func(g_free);
    for (int f = 0; f < fl_drawing_frames(plan->drawing); f++)
        g_ptr_array_add(inputs, g_strdup(fl_drawing_file(plan->drawing, f)));
    add_linked(inputs, plan->drawing);
    for (int p = 0; p < plan->n_painted; p++) {
        if (p == 0 || plan->painted[p].style != plan->painted[p - 1].style)
            add_style(inputs, plan->painted[p].style->path);
        if (plan->painted[p].tile && (p == 0 || plan->painted[p].tile != plan->painted[p - 1].tile))
            add_style(inputs, plan->painted[p].tile->path);
    }
    if (o->config)
        g_ptr_array_add(inputs, g_strdup(o->config));
    add_named(inputs, plan, o->background);
    if (o->paper)
        g_ptr_array_add(inputs, g_strdup(o->paper));
    add_named(inputs, plan, o->flow);
    if (o->merge)
        add_named(inputs, plan, o->paint);
    return inputs;
}

/* A link and what it leads to are both read; what is not there is told by its reader. A
 * style's folder is never written to. Adds drawings of frames that are not wanted to paths. */
static GHashTable *collect(const FlDrawing *drawing, GPtrArray *paths)
{
    GHashTable *inputs = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    for (const char *const *file = fl_drawing_found_files(drawing); *file; file++)
        g_ptr_array_add(paths, g_strdup(*file));
    for (guint k = 0; k < paths->len; k++) {
        struct stat status;
        if (lstat(paths->pdata[k], &status) == 0)
            g_hash_table_add(inputs, key_of(&status));
        if (stat(paths->pdata[k], &status) == 0)
            g_hash_table_add(inputs, key_of(&status));
    }
    return inputs;
}

/* A link that is written to is replaced itself. Takes the name; NULL: a mistake told elsewhere. */
static bool may_write(GHashTable *inputs, char *name, GError **error)
{
    g_autofree char *path = name;
    struct stat status;
    if (!path || lstat(path, &status) != 0)
        return true;
    g_autofree char *key = key_of(&status);
    if (!g_hash_table_contains(inputs, key))
        return true;
    g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                "%s: is read by this render; expected another name for what it writes", path);
    return false;
}

/* Whether no file of a folder that is written to is read. */
static bool may_fill(GHashTable *inputs, const char *folder, GError **error)
{
    g_autoptr(GDir) dir = g_dir_open(folder, 0, NULL);
    const char *name;
    while (dir && (name = g_dir_read_name(dir)))
        if (!may_write(inputs, g_build_filename(folder, name, NULL), error))
            return false;
    return true;
}

/* The folders of the regions in one; NULL: none. */
static bool check_regions_folders(const FlPlan *plan, const char *in, GHashTable *inputs,
                                  GError **error)
{
    for (int p = 0; in && p < plan->n_painted; p++) {
        g_autofree char *folder = g_build_filename(in, plan->painted[p].name, NULL);
        if (!may_fill(inputs, folder, error))
            return false;
    }
    return true;
}

/* The page of a report and the folders of a dump and of guides. */
static bool check_folders(const FlPlan *plan, GHashTable *inputs, GError **error)
{
    const FlRenderOptions *o = &plan->options;
    if (o->report && !may_write(inputs, g_build_filename(o->report, "index.html", NULL), error))
        return false;
    return check_regions_folders(plan, o->dump, inputs, error) &&
           check_regions_folders(plan, o->merge ? NULL : o->ebsynth, inputs, error);
}

static bool check_frame(const FlPlan *plan, GHashTable *inputs, int frame, GError **error)
{
    const FlRenderOptions *o = &plan->options;
    const int number = fl_drawing_number(plan->drawing, frame);
    if (!plan->format->film &&
        !may_write(inputs, fl_output_name(plan->output, number, NULL, NULL), error))
        return false;
    for (int p = 0; p < plan->n_painted; p++) {
        const FlRegionPlan *region = &plan->painted[p];
        if (o->layers &&
            !may_write(inputs, fl_output_name(o->layers, number, region->name, NULL), error))
            return false;
        if (o->paint && !o->merge &&
            !may_write(inputs, fl_paint_file_name(o->paint, plan->drawing, region, frame, NULL),
                       error))
            return false;
    }
    return true;
}

bool fl_guard_inputs(const FlPlan *plan, GError **error)
{
    g_autoptr(GPtrArray) paths = fl_guard_list_inputs(plan);
    g_autoptr(GHashTable) inputs = collect(plan->drawing, paths);
    if ((plan->format->film && !may_write(inputs, g_strdup(plan->output), error)) ||
        !may_write(inputs, g_strdup(plan->movie), error) ||
        !may_write(inputs, g_strdup(plan->options.stats), error) ||
        !check_folders(plan, inputs, error))
        return false;
    for (int f = 0; f < fl_drawing_frames(plan->drawing); f++)
        if (!check_frame(plan, inputs, f, error))
            return false;
    return true;
}

bool fl_guard_pictures(const FlDrawing *drawing, const FlRenderOptions *options,
                       const char *pattern, GError **error)
{
    g_autoptr(GPtrArray) paths = g_ptr_array_new_with_free_func(g_free);
    add_linked(paths, drawing);
    for (size_t k = 0; k < options->n_settings; k++)
        if (fl_option_names_style(options->settings[k].name))
            add_style(paths, options->settings[k].value);
    if (options->config)
        g_ptr_array_add(paths, g_strdup(options->config));
    add_frames(paths, drawing, NULL, options->background);
    if (options->paper)
        g_ptr_array_add(paths, g_strdup(options->paper));
    g_autoptr(GHashTable) inputs = collect(drawing, paths);
    for (int f = 0; f < fl_drawing_frames(drawing); f++) {
        char *path = fl_output_name(pattern, fl_drawing_number(drawing, f), NULL, NULL);
        if (!may_write(inputs, path, error))
            return false;
    }
    return true;
}
