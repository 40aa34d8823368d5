/* Moving ink: as much of it as there was, and a region's from frame to frame. */
#include "base/alloc.h"
#include "base/compress.h"
#include "base/density.h"
#include "base/rng.h"
#include "bundled_style.h"
#include "moving_disk.h"
#include "transport/material_layers.h"

#include <math.h>
#include <string.h>
#ifdef _OPENMP
#include <omp.h>
#endif

static void ink_is_neither_made_nor_lost(void)
{
    Disk *disk = disk_new(1);
    double deviation;
    for (int frame = 0; frame < 4; frame++) {
        disk_frame(disk, 50 + 3 * (float)frame, 3);
        g_assert_cmpfloat(fabs(mean_of(disk, &deviation) - 1), <, 1e-5);
        g_assert_cmpfloat(deviation, >, 0.3); // and it has moved
    }
    disk_free(disk);
}

/* The same before the scalar that makes it exact: the map itself keeps the area of the shape. */
static void the_map_itself_keeps_the_ink(void)
{
    g_auto(FlFlowMap) map = {0};
    g_autofree float *velocity = g_new(float, 2 * PIXELS);
    double mask = 0, sum = 0;
    g_assert_true(fl_flow_map_init(&map, SIDE, SIDE, false, NULL));
    for (size_t p = 0; p < PIXELS; p++) {
        const float depth = 40 - hypotf((float)(p % SIDE) - 60, (float)(p / SIDE) - 60);
        const float t = fminf(fmaxf(depth / 6, 0), 1), taper = t * t * (3 - 2 * t);
        velocity[2 * p] = 5 * taper * cosf((float)(p % SIDE) * 0.26f);
        velocity[2 * p + 1] = 5 * taper * sinf((float)(p / SIDE) * 0.26f);
    }
    fl_flow_map_run(&map, velocity);
    for (size_t p = 0; p < PIXELS; p++)
        if (hypotf((float)(p % SIDE) - 60, (float)(p / SIDE) - 60) < 40)
            mask++, sum += map.jacobian[p];
    g_test_message("%.4f of the ink", sum / mask);
    g_assert_cmpfloat(fabs(sum / mask - 1), <, 0.02);
}

static void no_strength_is_a_flat_fill(void)
{
    Disk *disk = disk_new(0);
    draw_disk(&disk->guides, 60, 0);
    g_assert_true(fl_carried_ink_frame(disk->ink, &disk->guides, disk->rgb, NULL));
    const uint8_t *middle = disk->rgb + 3 * (60 * SIDE + 60);
    for (size_t p = 0; p < PIXELS; p++)
        if (disk->guides.mask[p])
            g_assert_cmpmem(disk->rgb + 3 * p, 3, middle, 3);
    disk_free(disk);
}

/* ---- a reference: the same in doubles, as its formulas are written ------------------------------
 */

typedef double Plane[SIDE * SIDE];

static double between(const double *plane, double x, double y)
{
    x = CLAMP(x, 0, SIDE - 1), y = CLAMP(y, 0, SIDE - 1);
    const int x0 = (int)fmin(x, SIDE - 2), y0 = (int)fmin(y, SIDE - 2);
    const double *p = plane + (ptrdiff_t)y0 * SIDE + x0, fx = x - x0, fy = y - y0;
    return (1 - fy) * ((1 - fx) * p[0] + fx * p[1]) + fy * ((1 - fx) * p[SIDE] + fx * p[SIDE + 1]);
}

/* u(x) becomes u(x) + u(x + u(x)). */
static void square_map(Plane u[2])
{
    static Plane next[2];
    for (int p = 0; p < SIDE * SIDE; p++)
        for (int c = 0; c < 2; c++)
            next[c][p] = u[c][p] + between(u[c], p % SIDE + u[0][p], p / SIDE + u[1][p]);
    memcpy(u, next, sizeof next);
}

static double slope_of(const double *plane, int p, bool down)
{
    const int step = down ? SIDE : 1, at = down ? p / SIDE : p % SIDE;
    const int before = at > 0 ? p - step : p, after = at < SIDE - 1 ? p + step : p;
    return (plane[after] - plane[before]) / 2;
}

