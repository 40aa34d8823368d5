/* Frames that a film goes on without, since their drawings cannot be read or drawn. */
#include "drawing/drawing_data.h"

/** With hold, the frame whose file frame t gets: itself, if it is good. */
static int instead_of(GError *const *failed, int n, int t)
{
    int instead = t;
    while (instead >= 0 && failed[instead])
        instead--;
    for (instead = instead < 0 ? 0 : instead; instead < n - 1 && failed[instead];)
        instead++;
    return instead;
}

void fl_sequence_leave_out(FlSequence *s, FlMissing missing, GError *const *failed,
                           FlWarnings *warnings)
{
    const int n = s->n;
    g_autofree FlSequenceFrame *frame = g_memdup2(s->frame, (size_t)n * sizeof *frame);
    s->n = 0;
    for (int t = 0; t < n; t++) {
        if (failed[t]) {
            fl_warnings_add(warnings, frame[t].file, frame[t].number, NULL,
                            "left out (‘missing’): %s", failed[t]->message);
            s->n_left_out++;
        }
        const int from = missing == FL_MISSING_HOLD ? instead_of(failed, n, t) : t;
        if (failed[from])
            continue;
        FlSequenceFrame *kept = &s->frame[s->n++];
        *kept = frame[from];
        kept->number = frame[t].number;
        kept->stand_in = frame[t].stand_in || from != t;
    }
}

static FlDrawingFrame copy_of(const FlDrawing *drawing, const FlDrawingFrame *frame)
{
    FlDrawingFrame copy = *frame;
    copy.step = g_memdup2(frame->step, ((size_t)frame->n + 1) * sizeof *frame->step);
    copy.whole = g_strdupv(frame->whole);
    copy.limbs = g_array_copy(frame->limbs);
    copy.anchor = g_memdup2(frame->anchor, (drawing->regions->len + 1) * sizeof *frame->anchor);
    return copy;
}

/** Leaves out frames of a drawing as fl_sequence_leave_out() does. */
static void leave_out(FlDrawing *drawing, FlMissing missing, GError *const *failed,
                      FlWarnings *warnings)
{
    const int n = drawing->sequence->n;
    int kept = 0;
    for (int t = 0; t < n; t++)
        if (failed[t])
            fl_drawing_frame_clear(&drawing->frame[t]);
    for (int t = 0; t < n; t++) {
        const int from = missing == FL_MISSING_HOLD ? instead_of(failed, n, t) : t;
        if (from != t)
            drawing->frame[kept++] = copy_of(drawing, &drawing->frame[from]);
        else if (!failed[t])
            drawing->frame[kept++] = drawing->frame[t];
    }
    fl_sequence_leave_out(drawing->sequence, missing, failed, warnings);
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

/** The error with which the film ends: one by chance, else the first if all frames have one. */
static const GError *reason_to_stop(GError *const *failed, int n)
{
    int n_failed = 0;
    for (int t = 0; t < n; t++) {
        n_failed += failed[t] != NULL;
        if (failed[t] && fl_is_by_chance(failed[t]))
            return failed[t];
    }
    return n_failed == n ? failed[0] : NULL;
}

bool fl_may_leave_out(GError *const *failed, int n, GError **error)
{
    const GError *reason = reason_to_stop(failed, n);
    if (reason)
        g_propagate_error(error, g_error_copy(reason));
    return !reason;
}

bool fl_drawing_leave_out_bad(FlDrawing *drawing, FlMissing missing, FlWarnings *warnings,
                              GError **error)
{
    const int n = drawing->sequence->n;
    g_autofree GError **failed = g_new0(GError *, n);
#pragma omp parallel for schedule(dynamic, 1)
    for (int t = 0; t < n; t++)
        fl_draw_list_free(fl_drawing_draw_list(drawing, t, &failed[t]));
    const bool may = fl_may_leave_out(failed, n, error);
    if (may) {
        leave_out(drawing, missing, failed, warnings);
        count_present(drawing);
    }
    for (int t = 0; t < n; t++)
        g_clear_error(&failed[t]);
    return may;
}
