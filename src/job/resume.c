#include "job/resume.h"

#include "base/exists.h"
#include "io/lock.h"
#include "io/pattern.h"
#include "io/sink.h"
#include "job/paint_files.h"
#include <glib/gstdio.h>
#include <unistd.h>

static char *frame_file(const FlPlan *plan, int frame, GError **error)
{
    const FlSinkParams params = {.path = plan->output};
    return fl_sink_file(&params, fl_drawing_number(plan->drawing, frame), error);
}

/* A hidden file beside the frames, one for each pattern and part, however it is spelt; with
 * any_digits one for all patterns that name the same files sooner or later, as %03d and %04d do
 * from 1000 on. */
static char *hidden_file(const FlPlan *plan, bool any_digits, const char *suffix)
{
    g_autofree char *folder = g_path_get_dirname(plan->output);
    g_auto(FlPattern) pattern = {0};
    const bool parsed = fl_pattern_parse(plan->output, &pattern, NULL);
    if (any_digits && pattern.width > 1)
        pattern.width = 1;
    g_autofree char *text = parsed ? fl_pattern_text(&pattern) : g_strdup(plan->output);
    g_autofree char *base = g_path_get_basename(text);
    g_autofree char *part =
        plan->n_parts > 1 ? g_strdup_printf(".%d-%d", plan->part + 1, plan->n_parts) : g_strdup("");
    g_autofree char *name = g_strdup_printf(".%s%s.%s", base, part, suffix);
    return g_build_filename(folder, name, NULL);
}

static bool may_overwrite(const FlPlan *plan)
{
    return plan->options.overwrite == FL_OVERWRITE_YES;
}

/* Loads the state of an earlier run into resume->state, if this one resumes it. */
static bool find_state(FlResume *resume, const FlPlan *plan, FlFingerprint *print, GError **error)
{
    if ((may_overwrite(plan) && !plan->options.resume) ||
        !g_file_test(resume->path, G_FILE_TEST_EXISTS))
        return true;
    g_autoptr(GError) problem = NULL;
    g_autoptr(FlCheckpoint) state = fl_checkpoint_load(resume->path, &problem);
    g_autofree char *difference =
        state ? fl_fingerprint_difference(state->print, print) : g_strdup(problem->message);
    if (!difference) {
        resume->state = g_steal_pointer(&state);
        return true;
    }
    if (may_overwrite(plan))
        return true;
    if (!state)
        g_propagate_error(error, g_steal_pointer(&problem));
    else
        g_set_error(error, FL_ERROR, FL_ERROR_CHANGED,
                    "%s: an earlier run painted %d frames, but %s; use ‘overwrite’ to start anew",
                    plan->output, state->done, difference);
    return false;
}

/* Frames that are there keep a film from being made, where they may have been forgotten. */
static bool frame_is_free(const FlPlan *plan, const char *file, GError **error)
{
    if (fl_check_not_exists(file, plan->movie ? NULL : error))
        return true;
    if (plan->movie)
        g_set_error(error, FL_ERROR, FL_ERROR_EXISTS,
                    "%s: already exists, a frame of an earlier film; use ‘overwrite’ to replace "
                    "its frames, ‘no-frames’ to write none, or another name",
                    file);
    return false;
}

static bool layers_are_free(const FlPlan *plan, int frame, GError **error)
{
    const int number = fl_drawing_number(plan->drawing, frame);
    for (int p = 0; plan->options.layers && p < plan->n_painted; p++) {
        const char *region = plan->painted[p].name;
        g_autofree char *file = fl_output_name(plan->options.layers, number, region, error);
        if (!file || !fl_check_not_exists(file, error))
            return false;
    }
    return true;
}

static bool paints_are_free(const FlPlan *plan, int frame, GError **error)
{
    const FlRenderOptions *o = &plan->options;
    for (int p = 0; o->paint && !o->merge && p < plan->n_painted; p++) {
        const FlRegionPlan *painted = &plan->painted[p];
        g_autofree char *file = fl_paint_file_name(o->paint, plan->drawing, painted, frame, error);
        if (!file || (frame % painted->settings.hold == 0 && !fl_check_not_exists(file, error)))
            return false;
    }
    return true;
}

/* The file of a finished frame must exist, that of another must not, unless it is ours. */
static bool check_frame(const FlResume *resume, const FlPlan *plan, int frame, GError **error)
{
    const bool has_file = resume->path && !plan->parts_only;
    g_autofree char *file = has_file ? frame_file(plan, frame, error) : NULL;
    if (has_file && !file)
        return false;
    if (frame < resume->first) {
        if (!file || g_file_test(file, G_FILE_TEST_EXISTS))
            return true;
        if (plan->options.part)
            g_set_error(error, FL_ERROR, FL_ERROR_INPUT,
                        "%s: there is no such frame; ‘merge’ its ‘part’ first", file);
        else
            g_set_error(
                error, FL_ERROR, FL_ERROR_CHANGED,
                "%s: an earlier run painted it, but it is gone; use ‘overwrite’ to start anew",
                file);
        return false;
    }
    return resume->keep_files || fl_resume_replaces(resume, frame) ||
           ((!file || frame_is_free(plan, file, error)) && layers_are_free(plan, frame, error) &&
            paints_are_free(plan, frame, error));
}

