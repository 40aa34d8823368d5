/*
 * usage: motion [--dump FOLDER] [--size PX] [--masks] FOLDER...
 *
 * Prints for each sequence how much of the area of the painted regions has its motion from the
 * outlines and how much from the masks, and how many of the pixels that move come from where the
 * region was. --dump writes the fields as FOLDER/REGION_0001.flo, motion into the frame, with a
 * picture of each. --masks leaves the outlines unread.
 */
#include "base/colour_map.h"
#include "guides/flow_file.h"
#include "guides/guides.h"
#include "guides/registration.h"
#include "io/png.h"
#include "render/motion_source.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Options {
    const char *dump;
    int size;
    bool masks;
} Options;

static void dump(const Options *o, const char *name, int number, int w, int h, const float *motion)
{
    GError *error = NULL;
    float most = 0.01f;
    g_autofree char *flo = g_strdup_printf("%s/%s_%04d.flo", o->dump, name, number);
    g_autofree char *png = g_strdup_printf("%s/%s_%04d.png", o->dump, name, number);
    g_autofree uint8_t *rgb = g_malloc(3 * (size_t)w * h);
    g_mkdir_with_parents(o->dump, 0777);
    g_assert_true(fl_flow_save(flo, w, h, motion, &error));
    for (size_t k = 0; k < 2 * (size_t)w * h; k++)
        most = MAX(most, fabsf(motion[k]));
    for (size_t p = 0; p < (size_t)w * h; p++)
        fl_colour_wheel(isnan(motion[2 * p]) ? 0 : motion[2 * p],
                        isnan(motion[2 * p + 1]) ? 0 : motion[2 * p + 1], most, rgb + 3 * p);
    g_assert_true(fl_png_write(png, rgb, w, h, 3, &error));
}

static bool by_masks(const FlMaskStore *masks, int region, int now, FlRect page, float *motion,
                     GError **error)
{
    const size_t n = fl_rect_pixels(page);
    g_autofree uint8_t *a = g_malloc(n), *b = g_malloc(n);
    g_autoptr(FlOutline) before = NULL, outline = NULL;
    return fl_mask_store_get(masks, region, now - 1, page, a, error) &&
           fl_mask_store_get(masks, region, now, page, b, error) &&
           (before = fl_outline_new(a, page.width, page.height, error)) &&
           (outline = fl_outline_new(b, page.width, page.height, error)) &&
           fl_registration(before, outline, motion, error);
}

/** Counts pixels of the region, and those that come from where it was. */
static void count_origins(const FlMaskStore *masks, int region, int now, FlRect page,
                          const float *motion, double *all, double *lands)
{
    GError *error = NULL;
    const size_t n = fl_rect_pixels(page);
    g_autofree uint8_t *a = g_malloc(n), *b = g_malloc(n);
    g_assert_true(fl_mask_store_get(masks, region, now - 1, page, a, &error));
    g_assert_true(fl_mask_store_get(masks, region, now, page, b, &error));
    for (size_t p = 0; p < n; p++) {
        if (b[p] < FL_INSIDE || isnan(motion[2 * p]) ||
            (motion[2 * p] == 0 && motion[2 * p + 1] == 0))
            continue;
        const int x = (int)lroundf((float)(p % page.width) - motion[2 * p]);
        const int y = (int)lroundf((float)(p / page.width) - motion[2 * p + 1]);
        *all += 1;
        *lands += x < 0 || y < 0 || x >= page.width || y >= page.height ||
                  a[(size_t)y * page.width + x] > 0; // beyond the frame nobody knows
    }
}

static FlMaskStore *masks_of(const FlDrawing *drawing, GError **error)
{
    const int w = fl_drawing_width(drawing), h = fl_drawing_height(drawing);
    FlMaskStore *masks =
        fl_mask_store_new(fl_drawing_regions(drawing), fl_drawing_frames(drawing), w, h, error);
    g_autofree uint8_t *mask = g_malloc((size_t)w * h);
    for (int f = 0; f < fl_drawing_frames(drawing); f++) {
        g_autoptr(FlDrawList) runs = fl_drawing_draw_list(drawing, f, error);
        for (int r = 0; runs && r < fl_drawing_regions(drawing); r++) {
            memset(mask, 0, (size_t)w * h);
            fl_draw_list_mask(runs, r, w, h, mask);
            g_assert_true(fl_mask_store_put(masks, r, f, mask, error));
        }
    }
    return masks;
}

static void show(const char *folder, const Options *o)
{
    GError *error = NULL;
    const char *const inputs[] = {folder, NULL};
    const FlDrawingOptions options = {.frames = {inputs, 1}, .width = o->size};
    g_autoptr(FlDrawing) drawing = fl_drawing_open(&options, NULL, &error);
    g_assert_no_error(error);
    const FlRect page = {0, 0, fl_drawing_width(drawing), fl_drawing_height(drawing)};
    g_autoptr(FlMaskStore) masks = masks_of(drawing, &error);
    g_assert_no_error(error);
    g_autoptr(FlMotionSource) source = fl_motion_source_new(drawing, masks, false, &error);
    g_autofree float *motion = g_new0(float, 2 * fl_rect_pixels(page));
    double exact = 0, registered = 0, moved = 0, seconds = 0, all = 0, lands = 0;
    int fields = 0;
    for (int r = 0; r < fl_drawing_regions(drawing); r++)
        for (int f = 0; f < fl_drawing_frames(drawing); f++) {
            FlMotionShares shares = {0, 0};
            if (!fl_drawing_region(drawing, r)->paintable)
                continue;
            const gint64 start = g_get_monotonic_time();
            if (f > 0 && o->masks)
                g_assert_true(by_masks(masks, r, f, page, motion, &error));
            else if (f > 0)
                g_assert_true(fl_motion_source_get(source, &(FlRegionStep){r, f - 1, f, page, {0}},
                                                   motion, &shares, &error));
            seconds += (double)(g_get_monotonic_time() - start) * 1e-6;
            fields++;
            double speed = 0;
            for (size_t p = 0; p < fl_rect_pixels(page); p++)
                speed += hypot(motion[2 * p], motion[2 * p + 1]) > 0.05;
            if (speed > 0)
                exact += (double)shares.exact, registered += (double)shares.registered;
            moved += speed;
            if (f > 0)
                count_origins(masks, r, f, page, motion, &all, &lands);
            if (o->dump)
                dump(o, fl_drawing_region(drawing, r)->name, fl_drawing_number(drawing, f),
                     page.width, page.height, motion);
        }
    g_autofree char *name = g_path_get_basename(folder);
    printf("%-22s exact %5.1f %%, moving %5.2f Mpx, from the shape %5.1f %%, %5.1f ms a field of "
           "%d\n",
           name, 100 * exact / MAX(exact + registered, 1), moved * 1e-6, 100 * lands / MAX(all, 1),
           1e3 * seconds / MAX(fields, 1), fields);
    fflush(stdout);
}

int main(int argc, char **argv)
{
    Options o = {NULL, 0, false};
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--dump") == 0 && i + 1 < argc)
            o.dump = argv[++i];
        else if (strcmp(argv[i], "--size") == 0 && i + 1 < argc)
            o.size = atoi(argv[++i]);
        else if (strcmp(argv[i], "--masks") == 0)
            o.masks = true;
        else
            show(argv[i], &o);
    }
    return 0;
}
