#include "progress.h"

#include "base/json.h"
#include <glib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#define BAR_EVERY_S 0.1   // a terminal that is redrawn more often flickers
#define PLAIN_EVERY_S 10. // keeps logs short
#define BAR_COLUMNS 24

void fl_meter_init(FlMeter *meter, FlProgressMode mode, FILE *stream)
{
    const bool terminal = isatty(fileno(stream));
    const char *no_colour = g_getenv("NO_COLOR");
    const char *type = g_getenv("TERM");
    const bool dumb = !type || strcmp(type, "dumb") == 0;
    if (mode == FL_PROGRESS_AUTO)
        mode = terminal && !dumb ? FL_PROGRESS_BAR : FL_PROGRESS_PLAIN;
    *meter = (FlMeter){.stream = stream,
                       .mode = mode,
                       .colour = terminal && !dumb && !(no_colour && *no_colour),
                       .region_index = -2};
}

void fl_meter_hide(FlMeter *meter)
{
    if (meter->bar_columns > 0)
        fputs("\r\033[K", meter->stream);
    meter->bar_columns = 0;
    fflush(meter->stream);
}

/* "3:07", "1:02:45" */
static char *duration(double seconds)
{
    const long s = (long)(seconds + 0.5);
    return s >= 3600 ? g_strdup_printf("%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60)
                     : g_strdup_printf("%ld:%02ld", s / 60, s % 60);
}

/* "hair (2/5), paint, frame 12 (3/48), 1.25 s/frame, 0:48 left" */
static char *sentence(const FlProgress *p)
{
    GString *text = g_string_new(NULL);
    if (p->region)
        g_string_append_printf(text, "%s (%d/%d), ", p->region, p->region_index + 1, p->n_regions);
    g_string_append_printf(text, "%s, frame %d", p->stage, p->frame);
    if (p->total > 0)
        g_string_append_printf(text, " (%d/%d)", p->done, p->total);
    if (p->frame_s > 0)
        g_string_append_printf(text, ", %.2f s/frame", p->frame_s);
    if (p->remaining_s >= 0) {
        g_autofree char *left = duration(p->remaining_s);
        g_string_append_printf(text, ", %s left", left);
    }
    return g_string_free(text, FALSE);
}

static int terminal_columns(FILE *stream)
{
    struct winsize size = {0};
    const bool known = ioctl(fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? size.ws_col : 80;
}

static void show_bar(FlMeter *meter, const FlProgress *p)
{
    char filled[BAR_COLUMNS + 1], empty[BAR_COLUMNS + 1];
    const int n = (int)(CLAMP(p->share, 0, 1) * BAR_COLUMNS + 0.5);
    memset(filled, '#', BAR_COLUMNS), memset(empty, '.', BAR_COLUMNS);
    filled[n] = '\0', empty[BAR_COLUMNS - n] = '\0';
    g_autofree char *words = sentence(p);
    const int columns = MAX(terminal_columns(meter->stream) - BAR_COLUMNS - 10, 0);
    if (g_utf8_strlen(words, -1) > columns)
        *g_utf8_offset_to_pointer(words, columns) = '\0';
    fprintf(meter->stream, "\r[%s%s%s%s] %3d %% %s\033[K", meter->colour ? "\033[36m" : "", filled,
            meter->colour ? "\033[0m" : "", empty, (int)(p->share * 100), words);
    meter->bar_columns = 1;
}

static void show_plain(FlMeter *meter, const FlProgress *p)
{
    g_autofree char *words = sentence(p);
    fprintf(meter->stream, "%3d %% %s\n", (int)(p->share * 100), words);
}

static void show_json(FlMeter *meter, const FlProgress *p)
{
    g_autoptr(GString) json = g_string_new("{");
    fl_json_text(json, "stage", p->stage);
    fl_json_text(json, "region", p->region);
    fl_json_number(json, "region_index", p->region_index, p->region_index >= 0);
    fl_json_number(json, "regions", p->n_regions, p->n_regions > 0);
    fl_json_number(json, "frame", p->frame, true);
    fl_json_number(json, "done", p->done, true);
    fl_json_number(json, "total", p->total, p->total > 0);
    fl_json_number(json, "share", p->share, true);
    fl_json_number(json, "elapsed_s", p->elapsed_s, true);
    fl_json_number(json, "frame_s", p->frame_s, p->frame_s > 0);
    fl_json_number(json, "remaining_s", p->remaining_s, p->remaining_s >= 0);
    fprintf(meter->stream, "%s}\n", json->str);
}

void fl_meter_say(FlMeter *meter, const char *kind, const char *message)
{
    fl_meter_hide(meter);
    g_autofree char *line = fl_one_line(message);
    if (meter->mode == FL_PROGRESS_JSON) {
        g_autoptr(GString) json = g_string_new("{");
        fl_json_text(json, kind, line);
        fprintf(meter->stream, "%s}\n", json->str);
    } else {
        const bool warning = strcmp(kind, "warning") == 0;
        fprintf(meter->stream, "fluidy-svg: %s%s\n", warning ? "warning: " : "", line);
    }
}

/* The last frame of a stage is always due, and so is the first of the next; but a log does not
 * announce what has not begun, for it may be over at once, nor what mostly takes no time. */
static bool is_due(const FlMeter *meter, const FlProgress *p)
{
    if (meter->mode == FL_PROGRESS_PLAIN && p->done == 0)
        return false;
    const double every = meter->mode == FL_PROGRESS_BAR     ? BAR_EVERY_S
                         : meter->mode == FL_PROGRESS_PLAIN ? PLAIN_EVERY_S
                                                            : 0;
    if (meter->mode == FL_PROGRESS_PLAIN && p->share <= 0)
        return p->elapsed_s - meter->shown_s >= every;
    return g_strcmp0(p->stage, meter->stage) != 0 || p->region_index != meter->region_index ||
           (p->done > 0 && p->done == p->total) || p->elapsed_s - meter->shown_s >= every;
}

void fl_meter_show(FlMeter *meter, const FlProgress *progress)
{
    if (meter->mode == FL_PROGRESS_NONE || !is_due(meter, progress))
        return;
    meter->stage = progress->stage;
    meter->region_index = progress->region_index;
    meter->shown_s = progress->elapsed_s;
    if (meter->mode == FL_PROGRESS_BAR)
        show_bar(meter, progress);
    else if (meter->mode == FL_PROGRESS_JSON)
        show_json(meter, progress);
    else
        show_plain(meter, progress);
    fflush(meter->stream);
}