static bool check_files(const FlResume *resume, const FlPlan *plan, GError **error)
{
    const char *movie = resume->path ? plan->movie : plan->output;
    if (movie && !may_overwrite(plan) && !fl_check_not_exists(movie, error))
        return false;
    for (int f = plan->first; f < plan->end; f++)
        if (!check_frame(resume, plan, f, error))
            return false;
    return true;
}

static void note_resume(const FlResume *resume, const FlPlan *plan)
{
    const FlRenderOptions *o = &plan->options;
    if (!o->note)
        return;
    g_autofree char *line =
        g_strdup_printf("resuming an earlier run, which painted %d of %d frames",
                        resume->first - plan->first, plan->end - plan->first);
    o->note(line, o->data);
}

bool fl_resume_expect_free(const FlPlan *plan, const FlSequence *sequence, GError **error)
{
    const bool one_file = plan->format->film && !plan->parts_only;
    const char *movie = one_file ? plan->output : plan->movie, *stats = plan->options.stats;
    if (may_overwrite(plan))
        return true;
    if (stats && plan->options.overwrite == FL_OVERWRITE_REFUSE &&
        !fl_check_not_exists(stats, error))
        return false;
    if (movie && !fl_check_not_exists(movie, error))
        return false;
    g_autofree char *state = hidden_file(plan, false, "state");
    if (plan->format->film || plan->finished == FL_FINISHED_FRAMES ||
        plan->options.overwrite == FL_OVERWRITE_KEEP || g_file_test(state, G_FILE_TEST_EXISTS))
        return true;
    for (int f = 0; plan->n_parts == 1 && f < sequence->n; f++) {
        g_autofree char *file = fl_output_name(plan->output, sequence->number[f], NULL, error);
        if (!file || !frame_is_free(plan, file, error))
            return false;
    }
    return true;
}

/* A film without its frames is one file, which cannot be continued. */
static bool check_film(const FlPlan *plan, GError **error)
{
    if (plan->options.resume) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "%s: a film cannot be resumed without its frames; leave out ‘no-frames’",
                    plan->output);
        return false;
    }
    return true;
}

bool fl_resume_init(FlResume *resume, const FlPlan *plan, GError **error)
{
    const bool one_file = plan->format->film && !plan->parts_only;
    *resume = (FlResume){.keep_files = plan->options.overwrite == FL_OVERWRITE_KEEP,
                         .forgets = plan->options.watch};
    if (one_file && !check_film(plan, error))
        return false;
    g_autoptr(FlFingerprint) print = fl_fingerprint_new(plan, error);
    resume->path = one_file ? NULL : hidden_file(plan, false, "state");
    if (!print || (resume->path && !find_state(resume, plan, print, error)))
        return false;
    resume->found = resume->written = resume->state != NULL;
    if (!resume->found) {
        resume->state = fl_checkpoint_new();
        resume->state->overwrite = may_overwrite(plan);
    }
    fl_fingerprint_free(resume->state->print); // equal to print
    resume->state->print = g_steal_pointer(&print);
    resume->first =
        plan->finished == FL_FINISHED_FRAMES ? plan->end : MAX(resume->state->done, plan->first);
    if (!check_files(resume, plan, error))
        return false;
    if (resume->found)
        note_resume(resume, plan);
    return true;
}

/* Excludes other runs with the same output, which would mix their frames. */
static bool take_lock(FlResume *resume, const FlPlan *plan, GError **error)
{
    g_autofree char *folder = g_path_get_dirname(plan->output);
    g_autofree char *path = hidden_file(plan, true, "lock");
    GError *lock_error = NULL;
    (void)g_mkdir_with_parents(folder, 0777); // saving the state reports an error
    resume->lock = fl_lock_take(path, plan->output, &lock_error);
    if (lock_error) {
        g_propagate_error(error, lock_error);
        return false;
    }
    resume->lock_path = g_steal_pointer(&path);
    return true;
}

/* The lock goes before the state: a run killed in between is known to be complete. */
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

bool fl_resume_before_files(FlResume *resume, const FlPlan *plan, int frame, GError **error)
{
    if (!fl_fingerprint_check_drawing(resume->state->print, plan->drawing, frame, error))
        return false;
    // The first state is saved before the first frame, which is not known as ours without it; no
    // sooner, so that an error in the first frame leaves nothing behind.
    if (!resume->path)
        return true;
    if (!resume->lock_path && !take_lock(resume, plan, error))
        return false;
    if (resume->written)
        return true;
    return resume->written = fl_checkpoint_save(resume->state, resume->path, error);
}

bool fl_resume_save(FlResume *resume, GError **error)
{
    return !resume->path || fl_checkpoint_save(resume->state, resume->path, error);
}

bool fl_resume_replaces(const FlResume *resume, int frame)
{
    const bool interrupted = resume->found && frame == resume->first;
    return !resume->keep_files && (interrupted || (resume->state && resume->state->overwrite));
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

void fl_resume_finish(FlResume *resume)
{
    release_lock(resume);
    if (resume->path)
        g_unlink(resume->path);
}

void fl_resume_clear(FlResume *resume)
{
    if (resume->forgets && resume->lock_path)
        fl_resume_finish(resume); // the lock says that the state is ours
    release_lock(resume);
    g_free(resume->path);
    fl_checkpoint_free(resume->state);
    *resume = (FlResume){0};
}
