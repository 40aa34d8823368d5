#include "guides/guides.h"
#include "guides/registration.h"
#include "render/motion_source.h"
#include "scratch.h"
#include <math.h>
#include <string.h>

enum { SIZE = 200, FRAMES = 4 };

/** A film of drawings of SIZE x SIZE px, with the masks of its regions. */
typedef struct Sequence {
    char *folder;
    FlDrawing *drawing;
    FlMaskStore *masks;
    FlMotionSource *source;
} Sequence;

static void sequence_clear(Sequence *s)
{
    fl_motion_source_free(s->source);
    fl_mask_store_free(s->masks);
    fl_drawing_free(s->drawing);
    scratch_remove(s->folder);
}
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Sequence, sequence_clear)

/** Writes what a frame shows. */
typedef void Draw(GString *out, int t);

static const FlRect page = {0, 0, SIZE, SIZE};

static void fill_masks(Sequence *s)
{
    uint8_t *mask = g_malloc(SIZE * SIZE);
    for (int f = 0; f < fl_drawing_frames(s->drawing); f++) {
        g_autoptr(FlDrawList) runs = fl_drawing_draw_list(s->drawing, f, NULL);
        for (int r = 0; r < fl_drawing_regions(s->drawing); r++) {
            memset(mask, 0, SIZE * SIZE);
            fl_draw_list_mask(runs, r, SIZE, SIZE, mask);
            g_assert_true(fl_mask_store_put(s->masks, r, f, mask, NULL));
        }
    }
    g_free(mask);
}

static Sequence sequence_of(Draw *draw, int frames)
{
    Sequence s = {.folder = scratch_make()};
    for (int t = 0; t < frames; t++) {
        g_autoptr(GString) text = g_string_new(NULL);
        g_autofree char *name = g_strdup_printf("%04d.svg", t + 1);
        g_string_append_printf(
            text, "<svg xmlns='http://www.w3.org/2000/svg' width='%d' height='%d'>", SIZE, SIZE);
        draw(text, t);
        g_string_append(text, "</svg>");
        g_free(scratch_write(s.folder, name, text->str));
    }
    const char *const inputs[] = {s.folder, NULL};
    const FlDrawingOptions options = {.frames = {inputs, 1}, .strokes = FL_STROKES_PAINT};
    g_autoptr(GError) error = NULL;
    s.drawing = fl_drawing_open(&options, NULL, &error);
    g_assert_no_error(error);
    s.masks = fl_mask_store_new(fl_drawing_regions(s.drawing), frames, SIZE, SIZE, &error);
    fill_masks(&s);
    s.source = fl_motion_source_new(s.drawing, s.masks, false, &error);
    g_assert_no_error(error);
    return s;
}

static bool registration(const uint8_t *mask_before, const uint8_t *mask_now, float *motion)
{
    g_autoptr(FlOutline) before = fl_outline_new(mask_before, SIZE, SIZE, NULL);
    g_autoptr(FlOutline) now = fl_outline_new(mask_now, SIZE, SIZE, NULL);
    return fl_registration(before, now, motion, NULL);
}

static void get(const Sequence *s, int region, int before, int now, float *motion,
                FlMotionShares *shares)
{
    g_autoptr(GError) error = NULL;
    g_assert_true(fl_motion_source_get(s->source, &(FlRegionStep){region, before, now, page, {0}},
                                       motion, shares, &error));
    g_assert_no_error(error);
}

/** The region that a paint has. */
static int region_of(const Sequence *s, const char *paint)
{
    for (int r = 0; r < fl_drawing_regions(s->drawing); r++)
        if (strcmp(fl_drawing_region(s->drawing, r)->paint, paint) == 0)
            return r;
    g_error("no region %s", paint);
}

#define RED "#cc2020"

/** Where the point at x, y in a frame was in the frame before. */
typedef FlPoint Origin(FlPoint now, int t);

