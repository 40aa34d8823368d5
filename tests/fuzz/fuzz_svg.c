/* A drawing: read, normalised, its leaves found, their paint asked for and one of them drawn. */
#include "apart.h"
#include "fuzz.h"
#include "svg/svg_frame.h"

#define MOST_LEAVES 8 // to keep an input's time short
#define SIDE 16

static void look_at(FlSvg *svg)
{
    double width, height;
    if (!fl_svg_size(svg, &width, &height, NULL))
        return;
    const FlLeaves *leaves = fl_svg_leaves(svg);
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_A8, SIDE, SIDE);
    cairo_t *cr = cairo_create(surface);
    for (guint l = 0; l < MIN(leaves->leaf->len, MOST_LEAVES); l++) {
        const FlLeaf *leaf = &g_array_index(leaves->leaf, FlLeaf, l);
        FlPainted parts[FL_MOST_PARTS];
        const int n = fl_svg_leaf_paints(svg, leaf, (FlPageSize){1, 1}, parts);
        g_assert_cmpint(n, <=, FL_MOST_PARTS);
        if (n > 0)
            fl_svg_draw(svg, leaf, parts[0].part, cr, (FlPageSize){SIDE, SIDE}, NULL);
        for (int k = 0; k < n; k++)
            fl_svg_paint_clear(&parts[k].paint);
    }
    cairo_destroy(cr);
    cairo_surface_destroy(surface);
}

static void read_drawing(const uint8_t *data, size_t size)
{
    char path[32];
    const int fd = fuzz_file(data, size, path);
    const FlSvgOptions options = {0};
    g_autoptr(GError) error = NULL;
    g_autoptr(FlWarnings) warnings = fl_warnings_new();
    g_autoptr(FlSvg) svg = fl_svg_open(path, 1, &options, warnings, &error);
    g_assert_true((svg == NULL) == (error != NULL));
    if (svg)
        look_at(svg);
    fuzz_file_end(fd);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_apart(read_drawing, data, size);
    return 0;
}
