/* The record of an earlier render, behind its seal, and a region's field. */
#include "base/compress.h"
#include "fuzz.h"
#include "keep/record.h"
#include "synth/synth_state.h"
#include <string.h>

static void check_record(const uint8_t *data, size_t size)
{
    g_autoptr(GBytes) bytes = g_bytes_new(data, size);
    g_autoptr(FlRecord) record = fl_record_parse(bytes);
    if (!record)
        return;
    g_assert_cmpint(record->done, >=, 0);
    g_autofree char *same = fl_facts_difference(record->facts, record->facts);
    g_assert_null(same);
}

#define SIDE 16 // of the frames of a region's state

static void check_past(GBytes *bytes)
{
    const FlExemplarLevel level = {.width = 40, .height = 30, .n_frames = 5};
    g_autoptr(GError) error = NULL;
    FlSynthState state = {
        .width = SIDE, .height = SIDE, .painted_width = SIDE, .painted_height = SIDE};
    const bool read = fl_synth_state_unpack(&state, bytes, &level, &error);
    g_assert_true(read == (error == NULL));
    for (int p = 0; p < state.nnf.width * state.nnf.height && read && state.valid; p++)
        g_assert_cmpint(state.nnf.match[p].frame, <, level.n_frames);
    fl_synth_state_clear(&state);
}

/* The bytes as they are, and with all behind the header packed as a state's are. */
static void check_pasts(const uint8_t *data, size_t size)
{
    const size_t header = MIN(size, FL_SYNTH_STATE_HEADER);
    const FlSpan part = {(void *)(uintptr_t)(data + header), size - header};
    g_autoptr(GBytes) plain = g_bytes_new(data, size);
    g_autoptr(GBytes) whole = fl_pack(data, header, &part, 1, NULL);
    check_past(plain);
    check_past(whole);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    check_record(data, size);
    check_pasts(data, size);
    return 0;
}