/* The map of a first frame, backwards. */
static void reference_map(const Disk *disk, Plane u[2])
{
    FlRng rng = {fl_hash64(3)};
    const float left = 96 * fl_rng_float(&rng), top = 96 * fl_rng_float(&rng);
    for (int p = 0; p < SIDE * SIDE; p++) {
        const double depth = (double)disk->guides.distance[p], t = CLAMP(depth / 5, 0, 1);
        float g[2];
        fl_tile_gradient(disk->tile, (float)(p % SIDE) + left, (float)(p / SIDE) + top, g);
        const double way = t * t * (3 - 2 * t) * hypot((double)g[0], (double)g[1]);
        const double share = t * t * (3 - 2 * t) * fmin(depth / 2 / fmax(way, 1e-9), 1);
        for (int c = 0; c < 2; c++)
            u[c][p] = disk->guides.mask[p] ? -share * (double)g[c] / 8 : 0;
    }
    for (int k = 0; k < 3; k++)
        square_map(u);
}

static void a_frame_is_what_the_formulas_say(void)
{
    static Plane u[2], amount;
    Disk *disk = disk_new(1);
    disk_frame(disk, 60, 0);
    reference_map(disk, u);
    double mask = 0, sum = 0, most = 0;
    for (int p = 0; p < SIDE * SIDE; p++) {
        amount[p] = (1 + slope_of(u[0], p, false)) * (1 + slope_of(u[1], p, true)) -
                    slope_of(u[0], p, true) * slope_of(u[1], p, false);
        amount[p] = fmax(amount[p], 0);
        mask += disk->guides.mask[p], sum += disk->guides.mask[p] * amount[p];
    }
    for (int p = 0; p < SIDE * SIDE; p++)
        if (disk->guides.mask[p])
            most = fmax(most, fabs(amount[p] * mask / sum - (double)disk->amount[p]));
    g_test_message("largest difference %.6f of an amount of 1", most);
    g_assert_cmpfloat(most, <, 1e-4);
    disk_free(disk);
}

static void the_pattern_rides_on_the_drawing(void)
{
    Disk *disk = disk_new(1);
    disk_frame(disk, 50, 0);
    g_autofree float *first = g_memdup2(disk->amount, sizeof disk->amount);
    for (int frame = 1; frame <= 8; frame++)
        disk_frame(disk, 50 + 2.5f * (float)frame, 2.5f); // 20 px in all
    double difference = 0, n = 0, deviation;
    mean_of(disk, &deviation);
    for (size_t p = 0; p + 20 < PIXELS; p++)
        if (p % SIDE + 20 < SIDE && disk->guides.distance[p + 20] > 3)
            difference += fabs((double)disk->amount[p + 20] - first[p]), n++;
    g_test_message("difference %.4f, deviation %.4f", difference / n, deviation);
    g_assert_cmpfloat(difference / n, <, 0.02 * deviation);
    disk_free(disk);
}

static void a_region_at_rest_has_the_same_bytes(void)
{
    Disk *disk = disk_new(1);
    disk_frame(disk, 55.3f, 0);
    g_autofree float *first = g_memdup2(disk->amount, sizeof disk->amount);
    disk_frame(disk, 55.3f, 0);
    g_assert_cmpmem(disk->amount, sizeof disk->amount, first, sizeof disk->amount);
    disk_free(disk);
}

static void the_same_bytes_on_any_thread_count(void)
{
#ifdef _OPENMP
    g_autofree float *one = NULL;
    const int most = omp_get_max_threads();
    for (int threads = 1; threads <= 5; threads += 2) {
        omp_set_num_threads(threads);
        Disk *disk = disk_new(1);
        disk_frame(disk, 50, 0);
        disk_frame(disk, 52.3f, 2.3f);
        if (one)
            g_assert_cmpmem(disk->amount, sizeof disk->amount, one, sizeof disk->amount);
        else
            one = g_memdup2(disk->amount, sizeof disk->amount);
        disk_free(disk);
    }
    omp_set_num_threads(most);
#else
    g_test_skip("built without OpenMP");
#endif
}

