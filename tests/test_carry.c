/* The last field travels with the drawing: where to, how exactly, and what of it. */
#include "default_params.h"
#include "guides/displacement.h"
#include "synth/carry.h"
#include "synth/patch_cost.h"
#include "synth/rest.h"
#include "synth/rotation.h"
#include <math.h>
#include <string.h>

enum { SIDE = 64, CENTRE = SIDE / 2 };

static const FlRect whole = {0, 0, SIDE, SIDE};
static const FlExemplarLevel level = {.width = 2 * SIDE, .height = 2 * SIDE};

/* What a drawing does at a place: u, v in px. */
typedef void (*Motion)(double x, double y, double u[2]);

static void slow(double x, double y, double u[2])
{
    u[0] = 0.03, u[1] = -0.02;
}

static void leap(double x, double y, double u[2])
{
    u[0] = 5.25, u[1] = 2;
}

static void spin(double x, double y, double u[2])
{
    const double a = -0.3 * G_PI / 180; // back
    u[0] = x - (cos(a) * x - sin(a) * y);
    u[1] = y - (sin(a) * x + cos(a) * y);
}

static void half_spins(double x, double y, double u[2])
{
    if (x < 0)
        u[0] = u[1] = 0;
    else
        spin(x + 100, y, u); // the seam slips
}

static void unknown(double x, double y, double u[2])
{
    u[0] = u[1] = NAN;
}

static bool all_inside(void *data, int frame, uint8_t *coverage, GError **error)
{
    memset(coverage, 255, SIDE * SIDE);
    return true;
}

static bool moving(void *data, int frame, const FlOutlinePair *outlines, float *motion,
                   GError **error)
{
    for (int p = 0; p < SIDE * SIDE; p++) {
        double u[2];
        (*(Motion *)data)(p % SIDE - CENTRE, p / SIDE - CENTRE, u);
        motion[2 * p] = (float)u[0], motion[2 * p + 1] = (float)u[1];
    }
    return true;
}

/* A frame that is all paint; its direction is that of angle. */
static void moving_guides(Motion motion, uint8_t angle, FlGuides *guides)
{
    g_autoptr(GError) error = NULL;
    const FlGuideParams how = {.still_px = 0.05f, .flow_limit = 0.1f};
    const FlGuideSource source = {SIDE, SIDE, 2, all_inside, NULL, &motion, moving};
    g_autoptr(FlGuideSequence) sequence = fl_guide_sequence_new(&source, &how, &error);
    g_assert_true(sequence && fl_guides_init(guides, SIDE, SIDE, &error));
    g_assert_true(fl_guide_sequence_get(sequence, 1, guides, &error));
    memset(guides->angle, angle, SIDE * SIDE);
}

/* Every pixel is painted from as far right and down in the exemplar as it is in the frame. */
static void coherent_field(FlNnf *nnf)
{
    g_autoptr(GError) error = NULL;
    g_assert_true(fl_nnf_init(nnf, SIDE, SIDE, &error));
    for (int p = 0; p < SIDE * SIDE; p++)
        nnf->match[p] = (FlMatch){.x_16 = (uint16_t)(16 * (p % SIDE + CENTRE)),
                                  .y_16 = (uint16_t)(16 * (p / SIDE + CENTRE))};
}

/* The shape of a frame in which each pixel was as deep as it is far right. */
static const uint8_t *shape_of_columns(void)
{
    static uint8_t shape[SIDE * SIDE];
    for (int p = 0; p < SIDE * SIDE; p++)
        shape[p] = (uint8_t)(255 ^ p % SIDE);
    return shape;
}

static void carry_once(const FlGuides *guides, float carry, int frame, const FlNnf *nnf,
                       FlCarried *out)
{
    g_autoptr(GError) error = NULL;
    const FlCarry how = {guides, carry, true, frame, SIDE, shape_of_columns(), NULL, NULL};
    g_assert_true(fl_carried_init(out, SIDE, SIDE, &error));
    fl_nnf_carry(nnf, whole, &how, whole, &level, out);
}

