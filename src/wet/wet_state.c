/* The paper between two runs of a render. */
#include "wet/wet.h"

#include "base/alloc.h"
#include "base/compress.h"
#include <math.h>

/** Of a region. */
typedef struct MarkerState {
    FlRect rect; // of its contour in the frame before
    int32_t n_points, rests;
    int32_t n_fronts;
} MarkerState;

typedef struct SheetState {
    int32_t at;
    float camera_x, camera_y;
    FlRect wet;
    FlAffine paper;
} SheetState;

/** Header and parts of a state. */
typedef struct State {
    size_t bytes;
    SheetState *sheet;
    MarkerState *marker; // behind it
    FlWetCell *cells;    // of sheet->wet
    GArray *parts;       // of FlSpan
} State;

static void state_init(State *state, const FlWet *wet)
{
    state->bytes = sizeof(SheetState) + (size_t)wet->n_markers * sizeof(MarkerState);
    state->sheet = g_malloc0(state->bytes);
    state->marker = (MarkerState *)(state->sheet + 1);
    state->cells = NULL;
    state->parts = g_array_new(FALSE, FALSE, sizeof(FlSpan));
}

static void state_clear(State *state)
{
    g_free(state->sheet);
    free(state->cells);
    g_array_unref(state->parts);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(State, state_clear)

static void add_part(State *state, const void *data, size_t bytes)
{
    const FlSpan part = {(void *)data, bytes};
    g_array_append_val(state->parts, part);
}

/** All parts, once the header is known and there is room for them. */
static void list_parts(State *state, const FlWet *wet)
{
    const size_t cells = (size_t)wet->laid.width * (size_t)wet->laid.height;
    add_part(state, state->cells, fl_rect_pixels(state->sheet->wet) * sizeof(FlWetCell));
    add_part(state, wet->laid.rgb, 3 * cells);
    add_part(state, wet->laid.region, cells * sizeof *wet->laid.region);
    for (int m = 0; m < wet->n_markers; m++) {
        const FlMarker *marker = &wet->marker[m];
        const MarkerState *kept = &state->marker[m];
        add_part(state, marker->before.point, (size_t)kept->n_points * sizeof(FlEdgePoint));
        add_part(state, marker->fronts->data, (size_t)kept->n_fronts * sizeof(FlFrontMark));
    }
}

static bool alloc_cells(State *state, GError **error)
{
    const size_t n = fl_rect_pixels(state->sheet->wet);
    return (state->cells = fl_alloc_unset(MAX(n, 1), sizeof(FlWetCell), "a state", error));
}

GBytes *fl_wet_save(const FlWet *wet, GError **error)
{
    g_auto(State) state;
    state_init(&state, wet);
    *state.sheet = (SheetState){.at = wet->at,
                                .camera_x = wet->camera_x,
                                .camera_y = wet->camera_y,
                                .wet = wet->sheet.wet,
                                .paper = wet->sheet.fibres.place};
    for (int m = 0; m < wet->n_markers; m++) {
        const FlMarker *marker = &wet->marker[m];
        state.marker[m] = (MarkerState){.rect = marker->before.rect,
                                        .n_points = marker->before.n,
                                        .rests = marker->rests,
                                        .n_fronts = (int32_t)marker->fronts->len};
    }
    if (!alloc_cells(&state, error))
        return NULL;
    fl_rect_copy(wet->sheet.cell, wet->sheet.page, state.cells, state.sheet->wet,
                 sizeof(FlWetCell));
    list_parts(&state, wet);
    return fl_pack(state.sheet, state.bytes, &g_array_index(state.parts, FlSpan, 0),
                   (int)state.parts->len, error);
}

static bool lies_in(FlRect rect, FlRect page)
{
    return rect.x >= 0 && rect.y >= 0 && rect.width >= 0 && rect.height >= 0 &&
           rect.width <= page.width && rect.height <= page.height &&
           rect.x <= page.width - rect.width && rect.y <= page.height - rect.height;
}

/** Says if n floats are numbers that a film can have. */
static bool are_sane(const float *value, size_t n)
{
    bool sane = true;
    for (size_t k = 0; k < n; k++)
        sane = sane && fabsf(value[k]) < 1e6f;
    return sane;
}

static bool is_sane(const FlAffine *place)
{
    const double *value = &place->xx;
    bool sane = true;
    for (size_t k = 0; k < sizeof *place / sizeof *value; k++)
        sane = sane && fabs(value[k]) < 1e6;
    return sane;
}

/** Says if the header fits the film. */
static bool header_fits(const State *state, const FlWet *wet)
{
    const SheetState *sheet = state->sheet;
    const FlRect page = wet->sheet.page;
    bool fits = sheet->at >= -1 && sheet->at < wet->shapes->n_frames && lies_in(sheet->wet, page) &&
                are_sane(&sheet->camera_x, 2) && is_sane(&sheet->paper);
    for (int m = 0; m < wet->n_markers; m++)
        fits = fits && lies_in(state->marker[m].rect, page) && state->marker[m].n_fronts >= 0 &&
               (size_t)state->marker[m].n_fronts <= fl_rect_pixels(page) &&
               state->marker[m].n_points >= 0 &&
               (size_t)state->marker[m].n_points <= fl_rect_pixels(state->marker[m].rect);
    return fits;
}

static void make_room(const State *state, FlWet *wet)
{
    for (int m = 0; m < wet->n_markers; m++) {
        FlMarker *marker = &wet->marker[m];
        const MarkerState *kept = &state->marker[m];
        fl_moving_edge_clear(&marker->before);
        marker->before.rect = kept->rect, marker->before.n = kept->n_points;
        marker->before.point = g_new0(FlEdgePoint, MAX(kept->n_points, 1));
        marker->rests = kept->rests;
        g_array_set_size(marker->fronts, (guint)kept->n_fronts);
    }
}

/** Says if all indices and numbers are in range. */
static bool parts_fit(const State *state, const FlWet *wet)
{
    const size_t page = fl_rect_pixels(wet->sheet.page);
    const size_t n = fl_rect_pixels(state->sheet->wet) * sizeof(FlWetCell) / sizeof(float);
    bool fit = are_sane((const float *)state->cells, n);
    for (size_t p = 0; p < page; p++)
        fit = fit && wet->laid.region[p] < fl_drawing_regions(wet->shapes->drawing);
    for (int m = 0; m < wet->n_markers; m++) {
        const FlMarker *marker = &wet->marker[m];
        fit = fit && are_sane((const float *)marker->before.point,
                              (size_t)marker->before.n * sizeof(FlEdgePoint) / sizeof(float));
        for (guint k = 0; k < marker->fronts->len; k++) {
            const FlFrontMark *mark = &g_array_index(marker->fronts, FlFrontMark, k);
            fit = fit && mark->at >= 0 && (size_t)mark->at < page && are_sane(&mark->density, 6);
        }
    }
    return fit;
}

bool fl_wet_load(FlWet *wet, GBytes *bytes, GError **error)
{
    g_auto(State) state;
    state_init(&state, wet);
    if (!fl_state_bytes_header(bytes, state.sheet, state.bytes, error))
        return false;
    if (!header_fits(&state, wet))
        return fl_state_bytes_damaged("the paper's header", error);
    make_room(&state, wet);
    if (!alloc_cells(&state, error))
        return false;
    list_parts(&state, wet);
    if (!fl_state_bytes_parts(bytes, state.bytes, &g_array_index(state.parts, FlSpan, 0),
                              (int)state.parts->len, error))
        return false;
    if (!parts_fit(&state, wet))
        return fl_state_bytes_damaged("the paper's marks", error);
    wet->at = state.sheet->at;
    wet->camera_x = state.sheet->camera_x, wet->camera_y = state.sheet->camera_y;
    fl_wet_place_cells(wet);
    fl_wet_sheet_restore(&wet->sheet, state.sheet->wet, state.cells, state.sheet->paper);
    return fl_wet_show(wet, error);
}
