/* Paper: a sheet looks like the scans it was matched with, is the same everywhere, and paint lies
 * on it. */
#include "base/noise.h"
#include "compose/granulation.h"
#include "compose/ink.h"
#include "delta_e.h"
#include "io/png.h"
#include "scratch.h"
#include "threads.h"
#include <math.h>
#include <string.h>

#define SIDE 480

static const char *const words[FL_PAPER_KINDS] = {"cold", "hot", "rough", "laid", "kraft"};

static FlPaperSheet *sheet_of(const char *paper, uint64_t seed, int width, int height, int boil)
{
    GError *error = NULL;
    FlPaperSheet *sheet = NULL;
    const FlPaperChoice choice = {
        .paper = paper, .scale = 1, .relief = 1, .seed = seed, .boil = boil};
    fl_paper_sheet_make(&choice, true, width, height, &sheet, &error);
    g_assert_no_error(error);
    g_assert_nonnull(sheet);
    return sheet;
}

/* L* of bare paper, SIDE * SIDE. */
static double *lightness_of(const FlPaperSheet *sheet, const uint8_t colour[3])
{
    double *light = g_new(double, SIDE *SIDE);
    g_autofree uint16_t *rgba = g_new(uint16_t, 4 * SIDE * SIDE);
    for (int i = 0; i < SIDE * SIDE; i++)
        for (int c = 0; c < 4; c++)
            rgba[4 * i + c] = (uint16_t)(257 * (c < 3 ? colour[c] : 255));
    g_assert_true(fl_paper_sheet_light(sheet, 0, SIDE, SIDE, NULL, rgba, NULL));
    static double linear[65536];
    for (int i = 0; i < 65536 && linear[65535] == 0; i++) {
        const double s = i / 65535.0;
        linear[i] = s <= .04045 ? s / 12.92 : pow((s + .055) / 1.055, 2.4);
    }
    for (int i = 0; i < SIDE * SIDE; i++)
        light[i] = 116 * cbrt(.2126729 * linear[rgba[4 * i]] + .7151522 * linear[rgba[4 * i + 1]] +
                              .0721750 * linear[rgba[4 * i + 2]]) -
                   16;
    return light;
}

static double deviation_of(const double *values, double *mean)
{
    double sum = 0, squares = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        sum += values[i], squares += values[i] * values[i];
    *mean = sum / (SIDE * SIDE);
    return sqrt(squares / (SIDE * SIDE) - *mean * *mean);
}

/* The lightness of a sheet of a kind. */
static double *lightness_of_kind(int kind, uint64_t seed, double *mean, double *deviation)
{
    g_autoptr(FlPaperSheet) sheet = sheet_of(words[kind], seed, SIDE, SIDE, 0);
    double *light = lightness_of(sheet, fl_paper_grain((FlPaperKind)kind)->colour);
    *deviation = deviation_of(light, mean);
    return light;
}

static double correlation(const double *values, double mean, double deviation, int dx, int dy)
{
    double sum = 0;
    for (int y = 0; y + dy < SIDE; y++)
        for (int x = MAX(-dx, 0); x + MAX(dx, 0) < SIDE; x++)
            sum += (values[y * SIDE + x] - mean) * (values[(y + dy) * SIDE + x + dx] - mean);
    return sum / (deviation * deviation * (SIDE - abs(dx)) * (SIDE - dy));
}

/* The lamp of a scanner travels down the sheet, whose grain has no side that is lit. */
static void light_comes_from_above(void)
{
    for (int kind = 0; kind < FL_PAPER_KINDS; kind++) {
        double mean, deviation;
        g_autofree double *light = lightness_of_kind(kind, 1, &mean, &deviation);
        const double down = correlation(light, mean, deviation, 2, 2);
        const double up = correlation(light, mean, deviation, -2, 2);
        g_test_message("%s: along the diagonals %.3f and %.3f", words[kind], down, up);
        g_assert_cmpfloat(fabs(down - up), <, .05);
    }
}

