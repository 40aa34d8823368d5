#include "job/plan.h"

#include "base/error.h"
#include "drawing/drawing.h"
#include "io/atomic_file.h"
#include "io/pattern.h"
#include "io/provenance.h"
#include "job/outputs.h"
#include "style/style_folder.h"
#include <glib/gstdio.h>
#include <unistd.h>

/* A hidden file beside the frames, one for each pattern and part, however it is spelt; with
 * any_digits one for all patterns that name the same files sooner or later, as %03d and %04d do
 * from 1000 on. */
static char *hidden_file(const FlPlan *plan, bool any_digits, const char *suffix)
{
    g_autofree char *parent = g_path_get_dirname(plan->out.output);
    g_autoptr(GString) folder = g_string_new(parent);
    if (!plan->out.format->film)
        g_string_replace(folder, "%%", "%", 0);
    g_auto(FlPattern) pattern = {0};
    const bool parsed = fl_pattern_parse(plan->out.output, &pattern, NULL);
    if (any_digits && pattern.width > 1)
        pattern.width = 1;
    g_autofree char *text = parsed ? fl_pattern_text(&pattern) : g_strdup(plan->out.output);
    g_autofree char *base = g_path_get_basename(text);
    g_autofree char *part = plan->out.n_parts > 1
                                ? g_strdup_printf(".%d-%d", plan->out.part + 1, plan->out.n_parts)
                                : g_strdup("");
    g_autofree char *name = g_strdup_printf(".%s%s.%s", base, part, suffix);
    return g_build_filename(folder->str, name, NULL);
}

static bool may_overwrite(const FlPlan *plan)
{
    return plan->out.overwrite == FL_OVERWRITE_YES;
}

/* Loads the record of an earlier run into resume->record, unless this run starts anew. */
static bool find_record(FlResume *resume, const FlPlan *plan, const FlFacts *facts, GError **error)
{
    if ((may_overwrite(plan) && !plan->options.resume) ||
        !g_file_test(resume->path, G_FILE_TEST_EXISTS))
        return true;
    g_autoptr(GError) problem = NULL;
    g_autoptr(FlRecord) record = fl_record_load(resume->path, &problem);
    g_autofree char *difference =
        record ? fl_facts_difference(record->facts, facts) : g_strdup(problem->message);
    if (!difference) {
        resume->record = g_steal_pointer(&record);
        return true;
    }
    if (may_overwrite(plan))
        return true;
    if (!record)
        g_propagate_error(error, g_steal_pointer(&problem));
    else
        fl_fail(error, FL_ERROR_CHANGED,
                "%s: an earlier run painted %d frames, but %s; use ‘overwrite’ to start anew",
                plan->out.output, record->done, difference);
    return false;
}

/* ---- files that exist ------------------------------------------------------------------------ */

/* A frame of an earlier film keeps a film from being made: its user may have forgotten it. */
static bool frame_is_free(const FlPlan *plan, const char *file, GError **error)
{
    if (fl_check_not_exists(file, plan->out.movie ? NULL : error))
        return true;
    if (plan->out.movie)
        fl_fail(error, FL_ERROR_EXISTS,
                "%s: already exists, a frame of an earlier film; use ‘overwrite’ to replace "
                "its frames, ‘no-frames’ to write none, or another name",
                file);
    return false;
}

static bool refuse_frame(const FlPlan *plan, const char *file, const char *but, GError **error)
{
    if (plan->options.part && !g_file_test(file, G_FILE_TEST_EXISTS))
        fl_fail(error, FL_ERROR_INPUT, "%s: there is no such frame; ‘merge’ its ‘part’ first",
                file);
    else
        fl_fail(error, FL_ERROR_CHANGED,
                "%s: an earlier run painted it, but %s; use ‘overwrite’ to start anew", file, but);
    return false;
}

/* Checks that the files of a finished frame exist and are unchanged; files of other renders, which
 * were kept, need only exist. */
static bool is_finished(const FlResume *resume, const FlPlan *plan, int frame,
                        const GPtrArray *files, GError **error)
{
    const int number = fl_drawing_number(plan->shapes.drawing, frame);
    const FlDigest made_from = fl_mark_of_frame(resume->made_from, number);
    for (guint k = 0; k < files->len; k++) {
        const char *file = files->pdata[k];
        if (!g_file_test(file, G_FILE_TEST_EXISTS))
            return refuse_frame(plan, file, "it is gone", error);
        if (!resume->keep_files && !fl_mark_is(file, made_from))
            return refuse_frame(plan, file, "it has changed since", error);
    }
    return true;
}

