#include "drawing/survey.h"

#include "svg/pose.h"
#include <math.h>
#include <string.h>

/* Cosines of turns in a frame: beyond the first a turn counts less, beyond the second it does not;
 * there an outline that begins at another node cannot be told from one that turns. */
#define SURE_TURN 0.85
#define MOST_TURN 0.6
#define NO_TURN 1e-9 // a turn that is this share of what it could be is rounding

#define LIMB 0.03      // of a region's area, at least
#define LIMB_PX 0.024  // side of a square as large as a limb, share of the page's longer side
#define STRAY_PX 0.004 // that a limb moves apart from its region, share of that side

#define STEADY 4 // in all but one of so many steps a leaf that keeps its nodes has as many

/* A leaf of a region. */
typedef struct Leaf {
    const FlSurveyPart *part; // last seen; NULL: not yet
    int frame;                // of that
    int steps, same;          // times it is seen again; of these with as many nodes
    bool shared;   // two leaves have its number, since regions were merged: the number is ambiguous
    double area;   // sum over the frames
    float largest; // of its areas so far
    bool limb;
    FlAnchor anchor; // of a limb
} Leaf;

/* Places of leaves before and after a step, weighted by area. */
typedef struct Means {
    double weight;
    FlPoint from, to; // sums
} Means;

/* The motion of a region's leaves into a frame. */
typedef struct Fit {
    Means all, steady; // steady: the leaves that tell of a turn
    FlPoint turn;  // of those the conjugates of `from` times `to`, with those of harmonics; x is
                   // real
    double most;   // that the turn could be
    FlPoint grown; // sum of the ways of edges at which paint is laid, weighted by area
} Fit;

/* A region that is followed. */
typedef struct Region {
    int first;        // index of its first leaf
    Fit fit;          // into the frame at hand
    Means means;      // as its first frame shows it
    double spread[3]; // of its shapes, each about its own middle: as in FlPose, times the weight
    bool begun;       // true after that frame
    bool limbs;       // true if some of its limbs move by themselves
} Region;

/* The follower of a film's regions. */
typedef struct Follower {
    int n_regions;
    float page[2]; // width and height
    Region *region;
    Leaf *leaf;
} Follower;

/* The conjugate of a, times b. */
static FlPoint conjugate_times(FlPoint a, FlPoint b)
{
    return (FlPoint){a.x * b.x + a.y * b.y, a.x * b.y - a.y * b.x};
}

static FlPoint times(FlPoint a, FlPoint b)
{
    return (FlPoint){a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x};
}

static void add(FlPoint *sum, double weight, FlPoint p)
{
    sum->x += weight * p.x, sum->y += weight * p.y;
}

static FlPoint middle_of(const FlSurveyPart *part, bool by_outline)
{
    if (by_outline)
        return (FlPoint){(double)part->pose.middle_x, (double)part->pose.middle_y};
    const float *box = part->box;
    return (FlPoint){((double)box[0] + (double)box[2]) / 2, ((double)box[1] + (double)box[3]) / 2};
}

static double weight_of(const FlSurveyPart *part)
{
    return (double)part->area_px + 1e-3; // something, of what is hidden as well
}

static void add_means(Means *means, double weight, FlPoint from, FlPoint to)
{
    means->weight += weight;
    add(&means->from, weight, from);
    add(&means->to, weight, to);
}

static FlPoint mean_of(const Means *means, FlPoint sum)
{
    return (FlPoint){sum.x / means->weight, sum.y / means->weight};
}

static void add_turn(Fit *fit, double weight, FlPoint from, FlPoint to)
{
    add(&fit->turn, weight, conjugate_times(from, to));
    fit->most += weight * (from.x * from.x + from.y * from.y + to.x * to.x + to.y * to.y);
}

#define HELD_PX 0.1 // of a side of a box that stays where it is
#define GROWN_PX 1  // of one that moves on
#define GROWS 0.016 // way of a growing edge in a frame, at most, share of the page's longer side
#define FOLLOWS 0.1 // share of it by which the mean way follows: strokes come one by one