static void lightness_deviates_as_in_scans(void)
{
    static const double wanted[FL_PAPER_KINDS] = {1.5, 1.0, 2.0, 1.1, 1.4};
    for (int kind = 0; kind < FL_PAPER_KINDS; kind++)
        for (uint64_t seed = 1; seed <= 3; seed++) {
            double mean, deviation;
            g_autofree double *light = lightness_of_kind(kind, seed, &mean, &deviation);
            g_test_message("%s, seed %d: L* %.2f, deviation %.3f", words[kind], (int)seed, mean,
                           deviation);
            g_assert_cmpfloat_with_epsilon(deviation, wanted[kind], .1 * wanted[kind]);
        }
}

/* Single fibres and grains have colours of their own, up to a level of a* and b* in the mean. */
static void grains_have_hues(void)
{
    g_autoptr(FlPaperSheet) sheet = sheet_of("cold", 1, SIDE, SIDE, 0);
    g_autofree double *red = g_new(double, SIDE *SIDE), *blue = g_new(double, SIDE *SIDE);
    double mean;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const uint16_t *factor = sheet->factor + 4 * i;
        red[i] = (factor[0] - factor[1]) / (double)FL_PAPER_ONE;
        blue[i] = (factor[2] - factor[1]) / (double)FL_PAPER_ONE;
    }
    const double reds = deviation_of(red, &mean), blues = deviation_of(blue, &mean);
    g_test_message("red deviates by %.4f, blue by %.4f", reds, blues);
    g_assert_true(reds > .006 && reds < .011);
    g_assert_true(blues > .006 && blues < .012);
}

static void nothing_repeats(void)
{
    for (int kind = 0; kind < FL_PAPER_KINDS; kind++) {
        double mean, deviation, most = 0;
        g_autofree double *light = lightness_of_kind(kind, 1, &mean, &deviation);
        for (int lag = 40; lag < 160; lag++) {
            most = MAX(most, fabs(correlation(light, mean, deviation, lag, 0)));
            most = MAX(most, fabs(correlation(light, mean, deviation, 0, lag)));
        }
        g_test_message("%s: correlation from 40 px on at most %.3f", words[kind], most);
        g_assert_cmpfloat(most, <, .1);
    }
}

static void little_of_it_is_in_long_waves(void)
{
    for (int kind = 0; kind < FL_PAPER_KINDS; kind++) {
        double mean, deviation;
        g_autofree double *light = lightness_of_kind(kind, 1, &mean, &deviation);
        double sum = 0; // of means over 16 px squares, whose deviation is that of long waves
        for (int y = 0; y < SIDE; y += 16)
            for (int x = 0; x < SIDE; x += 16) {
                double square = 0;
                for (int k = 0; k < 256; k++)
                    square += light[(y + k / 16) * SIDE + x + k % 16] - mean;
                sum += square / 256 * square / 256;
            }
        const double share = sum / (SIDE / 16 * SIDE / 16) / (deviation * deviation);
        g_test_message("%s: energy of waves longer than 32 px %.3f", words[kind], share);
        g_assert_cmpfloat(share, <, .15);
        g_assert_cmpfloat(share, >, .002);
    }
}

static void a_sheet_is_a_function_of_place(void)
{
    g_autoptr(FlPaperSheet) large = sheet_of("laid", 7, SIDE, 300, 0);
    g_autoptr(FlPaperSheet) small = sheet_of("laid", 7, 100, 90, 0);
    for (size_t y = 0; y < 90; y++) {
        g_assert_cmpmem(small->factor + 400 * y, 800, large->factor + 4 * SIDE * y, 800);
        g_assert_cmpmem(small->tooth + 100 * y, 100, large->tooth + SIDE * y, 100);
    }
    g_autoptr(FlPaperSheet) other = sheet_of("laid", 8, 100, 90, 0);
    g_assert_cmpint(memcmp(other->factor, small->factor, 800), !=, 0);
}

static void threads_do_not_matter(void)
{
    const int threads = omp_get_max_threads();
    for (int kind = 0; kind < FL_PAPER_KINDS; kind++) {
        omp_set_num_threads(1);
        g_autoptr(FlPaperSheet) one = sheet_of(words[kind], 1, 301, 203, 0);
        omp_set_num_threads(3);
        g_autoptr(FlPaperSheet) three = sheet_of(words[kind], 1, 301, 203, 0);
        g_assert_cmpmem(one->factor, 301 * 203 * 8, three->factor, 301 * 203 * 8);
        g_assert_cmpmem(one->tooth, 301 * 203, three->tooth, 301 * 203);
    }
    omp_set_num_threads(threads);
}

