#include "inspect/stats.h"

#include "base/json.h"
#include <sys/resource.h>

bool fl_stats_init(FlStats *stats, const char *path, bool overwrite, GError **error)
{
    *stats = (FlStats){0};
    if (!path)
        return true;
    stats->open = fl_atomic_open(&stats->file, path, overwrite, error);
    return stats->open;
}

/* Begins a line about a frame, and about a region or NULL. */
static GString *new_line(int frame_number, const char *region)
{
    GString *line = g_string_new("{");
    fl_json_number(line, "frame", frame_number, true);
    if (region)
        fl_json_text(line, "region", region);
    return line;
}

static void write_line(FILE *out, GString *line)
{
    fprintf(out, "%s}\n", line->str);
    g_string_free(line, TRUE);
}

static void level_line(FILE *out, const FlPaintedRegion *painted, int frame_number, int level)
{
    const FlLevelStats *s = &painted->stats.level[level];
    GString *line = new_line(frame_number, painted->name);
    fl_json_number(line, "level", level, true);
    fl_json_number(line, "width", s->width, true);
    fl_json_number(line, "height", s->height, true);
    fl_json_number(line, "pixels", s->pixels, true);
    fl_json_number(line, "rounds", s->rounds, true);
    fl_json_number(line, "energy_start", s->energy_start, true);
    fl_json_number(line, "energy", s->energy, true);
    fl_json_number(line, "texture", s->texture, true);
    fl_json_number(line, "bound", s->bound, true);
    fl_json_number(line, "ext", s->ext, true);
    fl_json_number(line, "direction", s->direction, true);
    fl_json_number(line, "temporal", s->temporal, true);
    fl_json_number(line, "uniformity", s->uniformity, true);
    fl_json_number(line, "coherence", s->coherence, true);
    fl_json_number(line, "tried_per_pixel", (double)s->counts.tried / MAX(s->pixels, 1), true);
    fl_json_number(line, "accepted_per_pixel", (double)s->counts.accepted / MAX(s->pixels, 1),
                   true);
    fl_json_number(line, "seconds", s->seconds, true);
    write_line(out, line);
}

double fl_peak_mib(void)
{
    struct rusage usage = {0};
    getrusage(RUSAGE_SELF, &usage);
    return (double)usage.ru_maxrss / 1024;
}

void fl_stats_frame(FlStats *stats, const FlPaintedRegion *const *painted, int n, int frame_number,
                    double paint_s, double compose_s, double write_s)
{
    stats->paint_s += paint_s, stats->compose_s += compose_s, stats->write_s += write_s;
    if (!stats->open)
        return;
    FILE *out = stats->file.stream;
    for (int p = 0; p < n; p++) {
        if (painted[p]->from == FL_FROM_CACHE) {
            GString *taken = new_line(frame_number, painted[p]->name);
            fl_json_bool(taken, "taken", true);
            write_line(out, taken);
        }
        for (int l = painted[p]->stats.n_levels - 1; l >= 0; l--)
            level_line(out, painted[p], frame_number, l);
    }
    GString *line = new_line(frame_number, NULL);
    fl_json_number(line, "paint_seconds", paint_s, true);
    fl_json_number(line, "compose_seconds", compose_s, true);
    fl_json_number(line, "write_seconds", write_s, true);
    fl_json_number(line, "peak_mib", fl_peak_mib(), true);
    write_line(out, line);
}

char *fl_stats_summary(const FlStats *stats, int n_frames)
{
    return g_strdup_printf("seconds: read %.1f, guides %.1f, paint %.1f (%.2f a frame), compose "
                           "%.1f, write %.1f; memory: at most %.0f MiB",
                           stats->read_s, stats->guides_s, stats->paint_s,
                           stats->paint_s / MAX(n_frames, 1), stats->compose_s, stats->write_s,
                           fl_peak_mib());
}

bool fl_stats_finish(FlStats *stats, GError **error)
{
    return !stats->open || fl_atomic_commit(&stats->file, error);
}

void fl_stats_clear(FlStats *stats)
{
    if (stats->open)
        fl_atomic_clear(&stats->file);
    stats->open = false;
}
