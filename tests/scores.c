/*
 * How a painted film compares with its recording. usage: scores STYLE_DIR DUMP_DIR [NAME]
 *
 * DUMP_DIR is that of --dump, with the paint beside it: --paint 'DUMP_DIR/{region}/paint_%04d.png'.
 * Prints a line, of all painted regions together, which must have been painted with
 * the recording in its own size, --style-by-page off:
 *   sharp, std  gradient and deviation of the luminance, shares of the recording's
 *   edge        rms error of the luminance profile below the contour, levels of 255
 *   flicker     difference of frames, share of the recording's
 *   used        different places of the recording per pixel
 *   rim         luminance 2 to 8 px inside edges that advance minus that of the others, in levels
 *   (of)        the same of the recording
 */
#include "default_params.h"
#include "guides/outline.h"
#include "io/picture_series.h"
#include "io/png.h"
#include "job/style_cache.h"
#include "scorecard.h"
#include "style/adapt.h"
#include "synth/synth.h"
#include <math.h>
#include <stdio.h>

/* A plane of n floats a pixel, as --dump writes it. */
static float *read_plane(const char *region, const char *what, int number, size_t floats)
{
    GError *error = NULL;
    gsize length = 0;
    char *bytes = NULL;
    g_autofree char *path = g_strdup_printf("%s/%s_%04d.f32", region, what, number);
    if (!g_file_get_contents(path, &bytes, &length, &error) || length != floats * sizeof(float))
        g_error("%s", error ? error->message : path);
    return (float *)(void *)bytes;
}

static void read_guides(const char *region, int number, FlGuides *guides)
{
    const size_t n = (size_t)guides->width * guides->height;
    g_autofree float *mask = read_plane(region, "mask", number, n);
    g_autofree float *distance = read_plane(region, "distance", number, n);
    g_autofree float *depth = read_plane(region, "depth", number, n);
    g_autofree float *flow = read_plane(region, "flow", number, 2 * n);
    for (size_t p = 0; p < n; p++)
        guides->mask[p] = (uint8_t)(mask[p] * 255 + .5f);
    memcpy(guides->distance, distance, n * sizeof *distance);
    memcpy(guides->depth, depth, n * sizeof *depth);
    memcpy(guides->flow, flow, 2 * n * sizeof *flow);
}

/* A region's paint with its guides. */
static Film *film_of_dump(const char *region, const FlSeries *series)
{
    GError *error = NULL;
    Film *film = g_new0(Film, 1);
    film->n_frames = series->n;
    film->guides = g_new0(FlGuides, series->n);
    for (int f = 0; f < series->n; f++) {
        g_autoptr(FlPicture) paint = fl_picture_read_png(series->path[f], &error);
        if (!paint)
            g_error("%s", error->message);
        const size_t n = (size_t)paint->width * paint->height;
        if (f == 0) {
            film->width = paint->width, film->height = paint->height;
            film->rgb = g_malloc(3 * n * series->n);
        }
        for (size_t p = 0; p < n; p++)
            memcpy(film->rgb + 3 * (f * n + p), paint->rgba + 4 * p, 3);
        g_assert_true(fl_guides_init(&film->guides[f], paint->width, paint->height, &error));
        read_guides(region, series->number[f], &film->guides[f]);
    }
    return film;
}

/* Counts the places of the recording that a frame's matches come from; where the region is not in
 * the frame, there is no field. */
static void add_use(const char *region, int number, const Film *film, Mean *used)
{
    g_autofree char *path = g_strdup_printf("%s/field_%04d.f32", region, number);
    if (!g_file_test(path, G_FILE_TEST_EXISTS))
        return;
    const size_t n = (size_t)film->width * film->height;
    g_autofree float *field = read_plane(region, "field", number, 4 * n);
    g_autoptr(GHashTable) places = g_hash_table_new(g_direct_hash, g_direct_equal);
    int matches = 0;
    for (size_t p = 0; p < n; p++) {
        const float *m = field + 4 * p;
        if (m[0] < 0)
            continue;
        const uint64_t place =
            ((uint64_t)m[0] << 40) + ((uint64_t)lroundf(m[2]) << 20) + (uint64_t)lroundf(m[1]);
        g_hash_table_add(places, (void *)(uintptr_t)(place + 1));
        matches++;
    }
    used->sum += g_hash_table_size(places);
    used->n += matches;
}

static void add_region(const char *region, ScoreSums *sums, Mean *used)
{
    g_autofree char *pattern = g_build_filename(region, "paint_%04d.png", NULL);
    g_autoptr(FlSeries) series = fl_series_of_pattern(pattern, NULL);
    if (!series) // a kept line
        return;
    Film *film = film_of_dump(region, series);
    film_count(film, sums);
    for (int f = 0; f < series->n; f++)
        add_use(region, series->number[f], film, used);
    film_free(film);
}

/* The recording in its own size. */
static Score score_of_style(const char *folder)
{
    GError *error = NULL;
    float factor = 1;
    g_autofree FlParams *params = default_params();
    const FlGuideParams how = fl_guide_params(params);
    g_autoptr(FlStyle) whole =
        fl_style_load_for(folder, 0, 1, 0, true, (FlCaller){0}, &factor, &error);
    const FlStyleUse use = {.start = 1, .step = 1, .scale = factor};
    g_autoptr(FlStyle) style = whole ? fl_style_adapt(whole, &use, &error) : NULL;
    g_autoptr(FlExemplar) exemplar = style ? fl_exemplar_new(style, params, &error) : NULL;
    if (!exemplar)
        g_error("%s", error->message);
    Film *film = film_of_style(style, &how, exemplar->margin_px);
    const Score score = film_score(film);
    film_free(film);
    return score;
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "usage: scores STYLE_DIR DUMP_DIR [NAME]\n");
        return 2;
    }
    ScoreSums sums = {0};
    Mean used = {0};
    GDir *dir = g_dir_open(argv[2], 0, NULL);
    for (const char *name; dir && (name = g_dir_read_name(dir));) {
        g_autofree char *region = g_build_filename(argv[2], name, NULL);
        add_region(region, &sums, &used);
    }
    if (dir)
        g_dir_close(dir);
    if (used.n == 0) {
        fprintf(stderr, "scores: %s: no region with its paint\n", argv[2]);
        return 1;
    }
    const Score want = score_of_style(argv[1]), got = score_of(&sums);
    printf("%-28s %5.2f %5.2f %5.1f %7.2f %5.2f %6.1f (%.1f)\n", argc > 3 ? argv[3] : "",
           got.sharp / want.sharp, got.deviation / want.deviation, profile_error(&want, &got),
           got.flicker / want.flicker, used.sum / used.n, got.rim, want.rim);
    return 0;
}