/* Files of a finished frame must exist; files of other frames must not, unless they are ours. */
static bool check_frame(const FlResume *resume, const FlPlan *plan, int frame, GError **error)
{
    g_autoptr(GPtrArray) files = fl_frame_files(&plan->out, &plan->shapes, frame, error);
    if (!files)
        return false;
    if (frame < resume->first)
        return is_finished(resume, plan, frame, files, error);
    if (resume->keep_files || fl_resume_replaces(resume, frame))
        return true;
    for (guint k = 0; k < files->len; k++)
        if (!(k == 0 && fl_frame_has_picture(&plan->out)
                  ? frame_is_free(plan, files->pdata[k], error)
                  : fl_check_not_exists(files->pdata[k], error)))
            return false;
    return true;
}

static bool check_files(const FlResume *resume, const FlPlan *plan, GError **error)
{
    const char *movie = resume->path ? plan->out.movie : plan->out.output;
    if (movie && !may_overwrite(plan) && !fl_check_not_exists(movie, error))
        return false;
    for (int f = plan->out.first; f < plan->out.end; f++)
        if (!check_frame(resume, plan, f, error))
            return false;
    return true;
}

static bool note_resume(const FlResume *resume, const FlPlan *plan, GError **error)
{
    const int n = resume->first - plan->out.first;
    fl_note(&plan->caller, "resuming an earlier run, which painted %d of %d frames", n,
            plan->out.end - plan->out.first);
    return n == 0 || !(plan->out.report || plan->out.stats) ||
           fl_warn(&plan->caller, error, FL_ERROR_INPUT,
                   "report and statistics lack the %d frames that an earlier run has painted; use "
                   "‘overwrite’ to paint them again",
                   n);
}

bool fl_resume_expect_free(const FlPlan *plan, const FlSequence *sequence, GError **error)
{
    const bool one_file = plan->out.format->film && !plan->out.parts_only;
    const char *movie = one_file ? plan->out.output : plan->out.movie;
    const char *const beside[] = {plan->out.stats, plan->out.provenance};
    if (may_overwrite(plan))
        return true;
    for (size_t k = 0; k < G_N_ELEMENTS(beside); k++)
        if (beside[k] && plan->out.overwrite == FL_OVERWRITE_REFUSE &&
            !fl_check_not_exists(beside[k], error))
            return false;
    if (movie && !fl_check_not_exists(movie, error))
        return false;
    g_autofree char *state = hidden_file(plan, false, "state");
    if (plan->out.format->film || plan->finished == FL_FINISHED_FRAMES ||
        plan->out.overwrite == FL_OVERWRITE_KEEP || g_file_test(state, G_FILE_TEST_EXISTS))
        return true;
    for (int f = 0; plan->out.n_parts == 1 && f < sequence->n; f++) {
        g_autofree char *file =
            fl_output_name(plan->out.output, sequence->frame[f].number, NULL, error);
        if (!file || !frame_is_free(plan, file, error))
            return false;
    }
    return true;
}

bool fl_resume_init(FlResume *resume, const FlPlan *plan, GError **error)
{
    const bool one_file = plan->out.format->film && !plan->out.parts_only;
    *resume = (FlResume){.keep_files = plan->out.overwrite == FL_OVERWRITE_KEEP,
                         .forgets = plan->options.watch};
    if (one_file && plan->options.resume)
        return fl_fail(error, FL_ERROR_USAGE,
                       "%s: a film cannot be resumed without its frames; leave out ‘no-frames’",
                       plan->out.output);
    g_autoptr(FlFacts) facts = fl_plan_facts(plan);
    resume->path = one_file ? NULL : hidden_file(plan, false, "state");
    if (resume->path && !find_record(resume, plan, facts, error))
        return false;
    resume->found = resume->written = resume->record != NULL;
    if (!resume->found) {
        resume->record = fl_record_new();
        resume->record->overwrite = may_overwrite(plan);
        fl_facts_free(resume->record->facts);
        resume->record->facts = g_steal_pointer(&facts);
    }
    resume->made_from = fl_facts_digest(resume->record->facts);
    resume->first = plan->finished == FL_FINISHED_FRAMES
                        ? plan->out.end
                        : CLAMP(resume->record->done, plan->out.first, plan->out.end);
    if (!check_files(resume, plan, error))
        return false;
    return !resume->found || note_resume(resume, plan, error);
}

