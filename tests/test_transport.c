/* Moving ink: adjoints, mass, and the region's ink from frame to frame. */
#include "base/alloc.h"
#include "base/density.h"
#include "base/rng.h"
#include "transport/carried_ink.h"
#include "transport/style_ink.h"
#include "transport/material_layers.h"

#include <glib/gstdio.h>
#include <math.h>
#include <string.h>
#include <zlib.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#define N 48 // px, the sides of a torus
#define SIDE 120
#define PIXELS ((size_t)SIDE * SIDE)

static float noise(uint64_t key, size_t i)
{
    FlRng rng = {fl_key(key, i)};
    return 2 * fl_rng_float(&rng) - 1;
}

/* ---- adjoints ----------------------------------------------------------------------------------
 */

/* What is derived: the mean of by[i] * ink after a potential, and a little of the determinants. */
typedef struct Problem {
    FlPotential potential;
    float density[N * N], taper[N * N], by[N * N], by_jacobian[N * N];
    FlTransportMode mode;
    bool periodic;
} Problem;

static Problem *problem_new(FlTransportMode mode, bool periodic)
{
    Problem *p = g_new0(Problem, 1);
    p->mode = mode, p->periodic = periodic;
    g_assert_true(fl_potential_init(&p->potential, N, N, NULL));
    for (int l = 0; l < FL_POTENTIAL_GRIDS; l++)
        for (size_t i = 0; i < fl_potential_nodes(&p->potential, l); i++)
            p->potential.grid[l][i] = noise((uint64_t)l, i) * (float)(1 << l);
    for (size_t i = 0; i < (size_t)N * N; i++) {
        p->density[i] = 1 + 0.4f * sinf((float)(i % N) * 0.26f) * cosf((float)(i / N) * 0.26f);
        p->taper[i] = 0.6f + 0.4f * cosf((float)(i % N) * 0.13f);
        p->by[i] = noise(10, i);
        p->by_jacobian[i] = noise(11, i);
    }
    return p;
}

static void problem_free(Problem *p)
{
    fl_potential_clear(&p->potential);
    g_free(p);
}

static double value_of(const Problem *p)
{
    g_auto(FlFlowMap) map = {0};
    g_autofree float *sum = g_new(float, N *N), *velocity = g_new(float, 2 * N * N);
    g_autofree float *carried = g_new(float, N *N);
    g_assert_true(fl_flow_map_init(&map, N, N, p->periodic, NULL));
    fl_potential_sum(&p->potential, sum);
    fl_velocity(&map, sum, p->taper, p->mode, velocity);
    fl_flow_map_run(&map, velocity);
    fl_flow_map_carry(&map, p->density, carried);
    double value = 0;
    for (size_t i = 0; i < (size_t)N * N; i++)
        value += (double)p->by[i] * carried[i] + (double)p->by_jacobian[i] * map.jacobian[i];
    return value;
}

static void derivative_of(const Problem *p, FlPotential *by_node)
{
    g_auto(FlFlowMap) map = {0};
    g_autofree float *sum = g_new(float, N *N), *velocity = g_new(float, 2 * N * N);
    g_assert_true(fl_flow_map_init(&map, N, N, p->periodic, NULL));
    fl_potential_sum(&p->potential, sum);
    fl_velocity(&map, sum, p->taper, p->mode, velocity);
    fl_flow_map_run(&map, velocity);
    g_assert_true(fl_flow_map_adjoint(&map, p->density, p->by, p->by_jacobian, velocity, NULL));
    fl_velocity_adjoint(&map, velocity, p->taper, p->mode, sum);
    g_assert_true(fl_potential_init(by_node, N, N, NULL));
    fl_potential_adjoint(sum, by_node);
}

/* The derivative along a direction of all nodes against central differences. Bilinear samples have
 * kinks, which a small step along many nodes averages. */
static void compare_derivatives(FlTransportMode mode, bool periodic)
{
    const float step = 0.1f; // length in all nodes
    Problem *p = problem_new(mode, periodic);
    g_auto(FlPotential) by = {0};
    derivative_of(p, &by);
    for (int l = 0; l < FL_POTENTIAL_GRIDS; l++) {
        double expected = 0, length = 0;
        const size_t n = fl_potential_nodes(&by, l);
        g_autofree float *kept = g_memdup2(p->potential.grid[l], n * sizeof(float));
        for (size_t i = 0; i < n; i++) // along the derivative itself, where it is largest
            length += (double)by.grid[l][i] * by.grid[l][i];
        length = sqrt(length);
        double value[2];
        for (int side = 0; side < 2; side++) {
            for (size_t i = 0; i < n; i++)
                p->potential.grid[l][i] =
                    kept[i] + (side ? step : -step) * (float)(by.grid[l][i] / length);
            value[side] = value_of(p);
        }
        memcpy(p->potential.grid[l], kept, n * sizeof(float));
        expected = (value[1] - value[0]) / (2 * (double)step);
        g_test_message("grid %d: adjoint %.5f, differences %.5f", l, length, expected);
        g_assert_cmpfloat(fabs(length - expected), <, 0.01 * fabs(expected) + 0.004);
    }
    problem_free(p);
}