/* Some frames of the same motion; what leaves the frame is known no more. */
static void carry_on(const FlGuides *guides, float carry, int frames, FlNnf *nnf)
{
    for (int f = 1; f <= frames; f++) {
        g_auto(FlCarried) next = {0};
        carry_once(guides, carry, f, nnf, &next);
        fl_nnf_clear(nnf);
        *nnf = next.nnf, next.nnf = (FlNnf){0};
    }
}

static void carried_on(const FlGuides *guides, float carry, int frames, FlNnf *nnf)
{
    coherent_field(nnf);
    carry_on(guides, carry, frames, nnf);
}

#define assert_near(value, expected, tolerance)                                                    \
    g_assert_cmpfloat_with_epsilon((double)(value), (double)(expected), (double)(tolerance))

/* The match of a pixel, as an offset from the exemplar's middle in px. */
static FlMatch match_of(const FlNnf *nnf, int x, int y, double place[2])
{
    const FlMatch m = nnf->match[(y + CENTRE) * SIDE + x + CENTRE];
    g_assert_cmpint(m.frame, !=, FL_NO_MATCH);
    place[0] = m.x_16 / 16.0 - 2 * CENTRE, place[1] = m.y_16 / 16.0 - 2 * CENTRE;
    return m;
}

static void slow_motion_carries_as_far_in_the_end(void)
{
    g_auto(FlGuides) guides = {0};
    g_auto(FlNnf) nnf = {0};
    moving_guides(slow, 0, &guides);
    carried_on(&guides, 1, 300, &nnf);
    for (int y = -20; y <= 20; y += 10)
        for (int x = -20; x <= 20; x += 10) {
            double place[2];
            g_assert_cmpint(match_of(&nnf, x, y, place).theta, ==, 0);
            assert_near(place[0], x - 9, 0.5);
            assert_near(place[1], y + 6, 0.5);
        }
}

static void a_slow_spin_carries_and_turns_as_far_in_the_end(void)
{
    g_auto(FlGuides) guides = {0};
    g_auto(FlNnf) nnf = {0};
    moving_guides(spin, 0, &guides);
    carried_on(&guides, 1, 300, &nnf);
    for (int y = -15; y <= 15; y += 6)
        for (int x = -15; x <= 15; x += 6) {
            double place[2]; // a quarter turn clockwise on the screen: (x, y) was at (y, -x)
            const FlMatch m = match_of(&nnf, x, y, place);
            g_assert_cmpint(ABS(m.theta - 64), <=, 1); // 1.4 degrees
            assert_near(place[0], y, 1);
            assert_near(place[1], -x, 1);
        }
}

static void half_a_pixel(double x, double y, double u[2])
{
    u[0] = 0.48, u[1] = -0.49;
}

enum { CONTOUR = 8, BORDER = 16, WIDE = 2 * SIDE }; // columns of the frame, px

static void squeezes(double x, double y, double u[2])
{
    u[0] = 0.01 * (CONTOUR - CENTRE - x), u[1] = 0;
}

static void swells(double x, double y, double u[2])
{
    u[0] = -0.01 * (CONTOUR - CENTRE - x), u[1] = 0;
}

/* The depth that a pixel shows after 20 frames which move it by a fifth of its depth; narrow: how
 * much deeper it is for the paint. */
static double depth_shown(Motion motion, const FlExemplar *exemplar, float narrow, int depth)
{
    g_auto(FlGuides) guides = {0};
    g_auto(FlNnf) nnf = {0};
    moving_guides(motion, 0, &guides);
    for (int p = 0; p < SIDE * SIDE; p++)
        guides.depth[p] = narrow * (guides.distance[p] = (float)(p % SIDE - CONTOUR));
    coherent_field(&nnf);
    for (int f = 1; f <= 20; f++) {
        g_auto(FlCarried) next = {0};
        const FlCarry how = {&guides, 1, true, f, SIDE, shape_of_columns(), NULL, exemplar};
        g_assert_true(fl_carried_init(&next, SIDE, SIDE, NULL));
        fl_nnf_carry(&nnf, whole, &how, whole, exemplar ? &exemplar->level[0] : &level, &next);
        fl_nnf_clear(&nnf);
        nnf = next.nnf, next.nnf = (FlNnf){0};
    }
    double place[2];
    (void)match_of(&nnf, depth + CONTOUR - CENTRE, 0, place);
    return place[0] + CENTRE - CONTOUR;
}

