/* Wet paper: a disk that moves over it wets what lies ahead and stains what it leaves. */
#include "base/alloc.h"
#include "guides/distance.h"
#include "io/png.h"
#include "scratch.h"
#include "wet/marks.h"
#include <fluidy/fluidy.h>
#include <math.h>

enum { SIDE = 200, PIXELS = SIDE * SIDE, RADIUS = 40 };

static const FlFrontStyle plain = FL_FRONT_DEFAULTS;

/* A disk in two frames, on a page of 480 px of which this is a part. */
typedef struct Scene {
    FlWetSheet sheet;
    uint8_t before[PIXELS], now[PIXELS], ahead[PIXELS], touches[PIXELS], touched[PIXELS];
    float distance[PIXELS], beyond[PIXELS], motion[2 * PIXELS];
    uint8_t rgb[3 * PIXELS];
    int16_t region[PIXELS];
    FlLaid laid;
    FlWetShape shape;
    FlWetDials dials;
    float spin;    // of the disk around its middle, radians a frame
    float pace;    // of the disk in the frame before; 0: not known
    float receded; // of its edge until then
    bool stops;    // the disk, where it is now
    GArray *fronts, *stains, *below;
} Scene;

static void draw_disk(float x0, float radius, uint8_t *mask)
{
    for (int p = 0; p < PIXELS; p++) {
        const float inside = radius - hypotf((float)(p % SIDE) - x0, (float)(p / SIDE) - 100);
        mask[p] = (uint8_t)(255 * CLAMP(inside + 0.5f, 0, 1));
    }
}

static Scene *scene_new(void)
{
    const FlRect page = {0, 0, SIDE, SIDE};
    Scene *scene = g_new0(Scene, 1);
    scene->sheet = (FlWetSheet){.page = page,
                                .width = SIDE,
                                .height = SIDE,
                                .cell_px = 1,
                                .px = 1,
                                .stain_time = 7,
                                .fibres = {.seed = 5}};
    g_assert_true(fl_wet_sheet_init(&scene->sheet, NULL));
    fl_wet_sheet_begin(&scene->sheet);
    scene->shape = (FlWetShape){.rect = page,
                                .page = page,
                                .px = 1,
                                .frames = 1,
                                .now = scene->now,
                                .motion = scene->motion,
                                .overlap = 1,
                                .came = FL_AFFINE_NONE,
                                .laid = &scene->laid,
                                .paper = {255, 255, 255}};
    scene->laid = (FlLaid){SIDE, SIDE, 1, scene->rgb, scene->region};
    memset(scene->rgb, 120, sizeof scene->rgb);
    scene->dials = (FlWetDials){&plain, 1, 1, 5};
    memset(scene->touches, 1, PIXELS);
    memset(scene->touched, 255, PIXELS);
    scene->fronts = g_array_new(FALSE, FALSE, sizeof(FlFrontMark));
    scene->stains = g_array_new(FALSE, FALSE, sizeof(FlStainMark));
    scene->below = g_array_new(FALSE, FALSE, sizeof(FlFrontMark));
    return scene;
}

static void scene_free(Scene *scene)
{
    fl_wet_sheet_clear(&scene->sheet);
    g_array_unref(scene->fronts);
    g_array_unref(scene->stains);
    g_array_unref(scene->below);
    g_free(scene);
}

/* The marks of a disk that goes from x0 to x1 and grows by `grown`, and goes on unless it stops. */
static void mark(Scene *scene, float x0, float x1, float grown)
{
    g_auto(FlMovingEdge) edge = {0};
    g_auto(FlMovingEdge) before = {0};
    FlWetShape was = scene->shape;
    draw_disk(x0, RADIUS, scene->before);
    draw_disk(x1, RADIUS + grown, scene->now);
    draw_disk(x1 + (scene->stops ? 0 : 4 * (x1 - x0)), RADIUS + grown, scene->ahead);
    for (int p = 0; p < PIXELS; p++) {
        const float x = (float)(p % SIDE) - x1, y = (float)(p / SIDE) - 100;
        scene->motion[2 * p] = x1 - x0 + x - cosf(scene->spin) * x - sinf(scene->spin) * y;
        scene->motion[2 * p + 1] = y - cosf(scene->spin) * y + sinf(scene->spin) * x;
    }
    g_assert_true(fl_distance(scene->now, SIDE, SIDE, scene->distance, NULL));
    was.now = scene->before;
    g_assert_true(fl_moving_edge_look(&before, &was, NULL));
    for (int i = 0; i < before.n; i++)
        before.point[i].pace = scene->pace, before.point[i].receded = scene->receded,
        before.point[i].lead = 1;
    before.n = scene->pace > 0 ? before.n : 0;
    scene->shape.distance_before = before.distance;
    g_assert_true(fl_distance(scene->ahead, SIDE, SIDE, scene->beyond, NULL));
    for (int p = 0; p < PIXELS; p++)
        scene->beyond[p] = fmaxf(-fmaxf(scene->beyond[p], scene->distance[p]), 0);
    g_array_set_size(scene->fronts, 0);
    g_array_set_size(scene->stains, 0);
    g_array_set_size(scene->below, 0);
    const FlWetAround around = {scene->beyond, scene->touches, scene->touched};
    g_assert_true(fl_moving_edge_init(&edge, &scene->shape, &before, NULL));
    g_assert_true(fl_marks_add_front(&scene->shape, &edge, &around, &scene->dials, &scene->sheet,
                                     scene->fronts, NULL));
    fl_marks_add_stain(&scene->shape, &edge, &around, &scene->dials, scene->stains, scene->below);
}

/* The sum of the fronts outside the disk, right of it less left of it, and of both. */
static float front_outside(const Scene *scene, float x1, float *both)
{
    float right = 0;
    *both = 0;
    for (guint i = 0; i < scene->fronts->len; i++) {
        const FlFrontMark *front = &g_array_index(scene->fronts, FlFrontMark, i);
        if (scene->distance[front->at] >= -1)
            continue;
        *both += front->density;
        right += (float)(front->at % SIDE) > x1 ? front->density : -front->density;
    }
    return right;
}

