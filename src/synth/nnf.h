/* Nearest-neighbour field: which rotated exemplar patch explains each target patch. */
#pragma once

#include "synth/target.h"

/** The field of one target level: row-major, width * height. */
typedef struct FlNnf {
    int width, height;
    FlMatch *match;
} FlNnf;

bool fl_nnf_init(FlNnf *nnf, int width, int height, GError **error); // without any match
void fl_nnf_clear(FlNnf *nnf);

static inline int fl_match_x(FlMatch m)
{
    return (m.x_16 + 8) >> 4;
}

static inline int fl_match_y(FlMatch m)
{
    return (m.y_16 + 8) >> 4;
}

/** True if all matches lie in a level; use it to check fields that are loaded. */
bool fl_nnf_fits(const FlNnf *nnf, const FlExemplarLevel *level);

/** A match moved by a target offset, as if both pixels had the same transformation; may be
 * FL_NO_MATCH. */
static inline FlMatch fl_match_moved(FlMatch m, int dx, int dy, const FlExemplarLevel *level)
{
    int sx, sy;
    fl_unrotate(m.theta, dx, dy, &sx, &sy);
    const int x = m.x_16 + sx, y = m.y_16 + sy;
    if (x < 0 || y < 0 || x > 16 * (level->width - 1) || y > 16 * (level->height - 1))
        return (FlMatch){.frame = FL_NO_MATCH};
    m.x_16 = (uint16_t)x, m.y_16 = (uint16_t)y, m.off = 0;
    return m;
}

/**
 * Makes a field valid for a level: each match whose centre is outside its segment goes to the
 * nearest valid pixel of its frame (within 12 px), else to a random one. Missing matches become
 * random ones. Beside the target's blocks there must be no matches.
 */
void fl_nnf_repair(FlNnf *nnf, const FlExemplarLevel *level, const FlTargetLevel *target,
                   bool rotate, uint64_t key);

/** The field of the next finer level [F21 §3.6, fig. 6] in some blocks; pixels without a parent get
 * no match. */
void fl_nnf_upscale(const FlNnf *coarse, const FlExemplarLevel *fine_level, const FlBlocks *blocks,
                    FlNnf *fine);

/** Converts the match of a pixel of level l to level 0, at the nearest possible place. */
FlMatch fl_match_enlarged(FlMatch match, int l, const FlExemplarLevel *full);

/**
 * The level-0 field at a coarser level: the mode of the inversely transformed matches in each
 * window of 2^l pixels [F21 §3.6, fig. 7]; FL_NO_MATCH for a window without matches.
 */
void fl_nnf_downscale(const FlNnf *full, int l, const FlExemplarLevel *level, FlNnf *coarse);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlNnf, fl_nnf_clear)