/* ---- while it paints ------------------------------------------------------------------------- */

/* Excludes other runs with the same output, which would mix their frames. */
static bool take_lock(FlResume *resume, const FlPlan *plan, GError **error)
{
    g_autofree char *path = hidden_file(plan, true, "lock");
    g_autofree char *folder = g_path_get_dirname(path);
    GError *lock_error = NULL;
    (void)g_mkdir_with_parents(folder, 0777); // an error is told when the record is saved
    resume->lock = fl_lock_take(path, plan->out.output, &lock_error);
    if (lock_error) {
        g_propagate_error(error, lock_error);
        return false;
    }
    resume->lock_path = g_steal_pointer(&path);
    return true;
}

/* The lock goes before the record: a run killed in between is known to be complete. */
static void release_lock(FlResume *resume)
{
    if (resume->lock_path && resume->lock >= 0) {
        g_unlink(resume->lock_path);
        close(resume->lock);
    }
    g_clear_pointer(&resume->lock_path, g_free);
}

bool fl_resume_start(FlResume *resume, const FlPlan *plan, GError **error)
{
    return !resume->found || take_lock(resume, plan, error);
}

/* Checks that a frame's drawing is as it was when the render began. */
static bool check_drawing(const FlPlan *plan, int frame, GError **error)
{
    const char *path = fl_drawing_file(plan->shapes.drawing, frame);
    const FlDigest before = fl_inputs_digest(plan->inputs, path), now = fl_file_digest(path);
    if (fl_digest_is_same(before, now))
        return true;
    return fl_fail(error, FL_ERROR_CHANGED, "%s: has changed since the render began", path);
}

bool fl_resume_before_files(FlResume *resume, const FlPlan *plan, int frame, GError **error)
{
    if (!check_drawing(plan, frame, error))
        return false;
    // The first record is saved just before the first frame: it says that the frame is ours, and an
    // error while painting the first frame leaves no file.
    if (!resume->path)
        return true;
    if (!resume->lock_path && !take_lock(resume, plan, error))
        return false;
    if (resume->written)
        return true;
    return resume->written = fl_record_save(resume->record, resume->path, error);
}

bool fl_resume_save(const FlResume *resume, GError **error)
{
    return !resume->path || fl_record_save(resume->record, resume->path, error);
}

bool fl_resume_replaces(const FlResume *resume, int frame)
{
    const bool interrupted = resume->found && frame == resume->first;
    return !resume->keep_files && (interrupted || (resume->record && resume->record->overwrite));
}

bool fl_resume_keeps(const FlResume *resume, const char *file)
{
    return resume->keep_files && g_file_test(file, G_FILE_TEST_EXISTS);
}

const char *fl_resume_advice(const FlResume *resume)
{
    if (resume->forgets)
        return "run again, with its paint from the cache";
    return resume->path ? "run again to resume" : "a film without its frames starts anew";
}

static void remove_record(FlResume *resume)
{
    release_lock(resume);
    if (resume->path)
        g_unlink(resume->path);
}

void fl_resume_clear(FlResume *resume)
{
    if (resume->forgets && resume->lock_path)
        remove_record(resume); // the lock says that it is ours
    release_lock(resume);
    g_free(resume->path);
    fl_record_free(resume->record);
    *resume = (FlResume){0};
}

/* ---- finished renders ------------------------------------------------------------------------ */

/* True if a render writes more than frames and a film. */
static bool writes_more(const FlOutputs *o)
{
    return o->layers || o->paint || o->stats || o->provenance || o->report || o->dump || o->ebsynth;
}

/* The store of the plan, if its render can be known as finished. */
static FlStore *store_for(const FlPlan *plan)
{
    const GPtrArray *configs = plan->config->files;
    for (guint k = 0; k < configs->len; k++)
        if (!g_file_test(configs->pdata[k], G_FILE_TEST_IS_REGULAR))
            return NULL; // a pipe cannot be read again
    return writes_more(&plan->out) || plan->options.dry_run ? NULL : plan->cache;
}

/* The name of the record: all renders of these frames, or this film, have the same. */
static FlDigest name_of(const FlPlan *plan)
{
    FlDigest name = {0};
    g_autofree char *path = g_canonicalize_filename(plan->out.output, NULL);
    fl_digest_add_text(&name, path);
    return name;
}