/** The mean error of a region's motion into frame t as a share of the mean speed; where nothing is
 * known, none is taken for it. */
static double error_of(const uint8_t *mask, const float *motion, Origin *origin, int t)
{
    double error = 0, speed = 0;
    for (int p = 0; p < SIZE * SIZE; p++) {
        const FlPoint now = {p % SIZE + 0.5, p / SIZE + 0.5}, was = origin(now, t);
        if (mask[p] < FL_INSIDE)
            continue;
        const double u = isnan(motion[2 * p]) ? 0 : motion[2 * p];
        const double v = isnan(motion[2 * p]) ? 0 : motion[2 * p + 1];
        error += hypot(u - (now.x - was.x), v - (now.y - was.y));
        speed += hypot(now.x - was.x, now.y - was.y);
    }
    return error / speed;
}

/** The same of a film, in which all but the first frame move. */
static double error_of_film(Draw *draw, Origin *origin, bool masks_only)
{
    static float motion[2 * SIZE * SIZE];
    static uint8_t before[SIZE * SIZE], now[SIZE * SIZE];
    double sum = 0;
    g_auto(Sequence) s = sequence_of(draw, FRAMES);
    const int region = region_of(&s, RED);
    for (int t = 1; t < FRAMES; t++) {
        FlMotionShares shares = {0, 0};
        g_assert_true(fl_mask_store_get(s.masks, region, t - 1, page, before, NULL));
        g_assert_true(fl_mask_store_get(s.masks, region, t, page, now, NULL));
        if (masks_only)
            g_assert_true(registration(before, now, motion));
        else
            get(&s, region, t - 1, t, motion, &shares);
        sum += error_of(now, motion, origin, t) / (FRAMES - 1);
    }
    return sum;
}

/* ---- what moves ---- */

static FlAffine turn(double degrees)
{
    double s, c;
    fl_sincos_degrees(degrees, &s, &c);
    return (FlAffine){c, s, -s, c, 100 - 100 * c + 100 * s, 100 - 100 * s - 100 * c};
}

static FlPoint turned_back(FlPoint now, int t)
{
    (void)t;
    const FlAffine back = turn(-4);
    return fl_affine_apply(&back, now);
}

static FlPoint slid_back(FlPoint now, int t)
{
    (void)t;
    return (FlPoint){now.x - 5, now.y - 1.5};
}

static double growth(int t)
{
    return 1 + 0.05 * t;
}

static FlPoint shrunk(FlPoint now, int t)
{
    const double k = growth(t - 1) / growth(t);
    return (FlPoint){100 + k * (now.x - 100), 100 + k * (now.y - 100)};
}

static void spinning_disc(GString *out, int t)
{
    g_string_append_printf(out,
                           "<g transform='rotate(%d 100 100)'><ellipse cx='100' cy='100' rx='70' "
                           "ry='70' fill='" RED "'/></g>",
                           4 * t);
}

static void sliding_disc(GString *out, int t)
{
    g_string_append_printf(out, "<circle cx='%g' cy='%g' r='40' fill='" RED "'/>", 60 + 5.0 * t,
                           90 + 1.5 * t);
}

static void strip_behind_a_window(GString *out, int t)
{
    g_string_append_printf(out,
                           "<clipPath id='c'><rect x='30' y='30' width='140' height='140'/>"
                           "</clipPath><g clip-path='url(#c)'><g transform='translate(%g %g)'>"
                           "<path d='M-300 70H500V130H-300Z' fill='" RED "'/></g></g>",
                           5.0 * t, 1.5 * t);
}

/** Corner k of a star of five points, turned by 4 degrees a frame. */
static FlPoint star(int k, int t)
{
    double s, c;
    fl_sincos_degrees(36 * k - 90, &s, &c);
    const double r = k % 2 ? 40 : 90;
    const FlAffine m = turn(4 * t);
    return fl_affine_apply(&m, (FlPoint){100 + r * c, 100 + r * s});
}

