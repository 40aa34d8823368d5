#include "compose/culling.h"

#include "base/alloc.h"
#include "base/row_kernels.h"
#include <string.h>

#define MARGIN_PX 1 // the visible part of an edge depends on its neighbours' coverage

/** A layer's rows among those of the frame. */
typedef struct Window {
    const FlLayersAbove *above;
    FlRect box;      // of the layer, with the margin
    uint8_t *hidden; // 255 or 0, of the box's columns: hidden in all rows that the layer's reaches
} Window;

static bool window_init(Window *window, const FlLayer *layer, const FlLayersAbove *above,
                        GError **error)
{
    const FlRect box = layer->area.box;
    *window = (Window){.above = above};
    window->box = (FlRect){box.x - MARGIN_PX, box.y - MARGIN_PX, box.width + 2 * MARGIN_PX,
                           box.height + 2 * MARGIN_PX};
    window->hidden = fl_alloc_unset((size_t)window->box.width, 1, "a row of a matte", error);
    return window->hidden != NULL;
}

/** Takes out of hidden what row y of the frame shows in columns first … last - 1 of the box; pixels
 * beyond the frame are not seen. Returns: true if any pixel stays hidden. */
static bool look_at_row(const Window *window, int y, int first, int last)
{
    const FlLayersAbove *above = window->above;
    const int from = MAX(first, -window->box.x);
    const int to = MIN(last, above->width - window->box.x);
    if (y < 0 || y >= above->height || from >= to)
        return true;
    const size_t row = (size_t)y * (size_t)above->width + (size_t)(window->box.x + from);
    return fl_row_kernels()->keep_hidden(above->area + row, above->paint + row,
                                         window->hidden + from, to - from);
}

/** Fills hidden for row y of the layer. Returns: whether anything is. */
static bool find_hidden(const Window *window, int y, FlColumns span)
{
    const int first = span.first, last = span.last + 2 * MARGIN_PX;
    bool any = true;
    memset(window->hidden + first, 255, (size_t)(last - first));
    for (int k = 0; k <= 2 * MARGIN_PX && any; k++)
        any = look_at_row(window, window->box.y + y + k, first, last);
    return any;
}

/** Each of n is hidden if the next one is as well. */
static void keep_next(uint8_t *hidden, int n)
{
    for (int x = 0; x < n; x++)
        hidden[x] &= hidden[x + 1];
}

/** Clears a row's pixels all whose window is hidden. Returns: the columns of what is left. */
static FlColumns clear_hidden(const Window *window, FlColumns span, uint8_t *restrict coverage)
{
    const int n = span.last - span.first;
    uint8_t *hidden = window->hidden + span.first;
    for (int k = 1; k <= 2 * MARGIN_PX; k++)
        keep_next(hidden, n + 2 * MARGIN_PX - k);
    for (int x = 0; x < n; x++)
        coverage[span.first + x] &= (uint8_t)~hidden[x];
    while (span.first < span.last && !coverage[span.first])
        span.first++;
    while (span.first < span.last && !coverage[span.last - 1])
        span.last--;
    return span;
}

/** Makes the coverage the layer's own. */
static uint8_t *own_coverage(FlLayer *layer, GError **error)
{
    const size_t n = fl_rect_pixels(layer->area.box);
    uint8_t *coverage = fl_alloc_unset(n, 1, "a layer", error);
    if (!coverage)
        return NULL;
    memcpy(coverage, layer->coverage, n);
    if (layer->owns_coverage)
        free((uint8_t *)layer->coverage);
    layer->coverage = coverage, layer->owns_coverage = true;
    return coverage;
}

bool fl_layer_cull(FlLayer *layer, const FlLayersAbove *above, GError **error)
{
    const FlRect box = layer->area.box;
    Window window;
    if (!above || above->gap_px > 0 || box.width == 0 || !layer->area.row)
        return true;
    if (!window_init(&window, layer, above, error))
        return false;
    g_autofree uint8_t *hidden = window.hidden;
    uint8_t *coverage = NULL;
    for (int y = 0; y < box.height; y++) {
        FlColumns *span = &layer->area.row[y];
        if (span->first == span->last || !find_hidden(&window, y, *span))
            continue;
        if (!coverage && !(coverage = own_coverage(layer, error)))
            return false;
        *span = clear_hidden(&window, *span, coverage + (size_t)y * (size_t)box.width);
    }
    return true;
}
