/* The paint of frames that are not painted: their fills, as pale near edges as paint is. */
#include "wet/wet.h"

#include "wet/wet_data.h"
#include <math.h>

#define RIM_PX 9 // px of the page from the edge in which stains take their colour

static bool lay_fills(const FlWet *wet, int frame, FlLaid *laid, GError **error)
{
    const FlShapes *shapes = wet->shapes;
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(shapes->drawing, frame, error);
    fl_laid_begin(laid);
    for (int d = 0; draws && d < draws->n; d++) {
        const int p = shapes->painted_of[draws->draw[d].region];
        const FlRegionSettings *settings = p < 0 ? NULL : &shapes->painted[p].settings;
        if (settings)
            fl_laid_add_draw(laid, &draws->draw[d], settings->has_colour ? settings->colour : NULL,
                             wet->paper);
    }
    return draws;
}

bool fl_wet_lay_fills(FlWet *wet, int frame, GError **error)
{
    FlLaid *laid = &wet->laid;
    if (!lay_fills(wet, frame, laid, error))
        return false;
    for (size_t cell = 0; cell < fl_rect_pixels(wet->sheet.page) && wet->rim; cell++)
        for (int c = 0; laid->region[cell] >= 0 && c < 3; c++) {
            uint8_t *value = &laid->rgb[3 * cell + (size_t)c];
            const float ink = fl_wet_absorbance(*value, wet->paper[c]);
            const float rim = wet->rim[3 * laid->region[cell] + c];
            *value = (uint8_t)((float)wet->paper[c] * expf(-rim * ink) + 0.5f);
        }
    return true;
}

/** Says if a cell of a region lies near to its edge. */
static bool is_rim(const FlWet *wet, const FlLaid *laid, int x, int y)
{
    const int far = MAX((int)(RIM_PX * wet->sheet.px), 1), width = laid->width;
    const int16_t *region = laid->region, own = region[y * width + x];
    const int left = MAX(x - far, 0), right = MIN(x + far, width - 1);
    const int above = MAX(y - far, 0), below = MIN(y + far, laid->height - 1);
    return region[y * width + left] != own || region[y * width + right] != own ||
           region[above * width + x] != own || region[below * width + x] != own;
}

/** The region of the same name; -1: there is none. */
static int namesake(const FlWet *wet, const FlRegion *region)
{
    for (int r = 0; r < fl_drawing_regions(wet->shapes->drawing); r++)
        if (g_str_equal(fl_drawing_region(wet->shapes->drawing, r)->name, region->name))
            return r;
    return -1;
}

/** Adds up the absorbances near to edges, by region of wet and channel. */
static void add_inks(const FlWet *wet, const FlLaid *fills, const FlWet *painted, float *of_fill,
                     float *of_paint)
{
    const int n = fl_drawing_regions(wet->shapes->drawing);
    g_autofree int *other = g_new(int, MAX(n, 1));
    for (int r = 0; r < n; r++)
        other[r] = namesake(painted, fl_drawing_region(wet->shapes->drawing, r));
    for (int y = 0; y < fills->height; y++)
        for (int x = 0; x < fills->width; x++) {
            const size_t cell = (size_t)y * (size_t)fills->width + (size_t)x;
            const int region = fills->region[cell];
            if (region < 0 || painted->laid.region[cell] != other[region] ||
                !is_rim(wet, fills, x, y))
                continue;
            for (int c = 0; c < 3; c++) {
                const size_t at = 3 * cell + (size_t)c;
                of_fill[3 * region + c] += fl_wet_absorbance(fills->rgb[at], wet->paper[c]);
                of_paint[3 * region + c] += fl_wet_absorbance(painted->laid.rgb[at], wet->paper[c]);
            }
        }
}

bool fl_wet_learn(FlWet *wet, int frame, const FlWet *painted, GError **error)
{
    const FlRect page = wet->sheet.page;
    const size_t n = 3 * (size_t)fl_drawing_regions(wet->shapes->drawing);
    g_auto(FlLaid) fills = {0};
    if (page.width != painted->sheet.page.width || page.height != painted->sheet.page.height)
        return true;
    if (!fl_laid_init(&fills, page.width, page.height, wet->laid.cell_px, error) ||
        !lay_fills(wet, frame, &fills, error))
        return false;
    g_autofree float *of_fill = g_new0(float, n + 1), *of_paint = g_new0(float, n + 1);
    add_inks(wet, &fills, painted, of_fill, of_paint);
    g_free(wet->rim);
    wet->rim = g_new(float, n + 1);
    for (size_t k = 0; k < n; k++) // a few cells say little
        wet->rim[k] = CLAMP((of_paint[k] + 1) / (of_fill[k] + 1), 0, 2);
    return true;
}
