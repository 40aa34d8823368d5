#include "job/outputs.h"

#include "base/json.h"
#include "io/atomic_file.h"
#include "io/pattern.h"

bool fl_frame_has_picture(const FlOutputs *out)
{
    return !out->format->film && !out->parts_only;
}

void fl_outputs_part(const FlOutputs *out, int n_frames, int *first, int *end)
{
    *first = (int)((int64_t)n_frames * out->part / out->n_parts);
    *end = (int)((int64_t)n_frames * (out->part + 1) / out->n_parts);
}

/* Takes the name. Returns: false if it is NULL. */
static bool add(GPtrArray *files, char *name)
{
    if (name)
        g_ptr_array_add(files, name);
    return name != NULL;
}

GPtrArray *fl_frame_files(const FlOutputs *out, const FlShapes *shapes, int frame, GError **error)
{
    const int number = fl_drawing_number(shapes->drawing, frame);
    g_autoptr(GPtrArray) files = g_ptr_array_new_with_free_func(g_free);
    if (fl_frame_has_picture(out) && !add(files, fl_output_name(out->output, number, NULL, error)))
        return NULL;
    for (int p = 0; p < shapes->n_painted; p++) {
        const FlRegionPlan *region = &shapes->painted[p];
        if (out->layers && !add(files, fl_output_name(out->layers, number, region->name, error)))
            return NULL;
        if (out->paint && !out->merge && frame % region->settings.hold == 0 &&
            !add(files, fl_paint_file_name(out->paint, shapes->drawing, region, frame, error)))
            return NULL;
    }
    return g_steal_pointer(&files);
}

FlDigest fl_film_digest(const FlOutputs *out, FlDigest made_from)
{
    FlDigest digest = made_from;
    fl_digest_add_text(&digest, (out->movie ? out->movie_format : out->format)->name);
    fl_digest_add(&digest, &out->fps, sizeof out->fps);
    if (out->audio) {
        const FlDigest sound = fl_file_digest(out->audio);
        fl_digest_add(&digest, &sound, sizeof sound);
        fl_digest_add(&digest, &out->audio_from, sizeof out->audio_from);
    }
    return digest;
}

/* ---- the guard ------------------------------------------------------------------------------- */

/* Checks the files in a folder of each region, below `in`, which may be NULL. */
static bool may_fill_folders(const FlShapes *shapes, FlInputs *inputs, const char *in,
                             GError **error)
{
    for (int p = 0; in && p < shapes->n_painted; p++) {
        g_autofree char *folder = g_build_filename(in, shapes->painted[p].name, NULL);
        g_autoptr(GDir) dir = g_dir_open(folder, 0, NULL);
        for (const char *name; dir && (name = g_dir_read_name(dir));) {
            char *path = g_build_filename(folder, name, NULL);
            if (!fl_inputs_may_write(inputs, shapes->drawing, path, error))
                return false;
        }
    }
    return true;
}

bool fl_guard_inputs(const FlOutputs *out, const FlShapes *shapes, FlInputs *inputs, GError **error)
{
    g_autofree char *report =
        out->report ? g_build_filename(out->report, "index.html", NULL) : NULL;
    const char *const single[] = {report, out->format->film ? out->output : NULL, out->movie,
                                  out->stats, out->provenance};
    for (size_t k = 0; k < G_N_ELEMENTS(single); k++)
        if (!fl_inputs_may_write(inputs, shapes->drawing, g_strdup(single[k]), error))
            return false;
    for (int f = 0; f < shapes->n_frames; f++) {
        // mistakes of their names are told later
        g_autoptr(GPtrArray) files = fl_frame_files(out, shapes, f, NULL);
        for (guint k = 0; files && k < files->len; k++)
            if (!fl_inputs_may_write(inputs, shapes->drawing, g_strdup(files->pdata[k]), error))
                return false;
    }
    return may_fill_folders(shapes, inputs, out->dump, error) &&
           may_fill_folders(shapes, inputs, out->merge ? NULL : out->ebsynth, error);
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

static bool put_files(GString *json, const FlOutputs *out, const FlShapes *shapes, GError **error)
{
    for (int f = out->first; f < out->end; f++) {
        g_autoptr(GPtrArray) files = fl_frame_files(out, shapes, f, error);
        for (guint k = 0; files && k < files->len; k++)
            put_file(json, files->pdata[k]);
        if (!files)
            return false;
    }
    if (out->format->film || out->movie)
        put_file(json, out->format->film ? out->output : out->movie);
    return true;
}

bool fl_write_provenance(const FlOutputs *out, const FlShapes *shapes, const FlFacts *facts,
                         GError **error)
{
    g_auto(FlAtomicFile) file = {0};
    g_autoptr(GString) json = g_string_new("{\"facts\":[");
    for (guint k = 0; k < facts->list->len; k++) {
        const FlFact *fact = &g_array_index(facts->list, FlFact, k);
        fl_json_begin(json, NULL, '[');
        fl_json_text(json, NULL, fact->name);
        fl_json_text(json, NULL, fact->value);
        g_string_append_c(json, ']');
    }
    g_string_append(json, "],\"sha256\":{");
    if (!put_files(json, out, shapes, error) ||
        !fl_atomic_open(&file, out->provenance, out->overwrite != FL_OVERWRITE_REFUSE, error))
        return false;
    g_string_append(json, "}}\n");
    fputs(json->str, file.stream);
    return fl_atomic_commit(&file, error);
}