/* True if a leaf has grown on one side, held the other, and not shrunk on any; page: its width and
 * height. False at the page's edges, which may cut the leaf off. */
static bool has_grown(const float before[4], const float now[4], const float page[2])
{
    bool grown = false, shrunk = false;
    for (int axis = 0; axis < 2; axis++) {
        const float low = before[axis] - now[axis], high = now[axis + 2] - before[axis + 2];
        const bool in_page = now[axis] > 1 && now[axis + 2] < page[axis] - 1;
        shrunk |= low < -HELD_PX || high < -HELD_PX || !in_page;
        grown |= fabsf(low) < HELD_PX && high > GROWN_PX;
        grown |= fabsf(high) < HELD_PX && low > GROWN_PX;
    }
    return grown && !shrunk;
}

/* True if an outline that begins where it began has more nodes than before, or fewer. */
static bool is_drawn_on(const FlPose *before, const FlPose *now)
{
    return before->n > 0 && now->n > 0 && before->n != now->n &&
           fabsf(now->start_x - before->start_x) < HELD_PX &&
           fabsf(now->start_y - before->start_y) < HELD_PX;
}

/* True if an outline has moved and turned, and kept its form: the box of a blade that turns grows
 * on one side and holds the other at some angles. */
static bool keeps_form(const FlPose *before, const FlPose *now)
{
    bool keeps = before->n > 2 && before->n == now->n;
    for (int h = 0; h < 2; h++)
        keeps = keeps && fabsf(hypotf(before->harmonic[h][0], before->harmonic[h][1]) -
                               hypotf(now->harmonic[h][0], now->harmonic[h][1])) < HELD_PX;
    return keeps;
}

/* Paint stays where it is in a leaf that is being built, or the reverse. */
static bool stays(const FlSurveyPart *before, const FlSurveyPart *now, const float page[2])
{
    if (keeps_form(&before->pose, &now->pose))
        return false;
    return is_drawn_on(&before->pose, &now->pose) || has_grown(before->box, now->box, page) ||
           has_grown(now->box, before->box, page);
}

/* True if a leaf has the same nodes in nearly all frames. If it is traced anew in each, as many
 * nodes are chance, and begin anywhere. */
static bool keeps_nodes(const Leaf *leaf)
{
    return STEADY * leaf->same >= (STEADY - 1) * leaf->steps;
}

static void add_leaf(Fit *fit, const Leaf *leaf, const FlSurveyPart *now, const float page[2])
{
    const FlSurveyPart *before = leaf->part;
    const FlPose *a = &before->pose, *b = &now->pose;
    const double weight = MIN(weight_of(before), weight_of(now));
    if (stays(before, now, page)) {
        const FlPoint from = middle_of(before, false), to = middle_of(now, false);
        add_means(&fit->all, weight, from, from);
        if (now->area_px <= leaf->largest)
            return; // it lays no paint where there was none
        const FlPoint way = {2 * (to.x - from.x), 2 * (to.y - from.y)}; // one side is held
        const double most = GROWS * (double)MAX(page[0], page[1]), length = hypot(way.x, way.y);
        add(&fit->grown, weight * MIN(1, most / MAX(length, 1e-6)), way);
        return;
    }
    if (!keeps_nodes(leaf) || a->n == 0 || a->n != b->n) {
        const bool known = a->n > 0 && b->n > 0;
        add_means(&fit->all, weight, middle_of(before, known), middle_of(now, known));
        return;
    }
    const FlPoint from = {(double)a->x, (double)a->y}, to = {(double)b->x, (double)b->y};
    add_means(&fit->all, weight, from, to);
    add_means(&fit->steady, weight, from, to);
    add_turn(fit, weight, from, to);
    for (int h = 0; h < 2; h++)
        add_turn(fit, weight, (FlPoint){(double)a->harmonic[h][0], (double)a->harmonic[h][1]},
                 (FlPoint){(double)b->harmonic[h][0], (double)b->harmonic[h][1]});
}

