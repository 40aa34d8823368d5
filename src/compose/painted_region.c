#include "compose/painted_region.h"

#include "base/alloc.h"
#include "base/compress.h"

/* Colours and alpha, in one piece. */
static FlSpan span_of(const FlPaintedRegion *painted, uint8_t *picture)
{
    return (FlSpan){picture, fl_painted_bytes(painted)};
}

static void set_picture(FlPaintedRegion *painted, uint8_t *picture)
{
    painted->painted = picture;
    painted->alpha =
        picture && painted->reach_px > 0 ? picture + 3 * fl_rect_pixels(painted->rect) : NULL;
}

void fl_painted_clear(FlPaintedRegion *painted)
{
    g_clear_pointer(&painted->packed, g_bytes_unref);
    free(painted->painted);
    set_picture(painted, NULL);
}

bool fl_painted_pack(FlPaintedRegion *painted, GError **error)
{
    const FlSpan picture = span_of(painted, painted->painted);
    if (!painted->painted)
        return true;
    painted->packed = fl_pack(NULL, 0, &picture, 1, error);
    if (!painted->packed)
        return false;
    free(painted->painted);
    set_picture(painted, NULL);
    return true;
}

/* A picture as it was packed, or a black one; to be freed with free(). */
static uint8_t *unpacked(const FlPaintedRegion *painted, GError **error)
{
    g_autofree uint8_t *picture =
        fl_alloc_scratch(fl_painted_bytes(painted), 1, "a painted region", error);
    const FlSpan part = span_of(painted, picture);
    if (!picture || (painted->packed && !fl_state_bytes_parts(painted->packed, 0, &part, 1, error)))
        return NULL;
    return g_steal_pointer(&picture);
}

bool fl_painted_open(FlPaintedRegion *painted, GError **error)
{
    if (painted->painted)
        return true;
    set_picture(painted, unpacked(painted, error));
    g_clear_pointer(&painted->packed, g_bytes_unref);
    return painted->painted != NULL;
}

bool fl_painted_renew(FlPaintedRegion *painted, GError **error)
{
    g_clear_pointer(&painted->packed, g_bytes_unref);
    return fl_painted_open(painted, error);
}

bool fl_painted_read(const FlPaintedRegion *painted, FlPaintedReader *look, GError **error)
{
    *look = (FlPaintedReader){.region = *painted};
    if (painted->painted)
        return true;
    set_picture(&look->region, look->own = unpacked(painted, error));
    return look->own != NULL;
}

void fl_painted_reader_clear(FlPaintedReader *look)
{
    free(look->own);
    *look = (FlPaintedReader){0};
}
