/* Washes ride with their figures, are one where shapes of a fill touch, and keep the fill. */
#include "base/colour_difference.h"
#include "compose/background.h"
#include "compose/contacts.h"
#include "compose/gaps.h"
#include "compose/ink.h"
#include "compose/pigments.h"
#include "compose/wash_field.h"
#include "scratch.h"
#include "threads.h"
#include <math.h>

#define W 400
#define H 300
#define BARE -99.f // beyond all washes
#define DISC "<circle id='c' fill='#5bb7d8' cx='200' cy='150' r='140'/>"
#define BLOB                                                                                       \
    "<path fill='#5bb7d8' d='M-100 0 C-90 -90 70 -110 95 -20 C110 60 30 95 -20 90 C-80 85 -105 "   \
    "50 -100 0z'"

/* folder: an empty one, which must stay. */
static FlDrawing *open_film_by(FlRegionKey key, const char *folder, const char *const *frames)
{
    for (int t = 0; frames[t]; t++) {
        g_autofree char *name = g_strdup_printf("%d.svg", t + 1);
        g_autofree char *page =
            g_strdup_printf("<svg xmlns='http://www.w3.org/2000/svg' width='%d' "
                            "height='%d'>%s</svg>",
                            W, H, frames[t]);
        g_autofree char *path = g_build_filename(folder, name, NULL);
        g_assert_true(g_file_set_contents(path, page, -1, NULL));
    }
    const char *const inputs[] = {folder, NULL};
    const FlDrawingOptions options = {.frames = {inputs, 1, .missing = FL_MISSING_ERROR},
                                      .key = key};
    GError *error = NULL;
    FlDrawing *drawing = fl_drawing_open(&options, NULL, &error);
    g_assert_no_error(error);
    return drawing;
}

static FlDrawing *open_film(const char *folder, const char *const *frames)
{
    return open_film_by(FL_KEY_ID, folder, frames);
}

static FlBackground sheet = {.paper = {255, 255, 255}};

/* The ln of the factor on the amount of each pixel of a frame, BARE where there is no paint. */
typedef struct Tones {
    float tone[W * H];
    int8_t play[W * H];
} Tones;

static float paper_px = 1; // px of a page of 1000
static uint64_t film_seed = 1;

/* The recording's amounts are off by `uneven` to both sides of the fill's, line by line. */
static Tones *lay_frame_of(const FlDrawing *drawing, int frame, const FlWashStyle *style,
                           int uneven)
{
    const int n = fl_drawing_regions(drawing);
    FlRegionSettings settings;
    fl_region_settings_init(&settings);
    const FlStyleInstance instance = {.wash = *style, .front = {.width = 1}};
    g_autofree FlPaintedRegion *region = g_new0(FlPaintedRegion, n);
    g_autofree const FlPaintedRegion **painted = g_new0(const FlPaintedRegion *, n);
    g_autofree int *painted_of = g_new0(int, n);
    for (int r = 0; r < n; r++) {
        region[r] = (FlPaintedRegion){.region = r,
                                      .name = fl_drawing_region(drawing, r)->name,
                                      .settings = &settings,
                                      .style = &instance,
                                      .from = FL_FROM_ENGINE,
                                      .share = 1,
                                      .anchor = fl_drawing_anchor(drawing, r, frame),
                                      .drift = fl_drawing_drift(drawing, r, -1, frame, false)};
        region[r].n_limbs = fl_drawing_limbs(drawing, r, frame, region[r].limb);
        painted[r] = &region[r], painted_of[r] = r;
    }
    const FlComposeInput input = {.drawing = drawing,
                                  .background = &sheet,
                                  .painted_of = painted_of,
                                  .n_painted = n,
                                  .painted = painted,
                                  .seed = film_seed,
                                  .width = W,
                                  .height = H,
                                  .paper_px = paper_px};
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, frame, NULL);
    g_auto(FlWashes) washes = {0};
    g_assert_true(fl_washes_find(&washes, &input, draws, NULL));
    Tones *tones = g_new0(Tones, 1);
    for (int i = 0; i < W * H; i++)
        tones->tone[i] = BARE;
    for (int r = 0; r < draws->n; r++) {
        const FlWash *wash = fl_wash_of_draw(&washes, r);
        const FlArea *area = &draws->draw[r].area;
        const size_t pixels = fl_rect_pixels(area->box);
        g_autofree int16_t *amounts = g_new(int16_t, pixels);
        g_autofree int8_t *play = g_new0(int8_t, pixels);
        for (size_t i = 0; i < pixels; i++) {
            const int more = (int)i / area->box.width % 2 == 0 ? uneven : -uneven;
            amounts[i] = (int16_t)(draws->draw[r].coverage[i] ? 1024 + more : -1);
        }
        if (wash)
            fl_wash_lay(wash, 0, area, amounts, play);
        for (size_t i = 0; i < pixels; i++) {
            const int x = area->box.x + (int)i % area->box.width,
                      y = area->box.y + (int)i / area->box.width;
            if (draws->draw[r].coverage[i] < 128)
                continue;
            tones->tone[y * W + x] = logf((float)amounts[i] / 1024);
            tones->play[y * W + x] = play[i];
        }
    }
    fl_region_settings_clear(&settings);
    return tones;
}

static Tones *lay_frame(const FlDrawing *drawing, int frame, const FlWashStyle *style)
{
    return lay_frame_of(drawing, frame, style, 0);
}

/* The tones of a drawing of one frame. */
static Tones *lay_still(const char *shapes, const FlWashStyle *style, int uneven)
{
    const char *const frames[] = {shapes, NULL};
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing = open_film(folder, frames);
    return lay_frame_of(drawing, 0, style, uneven);
}

/* The mean tone of the painted pixels in a ring around a place. */
static double mean_in_ring(const Tones *tones, int x, int y, double from, double to)
{
    double n = 0, sum = 0;
    for (int i = 0; i < W * H; i++) {
        const double away = hypot(i % W - x, i / W - y);
        if (tones->tone[i] > BARE && away >= from && away < to)
            n++, sum += (double)tones->tone[i];
    }
    g_assert_cmpfloat(n, >, 0);
    return sum / n;
}

static const FlWashStyle plain = FL_WASH_DEFAULTS;

