/* The ground on which figures move, and the camera: what the paper moves with. */
#include "job/region_plan.h"

#include <math.h>

#define GROUND_SHARE 0.4 // of the page: more is ground

/** The way of a region through the film; against that of another, or -1: against the page. */
static double way_of(const FlShapes *shapes, int region, int other)
{
    double way = 0;
    for (int f = 1; f < shapes->n_frames; f++) {
        double step[2] = {0, 0};
        for (int k = 0; k < (other < 0 ? 1 : 2); k++) {
            const FlAnchor was = fl_drawing_anchor(shapes->drawing, k ? other : region, f - 1);
            const FlAnchor now = fl_drawing_anchor(shapes->drawing, k ? other : region, f);
            const double sign = k ? -1 : 1;
            step[0] += sign * (double)(now.x - was.x), step[1] += sign * (double)(now.y - was.y);
        }
        way += hypot(step[0], step[1]);
    }
    return way;
}

/** The share of the page that moves along with a region; 0: it rests. Hills behind a meadow move
 * the same way, less far. */
static double moves_along(const FlShapes *shapes, int region)
{
    const double way = way_of(shapes, region, -1);
    double along = 0;
    for (int r = 0; r < fl_drawing_regions(shapes->drawing) && way > 1; r++)
        along += fl_shapes_share_of_page(shapes, r) * fmax(1 - way_of(shapes, r, region) / way, 0);
    return along;
}

/** How well a region serves as the camera; 0: it is no ground. A ground that moves comes before the
 * sky that rests behind it. */
static double rank_of(const FlShapes *shapes, int region)
{
    const double share = fl_shapes_share_of_page(shapes, region);
    const bool spans = fl_drawing_region(shapes->drawing, region)->spans;
    const double along = spans ? moves_along(shapes, region) : 0;
    return along > GROUND_SHARE ? 1 + along : share > GROUND_SHARE ? share : 0;
}

static bool find_camera(FlShapes *shapes, const char *wanted, GError **error)
{
    const bool none = g_str_equal(wanted, "none"), found = g_str_equal(wanted, "auto");
    double most = 0;
    shapes->camera = -1;
    for (int r = 0; r < fl_drawing_regions(shapes->drawing) && !none; r++) {
        const bool named = g_str_equal(wanted, fl_drawing_region(shapes->drawing, r)->name);
        const double rank = found ? rank_of(shapes, r) : named ? 1 : 0;
        if (rank > most)
            shapes->camera = r, most = rank;
    }
    if (shapes->camera >= 0 || none || found)
        return true;
    return fl_fail(error, FL_ERROR_USAGE,
                   "camera “%s”: there is no such region; expected auto, none or the name of one",
                   wanted);
}

bool fl_shapes_find_ground(FlShapes *shapes, const char *camera, GError **error)
{
    const int n = fl_drawing_regions(shapes->drawing);
    if (!find_camera(shapes, camera ? camera : "auto", error))
        return false;
    g_free(shapes->ground);
    shapes->ground = g_new0(bool, MAX(n, 1));
    for (int r = 0; r < n; r++)
        shapes->ground[r] = r == shapes->camera || fl_drawing_region(shapes->drawing, r)->stays ||
                            fl_shapes_share_of_page(shapes, r) > GROUND_SHARE;
    return true;
}
