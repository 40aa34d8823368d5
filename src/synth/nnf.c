#include "synth/nnf.h"

#include "base/alloc.h"
#include "base/rng.h"

bool fl_nnf_init(FlNnf *nnf, int width, int height, GError **error)
{
    *nnf = (FlNnf){.width = width, .height = height};
    nnf->match = fl_alloc_unset((size_t)width * height, sizeof(FlMatch), "a field", error);
    if (!nnf->match)
        return false;
    for (size_t p = 0; p < (size_t)width * height; p++)
        nnf->match[p] = (FlMatch){.frame = FL_NO_MATCH};
    return true;
}

void fl_nnf_clear(FlNnf *nnf)
{
    free(nnf->match);
    *nnf = (FlNnf){0};
}

bool fl_nnf_fits(const FlNnf *nnf, const FlExemplarLevel *level)
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

/** A random patch of the segment, turned into the target's direction; key decides. */
static FlMatch random_match(const FlExemplarLevel *level, FlSegment segment, uint8_t target_angle,
                            bool rotate, uint64_t key)
{
    const FlSegment s = level->n_valid[segment] > 0 ? segment : FL_SEGMENT_BORDER;
    FlRng rng = {key};
    if (level->n_valid[s] == 0) // little paint may vanish on a coarse level
        return (FlMatch){.x_16 = (uint16_t)(16 * (level->width / 2)),
                         .y_16 = (uint16_t)(16 * (level->height / 2)),
                         .frame = (int16_t)level->first};
    const uint32_t n = (uint32_t)MIN(level->n_valid[s], UINT32_MAX);
    const uint32_t pixel = level->valid[s][fl_rng_below(&rng, n)];
    const int x = (int)(pixel % level->width), y = (int)(pixel / level->width % level->height);
    const int t = (int)(pixel / level->width / level->height);
    const int source_angle = fl_exemplar_at(level, x, y, t)->c[FL_CH_ANGLE];
    const uint8_t half_turn = fl_rng_below(&rng, 2) ? 128 : 0;
    return (FlMatch){.x_16 = (uint16_t)(16 * x),
                     .y_16 = (uint16_t)(16 * y),
                     .frame = (int16_t)t,
                     .theta = rotate ? (uint8_t)(target_angle - source_angle + half_turn) : 0};
}

static bool is_valid(const FlExemplarLevel *level, int x, int y, int t, FlSegment segment)
{
    return x >= 0 && y >= 0 && x < level->width && y < level->height &&
           fl_exemplar_at(level, x, y, t)->c[FL_CH_SEGMENT] == segment;
}

#define REPAIR_RADIUS 12

/* Nearest valid pixel, ring by ring; of equally near rings the first found. */
static bool nearest_valid(const FlExemplarLevel *level, FlMatch *m, FlSegment segment)
{
    const int x = fl_match_x(*m), y = fl_match_y(*m);
    int best = INT32_MAX, best_x = 0, best_y = 0;
    for (int r = 1; r <= REPAIR_RADIUS && best > (r - 1) * (r - 1); r++)
        for (int k = -r; k <= r; k++) {
            const int ring[4][2] = {{k, -r}, {k, r}, {-r, k}, {r, k}};
            for (int side = 0; side < 4; side++) {
                const int dx = ring[side][0], dy = ring[side][1];
                if (dx * dx + dy * dy < best && is_valid(level, x + dx, y + dy, m->frame, segment))
                    best = dx * dx + dy * dy, best_x = x + dx, best_y = y + dy;
            }
        }
    if (best == INT32_MAX)
        return false;
    m->x_16 = (uint16_t)(16 * best_x), m->y_16 = (uint16_t)(16 * best_y);
    return true;
}

/* Makes the match of pixel p valid; key decides where it is random. */
static void repair(FlMatch *m, const FlExemplarLevel *level, const FlTargetLevel *target, size_t p,
                   bool rotate, uint64_t key)
{
    const FlSegment segment = target->segment[p];
    if (segment == FL_SEGMENT_OUTSIDE)
        m->frame = FL_NO_MATCH;
    else if (m->frame == FL_NO_MATCH ||
             (!is_valid(level, fl_match_x(*m), fl_match_y(*m), m->frame, segment) &&
              !nearest_valid(level, m, segment)))
        *m = random_match(level, segment, target->angle[p], rotate, fl_key(key, p));
}

void fl_nnf_repair(FlNnf *nnf, const FlExemplarLevel *level, const FlTargetLevel *target,
                   bool rotate, uint64_t key)
{
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = 0; k < target->blocks.n; k++) {
        const FlRect block = target->blocks.block[k];
        for (int y = block.y; y < block.y + block.height; y++)
            for (int x = block.x; x < block.x + block.width; x++) {
                const size_t p = (size_t)y * (size_t)nnf->width + (size_t)x;
                repair(&nnf->match[p], level, target, p, rotate, key);
            }
    }
}

