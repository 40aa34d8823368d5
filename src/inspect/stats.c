#include "inspect/stats.h"

#include <sys/resource.h>

bool fl_stats_init(FlStats *stats, const char *path, bool overwrite, GError **error)
{
    *stats = (FlStats){0};
    if (!path)
        return true;
    stats->open = fl_atomic_open(&stats->file, path, overwrite, error);
    return stats->open;
}

/* A double with a point, whatever the locale. */
static const char *number(char buffer[32], double value)
{
    return g_ascii_formatd(buffer, 32, "%.6g", value);
}

static void pair(FILE *out, const char *name, double value)
{
    char buffer[32];
    fprintf(out, ", \"%s\": %s", name, number(buffer, value));
}

static void level_line(FILE *out, const FlPaintedRegion *painted, int frame_number, int level)
{
    const FlLevelStats *s = &painted->stats.level[level];
    fprintf(out,
            "{\"frame\": %d, \"region\": \"%s\", \"level\": %d, \"width\": %d, \"height\": %d, "
            "\"pixels\": %d, \"rounds\": %d",
            frame_number, painted->name, level, s->width, s->height, s->pixels, s->rounds);
    pair(out, "energy_start", s->energy_start);
    pair(out, "energy", s->energy);
    pair(out, "texture", s->texture);
    pair(out, "bound", s->bound);
    pair(out, "ext", s->ext);
    pair(out, "direction", s->direction);
    pair(out, "temporal", s->temporal);
    pair(out, "uniformity", s->uniformity);
    pair(out, "coherence", s->coherence);
    pair(out, "tried_per_pixel", s->pixels ? (double)s->counts.tried / s->pixels : 0);
    pair(out, "accepted_per_pixel", s->pixels ? (double)s->counts.accepted / s->pixels : 0);
    pair(out, "seconds", s->seconds);
    fputs("}\n", out);
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
        if (painted[p]->from == FL_FROM_CACHE)
            fprintf(out, "{\"frame\": %d, \"region\": \"%s\", \"taken\": true}\n", frame_number,
                    painted[p]->name);
        for (int l = painted[p]->stats.n_levels - 1; l >= 0; l--)
            level_line(out, painted[p], frame_number, l);
    }
    fprintf(out, "{\"frame\": %d", frame_number);
    pair(out, "paint_seconds", paint_s);
    pair(out, "compose_seconds", compose_s);
    pair(out, "write_seconds", write_s);
    pair(out, "peak_mib", fl_peak_mib());
    fputs("}\n", out);
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
