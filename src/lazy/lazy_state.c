#include "lazy/lazy_state.h"

#include "base/alloc.h"
#include "base/compress.h"
#include <string.h>

typedef struct Header {
    int32_t frame, valid, width, height;
} Header;

enum { FIELD, PICTURE, MASK, SHAPE, N_PARTS };

bool fl_lazy_state_init(FlLazyState *state, int width, int height, GError **error)
{
    const size_t pixels = (size_t)width * (size_t)height;
    *state = (FlLazyState){.width = width, .height = height};
    return (state->past.rgba = fl_alloc(4 * pixels, sizeof(uint16_t), "a picture", error)) &&
           (state->past.mask = fl_alloc(pixels, 1, "a mask", error)) &&
           (state->shape = fl_alloc(pixels, 1, "a mask", error)) &&
           fl_nnf_init(&state->past.nnf, width, height, error);
}

void fl_lazy_state_clear(FlLazyState *state)
{
    free(state->past.rgba);
    free(state->past.mask);
    free(state->shape);
    fl_nnf_clear(&state->past.nnf);
    *state = (FlLazyState){0};
}

static void parts_of(const FlLazyState *state, FlSpan parts[N_PARTS])
{
    const size_t pixels = (size_t)state->width * (size_t)state->height;
    parts[FIELD] = (FlSpan){state->past.nnf.match, pixels * sizeof(FlMatch)};
    parts[PICTURE] = (FlSpan){state->past.rgba, 4 * pixels * sizeof(uint16_t)};
    parts[MASK] = (FlSpan){state->past.mask, pixels};
    parts[SHAPE] = (FlSpan){state->shape, pixels};
}

GBytes *fl_lazy_state_pack(const FlLazyState *state, GError **error)
{
    const Header header = {state->frame, state->valid, state->width, state->height};
    FlSpan parts[N_PARTS];
    parts_of(state, parts);
    const size_t capacity = state->valid ? fl_compress_bound(parts, N_PARTS) : 0;
    g_autofree uint8_t *bytes =
        fl_alloc(sizeof header + capacity, 1, "the state of a region", error);
    if (!bytes)
        return NULL;
    memcpy(bytes, &header, sizeof header);
    const size_t packed =
        state->valid ? fl_compress(parts, N_PARTS, bytes + sizeof header, capacity) : 0;
    if (state->valid && packed == 0) {
        g_set_error(error, FL_ERROR, FL_ERROR_NO_MEMORY, "not enough memory to pack a state");
        return NULL;
    }
    bytes = g_realloc(bytes, sizeof header + packed); // it is kept: no more bytes than needed
    return g_bytes_new_take(g_steal_pointer(&bytes), sizeof header + packed);
}

static bool damaged(FlLazyState *state, const char *what, GError **error)
{
    state->valid = false;
    g_set_error(error, FL_ERROR, FL_ERROR_CHANGED, "a region's state is damaged: %s", what);
    return false;
}

static bool matches_fit(const FlNnf *nnf, const FlExemplarLevel *level)
{
    for (size_t p = 0; p < (size_t)nnf->width * (size_t)nnf->height; p++) {
        const FlMatch m = nnf->match[p];
        if (m.frame != FL_NO_MATCH &&
            (m.frame < 0 || m.frame >= level->n_frames || m.x_16 > 16 * (level->width - 1) ||
             m.y_16 > 16 * (level->height - 1)))
            return false;
    }
    return true;
}

bool fl_lazy_state_unpack(FlLazyState *state, GBytes *bytes, const FlExemplarLevel *level,
                          GError **error)
{
    size_t size;
    const uint8_t *data = g_bytes_get_data(bytes, &size);
    Header h;
    if (size < sizeof h)
        return damaged(state, "it is cut short", error);
    memcpy(&h, data, sizeof h);
    if (h.frame < 0 || (h.valid != 0 && h.valid != 1) || h.width != state->width ||
        h.height != state->height)
        return damaged(state, "it does not start as a state does", error);
    state->frame = h.frame, state->valid = h.valid;
    FlSpan parts[N_PARTS];
    parts_of(state, parts);
    if (h.valid && !fl_decompress(data + sizeof h, size - sizeof h, parts, N_PARTS))
        return damaged(state, "its pictures cannot be read", error);
    if (h.valid && !matches_fit(&state->past.nnf, level))
        return damaged(state, "its field points outside the style", error);
    return true;
}