static void a_state_continues_as_if_nothing_had_been(void)
{
    Disk *disk = disk_new(1), *other = disk_new(1);
    disk_frame(disk, 50, 0), disk_frame(disk, 52.6f, 2.6f);
    g_autoptr(GBytes) state = fl_carried_ink_save(disk->ink, NULL);
    g_assert_true(fl_carried_ink_load(other->ink, state, NULL));
    disk_frame(disk, 55, 2.4f), disk_frame(other, 55, 2.4f);
    g_assert_cmpmem(disk->amount, sizeof disk->amount, other->amount, sizeof disk->amount);
    disk_free(disk);
    disk_free(other);
}

static void a_damaged_state_is_refused(void)
{
    Disk *disk = disk_new(1);
    disk_frame(disk, 50, 0);
    g_autoptr(GBytes) state = fl_carried_ink_save(disk->ink, NULL);
    gsize size;
    g_autofree uint8_t *bytes = g_memdup2(g_bytes_get_data(state, NULL), g_bytes_get_size(state));
    size = g_bytes_get_size(state);
    const gsize cuts[] = {0, 7, 20, size - 1};
    for (gsize k = 0; k < G_N_ELEMENTS(cuts); k++) {
        g_autoptr(GBytes) cut = g_bytes_new(bytes, cuts[k]);
        g_autoptr(GError) error = NULL;
        g_assert_false(fl_carried_ink_load(disk->ink, cut, &error));
        g_assert_error(error, FL_ERROR, FL_ERROR_CHANGED);
    }
    int32_t header[5]; // planes, x, y, width, height
    memcpy(header, bytes, sizeof header);
    const gsize plane = 2 * sizeof(float) * (gsize)(header[3] * header[4]);
    g_autofree uint8_t *wild_shift = g_malloc(plane);
    memset(wild_shift, 0xff, plane); // not a number
    g_autoptr(GBytes) wild =
        fl_pack(header, sizeof header, &(FlSpan){wild_shift, plane}, header[0], NULL);
    g_autoptr(GError) error = NULL;
    g_assert_false(fl_carried_ink_load(disk->ink, wild, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_CHANGED);
    disk_free(disk);
}

/* The disk's drawing is enlarged about x = 60 by `right` and `left` of its sides, a share a frame.
 */
static void stretch_disk(Disk *disk, float left, float right)
{
    for (size_t p = 0; p < PIXELS; p++) {
        const float x = (float)(p % SIDE) - 60, y = (float)(p / SIDE) - 60;
        const float by = (x < 0 ? left : right) * FL_MOTION_ONE;
        disk->guides.motion[2 * p] = (int32_t)(x * by);
        disk->guides.motion[2 * p + 1] = (int32_t)(x < 0 && left == 0 ? 0 : y * by);
    }
    g_assert_true(fl_carried_ink_amounts(disk->ink, &disk->guides, disk->amount, NULL));
}

/* The mean change of the amounts at pixels of the disk between two columns. */
static double change_in(const Disk *disk, const float *before, size_t x0, size_t x1)
{
    double change = 0, n = 0;
    for (size_t p = 0; p < PIXELS; p++)
        if (disk->guides.mask[p] && p % SIDE >= x0 && p % SIDE < x1)
            change += fabs((double)disk->amount[p] - (double)before[p]), n++;
    return change / n;
}

/* A shape that doubles its size within 40 frames gets a pattern of its own size again; nothing
 * jumps meanwhile, and at rest it comes to rest. */
static void what_is_stretched_is_laid_anew_by_and_by(void)
{
    Disk *disk = disk_new(1);
    double most = 0, deviation;
    draw_disk(&disk->guides, 60, 0);
    stretch_disk(disk, 0, 0);
    g_autofree float *before = g_memdup2(disk->amount, sizeof disk->amount);
    for (int frame = 0; frame < 40; frame++) {
        stretch_disk(disk, 0.02f, 0.02f);
        most = fmax(most, change_in(disk, before, 0, SIDE));
        memcpy(before, disk->amount, sizeof disk->amount);
        mean_of(disk, &deviation);
        g_assert_cmpfloat(deviation, >, 0.25); // a fade keeps the contrast
    }
    g_test_message("largest change %.3f", most);
    g_assert_cmpfloat(most, <, 0.25);
    for (int frame = 0; frame < 80; frame++)
        memcpy(before, disk->amount, sizeof disk->amount), stretch_disk(disk, 0, 0);
    g_assert_cmpmem(disk->amount, sizeof disk->amount, before, sizeof disk->amount);
    disk_free(disk);
}

/* Where only one half is stretched, the other one keeps its pattern. */
static void what_is_not_stretched_stays(void)
{
    Disk *disk = disk_new(1);
    draw_disk(&disk->guides, 60, 0);
    stretch_disk(disk, 0, 0);
    g_autofree float *first = g_memdup2(disk->amount, sizeof disk->amount);
    for (int frame = 0; frame < 30; frame++)
        stretch_disk(disk, 0, 0.02f);
    for (int frame = 0; frame < 12; frame++)
        stretch_disk(disk, 0, 0);
    const double left = change_in(disk, first, 0, 45), right = change_in(disk, first, 60, SIDE);
    g_test_message("changes: %.4f left, %.4f right", left, right);
    g_assert_cmpfloat(left, <, 0.01);
    g_assert_cmpfloat(right, >, 0.2);
    disk_free(disk);
}

/* A shape that turns fast is squeezed at once, along one axis or turned over as well: its ink keeps
 * its contrast, however the material lies, and does not fold. */
static void what_is_squeezed_at_once_keeps_its_contrast(void)
{
    static const float factors[] = {1.8f, 2.5f, 3, -1, -2};
    for (size_t k = 0; k < G_N_ELEMENTS(factors); k++) {
        Disk *disk = disk_new(1);
        double before, after;
        float most = 0;
        draw_disk(&disk->guides, 60, 0);
        stretch_disk(disk, 0, 0);
        mean_of(disk, &before);
        for (size_t p = 0; p < PIXELS; p++)
            disk->guides.motion[2 * p] =
                (int32_t)((1 - factors[k]) * ((float)(p % SIDE) - 60) * FL_MOTION_ONE);
        g_assert_true(fl_carried_ink_amounts(disk->ink, &disk->guides, disk->amount, NULL));
        mean_of(disk, &after);
        for (size_t p = 0; p < PIXELS; p++)
            most = fmaxf(most, disk->amount[p]);
        g_test_message("%g: deviation %.3f, then %.3f, at most %.2f", (double)factors[k], before,
                       after, (double)most);
        g_assert_cmpfloat(fabs(after / before - 1), <, 0.25);
        disk_free(disk);
    }
}

static void a_state_in_a_fade_continues(void)
{
    Disk *disk = disk_new(1), *other = disk_new(1);
    draw_disk(&disk->guides, 60, 0), draw_disk(&other->guides, 60, 0);
    int32_t planes = 0;
    for (int frame = 0; frame < 40 && planes < 3; frame++) {
        stretch_disk(disk, 0, 0.03f);
        g_autoptr(GBytes) state = fl_carried_ink_save(disk->ink, NULL);
        memcpy(&planes, g_bytes_get_data(state, NULL), sizeof planes);
        g_assert_true(fl_carried_ink_load(other->ink, state, NULL));
    }
    g_assert_cmpint(planes, ==, 3); // two layers and their shares
    for (int frame = 0; frame < 4; frame++)
        stretch_disk(disk, 0, 0.03f), stretch_disk(other, 0, 0.03f);
    g_assert_cmpmem(disk->amount, sizeof disk->amount, other->amount, sizeof disk->amount);
    disk_free(disk);
    disk_free(other);
}

/* ---- two shapes --------------------------------------------------------------------------------
 */

/* Left of x = 65 everything has moved by 25 px, from there on nothing has. */
static void ink_stays_off_a_tear(void)
{
    g_auto(FlGuides) guides = {0};
    g_auto(FlMaterial) material = {{0, 0, SIDE, SIDE}, g_new0(float, 2 * PIXELS)};
    const FlMaterial no_share = {0};
    g_autofree float *whole = g_new(float, PIXELS);
    g_assert_true(fl_guides_init(&guides, SIDE, SIDE, NULL));
    for (size_t p = 0; p < PIXELS; p++) {
        guides.mask[p] = 255;
        material.shift[2 * p] = p % SIDE < 65 ? 25 : 0;
    }
    const float *row = whole + (size_t)SIDE * 60;
    g_assert_true(fl_material_whole(&material, &no_share, &guides, 8, whole, NULL));
    g_assert_cmpfloat(row[64], ==, 0); // there they meet
    g_assert_cmpfloat(row[60], >, 0);
    g_assert_cmpfloat(row[60], <, row[58]);
    g_assert_cmpfloat(row[50], ==, 1);
    g_assert_cmpfloat(row[80], ==, 1);
}

/* The amount at a place between pixels. */
static double amount_at(const float *amount, double x, double y)
{
    const int x0 = (int)floor(x), y0 = (int)floor(y);
    const double fx = x - x0, fy = y - y0;
    const float *a = amount + (ptrdiff_t)y0 * SIDE + x0;
    return (1 - fy) * ((1 - fx) * (double)a[0] + fx * (double)a[1]) +
           fy * ((1 - fx) * (double)a[SIDE] + fx * (double)a[SIDE + 1]);
}

/* The mean change along the motion within the taper, by the deviation of the pattern. */
static double flicker_of(Disk *disk, const Motion *m, int frames)
{
    const Motion rest = {.growth = 1};
    double change = 0, n = 0, deviation = 0;
    float before[PIXELS];
    for (int frame = 0; frame < frames; frame++) {
        const double x0 = m->shift != 0 ? 45 + (double)m->shift * frame : 60;
        const double radius = (m->growth > 1 ? 32 : 40) * pow((double)m->growth, frame);
        draw_moved(&disk->guides, frame ? m : &rest, x0, radius);
        g_assert_true(fl_carried_ink_amounts(disk->ink, &disk->guides, disk->amount, NULL));
        for (size_t p = 0; frame && p < PIXELS; p++) {
            double place[2];
            if (disk->guides.distance[p] <= 8)
                continue;
            place_before(m, x0, p, place);
            change += fabs((double)disk->amount[p] - amount_at(before, place[0], place[1])), n++;
        }
        memcpy(before, disk->amount, sizeof before);
        mean_of(disk, &deviation);
        g_assert_cmpfloat(deviation, >, 0.3);
    }
    return change / n / deviation;
}

/* What moves, grows, turns by a quarter or rests flickers no more than the bounds say. */
static void ink_does_not_flicker(void)
{
    static const Motion motions[] = {{"moving", 3, 0, 1, 0.005f},
                                     {"growing", 2.8f, 0, 1.012f, 0.015f},
                                     {"turning", 0, 0.0654498f, 1, 0.03f},
                                     {"at rest", 0, 0, 1, 0}};
    g_autofree char *smoke = bundled_style("14");
    for (size_t k = 0; k < G_N_ELEMENTS(motions); k++) {
        const Motion *m = &motions[k];
        Disk *disk = disk_new(1);
        fl_carried_ink_free(disk->ink);
        fl_tile_free(disk->tile);
        disk->tile = fl_tile_load(smoke, 1, NULL);
        disk->ink = ink_of(disk->tile, &disk->strength);
        const double flicker = flicker_of(disk, m, m->turn > 0 ? 24 : 10);
        g_test_message("%s: flicker %.4f", m->name, flicker);
        g_assert_cmpfloat(flicker, <=, (double)m->flicker);
        disk_free(disk);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/transport/" #name, name)
    TEST(ink_is_neither_made_nor_lost);
    TEST(the_map_itself_keeps_the_ink);
    TEST(no_strength_is_a_flat_fill);
    TEST(a_frame_is_what_the_formulas_say);
    TEST(the_pattern_rides_on_the_drawing);
    TEST(a_region_at_rest_has_the_same_bytes);
    TEST(the_same_bytes_on_any_thread_count);
    TEST(a_state_continues_as_if_nothing_had_been);
    TEST(a_damaged_state_is_refused);
    TEST(what_is_stretched_is_laid_anew_by_and_by);
    TEST(what_is_not_stretched_stays);
    TEST(what_is_squeezed_at_once_keeps_its_contrast);
    TEST(a_state_in_a_fade_continues);
    TEST(ink_stays_off_a_tear);
    TEST(ink_does_not_flicker);
    return g_test_run();
}
