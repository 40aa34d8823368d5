#include "job/outputs.h"

#include "base/json.h"
#include "io/atomic_file.h"
#include "io/pattern.h"
#include "job/paint_files.h"
#include "job/plan_facts.h"
#include "params/options.h"

bool fl_frame_has_picture(const FlPlan *plan)
{
    return !plan->format->film && !plan->parts_only;
}

/* Takes the name. Returns: false if it is NULL. */
static bool add(GPtrArray *files, char *name)
{
    if (name)
        g_ptr_array_add(files, name);
    return name != NULL;
}

GPtrArray *fl_frame_files(const FlPlan *plan, int frame, GError **error)
{
    const FlShapes *shapes = &plan->shapes;
    const FlRenderOptions *o = &plan->options;
    const int number = fl_drawing_number(shapes->drawing, frame);
    g_autoptr(GPtrArray) files = g_ptr_array_new_with_free_func(g_free);
    if (fl_frame_has_picture(plan) &&
        !add(files, fl_output_name(plan->output, number, NULL, error)))
        return NULL;
    for (int p = 0; p < shapes->n_painted; p++) {
        const FlRegionPlan *region = &shapes->painted[p];
        if (o->layers && !add(files, fl_output_name(o->layers, number, region->name, error)))
            return NULL;
        if (o->paint && !o->merge && frame % region->settings.hold == 0 &&
            !add(files, fl_paint_file_name(o->paint, shapes->drawing, region, frame, error)))
            return NULL;
    }
    return g_steal_pointer(&files);
}

/* ---- the guard ------------------------------------------------------------------------------- */

static bool may_write(const FlPlan *plan, char *name, GError **error)
{
    return fl_inputs_may_write(plan->inputs, plan->shapes.drawing, name, error);
}

/* Checks the files in a folder of each region, below `in`, which may be NULL. */
static bool may_fill_folders(const FlPlan *plan, const char *in, GError **error)
{
    for (int p = 0; in && p < plan->shapes.n_painted; p++) {
        g_autofree char *folder = g_build_filename(in, plan->shapes.painted[p].name, NULL);
        g_autoptr(GDir) dir = g_dir_open(folder, 0, NULL);
        for (const char *name; dir && (name = g_dir_read_name(dir));)
            if (!may_write(plan, g_build_filename(folder, name, NULL), error))
                return false;
    }
    return true;
}

static bool may_write_frame(const FlPlan *plan, int frame, GError **error)
{
    g_autoptr(GPtrArray) files = fl_frame_files(plan, frame, NULL); // its mistakes are told later
    for (guint k = 0; files && k < files->len; k++)
        if (!may_write(plan, g_strdup(files->pdata[k]), error))
            return false;
    return true;
}

bool fl_guard_inputs(const FlPlan *plan, GError **error)
{
    const FlRenderOptions *o = &plan->options;
    char *report = o->report ? g_build_filename(o->report, "index.html", NULL) : NULL;
    if (!may_write(plan, report, error) ||
        !may_write(plan, g_strdup(plan->format->film ? plan->output : NULL), error) ||
        !may_write(plan, g_strdup(plan->movie), error) ||
        !may_write(plan, g_strdup(o->stats), error) ||
        !may_write(plan, g_strdup(o->provenance), error) ||
        !may_fill_folders(plan, o->dump, error) ||
        !may_fill_folders(plan, o->merge ? NULL : o->ebsynth, error))
        return false;
    for (int f = 0; f < plan->shapes.n_frames; f++)
        if (!may_write_frame(plan, f, error))
            return false;
    return true;
}

bool fl_guard_pictures(const FlDrawing *drawing, const FlRenderOptions *options,
                       const char *pattern, GError **error)
{
    g_autoptr(FlInputs) inputs = fl_inputs_new(NULL, NULL);
    fl_inputs_add_drawing(inputs, drawing);
    fl_inputs_add_options(inputs, options, drawing, NULL);
    for (size_t k = 0; k < options->n_settings; k++)
        if (fl_option_names_style(options->settings[k].name))
            fl_inputs_add_style(inputs, options->settings[k].value);
    for (int f = 0; f < fl_drawing_frames(drawing); f++) {
        char *path = fl_output_name(pattern, fl_drawing_number(drawing, f), NULL, NULL);
        if (!fl_inputs_may_write(inputs, drawing, path, error))
            return false;
    }
    return true;
}

/* ---- provenance ------------------------------------------------------------------------------ */

/** The SHA-256 of a file, to be freed; NULL: it cannot be read. */
static char *sum_of(const char *path)
{
    g_autoptr(GMappedFile) file = g_mapped_file_new(path, FALSE, NULL);
    return file ? g_compute_checksum_for_data(G_CHECKSUM_SHA256,
                                              (const guchar *)g_mapped_file_get_contents(file),
                                              g_mapped_file_get_length(file))
                : NULL;
}

/** A file that was made anew or kept; paint that is no file of this run is left out. */
static void put_file(GString *json, const char *path)
{
    g_autofree char *sum = sum_of(path);
    if (sum)
        fl_json_text(json, path, sum);
}

static bool put_files(GString *json, const FlPlan *plan, GError **error)
{
    for (int f = plan->first; f < plan->end; f++) {
        g_autoptr(GPtrArray) files = fl_frame_files(plan, f, error);
        for (guint k = 0; files && k < files->len; k++)
            put_file(json, files->pdata[k]);
        if (!files)
            return false;
    }
    if (plan->format->film || plan->movie)
        put_file(json, plan->format->film ? plan->output : plan->movie);
    return true;
}

bool fl_write_provenance(const FlPlan *plan, GError **error)
{
    const FlRenderOptions *o = &plan->options;
    g_auto(FlAtomicFile) file = {0};
    g_autoptr(GString) json = g_string_new("{\"facts\":[");
    if (!o->provenance)
        return true;
    g_autoptr(FlFacts) facts = fl_plan_facts(plan);
    for (guint k = 0; k < facts->list->len; k++) {
        const FlFact *fact = &g_array_index(facts->list, FlFact, k);
        g_string_append(json, k ? ",[" : "[");
        fl_json_string(json, fact->name);
        g_string_append_c(json, ',');
        fl_json_string(json, fact->value);
        g_string_append_c(json, ']');
    }
    g_string_append(json, "],\"sha256\":{");
    if (!put_files(json, plan, error) ||
        !fl_atomic_open(&file, o->provenance, o->overwrite != FL_OVERWRITE_REFUSE, error))
        return false;
    g_string_append(json, "}}\n");
    fputs(json->str, file.stream);
    return fl_atomic_commit(&file, error);
}
