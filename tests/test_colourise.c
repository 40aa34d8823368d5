#include "base/density.h"
#include "compose/colourise.h"
#include "delta_e.h"
#include "io/png.h"

#include <string.h>

/** A frame of paint from the fixtures. */
typedef struct Sample {
    int width, height;
    uint8_t *rgb, *mask;
} Sample;

static FlPicture *picture(const char *name, const char *kind)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *file =
        g_strdup_printf("%s/compose/%s-%s.png", g_getenv("FLUIDY_FIXTURES"), name, kind);
    FlPicture *read = fl_picture_read_png(file, &error);
    g_assert_no_error(error);
    return read;
}

static Sample sample_load(const char *name)
{
    g_autoptr(FlPicture) rgb = picture(name, "rgb");
    g_autoptr(FlPicture) mask = picture(name, "mask");
    const size_t n = (size_t)rgb->width * rgb->height;
    Sample s = {rgb->width, rgb->height, g_malloc(3 * n), g_malloc(n)};
    for (size_t i = 0; i < n; i++) {
        memcpy(s.rgb + 3 * i, rgb->rgba + 4 * i, 3);
        s.mask[i] = mask->rgba[4 * i];
    }
    return s;
}

static void sample_clear(Sample *s)
{
    g_free(s->rgb);
    g_free(s->mask);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Sample, sample_clear)

static const uint8_t drop_paper[3] = {234, 230, 228}, bloom_paper[3] = {233, 216, 187};
static const uint8_t white[3] = {255, 255, 255};

static FlInk *ink_of(const Sample *s, const uint8_t paper[3])
{
    g_autoptr(GError) error = NULL;
    FlInk *ink = fl_ink_new(paper, s->rgb, s->mask, (size_t)s->width * s->height, &error);
    g_assert_no_error(error);
    return ink;
}

/** Colours a sample and puts it on its paper: to be freed, width * height * 3. */
static uint8_t *paint(const Sample *s, const FlInk *ink, const FlColouring *how, int tone)
{
    const FlArea area = {{0, 0, s->width, s->height}};
    const size_t n = fl_rect_pixels(area.box);
    g_autofree uint8_t *rgba = g_malloc0(4 * n);
    g_autofree int16_t *amounts = g_new(int16_t, n);
    uint8_t *rgb = g_malloc(3 * n);
    const FlPaintedPart painted = {s->rgb, area.box};
    fl_colourise_amounts(ink, tone, &painted, s->mask, &area, amounts);
    fl_colourise(ink, how, &painted, amounts, &area, rgba);
    for (size_t i = 0; i < 3 * n; i++) {
        const uint8_t *p = rgba + i / 3 * 4;
        rgb[i] = (uint8_t)((p[i % 3] * p[3] + how->paper[i % 3] * (255 - p[3]) + 127) / 255);
    }
    return rgb;
}

static int compare_bytes(const void *a, const void *b)
{
    return *(const uint8_t *)a - *(const uint8_t *)b;
}

/** The median of each channel where the coverage is full, 2 px and more from the contour. */
static void median_colour(const Sample *s, const uint8_t *rgb, uint8_t median[3])
{
    g_autofree uint8_t *values = g_malloc((size_t)s->width * s->height);
    for (int c = 0; c < 3; c++) {
        size_t n = 0;
        for (int y = 2; y < s->height - 2; y++)
            for (int x = 2; x < s->width - 2; x++) {
                const size_t i = (size_t)y * s->width + x;
                const size_t row = 2 * (size_t)s->width;
                bool inner = true;
                for (size_t j = i - row; j <= i + row; j += row)
                    inner &= s->mask[j - 2] == 255 && s->mask[j] == 255 && s->mask[j + 2] == 255;
                if (inner)
                    values[n++] = rgb[3 * i + c];
            }
        qsort(values, n, 1, compare_bytes);
        median[c] = values[n / 2];
    }
}

static const uint8_t fills[][3] = {
    {0, 0, 0},       {255, 255, 255}, {214, 40, 40},   {255, 0, 0},     {0, 0, 255},
    {0, 255, 0},     {59, 42, 26},    {247, 241, 230}, {128, 128, 128}, {255, 230, 0},
    {250, 199, 170}, {20, 40, 90},    {120, 200, 240}, {90, 30, 120},   {255, 255, 255},
    {249, 242, 239}, {240, 236, 226},
};

