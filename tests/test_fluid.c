/* The fluid inside a moving outline, against flows that are known. */
#include "guides/fluid_data.h"
#include "params/region_settings.h"
#include <math.h>
#include <string.h>

enum { SIDE = 200 };

typedef double (*Shape)(double x, double y, int frame); // px inside its contour, about

static FlOutline *outline_of(Shape shape, int frame)
{
    static uint8_t mask[SIDE * SIDE];
    for (int p = 0; p < SIDE * SIDE; p++)
        mask[p] =
            (uint8_t)lround(255 * CLAMP(shape(p % SIDE + .5, p / SIDE + .5, frame) + .5, 0.0, 1.0));
    return fl_outline_new(mask, SIDE, SIDE, NULL);
}

static FlFluid *fluid_of(const char *kind)
{
    const FlRect page = {0, 0, SIDE, SIDE};
    g_auto(FlRegionSettings) settings;
    fl_region_settings_init(&settings);
    g_assert_true(fl_region_settings_set(&settings, "fluid", kind, NULL, NULL));
    const FlFluidDials dials = fl_fluid_dials(&settings);
    return fl_fluid_new(page, page, &dials, NULL);
}

static float motion[2 * SIDE * SIDE];

/* Moves a fluid by frames first + 1 … last; motion has the sum. */
static void flow(FlFluid *fluid, Shape shape, int first, int last)
{
    g_autoptr(FlOutline) now = outline_of(shape, first);
    fl_fluid_begin(fluid);
    for (int frame = first + 1; frame <= last; frame++) {
        g_autoptr(FlOutline) before = now;
        now = outline_of(shape, frame);
        fl_fluid_step(fluid, before, fl_outlines_alike(before, now) ? before : now);
    }
    fl_fluid_motion(fluid, motion);
}

/* The mean error of the motion well inside a shape, over the mean length of a true one. */
static double error_of(Shape shape, int frame, void (*truth)(double x, double y, double out[2]))
{
    double error = 0, length = 0;
    for (int p = 0; p < SIDE * SIDE; p++) {
        const double x = p % SIDE + .5, y = p / SIDE + .5;
        double out[2];
        if (shape(x, y, frame) < 4)
            continue;
        truth(x, y, out);
        g_assert_true(isfinite(motion[2 * p]));
        error += hypot((double)motion[2 * p] - out[0], (double)motion[2 * p + 1] - out[1]);
        length += hypot(out[0], out[1]);
    }
    return error / length;
}

static double sliding(double x, double y, int frame)
{
    return 30 - hypot(x - 60 - 3.5 * frame, y - 90 - 1.5 * frame);
}

static void slide_of(double x, double y, double out[2])
{
    out[0] = 3.5, out[1] = 1.5;
}

static void test_slide(void)
{
    g_autoptr(FlFluid) fluid = fluid_of("plain");
    for (int frame = 1; frame < 12; frame++)
        flow(fluid, sliding, frame - 1, frame);
    g_assert_cmpfloat(error_of(sliding, 11, slide_of), <, .02);
}

/* An ellipse that is drawn out: of all flows that follow its outline, one has neither divergence
 * nor curl. */
#define DRAWN .02
static double half_axis(int frame)
{
    return 40 * exp(DRAWN * (frame + 1));
}

static double drawn(double x, double y, int frame)
{
    const double a = half_axis(frame), b = 1600 / a, u = x - 100, v = y - 100;
    const double slope = 2 * hypot(u / (a * a), v / (b * b)) + 1e-9;
    return (1 - u * u / (a * a) - v * v / (b * b)) / slope;
}

static void strain_of(double x, double y, double out[2])
{
    out[0] = (x - 100) * (1 - exp(-DRAWN)), out[1] = (y - 100) * (1 - exp(DRAWN));
}

static void test_strain(void)
{
    static const char *const kinds[] = {"plain", "water"};
    for (size_t k = 0; k < G_N_ELEMENTS(kinds); k++) {
        g_autoptr(FlFluid) fluid = fluid_of(kinds[k]);
        for (int frame = 1; frame < 12; frame++)
            flow(fluid, drawn, frame - 1, frame);
        g_assert_cmpfloat(error_of(drawn, 11, strain_of), <, .08);
    }
}

