/* The colours that votes give, by a version's own clustering and sampling, which are inlined. */
#pragma once

#include "synth/kernels.h"

#include <glib.h>

/**
 * Clusters votes: the first remaining vote, row by row, leads; all remaining ones in its frame and
 * near it join. clusters: FL_PATCH_PIXELS. Returns their number.
 */
typedef int (*FlClusterVotes)(const FlVotes *votes, FlVoteCluster *clusters);

/* The place along an axis to which a match moves a vote. */
static inline uint16_t moved(uint16_t match, const int16_t turn[2], const int16_t step[2])
{
    return (uint16_t)(match + ((turn[0] * step[0] + turn[1] * step[1] + (1 << 9)) >> 10));
}

/* The votes of the patches over a pixel; those beyond FL_PATCH_PIXELS do not count. */
static inline void find_places(const FlVoteMatches *covering, FlVotes *votes)
{
    for (int k = 0; k < FL_VOTES; k++) {
        votes->x[k] = moved(covering->x[k], covering->turn[k], fl_vote_steps[0][k]);
        votes->y[k] = moved(covering->y[k], covering->turn[k], fl_vote_steps[1][k]);
        votes->frame[k] = covering->frame[k];
    }
}

/* The mean of first + sum / n over the n votes, half away from first. */
static inline int mean_of(int first, int sum, uint32_t votes)
{
    const int n = __builtin_popcount(votes);
    return first - FL_VOTE_BIAS + (sum + (sum < 0 ? -n : n) / 2) / n;
}

/* The weighted sum of the colours of clusters. */
typedef struct Sum {
    float value[4], weight;
} Sum;

/* Adds the colour of a cluster of n votes, whose place may lie beyond the borders. */
static inline void add_cluster(Sum *sum, const FlVoteCluster *cluster, int n, int x, int y,
                               FlSplineSample sample, const FlVoteSource *voted)
{
    float value[4];
    x = CLAMP(x, 0, voted->most[0]), y = CLAMP(y, 0, voted->most[1]);
    sample(voted->colour + (size_t)cluster->frame * voted->frame_pixels +
               (size_t)(y >> 4) * voted->pitch + (x >> 4),
           voted->pitch, fl_spline_phases[x & 15].x, fl_spline_phases[y & 15].y, value);
    for (int c = 0; c < 4; c++)
        sum->value[c] += voted->weight[n] * value[c];
    sum->weight += voted->weight[n];
}

static inline void colour_of(const Sum *sum, float colour[4])
{
    for (int c = 0; c < 4; c++)
        colour[c] = CLAMP(sum->value[c] / sum->weight, 0.0f, 1.0f);
}

/** The colour that votes give. */
static inline bool fl_vote_of(const FlVoteMatches *covering, FlClusterVotes cluster_votes,
                              FlSplineSample sample, const FlVoteSource *voted, float colour[4])
{
    FlVotes votes;
    FlVoteCluster clusters[FL_PATCH_PIXELS];
    Sum sum = {0};
    find_places(covering, &votes);
    const int n = cluster_votes(&votes, clusters);
    for (const FlVoteCluster *o = clusters; o < clusters + n; o++)
        add_cluster(&sum, o, __builtin_popcount(o->votes), mean_of(o->x, o->sum_x, o->votes),
                    mean_of(o->y, o->sum_y, o->votes), sample, voted);
    colour_of(&sum, colour);
    return n > 0;
}

static inline void add_children(Sum sum[4], const FlVoteCluster *cluster, const int16_t turn[2],
                                FlSplineSample sample, const FlVoteSource *voted)
{
    const int n = __builtin_popcount(cluster->votes);
    const int x = mean_of(cluster->x, cluster->sum_x, cluster->votes);
    const int y = mean_of(cluster->y, cluster->sum_y, cluster->votes);
    for (int child = 0; child < 4; child++) {
        const FlOffset move = fl_child_move(turn, child % 2, child / 2);
        add_cluster(&sum[child], cluster, n, x + move.x, y + move.y, sample, voted);
    }
}

/** Likewise for FlVoteDoubled. */
static inline bool fl_vote_doubled_of(const FlVoteMatches *covering, FlClusterVotes cluster_votes,
                                      FlSplineSample sample, const FlVoteSource *voted,
                                      float colour[4][4])
{
    FlVotes votes;
    FlVoteCluster clusters[FL_PATCH_PIXELS];
    Sum sum[4] = {0};
    find_places(covering, &votes);
    for (int k = 0; k < FL_PATCH_PIXELS; k++) {
        votes.x[k] = (uint16_t)(2 * votes.x[k] - FL_VOTE_BIAS);
        votes.y[k] = (uint16_t)(2 * votes.y[k] - FL_VOTE_BIAS);
    }
    const int n = cluster_votes(&votes, clusters);
    for (const FlVoteCluster *o = clusters; o < clusters + n; o++)
        add_children(sum, o, covering->turn[fl_vote_leader(o->votes)], sample, voted);
    for (int child = 0; child < 4; child++)
        colour_of(&sum[child], colour[child]);
    return n > 0;
}