/* So that a sheet found wrong on one machine is found wrong on all. */
static void a_sheet_is_known(void)
{
    g_autoptr(FlPaperSheet) sheet = sheet_of("cold", 1, 200, 200, 0);
    g_autofree char *sum =
        g_compute_checksum_for_data(G_CHECKSUM_SHA256, (const guchar *)sheet->tooth, 200 * 200);
    g_assert_cmpstr(sum, ==, "c9e592a93a9f7c2cbb9d97490b4d459026cc16a61f0ef5f6d3366cf36f3de90a");
}

static void all_frames_have_the_same_sheet_unless_it_boils(void)
{
    int x, y, u, v;
    g_autoptr(FlPaperSheet) still = sheet_of("hot", 1, 60, 40, 0);
    fl_paper_sheet_origin(still, 1234, &x, &y);
    g_assert_true(x == 0 && y == 0 && fl_paper_sheet_since(still, 1234) == 0);
    g_autoptr(FlPaperSheet) boiling = sheet_of("hot", 1, 60, 40, 3);
    for (int frame = 0; frame < 300; frame++) {
        const int since = fl_paper_sheet_since(boiling, frame);
        fl_paper_sheet_origin(boiling, frame, &x, &y);
        fl_paper_sheet_origin(boiling, since, &u, &v);
        g_assert_true(since == frame / 3 * 3 && x == u && y == v && x % 2 == 0 && y % 2 == 0);
        g_assert_true(x >= 0 && x + 60 <= boiling->width && y >= 0 && y + 40 <= boiling->height);
    }
    fl_paper_sheet_origin(boiling, 0, &x, &y);
    fl_paper_sheet_origin(boiling, 3, &u, &v);
    g_assert_true(x != u || y != v);
}

static void light_leaves_alpha_alone(void)
{
    g_autoptr(FlPaperSheet) sheet = sheet_of("rough", 1, 64, 64, 0);
    uint8_t rgba[64 * 64 * 4], black[64 * 64 * 4] = {0};
    for (size_t i = 0; i < sizeof rgba; i++)
        rgba[i] = i % 4 == 3 ? (uint8_t)(i / 4) : 200;
    g_assert_true(fl_paper_sheet_light(sheet, 0, 64, 64, rgba, NULL, NULL));
    g_assert_true(fl_paper_sheet_light(sheet, 0, 64, 64, black, NULL, NULL));
    int changed = 0;
    for (size_t i = 0; i < sizeof rgba; i++) {
        const int wanted = (200 * sheet->factor[i] + FL_PAPER_ONE / 2) / FL_PAPER_ONE;
        g_assert_cmpint(rgba[i], ==, i % 4 == 3 ? (uint8_t)(i / 4) : MIN(wanted, 255));
        g_assert_cmpint(black[i], ==, 0);
        changed += i % 4 != 3 && rgba[i] != 200;
    }
    g_assert_cmpint(changed, >, 64 * 64);
}

static void light_that_is_put_away_is_the_same(void)
{
    enum { WIDTH = 50, HEIGHT = 70 }; // not whole bands
    g_autoptr(FlPaperSheet) here = sheet_of("cold", 1, WIDTH, HEIGHT, 1);
    g_autoptr(FlPaperSheet) away = sheet_of("cold", 1, WIDTH, HEIGHT, 1);
    g_assert_true(fl_paper_sheet_put_away(away, NULL));
    g_assert_null(away->factor);
    for (int frame = 0; frame < 20; frame++) {
        uint8_t a[4 * WIDTH * HEIGHT], b[4 * WIDTH * HEIGHT];
        g_assert_true(fl_paper_sheet_picture(here, frame, WIDTH, HEIGHT, a, NULL));
        g_assert_true(fl_paper_sheet_picture(away, frame, WIDTH, HEIGHT, b, NULL));
        g_assert_cmpmem(a, sizeof a, b, sizeof b);
    }
}

