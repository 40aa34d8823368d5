/* The ground on which figures move, and the camera: what the paper moves with. */
#include "job/region_plan.h"

#include <math.h>

#define GROUND_SHARE 0.4 // of the page: more is ground
#define MOVED 0.02       // of the page's width: what goes less far rests

/** How far a region goes to the sides in the film; against another, or -1: against the page. */
static double way_of(const FlShapes *shapes, int region, int other)
{
    const FlDrawing *drawing = shapes->drawing;
    const int with = other < 0 ? region : other;
    double least = INFINITY, most = -INFINITY;
    for (int f = MAX(fl_drawing_region(drawing, region)->first_frame,
                     fl_drawing_region(drawing, with)->first_frame);
         f < shapes->n_frames; f++) {
        const double from = other < 0 ? 0 : (double)fl_drawing_anchor(drawing, other, f).x;
        const double x = (double)fl_drawing_anchor(drawing, region, f).x - from;
        least = fmin(least, x), most = fmax(most, x);
    }
    return fmax(most - least, 0);
}

/** The share of the page that moves to the sides along with a region; 0: it rests, or water rises
 * and falls. Hills behind a meadow move the same way, less far. */
static double moves_along(const FlShapes *shapes, int region)
{
    const double way = way_of(shapes, region, -1);
    double along = 0;
    for (int r = 0; r < fl_drawing_regions(shapes->drawing) && way > MOVED * shapes->page_width;
         r++)
        along += fl_shapes_share_of_page(shapes, r) * fmax(1 - way_of(shapes, r, region) / way, 0);
    return along;
}

/** How well a region serves as the camera; 0: it is no ground. Above 1: it moves, and comes before
 * the sky that rests behind it. */
static double rank_of(const FlShapes *shapes, int region)
{
    const double share = fl_shapes_share_of_page(shapes, region);
    const bool wide = fl_drawing_region(shapes->drawing, region)->wide;
    const double along = wide ? moves_along(shapes, region) : 0;
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
    shapes->n_far = most > 1 ? shapes->camera : 0;
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
