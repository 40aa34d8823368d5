#include "job/finished.h"

#include "io/pattern.h"
#include "job/fingerprint.h"
#include "job/guard.h"
#include "style/style_folder.h"
#include <string.h>
#include <sys/stat.h>

// request, sum of the inputs, inputs, styles by name, frames and film with size and time
#define RECORD "((tt)(tt)asa(ss)a(sxx)a(sxx))"

static FlStore *cache_for(const FlPlan *plan)
{
    const FlRenderOptions *o = &plan->options;
    const bool more =
        o->layers || o->paint || o->stats || o->report || o->dump || o->ebsynth || o->dry_run;
    const bool piped = o->config && !g_file_test(o->config, G_FILE_TEST_IS_REGULAR);
    return more || piped ? NULL : plan->cache; // what came through a pipe cannot be read again
}

/* Where the record is: every render of these frames, or this film, has the same place. */
static FlDigest place_of(const FlPlan *plan)
{
    FlDigest place = {0};
    g_autofree char *path = g_canonicalize_filename(plan->output, NULL);
    fl_digest_add_text(&place, "finished");
    fl_digest_add_text(&place, path);
    return place;
}

/* The one file beside the frames, or instead of them; NULL: none. */
static const char *film_of(const FlPlan *plan)
{
    return plan->format->film ? plan->output : plan->movie;
}

/* What decides the film besides its frames is part of its name. */
static char *film_key(const FlPlan *plan)
{
    char rate[G_ASCII_DTOSTR_BUF_SIZE];
    const FlSinkFormat *format = plan->movie ? plan->movie_format : plan->format;
    return g_strdup_printf("%s %s %s", film_of(plan), format->name,
                           g_ascii_dtostr(rate, sizeof rate, plan->options.fps));
}

/* ---- what was read -------------------------------------------------------------------------- */

