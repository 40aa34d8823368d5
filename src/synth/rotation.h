/* Angles of 256 steps a turn, and the patch offsets rotated by them. */
#pragma once

#include <stdint.h>

#define FL_PATCH 5 // n, the patch's side in pixels [F21 table 1]
#define FL_PATCH_RADIUS (FL_PATCH / 2)
#define FL_PATCH_PIXELS (FL_PATCH * FL_PATCH)

/*
 * A step is 1.4 degrees, so the farthest pixel of a patch (2.83 px out) is misplaced by at most
 * 0.035 px: a twentieth of what nearest sampling allows anyway.
 */
#define FL_ANGLES 256

/** Cosine and sine in 1/16384, for every angle: [angle][0] is the cosine. */
extern const int16_t (*fl_turns)[2];

/** Patch offsets in the order in which the distance sums them: outer ring first, in opposite
 * pairs, the centre last. */
extern const int8_t fl_patch_offsets[FL_PATCH_PIXELS][2];

/** An offset in 1/16 source pixels. */
typedef struct FlOffset {
    int16_t x, y;
} FlOffset;

/**
 * The offset from twice a match's place to the place of a child pixel's match, in 1/16 px of the
 * next finer level, -8 … 24: fl_child_moves[row & 1][theta][column & 1].
 */
extern const FlOffset (*fl_child_moves)[FL_ANGLES][2];

/** Fills the tables; harmless to call again. To be called before the other modules run. */
void fl_rotation_init(void);

/** R(-theta) applied to a target offset in pixels, theta by its row of fl_turns; the result is in
 * 1/16 source pixels. */
static inline void fl_turn_back(const int16_t turn[2], int dx, int dy, int *sx_16, int *sy_16)
{
    const int c = turn[0], s = turn[1];
    *sx_16 = (c * dx + s * dy + (1 << 9)) >> 10;
    *sy_16 = (-s * dx + c * dy + (1 << 9)) >> 10;
}

/** The same for an angle. */
static inline void fl_unrotate(uint8_t theta, int dx, int dy, int *sx_16, int *sy_16)
{
    fl_turn_back(fl_turns[theta], dx, dy, sx_16, sy_16);
}

/** Computes an entry of fl_child_moves. turn: the angle's row of fl_turns. */
static inline FlOffset fl_child_move(const int16_t turn[2], int column, int row)
{
    int dx, dy;
    fl_turn_back(turn, 2 * column - 1, 2 * row - 1, &dx, &dy);
    return (FlOffset){(int16_t)(8 + dx / 2), (int16_t)(8 + dy / 2)};
}

/** The distance between an angle and 0, in steps: 0 … 128. */
static inline int fl_angle_distance(uint8_t angle)
{
    return angle < 128 ? angle : 256 - angle;
}
