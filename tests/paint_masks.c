/*
 * Paints a mask sequence without any SVG: what the scorecards are made from.
 *
 * usage: paint_masks STYLE_DIR MASK_DIR OUT_DIR [FRAMES [NAME=VALUE …]]
 * MASK_DIR holds mask_%05d.png from 1; OUT_DIR gets o_%05d.png and nnf/nnf_%05d.f32 (frame, x, y,
 * theta per pixel). FRAMES beyond the last mask go on backwards and forwards. NAME=VALUE sets a
 * parameter, preset=NAME all of them.
 */
#include "default_params.h"
#include "synth/synth.h"
#include <cairo.h>
#include <glib/gstdio.h>
#include <stdio.h>
#include <string.h>

typedef struct Masks {
    char *folder;
    int n, width, height;
    uint8_t *data;
} Masks;

static bool read_mask(const char *file, Masks *masks)
{
    cairo_surface_t *s = cairo_image_surface_create_from_png(file);
    if (cairo_surface_status(s) != CAIRO_STATUS_SUCCESS)
        return false;
    const int w = cairo_image_surface_get_width(s), h = cairo_image_surface_get_height(s);
    masks->width = w, masks->height = h;
    masks->data = g_realloc_n(masks->data, masks->n + 1, (size_t)w * h);
    const bool grey = cairo_image_surface_get_format(s) == CAIRO_FORMAT_A8;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const unsigned char *row =
                cairo_image_surface_get_data(s) + (size_t)y * cairo_image_surface_get_stride(s);
            masks->data[((size_t)masks->n * h + y) * w + x] = grey ? row[x] : row[4 * x];
        }
    cairo_surface_destroy(s);
    masks->n++;
    return true;
}

static int pingpong(int frame, int n)
{
    const int period = MAX(2 * n - 2, 1), k = frame % period;
    return k < n ? k : period - k;
}

static bool mask_of(void *data, int frame, uint8_t *coverage, GError **error)
{
    const Masks *m = data;
    const size_t pixels = (size_t)m->width * m->height;
    memcpy(coverage, m->data + pingpong(frame, m->n) * pixels, pixels);
    return true;
}

static void write_picture(const char *file, const uint8_t *rgb, int w, int h)
{
    cairo_surface_t *s = cairo_image_surface_create(CAIRO_FORMAT_RGB24, w, h);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const uint8_t *p = rgb + 3 * ((size_t)y * w + x);
            uint32_t *to = (uint32_t *)(void *)(cairo_image_surface_get_data(s) +
                                                (size_t)y * cairo_image_surface_get_stride(s));
            to[x] = (uint32_t)p[0] << 16 | (uint32_t)p[1] << 8 | p[2];
        }
    cairo_surface_mark_dirty(s);
    cairo_surface_write_to_png(s, file);
    cairo_surface_destroy(s);
}

static void write_field(const char *file, const FlSynthView *view, int w, int h)
{
    g_autofree float *out = g_new0(float, 4 * (size_t)w * h);
    for (int y = 0; y < view->rect.height; y++)
        for (int x = 0; x < view->rect.width; x++) {
            const FlMatch m = view->nnf->match[(size_t)y * view->rect.width + x];
            float *to = out + 4 * ((size_t)(view->rect.y + y) * w + view->rect.x + x);
            to[0] = m.frame, to[1] = m.x_16 / 16.0f, to[2] = m.y_16 / 16.0f;
            to[3] = m.theta * (float)(2 * G_PI / FL_ANGLES);
        }
    g_file_set_contents(file, (const char *)out, 4 * sizeof(float) * w * h, NULL);
}

static void print_stats(int frame, const FlFrameStats *s, double seconds)
{
    fprintf(stderr, "%d: %.3f s", frame, seconds);
    for (int l = s->n_levels - 1; l >= 0; l--)
        fprintf(stderr, "  L%d %dpx %.3f>%.3f %.0f/px +%.2f %.3fs", l, s->level[l].pixels,
                s->level[l].energy_start, s->level[l].energy,
                (double)s->level[l].counts.tried / MAX(s->level[l].pixels, 1),
                (double)s->level[l].counts.accepted / MAX(s->level[l].pixels, 1),
                s->level[l].seconds);
    fprintf(stderr, "\n");
}