static int by_text(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static void add_folder(FlDigest *sum, const char *path)
{
    g_autoptr(GDir) dir = g_dir_open(path, 0, NULL);
    g_autoptr(GPtrArray) names = g_ptr_array_new_with_free_func(g_free);
    for (const char *name; dir && (name = g_dir_read_name(dir));)
        g_ptr_array_add(names, g_strdup(name));
    g_ptr_array_sort(names, by_text);
    for (guint k = 0; k < names->len; k++)
        fl_digest_add_text(sum, names->pdata[k]);
}

/* A file by its contents, a folder by its names; what is missing counts as well. */
static void add_input(FlDigest *sum, const char *path)
{
    g_autofree char *contents = NULL;
    gsize bytes = 0;
    fl_digest_add_text(sum, path);
    if (g_file_test(path, G_FILE_TEST_IS_DIR))
        add_folder(sum, path);
    else if (g_file_test(path, G_FILE_TEST_IS_REGULAR) &&
             g_file_get_contents(path, &contents, &bytes, NULL))
        fl_digest_add(sum, contents, bytes);
    else
        fl_digest_add_text(sum, NULL);
}

/* ---- what was written ----------------------------------------------------------------------- */

/* Size and time of change in nanoseconds; false: there is no such file. */
static bool state_of(const char *path, gint64 *bytes, gint64 *time)
{
    struct stat status;
    if (stat(path, &status) != 0 || !S_ISREG(status.st_mode))
        return false;
    *bytes = status.st_size;
    *time = (gint64)status.st_mtim.tv_sec * 1000000000 + status.st_mtim.tv_nsec;
    return true;
}

static bool is_as_written(const char *path, gint64 bytes, gint64 time)
{
    gint64 bytes_now, time_now;
    return state_of(path, &bytes_now, &time_now) && bytes_now == bytes && time_now == time;
}

/* ---- looking -------------------------------------------------------------------------------- */

static bool inputs_are_the_same(GVariant *record)
{
    FlDigest was, now = {0};
    g_autoptr(GVariantIter) inputs = NULL, styles = NULL;
    const char *path, *name;
    g_variant_get(record, "((tt)(tt)asa(ss)a(sxx)a(sxx))", NULL, NULL, &was.a, &was.b, &inputs,
                  &styles, NULL, NULL);
    while (g_variant_iter_next(styles, "(&s&s)", &name, &path)) {
        g_autofree char *found = fl_style_find(name, NULL);
        if (!found || !g_str_equal(found, path))
            return false;
    }
    while (g_variant_iter_next(inputs, "&s", &path))
        add_input(&now, path);
    return now.a == was.a && now.b == was.b;
}

/* Whether all files of a list, those of part `child`, are as they were written. */
static bool outputs_are_there(GVariant *record, gsize child)
{
    g_autoptr(GVariant) list = g_variant_get_child_value(record, child);
    GVariantIter at;
    const char *path;
    gint64 bytes, time;
    g_variant_iter_init(&at, list);
    while (g_variant_iter_next(&at, "(&sxx)", &path, &bytes, &time))
        if (!is_as_written(path, bytes, time))
            return false;
    return true;
}

static bool film_is_there(const FlPlan *plan, GVariant *record)
{
    g_autoptr(GVariant) list = g_variant_get_child_value(record, 5);
    g_autofree char *key = film_key(plan);
    const char *path;
    gint64 bytes, time;
    GVariantIter at;
    g_variant_iter_init(&at, list);
    while (g_variant_iter_next(&at, "(&sxx)", &path, &bytes, &time))
        if (g_str_equal(path, key) && is_as_written(film_of(plan), bytes, time))
            return true;
    return false;
}

/* Frames that exist and are to be kept. */
static bool keeps_all(const FlPlan *plan, const FlSequence *sequence)
{
    const FlRenderOptions *o = &plan->options;
    if (o->overwrite != FL_OVERWRITE_KEEP || film_of(plan) || plan->parts_only || o->layers ||
        o->paint || o->stats || o->report || o->dump || o->ebsynth)
        return false;
    // frames that are found to be left out would move the bounds of parts
    if (plan->n_parts > 1 && o->missing > FL_MISSING_ERROR)
        return false;
    int first, end;
    fl_plan_part(plan, sequence->n, &first, &end);
    for (int f = first; f < end; f++) {
        g_autofree char *file = fl_output_name(plan->output, sequence->number[f], NULL, NULL);
        if (!file || !g_file_test(file, G_FILE_TEST_EXISTS))
            return false;
    }
    return true;
}

static GVariant *record_of(const FlPlan *plan)
{
    FlStore *cache = cache_for(plan);
    g_autoptr(GBytes) bytes = cache ? fl_store_get(cache, FL_KEPT_RENDER, place_of(plan)) : NULL;
    if (!bytes)
        return NULL;
    g_autoptr(GVariant) record =
        g_variant_ref_sink(g_variant_new_from_bytes(G_VARIANT_TYPE(RECORD), bytes, FALSE));
    return g_variant_is_normal_form(record) ? g_steal_pointer(&record) : NULL;
}

FlFinished fl_finished_look(const FlPlan *plan, const FlSequence *sequence)
{
    if (keeps_all(plan, sequence))
        return FL_FINISHED_ALL;
    g_autoptr(GVariant) record = record_of(plan);
    if (!record)
        return FL_FINISHED_NOTHING;
    FlDigest request;
    g_variant_get_child(record, 0, "(tt)", &request.a, &request.b);
    if (request.a != plan->request.a || request.b != plan->request.b ||
        !outputs_are_there(record, 4) || !inputs_are_the_same(record))
        return FL_FINISHED_NOTHING;
    if (!film_of(plan) || film_is_there(plan, record))
        return FL_FINISHED_ALL;
    return plan->format->film ? FL_FINISHED_NOTHING : FL_FINISHED_FRAMES;
}

/* ---- noting --------------------------------------------------------------------------------- */

static bool add_output(GVariantBuilder *list, const char *path, const char *key)
{
    gint64 bytes, time;
    if (!state_of(path, &bytes, &time))
        return false;
    g_variant_builder_add(list, "(sxx)", key, bytes, time);
    return true;
}

/* Returns: whether everything is there, which formats that write no files do not give. */
static bool add_outputs(GVariantBuilder *frames, GVariantBuilder *films, const FlPlan *plan)
{
    bool whole = true;
    for (int f = 0; !plan->format->film && whole && f < fl_drawing_frames(plan->drawing); f++) {
        const int number = fl_drawing_number(plan->drawing, f);
        g_autofree char *file = fl_output_name(plan->output, number, NULL, NULL);
        whole = file && add_output(frames, file, file);
    }
    g_autofree char *key = film_of(plan) ? film_key(plan) : NULL;
    return whole && (!key || add_output(films, film_of(plan), key));
}

static void add_inputs(GVariantBuilder *list, const FlPlan *plan, FlDigest *sum)
{
    g_autoptr(GPtrArray) paths = fl_guard_list_inputs(plan);
    for (guint k = 0; k < paths->len; k++) {
        g_variant_builder_add(list, "s", paths->pdata[k]);
        add_input(sum, paths->pdata[k]);
    }
}

void fl_finished_note(const FlPlan *plan)
{
    FlStore *cache = cache_for(plan);
    if (!cache || plan->options.overwrite == FL_OVERWRITE_KEEP)
        return; // what was kept may be anything
    FlDigest sum = {0};
    GVariantBuilder inputs, styles, frames, films;
    g_variant_builder_init(&inputs, G_VARIANT_TYPE("as"));
    g_variant_builder_init(&styles, G_VARIANT_TYPE("a(ss)"));
    g_variant_builder_init(&frames, G_VARIANT_TYPE("a(sxx)"));
    g_variant_builder_init(&films, G_VARIANT_TYPE("a(sxx)"));
    add_inputs(&inputs, plan, &sum);
    for (int p = 0; p < plan->n_painted; p++)
        g_variant_builder_add(&styles, "(ss)", plan->painted[p].settings.style,
                              plan->painted[p].style->path);
    const bool whole = add_outputs(&frames, &films, plan);
    g_autoptr(GVariant) record = g_variant_ref_sink(g_variant_new(
        RECORD, plan->request.a, plan->request.b, sum.a, sum.b, &inputs, &styles, &frames, &films));
    g_autoptr(GBytes) bytes = g_variant_get_data_as_bytes(record);
    gsize size;
    const void *data = g_bytes_get_data(bytes, &size);
    if (whole)
        fl_store_put(cache, FL_KEPT_RENDER, place_of(plan),
                     &(FlSpan){(void *)(uintptr_t)data, size}, 1);
}
