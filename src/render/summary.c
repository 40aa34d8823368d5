#include "render/summary.h"

#include "base/error.h"
#include "inspect/report.h"
#include "render/loop.h"
#include <string.h>

static void send_note(const FlPlan *plan, const char *line)
{
    fl_note(&plan->caller, "%s", line);
}

static const char *written(const FlPlan *plan)
{
    const FlRenderOptions *o = &plan->options;
    return !plan->parts_only ? plan->output : o->paint ? o->paint : o->layers;
}

static const char *plural(int n)
{
    return n == 1 ? "" : "s";
}

void fl_summary_of_render(const FlPlan *plan, const FlStats *stats)
{
    const int n = plan->end - plan->first;
    const char *movie = plan->movie ? plan->movie : "", *and = plan->movie ? " and " : "";
    g_autofree char *done = plan->finished == FL_FINISHED_FRAMES
                                ? g_strdup_printf("made of %d frame%s that %s painted before: %s",
                                                  n, plural(n), n == 1 ? "was" : "were", movie)
                                : g_strdup_printf("painted %d frame%s: %s%s%s", n, plural(n), movie,
                                                  and, written(plan));
    g_autofree char *seconds = fl_stats_summary(stats, n);
    g_autofree char *gaps = fl_drawing_left_out(plan->shapes.drawing, plan->options.missing);
    send_note(plan, done);
    if (gaps)
        send_note(plan, gaps);
    send_note(plan, seconds);
    if (!plan->options.report)
        return;
    g_autofree char *page = g_strdup_printf("report: %s/index.html", plan->options.report);
    send_note(plan, page);
}

void fl_summary_of_nothing(const FlPlan *plan)
{
    const int n = plan->n_finished;
    g_autofree char *line =
        plan->options.overwrite == FL_OVERWRITE_KEEP
            ? g_strdup_printf("nothing to do: %d frame%s exist%s and %s kept: %s", n, plural(n),
                              n == 1 ? "s" : "", n == 1 ? "is" : "are", plan->output)
            : g_strdup_printf("nothing to do: %d frame%s and all that they are made from have not "
                              "changed: %s",
                              n, plural(n), plan->movie ? plan->movie : plan->output);
    send_note(plan, line);
}

/* The reason why some of each region was painted although the cache is not new: an array of
 * strings, "" if no reason is known; to be freed. */
static char **reasons_of(const FlPainters *painters)
{
    char **reasons = g_new0(char *, (gsize)painters->n + 1);
    for (int p = 0; p < painters->n; p++) {
        const FlReuse *reuse = &painters->painter[p]->reuse;
        char *reason = reuse->n_painted > 0 ? fl_reuse_reason(reuse) : NULL;
        reasons[p] = reason ? reason : g_strdup("");
    }
    return reasons;
}

/* Notes one line for all regions that share the reason of region p, unless an earlier region
 * did. */
static void tell_reason(const FlPainters *painters, int p, char **reasons, const FlCaller *caller)
{
    int n = 0, painted = 0, all = 0;
    for (int q = 0; q < painters->n; q++) {
        const FlReuse *reuse = &painters->painter[q]->reuse;
        if (strcmp(reasons[q], reasons[p]) != 0)
            continue;
        if (q < p)
            return;
        n++, painted += reuse->n_painted, all += reuse->n_painted + reuse->n_taken;
    }
    g_autofree char *who = n == 1 ? g_strdup_printf("region %s", painters->painter[p]->plan->name)
                                  : g_strdup_printf("%d regions", n);
    g_autofree char *line =
        g_strdup_printf("%s: painted %d of %d pictures, since %s", who, painted, all, reasons[p]);
    fl_note(caller, "%s", line);
}

void fl_summary_of_reuse(const FlPainters *painters, const FlCaller *caller)
{
    int taken = 0, painted = 0;
    g_auto(GStrv) reasons = reasons_of(painters);
    for (int p = 0; p < painters->n; p++) {
        const FlReuse *reuse = &painters->painter[p]->reuse;
        taken += reuse->n_taken, painted += reuse->n_painted;
        if (reasons[p][0])
            tell_reason(painters, p, reasons, caller);
    }
    if (taken == 0)
        return;
    g_autofree char *line =
        g_strdup_printf("paint of regions: %d pictures from the cache, %d painted", taken, painted);
    fl_note(caller, "%s", line);
}

/* An estimate of the time; held frames take no time. */
static char *forecast(const FlPlan *plan, double frame_s)
{
    const int n = (plan->shapes.n_frames - 1) / plan->shapes.hold + 1;
    const int lead_in = plan->options.loop ? fl_loop_length(n) : 0;
    const int seconds = (int)(frame_s * (n + lead_in) + 0.5);
    return g_strdup_printf("that would take about %d:%02d:%02d, %.2f seconds a frame",
                           seconds / 3600, seconds / 60 % 60, seconds % 60, frame_s);
}

void fl_summary_of_dry_run(const FlPlan *plan, double frame_s)
{
    const FlShapes *shapes = &plan->shapes;
    const int n = shapes->n_frames;
    const char *movie = plan->movie ? plan->movie : "", *and = plan->movie ? " and " : "";
    g_autofree char *work =
        g_strdup_printf("would paint %d frame%s of %dx%d pixels, %d region%s: %s%s%s", n, plural(n),
                        shapes->page_width, shapes->page_height, shapes->n_painted,
                        plural(shapes->n_painted), movie, and, written(plan));
    g_autofree char *time = forecast(plan, frame_s);
    g_autofree char *gaps = fl_drawing_left_out(shapes->drawing, plan->options.missing);
    send_note(plan, work);
    if (gaps)
        send_note(plan, gaps);
    send_note(plan, time);
}
