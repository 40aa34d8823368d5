#include "synth/rotation.h"

#include <glib.h>
#include <math.h>

/* Far pixels differ most between patches, so the sum of a bad candidate stops early; opposite
 * pixels are neighbours, so that half a turn swaps them. */
const int8_t fl_patch_offsets[FL_PATCH_PIXELS][2] = {
    {-2, -2}, {2, 2},  {2, -2}, {-2, 2}, {0, -2}, {0, 2}, {-2, 0},  {2, 0},   {-1, -2},
    {1, 2},   {2, -1}, {-2, 1}, {1, -2}, {-1, 2}, {2, 1}, {-2, -1}, {-1, -1}, {1, 1},
    {1, -1},  {-1, 1}, {0, -1}, {0, 1},  {-1, 0}, {1, 0}, {0, 0},
};

static int16_t turns[FL_ANGLES][2];
const int16_t (*fl_turns)[2] = turns;

static FlOffset child_moves[2][FL_ANGLES][2];
const FlOffset (*fl_child_moves)[FL_ANGLES][2] = child_moves;

/* The middle of a coarse pixel p is 2 p + 1/2 on the finer level; the middle of its child q is
 * R(-theta)(q mod 2 - 1/2) away. Twice that offset is rotated, then halved. */
static void fill_child_moves(void)
{
    for (int a = 0; a < FL_ANGLES; a++)
        for (int k = 0; k < 4; k++)
            child_moves[k / 2][a][k % 2] = fl_child_move(turns[a], k % 2, k / 2);
}

void fl_rotation_init(void)
{
    static gsize once;
    if (!g_once_init_enter(&once))
        return;
    for (int a = 0; a < FL_ANGLES; a++) {
        turns[a][0] = (int16_t)lrint(16384 * cos(a * (2 * G_PI / FL_ANGLES)));
        turns[a][1] = (int16_t)lrint(16384 * sin(a * (2 * G_PI / FL_ANGLES)));
    }
    fill_child_moves();
    g_once_init_leave(&once, 1);
}
