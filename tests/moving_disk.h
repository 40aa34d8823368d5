/* A disk of ink that moves, for the tests of transport. */
#ifndef FLUIDY_TESTS_MOVING_DISK_H
#define FLUIDY_TESTS_MOVING_DISK_H

#include "transport/carried_ink.h"

#include <math.h>

#define SIDE 120
#define PIXELS ((size_t)SIDE * SIDE)

/* A tile of waves 24 px long that move ink by up to 4 px. */
static inline FlTile *waves(void)
{
    FlTile *tile = g_new0(FlTile, 1);
    tile->style = (FlTransportStyle){.size = 96, .taper_px = 5, .pace = 1, .effort = 1};
    tile->spline = g_new(float, 96 * 96);
    for (int i = 0; i < 96 * 96; i++)
        tile->spline[i] = 15 * sinf((float)(i % 96) * 0.2618f) * cosf((float)(i / 96) * 0.1309f);
    return tile;
}

/* A disk of radius 40 at (x, 60), which has moved by `motion` px to the right. */
static inline void draw_disk(FlGuides *guides, float x0, float motion)
{
    guides->has_motion = true;
    for (size_t p = 0; p < PIXELS; p++) {
        const float x = (float)(p % SIDE), y = (float)(p / SIDE);
        guides->distance[p] = 40 - hypotf(x - x0, y - 60);
        guides->mask[p] = (uint8_t)(255 * fminf(fmaxf(guides->distance[p] + 0.5f, 0), 1) + 0.5f);
        guides->motion[2 * p] =
            guides->mask[p] ? (int32_t)(motion * FL_MOTION_ONE) : FL_MOTION_UNKNOWN;
        guides->motion[2 * p + 1] = guides->mask[p] ? 0 : FL_MOTION_UNKNOWN;
    }
}

static inline FlCarriedInk *ink_of(const FlTile *tile, const double *strength)
{
    const FlCarriedInkInput input = {.tile = tile,
                                     .width = SIDE,
                                     .height = SIDE,
                                     .scale = 1,
                                     .strength = strength,
                                     .seed = 3,
                                     .colour = {{250, 240, 230}, {60000, 50000, 40000}}};
    return fl_carried_ink_new(&input, NULL);
}

typedef struct Disk {
    FlTile *tile;
    FlCarriedInk *ink;
    FlGuides guides;
    double strength;
    float amount[PIXELS];
    uint8_t rgb[3 * PIXELS];
} Disk;

static inline Disk *disk_new(double strength)
{
    Disk *disk = g_new0(Disk, 1);
    disk->tile = waves();
    disk->strength = strength;
    disk->ink = ink_of(disk->tile, &disk->strength);
    g_assert_true(fl_guides_init(&disk->guides, SIDE, SIDE, NULL));
    return disk;
}

static inline void disk_free(Disk *disk)
{
    fl_carried_ink_free(disk->ink);
    fl_tile_free(disk->tile);
    fl_guides_clear(&disk->guides);
    g_free(disk);
}

static inline void disk_frame(Disk *disk, float x, float motion)
{
    draw_disk(&disk->guides, x, motion);
    g_assert_true(fl_carried_ink_amounts(disk->ink, &disk->guides, disk->amount, NULL));
}

static inline double mean_of(const Disk *disk, double *deviation)
{
    double n = 0, sum = 0, squares = 0;
    for (size_t p = 0; p < PIXELS; p++) {
        const double c = disk->guides.mask[p], d = disk->amount[p];
        n += c, sum += c * d, squares += c * d * d;
    }
    *deviation = sqrt(squares / n - sum / n * sum / n);
    return sum / n;
}

/* What a shape does from frame to frame. */
typedef struct Motion {
    const char *name;
    float shift, turn, growth; // px, radians and a factor of its size
    float flicker;             // its bound
} Motion;

/* The frame before's place of a pixel of a frame; a disk's radius is that of the frame. */
static inline void place_before(const Motion *m, double x0, size_t p, double place[2])
{
    const double x = (double)(p % SIDE) - x0, y = (double)(p / SIDE) - 60;
    const double c = cos((double)m->turn), s = sin((double)m->turn);
    place[0] = (c * x + s * y) / (double)m->growth + x0 - (double)m->shift;
    place[1] = (c * y - s * x) / (double)m->growth + 60;
}

/* A frame of a disk at x0 that has come there by the motion. */
static inline void draw_moved(FlGuides *guides, const Motion *m, double x0, double radius)
{
    draw_disk(guides, (float)x0, 0);
    for (size_t p = 0; p < PIXELS; p++) {
        double place[2];
        guides->distance[p] += (float)(radius - 40);
        guides->mask[p] = (uint8_t)(255 * fminf(fmaxf(guides->distance[p] + 0.5f, 0), 1) + 0.5f);
        place_before(m, x0, p, place);
        const double motion[2] = {(double)(p % SIDE) - place[0], (double)(p / SIDE) - place[1]};
        for (size_t c = 0; c < 2; c++)
            guides->motion[2 * p + c] =
                guides->mask[p] ? (int32_t)lround(motion[c] * FL_MOTION_ONE) : FL_MOTION_UNKNOWN;
    }
}

#endif