static void append_point(GString *out, const char *command, FlPoint p)
{
    g_string_append_printf(out, "%s%.4f,%.4f", command, p.x, p.y);
}

static void draw_star(GString *out, int t, int first, int extra)
{
    g_string_append(out, "<path fill='" RED "' d='");
    for (int k = 0; k < 10; k++) {
        const FlPoint p = star(first + k, t), q = star(first + k + 1, t);
        append_point(out, k ? "L" : "M", p);
        for (int e = 1; e <= extra && k < 3; e++)
            append_point(out, "L",
                         (FlPoint){p.x + (q.x - p.x) * e / (extra + 2),
                                   p.y + (q.y - p.y) * e / (extra + 2)});
    }
    g_string_append(out, "Z'/>");
}

static void spinning_star(GString *out, int t)
{
    draw_star(out, t, 0, 0);
}

static void renumbered_star(GString *out, int t)
{
    draw_star(out, t, 3 * t, t % 3);
}

static void star_with_other_starts(GString *out, int t)
{
    draw_star(out, t, 3 * t, 0);
}

static void spinning_bar(GString *out, int t)
{
    const FlAffine m = turn(4 * t);
    const double corner[4][2] = {{20, 88}, {180, 88}, {180, 112}, {20, 112}};
    g_string_append(out, "<path fill='" RED "' d='");
    for (int k = 0; k < 4; k++)
        append_point(out, k ? "L" : "M",
                     fl_affine_apply(&m, (FlPoint){corner[k][0], corner[k][1]}));
    g_string_append(out, "Z'/>");
}

static void growing_blob(GString *out, int t)
{
    g_string_append_printf(out,
                           "<path transform='translate(100 100) scale(%g)' fill='" RED
                           "' d='M-60 -10C-50 -60 -10 -40 10 -50S60 -20 50 10 20 60 -10 50 -70 "
                           "30 -60 -10Z'/>",
                           growth(t));
}

/** A leg that bends: a parabola is a cubic, so that its outline is exact. */
static double bend(int t)
{
    return 0.0008 * t;
}

static void bending_leg(GString *out, int t)
{
    const double c = bend(t), side[2] = {85, 115};
    g_string_append(out, "<path fill='" RED "' d='");
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 5; i++) {
            const double x = k ? 160 - 30 * i : 10 + 30 * i, next = k ? x - 30 : x + 30;
            const double y = side[k] + c * x * x, mid = side[k] + c * x * next;
            if (i == 0)
                append_point(out, k ? "L" : "M", (FlPoint){x, y});
            const FlPoint end = {next, side[k] + c * next * next};
            append_point(out, "Q", (FlPoint){(x + next) / 2, mid});
            append_point(out, " ", end);
        }
    g_string_append(out, "Z'/>");
}

static FlPoint unbent(FlPoint now, int t)
{
    return (FlPoint){now.x, now.y - (bend(t) - bend(t - 1)) * now.x * now.x};
}

/** A plate that bulges as no affine motion does, drawn from another corner each time. */
static void bulging_plate_with_other_starts(GString *out, int t)
{
    const FlPoint corner[4] = {{40, 40}, {160, 40}, {160, 160}, {40, 160}};
    const FlPoint bulge[4] = {{100, 40 - 3 * t}, {160, 100}, {100, 160 - 5 * t}, {40, 100}};
    g_string_append(out, "<path fill='" RED "' d='");
    append_point(out, "M", corner[t % 4]);
    for (int k = t; k < t + 4; k++) {
        append_point(out, "Q", bulge[k % 4]);
        append_point(out, " ", corner[(k + 1) % 4]);
    }
    g_string_append(out, "Z'/>");
}