static void a_page_of_half_the_size_shows_the_same_sheet(void)
{
    FlPaperSheet *half = NULL;
    const FlPaperChoice choice = {.paper = "laid", .scale = .5, .relief = 1, .seed = 3};
    g_autoptr(FlPaperSheet) once = sheet_of("laid", 3, 2 * 60, 2 * 40, 0);
    g_assert_true(fl_paper_sheet_make(&choice, true, 60, 40, &half, NULL));
    for (int y = 0; y < 40; y++)
        for (int x = 0; x < 60; x++) {
            int sum = 0;
            for (int p = 0; p < 4; p++)
                sum += once->factor[4 * ((2 * y + p / 2) * 120 + 2 * x + p % 2)];
            g_assert_cmpint(abs(4 * half->factor[4 * (y * 60 + x)] - sum), <=, 2);
        }
    fl_paper_sheet_free(half);
}

static void papers_are_chosen(void)
{
    FlPaperSheet *sheet = NULL;
    FlPaperChoice choice = {.paper = "none", .scale = 1, .relief = 1};
    g_assert_true(fl_paper_sheet_make(&choice, true, 20, 20, &sheet, NULL));
    g_assert_null(sheet);
    choice.paper = NULL;
    for (int plain = 0; plain < 2; plain++) { // over a background paint has tooth alone
        g_assert_true(fl_paper_sheet_make(&choice, plain, 20, 20, &sheet, NULL));
        g_assert_cmpint(sheet->lights, ==, plain);
        fl_paper_sheet_free(sheet);
    }
    g_autoptr(GError) error = NULL;
    choice.paper = "could";
    g_assert_false(fl_paper_sheet_make(&choice, true, 20, 20, &sheet, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_USAGE);
    g_assert_nonnull(fl_paper_ground("kraft"));
    g_assert_null(fl_paper_ground("cold"));
    g_assert_null(fl_paper_ground(NULL));
}

/* The style's own, unless a paper is asked for; the usual one is cold. */
static void a_style_has_a_sheet_of_its_own(void)
{
    const FlSheetStyle own = {.grain = 5, .stretch = 1.3f, .tooth = .6f, .relief = 1};
    const FlSheetStyle usual = FL_SHEET_DEFAULTS;
    const FlPaperChoice choices[] = {
        {.paper = "cold", .sheet = &own}, {.sheet = &usual}, {.sheet = &own}};
    FlPaperSheet *sheet[3];
    for (int k = 0; k < 3; k++) {
        FlPaperChoice choice = choices[k];
        choice.scale = 1, choice.relief = 1, choice.seed = 1;
        g_assert_true(fl_paper_sheet_make(&choice, true, 60, 40, &sheet[k], NULL));
    }
    g_assert_cmpmem(sheet[0]->tooth, 2400, sheet[1]->tooth, 2400);
    g_assert_cmpint(memcmp(sheet[0]->tooth, sheet[2]->tooth, 2400), !=, 0);
    for (int k = 0; k < 3; k++)
        fl_paper_sheet_free(sheet[k]);
}

static void a_file_is_laid_side_by_side(void)
{
    GError *error = NULL;
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *path = g_build_filename(folder, "scan.png", NULL);
    uint8_t rgb[32 * 24 * 3];
    for (int i = 0; i < 32 * 24 * 3; i++)
        rgb[i] = (uint8_t)(200 + (i / 3 * 37 % 11) - 5);
    fl_png_write(path, rgb, 32, 24, 3, &error);
    g_assert_no_error(error);
    g_autoptr(FlPaperSheet) sheet = sheet_of(path, 1, 100, 60, 0);
    for (int y = 24; y < 60; y++)
        g_assert_cmpmem(sheet->factor + 400 * y, 800, sheet->factor + 400 * (y - 24), 800);
    g_assert_cmpmem(sheet->tooth, 32, sheet->tooth + 32, 32);
    double mean = 0;
    for (int i = 0; i < 32 * 24; i++)
        mean += sheet->factor[4 * (i / 32 * 100 + i % 32)] / (32 * 24.0 * FL_PAPER_ONE);
    g_assert_cmpfloat_with_epsilon(mean, 1, .001);
}

/* ---- paint on it ----------------------------------------------------------------------------- */

static double mean_granulated(const FlPaperSheet *sheet, float granulation, int amount,
                              double *deviation)
{
    g_autofree int16_t *amounts = g_new(int16_t, SIDE * SIDE);
    const FlArea area = {{0, 0, SIDE, SIDE}, NULL};
    double sum = 0, squares = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        amounts[i] = (int16_t)(i % 9 == 0 ? -1 : amount);
    fl_granulate(granulation, fl_paper_sheet_tooth(sheet, 0), &area, amounts, NULL);
    int n = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        g_assert_true(amounts[i] < FL_AMOUNTS && (amounts[i] == -1) == (i % 9 == 0));
        if (amounts[i] >= 0)
            n++, sum += amounts[i], squares += (double)amounts[i] * amounts[i];
    }
    *deviation = sqrt(squares / n - sum / n * sum / n);
    return sum / n;
}

