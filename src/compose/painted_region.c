#include "compose/painted_region.h"

#include "base/alloc.h"

void fl_painted_clear(FlPaintedRegion *painted)
{
    g_clear_pointer(&painted->painted, free);
    painted->alpha = NULL;
}

bool fl_painted_open(FlPaintedRegion *painted, GError **error)
{
    if (painted->painted)
        return true;
    painted->painted = fl_alloc_scratch(fl_painted_bytes(painted), 1, "a painted region", error);
    if (painted->painted && painted->reach_px > 0)
        painted->alpha = painted->painted + 3 * fl_rect_pixels(painted->rect);
    return painted->painted;
}