static uint16_t clamp_16(int v, int size)
{
    return (uint16_t)CLAMP(v, 0, 16 * (size - 1));
}

/* A row of n matches, two for each coarse one: each place is doubled and moved as in
 * fl_child_moves, but stays from 0 to `most`. */
static void upscale_row(const FlMatch *coarse, const FlOffset (*moves)[2], const uint16_t most[2],
                        FlMatch *fine, int n)
{
    for (int i = 0; i < n; i++) {
        FlMatch m = coarse[i / 2];
        const FlOffset move = moves[m.theta][i % 2];
        m.x_16 = (uint16_t)CLAMP(2 * m.x_16 + move.x, 0, most[0]);
        m.y_16 = (uint16_t)CLAMP(2 * m.y_16 + move.y, 0, most[1]);
        fine[i] = m;
    }
}

void fl_nnf_upscale(const FlNnf *coarse, const FlExemplarLevel *fine_level, const FlBlocks *blocks,
                    FlNnf *fine)
{
    const uint16_t most[2] = {(uint16_t)(16 * (fine_level->width - 1)),
                              (uint16_t)(16 * (fine_level->height - 1))};
#pragma omp parallel for schedule(static)
    for (int k = 0; k < blocks->n; k++) {
        const FlRect block = blocks->block[k];
        for (int y = block.y; y < block.y + block.height; y++)
            upscale_row(
                coarse->match + (size_t)(y / 2) * (size_t)coarse->width + (size_t)(block.x / 2),
                fl_child_moves[y & 1], most,
                fine->match + (size_t)y * (size_t)fine->width + (size_t)block.x, block.width);
    }
}

/* The inverse of l upscalings for the match of full-size pixel (x, y). */
static FlMatch scaled_down(FlMatch m, int x, int y, int l, const FlExemplarLevel *level)
{
    const int half = (1 << l) - 1; // the window's centre, in half pixels from its corner
    int dx, dy;
    fl_unrotate(m.theta, 2 * (x & half) - half, 2 * (y & half) - half, &dx, &dy);
    // full = 2^l coarse + (2^l - 1)/2 + R(-theta) offset, all in 1/16
    const int cx = (m.x_16 - 8 * half - dx / 2) >> l, cy = (m.y_16 - 8 * half - dy / 2) >> l;
    m.x_16 = clamp_16(cx, level->width), m.y_16 = clamp_16(cy, level->height), m.off = 0;
    return m;
}

FlMatch fl_match_enlarged(FlMatch m, int l, const FlExemplarLevel *full)
{
    const int half = (1 << l) - 1; // the centre of the pixel, in half pixels from its corner
    m.x_16 = clamp_16((m.x_16 << l) + 8 * half, full->width);
    m.y_16 = clamp_16((m.y_16 << l) + 8 * half, full->height);
    return m;
}

static uint64_t bin_of(FlMatch m)
{
    return (uint64_t)(uint16_t)m.frame << 40 | (uint64_t)(m.theta >> 3) << 32 |
           (uint64_t)fl_match_x(m) << 16 | (uint64_t)fl_match_y(m);
}

#define WINDOW 64 // matches sampled in a window; larger windows are sampled evenly

/* The most frequent bin's first match, in scan order. */
static FlMatch mode_of(const FlMatch *matches, int n)
{
    int best = 0, best_count = 0;
    uint64_t bins[WINDOW];
    for (int i = 0; i < n; i++)
        bins[i] = bin_of(matches[i]);
    for (int i = 0; i < n && best_count < n - i; i++) {
        int count = 0;
        for (int k = i; k < n; k++)
            count += bins[k] == bins[i];
        if (count > best_count)
            best_count = count, best = i;
    }
    return matches[best];
}

static FlMatch window_mode(const FlNnf *full, int qx, int qy, int l, const FlExemplarLevel *level)
{
    FlMatch sampled[WINDOW];
    int n = 0;
    const int side = 1 << l, step = MAX(1, side / 8);
    for (int y = qy * side + step / 2; y < MIN((qy + 1) * side, full->height); y += step)
        for (int x = qx * side + step / 2; x < MIN((qx + 1) * side, full->width); x += step) {
            const FlMatch m = full->match[(size_t)y * full->width + x];
            if (m.frame != FL_NO_MATCH)
                sampled[n++] = scaled_down(m, x, y, l, level);
        }
    return n > 0 ? mode_of(sampled, n) : (FlMatch){.frame = FL_NO_MATCH};
}

void fl_nnf_downscale(const FlNnf *full, int l, const FlExemplarLevel *level, FlNnf *coarse)
{
#pragma omp parallel for schedule(dynamic, 8)
    for (int y = 0; y < coarse->height; y++)
        for (int x = 0; x < coarse->width; x++)
            coarse->match[(size_t)y * coarse->width + x] = window_mode(full, x, y, l, level);
}