static void the_median_interior_colour_is_the_fill(void)
{
    const char *names[] = {"drop-13", "drop-30", "bloom-13", "bloom-30"};
    for (int k = 0; k < 4; k++) {
        const uint8_t *paper = k < 2 ? drop_paper : bloom_paper;
        g_auto(Sample) learned = sample_load(k < 2 ? "drop-30" : "bloom-30");
        g_auto(Sample) s = sample_load(names[k]);
        g_autoptr(FlInk) ink = ink_of(&learned, paper);
        for (size_t f = 0; f < 2 * G_N_ELEMENTS(fills); f++) {
            const uint8_t *fill = fills[f / 2], *on = f % 2 ? paper : white;
            const int tone = fl_ink_exposure(ink, s.rgb, s.mask, s.width, s.height);
            FlColouring how = {0};
            memcpy(how.fill, fill, 3);
            memcpy(how.paper, on, 3);
            g_autofree uint8_t *rgb = paint(&s, ink, &how, tone);
            uint8_t median[3];
            median_colour(&s, rgb, median);
            g_test_message("%s on #%02x%02x%02x: #%02x%02x%02x becomes #%02x%02x%02x, %.2f",
                           names[k], on[0], on[1], on[2], fill[0], fill[1], fill[2], median[0],
                           median[1], median[2], delta_e(fill, median));
            // beyond 3 where a channel is lighter than a coloured paper, and turns at one
            const double bound = on == white ? 3 : k < 2 ? 3.2 : 6;
            g_assert_cmpfloat(delta_e(fill, median), <=, bound);
        }
    }
}

static double light_of(const uint8_t *rgb)
{
    return 0.2126 * delta_e_light(rgb[0]) + 0.7152 * delta_e_light(rgb[1]) +
           0.0722 * delta_e_light(rgb[2]);
}

/** The standard deviation of the logarithm of the density of the light, inside the mask. */
static double contrast(const Sample *s, const uint8_t *rgb, const uint8_t *paper)
{
    double sum = 0, squares = 0, n = 0;
    for (size_t i = 0; i < (size_t)s->width * s->height; i++) {
        if (s->mask[i] < 255)
            continue;
        const double l = log(fmax(log(light_of(paper) / light_of(rgb + 3 * i)), 0.02));
        sum += l, squares += l * l, n++;
    }
    return sqrt(squares / n - sum / n * (sum / n));
}

static void four_fifths_of_the_contrast_are_kept(void)
{
    const struct {
        const char *name;
        const uint8_t *paper;
    } cases[] = {{"drop-13", drop_paper},
                 {"drop-30", drop_paper},
                 {"bloom-13", bloom_paper},
                 {"bloom-30", bloom_paper}};
    for (size_t k = 0; k < G_N_ELEMENTS(cases); k++) {
        g_auto(Sample) s = sample_load(cases[k].name);
        g_autoptr(FlInk) ink = ink_of(&s, cases[k].paper);
        const FlColouring how = {.fill = {120, 90, 70}, .paper = {255, 255, 255}};
        const int tone = fl_ink_exposure(ink, s.rgb, s.mask, s.width, s.height);
        g_autofree uint8_t *rgb = paint(&s, ink, &how, tone);
        const double had = contrast(&s, s.rgb, cases[k].paper), has = contrast(&s, rgb, white);
        g_test_message("%s: log density deviates by %.3f, was %.3f", cases[k].name, has, had);
        g_assert_cmpfloat(has, >=, 0.8 * had);
    }
}