/* The one file beside the frames, or instead of frames; may be NULL. */
static const char *film_of(const FlPlan *plan)
{
    return plan->out.format->film ? plan->out.output : plan->out.movie;
}

static bool same_facts(const FlFacts *before, FlFacts *now)
{
    g_autofree char *difference = fl_facts_difference(before, now);
    fl_facts_free(now);
    return !difference;
}

/* The digests of the same files, read now. */
static FlFacts *inputs_now(const FlFacts *before)
{
    FlFacts *now = fl_facts_new();
    for (guint k = 0; k < before->list->len; k++) {
        const char *path = g_array_index(before->list, FlFact, k).name;
        fl_facts_add_digest(now, path, fl_file_digest(path));
    }
    return now;
}

/* The folders in which the same styles are found now. */
static FlFacts *found_now(const FlFacts *before)
{
    FlFacts *now = fl_facts_new();
    for (guint k = 0; k < before->list->len; k++) {
        const char *name = g_array_index(before->list, FlFact, k).name;
        g_autofree char *path = fl_style_find(name, NULL);
        fl_facts_add(now, name, path);
    }
    return now;
}

static bool frames_are_there(const FlPlan *plan, const FlSequence *sequence, FlDigest made_from)
{
    bool there = true;
    for (int f = 0; f < sequence->n && !plan->out.format->film && there; f++) {
        g_autofree char *file =
            fl_output_name(plan->out.output, sequence->frame[f].number, NULL, NULL);
        there = file && fl_mark_is(file, fl_mark_of_frame(made_from, sequence->frame[f].number));
    }
    return there;
}

/* Frames that exist and are to be kept. */
static bool keeps_all(const FlPlan *plan, const FlSequence *sequence)
{
    if (plan->out.overwrite != FL_OVERWRITE_KEEP || plan->options.verify || film_of(plan) ||
        plan->out.parts_only || writes_more(&plan->out))
        return false;
    // frames that are found to be left out would move the bounds of parts
    if (plan->out.n_parts > 1 && plan->options.missing > FL_MISSING_ERROR)
        return false;
    int first, end;
    fl_outputs_part(&plan->out, sequence->n, &first, &end);
    for (int f = first; f < end; f++) {
        g_autofree char *file =
            fl_output_name(plan->out.output, sequence->frame[f].number, NULL, NULL);
        if (!file || !g_file_test(file, G_FILE_TEST_EXISTS))
            return false;
    }
    return true;
}

/* Lists the files that the earlier render read, so that they are watched. */
static void tell_inputs(const FlPlan *plan, const FlRecord *record)
{
    for (guint k = 0; k < record->inputs->list->len; k++) {
        const char *path = g_array_index(record->inputs->list, FlFact, k).name;
        if (!g_ptr_array_find_with_equal_func(plan->config->files, path, g_str_equal, NULL))
            fl_inputs_add(plan->inputs, path);
    }
}

FlFinished fl_resume_look(FlPlan *plan, const FlSequence *sequence)
{
    if (keeps_all(plan, sequence))
        return FL_FINISHED_ALL;
    FlStore *store = store_for(plan);
    g_autoptr(GBytes) bytes = store ? fl_store_get(store, FL_KEPT_RECORD, name_of(plan)) : NULL;
    g_autoptr(FlRecord) record = bytes ? fl_record_parse(bytes) : NULL;
    if (!record || !fl_digest_is_same(record->request, plan->request) ||
        !same_facts(record->found, found_now(record->found)) ||
        !same_facts(record->inputs, inputs_now(record->inputs)))
        return FL_FINISHED_NOTHING;
    plan->made_from = fl_facts_digest(record->facts);
    if (!frames_are_there(plan, sequence, plan->made_from))
        return FL_FINISHED_NOTHING;
    tell_inputs(plan, record);
    if (!film_of(plan) || fl_mark_is(film_of(plan), fl_film_digest(&plan->out, plan->made_from)))
        return FL_FINISHED_ALL;
    return plan->out.format->film ? FL_FINISHED_NOTHING : FL_FINISHED_FRAMES;
}