static void turning_face(GString *out, int t)
{
    const FlAffine m = turn(4 * t);
    g_string_append(out, "<g><circle fill='" RED "' cx='100' cy='100' r='80'/>");
    for (int k = 0; k < 2; k++) {
        const FlPoint eye = fl_affine_apply(&m, (FlPoint){k ? 130 : 70, 80});
        g_string_append_printf(out, "<circle fill='#202020' cx='%.4f' cy='%.4f' r='10'/>", eye.x,
                               eye.y);
    }
    g_string_append(out, "<path fill='#ffffff' d='");
    append_point(out, "M", fl_affine_apply(&m, (FlPoint){70, 125}));
    append_point(out, "L", fl_affine_apply(&m, (FlPoint){130, 125}));
    append_point(out, "L", fl_affine_apply(&m, (FlPoint){100, 140}));
    g_string_append(out, "Z'/></g>");
}

/** Both errors must hold; the lower one tells how good it is. */
static void assert_error(Draw *draw, Origin *origin, bool masks_only, double most)
{
    const double error = error_of_film(draw, origin, masks_only);
    g_test_message("error %.4f of the speed", error);
    g_assert_cmpfloat(error, <=, most);
}

static void affine_motion_is_exact(void)
{
    assert_error(spinning_disc, turned_back, false, 0.015);
    assert_error(sliding_disc, slid_back, false, 0.015);
    assert_error(strip_behind_a_window, slid_back, false, 0.01);
    assert_error(spinning_star, turned_back, false, 0.015);
    assert_error(star_with_other_starts, turned_back, false, 0.015);
    assert_error(spinning_bar, turned_back, false, 0.015);
    assert_error(growing_blob, shrunk, false, 0.015);
}

static void a_leg_bends(void)
{
    assert_error(bending_leg, unbent, false, 0.02);
}

static void a_face_turns_with_its_eyes(void)
{
    assert_error(turning_face, turned_back, false, 0.05);
}

static void masks_tell_motion_where_structure_changes(void)
{
    assert_error(renumbered_star, turned_back, false, 0.08);
}

static void masks_alone_tell_what_outlines_show(void)
{
    assert_error(sliding_disc, slid_back, true, 0.03);
    assert_error(spinning_star, turned_back, true, 0.08);
    assert_error(spinning_bar, turned_back, true, 0.06);
    assert_error(growing_blob, shrunk, true, 0.08);
    assert_error(bending_leg, unbent, true, 0.20);
}

static bool is_still(const float *motion)
{
    bool still = true;
    for (int k = 0; k < 2 * SIZE * SIZE && still; k++)
        still = motion[k] == 0;
    return still;
}

/** Whether nothing is carried: still, or unknown. */
static bool is_left_alone(const float *motion)
{
    bool alone = true;
    for (int k = 0; k < 2 * SIZE * SIZE && alone; k++)
        alone = motion[k] == 0 || isnan(motion[k]);
    return alone;
}

static void a_disc_that_slides_does_not_turn(void)
{
    static float motion[2 * SIZE * SIZE];
    uint8_t *mask[2] = {g_malloc(SIZE * SIZE), g_malloc(SIZE * SIZE)};
    g_auto(Sequence) s = sequence_of(sliding_disc, 2);
    for (int f = 0; f < 2; f++)
        g_assert_true(fl_mask_store_get(s.masks, 0, f, page, mask[f], NULL));
    g_assert_true(registration(mask[0], mask[0], motion));
    g_assert_true(is_still(motion));
    g_assert_true(registration(mask[0], mask[1], motion));
    const int above = 2 * (65 * SIZE + 65), below = 2 * (115 * SIZE + 65);
    g_assert_cmpfloat(fabsf(motion[above] - motion[below]), <, 0.1);
    g_free(mask[0]);
    g_free(mask[1]);
}

/* ---- parts that are nowhere over their past ---- */

/** A bar, and beside it a part that differs from frame to frame. */
static void bar_and(GString *out, const char *path)
{
    g_string_append_printf(out, "<path fill='" RED "' d='M10 150h180v30h-180z%s'/>", path);
}

static void part_that_leaps(GString *out, int t)
{
    bar_and(out, t ? "M100 40l30 10-5 25-20 5z" : "M60 30l30 10-5 25-20 5z");
}