static void a_rim_is_as_wide_in_a_shape_that_swells_or_shrinks(void)
{
    static float distance[WIDE * WIDE];
    for (int p = 0; p < WIDE * WIDE; p++)
        distance[p] = (float)(p % WIDE - CENTRE - CONTOUR);
    FlExemplar exemplar = {.n_levels = 1, .border_px = BORDER, .distance = distance};
    exemplar.level[0] = level;
    exemplar.level[0].window = 1;
    for (int depth = 2; depth < BORDER; depth += 3) {
        assert_near(depth_shown(squeezes, &exemplar, 1, depth), depth, 0.7);
        assert_near(depth_shown(swells, &exemplar, 1, depth), depth, 0.7);
    }
    assert_near(depth_shown(squeezes, NULL, 1, 12), 14.6, 0.7);
    assert_near(depth_shown(squeezes, &exemplar, 1.5f, 12), 14.6, 0.7); // so does a narrow rim
    assert_near(depth_shown(squeezes, &exemplar, 1, 40), 48.8, 1); // the body goes with its motion
}

/* Squares of other frames of the exemplar go as far as what they show. */
static void pieces_travel_as_fast_as_what_they_show(void)
{
    enum { SQUARE = 8, FRAMES = 30 };
    g_auto(FlGuides) guides = {0};
    g_auto(FlNnf) nnf = {0};
    moving_guides(half_a_pixel, 0, &guides);
    coherent_field(&nnf);
    for (int p = 0; p < SIDE * SIDE; p++)
        nnf.match[p].frame = (int16_t)((p % SIDE / SQUARE + p / SIDE / SQUARE) % 2);
    carry_on(&guides, 1, FRAMES, &nnf);
    for (int y = 0; y < SIDE - 16; y++)
        for (int x = 16; x < SIDE; x++) {
            const double from_x = x - 0.48 * FRAMES, from_y = y + 0.49 * FRAMES;
            const double in_x = from_x + 0.5 - SQUARE * floor((from_x + 0.5) / SQUARE);
            const double in_y = from_y + 0.5 - SQUARE * floor((from_y + 0.5) / SQUARE);
            const int square =
                (int)floor((from_x + 0.5) / SQUARE) + (int)floor((from_y + 0.5) / SQUARE);
            if (in_x > 1.5 && in_x < SQUARE - 1.5 && in_y > 1.5 && in_y < SQUARE - 1.5)
                g_assert_cmpint(nnf.match[y * SIDE + x].frame, ==, square % 2);
        }
}

static void a_share_is_carried_and_what_goes_along_is_left(void)
{
    g_auto(FlGuides) guides = {0};
    for (int along = 0; along < 2; along++)
        for (int c = 0; c <= 4; c += 2) {
            g_auto(FlNnf) before = {0};
            g_auto(FlCarried) after = {0};
            const float carry = 0.25f * (float)c;
            const double left = 1 - (double)carry;
            fl_guides_clear(&guides);
            moving_guides(leap, along ? 0 : 64, &guides);
            coherent_field(&before);
            carry_once(&guides, carry, 1, &before, &after);
            double place[2];
            match_of(&after.nnf, 3, 4, place);
            assert_near(place[0], 3 - 5.25 * (double)carry, 1.0 / 16);
            assert_near(place[1], 4 - 2 * (double)carry, 1.0 / 16);
            assert_near(after.speed[CENTRE * SIDE + CENTRE], (along ? 5.25 : 2) * left, 0.001);
        }
}