static int paint(const FlStyle *style, Masks *masks, const char *out, int frames,
                 const FlParams *params, GError **error)
{
    const int w = masks->width, h = masks->height;
    const FlGuideParams how = fl_guide_params(params);
    const FlGuideSource source = {w, h, frames, mask_of, NULL, masks};
    g_autoptr(FlExemplar) exemplar = fl_exemplar_new(style, params, error);
    g_autoptr(FlGuideSequence) guides =
        exemplar ? fl_guide_sequence_new(&source, &how, error) : NULL;
    g_autoptr(FlSynth) synth =
        guides ? fl_synth_new(exemplar, params, (FlSynthSize){w, h, w, h}, 1) : NULL;
    g_auto(FlGuides) now = {0};
    if (!synth || !fl_guides_init(&now, w, h, error))
        return 1;
    g_autofree uint8_t *rgb = g_malloc(3 * (size_t)w * h);
    double total = 0, pixels = 0;
    fl_synth_measure(synth, g_getenv("VERBOSE") != NULL);
    for (int f = 0; f < frames; f++) {
        FlFrameStats stats;
        FlSynthView view;
        if (!fl_guide_sequence_get(guides, f, &now, error))
            return 1;
        const gint64 start = g_get_monotonic_time();
        if (!fl_synth_frame(synth, &now, rgb, &stats, &view, error))
            return 1;
        const double seconds = (double)(g_get_monotonic_time() - start) * 1e-6;
        total += seconds, pixels += stats.n_levels ? stats.level[0].pixels : 0;
        if (g_getenv("VERBOSE"))
            print_stats(f + 1, &stats, seconds);
        g_autofree char *picture = g_strdup_printf("%s/o_%05d.png", out, f + 1);
        g_autofree char *field = g_strdup_printf("%s/nnf/nnf_%05d.f32", out, f + 1);
        write_picture(picture, rgb, w, h);
        if (view.nnf && frames <= 40)
            write_field(field, &view, w, h);
    }
    fprintf(stderr, "%s: %.3f s/frame, %.2f s/Mpx\n", out, total / frames, total / pixels * 1e6);
    return 0;
}

int main(int argc, char **argv)
{
    g_autoptr(GError) error = NULL;
    Masks masks = {0};
    FlParams *params = default_params();
    if (argc < 4) {
        fprintf(stderr,
                "usage: paint_masks STYLE_DIR MASK_DIR OUT_DIR [FRAMES [NAME=VALUE ...]]\n");
        return 2;
    }
    for (int i = 5; i < argc; i++) {
        g_auto(GStrv) pair = g_strsplit(argv[i], "=", 2);
        const bool preset = g_str_equal(pair[0], "preset");
        if (!(preset ? fl_params_preset(params, pair[1], &error)
                     : fl_params_set(params, pair[0], pair[1], &error)))
            g_error("%s", error->message);
    }
    g_autofree char *nnf = g_build_filename(argv[3], "nnf", NULL);
    g_mkdir_with_parents(nnf, 0755);
    for (int i = 1;; i++) {
        g_autofree char *file = g_strdup_printf("%s/mask_%05d.png", argv[2], i);
        if (!g_file_test(file, G_FILE_TEST_EXISTS) || !read_mask(file, &masks))
            break;
    }
    g_autoptr(FlStyle) style = fl_style_load(argv[1], &error);
    const int frames = argc > 4 ? atoi(argv[4]) : masks.n;
    const int status = style ? paint(style, &masks, argv[3], frames, params, &error) : 1;
    if (error)
        fprintf(stderr, "paint_masks: %s\n", error->message);
    return status;
}
