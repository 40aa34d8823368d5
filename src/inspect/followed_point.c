#include "inspect/followed_point.h"

#include <float.h>

#define LOST_PX 2.0f // search radius around the point

/* The motion of a pixel into the frame: px, and turns of the drawing. */
typedef struct Step {
    float x, y, turn;
} Step;

static Step step_at(const FlGuides *guides, size_t pixel)
{
    const int32_t *motion = guides->motion + 2 * pixel;
    if (guides->has_motion && motion[0] != FL_MOTION_UNKNOWN)
        return (Step){(float)motion[0] / FL_MOTION_ONE, (float)motion[1] / FL_MOTION_ONE,
                      (float)guides->turn[pixel] / 65536};
    return (Step){guides->flow[2 * pixel], guides->flow[2 * pixel + 1], 0};
}

static void find(FlFollowedPoint *point, FlRect rect, const FlGuides *guides)
{
    float deepest = -FLT_MAX;
    *point = (FlFollowedPoint){.found = true};
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t p = (size_t)y * rect.width + x;
            if (guides->mask[p] < FL_INSIDE || guides->distance[p] <= deepest)
                continue;
            deepest = guides->distance[p];
            point->here = true;
            point->x = (float)(rect.x + x), point->y = (float)(rect.y + y);
        }
}

/* Motion is known where things arrive, so this looks for the pixel that came from the point. */
static bool follow(FlFollowedPoint *point, FlRect rect, const FlGuides *guides)
{
    float nearest = LOST_PX * LOST_PX;
    Step taken = {0};
    bool followed = false;
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t p = (size_t)y * rect.width + x;
            if (guides->mask[p] < FL_INSIDE)
                continue;
            const Step step = step_at(guides, p);
            const float dx = (float)(rect.x + x) - step.x - point->x;
            const float dy = (float)(rect.y + y) - step.y - point->y;
            if (dx * dx + dy * dy < nearest)
                nearest = dx * dx + dy * dy, taken = step, followed = true;
        }
    if (followed)
        point->x += taken.x, point->y += taken.y, point->turn += taken.turn;
    return followed;
}

void fl_followed_point_move(FlFollowedPoint *point, FlRect rect, const FlGuides *guides)
{
    if (!point->here || !follow(point, rect, guides))
        find(point, rect, guides);
}