/* A number of length one. */
static FlPoint unit_of(FlPoint p)
{
    const double length = sqrt(p.x * p.x + p.y * p.y);
    return length > 1e-6 ? (FlPoint){p.x / length, p.y / length} : (FlPoint){1, 0};
}

/* The turn of a motion, as a number of length one. */
static FlPoint turn_of(const Fit *fit)
{
    const Means *steady = &fit->steady;
    if (steady->weight <= 0)
        return (FlPoint){1, 0};
    FlPoint turn = fit->turn;
    add(&turn, -steady->weight,
        conjugate_times(mean_of(steady, steady->from), mean_of(steady, steady->to)));
    if (fabs(turn.x) + fabs(turn.y) < NO_TURN * fit->most)
        return (FlPoint){1, 0};
    turn = unit_of(turn);
    const double share = CLAMP((turn.x - MOST_TURN) / (SURE_TURN - MOST_TURN), 0, 1);
    return unit_of((FlPoint){1 + share * (turn.x - 1), share * turn.y});
}

static float within(double px)
{
    return (float)CLAMP(px, (double)-FL_POSE_MOST_PX, (double)FL_POSE_MOST_PX);
}

static void move(FlAnchor *anchor, const Fit *fit)
{
    if (fit->all.weight <= 0) {
        anchor->grows_x = anchor->grows_y = 0;
        return;
    }
    const FlPoint from = mean_of(&fit->all, fit->all.from), to = mean_of(&fit->all, fit->all.to);
    const FlPoint turn = turn_of(fit);
    const FlPoint arm = {(double)anchor->x - from.x, (double)anchor->y - from.y};
    const FlPoint turned = times(turn, arm);
    const FlPoint axis =
        unit_of(times(turn, (FlPoint){(double)anchor->cosine, (double)anchor->sine}));
    anchor->x = within(to.x + turned.x), anchor->y = within(to.y + turned.y);
    anchor->cosine = (float)axis.x, anchor->sine = (float)axis.y;
    anchor->grows_x += (float)FOLLOWS * ((float)(fit->grown.x / fit->all.weight) - anchor->grows_x);
    anchor->grows_y += (float)FOLLOWS * ((float)(fit->grown.y / fit->all.weight) - anchor->grows_y);
}

static Leaf *leaf_of(const Follower *f, const FlSurveyPart *part)
{
    return &f->leaf[f->region[part->region].first + part->nth];
}

static void note_leaf(Follower *f, int t, const FlSurveyPart *part)
{
    Leaf *leaf = leaf_of(f, part);
    const bool known = !leaf->shared && leaf->part && leaf->frame == t - 1;
    if (known)
        add_leaf(&f->region[part->region].fit, leaf, part, f->page);
    if (known && leaf->limb) {
        Fit own = {{0}};
        add_leaf(&own, leaf, part, f->page);
        move(&leaf->anchor, &own);
    } else {
        leaf->anchor.cosine = leaf->anchor.sine = 0; // it begins
    }
    leaf->part = part, leaf->frame = t;
    leaf->largest = MAX(leaf->largest, part->area_px);
}

/* Finds out beforehand how steady a leaf is. */
static void count_leaf(Follower *f, int t, const FlSurveyPart *part)
{
    Leaf *leaf = leaf_of(f, part);
    leaf->shared |= leaf->part && leaf->frame == t;
    leaf->steps += leaf->part != NULL;
    leaf->same += leaf->part && leaf->part->pose.n == part->pose.n;
    leaf->area += (double)part->area_px;
    leaf->part = part, leaf->frame = t;
}

/* The largest leaves of a region are its limbs: tiny ones have no wash to carry. */
static void choose_limbs(Leaf *leaf, int n, double least)
{
    double all = 0;
    for (int k = 0; k < n; k++)
        all += leaf[k].area;
    for (int i = 0; n > 1 && i < FL_LIMBS; i++) {
        Leaf *largest = NULL;
        for (int k = 0; k < n; k++)
            if (!leaf[k].limb && !leaf[k].shared && (!largest || leaf[k].area > largest->area))
                largest = &leaf[k];
        if (!largest || largest->area < LIMB * all || largest->area < least * (largest->steps + 1))
            return;
        largest->limb = true;
    }
}