/* Adds the digests of all that was read. */
static void complete_record(FlRecord *record, const FlPlan *plan)
{
    record->request = plan->request;
    for (int k = 0; k < fl_inputs_count(plan->inputs); k++) {
        const char *path = fl_inputs_path(plan->inputs, k);
        fl_facts_add_digest(record->inputs, path, fl_inputs_digest(plan->inputs, path));
    }
    for (int p = 0; p < plan->shapes.n_painted; p++) {
        const FlRegionPlan *region = &plan->shapes.painted[p];
        fl_facts_add(record->found, region->settings.style, region->style->path);
    }
}

void fl_resume_finish(FlResume *resume, const FlPlan *plan)
{
    FlStore *store = store_for(plan);
    remove_record(resume);
    if (!store || resume->keep_files)
        return;
    complete_record(resume->record, plan);
    fl_record_keep(resume->record, store, name_of(plan));
}

/* ---- verifying ------------------------------------------------------------------------------- */

typedef struct Verify {
    const FlPlan *plan;
    int n, n_wrong;
} Verify;

static void verify_file(Verify *verify, const char *file, FlDigest made_from)
{
    FlDigest found = {0};
    const char *fault = NULL;
    switch (fl_mark_read(file, &found)) {
    case FL_MARK_MISSING:
        fault = "is missing";
        break;
    case FL_MARK_NONE:
        fault = "does not say what it was made from";
        break;
    case FL_MARK_ALTERED:
        fault = "has changed since it was written";
        break;
    case FL_MARK_WHOLE:
        fault = fl_digest_is_same(found, made_from) ? NULL : "was made from something else";
        break;
    }
    verify->n++, verify->n_wrong += fault != NULL;
    if (fault)
        fl_note(&verify->plan->caller, "%s: %s", file, fault);
}

/* Verifies frames by their names, since no drawing was read. */
static bool verify_frames(Verify *verify, GError **error)
{
    const FlPlan *plan = verify->plan;
    g_autoptr(FlSequence) sequence = fl_sequence_from_options(&plan->options, error);
    for (int f = 0; sequence && f < sequence->n && !plan->out.format->film; f++) {
        const int number = sequence->frame[f].number;
        g_autofree char *file = fl_output_name(plan->out.output, number, NULL, error);
        if (!file)
            return false;
        verify_file(verify, file, fl_mark_of_frame(plan->made_from, number));
    }
    return sequence != NULL;
}

static bool verify_all_files(Verify *verify, FlDigest made_from, GError **error)
{
    const FlPlan *plan = verify->plan;
    for (int f = plan->out.first; f < plan->out.end; f++) {
        const int number = fl_drawing_number(plan->shapes.drawing, f);
        g_autoptr(GPtrArray) files = fl_frame_files(&plan->out, &plan->shapes, f, error);
        for (guint k = 0; files && k < files->len; k++)
            verify_file(verify, files->pdata[k], fl_mark_of_frame(made_from, number));
        if (!files)
            return false;
    }
    return true;
}

/* Tells how the last render of these files, which the store knows, differs from this one. */
static void note_cause(const FlPlan *plan, const FlFacts *facts)
{
    g_autoptr(GBytes) bytes =
        plan->cache ? fl_store_get(plan->cache, FL_KEPT_RECORD, name_of(plan)) : NULL;
    g_autoptr(FlRecord) record = bytes ? fl_record_parse(bytes) : NULL;
    g_autofree char *cause = record ? fl_facts_difference(record->facts, facts) : NULL;
    if (cause)
        fl_note(&plan->caller, "since the last render, %s", cause);
}

bool fl_resume_verify(const FlPlan *plan, GError **error)
{
    Verify verify = {.plan = plan};
    g_autoptr(FlFacts) facts = plan->shapes.drawing ? fl_plan_facts(plan) : NULL;
    const FlDigest made_from = facts ? fl_facts_digest(facts) : plan->made_from;
    if (!(facts ? verify_all_files(&verify, made_from, error) : verify_frames(&verify, error)))
        return false;
    if (film_of(plan))
        verify_file(&verify, film_of(plan), fl_film_digest(&plan->out, made_from));
    if (verify.n_wrong > 0 && facts)
        note_cause(plan, facts);
    if (verify.n_wrong > 0)
        fl_fail(error, FL_ERROR_CHANGED, "%d of %d files are not as they would be made now",
                verify.n_wrong, verify.n);
    else
        fl_note(&plan->caller, "all %d files are as they would be made now", verify.n);
    return verify.n_wrong == 0;
}
