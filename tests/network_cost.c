/*
 * What a network costs and reaches beside solving each frame from nothing: core-s per Mpx, and the
 * loss by level. usage: network_cost STYLE (a folder with a transport.net).
 */
#include "base/rng.h"
#include "style/style_folder.h"
#include "transport/network_velocity.h"
#include "transport/solve.h"
#include "transport/style_ink.h"
#include "transport/tile.h"
#include <math.h>
#include <stdio.h>
#include <time.h>

enum { SIDE = 256, PIXELS = SIDE * SIDE, LEVELS = 3 };

typedef struct Scene {
    FlGuides guides;
    FlMaterialLayers layers;
    FlSliced *sliced;
    FlNetwork *network;
    float coverage[PIXELS], taper[PIXELS], velocity[2 * PIXELS], carried[PIXELS];
} Scene;

/* A blob with three arms, large enough for every level. */
static void draw(Scene *scene, float taper_px)
{
    for (int p = 0; p < PIXELS; p++) {
        const float x = (float)(p % SIDE) - SIDE / 2, y = (float)(p / SIDE) - SIDE / 2;
        const float depth = 85 + 22 * cosf(3 * atan2f(y, x)) - hypotf(x, y);
        const float t = fminf(fmaxf(depth / taper_px, 0), 1);
        scene->guides.distance[p] = depth;
        scene->coverage[p] = fminf(fmaxf(depth + 0.5f, 0), 1);
        scene->guides.mask[p] = (uint8_t)(255 * scene->coverage[p] + 0.5f);
        scene->taper[p] = t * t * (3 - 2 * t);
    }
}

static void show(Scene *scene, const char *name, double cpu_s)
{
    g_auto(FlFlowMap) map = {0};
    g_auto(FlSlicedPlaces) places = {0};
    g_assert_true(fl_sliced_places_init(&places, scene->coverage, SIDE, SIDE, NULL));
    const FlSlicedTarget target = {scene->carried, &places};
    float loss[FL_SLICED_LEVELS];
    g_assert_true(fl_flow_map_init(&map, SIDE, SIDE, false, NULL));
    const clock_t start = clock();
    fl_flow_map_run(&map, scene->velocity);
    fl_flow_map_carry(&map, scene->coverage, scene->carried);
    cpu_s += (double)(clock() - start) / CLOCKS_PER_SEC;
    fl_sliced_loss(scene->sliced, &target, (1 << LEVELS) - 1, 4096, FL_SLICED_DIRECTIONS, 5, NULL,
                   loss, NULL);
    printf("%-10s %8.3f core-s/Mpx   loss %.4f %.4f %.4f\n", name, cpu_s * 1e6 / PIXELS, loss[0],
           loss[1], loss[2]);
}

static void ask_network(Scene *scene)
{
    const FlNetworkPlace place = {1, {0, 0}, 3};
    const clock_t start = clock();
    g_assert_true(fl_network_velocity(scene->network, &place, &scene->layers, &scene->guides,
                                      scene->velocity, NULL));
    for (int i = 0; i < 2 * PIXELS; i++)
        scene->velocity[i] *= scene->taper[i / 2];
    show(scene, "network", (double)(clock() - start) / CLOCKS_PER_SEC);
}

static void solve(Scene *scene)
{
    g_auto(FlPotential) potential = {0};
    g_auto(FlFlowMap) map = {0};
    g_autofree float *sum = g_new(float, PIXELS);
    const FlTransportProblem problem = {.width = SIDE,
                                        .height = SIDE,
                                        .style = scene->sliced,
                                        .density = scene->coverage,
                                        .coverage = scene->coverage,
                                        .taper = scene->taper,
                                        .pace = 1,
                                        .key = 1};
    const clock_t start = clock();
    g_assert_true(fl_potential_init(&potential, SIDE, SIDE, NULL) &&
                  fl_flow_map_init(&map, SIDE, SIDE, false, NULL) &&
                  fl_transport_solve(&problem, 1, &potential, NULL, NULL, NULL));
    fl_potential_sum(&potential, sum);
    fl_velocity(&map, sum, scene->taper, FL_TRANSPORT_GATHER, scene->velocity);
    show(scene, "iteration", (double)(clock() - start) / CLOCKS_PER_SEC);
}

int main(int argc, char **argv)
{
    g_autoptr(FlStyle) style = argc == 2 ? fl_style_load(argv[1], NULL) : NULL;
    g_autofree float *ink = style ? fl_style_ink(style, NULL) : NULL;
    Scene *scene = g_new0(Scene, 1);
    FlTransportStyle wanted;
    if (!ink || !(scene->network = fl_network_load(argv[1], NULL)) ||
        !(scene->sliced = fl_sliced_new(ink, style->width, style->height, NULL)) ||
        !fl_guides_init(&scene->guides, SIDE, SIDE, NULL) ||
        !fl_transport_style_read(&wanted, argv[1], NULL))
        return 1;
    draw(scene, wanted.taper_px);
    scene->layers.old = (FlMaterial){{0, 0, SIDE, SIDE}, g_new0(float, 2 * PIXELS)};
    show(scene, "flat", 0);
    ask_network(scene);
    solve(scene);
    fl_material_layers_clear(&scene->layers);
    fl_guides_clear(&scene->guides);
    fl_sliced_free(scene->sliced);
    fl_network_free(scene->network);
    g_free(scene);
    return 0;
}