static void bare_paper_is_transparent_and_thin_paint_is_thin(void)
{
    g_auto(Sample) s = sample_load("bloom-30");
    g_autoptr(FlInk) ink = ink_of(&s, bloom_paper);
    const uint8_t black[3] = {0, 0, 0};
    uint8_t rgb[4][3], coverage[4] = {255, 255, 255, 0}, rgba[16] = {0};
    memcpy(rgb[0], bloom_paper, 3);
    memcpy(rgb[1], white, 3); // brighter than the paper: no paint either
    memcpy(rgb[2], black, 3);
    memcpy(rgb[3], black, 3);
    const FlArea area = {{0, 0, 4, 1}};
    const FlPaintedPart painted = {rgb[0], area.box};
    int16_t amounts[4];
    FlColouring how = {.fill = {200, 30, 30}, .paper = {255, 255, 255}};
    fl_colourise_amounts(ink, FL_EXPOSURE_ONE, &painted, coverage, &area, amounts);
    fl_colourise(ink, &how, &painted, amounts, &area, rgba);
    g_assert_cmpint(rgba[3], ==, 0);
    g_assert_cmpint(rgba[7], ==, 0);
    g_assert_cmpint(rgba[11], >=, 250);
    g_assert_cmpint(rgba[15], ==, 0);
    for (int medium = FL_MEDIUM_TRANSPARENT; medium <= FL_MEDIUM_BODY;
         medium++) { // white gouache covers, white watercolour does not
        memset(how.fill, 255, 3);
        how.medium = (FlMedium)medium;
        fl_colourise(ink, &how, &painted, amounts, &area, rgba);
        g_assert_cmpint(rgba[3], ==, 0);
        if (medium == FL_MEDIUM_TRANSPARENT)
            g_assert_cmpint(rgba[11], <, 128);
        else
            g_assert_cmpint(rgba[11], ==, 255);
    }
}

/** The RGBA of every amount of paint; to be freed, 4 * FL_AMOUNTS. */
static uint8_t *colours_of_amounts(const FlColouring *how)
{
    const FlInk ink = {.spread = 400};
    const FlArea area = {{0, 0, FL_AMOUNTS, 1}};
    g_autofree int16_t *amounts = g_new(int16_t, FL_AMOUNTS);
    uint8_t *rgba = g_malloc0((size_t)4 * FL_AMOUNTS);
    for (int i = 0; i < FL_AMOUNTS; i++)
        amounts[i] = (int16_t)i;
    fl_colourise(&ink, how, NULL, amounts, &area, rgba);
    return rgba;
}

static const uint8_t papers[][3] = {
    {255, 255, 255}, {245, 240, 230}, {196, 164, 124}, {50, 50, 50}};

static void more_paint_never_hides_less(void)
{
    for (size_t f = 0; f < 2 * G_N_ELEMENTS(fills) * G_N_ELEMENTS(papers); f++)
        for (int medium = FL_MEDIUM_TRANSPARENT; medium <= FL_MEDIUM_BODY; medium++) {
            FlColouring how = {.medium = (FlMedium)medium, .linear = f % 2};
            memcpy(how.fill, fills[f / 2 % G_N_ELEMENTS(fills)], 3);
            memcpy(how.paper, papers[f / 2 / G_N_ELEMENTS(fills)], 3);
            g_autofree uint8_t *rgba = colours_of_amounts(&how);
            for (int i = 1; i < FL_AMOUNTS; i++)
                g_assert_cmpint(rgba[4 * i + 3], >=, rgba[4 * i - 1]);
            if (medium != FL_MEDIUM_TRANSPARENT)
                g_assert_cmpint(rgba[4 * FL_AMOUNT_ONE + 3], >=, 238);
        }
}

/** What paint of some alpha has become on its paper. */
static int on_paper(const uint8_t *rgba, const uint8_t *paper, int c)
{
    return (rgba[c] * rgba[3] + paper[c] * (255 - rgba[3]) + 127) / 255;
}

/* The colour of an amount of one where a pigment prevails by so much, over white. */
static void colour_of_play(const uint8_t fill[3], int play, uint8_t colour[3], uint8_t bare[3])
{
    g_autofree int8_t *plays = g_malloc(FL_AMOUNTS);
    memset(plays, play, FL_AMOUNTS);
    FlColouring how = {.paper = {255, 255, 255},
                       .medium = FL_MEDIUM_BODY,
                       .play = play ? plays : NULL,
                       .turn = {-.3f, 0, .4f},
                       .reach = {.5f, 1}};
    memcpy(how.fill, fill, 3);
    g_autofree uint8_t *rgba = colours_of_amounts(&how);
    memcpy(colour, rgba + 4 * FL_AMOUNT_ONE, 3);
    g_assert_cmpint(rgba[4 * FL_AMOUNT_ONE + 3], ==, 255);
    for (int c = 0; c < 3; c++)
        bare[c] = (uint8_t)(255 - (255 - rgba[c]) * rgba[3] / 255);
}