static float charge_of(const Scene *scene)
{
    float sum = 0;
    for (guint i = 0; i < scene->stains->len; i++)
        sum += g_array_index(scene->stains, FlStainMark, i).charge;
    return sum;
}

/* The most red that the stains of a disk absorb, whose paint has 30 of red and the rest of all. */
static float most_red(int rest)
{
    Scene *scene = scene_new();
    float most = 0;
    for (int p = 0; p < 3 * PIXELS; p++)
        scene->rgb[p] = (uint8_t)(p % 3 == 0 ? 30 : rest);
    mark(scene, 80, 86, 0);
    for (guint i = 0; i < scene->stains->len; i++)
        most = fmaxf(most, g_array_index(scene->stains, FlStainMark, i).ink[0]);
    scene_free(scene);
    return most;
}

/* The stain of black paint is light, that of a colour as deep as the colour. */
static void test_black(void)
{
    g_assert_cmpfloat(most_red(255), >, 1);
    g_assert_cmpfloat(most_red(30), <, 0.6f * most_red(255));
}

static void test_ahead(void)
{
    Scene *scene = scene_new();
    float both;
    scene->pace = 6;
    mark(scene, 80, 86, 0);
    const float right = front_outside(scene, 86, &both);
    g_assert_cmpfloat(both, >, 120);
    g_assert_cmpfloat(right, >, 0.98f * both);
    g_assert_cmpuint(scene->stains->len, >, 200);
    for (guint i = 0; i < scene->stains->len; i++)
        g_assert_cmpint(g_array_index(scene->stains, FlStainMark, i).at % SIDE, <, 92);
    g_assert_cmpfloat(charge_of(scene), >, 100);
    scene_free(scene);
}

/* A front spreads in some frames, and is not there at once. */
static void test_spreads(void)
{
    Scene *scene = scene_new();
    float first, later;
    mark(scene, 80, 86, 0);
    front_outside(scene, 86, &first);
    scene->pace = 6;
    mark(scene, 80, 86, 0);
    front_outside(scene, 86, &later);
    g_test_message("fronts of %.0f in the first frame, later %.0f", first, later);
    g_assert_cmpfloat(first, >, 10);
    g_assert_cmpfloat(first, <, 0.7f * later);
    scene_free(scene);
}

/* The px by which the front of a disk is seen ahead of the disk. */
static float front_ahead(bool stops, float overrun)
{
    Scene *scene = scene_new();
    float most = 0;
    scene->stops = stops, scene->dials.overrun = overrun, scene->pace = 6;
    mark(scene, 80, 86, 0);
    for (guint i = 0; i < scene->fronts->len; i++) {
        const FlFrontMark *front = &g_array_index(scene->fronts, FlFrontMark, i);
        if (front->edge > 0)
            most = MAX(most, -scene->distance[front->at]);
    }
    scene_free(scene);
    return most;
}

/* A front hardly passes the place where its disk stops: by the overrun. */
static void test_stop(void)
{
    const float goes = front_ahead(false, 5), stops = front_ahead(true, 5);
    const float none = front_ahead(true, 0);
    g_test_message("%.1f px ahead, %.1f where it stops, %.1f without overrun", goes, stops, none);
    g_assert_cmpfloat(stops, <, 0.9f * goes);
    g_assert_cmpfloat(none, <, 0.5f * stops);
}

/* The charge of the stains as a share of the area that they have been left on, and their area. */
static float mean_charge(const Scene *scene, float *area)
{
    *area = 0;
    for (guint i = 0; i < scene->stains->len; i++)
        *area += g_array_index(scene->stains, FlStainMark, i).lost;
    return charge_of(scene) / *area;
}

static void test_quick(void)
{
    Scene *scene = scene_new();
    float area;
    mark(scene, 60, 64, 0);
    const float slow = mean_charge(scene, &area);
    mark(scene, 60, 84, 0);
    g_assert_cmpfloat(slow, >, 0.5f);
    g_assert_cmpfloat(mean_charge(scene, &area), <, 0.4f * slow);
    scene_free(scene);
}

/* The ink of the stains in the 8 columns behind a disk that goes from x0 to x0 + 24. */
static float ink_behind(float x0)
{
    Scene *scene = scene_new();
    const int edge = (int)x0 + 24 - RADIUS;
    float sum = 0;
    mark(scene, x0, x0 + 24, 0);
    for (guint i = 0; i < scene->stains->len; i++) {
        const FlStainMark *stain = &g_array_index(scene->stains, FlStainMark, i);
        if (stain->at % SIDE >= edge - 8 && stain->at % SIDE < edge)
            sum += stain->charge * stain->ink[0];
    }
    scene_free(scene);
    return sum;
}

/* A disk that comes in from beyond a side of the page leaves a stain there as it does within. */
static void test_comes_in(void)
{
    const float within = ink_behind(100), side = ink_behind(RADIUS - 14);
    g_test_message("%.1f within the page, %.1f at its side", within, side);
    g_assert_cmpfloat(within, >, 10);
    g_assert_cmpfloat(side, >, 0.8f * within);
}

/* The middles of the fronts and stains of a disk that goes 6 cells on, of cells beside the page's.
 */
static void find_middles(float x0, float beside, float middle[2])
{
    Scene *scene = scene_new();
    float sum[2] = {0}, all[2] = {0};
    scene->shape.beside[0] = beside;
    mark(scene, x0, x0 + 6, 0);
    for (guint i = 0; i < scene->fronts->len; i++) {
        const FlFrontMark *front = &g_array_index(scene->fronts, FlFrontMark, i);
        const float wet = front->density * CLAMP(front->edge, 0, 1);
        sum[0] += wet * (float)(front->at % SIDE), all[0] += wet;
    }
    for (guint i = 0; i < scene->stains->len; i++) {
        const FlStainMark *stain = &g_array_index(scene->stains, FlStainMark, i);
        sum[1] += stain->charge * (float)(stain->at % SIDE), all[1] += stain->charge;
    }
    for (int k = 0; k < 2; k++)
        middle[k] = sum[k] / all[k];
    scene_free(scene);
}

/* Where a camera has brought the paper's cells beside those of the page, marks lie in their place
 * all the same: those of two frames meet without a line between them. */
