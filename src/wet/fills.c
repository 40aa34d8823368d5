/* The ink of regions in frames that are not painted: that of their paint in one that is, else that
 * of their fills. */
#include "wet/wet.h"

#include "wet/wet_data.h"

#define RIM_PX 9 // px of the page from the edge in which stains take their colour

void fl_wet_take_fills(FlWet *wet)
{
    const FlShapes *shapes = wet->shapes;
    for (int r = 0; r < fl_drawing_regions(shapes->drawing); r++) {
        const int p = shapes->painted_of[r];
        const FlRegionSettings *settings = p < 0 ? NULL : &shapes->painted[p].settings;
        const uint8_t *rgb = settings && settings->has_colour
                                 ? settings->colour
                                 : fl_drawing_region(shapes->drawing, r)->rgb;
        for (int c = 0; c < 3; c++)
            wet->ink[3 * r + c] = fl_wet_absorbance(rgb[c], wet->paper[c]);
    }
}

/** Says if a cell of a region lies near to its edge. */
static bool is_rim(const FlWet *wet, int x, int y)
{
    const FlLaid *laid = &wet->laid;
    const int far = MAX((int)(RIM_PX * wet->sheet.px), 1), width = laid->width;
    const int16_t *region = laid->region, own = region[y * width + x];
    const int left = MAX(x - far, 0), right = MIN(x + far, width - 1);
    const int above = MAX(y - far, 0), below = MIN(y + far, laid->height - 1);
    return region[y * width + left] != own || region[y * width + right] != own ||
           region[above * width + x] != own || region[below * width + x] != own;
}

/** Sums of a region's paint near to its edges. */
typedef struct Rim {
    float cells, ink[3];
} Rim;

/** By region; to be freed. */
static Rim *measure_rims(const FlWet *painted)
{
    const FlLaid *laid = &painted->laid;
    Rim *rims = g_new0(Rim, fl_drawing_regions(painted->shapes->drawing) + 1);
    for (int y = 0; y < laid->height; y++)
        for (int x = 0; x < laid->width; x++) {
            const size_t cell = (size_t)y * (size_t)laid->width + (size_t)x;
            if (laid->region[cell] < 0 || !is_rim(painted, x, y))
                continue;
            Rim *rim = &rims[laid->region[cell]];
            rim->cells++;
            for (size_t c = 0; c < 3; c++)
                rim->ink[c] += fl_wet_absorbance(laid->rgb[3 * cell + c], painted->paper[c]);
        }
    return rims;
}

void fl_wet_learn(FlWet *wet, const FlWet *painted)
{
    const FlDrawing *own = wet->shapes->drawing, *its = painted->shapes->drawing;
    g_autofree Rim *rims = measure_rims(painted);
    for (int r = 0; r < fl_drawing_regions(own); r++)
        for (int k = 0; k < fl_drawing_regions(its); k++) {
            float *ink = wet->ink + 3 * r;
            if (!g_str_equal(fl_drawing_region(own, r)->name, fl_drawing_region(its, k)->name))
                continue;
            for (int c = 0; c < 3; c++) // a few cells say little
                ink[c] = (ink[c] + rims[k].ink[c]) / (1 + rims[k].cells);
        }
}