static void two_pigments_turn_the_hue(void)
{
    const uint8_t orange[3] = {240, 140, 30};
    uint8_t red[3], plain[3], green[3], bare[3];
    colour_of_play(orange, 64, red, bare);
    g_assert_true(bare[0] == 255 && bare[1] == 255 && bare[2] == 255);
    colour_of_play(orange, 0, plain, bare);
    colour_of_play(orange, -64, green, bare);
    g_assert_true(red[1] == plain[1] && green[1] == plain[1]);
    g_assert_true(red[0] == 255 && red[2] < plain[2] * 3 / 4);
    g_assert_true(green[0] < plain[0] * 9 / 10 && green[0] > plain[0] * 8 / 10);
    g_assert_cmpint(green[2], >, plain[2] * 11 / 10);
}

static void on_its_paper_every_medium_looks_the_same(void)
{
    for (size_t f = 0; f < G_N_ELEMENTS(fills) * G_N_ELEMENTS(papers); f++) {
        uint8_t *rgba[FL_MEDIUM_BODY + 1];
        FlColouring how = {0};
        memcpy(how.fill, fills[f % G_N_ELEMENTS(fills)], 3);
        memcpy(how.paper, papers[f / G_N_ELEMENTS(fills)], 3);
        for (int medium = FL_MEDIUM_TRANSPARENT; medium <= FL_MEDIUM_BODY; medium++) {
            how.medium = (FlMedium)medium;
            rgba[medium] = colours_of_amounts(&how);
        }
        for (int i = 0; i < 4 * FL_AMOUNTS; i += 4)
            for (int c = 0; c < 3; c++) {
                const int seen = on_paper(rgba[FL_MEDIUM_BODY] + i, how.paper, c);
                g_assert_cmpint(abs(on_paper(rgba[FL_MEDIUM_TRANSPARENT] + i, how.paper, c) - seen),
                                <=, 1);
                g_assert_cmpint(abs(on_paper(rgba[FL_MEDIUM_OPAQUE] + i, how.paper, c) - seen), <=,
                                1);
            }
        for (int medium = FL_MEDIUM_TRANSPARENT; medium <= FL_MEDIUM_BODY; medium++)
            g_free(rgba[medium]);
    }
}

/** A light grey figure, painted on cream, over a dark blue plate. */
static void light_paint_stands_over_a_dark_plate(void)
{
    const uint8_t plate[3] = {30, 42, 70};
    for (int medium = FL_MEDIUM_OPAQUE; medium <= FL_MEDIUM_BODY; medium++) {
        const FlColouring how = {
            .fill = {224, 224, 224}, .paper = {245, 240, 230}, .medium = (FlMedium)medium};
        g_autofree uint8_t *rgba = colours_of_amounts(&how);
        uint8_t seen[3];
        double lab[3];
        for (int c = 0; c < 3; c++)
            seen[c] = (uint8_t)on_paper(rgba + 4 * FL_AMOUNT_ONE, plate, c);
        delta_e_lab(seen, lab);
        g_test_message("medium %d: L* %.1f", medium, lab[0]);
        g_assert_cmpfloat(lab[0], >=, medium == FL_MEDIUM_OPAQUE ? 80 : 85);
    }
}

