/* The camera: the motion of the ground, which carries the paper along. */
#include "wet/wet_data.h"

#include "base/alloc.h"
#include <math.h>

#define STRIDE 6     // cells between places at which the motion is looked at
#define STEADY 2e-4  // turn or growth a frame below which a camera only pans: .05 cells at the edge
#define MISFIT 0.5   // cells, root of mean squares: more is no motion of a camera
#define FASTEST 0.25 // turn or growth in a frame beyond which it is a cut

/** The camera's region; auto: the largest ground. */
bool fl_wet_find_camera(const FlShapes *shapes, const char *wanted, int *camera, GError **error)
{
    wanted = wanted ? wanted : "auto";
    const bool none = g_str_equal(wanted, "none"), found = g_str_equal(wanted, "auto");
    double most = FL_GROUND_SHARE;
    *camera = -1;
    for (int r = 0; r < fl_drawing_regions(shapes->drawing) && !none; r++) {
        const double share = fl_shapes_share_of_page(shapes, r);
        const bool named = g_str_equal(wanted, fl_drawing_region(shapes->drawing, r)->name);
        if (named || (found && share > most))
            *camera = r, most = share;
    }
    if (*camera >= 0 || none || found)
        return true;
    g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                "camera “%s”: there is no such region; expected auto, none or the name of one",
                wanted);
    return false;
}

/** Sums for the least squares of (u, v) over (1, x, y). */
typedef struct Fit {
    double n, x, y, xx, xy, yy;
    double u[3], v[3], squares; // times 1, x and y
} Fit;

static Fit add_up(const float *motion, FlRect page)
{
    Fit fit = {0};
    for (int j = STRIDE / 2; j < page.height; j += STRIDE)
        for (int i = STRIDE / 2; i < page.width; i += STRIDE) {
            const float *at = motion + 2 * ((size_t)j * (size_t)page.width + (size_t)i);
            const double x = i - 0.5 * page.width, y = j - 0.5 * page.height;
            if (isnan(at[0]) || isnan(at[1]))
                continue;
            fit.n++, fit.x += x, fit.y += y;
            fit.xx += x * x, fit.xy += x * y, fit.yy += y * y;
            fit.u[0] += at[0], fit.u[1] += at[0] * x, fit.u[2] += at[0] * y;
            fit.v[0] += at[1], fit.v[1] += at[1] * x, fit.v[2] += at[1] * y;
            fit.squares += at[0] * at[0] + at[1] * at[1];
        }
    return fit;
}

/** Solves the normal equations for one component. Returns: the sum of squares that it explains. */
static double solve(const Fit *fit, const double sums[3], double out[3])
{
    const double mx = fit->x / fit->n, my = fit->y / fit->n;
    const double xx = fit->xx - fit->x * mx, xy = fit->xy - fit->x * my, yy = fit->yy - fit->y * my;
    const double a = sums[1] - sums[0] * mx, b = sums[2] - sums[0] * my;
    const double determinant = MAX(xx * yy - xy * xy, 1e-9);
    out[1] = (a * yy - b * xy) / determinant, out[2] = (b * xx - a * xy) / determinant;
    out[0] = sums[0] / fit->n - out[1] * mx - out[2] * my;
    return out[0] * sums[0] + out[1] * sums[1] + out[2] * sums[2];
}

/** The motion as an affine map. Returns: false if it only pans, or fits badly. */
static bool fit_motion(const float *motion, FlRect page, FlAffine *came)
{
    const Fit fit = add_up(motion, page);
    const double cx = 0.5 * page.width, cy = 0.5 * page.height;
    double u[3], v[3];
    if (fit.n < (double)fl_rect_pixels(page) / (STRIDE * STRIDE) / 4)
        return false; // of a quarter of the page at least
    const double explained = solve(&fit, fit.u, u) + solve(&fit, fit.v, v);
    const double most = MAX(MAX(fabs(u[1]), fabs(u[2])), MAX(fabs(v[1]), fabs(v[2])));
    *came = (FlAffine){.xx = 1 - u[1],
                       .yx = -v[1],
                       .xy = -u[2],
                       .yy = 1 - v[2],
                       .x0 = u[1] * cx + u[2] * cy - u[0],
                       .y0 = v[1] * cx + v[2] * cy - v[0]};
    return most > STEADY && most < FASTEST &&
           sqrt(MAX(fit.squares - explained, 0) / fit.n) < MISFIT;
}

bool fl_wet_follow_camera(const FlWet *wet, int before, int frame, FlAffine *came, GError **error)
{
    const FlRect page = wet->sheet.page;
    const FlDrawing *drawing = wet->shapes->drawing;
    if (wet->camera < 0 || before < 0)
        return true;
    g_autofree float *motion =
        fl_alloc_unset(2 * fl_rect_pixels(page), sizeof *motion, "a motion", error);
    if (!motion || !fl_wet_get_motion(wet, wet->camera, before, frame, page, motion, error))
        return false;
    if (fit_motion(motion, page, came))
        return true;
    const FlAnchor now = fl_drawing_anchor(drawing, wet->camera, frame);
    const FlAnchor was = fl_drawing_anchor(drawing, wet->camera, before);
    *came = FL_AFFINE_NONE;
    came->x0 = (was.x - now.x) / (float)wet->cell, came->y0 = (was.y - now.y) / (float)wet->cell;
    return true;
}
