/* The camera: the motion of the ground, which carries the paper along. */
#include "base/error.h"
#include "wet/wet_data.h"

#include "base/alloc.h"
#include "base/modes.h"
#include <math.h>

#define STRIDE 6     // cells between places at which the motion is looked at
#define STEADY 2e-4  // turn or growth a frame below which a camera only pans: .05 cells at the edge
#define MISFIT 0.5   // cells, root of mean squares: more is no motion of a camera
#define FASTEST 0.25 // turn or growth in a frame beyond which it is a cut

/** Adds the motion of the page to least squares. Returns: the number of places at which it is
 * known; *squares: of that motion. */
static int add_motion(const float *motion, FlRect page, FlLeastSquares *sum, double *squares)
{
    int n = 0;
    for (int j = STRIDE / 2; j < page.height; j += STRIDE)
        for (int i = STRIDE / 2; i < page.width; i += STRIDE) {
            const float *at = motion + 2 * ((size_t)j * (size_t)page.width + (size_t)i);
            double mode[FL_MODES][2], row[FL_MODES];
            if (isnan(at[0]) || isnan(at[1]))
                continue;
            fl_modes_at((double)i / page.width, (double)j / page.width, mode);
            for (int c = 0; c < 2; c++) {
                for (int k = 0; k < FL_MODES; k++)
                    row[k] = mode[k][c];
                fl_least_squares_add(sum, row, (double)at[c], 1);
                *squares += (double)(at[c] * at[c]);
            }
            n++;
        }
    return n;
}

/** The way to a place of the page, whose width is 1, by modes. */
static FlPoint way_to(const double p[FL_MODES], double x, double y)
{
    double mode[FL_MODES][2];
    FlPoint way = {0, 0};
    fl_modes_at(x, y, mode);
    for (int k = 0; k < FL_MODES; k++)
        way.x += p[k] * mode[k][0], way.y += p[k] * mode[k][1];
    return way;
}

/** The motion as an affine map. Returns: false if it only pans, or fits badly. */
static bool fit_motion(const float *motion, FlRect page, FlAffine *came)
{
    FlLeastSquares sum = {0};
    double p[FL_MODES], squares = 0;
    const int n = add_motion(motion, page, &sum, &squares);
    if (n < (int)fl_rect_pixels(page) / (4 * STRIDE * STRIDE) || !fl_least_squares_solve(&sum, p))
        return false; // of a quarter of the page at least
    for (int k = 0; k < FL_MODES; k++)
        squares -= p[k] * sum.b[k]; // what is left
    const FlPoint corner = way_to(p, 0, 0), right = way_to(p, 1, 0), down = way_to(p, 0, 1);
    const double xx = (right.x - corner.x) / page.width, yx = (right.y - corner.y) / page.width;
    const double xy = (down.x - corner.x) / page.width, yy = (down.y - corner.y) / page.width;
    const double most = MAX(MAX(fabs(xx), fabs(yx)), MAX(fabs(xy), fabs(yy)));
    *came = (FlAffine){1 - xx, -yx, -xy, 1 - yy, -corner.x, -corner.y};
    return most > STEADY && most < FASTEST && sqrt(MAX(squares, 0) / n) < MISFIT;
}

bool fl_wet_follow_camera(const FlWet *wet, int before, int frame, FlAffine *came, GError **error)
{
    const FlRect page = wet->sheet.page;
    const FlDrawing *drawing = wet->shapes->drawing;
    const int camera = wet->shapes->camera;
    if (camera < 0 || before < fl_drawing_region(drawing, camera)->first_frame)
        return true;
    const size_t n = fl_rect_pixels(page);
    g_autofree uint8_t *mask = fl_alloc_unset(n, 1, "a mask", error);
    g_autofree float *motion = fl_alloc_unset(2 * n, sizeof *motion, "a motion", error);
    if (!mask || !motion || !fl_wet_get_mask(wet, camera, frame, page, mask, error) ||
        !fl_wet_get_motion(wet, camera, before, frame, page, motion, error))
        return false;
    for (size_t p = 0; p < n; p++) // beyond the ground it is a guess
        motion[2 * p] = mask[p] < 128 ? NAN : motion[2 * p];
    if (fit_motion(motion, page, came))
        return true;
    const FlAnchor now = fl_drawing_anchor(drawing, camera, frame);
    const FlAnchor was = fl_drawing_anchor(drawing, camera, before);
    *came = FL_AFFINE_NONE;
    came->x0 = (was.x - now.x) / (float)wet->cell, came->y0 = (was.y - now.y) / (float)wet->cell;
    return true;
}