static void more_paint_never_looks_like_less(void)
{
    const char *const names[] = {"drop-30", "bloom-30"};
    for (int k = 0; k < 2; k++) {
        g_auto(Sample) s = sample_load(names[k]);
        g_autoptr(FlInk) ink = ink_of(&s, k ? bloom_paper : drop_paper);
        for (int tone = FL_EXPOSURE_MIN; tone <= FL_EXPOSURE_MAX; tone *= 2) {
            g_assert_cmpint(fl_ink_exposed(ink, 0, tone), ==, 0);
            for (int amount = 1; amount < FL_AMOUNTS; amount++)
                g_assert_cmpint(fl_ink_exposed(ink, amount, tone), >=,
                                fl_ink_exposed(ink, amount - 1, tone));
        }
        g_assert_cmpint(fl_ink_exposed(ink, FL_AMOUNT_ONE, FL_EXPOSURE_ONE), ==, FL_AMOUNT_ONE);
    }
}

static void a_line_too_thin_for_an_interior_gets_its_colour_too(void)
{
    enum { LENGTH = 90, WIDE = 2 };
    g_auto(Sample) s = sample_load("drop-30");
    g_autoptr(FlInk) ink = ink_of(&s, drop_paper);
    uint8_t painted[3 * LENGTH * WIDE], coverage[LENGTH * WIDE];
    for (int i = 0; i < LENGTH * WIDE; i++)
        memcpy(painted + 3 * i, (uint8_t[]){220, 180, 210}, 3); // thinner than the median
    memset(coverage, 200, sizeof coverage);
    const int amount = fl_ink_amount(ink, painted);
    const int tone = fl_ink_exposure(ink, painted, coverage, LENGTH, WIDE);
    g_assert_cmpint(amount, <, FL_AMOUNT_ONE / 2);
    g_assert_cmpint(abs(fl_ink_exposed(ink, amount, tone) - FL_AMOUNT_ONE), <, FL_AMOUNT_ONE / 50);
}

static void dense_cores_keep_texture_and_soft_rims_fade(void)
{
    g_auto(Sample) s = sample_load("drop-30");
    g_autoptr(FlInk) ink = ink_of(&s, drop_paper);
    const int core = fl_ink_exposed(ink, 5 * FL_AMOUNT_ONE, FL_EXPOSURE_ONE);
    const int rim = fl_ink_exposed(ink, FL_AMOUNT_ONE / 20, FL_EXPOSURE_ONE);
    g_assert_cmpint(core, >, 2 * FL_AMOUNT_ONE);
    g_assert_cmpint(core, <, 3 * FL_AMOUNT_ONE);
    g_assert_cmpint(rim, <, FL_AMOUNT_ONE / 40);
}

static void a_picture_of_one_colour_is_as_good_as_a_flat_fill(void)
{
    g_auto(Sample) s = sample_load("drop-30");
    g_autoptr(FlInk) ink = ink_of(&s, drop_paper);
    const size_t n = (size_t)s.width * s.height;
    g_autofree uint8_t *picture_rgba = g_malloc(4 * n);
    FlColouring how = {.fill = {12, 190, 77}, .paper = {250, 248, 240}};
    for (size_t i = 0; i < n; i++)
        memcpy(picture_rgba + 4 * i, (uint8_t[]){12, 190, 77, 255}, 4);
    g_autofree uint8_t *flat = paint(&s, ink, &how, 5000);
    how.picture = picture_rgba;
    g_autofree uint8_t *pixels = paint(&s, ink, &how, 5000);
    g_assert_cmpmem(flat, (int)(3 * n), pixels, (int)(3 * n));
}

static void the_exemplars_own_colours_are_kept_on_its_own_paper(void)
{
    g_auto(Sample) s = sample_load("drop-30");
    g_autoptr(FlInk) ink = ink_of(&s, drop_paper);
    FlColouring how = {.tint = FL_TINT_KEEP};
    memcpy(how.paper, drop_paper, 3);
    g_autofree uint8_t *rgb = paint(&s, ink, &how, FL_EXPOSURE_ONE);
    for (size_t i = 0; i < (size_t)s.width * s.height; i++)
        for (int c = 0; c < 3 && s.mask[i]; c++)
            g_assert_cmpint(abs(rgb[3 * i + c] - CLAMP(s.rgb[3 * i + c], 12, drop_paper[c])), <=,
                            s.rgb[3 * i + c] <= drop_paper[c] ? 1 : 255);
}