static void strain_of_two(double x, double y, double out[2])
{
    out[0] = (x - 100) * (1 - exp(-2 * DRAWN)), out[1] = (y - 100) * (1 - exp(2 * DRAWN));
}

static void test_held(void)
{
    g_autoptr(FlFluid) fluid = fluid_of("water");
    for (int frame = 2; frame < 12; frame += 2)
        flow(fluid, drawn, frame - 2, frame);
    g_assert_cmpfloat(error_of(drawn, 10, strain_of_two), <, .08);
}

/* A blade that sways, held at its foot. */
static double sway_of(double y, int frame)
{
    const double height = MAX(185 - y, 0) / 150;
    return 28 * height * height * sin(.13 * frame);
}

static double swaying(double x, double y, int frame)
{
    const double side = 5 + 8 * (y - 30) / 155;
    return MIN(side - fabs(x - 100 - sway_of(y, frame)), MIN(y - 30, 185 - y));
}

static void sway_of_last(double x, double y, double out[2])
{
    out[0] = sway_of(y, 48) - sway_of(y, 47), out[1] = 0;
}

/* No whirls pile up that the outline does not show. */
static void test_sway(void)
{
    g_autoptr(FlFluid) fluid = fluid_of("plain");
    for (int frame = 1; frame <= 48; frame++)
        flow(fluid, swaying, frame - 1, frame);
    g_test_message("error %g", error_of(swaying, 48, sway_of_last));
    g_assert_cmpfloat(error_of(swaying, 48, sway_of_last), <, .18);
}

/* A puff that drifts and swells, so that its rear rests on the page: nothing comes in there. */
static double puff_size(int frame)
{
    return 30 * exp(.01 * frame);
}

static double swelling(double x, double y, int frame)
{
    return puff_size(frame) - hypot(x - 70 - .45 * frame, y - 130 + .45 * frame);
}

static void swell_of_last(double x, double y, double out[2])
{
    const double share = 1 - puff_size(39) / puff_size(40);
    out[0] = .45 + share * (x - 70 - .45 * 40);
    out[1] = -.45 + share * (y - 130 + .45 * 40);
}

/* A hull that rocks to and fro. */
static double rocking(double x, double y, int frame)
{
    const double turn = .3 * sin(.15 * frame), c = cos(turn), s = sin(turn);
    const double u = c * (x - 100) + s * (y - 100), v = c * (y - 100) - s * (x - 100);
    return MIN(MIN(v + 25, 25 - v), 60 - fabs(u) - .5 * (v + 25));
}

static void rock_of_last(double x, double y, double out[2])
{
    const double turn = .3 * (sin(.15 * 40) - sin(.15 * 39)), c = cos(turn), s = sin(turn);
    out[0] = (x - 100) - (c * (x - 100) + s * (y - 100));
    out[1] = (y - 100) - (c * (y - 100) - s * (x - 100));
}

/* A wave on deep water that runs across the page. */
static double rolling(double x, double y, int frame)
{
    return y - 90 + 9 * cos(2 * G_PI * x / 100 - .25 * frame);
}

static void roll_of_last(double x, double y, double out[2])
{
    const double k = 2 * G_PI / 100, phase = k * x - .25 * 39.5, speed = 9 * .25;
    out[0] = speed * exp(-k * MAX(y - 90, -9)) * cos(phase);
    out[1] = -speed * exp(-k * MAX(y - 90, -9)) * sin(phase);
}

/* A pillar as high as the page that goes to the side. */
static double going(double x, double y, int frame)
{
    return 15 - fabs(x - 20 - 3 * frame) + 0 * y;
}

static void go_of(double x, double y, double out[2])
{
    out[0] = 3 + 0 * x, out[1] = 0 * y;
}