static void count_leaves(Follower *f, const FlSurvey *survey, int n_leaves)
{
    FL_EACH_PART (survey, t, part)
        if (part->region >= 0)
            count_leaf(f, t, part);
    for (int k = 0; k < n_leaves; k++)
        f->leaf[k].part = NULL;
    const double side = LIMB_PX * (double)MAX(f->page[0], f->page[1]);
    for (int r = 0; r < f->n_regions; r++) {
        const int first = f->region[r].first;
        const int end = r + 1 < f->n_regions ? f->region[r + 1].first : n_leaves;
        choose_limbs(f->leaf + first, end - first, side * side);
    }
}

static void add_beginning(Follower *f, const FlSurveyPart *part)
{
    const FlPoint middle = middle_of(part, part->pose.n > 0);
    const double weight = weight_of(part);
    Region *region = &f->region[part->region];
    if (region->begun)
        return;
    add_means(&region->means, weight, middle, middle);
    for (int k = 0; k < 3; k++)
        region->spread[k] += weight * (double)part->pose.spread[k];
}

#define LONG 1.35 // times as long as it is wide: such a shape has an axis

/* The direction in which the shapes of a region are longest, as a mean and not as they lie side by
 * side, degrees; NAN: hardly longer than wide. */
static float axis_of(const Region *region)
{
    const double xx = region->spread[0], yy = region->spread[1], xy = region->spread[2];
    const double apart = sqrt((xx - yy) * (xx - yy) + 4 * xy * xy);
    const double most = (xx + yy + apart) / 2, least = (xx + yy - apart) / 2;
    return most > LONG * LONG * MAX(least, 1e-6) ? (float)(90 / G_PI * atan2(2 * xy, xx - yy))
                                                 : NAN;
}

static void begin(Region *region, FlAnchor *anchor)
{
    if (region->begun || region->means.weight <= 0)
        return;
    const FlPoint middle = mean_of(&region->means, region->means.to);
    *anchor = (FlAnchor){
        .x = within(middle.x), .y = within(middle.y), .cosine = 1, .axis = axis_of(region)};
    anchor->rest_x = anchor->x, anchor->rest_y = anchor->y;
    region->begun = true;
}

/* The place of a point when its anchor was at rest. */
static FlPoint at_rest(const FlAnchor *anchor, FlPoint p)
{
    const FlPoint turn = {(double)anchor->cosine, (double)anchor->sine};
    const FlPoint arm = {p.x - (double)anchor->x, p.y - (double)anchor->y};
    const FlPoint back = conjugate_times(turn, arm);
    return (FlPoint){(double)anchor->rest_x + back.x, (double)anchor->rest_y + back.y};
}

void fl_anchor_rest_row(const FlAnchor *anchor, int x, int y, int step, int n, float scale,
                        float *rest_x, float *rest_y)
{
    const float c = anchor->cosine, s = anchor->sine, dy = (float)y - anchor->y;
    for (int i = 0; i < n; i++) {
        const float dx = (float)(x + i * step) - anchor->x;
        rest_x[i] = (anchor->rest_x + c * dx + s * dy) * scale;
        rest_y[i] = (anchor->rest_y + c * dy - s * dx) * scale;
    }
}

/* Gives a limb the anchor that it would have if it moved with its region. */
static void begin_limb(FlAnchor *limb, const FlAnchor *region, FlPoint middle)
{
    const FlPoint rest = at_rest(region, middle);
    *limb = *region;
    limb->x = within(middle.x), limb->y = within(middle.y);
    limb->rest_x = within(rest.x), limb->rest_y = within(rest.y);
}

/* Returns: true if a limb has moved from the place that its region's motion gives it. */
static bool strays(const FlAnchor *limb, const FlAnchor *region, const FlSurveyPart *part,
                   double least)
{
    const FlPoint rest = at_rest(region, (FlPoint){(double)limb->x, (double)limb->y});
    const double turned =
        fabs((double)(limb->cosine * region->sine - limb->sine * region->cosine)) *
        sqrt((double)(part->pose.spread[0] + part->pose.spread[1]));
    return turned + hypot(rest.x - (double)limb->rest_x, rest.y - (double)limb->rest_y) > least;
}

