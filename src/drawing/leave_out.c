#include "drawing/leave_out.h"

#include "base/schedule.h"
#include "drawing/draw_pool.h"
#include "drawing/drawing_data.h"
#include <string.h>

void fl_sequence_leave_out(FlSequence *sequence, int frame, int instead)
{
    sequence->n_left_out++;
    g_free(sequence->file[frame]);
    if (instead >= 0) {
        sequence->file[frame] = g_strdup(sequence->file[instead]);
        sequence->stand_in[frame] = true;
        sequence->layer[frame] = sequence->layer[instead];
        return;
    }
    for (int t = frame; t + 1 < sequence->n; t++) {
        sequence->file[t] = sequence->file[t + 1];
        sequence->number[t] = sequence->number[t + 1];
        sequence->stand_in[t] = sequence->stand_in[t + 1];
        sequence->layer[t] = sequence->layer[t + 1];
    }
    sequence->file[--sequence->n] = NULL;
}

/** Leaves out a frame of a drawing in the same way. */
static void leave_out(FlDrawing *drawing, int frame, int instead)
{
    FlDrawingFrame *here = &drawing->frame[frame];
    fl_drawing_frame_clear(here);
    if (instead >= 0) {
        *here = drawing->frame[instead];
        here->step = g_memdup2(here->step, ((size_t)here->n + 1) * sizeof *here->step);
        here->whole = g_strdupv(here->whole);
        here->anchor = g_memdup2(here->anchor, (drawing->regions->len + 1) * sizeof *here->anchor);
    } else {
        const int after = drawing->sequence->n - frame - 1;
        memmove(here, here + 1, (size_t)after * sizeof *here);
    }
    fl_sequence_leave_out(drawing->sequence, frame, instead);
}

/** Counts anew in how many frames each region is drawn. */
static void count_present(FlDrawing *drawing)
{
    const guint n = drawing->regions->len;
    g_autofree int *last = g_new0(int, n + 1); // 1 + the last frame in which it was found
    for (guint r = 0; r < n; r++)
        g_array_index(drawing->regions, FlRegion, r).n_present = 0;
    for (int t = 0; t < drawing->sequence->n; t++)
        for (int i = 0; i < drawing->frame[t].n; i++) {
            const int r = drawing->frame[t].step[i].region;
            FlRegion *region = &g_array_index(drawing->regions, FlRegion, r);
            if (last[r] != t + 1 && region->n_present++ == 0)
                region->first_frame = t;
            last[r] = t + 1;
        }
}

/** The first frame without an error; n if there is none. */
static int first_good(GError **failed, int n)
{
    int t = 0;
    while (t < n && failed[t])
        t++;
    return t;
}

/** Frames before the first good one show that, later ones the last good one before them. */
static void hold(FlDrawing *drawing, GError **failed)
{
    const int n = drawing->sequence->n, good = first_good(failed, n);
    for (int t = good - 1; t >= 0; t--)
        leave_out(drawing, t, t + 1);
    for (int t = good + 1; t < n; t++)
        if (failed[t])
            leave_out(drawing, t, t - 1);
}

static void skip(FlDrawing *drawing, GError **failed)
{
    for (int t = drawing->sequence->n - 1; t >= 0; t--)
        if (failed[t])
            leave_out(drawing, t, -1);
}

static void leave_out_failed(FlDrawing *drawing, FlMissing missing, GError **failed,
                             FlWarnings *warnings)
{
    const FlSequence *sequence = drawing->sequence;
    for (int t = 0; t < sequence->n; t++)
        if (failed[t])
            fl_warnings_add(warnings, sequence->file[t], sequence->number[t], NULL,
                            "left out (‘missing’): %s", failed[t]->message);
    if (missing == FL_MISSING_HOLD)
        hold(drawing, failed);
    else
        skip(drawing, failed);
    count_present(drawing);
}

bool fl_drawing_draw_apart(FlDrawing *drawing, FlMissing missing, FlWarnings *warnings,
                           GError **error)
{
    const int n = drawing->sequence->n;
    drawing->pool = fl_draw_pool_new(drawing, fl_schedule_threads());
    if (!drawing->pool || missing <= FL_MISSING_ERROR)
        return true;
    g_autofree GError **failed = g_new0(GError *, n);
#pragma omp parallel for schedule(dynamic, 1)
    for (int t = 0; t < n; t++)
        fl_draw_list_free(fl_drawing_draw_list(drawing, t, &failed[t]));
    const int good = first_good(failed, n);
    if (good < n)
        leave_out_failed(drawing, missing, failed, warnings);
    else
        g_propagate_error(error, g_steal_pointer(&failed[0]));
    for (int t = 0; t < n; t++)
        g_clear_error(&failed[t]);
    fl_draw_pool_enable_fallbacks(drawing->pool);
    return good < n;
}