/* What an affine motion of the outline explains is that motion; but a wave is not its outline's. */
static void test_outline(void)
{
    static const struct {
        Shape shape;
        void (*truth)(double x, double y, double out[2]);
        double most;
    } films[] = {{swelling, swell_of_last, .1},
                 {rocking, rock_of_last, .1},
                 {rolling, roll_of_last, .6},
                 {going, go_of, .1}};
    for (size_t k = 0; k < G_N_ELEMENTS(films); k++) {
        g_autoptr(FlFluid) fluid = fluid_of("plain");
        for (int frame = 1; frame <= 40; frame++)
            flow(fluid, films[k].shape, frame - 1, frame);
        g_test_message("film %zu, error %g", k, error_of(films[k].shape, 40, films[k].truth));
        g_assert_cmpfloat(error_of(films[k].shape, 40, films[k].truth), <, films[k].most);
    }
}

/* Clouds that span the page and drift; in frame 21 their rear comes off the page's edge. */
static double drifting(double x, double y, int frame)
{
    const double u = x - 2 * frame;
    return MIN(28 + 6 * sin(u / 12) + 4 * sin(u / 5) - fabs(y - 80), u + 40);
}

/* What comes off the page's edge has not been pushed in there. */
static void test_off_edge(void)
{
    g_autoptr(FlFluid) fluid = fluid_of("plain");
    float fastest = 0;
    for (int frame = 1; frame <= 24; frame++) {
        flow(fluid, drifting, frame - 1, frame);
        for (int p = 0; p < SIDE * SIDE && frame > 19; p++)
            if (drifting(p % SIDE + .5, p / SIDE + .5, frame) > 0)
                fastest = MAX(fastest, hypotf(motion[2 * p], motion[2 * p + 1]));
    }
    g_test_message("fastest %g", (double)fastest);
    g_assert_cmpfloat(fastest, <, 4);
}

/* The mean speed against its outline of what drifts as sliding() does. */
static double roll_within(int frame)
{
    double sum = 0, n = 0;
    for (int p = 0; p < SIDE * SIDE; p++)
        if (sliding(p % SIDE + .5, p / SIDE + .5, frame) >= 4)
            sum += hypot((double)motion[2 * p] - 3.5, (double)motion[2 * p + 1] - 1.5), n++;
    return sum / n;
}

/* Smoke rolls on in a cloud that drifts as a rigid body. */
static void test_roll(void)
{
    g_autoptr(FlFluid) fluid = fluid_of("smoke");
    double least = HUGE_VAL, most = 0;
    for (int frame = 1; frame <= 20; frame++) {
        flow(fluid, sliding, frame - 1, frame);
        if (frame > 10)
            least = MIN(least, roll_within(frame)), most = MAX(most, roll_within(frame));
    }
    g_test_message("from %g to %g", least, most);
    g_assert_cmpfloat(least, >, .5 * most);
    g_assert_cmpfloat(most, >, .1);
}

/* A column whose top rises: what it gains has to come in. */
static double rising(double x, double y, int frame)
{
    return MIN(MIN(x - 80, 120 - x), MIN(y - 130 + 3 * frame, 170 - y));
}

static void test_growth(void)
{
    g_autoptr(FlFluid) plain = fluid_of("plain"), fire = fluid_of("fire");
    FlFluid *const both[] = {plain, fire};
    for (int k = 0; k < 2; k++) {
        for (int frame = 1; frame < 25; frame++)
            flow(both[k], rising, frame - 1, frame);
        const float foot = motion[2 * (160 * SIDE + 100) + 1],
                    top = motion[2 * (75 * SIDE + 100) + 1];
        g_assert_cmpfloat(top, <, -2);   // it goes with the outline
        g_assert_cmpfloat(foot, <, -.5); // and comes in at the foot
    }
}

/* What leaves a cell is what its contour lets in and its share of the shape's gain, but for a
 * hundredth of what was missing. */