static void part_for_another(GString *out, int t)
{
    bar_and(out, t ? "M100 40h60v12h-60z" : "M60 30l30 10-5 25-20 5z");
}

static void speck_for_a_speck(GString *out, int t)
{
    bar_and(out, t ? "M100 40h3v2h-3z" : "M60 30h3v2h-3z");
}

static void part_from_nowhere(GString *out, int t)
{
    bar_and(out, t ? "M100 40l30 10-5 25-20 5z" : "");
}

/** The motion that the masks tell of a pixel, px to the right. */
static float registered_at(Draw *draw, int x, int y)
{
    static float motion[2 * SIZE * SIZE];
    static uint8_t mask[2][SIZE * SIZE];
    g_auto(Sequence) s = sequence_of(draw, 2);
    for (int f = 0; f < 2; f++)
        g_assert_true(fl_mask_store_get(s.masks, region_of(&s, RED), f, page, mask[f], NULL));
    g_assert_true(registration(mask[0], mask[1], motion));
    g_assert_cmpfloat(motion[2 * (165 * SIZE + 100)], ==, 0); // the bar
    return motion[2 * (y * SIZE + x)];
}

static void a_part_leaps_only_if_it_looks_the_same(void)
{
    g_assert_cmpfloat(fabsf(registered_at(part_that_leaps, 115, 60) - 40), <, 0.3);
    g_assert_true(isnan(registered_at(part_for_another, 130, 46)));
    g_assert_true(isnan(registered_at(speck_for_a_speck, 101, 41)));
    g_assert_true(isnan(registered_at(part_from_nowhere, 115, 60)));
}

static void moves_once(GString *out, int t)
{
    g_string_append_printf(out, "<path fill='" RED "' d='M%d 50h60v70z'/>", t < 2 ? 40 : 47);
}

static void motion_is_into_the_frame(void)
{
    static float motion[2 * SIZE * SIZE];
    g_auto(Sequence) s = sequence_of(moves_once, 4);
    get(&s, 0, 0, 1, motion, NULL);
    g_assert_true(is_still(motion));
    get(&s, 0, 2, 3, motion, NULL);
    g_assert_true(is_still(motion));
    get(&s, 0, 1, 2, motion, NULL);
    const int inside = 2 * (70 * SIZE + 90);
    g_assert_cmpfloat(fabsf(motion[inside] - 7), <, 1e-4);
    g_assert_cmpfloat(fabsf(motion[inside + 1]), <, 1e-4);
}

/** A square of bars with a mask that is the same whatever bar is where. */
static void bars_that_change_places(GString *out, int t)
{
    for (int k = 0; k < 2; k++)
        g_string_append_printf(out, "<path id='bar%c' fill='" RED "' d='M%d 50h40v70h-40z'/>",
                               'a' + k, (k + t) % 2 ? 40 : 80);
}

static void a_region_rests_if_neither_mask_nor_leaves_change(void)
{
    static float motion[2 * SIZE * SIZE];
    g_auto(Sequence) once = sequence_of(moves_once, 4),
                     bars = sequence_of(bars_that_change_places, 2);
    get(&once, 0, 0, 1, motion, NULL);
    g_assert_true(is_left_alone(motion));
    get(&once, 0, 1, 2, motion, NULL);
    g_assert_false(is_left_alone(motion));
    get(&bars, 0, 0, 1, motion, NULL);
    g_assert_false(is_left_alone(motion));
}