static void adjoints_agree_with_differences(void)
{
    for (int periodic = 0; periodic < 2; periodic++) {
        compare_derivatives(FL_TRANSPORT_GATHER, periodic);
        compare_derivatives(FL_TRANSPORT_STIR, periodic);
    }
}

/* A picture of stripes 12 px apart, mean 1. */
static float *striped(int n)
{
    float *picture = g_new(float, n *n);
    for (int i = 0; i < n * n; i++)
        picture[i] = 1 + 0.8f * sinf((float)(i / n + i % n / 3) * 0.5236f);
    return picture;
}

static void the_loss_has_the_derivative_it_says(void)
{
    enum { n = 64 };
    g_autofree float *picture = striped(n), *density = g_new(float, n *n);
    g_autofree float *by = g_new(float, n *n), *moved = g_new(float, n *n);
    g_autoptr(FlSliced) sliced = fl_sliced_new(picture, n, n, NULL);
    for (size_t i = 0; i < (size_t)n * n; i++)
        density[i] = 1 + 0.5f * noise(3, i);
    g_auto(FlSlicedPlaces) places = {0};
    g_assert_true(fl_sliced_places_init(&places, NULL, n, n, NULL));
    FlSlicedTarget target = {density, &places};
    fl_sliced_loss(sliced, &target, 7, 512, 96, 1, by, NULL, NULL);
    double length = 0, loss[2];
    for (int i = 0; i < n * n; i++)
        length += (double)by[i] * by[i];
    length = sqrt(length);
    for (int side = 0; side < 2; side++) {
        for (int i = 0; i < n * n; i++)
            moved[i] = density[i] + (side ? 0.02f : -0.02f) * (float)(by[i] / length);
        target.density = moved;
        loss[side] = fl_sliced_loss(sliced, &target, 7, 512, 96, 1, NULL, NULL, NULL);
    }
    const double expected = (loss[1] - loss[0]) / 0.04;
    g_test_message("adjoint %.5f, differences %.5f", length, expected);
    g_assert_cmpfloat(fabs(length - expected), <, 0.02 * expected);
}

static void a_solution_looks_like_its_picture(void)
{
    enum { n = 64 };
    g_autofree float *picture = striped(n), *flat = g_new(float, n *n), *sum = g_new(float, n *n);
    g_autofree float *velocity = g_new(float, 2 * n * n), *carried = g_new(float, n *n);
    g_autoptr(FlSliced) sliced = fl_sliced_new(picture, n, n, NULL);
    g_auto(FlPotential) potential = {0};
    g_auto(FlFlowMap) map = {0};
    g_assert_true(fl_potential_init(&potential, n, n, NULL) &&
                  fl_flow_map_init(&map, n, n, true, NULL));
    const FlTransportProblem problem = {
        .width = n, .height = n, .style = sliced, .pace = 1, .key = 1};
    g_assert_true(fl_transport_solve(&problem, 1, &potential, NULL, NULL, NULL));
    fl_potential_sum(&potential, sum);
    fl_velocity(&map, sum, NULL, FL_TRANSPORT_GATHER, velocity);
    fl_flow_map_run(&map, velocity);
    fl_flow_map_carry(&map, NULL, carried);
    for (int i = 0; i < n * n; i++)
        flat[i] = 1;
    g_auto(FlSlicedPlaces) places = {0};
    g_assert_true(fl_sliced_places_init(&places, NULL, n, n, NULL));
    FlSlicedTarget target = {flat, &places};
    const float before = fl_sliced_loss(sliced, &target, 7, 2048, 96, 5, NULL, NULL, NULL);
    target.density = carried;
    const float after = fl_sliced_loss(sliced, &target, 7, 2048, 96, 5, NULL, NULL, NULL);
    g_test_message("loss %.4f of the flat ink, %.4f of the solution", before, after);
    g_assert_cmpfloat(after, <, 0.05 * before);
}

/* ---- a region ----------------------------------------------------------------------------------
 */

/* A tile of waves 24 px long that move ink by up to 4 px. */
static FlTile *waves(void)
{
    FlTile *tile = g_new0(FlTile, 1);
    tile->style =
        (FlTransportStyle){.size = 96, .ring_px = 12, .taper_px = 5, .pace = 1, .effort = 1};
    tile->spline = g_new(float, 96 * 96);
    for (int i = 0; i < 96 * 96; i++)
        tile->spline[i] = 15 * sinf((float)(i % 96) * 0.2618f) * cosf((float)(i / 96) * 0.1309f);
    return tile;
}

/* A disk of radius 40 at (x, 60), which has moved by `motion` px to the right. */
static void draw_disk(FlGuides *guides, float x0, float motion)
{
    guides->has_motion = true;
    for (size_t p = 0; p < PIXELS; p++) {
        const float x = (float)(p % SIDE), y = (float)(p / SIDE);
        guides->distance[p] = 40 - hypotf(x - x0, y - 60);
        guides->mask[p] = (uint8_t)(255 * fminf(fmaxf(guides->distance[p] + 0.5f, 0), 1) + 0.5f);
        guides->motion[2 * p] =
            guides->mask[p] ? (int32_t)(motion * FL_MOTION_ONE) : FL_MOTION_UNKNOWN;
        guides->motion[2 * p + 1] = guides->mask[p] ? 0 : FL_MOTION_UNKNOWN;
    }
}