static void granulation_keeps_the_tone(void)
{
    g_autoptr(FlPaperSheet) sheet = sheet_of("cold", 1, SIDE, SIDE, 0);
    const int amounts[] = {100, 400, 1024, 2048, 5000, FL_AMOUNTS - 1};
    double deviation;
    for (size_t k = 0; k < G_N_ELEMENTS(amounts); k++)
        for (int g = -35; g <= 14; g += 7) {
            const double mean =
                mean_granulated(sheet, (float)g / 100, amounts[k], &deviation) / amounts[k];
            g_test_message("amount %d, granulation %.2f: mean %.4f, deviation %.3f", amounts[k],
                           g / 100.0, mean, deviation / amounts[k]);
            if (amounts[k] < 5000) // which end at FL_AMOUNTS - 1
                g_assert_cmpfloat_with_epsilon(mean, 1, .02);
            g_assert_true((deviation > 0) == (g != 0) || amounts[k] < 400);
        }
}

static void wet_paint_settles_and_dry_paint_catches(void)
{
    int8_t heights[3] = {-2 * FL_TOOTH_ONE, 0, 2 * FL_TOOTH_ONE};
    const FlTooth tooth = {heights, 3};
    const FlArea area = {{0, 0, 3, 1}, NULL};
    int16_t wet[3] = {1024, 1024, 1024}, dry[3] = {300, 300, 300}, flat[3] = {1024, 5, -1};
    fl_granulate(.14f, tooth, &area, wet, NULL);
    g_assert_true(wet[0] > 1200 && wet[1] == 1024 && wet[2] < 880);
    fl_granulate(-.35f, tooth, &area, dry, NULL);
    g_assert_true(dry[0] == 0 && dry[1] == 300 && dry[2] > 500);
    fl_granulate(.14f, (FlTooth){0}, &area, flat, NULL);
    fl_granulate(0, tooth, &area, flat, NULL);
    g_assert_true(flat[0] == 1024 && flat[1] == 5 && flat[2] == -1);
}

/* The ln of the factor by which wet paint of an amount gathers in a hollow. */
static double gathered(int amount)
{
    int8_t height = -2 * FL_TOOTH_ONE;
    int16_t amounts[1] = {(int16_t)amount};
    fl_granulate(.14f, (FlTooth){&height, 1}, &(FlArea){{0, 0, 1, 1}, NULL}, amounts, NULL);
    return log((double)amounts[0] / amount);
}

/* A thin film has little pigment to part with, and a deep one covers the paper. */
static void thin_and_deep_paint_granulate_less(void)
{
    const double thin = gathered(120), middle = gathered(512), deep = gathered(3072);
    g_test_message("thin %.3f, middle %.3f, deep %.3f", thin, middle, deep);
    g_assert_cmpfloat(middle, >, .25);
    g_assert_cmpfloat(thin, <, .6 * middle);
    g_assert_cmpfloat(deep, <, .4 * middle);
}

/* Of two pigments the heavy one granulates and parts from the other, and the one that stains does
 * not. */
static void heavy_pigments_settle(void)
{
    int8_t heights[4] = {-2 * FL_TOOTH_ONE, 2 * FL_TOOTH_ONE, -2 * FL_TOOTH_ONE, 2 * FL_TOOTH_ONE};
    int8_t play[4] = {64, 64, -64, -64};
    const FlTooth tooth = {heights, 4};
    const FlArea area = {{0, 0, 4, 1}, NULL};
    int16_t amounts[4] = {1024, 1024, 1024, 1024};
    fl_granulate(.14f, tooth, &area, amounts, play);
    g_assert_cmpint(amounts[0] - amounts[1], >, 5 * (amounts[2] - amounts[3]));
    g_assert_true(play[0] > 70 && play[1] < 58);
    g_assert_cmpint(play[0] - 64, >, 4 * (play[2] + 64));
    g_assert_true(play[2] > -64 - 10 && play[2] < -64 + 15);
    const int8_t before = play[0];
    fl_granulate(-.14f, tooth, &area, amounts, play); // dry paint does not part
    g_assert_cmpint(play[0], ==, before);
}

