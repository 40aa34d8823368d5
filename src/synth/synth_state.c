#include "synth/synth_state.h"

#include "base/alloc.h"
#include "base/compress.h"
#include "base/schedule.h"
#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* The bytes start with this; the packed field, mask, wetness and picture follow. Each match is
 * stored as its difference from the one before in its row, mostly the same in a coherent field:
 * states are a quarter smaller and packed in two thirds of the time. */
typedef struct Header {
    int32_t frame, valid;
    int32_t x, y, width, height;
    int32_t dries;
} Header;

static_assert(sizeof(Header) == FL_SYNTH_STATE_HEADER, "the header has no padding");

enum { FIELD, MASK, WETNESS, PICTURE, N_PARTS };

static size_t matches_of(const FlNnf *nnf)
{
    return (size_t)nnf->width * (size_t)nnf->height;
}

static FlMatch minus(FlMatch a, FlMatch b)
{
    return (FlMatch){.x_16 = (uint16_t)(a.x_16 - b.x_16),
                     .y_16 = (uint16_t)(a.y_16 - b.y_16),
                     .frame = (int16_t)(a.frame - b.frame),
                     .theta = (uint8_t)(a.theta - b.theta),
                     .off = (uint8_t)(a.off - b.off)};
}

static FlMatch plus(FlMatch a, FlMatch b)
{
    return (FlMatch){.x_16 = (uint16_t)(a.x_16 + b.x_16),
                     .y_16 = (uint16_t)(a.y_16 + b.y_16),
                     .frame = (int16_t)(a.frame + b.frame),
                     .theta = (uint8_t)(a.theta + b.theta),
                     .off = (uint8_t)(a.off + b.off)};
}

/* Each match of a row but the first minus the one before; to be freed with free(). */
static FlMatch *differences(const FlNnf *nnf, GError **error)
{
    FlMatch *out = fl_alloc_unset(matches_of(nnf), sizeof *out, "the state of a region", error);
#pragma omp parallel for schedule(static) if (fl_schedule_worth_threads(matches_of(nnf)))
    for (int y = 0; y < (out ? nnf->height : 0); y++) {
        const FlMatch *from = nnf->match + (size_t)y * (size_t)nnf->width;
        FlMatch *to = out + (size_t)y * (size_t)nnf->width;
        to[0] = from[0];
        for (int x = 1; x < nnf->width; x++)
            to[x] = minus(from[x], from[x - 1]);
    }
    return out;
}

static void add_up(FlNnf *nnf)
{
#pragma omp parallel for schedule(static) if (fl_schedule_worth_threads(matches_of(nnf)))
    for (int y = 0; y < nnf->height; y++) {
        FlMatch *row = nnf->match + (size_t)y * (size_t)nnf->width;
        for (int x = 1; x < nnf->width; x++)
            row[x] = plus(row[x], row[x - 1]);
    }
}

static size_t mask_bytes(const FlSynthState *state)
{
    return (size_t)state->width * (size_t)state->height;
}

/* `matches`: as they are packed. */
static void parts_of(const FlSynthState *state, FlMatch *matches, FlSpan parts[N_PARTS])
{
    parts[FIELD] = (FlSpan){matches, matches_of(&state->nnf) * sizeof *matches};
    parts[MASK] = (FlSpan){state->mask, mask_bytes(state)};
    parts[WETNESS] = (FlSpan){state->wet, mask_bytes(state)};
    parts[PICTURE] = (FlSpan){state->rgb, fl_synth_state_painted(state)};
}

static bool make_room(FlSynthState *state, GError **error)
{
    return fl_nnf_init(&state->nnf, state->rect.width, state->rect.height, error) &&
           (state->mask = fl_alloc(mask_bytes(state), 1, "a mask", error)) &&
           (state->wet = fl_alloc(mask_bytes(state), 1, "a mask", error)) &&
           (state->rgb = fl_alloc(fl_synth_state_painted(state), 1, "a picture", error));
}

void fl_synth_state_clear(FlSynthState *state)
{
    fl_nnf_clear(&state->nnf);
    g_clear_pointer(&state->mask, free);
    g_clear_pointer(&state->wet, free);
    g_clear_pointer(&state->rgb, free);
    state->valid = false;
}

GBytes *fl_synth_state_pack(const FlSynthState *state, GError **error)
{
    const FlRect rect = state->valid ? state->rect : (FlRect){0};
    const Header header = {state->frame, state->valid, rect.x,      rect.y,
                           rect.width,   rect.height,  state->dries};
    g_autofree FlMatch *matches = state->valid ? differences(&state->nnf, error) : NULL;
    if (state->valid && !matches)
        return NULL;
    FlSpan parts[N_PARTS];
    parts_of(state, matches, parts);
    return fl_pack(&header, sizeof header, parts, state->valid ? N_PARTS : 0, error);
}

/* True if a rectangle is not empty and lies within the frame. */
static bool fits(const Header *h, const FlSynthState *state)
{
    const int width = state->width, height = state->height;
    return h->x >= 0 && h->y >= 0 && h->width >= 1 && h->height >= 1 && h->width <= width &&
           h->height <= height && h->x <= width - h->width && h->y <= height - h->height;
}

/* The field, mask and picture of the last frame. */
static bool unpack_frame(FlSynthState *state, GBytes *bytes, const FlExemplarLevel *level,
                         GError **error)
{
    FlSpan parts[N_PARTS];
    if (!make_room(state, error))
        return false;
    parts_of(state, state->nnf.match, parts);
    if (!fl_state_bytes_parts(bytes, sizeof(Header), parts, N_PARTS, error))
        return false;
    add_up(&state->nnf);
    return fl_nnf_fits(&state->nnf, level) ||
           fl_state_bytes_damaged("its field points outside the style", error);
}

bool fl_synth_state_unpack(FlSynthState *state, GBytes *bytes, const FlExemplarLevel *level,
                           GError **error)
{
    Header h;
    fl_synth_state_clear(state);
    if (!fl_state_bytes_header(bytes, &h, sizeof h, error))
        return false;
    if (h.frame < 0 || (h.valid != 0 && h.valid != 1) || (h.dries != 0 && h.dries != 1))
        return fl_state_bytes_damaged("it does not start as a state does", error);
    if (h.valid && !fits(&h, state))
        return fl_state_bytes_damaged("its field lies outside the frame", error);
    state->frame = h.frame;
    state->dries = h.dries;
    state->rect = (FlRect){h.x, h.y, h.width, h.height};
    if (h.valid && !unpack_frame(state, bytes, level, error)) {
        fl_synth_state_clear(state);
        return false;
    }
    state->valid = h.valid;
    return true;
}
