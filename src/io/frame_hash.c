/* A list of the frames' SHA-256 sums: of pixels, so that no encoder matters. */
#include "io/atomic_file.h"
#include "io/formats.h"

#include <string.h>

typedef struct HashState {
    FlAtomicFile file;
} HashState;

static bool hash_open(FlSink *sink, GError **error)
{
    HashState *state = g_new0(HashState, 1);
    sink->state = state;
    return fl_atomic_open(&state->file, sink->params.path, sink->params.overwrite, error);
}

static bool hash_frame(FlSink *sink, const FlSinkFrame *frame, GError **error)
{
    HashState *state = sink->state;
    const size_t bytes = (size_t)sink->params.width * (size_t)sink->params.height * 4;
    g_autofree char *sum = g_compute_checksum_for_data(G_CHECKSUM_SHA256, frame->rgba, bytes);
    fprintf(state->file.stream, "%s  %d\n", sum, frame->number);
    return true; // fl_atomic_commit() reports write errors
}

static bool hash_finish(FlSink *sink, GError **error)
{
    HashState *state = sink->state;
    return fl_atomic_commit(&state->file, error);
}

static void hash_clear(FlSink *sink)
{
    HashState *state = sink->state;
    if (state)
        fl_atomic_clear(&state->file);
    g_clear_pointer(&sink->state, g_free);
}

const FlSinkFormat fl_sink_hash = {
    .name = "hash",
    .suffix = ".sha256",
    .help = "a list of the frames' SHA-256 sums",
    .film = true,
    .open = hash_open,
    .frame = hash_frame,
    .finish = hash_finish,
    .clear = hash_clear,
};
