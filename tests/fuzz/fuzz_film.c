/*
 * A whole film: its frames stand in one file with FRAME_MARK between them. Its regions are found,
 * it is drawn, and its outlines and the motion between frames are asked for. The bytes after a
 * first
 * "<?film " say how it is read.
 */
#include "apart.h"
#include "drawing/outlines.h"
#include "folder.h"
#include "fuzz.h"
#include "guides/guides.h"
#include "render/motion_source.h"
#include "splice.h"
#include <glib/gstdio.h>
#include <math.h>
#include <string.h>

#define MOST_FRAMES 6 // to keep an input's time short
#define MOST_REGIONS 6
#define SIDE 48

/** Writes the frames. Returns: their paths, to be freed. */
static char **write_frames(const uint8_t *data, size_t size)
{
    GPtrArray *paths = g_ptr_array_new();
    const char *at = (const char *)data, *end = at + size;
    while (at && (int)paths->len < MOST_FRAMES) {
        const char *mark = memmem(at, (size_t)(end - at), FRAME_MARK, strlen(FRAME_MARK));
        char *path = g_strdup_printf("%s/%d.svg", fuzz_folder(), (int)paths->len + 1);
        FILE *file = g_fopen(path, "w");
        g_assert_nonnull(file);
        fwrite(at, 1, (size_t)((mark ? mark : end) - at), file);
        fclose(file);
        g_ptr_array_add(paths, path);
        at = mark ? mark + strlen(FRAME_MARK) : NULL;
    }
    g_ptr_array_add(paths, NULL);
    return (char **)g_ptr_array_free(paths, FALSE);
}

/** How the film is read: digits after "<?film ", one for each choice; the defaults without. */
static void choose(const uint8_t *data, size_t size, FlDrawingOptions *options)
{
    static const char mark[] = "<?film ";
    const char *at = (const char *)data + strlen(mark);
    if (size < strlen(mark) + 4 || memcmp(data, mark, strlen(mark)) != 0)
        return;
    options->strokes = (FlStrokes)(at[0] % (FL_STROKES_DROP + 1));
    options->key = (FlRegionKey)(at[1] % (FL_KEY_TREE + 1));
    options->registered = at[2] % 2;
    if (at[3] % 2)
        options->canvas = (FlCanvas){0, 0, 100, 80};
}

/* ---- what is asked of it -------------------------------------------------------------------- */

static void check_regions(const FlDrawing *drawing)
{
    g_autoptr(GHashTable) names = g_hash_table_new(g_str_hash, g_str_equal);
    for (int r = 0; r < fl_drawing_regions(drawing); r++) {
        const FlRegion *region = fl_drawing_region(drawing, r);
        g_assert_cmpint(strspn(region->name, "abcdefghijklmnopqrstuvwxyz0123456789-"), ==,
                        strlen(region->name));
        g_assert_cmpint(strlen(region->name), >, 0);
        g_assert_true(g_hash_table_add(names, region->name));
        g_assert_cmpint(region->n_present, <=, fl_drawing_frames(drawing));
        g_assert_true(isfinite(region->area_px));
    }
}

static void check_draws(const FlDrawing *drawing, const FlDrawList *draws)
{
    const int width = fl_drawing_width(drawing), height = fl_drawing_height(drawing);
    g_autofree uint8_t *rgba = g_malloc((size_t)width * height * 4);
    for (int i = 0; i < draws->n; i++) {
        const FlRect box = draws->draw[i].area.box;
        g_assert_cmpint(draws->draw[i].region, <, fl_drawing_regions(drawing));
        g_assert_true(box.x >= 0 && box.y >= 0 && box.x + box.width <= width &&
                      box.y + box.height <= height);
    }
    fl_draw_list_flat(draws, width, height, rgba);
    fl_draw_list_map(drawing, draws, rgba);
}