static void test_flux(void)
{
    g_autoptr(FlFluid) fluid = fluid_of("water");
    const FlFluid *f = fluid;
    for (int frame = 1; frame < 25; frame++) {
        double off = 0, missing = 0, pushed = 0;
        flow(fluid, rising, frame - 1, frame);
        for (int c = 0; c < f->n; c++) {
            const FlFluidPart *part = fl_fluid_part(f, c);
            const int below = c + f->stride;
            if (!part)
                continue;
            const double out = (double)(f->open_u[c + 1] * f->u[c + 1] - f->open_u[c] * f->u[c] +
                                        f->open_v[below] * f->v[below] - f->open_v[c] * f->v[c]);
            const double push = (double)(f->speed[c] * f->length[c]);
            const double gain = part->growth * (double)fl_fluid_open_area(f, c) / part->area;
            off += (out + push - gain) * (out + push - gain);
            missing += f->missing[c] * f->missing[c], pushed += push;
        }
        g_assert_cmpfloat(pushed, >, 5); // the column is 20 cells wide
        g_assert_cmpfloat(sqrt(off), <, .0101 * sqrt(missing));
    }
}

static double resting(double x, double y, int frame)
{
    return MAX(20 - hypot(x - 60, y - 60), 30 - hypot(x - 140 + frame, y - 140));
}

static void test_rest(void)
{
    g_autoptr(FlFluid) fluid = fluid_of("smoke");
    for (int frame = 1; frame < 10; frame++)
        flow(fluid, resting, frame - 1, frame);
    for (int y = 45; y < 75; y++)
        for (int x = 45; x < 75; x++)
            if (resting(x + .5, y + .5, 9) > 0)
                g_assert_true(motion[2 * (y * SIDE + x)] == 0 &&
                              motion[2 * (y * SIDE + x) + 1] == 0);
}

/* A disk at the left that moves for ten frames, and a second one that does so from frame 30 on. */
static double stopping(double x, double y, int frame)
{
    return MAX(30 - hypot(x - 60 - 2 * MIN(frame, 10), y - 60 - MIN(frame, 10)),
               20 - hypot(x - 160, y - 150 - MAX(frame - 30, 0)));
}

/* The same, but the second one moves all the time. */
static double stopping_beside(double x, double y, int frame)
{
    return MAX(stopping(x, y, MIN(frame, 30)), 15 - hypot(x - 170, y - 190 + 3 * frame));
}

/* The largest difference of the motion in the first disk from (u, v). */
static float stir_of(double u, double v)
{
    float most = 0;
    for (int y = 50; y < 90; y++)
        for (int x = 60; x < 100; x++)
            most = MAX(most, hypotf(motion[2 * (y * SIDE + x)] - (float)u,
                                    motion[2 * (y * SIDE + x) + 1] - (float)v));
    return most;
}

static void test_stop(void)
{
    static const Shape shapes[] = {stopping, stopping_beside};
    for (int k = 0; k < 2; k++) {
        g_autoptr(FlFluid) fluid = fluid_of("smoke");
        for (int frame = 1; frame <= 31; frame++) {
            flow(fluid, shapes[k], frame - 1, frame);
            if (frame == 10)
                g_assert_cmpfloat(stir_of(2, 1), >, .5);
        }
        g_assert_cmpfloat(stir_of(0, 0), <, .1);
    }
}

static double leaping(double x, double y, int frame)
{
    return 12 - hypot(x - (frame % 2 ? 40 : 160), y - 100);
}

/* It lands where it was in part. */
static double hopping(double x, double y, int frame)
{
    return 12 - hypot(x - (frame % 2 ? 90 : 110), y - 100);
}

static double blinking(double x, double y, int frame)
{
    return frame % 3 == 1 ? -9 : 40 - hypot(x - 100, y - 100);
}

static double empty(double x, double y, int frame)
{
    return -9;
}

static double full(double x, double y, int frame)
{
    return 9;
}

static double dot(double x, double y, int frame)
{
    return 1 - hypot(x - 100, y - 100 - frame);
}

static double dots(double x, double y, int frame)
{
    return ((int)(x + 3 * frame) / 3 * 7 + (int)y / 3 * 13) % 5 == 0 ? 1 : -1;
}

static double bursting(double x, double y, int frame)
{
    return 1 + 30 * (frame % 6) - hypot(x - 100, y - 100);
}