static FlCarriedInk *ink_of(const FlTile *tile, float strength)
{
    const FlCarriedInkInput input = {.tile = tile,
                                     .width = SIDE,
                                     .height = SIDE,
                                     .scale = 1,
                                     .strength = strength,
                                     .seed = 3,
                                     .colour = {{250, 240, 230}, {60000, 50000, 40000}}};
    return fl_carried_ink_new(&input, NULL);
}

typedef struct Disk {
    FlTile *tile;
    FlCarriedInk *ink;
    FlGuides guides;
    float amount[PIXELS];
    uint8_t rgb[3 * PIXELS];
} Disk;

static Disk *disk_new(float strength)
{
    Disk *disk = g_new0(Disk, 1);
    disk->tile = waves();
    disk->ink = ink_of(disk->tile, strength);
    g_assert_true(fl_guides_init(&disk->guides, SIDE, SIDE, NULL));
    return disk;
}

static void disk_free(Disk *disk)
{
    fl_carried_ink_free(disk->ink);
    fl_tile_free(disk->tile);
    fl_guides_clear(&disk->guides);
    g_free(disk);
}

static void disk_frame(Disk *disk, float x, float motion)
{
    draw_disk(&disk->guides, x, motion);
    g_assert_true(fl_carried_ink_amounts(disk->ink, &disk->guides, disk->amount, NULL));
}

static double mean_of(const Disk *disk, double *deviation)
{
    double n = 0, sum = 0, squares = 0;
    for (size_t p = 0; p < PIXELS; p++) {
        const double c = disk->guides.mask[p], d = disk->amount[p];
        n += c, sum += c * d, squares += c * d * d;
    }
    *deviation = sqrt(squares / n - sum / n * sum / n);
    return sum / n;
}

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
    g_autofree float *velocity = g_new(float, 2 * PIXELS), *carried = g_new(float, PIXELS);
    double mask = 0, sum = 0;
    g_assert_true(fl_flow_map_init(&map, SIDE, SIDE, false, NULL));
    for (size_t p = 0; p < PIXELS; p++) {
        const float depth = 40 - hypotf((float)(p % SIDE) - 60, (float)(p / SIDE) - 60);
        const float t = fminf(fmaxf(depth / 6, 0), 1), taper = t * t * (3 - 2 * t);
        velocity[2 * p] = 5 * taper * cosf((float)(p % SIDE) * 0.26f);
        velocity[2 * p + 1] = 5 * taper * sinf((float)(p / SIDE) * 0.26f);
    }
    fl_flow_map_run(&map, velocity);
    fl_flow_map_carry(&map, NULL, carried);
    for (size_t p = 0; p < PIXELS; p++)
        if (hypotf((float)(p % SIDE) - 60, (float)(p / SIDE) - 60) < 40)
            mask++, sum += carried[p];
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

/* ---- the network ------------------------------------------------------------------------------
 */

#define CASE_WIDTH 64
#define CASE_HEIGHT 48
#define CASE_PLANE ((size_t)CASE_WIDTH * CASE_HEIGHT)

/* The network of the batik, and inputs with what the training script's own integers make of them.
 */
static char *network_folder(void)
{
    return g_build_filename(g_getenv("FLUIDY_FIXTURES"), "styles", "12", NULL);
}

static int16_t *stored_case(void)
{
    const size_t heads = CASE_PLANE / 4 + CASE_PLANE / 16 + CASE_PLANE / 64;
    const size_t n = FL_NETWORK_INPUTS * CASE_PLANE + heads;
    g_autofree char *path =
        g_build_filename(g_getenv("FLUIDY_FIXTURES"), "transport", "network.case", NULL);
    g_autofree uint8_t *bytes = NULL;
    size_t size;
    g_assert_true(g_file_get_contents(path, (char **)&bytes, &size, NULL));
    g_assert_cmpuint(size, ==, 2 * n);
    int16_t *values = g_new(int16_t, n);
    for (size_t i = 0; i < n; i++)
        values[i] = (int16_t)(bytes[2 * i] | bytes[2 * i + 1] << 8);
    return values;
}

static void the_network_is_that_of_its_training(void)
{
    g_autofree char *folder = network_folder();
    g_autofree int16_t *values = stored_case(), *found = g_new(int16_t, CASE_PLANE);
    g_autoptr(FlNetwork) network = fl_network_load(folder, NULL);
    g_assert_nonnull(network);
    int16_t *heads[FL_NETWORK_HEADS] = {found, found + CASE_PLANE / 4,
                                        found + CASE_PLANE / 4 + CASE_PLANE / 16};
    g_assert_true(fl_network_run(network, values, CASE_WIDTH, CASE_HEIGHT, heads, NULL));
    const size_t n = CASE_PLANE / 4 + CASE_PLANE / 16 + CASE_PLANE / 64;
    g_assert_cmpmem(found, 2 * n, values + FL_NETWORK_INPUTS * CASE_PLANE, 2 * n);
}