static void held_frames_move_by_what_is_between_them(void)
{
    static float motion[2 * SIZE * SIZE], again[2 * SIZE * SIZE];
    g_auto(Sequence) s = sequence_of(sliding_disc, 16);
    get(&s, 0, 0, 2, motion, NULL);
    const int inside = 2 * (93 * SIZE + 70);
    g_assert_cmpfloat(fabsf(motion[inside] - 10), <, 1e-4);
    for (int t = 1; t < 16; t++) // so that the first frames are read back
        get(&s, 0, t - 1, t, again, NULL);
    get(&s, 0, 0, 2, again, NULL);
    g_assert_cmpmem(motion, sizeof motion, again, sizeof again);
    get(&s, 0, 15, 0, motion, NULL); // the seam of a loop
    g_assert_cmpfloat(fabsf(motion[2 * (90 * SIZE + 60)] - (-75)), <, 1e-3);
}

static void regions_that_ask_later_get_the_same(void)
{
    static float motion[2 * SIZE * SIZE], again[2 * SIZE * SIZE];
    Draw *const draws[] = {bulging_plate_with_other_starts, turning_face};
    for (size_t k = 0; k < G_N_ELEMENTS(draws); k++) {
        g_auto(Sequence) s = sequence_of(draws[k], 12);
        get(&s, 0, 1, 2, motion, NULL);
        for (int t = 3; t < 12; t++)
            get(&s, 0, t - 1, t, again, NULL);
        get(&s, 0, 1, 2, again, NULL);
        g_assert_cmpmem(motion, sizeof motion, again, sizeof again);
    }
}

/* ---- which leaf was which ---- */

/** Two squares: where each was is told by its motion. */
static float motion_at(Draw *draw, int x, int y)
{
    static float motion[2 * SIZE * SIZE];
    g_auto(Sequence) s = sequence_of(draw, 2);
    get(&s, region_of(&s, RED), 0, 1, motion, NULL);
    return motion[2 * (y * SIZE + x)];
}

static void square(GString *out, const char *id, double x, double y, double side)
{
    g_string_append_printf(out, "<rect %s x='%g' y='%g' width='%g' height='%g' fill='" RED "'/>",
                           id, x, y, side, side);
}

static void permuted(GString *out, int t)
{
    const double x = 10 + 4.0 * t;
    for (int k = 0; k < 3; k++) {
        const int which = t ? (k + 1) % 3 : k;
        square(out, "", x + 60 * which, 20 + 50 * which, 30 + 4 * which);
    }
}

static void renamed(GString *out, int t)
{
    square(out, t ? "id='c'" : "id='a'", 10 + 4.0 * t, 20, 40);
    square(out, t ? "id='d'" : "id='b'", 100 + 4.0 * t, 120, 30);
}

static void inserted(GString *out, int t)
{
    if (t)
        square(out, "", 100, 10, 25);
    square(out, "", 10 + 4.0 * t, 60, 40);
    square(out, "", 100 + 4.0 * t, 120, 30);
}

static void crossing(GString *out, int t)
{
    square(out, "id='a'", t ? 104 : 96, 50, 30);
    square(out, "id='b'", t ? 96 : 104, 120, 30);
}

static void crossing_named(GString *out, int t)
{
    square(out, "id='a'", t ? 100 : 60, 50, 30);
    square(out, "id='b'", t ? 60 : 100, 50, 30);
}

static void crossing_without_names(GString *out, int t)
{
    square(out, "", t ? 64 : 60, 50, 30);
    square(out, "", t ? 96 : 100, 50, 30);
}

static void leaves_are_recognised(void)
{
    g_assert_cmpfloat(fabsf(motion_at(permuted, 20, 30) - 4), <, 1e-3);
    g_assert_cmpfloat(fabsf(motion_at(permuted, 80, 80) - 4), <, 1e-3);
    g_assert_cmpfloat(fabsf(motion_at(renamed, 30, 30) - 4), <, 1e-3);
    g_assert_cmpfloat(fabsf(motion_at(renamed, 110, 130) - 4), <, 1e-3);
    g_assert_cmpfloat(fabsf(motion_at(inserted, 30, 70) - 4), <, 1e-3);
    g_assert_true(isnan(motion_at(inserted, 110, 20)));
    g_assert_cmpfloat(fabsf(motion_at(crossing, 110, 60) - 8), <, 1e-3);
    g_assert_cmpfloat(fabsf(motion_at(crossing, 110, 130) + 8), <, 1e-3);
    g_assert_cmpfloat(fabsf(motion_at(crossing_named, 110, 60) - 40), <, 1e-3);
    g_assert_cmpfloat(fabsf(motion_at(crossing_without_names, 70, 60) - 4), <, 1e-3);
}