static void add_limb(Follower *f, const FlSurveyPart *part, const FlAnchor *anchor, GArray *limbs)
{
    Leaf *leaf = leaf_of(f, part);
    const FlAnchor *region = &anchor[part->region];
    const FlPoint middle = middle_of(part, part->pose.n > 0);
    if (!leaf->limb)
        return;
    if (leaf->anchor.cosine == 0 && leaf->anchor.sine == 0)
        begin_limb(&leaf->anchor, region, middle);
    const double least = STRAY_PX * (double)MAX(f->page[0], f->page[1]);
    f->region[part->region].limbs |= strays(&leaf->anchor, region, part, least);
    FlRegionLimb limb = {part->region, {leaf->anchor, (float)middle.x, (float)middle.y, {0}}};
    memcpy(limb.limb.spread, part->pose.spread, sizeof limb.limb.spread);
    g_array_append_val(limbs, limb);
}

static void follow(Follower *f, int t, const GArray *parts, FlAnchor *anchor, GArray *limbs)
{
    for (int r = 0; r < f->n_regions; r++)
        f->region[r].fit = (Fit){{0}};
    FL_EACH (const FlSurveyPart, part, parts) {
        if (part->region < 0)
            continue;
        note_leaf(f, t, part);
        add_beginning(f, part);
    }
    for (int r = 0; r < f->n_regions; r++) {
        begin(&f->region[r], &anchor[r]);
        move(&anchor[r], &f->region[r].fit);
    }
    FL_EACH (const FlSurveyPart, part, parts)
        if (part->region >= 0)
            add_limb(f, part, anchor, limbs);
}

/* Numbers the leaves of all regions. Returns: how many there are. */
static int number_leaves(const FlSurvey *survey, int n_regions, Region *region)
{
    g_autofree int *n = g_new0(int, n_regions + 1);
    FL_EACH_PART (survey, t, part)
        if (part->region >= 0)
            n[part->region] = MAX(n[part->region], part->nth + 1);
    int all = 0;
    for (int r = 0; r < n_regions; r++) {
        region[r].first = all;
        all += n[r];
    }
    return all;
}

/* Regions that move as one have none. */
static void drop_limbs(const Follower *f, GArray *limbs)
{
    guint kept = 0;
    for (guint k = 0; k < limbs->len; k++) {
        const FlRegionLimb limb = g_array_index(limbs, FlRegionLimb, k);
        if (f->region[limb.region].limbs)
            g_array_index(limbs, FlRegionLimb, kept++) = limb;
    }
    g_array_set_size(limbs, kept);
}

FlAnchor **fl_region_anchors_find(const FlSurvey *survey, int n_regions, GArray ***limbs)
{
    g_autofree Region *region = g_new0(Region, n_regions + 1);
    const int n_leaves = number_leaves(survey, n_regions, region);
    g_autofree Leaf *leaf = g_new0(Leaf, n_leaves + 1);
    Follower f = {n_regions, {(float)survey->width, (float)survey->height}, region, leaf};
    count_leaves(&f, survey, n_leaves);
    FlAnchor **anchors = g_new0(FlAnchor *, survey->n_frames + 1);
    *limbs = g_new0(GArray *, survey->n_frames + 1);
    for (int t = 0; t < survey->n_frames; t++) {
        anchors[t] = g_new0(FlAnchor, n_regions + 1);
        if (t > 0)
            memcpy(anchors[t], anchors[t - 1], (size_t)n_regions * sizeof **anchors);
        (*limbs)[t] = g_array_new(FALSE, TRUE, sizeof(FlRegionLimb));
        follow(&f, t, survey->frame[t].parts, anchors[t], (*limbs)[t]);
    }
    for (int t = 0; t < survey->n_frames; t++)
        drop_limbs(&f, (*limbs)[t]);
    return anchors;
}