/** Draws all frames and keeps the masks. */
static bool draw_frames(const FlDrawing *drawing, FlMaskStore *masks)
{
    const int width = fl_drawing_width(drawing), height = fl_drawing_height(drawing);
    g_autofree uint8_t *mask = g_malloc((size_t)width * height);
    for (int f = 0; f < fl_drawing_frames(drawing); f++) {
        g_autoptr(GError) error = NULL;
        g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, f, &error);
        g_assert_true((draws == NULL) == (error != NULL));
        if (!draws)
            return false;
        check_draws(drawing, draws);
        for (int r = 0; r < MIN(fl_drawing_regions(drawing), MOST_REGIONS); r++) {
            memset(mask, 0, (size_t)width * height);
            fl_draw_list_mask(draws, r, width, height, mask);
            g_assert_true(fl_mask_store_put(masks, r, f, mask, NULL));
        }
    }
    return true;
}

static void check_outlines(const FlDrawing *drawing, int frame)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(FlOutlines) outlines = fl_drawing_outlines(drawing, frame, &error);
    g_assert_true((outlines == NULL) == (error != NULL));
    if (!outlines)
        return;
    for (int i = 0; i < outlines->n_leaves; i++) {
        const FlGeometry *g = &outlines->leaf[i];
        g_assert_true(g->first_subpath >= 0 && g->n_subpaths >= 0 &&
                      g->first_subpath + g->n_subpaths <= outlines->n_subpaths);
    }
    for (int i = 0; i < outlines->n_subpaths; i++)
        g_assert_true(outlines->subpath[i].first + outlines->subpath[i].n <= outlines->n_cubics);
}

/** Motion is a number, or unknown, and at most the frame's larger side. */
static void check_motion(const FlDrawing *drawing, FlMotionSource *source, int before, int now)
{
    const FlRect page = {0, 0, fl_drawing_width(drawing), fl_drawing_height(drawing)};
    const size_t n = 2 * fl_rect_pixels(page);
    g_autofree float *motion = g_new(float, n);
    for (int r = 0; r < MIN(fl_drawing_regions(drawing), MOST_REGIONS); r++) {
        if (!fl_motion_source_get(source, &(FlRegionStep){r, before, now, page, {0}}, motion, NULL,
                                  NULL))
            return;
        for (size_t k = 0; k < n; k++)
            g_assert_false(isinf(motion[k]));
    }
}

static void look_at(FlDrawing *drawing)
{
    const int n = fl_drawing_frames(drawing);
    check_regions(drawing);
    g_autoptr(FlMaskStore) masks =
        fl_mask_store_new(fl_drawing_regions(drawing), n, fl_drawing_width(drawing),
                          fl_drawing_height(drawing), NULL);
    g_autoptr(FlMotionSource) source = fl_motion_source_new(drawing, masks, false, NULL);
    if (!draw_frames(drawing, masks))
        return;
    for (int f = 0; f < n; f++) {
        check_outlines(drawing, f);
        check_motion(drawing, source, f > 0 ? f - 1 : n - 1, f);
    }
    fl_drawing_halve(drawing);
    for (int f = 0; f < n; f++) {
        g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, f, NULL);
        if (draws)
            check_draws(drawing, draws);
    }
}

static void read_film(const uint8_t *data, size_t size)
{
    g_auto(GStrv) paths = write_frames(data, size);
    FlDrawingOptions options = {.frames = {(const char *const *)paths, (int)g_strv_length(paths)},
                                .width = SIDE,
                                .height = SIDE};
    choose(data, size, &options);
    g_autoptr(FlWarnings) warnings = fl_warnings_new();
    g_autoptr(GError) error = NULL;
    g_autoptr(FlDrawing) drawing = fl_drawing_open(&options, warnings, &error);
    g_assert_true((drawing == NULL) == (error != NULL));
    if (drawing)
        look_at(drawing);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_folder(); // here, so that it is removed here
    fuzz_apart(read_film, data, size);
    return 0;
}
