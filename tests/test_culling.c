/* Stacks of discs: what is culled is not seen. */
#include "base/rng.h"
#include "compose/culling.h"

#include <math.h>
#include <string.h>

enum { W = 90, H = 71, LAYERS = 9 };

typedef struct Scene {
    FlLayersAbove above;
    bool culls;
    size_t culled; // pixels
} Scene;

static void scene_init(Scene *scene, bool culls)
{
    *scene = (Scene){.culls = culls};
    g_assert_true(fl_layers_above_init(&scene->above, W, H, 0, NULL));
}

/* A disc with a soft edge, flat paint and some that is thin. */
static FlLayer disc(uint64_t key, uint8_t *coverage)
{
    FlRng rng = {key};
    const double x = fl_rng_below(&rng, W), y = fl_rng_below(&rng, H);
    const double radius = 6 + fl_rng_below(&rng, 30);
    uint8_t *plane = g_malloc0(W * H);
    for (int p = 0; p < W * H; p++)
        plane[p] = (uint8_t)CLAMP(255 * (radius - hypot(p % W - x, p / W - y)), 0, 255);
    FlLayer layer = {.alpha = key % 4 ? 255 : 240, .stacking = FL_STACKING_KNOCKOUT};
    fl_area_init(&layer.area, plane, W, H);
    fl_rect_copy(plane, (FlRect){0, 0, W, H}, coverage, layer.area.box, 1);
    g_free(plane);
    layer.coverage = coverage;
    return layer;
}

static void paint(FlLayer *layer, uint64_t key)
{
    const size_t n = fl_rect_pixels(layer->area.box);
    layer->rgba = calloc(n + 1, 4);
    layer->knockout = calloc(n + 1, 1);
    for (size_t p = 0; p < n; p++)
        if (layer->coverage[p]) {
            const uint8_t thin = key % 3 && p % 7 == 0 ? 180 : 255;
            memcpy(layer->rgba + 4 * p,
                   (uint8_t[]){(uint8_t)(37 * key), (uint8_t)(91 * key), (uint8_t)p, thin}, 4);
            layer->knockout[p] = key % 5 ? 255 : thin;
        }
}

static void layer_clear(FlLayer *layer)
{
    fl_area_clear(&layer->area);
    free(layer->rgba);
    free(layer->knockout);
    if (layer->owns_coverage)
        free((uint8_t *)layer->coverage);
}

static size_t covered(const FlLayer *layer)
{
    size_t n = 0;
    for (size_t p = 0; p < fl_rect_pixels(layer->area.box); p++)
        n += layer->coverage[p] > 0;
    return n;
}

static void compose(Scene *scene, uint64_t seed, uint8_t *out)
{
    static uint8_t coverage[LAYERS][W * H];
    const FlBackdrop paper = {.flat = {250, 240, 230, 255}};
    FlLayer layers[LAYERS];
    for (int k = LAYERS - 1; k >= 0; k--) {
        const uint64_t key = seed * LAYERS + (uint64_t)k;
        layers[k] = disc(key, coverage[k]);
        const size_t whole = covered(&layers[k]);
        g_assert_true(fl_layer_cull(&layers[k], scene->culls ? &scene->above : NULL, NULL));
        scene->culled += whole - covered(&layers[k]);
        paint(&layers[k], key);
        fl_layer_occlude(&layers[k], &scene->above);
        g_assert_true(fl_layer_pack(&layers[k], NULL));
    }
    fl_layers_compose(layers, LAYERS, &paper, W, H, false, out);
    for (int k = 0; k < LAYERS; k++) {
        fl_pixel_runs_clear(&layers[k].runs);
        layer_clear(&layers[k]);
    }
    fl_layers_above_clear(&scene->above);
}

static void what_is_culled_is_not_seen(void)
{
    static uint8_t whole[4 * W * H], culled[4 * W * H];
    size_t n = 0;
    for (uint64_t seed = 0; seed < 40; seed++) {
        Scene scene;
        scene_init(&scene, false);
        compose(&scene, seed, whole);
        g_assert_cmpuint(scene.culled, ==, 0);
        scene_init(&scene, true);
        compose(&scene, seed, culled);
        g_assert_cmpmem(culled, sizeof culled, whole, sizeof whole);
        n += scene.culled;
    }
    g_assert_cmpuint(n, >, 40 * W * H / 4); // a quarter of the page in each stack
}

static void a_gap_keeps_layers_whole(void)
{
    static uint8_t coverage[2][W * H];
    Scene scene;
    scene_init(&scene, true);
    fl_layers_above_clear(&scene.above);
    g_assert_true(fl_layers_above_init(&scene.above, W, H, 3, NULL));
    FlLayer upper = disc(3, coverage[0]), lower = disc(3, coverage[1]);
    paint(&upper, 1);
    fl_layer_occlude(&upper, &scene.above);
    g_assert_true(fl_layer_cull(&lower, &scene.above, NULL));
    g_assert_true(lower.coverage == coverage[1]);
    layer_clear(&upper);
    layer_clear(&lower);
    fl_layers_above_clear(&scene.above);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/culling/what-is-culled-is-not-seen", what_is_culled_is_not_seen);
    g_test_add_func("/culling/a-gap-keeps-layers-whole", a_gap_keeps_layers_whole);
    return g_test_run();
}
