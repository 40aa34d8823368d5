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

static int offset_along(const int16_t turn[2], const int16_t step[2])
{
    return (turn[0] * step[0] + turn[1] * step[1] + (1 << 9)) >> 10;
}

static void find_places(const FlVoteMatches *covering, FlVotes *votes)
{
    for (int k = 0; k < FL_PATCH_PIXELS; k++) {
        const int16_t *turn = covering->turn[k];
        votes->x[k] = (uint16_t)(covering->x[k] + offset_along(turn, fl_vote_steps[0][k]));
        votes->y[k] = (uint16_t)(covering->y[k] + offset_along(turn, fl_vote_steps[1][k]));
        votes->frame[k] = covering->frame[k];
    }
}

bool fl_vote_c(const FlVoteMatches *covering, const FlVoteSource *voted, float colour[4])
{
    FlVotes votes;
    find_places(covering, &votes);
    return fl_vote_of(&votes, cluster_votes_c, fl_spline_sample_c, voted, colour);
}

bool fl_vote_doubled_c(const FlVoteMatches *covering, const FlVoteSource *voted, float colour[4][4])
{
    FlVotes votes;
    find_places(covering, &votes);
    return fl_vote_doubled_of(&votes, covering->turn, cluster_votes_c, fl_spline_sample_c, voted,
                              colour);
}
