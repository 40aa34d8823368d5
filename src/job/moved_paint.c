#include "job/moved_paint.h"

#include "base/alloc.h"
#include "base/state_bytes.h"
#include "transport/carried_ink.h"
#include <string.h>

typedef struct Moved {
    const FlEngine *painter;
    void *paint; // its state
    FlTile *tile;
    FlCarriedInk *ink;
} Moved;

static void moved_close(void *state)
{
    Moved *moved = state;
    if (moved->paint)
        moved->painter->close(moved->paint);
    fl_carried_ink_free(moved->ink);
    fl_tile_free(moved->tile);
    g_free(moved);
}

static void *moved_open(const FlEngineInput *input, GError **error)
{
    Moved *moved = g_new0(Moved, 1);
    FlCarriedInkInput carried = {.width = input->size.width,
                                 .height = input->size.height,
                                 .scale = input->tile->enlarged,
                                 .strength = &input->settings->strength,
                                 .seed = input->seed};
    memcpy(carried.colour.paper, input->style->paper, sizeof carried.colour.paper);
    moved->painter = fl_engine_choose(input->settings->engine, input->style->path);
    carried.tile = moved->tile = fl_tile_load(input->tile->path, carried.scale, error);
    if (moved->tile && (moved->ink = fl_carried_ink_new(&carried, error)) &&
        (moved->paint = moved->painter->open(input, error)))
        return moved;
    moved_close(moved);
    return NULL;
}

static void moved_measure(void *state, bool energies)
{
    Moved *moved = state;
    if (moved->painter->measure)
        moved->painter->measure(moved->paint, energies);
}

static bool moved_frame(void *state, FlGuides *guides, const FlEnginePaint *paint, GError **error)
{
    Moved *moved = state;
    guides->disposable = false; // the ink moves by them
    return moved->painter->frame(moved->paint, guides, paint, error) &&
           fl_carried_ink_move(moved->ink, guides, paint->rgb, error);
}

/* The painter's state, and before it how large that is; the ink's. */
static GBytes *moved_save(void *state, GError **error)
{
    Moved *moved = state;
    g_autoptr(GBytes) paint = moved->painter->save(moved->paint, error);
    g_autoptr(GBytes) ink = paint ? fl_carried_ink_save(moved->ink, error) : NULL;
    if (!ink)
        return NULL;
    gsize n_paint, n_ink;
    const void *first = g_bytes_get_data(paint, &n_paint);
    const void *second = g_bytes_get_data(ink, &n_ink);
    const uint64_t header = n_paint;
    const size_t size = sizeof header + n_paint + n_ink;
    uint8_t *bytes = fl_alloc(size, 1, "the state of a region", error);
    if (!bytes)
        return NULL;
    memcpy(bytes, &header, sizeof header);
    memcpy(bytes + sizeof header, first, n_paint);
    memcpy(bytes + sizeof header + n_paint, second, n_ink);
    return g_bytes_new_with_free_func(bytes, size, free, bytes);
}

static bool moved_load(void *state, GBytes *bytes, GError **error)
{
    Moved *moved = state;
    uint64_t header;
    if (!fl_state_bytes_header(bytes, &header, sizeof header, error))
        return false;
    const gsize rest = g_bytes_get_size(bytes) - sizeof header;
    if (header > rest)
        return fl_state_bytes_damaged("it ends too early", error);
    g_autoptr(GBytes) paint = g_bytes_new_from_bytes(bytes, sizeof header, header);
    g_autoptr(GBytes) ink = g_bytes_new_from_bytes(bytes, sizeof header + header, rest - header);
    return moved->painter->load(moved->paint, paint, error) &&
           fl_carried_ink_load(moved->ink, ink, error);
}

static const FlEngine moved_paint = {.name = "paint that is moved",
                                     .plays = true,
                                     .open = moved_open,
                                     .close = moved_close,
                                     .measure = moved_measure,
                                     .frame = moved_frame,
                                     .save = moved_save,
                                     .load = moved_load};

const FlEngine *fl_engine_of_region(FlStyleCache *styles, const FlStyleInstance *style,
                                    const FlRegionSettings *settings, float texture_px,
                                    const FlStyleInstance **tile, GError **error)
{
    const FlEngine *engine = fl_engine_choose(settings->engine, style->path);
    FlRegionSettings of_tile = *settings;
    *tile = NULL;
    if (!settings->tile)
        return engine;
    if (!engine->plays) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "the engine %s moves ink by its own style; ‘tile’ is for patch and lazyfluids",
                    engine->name);
        return NULL;
    }
    of_tile.style = settings->tile;
    of_tile.params.style_start = of_tile.params.style_step = 1, of_tile.params.style_frames = 0;
    if (!(*tile = fl_style_cache_get(styles, &of_tile, texture_px, error)))
        return NULL;
    if (fl_tile_exists((*tile)->path))
        return &moved_paint;
    g_set_error(error, FL_ERROR, FL_ERROR_STYLE,
                "%s: has no tile; expected a style of transport, such as pools", (*tile)->path);
    return NULL;
}