/* Nor has paint whose patch was cut off at a side of the page. */
static void what_is_uncovered_has_no_match(void)
{
    g_auto(FlGuides) guides = {0};
    g_auto(FlNnf) nnf = {0};
    moving_guides(leap, 0, &guides);
    carried_on(&guides, 1, 1, &nnf);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            g_assert_true((nnf.match[y * SIDE + x].frame == FL_NO_MATCH) ==
                          (x < 5 + FL_PATCH_RADIUS || y < 2 + FL_PATCH_RADIUS));
}

static void how_deep_paint_was_comes_along(void)
{
    g_auto(FlGuides) guides = {0};
    g_auto(FlNnf) before = {0};
    g_auto(FlCarried) after = {0};
    moving_guides(leap, 0, &guides);
    coherent_field(&before);
    carry_once(&guides, 1, 1, &before, &after);
    for (int x = 5 + FL_PATCH_RADIUS; x < SIDE; x++)
        g_assert_cmpint(fl_rest_depth(after.shape[CENTRE * SIDE + x]), ==, x - 5);
    g_assert_cmpint(after.shape[CENTRE * SIDE + 3], ==, 0);
}

static void where_motion_is_unknown_nothing_is_carried(void)
{
    g_auto(FlGuides) guides = {0};
    g_auto(FlNnf) before = {0}, after = {0};
    moving_guides(unknown, 0, &guides);
    g_assert_false(guides.has_motion);
    coherent_field(&before);
    carried_on(&guides, 1, 3, &after);
    g_assert_cmpmem(after.match, SIDE * SIDE * sizeof(FlMatch), before.match,
                    SIDE * SIDE * sizeof(FlMatch));
}

static void parts_that_move_apart_turn_by_themselves(void)
{
    g_auto(FlGuides) guides = {0};
    moving_guides(half_spins, 0, &guides);
    g_assert_true(guides.has_motion);
    for (int p = 0; p < SIDE * SIDE; p++)
        g_assert_cmpint(ABS(guides.turn[p] - (p % SIDE < CENTRE ? 0 : 55)), <=, 30);
}

/* As far as the last frame is trusted at all, and nowhere where nothing was carried to. */
static void paint_that_was_carried_is_left_at_a_price(void)
{
    g_autofree FlParams *params = default_params();
    float trust[2] = {1, 0.5f};
    FlMatch match[2] = {{.frame = 0}, {.frame = 0}};
    const FlNnf carried = {2, 1, match};
    const FlTargetLevel target = {.width = 2, .height = 1, .temporal_weight = trust};
    FlCostScale scale;
    fl_cost_scale_init(&scale, params);
    FlSearch search = {.target = &target, .params = params, .scale = &scale, .carried = &carried};
    const uint32_t price = fl_leaving_cost(&search, 0);
    g_assert_cmpuint(price, >,
                     (uint32_t)(params->w_coh * scale.unit)); // more than a place in space
    g_assert_cmpuint(ABS((int)price / 2 - (int)fl_leaving_cost(&search, 1)), <=, 1);
    match[0].frame = FL_NO_MATCH;
    g_assert_cmpuint(fl_leaving_cost(&search, 0), ==, 0);
    search.carried = NULL;
    g_assert_cmpuint(fl_leaving_cost(&search, 1), ==, 0);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    fl_rotation_init();
#define TEST(name) g_test_add_func("/carry/" #name, name)
    TEST(slow_motion_carries_as_far_in_the_end);
    TEST(a_slow_spin_carries_and_turns_as_far_in_the_end);
    TEST(a_rim_is_as_wide_in_a_shape_that_swells_or_shrinks);
    TEST(pieces_travel_as_fast_as_what_they_show);
    TEST(a_share_is_carried_and_what_goes_along_is_left);
    TEST(what_is_uncovered_has_no_match);
    TEST(how_deep_paint_was_comes_along);
    TEST(where_motion_is_unknown_nothing_is_carried);
    TEST(parts_that_move_apart_turn_by_themselves);
    TEST(paint_that_was_carried_is_left_at_a_price);
#undef TEST
    return g_test_run();
}
