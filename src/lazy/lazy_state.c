#include "lazy/lazy_state.h"

#include "base/alloc.h"
#include "base/compress.h"

typedef struct Header {
    int32_t frame, valid, width, height;
} Header;

enum { FIELD, PICTURE, MASK, SHAPE, N_PARTS };

static bool make_room(FlLazyState *state, GError **error)
{
    const size_t pixels = (size_t)state->width * (size_t)state->height;
    return (state->past.rgba = fl_alloc(4 * pixels, sizeof(uint16_t), "a picture", error)) &&
           (state->past.mask = fl_alloc(pixels, 1, "a mask", error)) &&
           (state->shape = fl_alloc(pixels, 1, "a mask", error)) &&
           fl_nnf_init(&state->past.nnf, state->width, state->height, error);
}

void fl_lazy_state_forget(FlLazyState *state)
{
    g_clear_pointer(&state->past.rgba, free);
    g_clear_pointer(&state->past.mask, free);
    g_clear_pointer(&state->shape, free);
    fl_nnf_clear(&state->past.nnf);
    state->valid = false;
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
    return fl_pack(&header, sizeof header, parts, state->valid ? N_PARTS : 0, error);
}

static bool unpack(FlLazyState *state, GBytes *bytes, const FlExemplarLevel *level, GError **error)
{
    Header h;
    if (!fl_state_bytes_header(bytes, &h, sizeof h, error))
        return false;
    if (h.frame < 0 || (h.valid != 0 && h.valid != 1) || h.width != state->width ||
        h.height != state->height)
        return fl_state_bytes_damaged("it does not start as a state does", error);
    fl_lazy_state_forget(state);
    state->frame = h.frame;
    if (!h.valid)
        return true;
    if (!make_room(state, error))
        return false;
    FlSpan parts[N_PARTS];
    parts_of(state, parts);
    state->valid = fl_state_bytes_parts(bytes, sizeof h, parts, N_PARTS, error) &&
                   (fl_nnf_fits(&state->past.nnf, level) ||
                    fl_state_bytes_damaged("its field points outside the style", error));
    return state->valid;
}

bool fl_lazy_state_unpack(FlLazyState *state, GBytes *bytes, const FlExemplarLevel *level,
                          GError **error)
{
    const bool whole = unpack(state, bytes, level, error);
    if (!whole)
        fl_lazy_state_forget(state);
    return whole;
}