static void test_beside(void)
{
    float in_place[2], beside[2];
    find_middles(80, 0, in_place);
    find_middles(80, 0.4f, beside);
    g_test_message("fronts at %.2f and %.2f, stains at %.2f and %.2f", in_place[0],
                   beside[0] + 0.4f, in_place[1], beside[1] + 0.4f);
    for (int k = 0; k < 2; k++)
        g_assert_cmpfloat_with_epsilon(beside[k] + 0.4f, in_place[k], 0.2f);
}

static void test_turn(void)
{
    Scene *scene = scene_new();
    float area;
    scene->pace = 4;
    mark(scene, 60, 64, 0);
    const float slow = mean_charge(scene, &area);
    scene->pace = 60;
    mark(scene, 60, 64, 0);
    g_assert_cmpfloat(mean_charge(scene, &area), <, 0.5f * slow);
    scene_free(scene);
}

static void test_spin(void)
{
    Scene *scene = scene_new();
    float straight, spun;
    mark(scene, 60, 84, 0);
    const float charge = mean_charge(scene, &straight);
    scene->spin = 0.7f;
    mark(scene, 60, 84, 0);
    g_assert_cmpfloat_with_epsilon(mean_charge(scene, &spun), charge, 0.03f);
    g_assert_cmpfloat_with_epsilon(spun, straight, 0.03f * straight);
    scene_free(scene);
}

static void test_sides(void)
{
    Scene *scene = scene_new();
    scene->pace = 24, scene->receded = 48;
    mark(scene, 60, 84, 0);
    for (guint i = 0; i < scene->stains->len; i++) {
        const FlStainMark *stain = &g_array_index(scene->stains, FlStainMark, i);
        const int across = abs(stain->at / SIDE - 100);
        if (across > RADIUS - 5)
            g_assert_cmpfloat(stain->depth, <, 6);
        if (across < RADIUS - 23)
            g_assert_cmpfloat(stain->depth, >, 7);
    }
    scene_free(scene);
}

static void test_start(void)
{
    Scene *scene = scene_new();
    scene->shape.half_width = RADIUS;
    mark(scene, 60, 84, 0);
    g_assert_cmpuint(scene->stains->len, >, 0);
    for (guint i = 0; i < scene->stains->len; i++) {
        const FlStainMark *stain = &g_array_index(scene->stains, FlStainMark, i);
        const float way = (float)(stain->at % SIDE) - (60 - RADIUS);
        if (abs(stain->at / SIDE - 100) < RADIUS / 4)
            g_assert_cmpfloat(stain->depth, <, MAX(0.75f * way, 0) + 1);
    }
    scene_free(scene);
}

/* A stain breaks up all through where a shape hardly touched paper, and takes up as little. */
static void test_touched(void)
{
    Scene *scene = scene_new();
    memset(scene->touched, 51, PIXELS);
    scene->pace = 24, scene->receded = 48;
    mark(scene, 60, 84, 0);
    g_assert_cmpuint(scene->stains->len, >, 0);
    for (guint i = 0; i < scene->stains->len; i++) {
        const FlStainMark *stain = &g_array_index(scene->stains, FlStainMark, i);
        g_assert_cmpfloat(stain->depth, <=, 14 * 0.21f);
        g_assert_cmpfloat(stain->lost, <=, 0.21f);
    }
    scene_free(scene);
}