static double bars(double x, double y, int frame)
{
    return fmod(x + 2 * frame, 8) < 3 ? 1 : -1;
}

/* No outline makes a motion that is not a number where there is fluid, or faster than one. */
static void test_any(void)
{
    static const char *const kinds[] = {"plain", "smoke", "water", "fire", "honey"};
    static const Shape shapes[] = {leaping, blinking, empty, full, dot, dots, bursting, bars};
    for (size_t k = 0; k < G_N_ELEMENTS(kinds); k++)
        for (size_t s = 0; s < G_N_ELEMENTS(shapes); s++) {
            g_autoptr(FlFluid) fluid = fluid_of(kinds[k]);
            for (int frame = 1; frame < 12; frame++) {
                flow(fluid, shapes[s], frame - 1, frame);
                for (int p = 0; p < SIDE * SIDE; p++)
                    if (!isnan(motion[2 * p]))
                        g_assert_cmpfloat(hypotf(motion[2 * p], motion[2 * p + 1]), <, 80);
            }
        }
}

/* A ball that rises; in frame 12 a puff hangs below it. */
static double puffing(double x, double y, int frame)
{
    const double ball = 22 - hypot(x - 100, y - 110 + 2 * frame);
    return frame < 12 ? ball : MAX(ball, 16 - hypot(x - 100, y - 118));
}

static void test_puff(void)
{
    g_autoptr(FlFluid) fluid = fluid_of("plain");
    for (int frame = 1; frame <= 12; frame++)
        flow(fluid, puffing, frame - 1, frame);
    // the ball's fluid goes on, and is not sucked into the puff
    g_assert_cmpfloat(fabsf(motion[2 * (80 * SIDE + 100) + 1] + 2), <, .5f);
    g_assert_cmpfloat(fabsf(motion[2 * (96 * SIDE + 100) + 1]), <, 2);
}

static void test_leap(void)
{
    g_autoptr(FlFluid) far = fluid_of("plain"), near = fluid_of("plain");
    for (int frame = 1; frame < 4; frame++) {
        flow(far, leaping, frame - 1, frame);
        g_assert_true(isnan(motion[2 * (100 * SIDE + (frame % 2 ? 40 : 160))]));
        flow(near, hopping, frame - 1, frame);
        g_assert_true(isnan(motion[2 * (100 * SIDE + (frame % 2 ? 90 : 110))]));
    }
}

/* Fluid that has been somewhere else before flows alike. */
static void test_anew(void)
{
    static float alone[2 * SIDE * SIDE];
    g_autoptr(FlFluid) fluid = fluid_of("smoke");
    for (int frame = 1; frame < 6; frame++)
        flow(fluid, rising, frame - 1, frame);
    memcpy(alone, motion, sizeof alone);
    flow(fluid, empty, 0, 0);
    g_autoptr(FlOutline) none = outline_of(empty, 0), first = outline_of(rising, 0);
    fl_fluid_step(fluid, none, first);
    for (int frame = 1; frame < 6; frame++)
        flow(fluid, rising, frame - 1, frame);
    g_assert_cmpmem(alone, sizeof alone, motion, sizeof motion);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/fluid/slide", test_slide);
    g_test_add_func("/fluid/strain", test_strain);
    g_test_add_func("/fluid/held", test_held);
    g_test_add_func("/fluid/sway", test_sway);
    g_test_add_func("/fluid/outline", test_outline);
    g_test_add_func("/fluid/off-edge", test_off_edge);
    g_test_add_func("/fluid/roll", test_roll);
    g_test_add_func("/fluid/growth", test_growth);
    g_test_add_func("/fluid/flux", test_flux);
    g_test_add_func("/fluid/rest", test_rest);
    g_test_add_func("/fluid/stop", test_stop);
    g_test_add_func("/fluid/any", test_any);
    g_test_add_func("/fluid/puff", test_puff);
    g_test_add_func("/fluid/leap", test_leap);
    g_test_add_func("/fluid/anew", test_anew);
    return g_test_run();
}