static int compare_floats(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Least, median and greatest tone of a frame. */
static void spread_of(const Tones *tones, float spread[3])
{
    g_autofree float *all = g_new(float, W *H);
    int n = 0;
    for (int i = 0; i < W * H; i++)
        if (tones->tone[i] > BARE)
            all[n++] = tones->tone[i];
    g_assert_cmpint(n, >, 0);
    qsort(all, (size_t)n, sizeof *all, compare_floats);
    spread[0] = all[n / 50], spread[1] = all[n / 2], spread[2] = all[n - 1 - n / 50];
}

static void the_fill_stays_the_fill(void)
{
    g_autofree Tones *tones = lay_still(BLOB " id='b' transform='translate(200 150)'/>", &plain, 0);
    float spread[3];
    spread_of(tones, spread);
    g_test_message("ln of amounts from %.2f, median %.2f, to %.2f", spread[0], spread[1],
                   spread[2]);
    g_assert_cmpfloat(fabsf(spread[1]), <, .11f); // 2.2 L*: the mean is kept
    g_assert_cmpfloat(spread[0], <, -.2f);
    g_assert_cmpfloat(spread[2], >, .2f);
    double upper = 0, lower = 0;
    for (int i = 0; i < W * H; i++)
        if (tones->tone[i] > BARE)
            *(i < W * H / 2 ? &upper : &lower) += (double)tones->tone[i];
    g_assert_cmpfloat(lower, >, upper); // the light comes from above
}

/* A ground as large as the page has puddles and hues, too. */
static void a_ground_is_uneven(void)
{
    float spread[3];
    double plays = 0;
    paper_px = .5f;
    g_autofree Tones *tones =
        lay_still("<rect id='g' fill='#5bb7d8' width='400' height='300'/>", &plain, 0);
    paper_px = 1;
    spread_of(tones, spread);
    for (int i = 0; i < W * H; i++)
        plays += abs(tones->play[i]) / (W * H * (double)FL_PLAY_ONE);
    g_test_message("ln of amounts from %.2f to %.2f, play %.2f", spread[0], spread[2], plays);
    g_assert_cmpfloat(spread[2] - spread[0], >, .8f);
    g_assert_cmpfloat(plays, >, .3);
}

/* Small shapes, each with a wash of its own: noise makes none darker as a whole, and the light
 * comes from above. */
static void each_of_many_fills_stays(void)
{
    g_autoptr(GString) page = g_string_new(NULL);
    for (int k = 0; k < 8; k++)
        g_string_append_printf(page, "<circle id='c%d' fill='#%02x80c0' cx='%d' cy='%d' r='42'/>",
                               k, 30 * k, 50 + 100 * (k % 4), 75 + 150 * (k / 4));
    const FlWashStyle even = {.wash = 1, .hue = 1};
    g_autofree Tones *tones = lay_still(page->str, &even, 0);
    double n[8] = {0}, tone[8] = {0}, play[8] = {0}, shadow[8] = {0};
    for (int i = 0; i < W * H; i++) {
        const int k = i % W / 100 + 4 * (i / W / 150);
        if (tones->tone[i] > BARE)
            n[k]++, tone[k] += (double)tones->tone[i], play[k] += tones->play[i],
                shadow[k] += (double)tones->tone[i] * (i / W % 150 < 75 ? -1 : 1);
    }
    for (int k = 0; k < 8; k++) {
        g_test_message("mean of ln %.3f, of play %.3f", tone[k] / n[k],
                       play[k] / n[k] / FL_PLAY_ONE);
        g_assert_cmpfloat(shadow[k] / n[k], >, .01);
        g_assert_cmpfloat(fabs(tone[k] / n[k]), <, .02);
        g_assert_cmpfloat(fabs(play[k] / n[k] / FL_PLAY_ONE), <, .3);
    }
}

/* More of light paint on dark paper is lighter, also where it is but 15 L* lighter. */
static void light_paint_has_its_light_above(void)
{
    static const uint8_t papers[][3] = {{28, 34, 48}, {107, 134, 149}};
    const FlWashStyle even = {.wash = 1};
    for (size_t k = 0; k < G_N_ELEMENTS(papers); k++) {
        memcpy(sheet.paper, papers[k], 3);
        g_autofree Tones *tones = lay_still(DISC, &even, 0);
        double above = 0, below = 0;
        for (int i = 0; i < W * H; i++)
            if (tones->tone[i] > BARE)
                *(i / W < H / 2 ? &above : &below) += (double)tones->tone[i];
        g_assert_cmpfloat(above, >, below);
    }
    sheet = (FlBackground){.paper = {255, 255, 255}};
}

/* A large and a small shape of one fill. */
static void shapes_apart_stay_each(void)
{
    const FlWashStyle even = {.wash = 1, .pool = 1};
    g_autofree Tones *tones =
        lay_still("<g fill='#5bb7d8'><circle id='a' cx='140' cy='120' r='110'/>"
                  "<circle id='b' cx='340' cy='240' r='40'/></g>",
                  &even, 0);
    const double large = mean_in_ring(tones, 140, 120, 0, 112);
    const double small = mean_in_ring(tones, 340, 240, 0, 42);
    g_test_message("mean of ln %.3f, %.3f", large, small);
    g_assert_cmpfloat(fabs(large), <, .02);
    g_assert_cmpfloat(fabs(small), <, .02);
}

/* The tone of the left half of a disc less that of the right one. */
static double leftwards(const FlDrawing *drawing, int frame, int x)
{
    static const FlWashStyle even = {.wash = 1};
    g_autofree Tones *tones = lay_frame(drawing, frame, &even);
    double half[2] = {0};
    for (int i = 0; i < W * H; i++)
        if (tones->tone[i] > BARE)
            half[i % W >= x] += (double)tones->tone[i];
    return (half[0] - half[1]) / (G_PI / 2 * 70 * 70);
}

/* A loop comes back to a frame without the region. */
static void paint_that_comes_later_in_a_loop_rests(void)
{
#define GROUND "<rect id='g' fill='#123456' width='9' height='9'/>"
#define LATER GROUND "<circle id='d' fill='#5bb7d8' cx='150' cy='150' r='70'/>"
    static const char *const frames[] = {GROUND, LATER, LATER, NULL};
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing = open_film(folder, frames);
    g_assert_cmpint(fl_drawing_regions(drawing), ==, 2);
    for (int t = 0; t < 3; t++)
        g_assert_cmpfloat(fl_drawing_drift(drawing, 1, -1, t, true).pace, ==, 0);
}

/* A disc moves to the right, and rests. */
static void paint_that_moves_is_dark_behind(void)
{
    enum { MOVES = 24, FRAMES = 42 };
    g_auto(GStrv) frames = g_new0(char *, FRAMES + 1);
    for (int t = 0; t < FRAMES; t++)
        frames[t] = g_strdup_printf("<circle id='d' fill='#5bb7d8' cx='%d' cy='150' r='70'/>",
                                    90 + 8 * MIN(t, MOVES));
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing = open_film(folder, (const char *const *)frames);
    g_assert_cmpfloat(fl_drawing_drift(drawing, 0, -1, 5, false).pace, >, 7.9f);
    g_assert_cmpfloat(fl_drawing_drift(drawing, 0, 0, 5, false).pace, ==, 0); // on moving paper
    const double moving = leftwards(drawing, 0, 90);
    double before = moving;
    for (int t = 1; t < FRAMES; t++) {
        const double now = leftwards(drawing, t, 90 + 8 * MIN(t, MOVES));
        g_assert_cmpfloat(fabs(now - before), <, .06); // it turns slowly
        before = now;
    }
    g_test_message("darker behind by %.2f ln, at rest by %.2f", moving, before);
    g_assert_cmpfloat(moving, >, .28);
    g_assert_cmpfloat(before, <, -.1);
    g_assert_cmpfloat(before, ==, leftwards(drawing, FRAMES - 2, 90 + 8 * MOVES));
}

static double correlation(const float *a, const float *b, int n)
{
    double sum[5] = {0};
    for (int i = 0; i < n; i++) {
        const double x = (double)a[i], y = (double)b[i];
        sum[0] += x, sum[1] += y, sum[2] += x * x, sum[3] += y * y, sum[4] += x * y;
    }
    return (sum[4] - sum[0] * sum[1] / n) /
           sqrt((sum[2] - sum[0] * sum[0] / n) * (sum[3] - sum[1] * sum[1] / n));
}

/* The correlation of two frames at the places of a figure that moves by (x, y) and turns. */
static double likeness(const Tones *first, const Tones *now, double x, double y, double degrees)
{
    const double c = cos(degrees * G_PI / 180), s = sin(degrees * G_PI / 180);
    g_autofree float *a = g_new(float, W *H), *b = g_new(float, W *H);
    int n = 0;
    for (int i = 0; i < W * H; i++) {
        const double dx = i % W - 120, dy = i / W - 150;
        const int u = (int)lrint(120 + x + c * dx - s * dy),
                  v = (int)lrint(150 + y + s * dx + c * dy);
        if (u < 0 || u >= W || v < 0 || v >= H || first->tone[i] <= BARE ||
            now->tone[v * W + u] <= BARE)
            continue;
        a[n] = first->tone[i], b[n++] = now->tone[v * W + u];
    }
    return correlation(a, b, n);
}

static void it_rides_with_its_figure(void)
{
    enum { FRAMES = 24 };
    g_auto(GStrv) frames = g_new0(char *, FRAMES + 1);
    for (int t = 0; t < FRAMES; t++)
        frames[t] = g_strdup_printf(BLOB " id='b' transform='translate(%.2f %.2f) rotate(%.2f)'/>",
                                    120 + 7.0 * t, 150 + .7 * t, -.5 * t);
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing = open_film(folder, (const char *const *)frames);
    const FlWashStyle lines = {.wash = 1, .passes = 1, .tide = 1};
    g_autofree Tones *first = lay_frame(drawing, 0, &lines);
    for (int t = 1; t < FRAMES; t += 11) {
        g_autofree Tones *now = lay_frame(drawing, t, &lines);
        const double along = likeness(first, now, 7.0 * t, .7 * t, -.5 * t);
        const double page = likeness(first, now, 0, 0, 0);
        g_test_message("frame %d: correlation %.3f along the figure, %.3f on the page", t, along,
                       page);
        g_assert_cmpfloat(along, >, .95);
        g_assert_cmpfloat(along, >, page);
    }
}

enum { LEG_W = 70, LEG_H = 100 };

/* The tones of a frame of a seed, less those of the next: without light and shadow, which do not
 * turn with a limb. */
static Tones *lay_without_light(const FlDrawing *drawing, int frame, const FlWashStyle *style,
                                uint64_t seed)
{
    film_seed = seed;
    Tones *tones = lay_frame(drawing, frame, style);
    film_seed = seed + 1;
    g_autofree Tones *other = lay_frame(drawing, frame, style);
    film_seed = 1;
    for (int i = 0; i < W * H; i++)
        tones->tone[i] -= other->tone[i];
    return tones;
}

/* A leg of 200 by 90 px turns about its upper end at (200, 60), below a body of its fill. */
static void a_limb_carries_its_own(void)
{
    enum { FRAMES = 8 };
    g_auto(GStrv) frames = g_new0(char *, FRAMES + 1);
    for (int t = 0; t < FRAMES; t++)
        frames[t] =
            g_strdup_printf("<g fill='#5bb7d8'><rect x='20' y='10' width='360' height='50'/>"
                            "<rect x='-45' width='90' height='200' "
                            "transform='translate(200 60) rotate(%d)'/></g>",
                            5 * t);
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing = open_film_by(FL_KEY_FILL, folder, (const char *const *)frames);
    FlLimb limb[FL_LIMBS];
    g_assert_cmpint(fl_drawing_regions(drawing), ==, 1);
    g_assert_cmpint(fl_drawing_limbs(drawing, 0, FRAMES - 1, limb), ==, 2);
    const FlWashStyle lines = {.wash = 1, .passes = 1, .tide = 1};
    const double angle = 5 * (FRAMES - 1) * G_PI / 180, c = cos(angle), s = sin(angle);
    float a[2 * LEG_W * LEG_H], b[2 * LEG_W * LEG_H], same[2 * LEG_W * LEG_H];
    int n = 0;
    for (uint64_t seed = 1; seed <= 3; seed += 2) {
        g_autofree Tones *first = lay_without_light(drawing, 0, &lines, seed);
        g_autofree Tones *last = lay_without_light(drawing, FRAMES - 1, &lines, seed);
        for (int y = 80; y < 80 + LEG_H; y++)
            for (int x = -LEG_W / 2; x < LEG_W / 2; x++, n++) {
                const int u = (int)lrint(200 + c * x - s * y), v = (int)lrint(60 + s * x + c * y);
                a[n] = first->tone[(60 + y) * W + 200 + x];
                b[n] = last->tone[v * W + u];
                same[n] = last->tone[(60 + y) * W + 200 + x];
            }
    }
    const double along = correlation(a, b, n), page = correlation(a, same, n);
    g_test_message("correlation %.3f along the limb, %.3f on the page", along, page);
    g_assert_cmpfloat(along, >, .7);
    g_assert_cmpfloat(page, <, .35);
}

/* The loops that a line encloses cancel, so that its middle says little of where it is. */
static void all_of_a_limb_has_its_wash(void)
{
    g_auto(GStrv) frames = g_new0(char *, 3);
    for (int t = 0; t < 2; t++)
        frames[t] =
            g_strdup_printf("<g fill='#5bb7d8' stroke='#5bb7d8'><path fill='none' stroke-width='40'"
                            " d='M30 150L130 90L230 150L310 200L380 150'/>"
                            "<rect stroke='none' x='%d' y='220' width='60' height='60'/></g>",
                            20 + 20 * t);
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing = open_film_by(FL_KEY_FILL, folder, (const char *const *)frames);
    FlLimb limb[FL_LIMBS];
    g_assert_cmpint(fl_drawing_limbs(drawing, 0, 1, limb), ==, 2);
    const FlWashStyle hues = {.wash = 1, .hue = 1};
    g_autofree Tones *tones = lay_frame(drawing, 1, &hues);
    int least = 127, most = -128;
    for (int x = 300; x < 340; x++) {
        least = MIN(least, tones->play[190 * W + x]);
        most = MAX(most, tones->play[190 * W + x]);
    }
    g_test_message("play from %d to %d", least, most);
    g_assert_cmpint(most, >, least + 4);
}

/* The mean tone along a pass of the brush, that is dry where its edge is crisp. */
static float tone_along_pass(float pass, bool crisp)
{
    enum { N = 256 };
    FlWash wash = {.style = {.wash = 1, .passes = 1},
                   .key = 1,
                   .brush_px = 80,
                   .along = {1, 0},
                   .width = N,
                   .height = 1};
    g_autofree float *planes = g_new0(float, FL_WASH_PLANES *N);
    float tones[N], hues[N], sum = 0;
    for (int k = 0; k < FL_WASH_PLANES; k++)
        wash.plane[k] = planes + (size_t)k * N;
    for (int i = 0; i < N; i++) {
        wash.plane[FL_WASH_PASS][i] = pass, wash.plane[FL_WASH_LINES][i] = 1;
        wash.plane[FL_WASH_DRY][i] = crisp ? 1 : -1;
        wash.plane[FL_WASH_X][i] = 12.5f * (float)i;
    }
    fl_wash_find_tones(&wash, tones, hues);
    for (int i = 0; i < N; i++)
        sum += tones[i] / N;
    return sum;
}

/* The paint of a large cut-out reaches far beyond its shape. */
static void beside_a_wash_all_is_as_at_its_rim(void)
{
    enum { N = 3000, STEP = 5 };
    float one[4] = {1, 1, 1, 1}, zero[4] = {0};
    FlWash wash = {.style = {.wash = 1},
                   .key = 1,
                   .brush_px = 80,
                   .box = {N - 60, 20, STEP, STEP},
                   .step = STEP,
                   .width = 2,
                   .height = 2};
    for (int k = 0; k < FL_WASH_PLANES; k++)
        wash.plane[k] = k == FL_WASH_HUE ? one : zero;
    int16_t amounts[N];
    int8_t play[N];
    FlColumns row = {0, N};
    const FlArea area = {{3, 7, N, 1}, &row};
    for (int x = 0; x < N; x++)
        amounts[x] = 1000, play[x] = 99;
    fl_wash_lay(&wash, 0, &area, amounts, play);
    for (int x = 0; x < N; x++) {
        g_assert_cmpint(play[x], ==, FL_PLAY_ONE);
        g_assert_cmpint(amounts[x], ==, 1000);
    }
}

/* White is bare paper where it was painted, and nothing between the bristles of its rim, where it
 * would be an even border; thin paint there is no thicker on the dark side. A quarter of the fill
 * is bare already: half of it is lighter than white, and would be a bright outline. */
static void white_ends_where_its_paint_ends(void)
{
    enum { STEP = 5 };
    float dark[4] = {.5f, .5f, .5f, .5f}, zero[4] = {0};
    FlWash wash = {.style = {.wash = 1},
                   .key = 1,
                   .brush_px = 80,
                   .box = {0, 0, STEP, STEP},
                   .step = STEP,
                   .width = 2,
                   .height = 2};
    for (int k = 0; k < FL_WASH_PLANES; k++)
        wash.plane[k] = k == FL_WASH_TONE ? dark : zero;
    int16_t amounts[] = {0, 100, 900, 256};
    int8_t play[] = {99, 99, 99, 99};
    FlColumns row = {0, 4};
    const FlArea area = {{0, 0, 4, 1}, &row};
    fl_wash_lay(&wash, 1, &area, amounts, play);
    g_assert_cmpint(amounts[0], ==, 0);
    g_assert_cmpint(amounts[1], ==, 100);
    g_assert_cmpint(amounts[2], >, 900);
    g_assert_cmpint(amounts[3], >, 900);
    g_assert_cmpint(play[2], >, 20);
}

/* Where the edge of a pass grows wide, the tone beside it hardly changes: a crisp stretch is no
 * patch with ends. */
static void edges_of_passes_are_lost_in_their_place(void)
{
    float lost = 0, between = 0;
    for (int k = 0; k < 40; k++) {
        const float at = (float)k - .3f;
        lost += fabsf(tone_along_pass(at, false) - tone_along_pass(at, true));
        between += fabsf(tone_along_pass(at + .5f, true) - tone_along_pass(at - .5f, true));
    }
    g_test_message("%.2f of %.2f", lost, between);
    g_assert_cmpfloat(lost, <, .2f * between);
}

static void still_figures_do_not_change(void)
{
    const char *const still = BLOB " id='still' transform='translate(120 150)'/>";
    g_auto(GStrv) frames = g_new0(char *, 4);
    for (int t = 0; t < 3; t++)
        frames[t] = g_strdup_printf("%s<circle id='over' fill='#c03020' cx='%d' cy='150' r='50'/>",
                                    still, 40 + 60 * t);
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing = open_film(folder, (const char *const *)frames);
    g_autofree Tones *first = lay_frame(drawing, 0, &plain);
    g_autofree Tones *last = lay_frame(drawing, 2, &plain);
    int n = 0;
    for (int i = 0; i < W * H; i++) {
        const int x = i % W, y = i / W;
        const bool over = hypot(x - 40, y - 150) < 53 || hypot(x - 160, y - 150) < 53;
        if (over || first->tone[i] <= BARE)
            continue;
        g_assert_cmpfloat(first->tone[i], ==, last->tone[i]);
        g_assert_cmpint(first->play[i], ==, last->play[i]);
        n++;
    }
    g_assert_cmpint(n, >, 5000);
}

/* The mean step of tone over the points on both sides of a seam at x, without the slope beside it.
 */
static double step_at(const Tones *tones, int x)
{
    double sum = 0;
    for (int y = 60; y < 210; y++) {
        const float *row = tones->tone + y * W;
        sum += (double)fabsf(row[x + 4] - row[x - 5] -
                             .5f * (row[x + 13] - row[x + 4] + row[x - 5] - row[x - 14]));
    }
    return sum / 150;
}

/* How much larger that step is at a seam than amid the shapes beside it, which have lines. */
static double seam_at(const Tones *tones, int x)
{
    double beside = 0;
    for (int k = 1; k <= 4; k++)
        beside += step_at(tones, x - 25 * k) + step_at(tones, x + 25 * k);
    return step_at(tones, x) - beside / 8;
}

static void touching_shapes_of_one_fill_are_one_wash(void)
{
    const char *const one[] = {
        "<rect id='a' fill='#5bb7d8' x='50' y='50' width='150' height='200'/>"
        "<rect id='b' fill='#5bb7d8' x='200' y='50' width='150' height='200'/>",
        NULL};
    const char *const two[] = {
        "<rect id='a' fill='#5bb7d8' x='50' y='50' width='150' height='200'/>"
        "<rect id='b' fill='#c03020' x='200' y='50' width='150' height='200'/>",
        NULL};
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(Scratch) folder_of_two = scratch_make();
    g_autoptr(FlDrawing) same = open_film(folder, one);
    g_autoptr(FlDrawing) other = open_film(folder_of_two, two);
    g_assert_cmpint(fl_drawing_regions(same), ==, 2);
    g_autofree Tones *a = lay_frame(same, 0, &plain), *b = lay_frame(other, 0, &plain);
    g_test_message("step of ln: %.3f within a fill, %.3f between fills; at the seam %.3f, %.3f",
                   step_at(a, 200), step_at(b, 200), seam_at(a, 200), seam_at(b, 200));
    g_assert_cmpfloat(step_at(a, 200), <, .06);
    g_assert_cmpfloat(step_at(b, 200), >, .1);
    g_assert_cmpfloat(seam_at(a, 200), <, .03);
    g_assert_cmpfloat(seam_at(b, 200), >, .1);
}

/* A gradient is mixed of the pigments of the body that it goes over into, unless a config gives it
 * a colour. */
static void a_gradient_has_the_fill_of_its_body(void)
{
    const char *const frames[] = {
        "<linearGradient id='g'><stop stop-color='#fdae5f'/><stop offset='1' stop-color='#123'/>"
        "</linearGradient><rect id='body' fill='#fdae5f' width='90' height='90'/>"
        "<rect id='neck' fill='url(#g)' x='90' width='90' height='90'/>",
        NULL};
    const uint8_t body[] = {0xfd, 0xae, 0x5f};
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing = open_film(folder, frames);
    const FlComposeInput input = {.drawing = drawing};
    for (int r = 0; r < 2; r++) {
        FlRegionSettings settings = {.colour = {1, 2, 3}};
        const FlPaintedRegion painted = {.region = r, .settings = &settings};
        g_assert_cmpmem(fl_fill_of_film(&input, &painted), 3, body, 3);
        settings.has_colour = true;
        g_assert_cmpmem(fl_fill_of_film(&input, &painted), 3, settings.colour, 3);
    }
}

enum { ROW = 201 };

/* The tones at a row of points that differ in one or two of the slow fields. */
typedef struct Row {
    FlWash wash;
    float values[FL_WASH_PLANES][ROW], tones[ROW], hues[ROW];
} Row;

static void find_row(Row *row)
{
    row->wash = (FlWash){.style = {.wash = 1, .tide = 1, .passes = 1},
                         .brush_px = 50,
                         .along = {1},
                         .width = ROW,
                         .height = 1};
    for (int k = 0; k < FL_WASH_PLANES; k++)
        row->wash.plane[k] = row->values[k];
    fl_wash_find_tones(&row->wash, row->tones, row->hues);
}

static float most_step(const Row *row)
{
    float most = 0;
    for (int i = 1; i < ROW; i++)
        most = MAX(most, fabsf(row->tones[i] - row->tones[i - 1]));
    return most;
}

/* Paint that water carried lies beyond the place where it stopped, also where the edge is lost. */
static void a_front_parts_two_tones(void)
{
    for (int found = 0; found < 2; found++) {
        Row row = {0};
        for (int i = 0; i < ROW; i++) {
            row.values[FL_WASH_FRONT][i] = (float)(i - ROW / 2);
            row.values[FL_WASH_FRONTS][i] = (float)found, row.values[FL_WASH_LINES][i] = 1;
        }
        find_row(&row);
        g_assert_cmpfloat(row.tones[ROW - 1] - row.tones[0], >, .2f);
        g_assert_true(found ? most_step(&row) > .05f : most_step(&row) < .01f);
    }
}

/* Of a front, the flooded side is crisp where the brush was dry and soft where it was wet, and
 * paint lies for long beyond the line; far from it nothing ends in a line of its own. */
static void a_front_is_soft_in_wet_paint(void)
{
    double before[2] = {0}, beyond[2] = {0}, line[2] = {0}, wet[ROW] = {0};
    for (int dry = 0; dry < 2; dry++)
        for (int along = 0; along < 200; along++) {
            Row row = {0};
            for (int i = 0; i < ROW; i++) {
                row.values[FL_WASH_FRONT][i] = (float)(i - ROW / 2);
                row.values[FL_WASH_FRONTS][i] = 1, row.values[FL_WASH_X][i] = 7 * (float)along;
                row.values[FL_WASH_DRY][i] = dry ? 1 : -1;
            }
            find_row(&row);
            before[dry] += (double)row.tones[ROW / 2 - 5];
            line[dry] += (double)row.tones[ROW / 2 + 2],
                beyond[dry] += (double)row.tones[ROW / 2 + 20];
            for (int i = 0; i < ROW && !dry; i++)
                wet[i] += (double)row.tones[i] / 200;
        }
    g_test_message("5 px before the line %.3f and %.3f, on it %.3f, 20 px beyond %.3f",
                   before[0] / 200, before[1] / 200, line[0] / 200, beyond[0] / 200);
    g_assert_cmpfloat(before[0], >, 2 * before[1]);
    g_assert_cmpfloat(beyond[0], >, .15 * line[0]);
    for (int i = 1; i < ROW; i++)
        if (i < ROW / 2 - 10 || i > ROW / 2 + 50)
            g_assert_cmpfloat(fabs(wet[i] - wet[i - 1]), <, .012);
}

/* Along a front, teeth of uneven length run on the way of the water, and none back. */
static void fronts_have_teeth(void)
{
    static const struct {
        float away;
        bool uneven;
    } rows[] = {{10, true}, {-9, false}, {60, false}};
    for (size_t k = 0; k < 2 * G_N_ELEMENTS(rows); k++) {
        const int passes = k % 2; // whose hairs are faint where the brush is wet
        Row row = {0};
        for (int i = 0; i < ROW; i++) {
            row.values[FL_WASH_FRONT][i] = rows[k / 2].away, row.values[FL_WASH_FRONTS][i] = 1;
            row.values[FL_WASH_LINES][i] = (float)passes, row.values[FL_WASH_X][i] = (float)i;
        }
        find_row(&row);
        const float step = most_step(&row), least = passes ? .02f : .01f;
        g_test_message("row %zu: step %.3f", k / 2, (double)step);
        g_assert_true(rows[k / 2].uneven ? step > .03f : step < least);
    }
}

/* Wet passes of the brush go over into each other without a step, and slopes of the tone are
 * ragged. */
static void passes_are_soft_and_slopes_ragged(void)
{
    for (int rough = 0; rough < 2; rough++) {
        Row row = {0};
        for (int i = 0; i < ROW; i++) {
            row.values[FL_WASH_PASS][i] = (float)i / 50, row.values[FL_WASH_LINES][i] = 1;
            row.values[FL_WASH_X][i] = (float)i, row.values[FL_WASH_DRY][i] = -1;
            row.values[FL_WASH_FRONT][i] = 1000, row.values[FL_WASH_ROUGH][i] = .2f * (float)rough;
        }
        find_row(&row);
        g_test_message("steps up to %.3f", (double)most_step(&row));
        g_assert_true(rough ? most_step(&row) > .06f : most_step(&row) < .04f);
    }
}

/* The ragged edge of a dry pass, at a row of points along it. */
static void dry_passes_have_ragged_edges(void)
{
    Row row = {0};
    for (int i = 0; i < ROW; i++) {
        row.values[FL_WASH_PASS][i] = .985f, row.values[FL_WASH_LINES][i] = 1;
        row.values[FL_WASH_X][i] = (float)i, row.values[FL_WASH_DRY][i] = 1;
        row.values[FL_WASH_FRONT][i] = 1000;
    }
    find_row(&row);
    g_test_message("steps up to %.3f", (double)most_step(&row));
    g_assert_cmpfloat(most_step(&row), >, .05f);
}

/* The changes of the tone on a way of 17 px amid a pass, across it or along. */
static float changes_amid_pass(float dry, bool across)
{
    Row row = {0};
    float sum = 0;
    for (int i = 0; i < ROW; i++) {
        const float way = 17 * (float)i / ROW;
        row.values[FL_WASH_PASS][i] = .1f + (across ? way / 50 : 0);
        row.values[FL_WASH_X][i] = across ? 0 : way, row.values[FL_WASH_DRY][i] = dry;
        row.values[FL_WASH_FRONT][i] = 1000, row.values[FL_WASH_LINES][i] = 1;
    }
    find_row(&row);
    for (int i = 1; i < ROW; i++)
        sum += fabsf(row.tones[i] - row.tones[i - 1]);
    return sum;
}

static void hairs_of_a_dry_brush_draw_streaks(void)
{
    const float streaks = changes_amid_pass(1, true), wet = changes_amid_pass(-1, true);
    const float along = changes_amid_pass(1, false);
    g_test_message("the tone changes by %.3f across, %.3f along, %.3f where it is wet",
                   (double)streaks, (double)along, (double)wet);
    g_assert_cmpfloat(streaks, >, .1f);
    g_assert_cmpfloat(along, <, .3f * streaks);
    g_assert_cmpfloat(wet, <, .5f * streaks); // faint ones
}

/* Along the rows and down the columns of 1600 px of a wash, the brush turns from wet to dry or back
 * about every 130 px: once in a stroke. */
static void strokes_stay_dry_for_their_length(void)
{
    enum { POINTS = 200, ALL = POINTS * POINTS, STEP = 8 };
    g_autofree float *memory = g_new0(float, (FL_WASH_PLANES + FL_WASH_ROOMS + 4) * ALL);
    float *mask = memory + (FL_WASH_PLANES + FL_WASH_ROOMS) * ALL;
    FlWash wash = {
        .key = 7, .brush_px = 50, .along = {1}, .step = STEP, .width = POINTS, .height = POINTS};
    FlWashPart part = {.anchor = {.cosine = 1}};
    FlWashField field = {.wash = &wash,
                         .input = &(FlComposeInput){.paper_px = 1},
                         .part = &part,
                         .n_parts = 1,
                         .mask = mask,
                         .turned = mask + ALL};
    for (int k = 0; k < FL_WASH_PLANES; k++)
        wash.plane[k] = memory + k * ALL;
    for (int k = 0; k < FL_WASH_ROOMS; k++)
        field.room[k] = memory + (FL_WASH_PLANES + k) * ALL;
    for (int i = 0; i < ALL; i++)
        mask[i] = 1;
    fl_field_fill_noise(&field);
    const float *dry = wash.plane[FL_WASH_DRY];
    int turns = 0;
    for (int i = 0; i < ALL; i++) {
        turns += i % POINTS > 0 && (dry[i] > 0) != (dry[i - 1] > 0);
        turns += i >= POINTS && (dry[i] > 0) != (dry[i - POINTS] > 0);
    }
    const double length = 2. * STEP * ALL / turns;
    double bends = 0; // of the brush's way across, as a share of the way along
    for (int i = 1; i < ALL; i++)
        if (i % POINTS > 0)
            bends += pow(
                50 * (double)(wash.plane[FL_WASH_PASS][i] - wash.plane[FL_WASH_PASS][i - 1]) / STEP,
                2);
    bends = sqrt(bends / ALL);
    g_test_message("the brush turns dry or wet every %.0f px; its way has slopes of %.2f", length,
                   bends);
    g_assert_true(length > 110 && length < 160);
    g_assert_cmpfloat(bends, <, .15); // a hand's, not a marbled paper's
}

/* Parts of a fill that move apart: no line where one's wash passes into the other's. */
static void parts_that_move_apart_are_mixed(void)
{
    const char *const frames[] = {
        "<rect id='a' fill='#5bb7d8' x='50' y='50' width='150' height='200'/>"
        "<rect id='b' fill='#5bb7d8' x='200' y='50' width='150' height='200'/>",
        "<rect id='a' fill='#5bb7d8' x='50' y='50' width='150' height='200'/>"
        "<rect id='b' fill='#5bb7d8' x='200' y='20' width='150' height='200'/>",
        NULL};
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing = open_film(folder, frames);
    g_autofree Tones *tones = lay_frame(drawing, 1, &plain);
    g_test_message("step of ln: %.3f, at the seam %.3f", step_at(tones, 200), seam_at(tones, 200));
    g_assert_cmpfloat(step_at(tones, 200), <, .05);
    g_assert_cmpfloat(seam_at(tones, 200), <, .03);
}

static void dots_and_lines_have_none(void)
{
    g_autofree Tones *tones =
        lay_still("<circle id='dot' fill='#5bb7d8' cx='60' cy='60' r='7'/>"
                  "<rect id='line' fill='#5bb7d8' x='20' y='200' width='350' height='6'/>",
                  &plain, 0);
    float spread[3];
    spread_of(tones, spread);
    g_assert_cmpfloat(spread[2] - spread[0], <, .02f);
}

/* Where calm is, the step between lines goes; at the rim it stays in places and is lost in others.
 */
static void a_calm_wash_keeps_some_of_the_rim(void)
{
    const FlWashStyle calm = {.wash = 1, .calm = 1};
    g_autofree Tones *tones = lay_still(DISC, &calm, 200);
    int middle = 0, even = 0, rim = 0, found = 0, lost = 0;
    for (int y = 11; y < H - 11; y++)
        for (int x = 60; x < W - 60; x++) {
            const double depth = 140 - hypot(x - 200, y - 150);
            const float step = fabsf(tones->tone[y * W + x] - tones->tone[(y + 1) * W + x]);
            if (depth > 3 && depth < 5)
                rim++, found += step > .3f, lost += step < .1f; // ln(1224 / 824) is .4
            if (depth > 35)
                middle++, even += step < .1f;
        }
    g_test_message("of the rim %d/%d are found, %d lost; of the middle %d/%d are even", found, rim,
                   lost, even, middle);
    g_assert_cmpint(found, >, rim / 10);
    g_assert_cmpint(lost, >, rim / 10);
    g_assert_cmpint(even, >, 99 * middle / 100);
}

static void a_heart_is_light(void)
{
    const FlWashStyle style = {.wash = 1, .heart = 1};
    g_autofree Tones *tones = lay_still(DISC, &style, 0);
    const double rim = mean_in_ring(tones, 200, 150, 110, 135);
    const double middle = mean_in_ring(tones, 200, 150, 0, 60);
    g_test_message("mean of ln near the rim %.3f, in the middle %.3f", rim, middle);
    g_assert_cmpfloat(rim, >, .1);
    g_assert_cmpfloat(middle, <, -.1);
}

/* The pixels that drops make lighter, and darker, on eight pages of fills a step apart. */
static void count_spots(int fill, int step, int *light, int *dark)
{
    static const FlWashStyle wet = {.wash = 1, .blooms = 1}, even = {.wash = 1};
    for (int k = 0; k < 8; k++) {
        g_autofree char *page =
            g_strdup_printf("<path fill='#%06x' d='M0 0h400v300h-400z'/>", fill + k * step);
        g_autofree Tones *drops = lay_still(page, &wet, 0), *none = lay_still(page, &even, 0);
        for (int i = 0; i < W * H; i++) {
            *light += drops->tone[i] < none->tone[i] - .08f;
            *dark += drops->tone[i] > none->tone[i] + .08f;
        }
    }
}

/* Drops fall into some of eight pages: of water, which is light within its rim, and of paint. */
static void drops_leave_light_and_dark_spots(void)
{
    int light = 0, dark = 0, light_in_white = 0, dark_in_white = 0;
    count_spots(0x0080c0, 0x1e0000, &light, &dark);
    count_spots(0xffffff, -1, &light_in_white, &dark_in_white);
    g_test_message("%d px are lighter, %d darker; %d and %d in white", light, dark, light_in_white,
                   dark_in_white);
    g_assert_cmpint(light, >, 10000);
    g_assert_cmpint(dark, >, 3000);
    g_assert_cmpint(dark_in_white, <, dark / 2); // paint would look like dirt
}

static void threads_and_parts_do_not_matter(void)
{
    const char *const frames[] = {BLOB " id='b' transform='translate(180 150)'/>"
                                       "<circle id='c' fill='#c03020' cx='330' cy='90' r='60'/>",
                                  NULL};
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing = open_film(folder, frames);
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    g_autofree Tones *one = lay_frame(drawing, 0, &plain);
    omp_set_num_threads(3);
    g_autofree Tones *three = lay_frame(drawing, 0, &plain);
    omp_set_num_threads(threads);
    g_assert_cmpmem(one->tone, sizeof one->tone, three->tone, sizeof three->tone);
    g_assert_cmpmem(one->play, sizeof one->play, three->play, sizeof three->play);
}

/* ---- gaps ------------------------------------------------------------------------------------ */

#define BOX_PX 80

/* A square of full paint at (x, 40), whose edges are off. */
static FlLayer square_off(int x, float strength)
{
    enum { N = BOX_PX * BOX_PX };
    uint8_t *coverage = malloc(N);
    FlLayer layer = {.area = {{x, 40, BOX_PX, BOX_PX}, NULL},
                     .coverage = coverage,
                     .owns_coverage = true,
                     .knockout = malloc(N),
                     .rgba = malloc(4 * N),
                     .alpha = 255};
    memset(coverage, 255, N);
    memset(layer.knockout, 255, N);
    memset(layer.rgba, 200, 4 * N);
    const FlGaps gaps = {strength, 7, {.x = (float)x + 40, .y = 80, .cosine = 1}, 1};
    g_assert_true(fl_layer_open_gaps(&layer, &gaps, (FlRect){0, 0, W, H}, NULL));
    return layer;
}

static void layer_free(FlLayer *layer)
{
    free(layer->rgba);
    free(layer->knockout);
    free((uint8_t *)layer->coverage);
}

static void edges_are_off_by_a_hair(void)
{
    FlLayer layer = square_off(60, 1), moved = square_off(97, 1), same = square_off(60, 0);
    const FlRect box = layer.area.box, own = {60, 40, BOX_PX, BOX_PX};
    int beyond = 0, bare = 0;
    g_assert_cmpint(same.area.box.width, ==, BOX_PX);
    for (int y = 0; y < box.height; y++)
        for (int x = 0; x < box.width; x++) {
            const size_t p = (size_t)y * (size_t)box.width + (size_t)x;
            const FlRect here = {box.x + x, box.y + y, 1, 1};
            const bool inside = fl_rect_meet(here, own);
            const bool deep = fl_rect_is_inside(fl_rect_grown(here, 2, (FlRect){0, 0, W, H}), own);
            g_assert_true(!deep || layer.coverage[p] == 255);
            bare += inside && layer.coverage[p] < 128;
            beyond += !inside && layer.coverage[p] > 128;
            g_assert_true(inside || layer.knockout[p] == 0); // what it overlaps shows through
            g_assert_true(layer.coverage[p] == 0 || layer.rgba[4 * p] == 200);
        }
    g_test_message("%d px are bare, %d overlap", bare, beyond);
    g_assert_cmpint(bare, >, 20);
    g_assert_cmpint(beyond, >, 20);
    g_assert_cmpint(moved.area.box.x, ==, box.x + 37);
    const int pixels = box.width * box.height;
    g_assert_cmpmem(layer.coverage, pixels, moved.coverage, pixels);
    layer_free(&layer);
    layer_free(&moved);
    layer_free(&same);
}

/* ---- pigments -------------------------------------------------------------------------------- */

static void pigments_mix_to_the_fill(void)
{
    static const uint8_t fills[][3] = {{0x4f, 0x9d, 0x3f}, {0xe0, 0xca, 0xb1}, {0x84, 0x83, 0x83},
                                       {0xb0, 0x4e, 0xba}, {0x5b, 0xb7, 0xd8}, {0xa4, 0x63, 0x40}};
    for (size_t k = 0; k < G_N_ELEMENTS(fills); k++) {
        const FlMixture mixture = fl_mixture_of(fills[k]), again = fl_mixture_of(fills[k]);
        const float off = fl_colour_difference(fills[k], mixture.rgb);
        g_test_message("%s and %s: off by %.1f", mixture.pigment[0]->name, mixture.pigment[1]->name,
                       (double)off);
        g_assert_cmpfloat(off, <, 12);
        g_assert_cmpmem(&mixture, sizeof mixture, &again, sizeof again);
    }
}

/* A colour beyond all paint becomes the nearest of paint: pure green is 5dbc35 or so. */
static void fills_beyond_paint_become_paint(void)
{
    const uint8_t green[3] = {0, 255, 0};
    const FlMixture mixture = fl_mixture_of(green);
    g_assert_true(mixture.rgb[0] > 40 && mixture.rgb[1] < 220 && mixture.rgb[1] > 150);
}

static void the_hue_turns_and_most_light_stays(void)
{
    static const uint8_t fills[][3] = {{0x4f, 0x9d, 0x3f}, {0xfd, 0xae, 0x5f}, {0x5b, 0xb7, 0xd8}};
    for (size_t k = 0; k < G_N_ELEMENTS(fills); k++) {
        const FlMixture mixture = fl_mixture_of(fills[k]);
        float lab[2][3];
        for (int side = 0; side < 2; side++) {
            float level[3];
            for (int c = 0; c < 3; c++)
                level[c] = (float)fills[k][c] * expf((side ? -4.f : 4.f) * mixture.turn[c]);
            fl_lab(level, lab[side]);
        }
        const float *a = lab[0], *b = lab[1];
        g_test_message("from %.0f %.0f %.0f to %.0f %.0f %.0f", (double)a[0], (double)a[1],
                       (double)a[2], (double)b[0], (double)b[1], (double)b[2]);
        g_assert_cmpfloat(fabsf(a[0] - b[0]), <, 5);
        g_assert_cmpfloat(hypotf(a[1] - b[1], a[2] - b[2]), >, 4);
        g_assert_cmpfloat(hypotf(b[1], b[2]), >, hypotf(a[1], a[2])); // a pure shadow
    }
}

/* Two fields that meet at column 200, wet together: fills, amounts and plays once paint has run. */
typedef struct Fields {
    uint8_t fills[4 * W * H];
    int16_t amounts[W * H];
    int8_t plays[W * H];
} Fields;

static const uint8_t red[3] = {200, 64, 58}, ochre[3] = {232, 178, 58};

static void run_into(Fields *fields, bool right, float strength)
{
    static const FlFrontStyle front = FL_FRONT_DEFAULTS;
    const FlRect box = {right ? 200 : 0, 0, 200, H};
    const FlArea area = {box, NULL};
    const size_t n = fl_rect_pixels(box);
    g_autofree float *planes = g_new(float, 3 * n);
    g_autofree uint8_t *fills = g_new(uint8_t, 4 * n);
    g_autofree int16_t *amounts = g_new(int16_t, n);
    g_autofree int8_t *plays = g_new(int8_t, n);
    const FlContact contact = {.strength = strength,
                               .reach_px = 30 * strength,
                               .style = &front,
                               .first = right,
                               .key = 7,
                               .anchor = {.cosine = 1},
                               .page = 1,
                               .box = box,
                               .step = 1,
                               .width = 200,
                               .height = H,
                               .away = planes,
                               .foot = {planes + n, planes + 2 * n}};
    for (size_t i = 0; i < n; i++) {
        const int x = (int)i % 200, y = (int)i / 200;
        planes[i] = (float)(right ? x : 199 - x), planes[n + i] = 200, planes[2 * n + i] = (float)y;
        memcpy(fills + 4 * i, right ? ochre : red, 3);
        amounts[i] = 1024, plays[i] = right ? -90 : 90;
    }
    const uint8_t *other = right ? red : ochre;
    const FlRunning to = {{other[0], other[1], other[2]}, amounts, plays, fills, NULL};
    fl_contact_lay(&contact, &area, &to);
    for (int y = 0; y < H; y++) {
        memcpy(fields->fills + 4 * (y * W + box.x), fills + (size_t)(800 * y), 800);
        memcpy(fields->amounts + y * W + box.x, amounts + 200 * y, 400);
        memcpy(fields->plays + y * W + box.x, plays + 200 * y, 200);
    }
}

/* The share of ochre in a pixel. */
static float ochre_at(const Fields *fields, int x, int y)
{
    return logf((float)fields->fills[4 * (y * W + x) + 1] / (float)red[1]) /
           logf((float)ochre[1] / (float)red[1]);
}

static void wet_fields_run_into_each_other(void)
{
    g_autofree Fields *fields = g_new0(Fields, 1);
    int found = 0, of_red = 0, of_ochre = 0, ran = 0, step = 0;
    run_into(fields, false, 1);
    run_into(fields, true, 1);
    for (int y = 0; y < H; y++) {
        g_assert_cmpfloat(fabsf(ochre_at(fields, 199, y) - ochre_at(fields, 200, y)), <, .1f);
        g_assert_cmpfloat(ochre_at(fields, 130, y), ==, 0);
        g_assert_cmpfloat(ochre_at(fields, 270, y), ==, 1);
        g_assert_cmpint(fields->amounts[y * W + 130], ==, 1024);
        g_assert_cmpint(fields->plays[y * W + 130], ==, 90);
        const bool left = ochre_at(fields, 195, y) > .15f, right = ochre_at(fields, 204, y) < .85f;
        found += !left && !right, of_ochre += left && !right, of_red += right && !left;
        ran += left != right;
        step += left != right ? fields->plays[y * W + 199] - fields->plays[y * W + 200] : 0;
    }
    g_test_message("of %d rows found %d, run over by red %d, by ochre %d", H, found, of_red,
                   of_ochre);
    g_test_message("the balance of the pigments changes by %d at their edge", step / ran);
    g_assert_cmpint(step, <, 45 * ran); // of 180: the hues of the washes are lost there
    g_assert_cmpint(found, >, H / 20);
    g_assert_cmpint(found, <, H / 2);
    g_assert_cmpint(of_red, >, H / 20);
    g_assert_cmpint(of_ochre, >, H / 20);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/wash/the-fill-stays-the-fill", the_fill_stays_the_fill);
    g_test_add_func("/wash/a-ground-is-uneven", a_ground_is_uneven);
    g_test_add_func("/wash/each-of-many-fills-stays", each_of_many_fills_stays);
    g_test_add_func("/wash/light-paint-has-its-light-above", light_paint_has_its_light_above);
    g_test_add_func("/wash/shapes-apart-stay-each", shapes_apart_stay_each);
    g_test_add_func("/wash/paint-that-comes-later-in-a-loop-rests",
                    paint_that_comes_later_in_a_loop_rests);
    g_test_add_func("/wash/paint-that-moves-is-dark-behind", paint_that_moves_is_dark_behind);
    g_test_add_func("/wash/it-rides-with-its-figure", it_rides_with_its_figure);
    g_test_add_func("/wash/a-limb-carries-its-own", a_limb_carries_its_own);
    g_test_add_func("/wash/all-of-a-limb-has-its-wash", all_of_a_limb_has_its_wash);
    g_test_add_func("/wash/beside-a-wash-all-is-as-at-its-rim", beside_a_wash_all_is_as_at_its_rim);
    g_test_add_func("/wash/white-ends-where-its-paint-ends", white_ends_where_its_paint_ends);
    g_test_add_func("/wash/edges-of-passes-are-lost-in-their-place",
                    edges_of_passes_are_lost_in_their_place);
    g_test_add_func("/wash/still-figures-do-not-change", still_figures_do_not_change);
    g_test_add_func("/wash/touching-shapes-of-one-fill-are-one-wash",
                    touching_shapes_of_one_fill_are_one_wash);
    g_test_add_func("/wash/a-front-is-soft-in-wet-paint", a_front_is_soft_in_wet_paint);
    g_test_add_func("/wash/a-gradient-has-the-fill-of-its-body",
                    a_gradient_has_the_fill_of_its_body);
    g_test_add_func("/wash/a-front-parts-two-tones", a_front_parts_two_tones);
    g_test_add_func("/wash/fronts-have-teeth", fronts_have_teeth);
    g_test_add_func("/wash/passes-are-soft-and-slopes-ragged", passes_are_soft_and_slopes_ragged);
    g_test_add_func("/wash/dry-passes-have-ragged-edges", dry_passes_have_ragged_edges);
    g_test_add_func("/wash/hairs-of-a-dry-brush-draw-streaks", hairs_of_a_dry_brush_draw_streaks);
    g_test_add_func("/wash/strokes-stay-dry-for-their-length", strokes_stay_dry_for_their_length);
    g_test_add_func("/wash/parts-that-move-apart-are-mixed", parts_that_move_apart_are_mixed);
    g_test_add_func("/wash/dots-and-lines-have-none", dots_and_lines_have_none);
    g_test_add_func("/wash/a-calm-wash-keeps-some-of-the-rim", a_calm_wash_keeps_some_of_the_rim);
    g_test_add_func("/wash/a-heart-is-light", a_heart_is_light);
    g_test_add_func("/wash/drops-leave-light-and-dark-spots", drops_leave_light_and_dark_spots);
    g_test_add_func("/wash/threads-and-parts-do-not-matter", threads_and_parts_do_not_matter);
    g_test_add_func("/contacts/wet-fields-run-into-each-other", wet_fields_run_into_each_other);
    g_test_add_func("/gaps/edges-are-off-by-a-hair", edges_are_off_by_a_hair);
    g_test_add_func("/pigments/they-mix-to-the-fill", pigments_mix_to_the_fill);
    g_test_add_func("/pigments/fills-beyond-paint-become-paint", fills_beyond_paint_become_paint);
    g_test_add_func("/pigments/the-hue-turns-and-most-light-stays",
                    the_hue_turns_and_most_light_stays);
    return g_test_run();
}