static int by_size(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Fingers all around a disk that grows: a few are long, many short. */
static void test_fingers(void)
{
    enum { N = 240 };
    Scene *scene = scene_new();
    FlFrontStyle style = plain;
    float reach[N] = {0};
    style.fingers = 1;
    scene->dials.style = &style;
    mark(scene, 100, 100, 24);
    for (guint i = 0; i < scene->fronts->len; i++) {
        const FlFrontMark *front = &g_array_index(scene->fronts, FlFrontMark, i);
        const double x = front->at % SIDE - 100, y = front->at / SIDE - 100;
        float *far = &reach[(int)((atan2(y, x) / G_PI + 1) / 2 * (N - 1))];
        *far = MAX(*far, -scene->distance[front->at]);
    }
    qsort(reach, N, sizeof *reach, by_size);
    const float shortest = reach[N / 20], median = reach[N / 2], longest = reach[N - 1 - N / 20];
    g_test_message("reach from %.1f, median %.1f, to %.1f px", shortest, median, longest);
    g_assert_cmpfloat(longest - median, >, 1.5f * (median - shortest));
    g_assert_cmpfloat(longest, <, 1.75f * median); // and none is a thorn
    scene_free(scene);
}

/* A stroke to the right. */
static void draw_stroke(int end, uint8_t *mask)
{
    for (int p = 0; p < PIXELS; p++)
        mask[p] = p % SIDE >= 20 && p % SIDE < end && abs(p / SIDE - 100) < 15 ? 255 : 0;
}

/* The edge of a stroke as far as `end`, which advances there by 20 px a frame. */
static Scene *scene_of_stroke(int end, FlMovingEdge *edge)
{
    Scene *scene = scene_new();
    draw_stroke(end, scene->now);
    g_assert_true(fl_moving_edge_look(edge, &scene->shape, NULL));
    for (int i = 0; i < edge->n; i++)
        edge->point[i].speed = edge->point[i].nx > 0.5f ? 20 : 0;
    scene->shape.motion = NULL;
    scene->shape.distance_before = edge->distance;
    return scene;
}

/* An edge that goes back beyond the middle of what was there goes back all the same. */
static void test_retreat(void)
{
    g_auto(FlMovingEdge) before = {0};
    g_auto(FlMovingEdge) edge = {0};
    Scene *scene = scene_of_stroke(120, &before);
    memset(scene->now, 0, 105 * SIDE);
    g_assert_true(fl_moving_edge_init(&edge, &scene->shape, &before, NULL));
    int n = 0;
    for (int i = 0; i < edge.n; i++) {
        const FlEdgePoint *point = &edge.point[i];
        if (point->x < 40 || point->x > 100 || point->y > 110)
            continue;
        g_assert_cmpfloat(point->speed, <, -2);
        n++;
    }
    g_assert_cmpint(n, >, 20);
    scene_free(scene);
}

/* A stroke that grows at its end advances there, and not at its new sides. */
static void test_stroke(void)
{
    g_auto(FlMovingEdge) before = {0};
    g_auto(FlMovingEdge) edge = {0};
    Scene *scene = scene_of_stroke(100, &before);
    draw_stroke(120, scene->now);
    g_assert_true(fl_moving_edge_init(&edge, &scene->shape, &before, NULL));
    int sides = 0, ends = 0;
    for (int i = 0; i < edge.n; i++) {
        const FlEdgePoint *point = &edge.point[i];
        if (point->x > 107 && point->x < 113) {
            g_assert_cmpfloat(point->speed, <, 1);
            sides++;
        } else if (point->nx > 0.9f && fabsf(point->y - 100) < 5) {
            g_assert_cmpfloat(point->speed, >, 10);
            ends++;
        }
    }
    g_assert_cmpint(sides, >, 6);
    g_assert_cmpint(ends, >, 6);
    scene_free(scene);
}

static void test_rest(void)
{
    Scene *scene = scene_new();
    mark(scene, 80, 80, 0);
    g_assert_cmpuint(scene->fronts->len, ==, 0);
    g_assert_cmpuint(scene->stains->len, ==, 0);
    scene_free(scene);
}

static void test_vanish(void)
{
    Scene *scene = scene_new();
    mark(scene, 80, 80, -3);
    const float shrunk = charge_of(scene);
    mark(scene, 80, 80, -38);
    g_assert_cmpfloat(shrunk, >, 300);
    g_assert_cmpfloat(charge_of(scene), <, 0.01f * shrunk);
    scene_free(scene);
}

/* A front is left where its disk slides on, below the disk also where that goes back, and is taken
 * away where the disk is suddenly far or the paper keeps none of its paint. */
static void test_jump(void)
{
    for (int k = 0; k < 4; k++) {
        const bool jumps = k == 1, leaves_none = k == 2, slides = k == 3;
        Scene *scene = scene_new();
        mark(scene, 60, 66, 0);
        g_autoptr(GArray) fronts = g_array_ref(scene->fronts), lost = NULL;
        g_auto(FlMovingEdge) edge = {0};
        lost = g_array_new(FALSE, FALSE, sizeof(FlStainMark));
        draw_disk(jumps ? 160 : 72, jumps ? 10 : RADIUS, scene->now);
        memset(scene->motion, 0, sizeof scene->motion);
        scene->shape.distance_before = scene->distance;
        g_assert_true(fl_moving_edge_look(&edge, &scene->shape, NULL));
        for (int i = 0; i < edge.n; i++)
            edge.point[i].receding = slides ? 0 : 20, edge.point[i].kept = leaves_none ? 0 : 1;
        fl_marks_lose_fronts(&scene->shape, &edge, fronts, lost);
        if (jumps || leaves_none)
            g_assert_cmpuint(lost->len, >, fronts->len / 2);
        else if (slides)
            g_assert_cmpuint(lost->len, ==, 0);
        guint ahead = 0;
        for (guint i = 0; i < fronts->len; i++)
            ahead += scene->distance[g_array_index(fronts, FlFrontMark, i).at] < -2;
        for (guint i = 0; k == 0 && i < lost->len; i++)
            g_assert_cmpfloat(scene->distance[g_array_index(lost, FlStainMark, i).at], <, 2);
        if (k == 0)
            g_assert_cmpuint(lost->len, >=, MAX(ahead, 100));
        scene_free(scene);
    }
}

static void test_other_paint(void)
{
    Scene *scene = scene_new();
    memset(scene->touches, 0, PIXELS);
    memset(scene->touched, 0, PIXELS);
    mark(scene, 80, 86, 0);
    g_assert_cmpuint(scene->fronts->len, ==, 0);
    g_assert_cmpuint(scene->stains->len, ==, 0);
    scene_free(scene);
}

/* The last of eight frames of a film, painted without fronts. painted: frames, all if NULL. */
static FlPicture *last_of(char *const *frames, int width, const char *stain, const char *painted)
{
    g_autoptr(Scratch) folder = scratch_make();
    for (int f = 1; f <= 8; f++) {
        g_autofree char *name = g_strdup_printf("d_%d.svg", f);
        g_free(scratch_svg(folder, name, frames[f - 1]));
    }
    g_autofree char *output = g_build_filename(folder, "d_%d.png", NULL);
    g_autofree char *style = g_build_filename(g_getenv("FLUIDY_FIXTURES"), "style-small", NULL);
    const char *const inputs[] = {folder, NULL};
    const FlSetting settings[] = {{.name = "style", .value = style},
                                  {.name = "front", .value = "0"},
                                  {.name = "stain", .value = stain}};
    const FlRenderOptions options = {.size = sizeof options,
                                     .inputs = inputs,
                                     .output = output,
                                     .frames = painted,
                                     .width = width,
                                     .settings = settings,
                                     .n_settings = G_N_ELEMENTS(settings)};
    g_autoptr(GError) error = NULL;
    fl_render(&options, &error);
    g_assert_no_error(error);
    g_autofree char *last = g_build_filename(folder, "d_8.png", NULL);
    FlPicture *picture = fl_picture_read_png(last, &error);
    g_assert_no_error(error);
    return picture;
}

/* The red of a page where a blue coat has left, and there a limb below it, if any, a little later.
 */
static double red_behind_coat(bool limb, const char *stain, const char *painted)
{
    g_auto(GStrv) frames = g_new0(char *, 9);
    for (int f = 1; f <= 8; f++)
        frames[f - 1] = g_strdup_printf("<path d='M%d 20h5v60h-5z' fill='#a53' display='%s'/>"
                                        "<path d='M%d 15h30v70h-30z' fill='#23a'/>",
                                        f < 7 ? 27 : 90, limb ? "inline" : "none", 17 + 3 * f);
    FlPicture *picture = last_of(frames, 96, stain, painted);
    double sum = 0;
    for (int y = 28; y < 68; y++)
        for (int x = 27; x < 31; x++)
            sum += picture->rgba[4 * (y * 96 + x)];
    fl_picture_free(picture);
    return sum / (4 * 40);
}

/* The mean of a channel, 8 px around a place. */
static double mean_at(const FlPicture *picture, int x, int y, int channel)
{
    double sum = 0;
    for (int k = 0; k < 81; k++)
        sum += picture->rgba[4 * ((y - 4 + k / 9) * picture->width + x - 4 + k % 9) + channel];
    return sum / 81;
}

/* Blue less red. */
static double blue_at(const FlPicture *picture, int x, int y)
{
    return mean_at(picture, x, y, 2) - mean_at(picture, x, y, 0);
}

/* The change of a channel of the ground that a shape has left, from x to x + width; the ground
 * comes up by `rocks` px in every other frame, and below it something sinks. */
static double change_on(const char *figure, const char *fill, int x, int width, int rocks,
                        int sinks, int channel)
{
    double mean[2];
    for (int k = 0; k < 2; k++) {
        g_auto(GStrv) frames = g_new0(char *, 9);
        for (int f = 1; f <= 8; f++)
            frames[f - 1] = g_strdup_printf("<path d='M22 %dh16v80h-16z' fill='#c93'/>"
                                            "<path d='M%d %dh%dv36h%dz' fill='%s'/>"
                                            "<path d='M%d 68h20v20h-20z' fill='%s'/>",
                                            9 + sinks * f, x, 60 - rocks * (f % 2), width, -width,
                                            fill, f < 7 ? 12 + 6 * f : 900, figure);
        FlPicture *picture = last_of(frames, 96, k ? "1" : "0", NULL);
        mean[k] = mean_at(picture, 30, 78, channel);
        fl_picture_free(picture);
    }
    return mean[1] - mean[0];
}

/* A resting region that spans the page is ground, which stains darken; they thin dark ground, those
 * of white paint as well. No ground are a face, water that moves, and hills before a mover. */
static void test_ground(void)
{
    const double pale = change_on("#d33", "#cdc", -9, 114, 0, 0, 2),
                 dark = change_on("#d33", "#112", -9, 114, 0, 0, 0);
    g_test_message("blue of pale ground %+.1f, red of dark ground %+.1f", pale, dark);
    g_assert_cmpfloat(pale, <, -4);
    g_assert_cmpfloat(dark, >, 2);
    g_assert_cmpfloat(change_on("#fff", "#112", -9, 114, 0, 0, 0), >, 1);
    g_assert_cmpfloat(change_on("#d33", "#cdc", 2, 92, 0, 0, 2), ==, 0);
    g_assert_cmpfloat(fabs(change_on("#d33", "#cdc", -9, 114, 2, 0, 2)), <, 0.5);
    g_assert_cmpfloat(fabs(change_on("#d33", "#cdc", -9, 114, 0, 7, 2)), <, 0.5);
}

/* A stain at the top of the page turns with the ground, clockwise by 32 degrees. */
static void test_camera(void)
{
    g_auto(GStrv) frames = g_new0(char *, 9);
    for (int f = 1; f <= 8; f++)
        frames[f - 1] = g_strdup_printf(
            "<g transform='rotate(%d 48 48)'><path d='M-99-99h300v300h-300z' fill='#eee'/>"
            "<path d='M%d 14h14v14h-14z' fill='#23a'/></g>",
            8 * MAX(f - 4, 0), f < 5 ? 30 + 6 * f : 900);
    FlPicture *picture = last_of(frames, 96, "1", NULL);
    const double turned = blue_at(picture, 60, 24), left = blue_at(picture, 45, 21);
    const double back = blue_at(picture, 31, 27);
    g_test_message("blue %.1f where it has turned to, %.1f where it was, %.1f the other way",
                   turned, left, back);
    g_assert_cmpfloat(turned, >, left + 3);
    g_assert_cmpfloat(turned, >, back + 3);
    fl_picture_free(picture);
}

/* A house that goes with a meadow of a third of the page, before hills that go half as far, leaves
 * nothing in the sky; one that goes over the meadow alone leaves a stain. */
static void test_pan(void)
{
    double blue[2][2];
    for (int k = 0; k < 4; k++) {
        g_auto(GStrv) frames = g_new0(char *, 9);
        for (int f = 1; f <= 8; f++)
            frames[f - 1] =
                g_strdup_printf("<path d='M%d 40h200v40h-200z' fill='#9ab'/>"
                                "<path d='M%d 62h200v40h-200z' fill='#9b6'/><path d='M%d "
                                "10h20v20h-20z' fill='#a53'/>",
                                -40 + (k & 1) * 3 * f, -60 + (k & 1) * 6 * f, 10 + 6 * f);
        FlPicture *picture = last_of(frames, 96, k & 2 ? "1" : "0", NULL);
        blue[k >> 1][k & 1] = mean_at(picture, 50, 20, 2);
        fl_picture_free(picture);
    }
    g_test_message("blue of the sky behind a house %.1f, of one that a camera passes %.1f of %.1f",
                   blue[1][0], blue[1][1], blue[0][0]);
    g_assert_cmpfloat(blue[1][0], <, blue[0][0] - 4);
    g_assert_cmpfloat(fabs(blue[1][1] - blue[0][1]), <, 0.5);
}

/* Blue of a sky at x, which a square has passed, by `way` px a frame, behind ground that moves to
 * the side or up or before it. */
static double sky_at(int x, int way, int pans, int rises, bool behind)
{
    g_auto(GStrv) frames = g_new0(char *, 9);
    for (int f = 1; f <= 8; f++) {
        g_autofree char *square =
            g_strdup_printf("<path d='M%d 10h20v20h-20z' fill='#a53'/>", 10 + way * f);
        frames[f - 1] = g_strdup_printf("<path d='M-9 -9h118v118h-118z' fill='#def'/>%s"
                                        "<path d='M%d %dh300v90h-300z' fill='#9b6'/>%s",
                                        behind ? square : "", pans * f - 90, 55 - rises * f,
                                        behind ? "" : square);
    }
    FlPicture *picture = last_of(frames, 96, "1", NULL);
    const double blue = mean_at(picture, x, 20, 2);
    fl_picture_free(picture);
    return blue;
}

/* Water that rises is no camera; a resting moon leaves no trail as a meadow moves before it. */
static void test_tide(void)
{
    const double before = sky_at(45, 6, 0, 0, false), tide = sky_at(45, 6, 0, 2, false);
    const double none = sky_at(45, 0, 0, 0, false);
    const double moon = sky_at(36, 0, 0, 0, true), passed = sky_at(36, 0, 6, 0, true);
    g_test_message("blue of the sky behind a bird %.1f, over a tide %.1f, of none %.1f; beside a "
                   "moon %.1f, as a meadow moves %.1f",
                   before, tide, none, moon, passed);
    g_assert_cmpfloat(before, <, none - 4);
    g_assert_cmpfloat(fabs(tide - before), <, 0.5);
    g_assert_cmpfloat(fabs(passed - moon), <, 0.5);
}

enum { WIDE = 360 }; // px, of a page whose cells have 2

/* A page on which a shape has left its stain after the ground has gone by `way` px to the right. */
static FlPicture *after_camera(double way, const char *stain)
{
    g_auto(GStrv) frames = g_new0(char *, 9);
    for (int f = 1; f <= 8; f++)
        frames[f - 1] =
            g_strdup_printf("<path d='M%g-99h300v300h-300z' fill='#eee'/>"
                            "<path d='M%d 40h14v14h-14z' fill='#23a'/>",
                            -99 + (f > 1 ? way * 96 / WIDE : 0), f < 7 ? 18 + 6 * f : 900);
    return last_of(frames, WIDE, stain, "8");
}

/* The middle of that stain, px; bare: the page without it. */
static double middle_of_stain(const FlPicture *bare, double way)
{
    double sum = 0, all = 0;
    FlPicture *page = after_camera(way, "1");
    for (int p = 0; p < WIDE * page->height; p++) {
        const int stain = bare->rgba[4 * p] - page->rgba[4 * p];
        sum += stain * (p % WIDE), all += stain;
    }
    fl_picture_free(page);
    g_assert_cmpfloat(all, >, 1000);
    return sum / all;
}

/* A part of a cell that the camera has gone is no part of the stain's way. */
static void test_part_of_a_cell(void)
{
    FlPicture *bare = after_camera(0, "0");
    const double still = middle_of_stain(bare, 0), moved = middle_of_stain(bare, 0.8);
    g_test_message("the middle of a stain at %.2f, and at %.2f after the camera", still, moved);
    g_assert_cmpfloat_with_epsilon(still, moved, 0.5);
    fl_picture_free(bare);
}

/* A limb that leaves shows no hole in the stain of a coat that was above it. A film that starts
 * late has the stain as well, though fainter, of frames that are not painted. */
static void test_limb(void)
{
    const double bare = red_behind_coat(false, "0", NULL),
                 stain = red_behind_coat(false, "1", NULL);
    const double limb = red_behind_coat(true, "1", NULL), late = red_behind_coat(false, "1", "8");
    g_test_message("red of bare paper %.2f, of a stain %.2f, of one below a limb %.2f, late %.2f",
                   bare, stain, limb, late);
    g_assert_cmpfloat(stain, <, bare - 4);
    g_assert_cmpfloat(limb, <, stain + 0.5 * (bare - stain));
    g_assert_cmpfloat(late, <, stain + 0.75 * (bare - stain));
}

/* The red of the page that a blue coat has just left, below a hand that lay over its edge, if any,
 * and swings away. */
static double red_below_hand(bool hand, const char *stain, const char *painted)
{
    g_auto(GStrv) frames = g_new0(char *, 9);
    for (int f = 1; f <= 8; f++)
        frames[f - 1] =
            g_strdup_printf("<path d='M%d 15h40v70h-40z' fill='#23a'/>"
                            "<path d='M%d 20h6v60h-6z' fill='#2a3' display='%s'/>",
                            17 + 3 * f, 13 + 3 * f + 2 * MAX(f - 5, 0), hand ? "inline" : "none");
    FlPicture *picture = last_of(frames, 288, stain, painted);
    double sum = 0;
    for (int y = 90; y < 210; y++)
        for (int x = 102; x < 120; x++)
            sum += picture->rgba[4 * (y * 288 + x)];
    fl_picture_free(picture);
    return sum / (18 * 120);
}

/* What leaves in the same moment below a quick shape is not taken up by that. */
static void test_hand(void)
{
    const double bare = red_below_hand(false, "0", NULL), stain = red_below_hand(false, "1", NULL),
                 hand = red_below_hand(true, "1", NULL);
    g_test_message("red of bare paper %.2f, of a stain %.2f, of one below a hand %.2f", bare, stain,
                   hand);
    g_assert_cmpfloat(stain, <, bare - 4);
    g_assert_cmpfloat(hand, <, stain + 0.3 * (bare - stain));
}

/* A stain from before a film's first painted frame is as strong as if all had been painted. */
static void test_late(void)
{
    const double bare = red_below_hand(false, "0", NULL), stain = red_below_hand(false, "1", NULL),
                 late = red_below_hand(false, "1", "8");
    g_test_message("red of bare paper %.2f, of a stain %.2f, of one from before %.2f", bare, stain,
                   late);
    g_assert_cmpfloat(fabs(late - stain), <, 0.05 * (bare - stain));
}

/* The most ink of the fronts of a disk of region 3 where paint of a region was seen, of any colour
 * but the disk's own: in places up to so far from the middle of the disk. */
static float most_ink(int16_t region, float pace, float radius)
{
    Scene *scene = scene_new();
    scene->pace = pace;
    float most = 0;
    draw_disk(80, radius, scene->before);
    for (int p = 0; p < PIXELS; p++)
        scene->region[p] = scene->before[p] > 0 ? region : -1;
    scene->shape.region = 3;
    mark(scene, 80, 86, 0);
    g_assert_cmpuint(scene->fronts->len, >, 0);
    for (guint i = 0; i < scene->fronts->len; i++) {
        const float *ink = g_array_index(scene->fronts, FlFrontMark, i).ink;
        g_assert_cmpfloat(fabsf(ink[0] - ink[2]), <, 1e-4f);
        most = MAX(most, ink[0]);
    }
    scene_free(scene);
    return most;
}

/* Paint that is seen runs ahead: that of a shape above where the shape's own was never seen or both
 * end at one edge, and none of a shape that has faded. */
static void test_seen_paint(void)
{
    const float all = 4 * RADIUS, own = most_ink(3, 0, all);
    g_assert_cmpfloat(own, >, 0.1f);
    g_assert_cmpfloat(most_ink(4, 0, all), ==, own);
    g_assert_cmpfloat(most_ink(4, 1, all), ==, 0); // it had none before
    g_assert_cmpfloat(most_ink(4, 1, RADIUS), >, 0.9f * own);
    g_assert_cmpfloat(most_ink(2, 0, all), ==, 0);
    g_assert_cmpfloat(most_ink(-1, 0, all), ==, 0);
}

/* A shape that grows further than paint is looked for has the colour of its earlier edge. */
static void test_grown(void)
{
    Scene *scene = scene_new();
    draw_disk(80, RADIUS, scene->before);
    for (int p = 0; p < PIXELS; p++)
        scene->region[p] = scene->before[p] > 0 ? 0 : -1;
    scene->pace = 1;
    mark(scene, 80, 80, 14);
    g_assert_cmpuint(scene->fronts->len, >, 0);
    for (guint i = 0; i < scene->fronts->len; i++)
        g_assert_cmpfloat(g_array_index(scene->fronts, FlFrontMark, i).ink[0], >, 0.5f);
    scene_free(scene);
}

/* The darkness of the green of a layer, summed. */
static double darkness(const Scene *scene)
{
    static const uint8_t paper[3] = {250, 240, 230};
    FlStainLayer layer;
    double sum = 0;
    g_assert_true(fl_wet_sheet_layer(&scene->sheet, paper, &layer, NULL));
    for (size_t p = 0; layer.rgba && p < fl_rect_pixels(layer.box); p++) {
        const uint8_t *rgba = layer.rgba + 4 * p;
        sum += (paper[1] - rgba[1]) * rgba[3] / 255.0;
    }
    free(layer.rgba);
    return sum;
}

/* Water on the paper dries through some frames, and is not gone from one to the next. */
static void test_film(void)
{
    Scene *scene = scene_new();
    FlFrontStyle water = plain;
    water.stain = 0.01f, water.film = 1;
    mark(scene, 80, 86, 0);
    for (guint i = 0; i < scene->stains->len; i++)
        g_array_index(scene->stains, FlStainMark, i).depth = 14;
    fl_wet_sheet_stain(&scene->sheet, &water, scene->stains);
    const double first = darkness(scene);
    double most = 0;
    for (double now = first, last = now; now > 0; last = now) {
        fl_wet_sheet_dry(&scene->sheet, 1);
        now = darkness(scene);
        most = MAX(most, last - now);
    }
    g_test_message("%.0f, of which at most %.0f dry in a frame", first, most);
    g_assert_cmpfloat(most, <, 0.45 * first);
    scene_free(scene);
}

static void test_dries(void)
{
    Scene *scene = scene_new();
    scene->pace = 6, scene->receded = 48;
    mark(scene, 80, 86, 0);
    fl_wet_sheet_stain(&scene->sheet, &plain, scene->stains);
    fl_wet_sheet_wet(&scene->sheet, &plain, 1, scene->fronts);
    double last = darkness(scene);
    g_assert_cmpfloat(last, >, 1000);
    for (int k = 0; k < 40; k++) {
        fl_wet_sheet_dry(&scene->sheet, 1);
        const double now = darkness(scene);
        g_assert_cmpfloat(now, <=, last);
        g_assert_true(k > 20 || now > last / 2); // not at once
        last = now;
    }
    g_assert_cmpfloat(last, ==, 0);
    g_assert_cmpint(scene->sheet.wet.width, ==, 0);
    scene_free(scene);
}

static void test_moved(void)
{
    Scene *scene = scene_new();
    mark(scene, 80, 86, 0);
    fl_wet_sheet_stain(&scene->sheet, &plain, scene->stains);
    const double before = darkness(scene);
    const FlRect wet = scene->sheet.wet;
    const FlAffine from = {1, 0, 0, 1, -7, 3};
    g_assert_true(fl_wet_sheet_turn(&scene->sheet, &from, NULL));
    g_assert_cmpint(abs(scene->sheet.wet.x - wet.x - 7), <=, 1);
    g_assert_cmpint(abs(scene->sheet.wet.y - wet.y + 3), <=, 1);
    g_assert_cmpfloat(darkness(scene), ==, before);
    scene_free(scene);
}

static float stain_of(const Scene *scene)
{
    float sum = 0;
    for (int p = 0; p < PIXELS; p++)
        sum += scene->sheet.cell[p].stain;
    return sum;
}

/* A quarter of a turn; the cell at (x, y) has come from (y, SIDE - 1 - x). */
static void test_turned(void)
{
    const FlAffine from = {.xx = 0, .yx = -1, .xy = 1, .yy = 0, .x0 = 0, .y0 = SIDE - 1};
    const int x = 37, y = 90, was = (SIDE - 1 - x) * SIDE + y;
    Scene *scene = scene_new();
    mark(scene, 80, 86, 0);
    fl_wet_sheet_stain(&scene->sheet, &plain, scene->stains);
    const float before = stain_of(scene);
    const FlPaperGrains grain = fl_wet_sheet_grain(&scene->sheet, was);
    const FlRect wet = scene->sheet.wet;
    g_assert_true(fl_wet_sheet_turn(&scene->sheet, &from, NULL));
    const FlPaperGrains now = fl_wet_sheet_grain(&scene->sheet, y * SIDE + x);
    g_assert_cmpint(now.hollow, ==, grain.hollow);
    g_assert_cmpint(now.spot, ==, grain.spot);
    g_assert_cmpfloat(fabsf(stain_of(scene) - before), <, 1e-3f * before);
    g_assert_cmpint(abs(scene->sheet.wet.width - wet.height), <=, 1);
    scene_free(scene);
}

/* The share of a stain that stays where paint passes so far from its own sides. */
static float share_left(float depth)
{
    Scene *scene = scene_new();
    mark(scene, 80, 86, 0);
    for (guint i = 0; i < scene->stains->len; i++)
        g_array_index(scene->stains, FlStainMark, i).depth = 14;
    fl_wet_sheet_stain(&scene->sheet, &plain, scene->stains);
    const float before = stain_of(scene);
    g_assert_cmpfloat(before, >, 20);
    for (guint i = 0; i < scene->stains->len; i++) {
        FlStainMark *mark = &g_array_index(scene->stains, FlStainMark, i);
        mark->charge = 0, mark->lost = 1, mark->depth = depth;
    }
    fl_wet_sheet_take_up(&scene->sheet, scene->stains);
    const float share = stain_of(scene) / before;
    scene_free(scene);
    return share;
}

static void test_taken_up(void)
{
    const float sides = share_left(6);
    g_assert_cmpfloat(share_left(14), ==, 0);
    g_assert_cmpfloat(sides, >, 0.2f);
    g_assert_cmpfloat(sides, <, 0.9f);
}

/* The darkness of a stain all of which is so far from its sides, below a front if it is wet. */
static double darkness_of_depth(float depth, bool wet)
{
    Scene *scene = scene_new();
    mark(scene, 80, 86, 0);
    for (guint i = 0; i < scene->stains->len; i++)
        g_array_index(scene->stains, FlStainMark, i).depth = depth;
    fl_wet_sheet_stain(&scene->sheet, &plain, scene->stains);
    for (int p = 0; p < PIXELS && wet; p++)
        if (scene->sheet.cell[p].stain > 0)
            scene->sheet.cell[p].front = 0.5f, scene->sheet.cell[p].edge = 3;
    const double sum = darkness(scene);
    scene_free(scene);
    return sum;
}

static void test_frayed(void)
{
    const double middle = darkness_of_depth(14, false), sides = darkness_of_depth(5, false);
    g_assert_cmpfloat(sides, >, 0.05 * middle);
    g_assert_cmpfloat(sides, <, 0.8 * middle);
    g_assert_cmpfloat(darkness_of_depth(5, true), >, 0.97 * darkness_of_depth(14, true));
}

/* A cell after a front that has not come to it, over a stain and so much of an earlier front. */
static FlWetCell cell_before_front(float front)
{
    Scene *scene = scene_new();
    const FlFrontMark mark = {.at = 5, .density = 0.5f, .edge = -1.5f, .ink = {0, 0, 1}};
    scene->sheet.cell[mark.at] =
        (FlWetCell){.front = front, .edge = 1.6f, .stain = 0.2f, .film = 0.2f, .ink = {1, 0, 0}};
    g_array_append_val(scene->fronts, mark);
    fl_wet_sheet_wet(&scene->sheet, &plain, 1, scene->fronts);
    const FlWetCell cell = scene->sheet.cell[mark.at];
    scene_free(scene);
    return cell;
}

/* The end of a front is its own over what is left of another, and the stain keeps its colour. */
static void test_front_over_stain(void)
{
    const FlWetCell left = cell_before_front(0.01f), wet = cell_before_front(0.4f);
    g_assert_cmpfloat(left.front, >, 0.2f);
    g_assert_cmpfloat(left.edge, <, -1);
    g_assert_cmpfloat(left.ink[2], <, 0.02f);
    g_assert_cmpfloat(wet.edge, >, 1.4f);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/wet/a-front-runs-ahead-and-a-stain-stays-behind", test_ahead);
    g_test_add_func("/wet/a-front-spreads-in-some-frames", test_spreads);
    g_test_add_func("/wet/a-front-ends-where-its-shape-stops", test_stop);
    g_test_add_func("/wet/black-paint-leaves-a-light-stain", test_black);
    g_test_add_func("/wet/a-quick-shape-leaves-less", test_quick);
    g_test_add_func("/wet/a-turn-after-quick-motion-leaves-less", test_turn);
    g_test_add_func("/wet/a-disk-that-spins-passes-straight-on", test_spin);
    g_test_add_func("/wet/stains-know-how-far-their-sides-are", test_sides);
    g_test_add_func("/wet/stains-at-the-side-of-the-page", test_comes_in);
    g_test_add_func("/wet/stains-break-up-where-they-begin", test_start);
    g_test_add_func("/wet/stains-break-up-below-other-figures", test_touched);
    g_test_add_func("/wet/marks-lie-in-place-between-cells", test_beside);
    g_test_add_func("/wet/paint-that-passes-takes-up-a-stain", test_taken_up);
    g_test_add_func("/wet/a-stain-breaks-up-towards-its-sides", test_frayed);
    g_test_add_func("/wet/a-front-ends-alike-on-stains", test_front_over_stain);
    g_test_add_func("/wet/a-few-fingers-are-long-and-many-short", test_fingers);
    g_test_add_func("/wet/a-retreat-is-whole", test_retreat);
    g_test_add_func("/wet/a-stroke-advances-at-its-end-and-not-at-its-sides", test_stroke);
    g_test_add_func("/wet/what-rests-marks-nothing", test_rest);
    g_test_add_func("/wet/what-vanishes-leaves-less-than-what-recedes", test_vanish);
    g_test_add_func("/wet/fronts-go-with-a-shape-that-jumps", test_jump);
    g_test_add_func("/wet/paint-on-other-paint-marks-nothing", test_other_paint);
    g_test_add_func("/wet/a-limb-that-leaves-shows-no-hole-in-a-stain", test_limb);
    g_test_add_func("/wet/a-hand-that-swings-away-takes-up-no-stain", test_hand);
    g_test_add_func("/wet/a-film-that-starts-late-has-its-stains", test_late);
    g_test_add_func("/wet/seen-paint-runs-ahead", test_seen_paint);
    g_test_add_func("/wet/what-grows-keeps-its-colour", test_grown);
    g_test_add_func("/wet/marks-fade-until-none-is-left", test_dries);
    g_test_add_func("/wet/water-dries-through-some-frames", test_film);
    g_test_add_func("/wet/marks-and-grain-move-with-the-paper", test_moved);
    g_test_add_func("/wet/a-stain-turns-with-the-ground", test_camera);
    g_test_add_func("/wet/houses-of-a-panned-meadow-leave-nothing", test_pan);
    g_test_add_func("/wet/a-tide-and-a-moon-leave-the-paper-as-it-is", test_tide);
    g_test_add_func("/wet/ground-is-stained-and-a-face-is-not", test_ground);
    g_test_add_func("/wet/a-stain-stays-in-place-between-cells", test_part_of_a_cell);
    g_test_add_func("/wet/the-paper-turns-with-the-camera", test_turned);
    return g_test_run();
}