static void paint_of_the_papers_colour_is_an_error(void)
{
    g_autoptr(GError) error = NULL;
    const uint8_t rgb[6] = {200, 200, 200, 201, 200, 200}, mask[2] = {255, 255};
    g_assert_null(fl_ink_new((uint8_t[]){200, 200, 200}, rgb, mask, 2, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_STYLE);
}

static void paint_beyond_the_paper_is_counted(void)
{
    const uint8_t rgb[12] = {90, 80, 70, 90, 80, 70, 90, 80, 70, 250, 240, 200};
    const uint8_t mask[4] = {255, 255, 255, 255}, paper[3] = {200, 190, 180};
    g_autoptr(FlInk) mixed = fl_ink_new(paper, rgb, mask, 4, NULL);
    g_autoptr(FlInk) dark = fl_ink_new(paper, rgb, mask, 3, NULL);
    g_assert_cmpint(mixed->beyond, ==, 25);
    g_assert_cmpint(dark->beyond, ==, 0);
}

/** How far a value is from the middle between two integers. */
static double from_tie(double value)
{
    return fabs(value - floor(value) - 0.5);
}

static void no_table_entry_is_near_a_tie(void)
{
    double least = 1;
    for (int s = 1; s < 255; s++)
        least = fmin(least, from_tie(-log2(s / 255.0) * FL_DENSITY_ONE));
    for (int d = 64; d < FL_DENSITY_MAX; d += 64)
        least = fmin(least, from_tie(exp2(-(double)d / FL_DENSITY_ONE) * 255 * 256));
    for (int s = 1; s < 255; s++)
        least = fmin(least, from_tie(delta_e_light((uint8_t)s) * 65535));
    g_test_message("nearest: %g", least);
    g_assert_cmpfloat(least, >, 1e-6);
}

static void linear_light_goes_there_and_back(void)
{
    for (int s = 0; s < 256; s++)
        g_assert_cmpint(fl_srgb_from_linear(fl_srgb_to_linear((uint8_t)s)), ==, s);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/colourise/the-median-interior-colour-is-the-fill",
                    the_median_interior_colour_is_the_fill);
    g_test_add_func("/colourise/four-fifths-of-the-contrast-are-kept",
                    four_fifths_of_the_contrast_are_kept);
    g_test_add_func("/colourise/bare-paper-is-transparent-and-thin-paint-is-thin",
                    bare_paper_is_transparent_and_thin_paint_is_thin);
    g_test_add_func("/colourise/more-paint-never-hides-less", more_paint_never_hides_less);
    g_test_add_func("/colourise/two-pigments-turn-the-hue", two_pigments_turn_the_hue);
    g_test_add_func("/colourise/on-its-paper-every-medium-looks-the-same",
                    on_its_paper_every_medium_looks_the_same);
    g_test_add_func("/colourise/light-paint-stands-over-a-dark-plate",
                    light_paint_stands_over_a_dark_plate);
    g_test_add_func("/colourise/more-paint-never-looks-like-less",
                    more_paint_never_looks_like_less);
    g_test_add_func("/colourise/a-line-too-thin-for-an-interior-gets-its-colour-too",
                    a_line_too_thin_for_an_interior_gets_its_colour_too);
    g_test_add_func("/colourise/dense-cores-keep-texture-and-soft-rims-fade",
                    dense_cores_keep_texture_and_soft_rims_fade);
    g_test_add_func("/colourise/a-picture-of-one-colour-is-as-good-as-a-flat-fill",
                    a_picture_of_one_colour_is_as_good_as_a_flat_fill);
    g_test_add_func("/colourise/the-exemplars-own-colours-are-kept-on-its-own-paper",
                    the_exemplars_own_colours_are_kept_on_its_own_paper);
    g_test_add_func("/colourise/paint-of-the-papers-colour-is-an-error",
                    paint_of_the_papers_colour_is_an_error);
    g_test_add_func("/colourise/paint-beyond-the-paper-is-counted",
                    paint_beyond_the_paper_is_counted);
    g_test_add_func("/colourise/no-table-entry-is-near-a-tie", no_table_entry_is_near_a_tie);
    g_test_add_func("/colourise/linear-light-goes-there-and-back",
                    linear_light_goes_there_and_back);
    return g_test_run();
}