/* ---- what is not to be trusted, and what grows ---- */

static void moved_by_a_style_sheet(GString *out, int t)
{
    g_string_append_printf(out,
                           "<style>#a{transform:translate(%dpx,10px)}</style><path id='a' d='M20 "
                           "20h80l10 50-70 30z' fill='" RED "'/>",
                           30 + 5 * t);
}

static void a_style_sheet_moves_exactly(void)
{
    static float motion[2 * SIZE * SIZE];
    FlMotionShares shares;
    g_auto(Sequence) s = sequence_of(moved_by_a_style_sheet, 2);
    get(&s, 0, 0, 1, motion, &shares);
    g_assert_cmpint(shares.exact, >, 1000);
    g_assert_cmpint(shares.registered, ==, 0);
    g_assert_cmpfloat(fabsf(motion[2 * (60 * SIZE + 100)] - 5), <, 1e-3);
}

static void line_that_draws_itself(GString *out, int t)
{
    g_string_append(out, "<path fill='none' stroke='" RED "' stroke-width='12' d='M20 100");
    for (int k = 0; k <= 3 + t; k++)
        g_string_append_printf(out, "L%d %d", 40 + 20 * k, k % 2 ? 60 : 140);
    g_string_append(out, "'/>");
}

static void line_that_gets_longer(GString *out, int t)
{
    g_string_append_printf(
        out, "<path fill='none' stroke='" RED "' stroke-width='12' d='M20 100L%d 100'/>",
        80 + 20 * t);
}

static void line_with_a_dash(GString *out, int t)
{
    g_string_append_printf(out,
                           "<path fill='none' stroke='" RED "' stroke-width='12' "
                           "stroke-dasharray='300' stroke-dashoffset='%d' d='M20 100C60 0 120 180 "
                           "180 100'/>",
                           200 - 20 * t);
}

static void strokes_that_come(GString *out, int t)
{
    for (int k = 0; k <= t; k++)
        square(out, "", 20 + 40 * k, 30 + 35 * k, 30);
}

/* With as many nodes in every frame, which lie elsewhere on its edges. */
static void band_that_gets_longer(GString *out, int t)
{
    const double end = 80 + 15 * t;
    g_string_append(out, "<path fill='" RED "' d='");
    for (int k = 0; k < 60; k++) {
        const double x = 20 + (end - 20) * (k < 30 ? k : 59 - k) / 29.0;
        g_string_append_printf(out, "%c%.4f %.4f", k ? 'L' : 'M', x,
                               (k < 30 ? 60 : 140) + 15 * sin(x / 40));
    }
    g_string_append(out, "z'/>");
}

/* Its nodes come one by one; the side that closes it hides nearly as much as they add. */
static void fill_that_is_drawn_on(GString *out, int t)
{
    static const char *const more[] = {"", "L30 150", "L30 150L26 100"};
    g_string_append_printf(out, "<path fill='" RED "' d='M40 20L160 20L160 180L40 180%sz'/>",
                           more[t]);
}

/* Nodes that hardly add to the outline's length come on its last side; the others are rounded. */
static void side_that_bulges(GString *out, int t)
{
    static const char *const more[] = {"", "L37 100", "L36 140L37 100"};
    const double off = t % 2 * 0.01;
    g_string_append_printf(out, "<path fill='" RED "' d='M%.2f 20L%.2f 20L%.2f 180L%.2f 180%sz'/>",
                           40 + off, 160 + off, 160 - off, 40 + off, more[t]);
}