/* What a shape does from frame to frame. */
typedef struct Motion {
    const char *name;
    float shift, turn, growth; // px, radians and a factor of its size
    float tile, network, refined; // bounds of flicker
} Motion;

/* The amount at a place between pixels. */
static double amount_at(const float *amount, double x, double y)
{
    const int x0 = (int)floor(x), y0 = (int)floor(y);
    const double fx = x - x0, fy = y - y0;
    const float *a = amount + (ptrdiff_t)y0 * SIDE + x0;
    return (1 - fy) * ((1 - fx) * (double)a[0] + fx * (double)a[1]) +
           fy * ((1 - fx) * (double)a[SIDE] + fx * (double)a[SIDE + 1]);
}

/* The frame before's place of a pixel of a frame; a disk's radius is that of the frame. */
static void place_before(const Motion *m, double x0, size_t p, double place[2])
{
    const double x = (double)(p % SIDE) - x0, y = (double)(p / SIDE) - 60;
    const double c = cos((double)m->turn), s = sin((double)m->turn);
    place[0] = (c * x + s * y) / (double)m->growth + x0 - (double)m->shift;
    place[1] = (c * y - s * x) / (double)m->growth + 60;
}

/* A frame of a disk at x0 that has come there by the motion. */
static void draw_moved(FlGuides *guides, const Motion *m, double x0, double radius)
{
    draw_disk(guides, (float)x0, 0);
    for (size_t p = 0; p < PIXELS; p++) {
        double place[2];
        guides->distance[p] += (float)(radius - 40);
        guides->mask[p] = (uint8_t)(255 * fminf(fmaxf(guides->distance[p] + 0.5f, 0), 1) + 0.5f);
        place_before(m, x0, p, place);
        const double motion[2] = {(double)(p % SIDE) - place[0], (double)(p / SIDE) - place[1]};
        for (size_t c = 0; c < 2; c++)
            guides->motion[2 * p + c] =
                guides->mask[p] ? (int32_t)lround(motion[c] * FL_MOTION_ONE) : FL_MOTION_UNKNOWN;
    }
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

/* A disk with the tile and, if wanted, the network and the patches of the batik. */
static Disk *batik_new(FlNetwork *network, FlSliced *patches)
{
    g_autofree char *folder = network_folder();
    Disk *disk = disk_new(1);
    fl_tile_free(disk->tile);
    disk->tile = fl_tile_load(folder, 1, NULL);
    g_assert_nonnull(disk->tile);
    FlCarriedInkInput input = {.tile = disk->tile,
                               .network = network,
                               .patches = patches,
                               .refine = 8,
                               .width = SIDE,
                               .height = SIDE,
                               .scale = 1,
                               .strength = 1,
                               .seed = 3};
    fl_carried_ink_free(disk->ink);
    disk->ink = fl_carried_ink_new(&input, NULL);
    return disk;
}

/* What moves, grows, turns by a quarter or rests flickers no more than the bounds say. */
static void ink_does_not_flicker(void)
{
    static const Motion motions[] = {
        {"moving", 3, 0, 1, 0.08f, 0.08f, 0.15f},
        {"growing", 2.8f, 0, 1.012f, 0.08f, 0.08f, 0.15f},
        {"turning", 0, 0.0654498f, 1, 0.08f, 0.08f, 0.15f},
        {"at rest", 0, 0, 1, 0, 0, 0},
    };
    g_autofree char *folder = network_folder();
    g_autoptr(FlNetwork) network = fl_network_load(folder, NULL);
    g_autoptr(FlSliced) patches = fl_style_patches(folder, NULL);
    for (size_t k = 0; k < G_N_ELEMENTS(motions); k++)
        for (int with = 0; with < 3; with++) {
            static const char *const names[] = {"tile", "network", "refined"};
            const Motion *m = &motions[k];
            const float bounds[] = {m->tile, m->network, m->refined};
            Disk *disk = batik_new(with == 1 ? network : NULL, with == 2 ? patches : NULL);
            const double flicker = flicker_of(disk, m, m->turn > 0 ? 24 : 10);
            g_test_message("%s, %s: flicker %.4f", m->name, names[with], flicker);
            g_assert_cmpfloat(flicker, <=, (double)bounds[with]);
            disk_free(disk);
        }
}

/* The loss of the ink in the disk on the finest levels, as far as they have patches. */
static double loss_of(const Disk *disk, const FlSliced *patches)
{
    enum { INNER = SIDE / 16 * 16 };
    float density[INNER * INNER], coverage[INNER * INNER];
    g_auto(FlSlicedPlaces) places = {0};
    for (size_t p = 0; p < G_N_ELEMENTS(density); p++) {
        const size_t q = p / INNER * SIDE + p % INNER;
        density[p] = disk->amount[q];
        coverage[p] = fminf(fmaxf(disk->guides.distance[q] - 4, 0), 1);
    }
    g_assert_true(fl_sliced_places_init(&places, coverage, INNER, INNER, NULL));
    const FlSlicedTarget target = {density, &places};
    return (double)fl_sliced_loss(patches, &target, 7, 2048, FL_SLICED_DIRECTIONS, 5, NULL, NULL,
                                  NULL);
}

/* Where a shape grows, a tile's pattern grows along; what is refined keeps the style's size. */
static void refined_ink_looks_like_its_style(void)
{
    const Motion growing = {.shift = 2.8f, .growth = 1.012f};
    g_autofree char *folder = network_folder();
    g_autoptr(FlSliced) patches = fl_style_patches(folder, NULL);
    double loss[2];
    for (int refined = 0; refined < 2; refined++) {
        Disk *disk = batik_new(NULL, refined ? patches : NULL);
        (void)flicker_of(disk, &growing, 10);
        loss[refined] = loss_of(disk, patches);
        disk_free(disk);
    }
    g_test_message("loss %.4f of the tile, %.4f refined", loss[0], loss[1]);
    g_assert_cmpfloat(loss[1], <, 0.5 * loss[0]);
}

/* Nothing fades or gains while a shape swings to and fro. */
static void refined_ink_does_not_decay(void)
{
    enum { FRAMES = 60 };
    const Motion motions[] = {{.shift = 2, .growth = 1}, {.shift = -2, .growth = 1}};
    g_autofree char *folder = network_folder();
    g_autoptr(FlSliced) patches = fl_style_patches(folder, NULL);
    Disk *disk = batik_new(NULL, patches);
    double x = 50, early = 0, late = 0;
    for (int frame = 0; frame < FRAMES; frame++) {
        const Motion *m = &motions[frame / 10 % 2];
        double deviation;
        x += frame ? (double)m->shift : 0;
        draw_moved(&disk->guides, frame ? m : &(Motion){.growth = 1}, x, 40);
        g_assert_true(fl_carried_ink_amounts(disk->ink, &disk->guides, disk->amount, NULL));
        mean_of(disk, &deviation);
        early += frame < 10 ? deviation / 10 : 0, late += frame >= FRAMES - 10 ? deviation / 10 : 0;
    }
    g_test_message("deviation %.3f early, %.3f late", early, late);
    g_assert_cmpfloat(fabs(late / early - 1), <, 0.05);
    disk_free(disk);
}

/* Whether a file with these bytes is read; if not, with one line that names it. */
static bool reads(const char *folder, const uint8_t *bytes, size_t size)
{
    g_autofree char *path = g_build_filename(folder, "transport.net", NULL);
    g_autoptr(GError) error = NULL;
    g_assert_true(g_file_set_contents(path, (const char *)bytes, (gssize)size, NULL));
    g_autoptr(FlNetwork) network = fl_network_load(folder, &error);
    if (!network) {
        g_assert_error(error, FL_ERROR, FL_ERROR_STYLE);
        g_assert_nonnull(strstr(error->message, path));
        g_assert_null(strchr(error->message, '\n'));
    }
    return network;
}

static void sign(uint8_t *bytes, size_t size)
{
    const uint32_t crc = (uint32_t)crc32(0, bytes + 8, (uInt)(size - 12));
    for (int i = 0; i < 4; i++)
        bytes[size - 4 + (size_t)i] = (uint8_t)(crc >> 8 * i);
}

static void hostile_networks_are_rejected(void)
{
    g_autofree char *folder = network_folder(), *temporary = g_dir_make_tmp("net-XXXXXX", NULL);
    g_autofree char *path = g_build_filename(folder, "transport.net", NULL);
    g_autofree char *written = g_build_filename(temporary, "transport.net", NULL);
    g_autofree uint8_t *bytes = NULL;
    size_t size;
    g_assert_true(g_file_get_contents(path, (char **)&bytes, &size, NULL));
    g_assert_true(reads(temporary, bytes, size));
    g_assert_false(reads(temporary, bytes, size - 1));
    g_assert_false(reads(temporary, bytes, 11));
    g_assert_false(reads(temporary, bytes, 0));
    bytes[size / 2] ^= 1; // damage
    g_assert_false(reads(temporary, bytes, size));
    bytes[size / 2] ^= 1;
    for (size_t at = 8; at < 20; at++) { // signed, but its sizes or the shift are wrong
        const uint8_t before = bytes[at];
        bytes[at] = at == 10 ? 13 : 255;
        sign(bytes, size);
        g_assert_false(reads(temporary, bytes, size));
        bytes[at] = before;
    }
    const size_t weights = 8 + 8 + 4 + 4 * 12;
    for (size_t i = 0; i < 100; i++) // sums that could overflow
        bytes[weights + 2 * i] = 0xff, bytes[weights + 2 * i + 1] = 0x7f;
    sign(bytes, size);
    g_assert_false(reads(temporary, bytes, size));
    g_unlink(written), g_rmdir(temporary);
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
        const double t = CLAMP((double)disk->guides.distance[p] / 5, 0, 1);
        float g[2];
        fl_tile_gradient(disk->tile, (float)(p % SIDE) + left, (float)(p / SIDE) + top, g);
        for (int c = 0; c < 2; c++)
            u[c][p] = disk->guides.mask[p] ? -t * t * (3 - 2 * t) * (double)g[c] / 8 : 0;
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

/* ---- painted ink ------------------------------------------------------------------------------
 */

static const uint8_t blotched[3] = {60, 100, 170}, bare[3] = {250, 240, 230};

/* Paint in blotches on the test's paper, inside the mask. */
static void paint_blotches(Disk *disk)
{
    for (size_t p = 0; p < PIXELS; p++)
        for (size_t c = 0; c < 3; c++) {
            const float paint = blotched[c] + 30 * noise(5, p / 7) - bare[c];
            disk->rgb[3 * p + c] =
                (uint8_t)((float)bare[c] + paint * (float)disk->guides.mask[p] / 255);
        }
}

static double density_of(const Disk *disk, size_t channel)
{
    double sum = 0;
    for (size_t p = 0; p < PIXELS; p++)
        sum += (double)disk->guides.mask[p] *
               (double)(fl_density(disk->rgb[3 * p + channel]) - fl_density(bare[channel]));
    return sum;
}

static void painted_ink_is_moved_and_stays_as_much(void)
{
    Disk *disk = disk_new(1), *still = disk_new(0);
    draw_disk(&disk->guides, 60, 0);
    draw_disk(&still->guides, 60, 0);
    paint_blotches(disk);
    paint_blotches(still);
    g_autofree uint8_t *before = g_memdup2(still->rgb, sizeof still->rgb);
    g_assert_true(fl_carried_ink_move(disk->ink, &disk->guides, disk->rgb, NULL));
    g_assert_true(fl_carried_ink_move(still->ink, &still->guides, still->rgb, NULL));
    g_assert_cmpmem(still->rgb, sizeof still->rgb, before, sizeof still->rgb); // no strength
    for (size_t c = 0; c < 3; c++)
        g_assert_cmpfloat(fabs(density_of(disk, c) / density_of(still, c) - 1), <, 0.01);
    double moved = 0, n = 0;
    for (size_t p = 0; p < PIXELS; p++) {
        if (!disk->guides.mask[p])
            g_assert_cmpmem(disk->rgb + 3 * p, 3, before + 3 * p, 3);
        if (disk->guides.distance[p] > 8)
            moved += abs(disk->rgb[3 * p] - before[3 * p]), n++;
    }
    g_assert_cmpfloat(moved / n, >, 10);
    disk_free(disk);
    disk_free(still);
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

static void a_refined_state_continues(void)
{
    const Motion growing = {.shift = 2.3f, .growth = 1.01f}, rest = {.growth = 1};
    g_autofree char *folder = network_folder();
    g_autoptr(FlSliced) patches = fl_style_patches(folder, NULL);
    Disk *disk = batik_new(NULL, patches), *other = batik_new(NULL, patches);
    draw_moved(&disk->guides, &rest, 50, 40);
    g_assert_true(fl_carried_ink_amounts(disk->ink, &disk->guides, disk->amount, NULL));
    g_autoptr(GBytes) state = fl_carried_ink_save(disk->ink, NULL);
    g_assert_true(fl_carried_ink_load(other->ink, state, NULL));
    Disk *const both[] = {disk, other};
    for (int k = 0; k < 2; k++) {
        draw_moved(&both[k]->guides, &growing, 52.3, 40.4);
        g_assert_true(
            fl_carried_ink_amounts(both[k]->ink, &both[k]->guides, both[k]->amount, NULL));
    }
    g_assert_cmpmem(disk->amount, sizeof disk->amount, other->amount, sizeof disk->amount);
    const gsize size = g_bytes_get_size(state), cuts[] = {1, 100, 4000};
    for (gsize k = 0; k < G_N_ELEMENTS(cuts); k++) {
        g_autoptr(GBytes) cut = g_bytes_new_from_bytes(state, 0, size - cuts[k]);
        g_autoptr(GError) error = NULL;
        g_assert_false(fl_carried_ink_load(other->ink, cut, &error));
        g_assert_error(error, FL_ERROR, FL_ERROR_CHANGED);
    }
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
    memset(bytes + 40, 0xff, 8); // not a number
    g_autoptr(GBytes) wild = g_bytes_new(bytes, size);
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
    gsize one = 0, size = 0;
    for (int frame = 0; frame < 40 && size <= one; frame++) {
        stretch_disk(disk, 0, 0.03f);
        g_autoptr(GBytes) state = fl_carried_ink_save(disk->ink, NULL);
        size = g_bytes_get_size(state), one = frame == 0 ? size : one;
        g_assert_true(fl_carried_ink_load(other->ink, state, NULL));
    }
    g_assert_cmpuint(size, >, one); // two layers and their shares
    for (int frame = 0; frame < 4; frame++)
        stretch_disk(disk, 0, 0.03f), stretch_disk(other, 0, 0.03f);
    g_assert_cmpmem(disk->amount, sizeof disk->amount, other->amount, sizeof disk->amount);
    disk_free(disk);
    disk_free(other);
}

/* ---- two shapes --------------------------------------------------------------------------------
 */

/* Left of `edge` everything moves by `motion` px, from there on nothing does. */
static void draw_halves(FlGuides *guides, int edge, float motion)
{
    guides->has_motion = true;
    for (size_t p = 0; p < PIXELS; p++) {
        guides->mask[p] = 255;
        guides->distance[p] = 40;
        guides->motion[2 * p] = (int)(p % SIDE) < edge ? (int32_t)(motion * FL_MOTION_ONE) : 0;
        guides->motion[2 * p + 1] = 0;
    }
}

static void what_is_revealed_belongs_to_its_shape(void)
{
    g_auto(FlMaterialLayers) layers = {0};
    g_auto(FlGuides) guides = {0};
    g_autofree float *whole = g_new(float, PIXELS);
    g_assert_true(fl_guides_init(&guides, SIDE, SIDE, NULL));
    for (int frame = 0; frame < 6; frame++) {
        const int edge = 90 - 5 * frame;
        draw_halves(&guides, edge, frame == 0 ? 0 : -5);
        g_assert_true(
            fl_material_layers_advance(&layers, &guides, (FlRect){0, 0, SIDE, SIDE}, 5, NULL));
        for (int x = 0; x < SIDE; x++) {
            const float wanted = x < edge ? 5 * (float)frame : 0;
            g_assert_cmpfloat(fabsf(layers.old.shift[2 * (SIDE * 60 + x)] - wanted), <, 1e-3);
        }
    }
    const float *row = whole + (size_t)SIDE * 60;
    g_assert_true(fl_material_whole(&layers.old, &layers.share, &guides, 8, whole, NULL));
    g_assert_cmpfloat(row[64], ==, 0); // there they meet
    g_assert_cmpfloat(row[60], >, 0);
    g_assert_cmpfloat(row[60], <, row[58]);
    g_assert_cmpfloat(row[50], ==, 1);
    g_assert_cmpfloat(row[80], ==, 1);
}

/* What is kept of a network's velocity turns with the shape on which it lies. */
static void a_kept_velocity_turns_with_its_shape(void)
{
    const Motion turning = {.turn = 0.0654498f, .growth = 1}, rest = {.growth = 1};
    const FlRect page = {0, 0, SIDE, SIDE};
    g_auto(FlMaterialLayers) layers = {0};
    g_auto(FlGuides) guides = {0};
    g_assert_true(fl_guides_init(&guides, SIDE, SIDE, NULL));
    for (int frame = 0; frame <= 24; frame++) {
        draw_moved(&guides, frame ? &turning : &rest, 60, 40);
        g_assert_true(fl_material_layers_advance(&layers, &guides, page, 5, NULL));
        if (frame == 0) {
            layers.velocity = (FlMaterial){page, fl_alloc(2 * PIXELS, sizeof(float), "", NULL)};
            for (size_t p = 0; p < PIXELS; p++)
                layers.velocity.shift[2 * p] = 3;
        }
    }
    float most[2] = {0, 0}; // px, near the contour and within
    for (size_t p = 0; p < PIXELS; p++) {
        const float *v = layers.velocity.shift + 2 * p; // to the right became downwards
        float *of = &most[guides.distance[p] > 8];
        if (guides.distance[p] > 2)
            *of = fmaxf(*of, hypotf(v[0], v[1] - 3));
    }
    g_test_message("off by %.3f px of 3 at most near the contour, %.3f within", (double)most[0],
                   (double)most[1]);
    g_assert_cmpfloat(most[1], <, 0.05); // 4.2 if it does not turn
}

/* ---- style folders -----------------------------------------------------------------------------
 */

static void expect_refusal(const char *folder, const char *ini, const char *says)
{
    g_autofree char *path = g_build_filename(folder, "style.ini", NULL);
    g_autoptr(GError) error = NULL;
    g_assert_true(g_file_set_contents(path, ini, -1, NULL));
    g_autoptr(FlTile) tile = fl_tile_load(folder, 1, &error);
    g_assert_null(tile);
    g_assert_error(error, FL_ERROR, FL_ERROR_STYLE);
    g_test_message("%s", error->message);
    g_assert_nonnull(strstr(error->message, says));
}

static void bad_style_folders_are_named(void)
{
    g_autofree char *folder = g_dir_make_tmp("transport-XXXXXX", NULL);
    g_autofree char *png = g_build_filename(folder, "transport.png", NULL);
    g_autofree char *ini = g_build_filename(folder, "style.ini", NULL);
    g_autofree float *potential = g_new0(float, 64 * 64);
    expect_refusal(folder, "[transport]\n", "no such file");
    g_assert_true(fl_tile_save(potential, 64, folder, NULL));
    expect_refusal(folder, "[transport]\nsize = 128\n", "64x64 pixels: expected 128x128");
    expect_refusal(folder, "[transport]\nmotion = swirl\n",
                   "style.ini:2: motion = swirl: expected");
    expect_refusal(folder, "[transport]\ntapir = 3\n", "style.ini:2: unknown key");
    g_assert_true(g_file_set_contents(png, "no picture", -1, NULL));
    expect_refusal(folder, "[transport]\nsize = 64\n", "transport.png");
    g_unlink(png), g_unlink(ini), g_rmdir(folder);
}

static void a_tile_is_read_as_it_was_written(void)
{
    g_autofree char *folder = g_dir_make_tmp("transport-XXXXXX", NULL);
    g_autofree char *png = g_build_filename(folder, "transport.png", NULL);
    g_autofree char *ini = g_build_filename(folder, "style.ini", NULL);
    g_autofree float *potential = g_new(float, 64 * 64);
    for (int i = 0; i < 64 * 64; i++)
        potential[i] = 20 * sinf((float)(i % 64) * 0.3927f) * cosf((float)(i / 64) * 0.3927f);
    g_assert_true(g_file_set_contents(ini, "[transport]\nsize = 64\n", -1, NULL));
    g_assert_true(fl_tile_save(potential, 64, folder, NULL));
    g_autoptr(FlTile) tile = fl_tile_load(folder, 2, NULL);
    const float smoothed = (4 + 2 * cosf(0.3927f)) / 6; // along one axis, twice along each
    const float most = 7.854f * powf(smoothed, 4);
    for (int i = 0; i < 64 * 64; i++) {
        float g[2];
        const float x = (float)(i % 64), y = (float)(i / 64);
        fl_tile_gradient(tile, x - 64, y + 128, g); // it repeats
        g_assert_cmpfloat(fabsf(g[0] - most * cosf(x * 0.3927f) * cosf(y * 0.3927f)), <, 0.05);
        g_assert_cmpfloat(fabsf(g[1] + most * sinf(x * 0.3927f) * sinf(y * 0.3927f)), <, 0.05);
    }
    g_unlink(png), g_unlink(ini), g_rmdir(folder);
}

/* The share of a tile, drawn at a scale, where the ink folds over: per cent. */
static double folds_of(const char *style, float scale)
{
    g_autofree char *folder = g_build_filename(g_getenv("FLUIDY_FIXTURES"), "styles", style, NULL);
    g_autoptr(FlTile) tile = fl_tile_load(folder, scale, NULL);
    g_assert_nonnull(tile);
    const int n = (int)((float)tile->style.size * scale + 0.5f);
    g_auto(FlFlowMap) map = {0};
    g_autofree float *velocity = g_new(float, 2 * (size_t)n * (size_t)n);
    g_assert_true(fl_flow_map_init(&map, n, n, true, NULL));
    int folds = 0;
    for (int p = 0; p < n * n; p++) {
        fl_tile_gradient(tile, (float)(p % n) / scale, (float)(p / n) / scale, velocity + 2 * p);
        velocity[2 * p] *= scale, velocity[2 * p + 1] *= scale;
    }
    fl_flow_map_run(&map, velocity);
    for (int p = 0; p < n * n; p++)
        folds += map.jacobian[p] < 0;
    g_test_message("style %s at %g: folds on %.3f %%", style, (double)scale, 100.0 * folds / n / n);
    return 100.0 * folds / n / n;
}

static void bundled_ink_does_not_fold(void)
{
    static const char *const styles[] = {"11", "12", "13", "14"};
    static const float scales[] = {0.5f, 1, 2.5f};
    for (size_t s = 0; s < G_N_ELEMENTS(styles); s++)
        for (size_t k = 0; k < G_N_ELEMENTS(scales); k++)
            g_assert_cmpfloat(folds_of(styles[s], scales[k]), <, 0.05);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/transport/" #name, name)
    TEST(adjoints_agree_with_differences);
    TEST(the_loss_has_the_derivative_it_says);
    TEST(a_solution_looks_like_its_picture);
    TEST(ink_is_neither_made_nor_lost);
    TEST(the_map_itself_keeps_the_ink);
    TEST(no_strength_is_a_flat_fill);
    TEST(the_network_is_that_of_its_training);
    TEST(ink_does_not_flicker);
    TEST(refined_ink_looks_like_its_style);
    TEST(refined_ink_does_not_decay);
    TEST(a_refined_state_continues);
    TEST(hostile_networks_are_rejected);
    TEST(a_frame_is_what_the_formulas_say);
    TEST(painted_ink_is_moved_and_stays_as_much);
    TEST(the_pattern_rides_on_the_drawing);
    TEST(a_region_at_rest_has_the_same_bytes);
    TEST(the_same_bytes_on_any_thread_count);
    TEST(a_state_continues_as_if_nothing_had_been);
    TEST(a_damaged_state_is_refused);
    TEST(what_is_stretched_is_laid_anew_by_and_by);
    TEST(what_is_not_stretched_stays);
    TEST(what_is_squeezed_at_once_keeps_its_contrast);
    TEST(a_state_in_a_fade_continues);
    TEST(what_is_revealed_belongs_to_its_shape);
    TEST(a_kept_velocity_turns_with_its_shape);
    TEST(bad_style_folders_are_named);
    TEST(a_tile_is_read_as_it_was_written);
    TEST(bundled_ink_does_not_fold);
    return g_test_run();
}
