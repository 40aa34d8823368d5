#include "worker/hand_line.h"

#include <stddef.h>

static const FlLineKind kinds[] = {
    // Ink from a nib: dark and sharp, a little thinner where the hand is fast.
    [FL_LINE_PEN] = {.play = .30f,
                     .wave = 9,
                     .rough = .08f,
                     .rough_wave = 1.6f,
                     .load = 1.16f,
                     .load_play = .24f,
                     .load_wave = 13,
                     .grain = .08f,
                     .grain_px = 2.4f,
                     .streak = 1,
                     .tooth = .06f,
                     .taper = 3,
                     .tip = .35f,
                     .opacity = 1},
    // Graphite: catches on the paper, greyer where the hand is light, with soft sides.
    [FL_LINE_PENCIL] = {.play = .18f,
                        .wave = 11,
                        .rough = .16f,
                        .rough_wave = 1.1f,
                        .load = .98f,
                        .load_play = .30f,
                        .load_wave = 7,
                        .soft = .30f,
                        .grain = .14f,
                        .grain_px = 1.9f,
                        .streak = 1,
                        .tooth = .11f,
                        .taper = 2.5f,
                        .tip = .5f,
                        .opacity = .92f},
    // A pointed brush: swells and thins, ends in points, and streaks where it runs dry.
    [FL_LINE_BRUSH] = {.play = .50f,
                       .wave = 12,
                       .rough = .12f,
                       .rough_wave = 2.5f,
                       .load = 1.25f,
                       .load_play = .55f,
                       .load_wave = 16,
                       .soft = .15f,
                       .grain = .30f,
                       .grain_px = 2.6f,
                       .streak = 9,
                       .tooth = .12f,
                       .taper = 5,
                       .tip = .12f,
                       .opacity = .97f},
};

const FlLineKind *fl_line_kind(FlLine line)
{
    return line == FL_LINE_PLAIN ? NULL : &kinds[line];
}
