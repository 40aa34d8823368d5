#include "render/summary.h"

#include "render/loop.h"

static void send_note(const FlPlan *plan, const char *line)
{
    const FlRenderOptions *o = &plan->options;
    if (o->note)
        o->note(line, o->data);
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
    const int n = fl_drawing_frames(plan->drawing);
    const char *movie = plan->movie ? plan->movie : "", *and = plan->movie ? " and " : "";
    g_autofree char *done =
        g_strdup_printf("painted %d frame%s: %s%s%s", n, plural(n), movie, and, written(plan));
    g_autofree char *seconds = fl_stats_summary(stats, n);
    g_autofree char *gaps = fl_drawing_left_out(plan->drawing, plan->options.missing);
    send_note(plan, done);
    if (gaps)
        send_note(plan, gaps);
    send_note(plan, seconds);
    if (!plan->options.report)
        return;
    g_autofree char *page = g_strdup_printf("report: %s/index.html", plan->options.report);
    send_note(plan, page);
}

/* An estimate of the time; held frames take none. */
static char *forecast(const FlPlan *plan, double frame_s)
{
    const int n = (fl_drawing_frames(plan->drawing) - 1) / plan->hold + 1;
    const int lead_in = plan->options.loop ? MIN(n / 3, FL_LOOP_LONGEST) : 0;
    const int seconds = (int)(frame_s * (n + lead_in) + 0.5);
    return g_strdup_printf("that would take about %d:%02d:%02d, %.2f seconds a frame",
                           seconds / 3600, seconds / 60 % 60, seconds % 60, frame_s);
}

void fl_summary_of_dry_run(const FlPlan *plan, double frame_s)
{
    const int n = fl_drawing_frames(plan->drawing);
    const char *movie = plan->movie ? plan->movie : "", *and = plan->movie ? " and " : "";
    g_autofree char *work = g_strdup_printf(
        "would paint %d frame%s of %dx%d pixels, %d region%s: %s%s%s", n, plural(n), plan->width,
        plan->height, plan->n_painted, plural(plan->n_painted), movie, and, written(plan));
    g_autofree char *time = forecast(plan, frame_s);
    g_autofree char *gaps = fl_drawing_left_out(plan->drawing, plan->options.missing);
    send_note(plan, work);
    if (gaps)
        send_note(plan, gaps);
    send_note(plan, time);
}