/** Cells that are remembered between calls, and points that are left out, change nothing. */
static void noise_is_a_function_of_place_alone(void)
{
    for (int k = 0; k < 1000; k++) {
        const float x = (float)(k * 37 % 91) / 8, y = (float)(k * 53 % 67) / 8;
        const float here = fl_noise(7, x, y);
        const float other = fl_noise(7 + 64, x, y); // has the same place among what is remembered
        const float beside = fl_noise(7, x + 1, y);
        g_assert_cmpfloat(fl_noise(7 + 64, x, y), ==, other);
        (void)fl_noise(7, x, y + 1);
        g_assert_cmpfloat(fl_noise(7, x, y), ==, here);
        g_assert_cmpfloat(fl_noise(7, x + 1, y), ==, beside);
    }
    g_assert_cmpfloat(fl_noise(0, .5f, .5f), !=, 0);
}

static void noise_of_a_row_is_that_of_its_places(void)
{
    float x[FL_NOISE_ROW], y[FL_NOISE_ROW], one[FL_NOISE_ROW], many[FL_NOISE_ROW];
    for (int n = 1; n <= FL_NOISE_ROW; n += 51) {
        for (int i = 0; i < n; i++)
            x[i] = .37f * (float)i - 40, y[i] = 3 * sinf((float)i) - (float)(i % 7 == 0);
        fl_noise_row(5, x, y, n, one);
        fl_noise_octaves_row(6, x, y, n, 3, .6f, many);
        for (int i = 0; i < n; i++) {
            g_assert_cmpfloat(one[i], ==, fl_noise(5, x[i], y[i]));
            g_assert_cmpfloat(many[i], ==, fl_noise_octaves(6, x[i], y[i], 3, .6f));
        }
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/paper/lightness-deviates-as-in-scans", lightness_deviates_as_in_scans);
    g_test_add_func("/paper/light-comes-from-above", light_comes_from_above);
    g_test_add_func("/paper/nothing-repeats", nothing_repeats);
    g_test_add_func("/paper/little-of-it-is-in-long-waves", little_of_it_is_in_long_waves);
    g_test_add_func("/paper/a-sheet-is-a-function-of-place", a_sheet_is_a_function_of_place);
    g_test_add_func("/paper/threads-do-not-matter", threads_do_not_matter);
    g_test_add_func("/paper/a-sheet-is-known", a_sheet_is_known);
    g_test_add_func("/paper/all-frames-have-the-same-sheet-unless-it-boils",
                    all_frames_have_the_same_sheet_unless_it_boils);
    g_test_add_func("/paper/grains-have-hues", grains_have_hues);
    g_test_add_func("/paper/light-leaves-alpha-alone", light_leaves_alpha_alone);
    g_test_add_func("/paper/light-that-is-put-away-is-the-same",
                    light_that_is_put_away_is_the_same);
    g_test_add_func("/paper/a-page-of-half-the-size-shows-the-same-sheet",
                    a_page_of_half_the_size_shows_the_same_sheet);
    g_test_add_func("/paper/papers-are-chosen", papers_are_chosen);
    g_test_add_func("/paper/a-style-has-a-sheet-of-its-own", a_style_has_a_sheet_of_its_own);
    g_test_add_func("/paper/a-file-is-laid-side-by-side", a_file_is_laid_side_by_side);
    g_test_add_func("/paper/granulation-keeps-the-tone", granulation_keeps_the_tone);
    g_test_add_func("/paper/wet-paint-settles-and-dry-paint-catches",
                    wet_paint_settles_and_dry_paint_catches);
    g_test_add_func("/paper/heavy-pigments-settle", heavy_pigments_settle);
    g_test_add_func("/paper/thin-and-deep-paint-granulate-less",
                    thin_and_deep_paint_granulate_less);
    g_test_add_func("/paper/noise-of-a-row-is-that-of-its-places",
                    noise_of_a_row_is_that_of_its_places);
    g_test_add_func("/paper/noise-is-a-function-of-place-alone",
                    noise_is_a_function_of_place_alone);
    return g_test_run();
}