static void fill_that_a_clip_opens(GString *out, int t)
{
    g_string_append_printf(out,
                           "<clipPath id='c'><rect width='%d' height='200'/></clipPath><g "
                           "clip-path='url(#c)'><circle cx='100' cy='100' r='80' fill='" RED
                           "'/></g>",
                           50 + 30 * t);
}

static void what_is_laid_stays(void)
{
    static float motion[2 * SIZE * SIZE];
    static Draw *const draws[] = {
        line_that_draws_itself, line_that_gets_longer, line_with_a_dash, strokes_that_come,
        band_that_gets_longer,  fill_that_is_drawn_on, side_that_bulges, fill_that_a_clip_opens};
    for (size_t i = 0; i < G_N_ELEMENTS(draws); i++) {
        g_auto(Sequence) s = sequence_of(draws[i], 3);
        for (int t = 1; t < 3; t++) {
            get(&s, region_of(&s, RED), t - 1, t, motion, NULL);
            g_assert_true(is_left_alone(motion));
        }
    }
}

static void line_beside_what_moves(GString *out, int t)
{
    line_that_gets_longer(out, t);
    square(out, "", 20 + 5 * t, 130, 40);
}

/** What a line gains is spread, in its own time; the paint beside it is carried. */
static void what_is_added_is_unknown(void)
{
    static float motion[2 * SIZE * SIZE];
    g_auto(Sequence) s = sequence_of(line_beside_what_moves, 3);
    for (int t = 1; t < 3; t++) {
        get(&s, region_of(&s, RED), t - 1, t, motion, NULL);
        g_assert_true(isnan(motion[2 * (100 * SIZE + 40)]));
        g_assert_cmpfloat(fabsf(motion[2 * (150 * SIZE + 50)] - 5), <, 0.01);
    }
}

static void swinging_limb(GString *out, int t)
{
    const FlAffine m = turn(4 * t);
    const FlPoint a = fl_affine_apply(&m, (FlPoint){60, 100});
    const FlPoint b = fl_affine_apply(&m, (FlPoint){170, 100});
    g_string_append_printf(out,
                           "<path fill='none' stroke='" RED
                           "' stroke-width='24' stroke-linecap='round' d='M%.4f %.4fL%.4f %.4f'/>",
                           a.x, a.y, b.x, b.y);
}

static void a_stroke_turns_in_all_its_width(void)
{
    assert_error(swinging_limb, turned_back, false, 0.015);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name, function) g_test_add_func("/motion/" name, function)
    TEST("affine-motion-is-exact", affine_motion_is_exact);
    TEST("a-leg-bends", a_leg_bends);
    TEST("a-face-turns-with-its-eyes", a_face_turns_with_its_eyes);
    TEST("masks-tell-motion-where-structure-changes", masks_tell_motion_where_structure_changes);
    TEST("masks-alone-tell-what-outlines-show", masks_alone_tell_what_outlines_show);
    TEST("a-disc-that-slides-does-not-turn", a_disc_that_slides_does_not_turn);
    TEST("a-part-leaps-only-if-it-looks-the-same", a_part_leaps_only_if_it_looks_the_same);
    TEST("motion-is-into-the-frame", motion_is_into_the_frame);
    TEST("a-region-rests-if-neither-mask-nor-leaves-change",
         a_region_rests_if_neither_mask_nor_leaves_change);
    TEST("held-frames-move-by-what-is-between-them", held_frames_move_by_what_is_between_them);
    TEST("regions-that-ask-later-get-the-same", regions_that_ask_later_get_the_same);
    TEST("leaves-are-recognised", leaves_are_recognised);
    TEST("a-style-sheet-moves-exactly", a_style_sheet_moves_exactly);
    TEST("what-is-laid-stays", what_is_laid_stays);
    TEST("what-is-added-is-unknown", what_is_added_is_unknown);
    TEST("a-stroke-turns-in-all-its-width", a_stroke_turns_in_all_its_width);
    return g_test_run();
}
