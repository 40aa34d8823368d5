#include "synth/vote_kernel.h"

#include <stdlib.h>

static bool is_near(uint16_t a, uint16_t b)
{
    return abs((int16_t)(uint16_t)(a - b)) < FL_SAME_PLACE;
}

static void join(const FlVotes *votes, int k, FlVoteCluster *cluster)
{
    cluster->sum_x += votes->x[k] - cluster->x;
    cluster->sum_y += votes->y[k] - cluster->y;
    cluster->votes |= 1u << k;
}

static int cluster_votes_c(const FlVotes *votes, FlVoteCluster *clusters)
{
    int n = 0;
    uint32_t left = 0;
    for (int k = 0; k < FL_PATCH_PIXELS; k++)
        left |= (uint32_t)(votes->frame[k] >= 0) << k;
    while (left) {
        const int leader = fl_vote_leader(left);
        FlVoteCluster *o = &clusters[n++];
        *o = (FlVoteCluster){
            .x = votes->x[leader], .y = votes->y[leader], .frame = votes->frame[leader]};
        for (int k = 0; k < FL_PATCH_PIXELS; k++)
            if (left >> k & 1 && votes->frame[k] == o->frame &&
                is_near(votes->x[k], votes->x[leader]) && is_near(votes->y[k], votes->y[leader])) {
                join(votes, k, o);
                left &= ~(1u << k);
            }
    }
    return n;
}

#define COLUMN_X(dx)                                                                               \
    {dx, 2}, {dx, 1}, {dx, 0}, {dx, -1},                                                           \
    {                                                                                              \
        dx, -2                                                                                     \
    }
#define COLUMN_Y(dx)                                                                               \
    {2, -(dx)}, {1, -(dx)}, {0, -(dx)}, {-1, -(dx)},                                               \
    {                                                                                              \
        -2, -(dx)                                                                                  \
    }
_Alignas(64) const int16_t fl_vote_steps[2][FL_VOTES][2] = {
    {COLUMN_X(2), COLUMN_X(1), COLUMN_X(0), COLUMN_X(-1), COLUMN_X(-2)},
    {COLUMN_Y(2), COLUMN_Y(1), COLUMN_Y(0), COLUMN_Y(-1), COLUMN_Y(-2)}};

bool fl_vote_c(const FlVoteMatches *covering, const FlVoteSource *voted, float colour[4])
{
    return fl_vote_of(covering, cluster_votes_c, fl_spline_sample_c, voted, colour);
}

bool fl_vote_doubled_c(const FlVoteMatches *covering, const FlVoteSource *voted, float colour[4][4])
{
    return fl_vote_doubled_of(covering, cluster_votes_c, fl_spline_sample_c, voted, colour);
}
