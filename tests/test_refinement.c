/* Ink from frame to frame by the tile and refined: it neither flickers nor fades.
 */
#include "bundled_style.h"
#include "moving_disk.h"
#include "scratch.h"
#include "transport/style_ink.h"

#include <string.h>
#include <unistd.h>

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

/* The style Smoke, whose ink is to look like its patches instead of its picture, in an empty
 * folder. */
static void make_style(const char *folder)
{
    static const char *const parts[] = {"frames", "masks", "transport.png"};
    g_autofree char *bundled = bundled_style("14");
    for (size_t k = 0; k < G_N_ELEMENTS(parts); k++) {
        g_autofree char *from = g_build_filename(bundled, parts[k], NULL);
        g_autofree char *to = g_build_filename(folder, parts[k], NULL);
        g_assert_cmpint(symlink(from, to), ==, 0);
    }
    g_free(
        scratch_write(folder, "style.ini",
                      "[style]\nname = Patches\nborder = 8\n[transport]\nsize = 384\ntaper = 7\n"));
}

/* A disk with the tile of a style and, if wanted, its patches. */
static Disk *disk_of_style(const char *folder, FlSliced *patches)
{
    Disk *disk = disk_new(1);
    fl_tile_free(disk->tile);
    disk->tile = fl_tile_load(folder, 1, NULL);
    g_assert_nonnull(disk->tile);
    static const double strength = 1;
    FlCarriedInkInput input = {.tile = disk->tile,
                               .patches = patches,
                               .refine = 8,
                               .width = SIDE,
                               .height = SIDE,
                               .scale = 1,
                               .strength = &strength,
                               .seed = 3};
    fl_carried_ink_free(disk->ink);
    disk->ink = fl_carried_ink_new(&input, NULL);
    return disk;
}

/* What moves, grows, turns by a quarter or rests flickers no more than the bounds say. */
static void ink_does_not_flicker(void)
{
    static const Motion motions[] = {
        {"moving", 3, 0, 1, 0.08f, 0.15f},
        {"growing", 2.8f, 0, 1.012f, 0.08f, 0.15f},
        {"turning", 0, 0.0654498f, 1, 0.08f, 0.15f},
        {"at rest", 0, 0, 1, 0, 0},
    };
    g_autoptr(Scratch) folder = scratch_make();
    make_style(folder);
    g_autoptr(FlSliced) patches = fl_style_patches(folder, NULL);
    for (size_t k = 0; k < G_N_ELEMENTS(motions); k++)
        for (int with = 0; with < 2; with++) {
            static const char *const names[] = {"tile", "refined"};
            const Motion *m = &motions[k];
            const float bounds[] = {m->tile, m->refined};
            Disk *disk = disk_of_style(folder, with == 1 ? patches : NULL);
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
    g_autoptr(Scratch) folder = scratch_make();
    make_style(folder);
    g_autoptr(FlSliced) patches = fl_style_patches(folder, NULL);
    double loss[2];
    for (int refined = 0; refined < 2; refined++) {
        Disk *disk = disk_of_style(folder, refined ? patches : NULL);
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
    g_autoptr(Scratch) folder = scratch_make();
    make_style(folder);
    g_autoptr(FlSliced) patches = fl_style_patches(folder, NULL);
    Disk *disk = disk_of_style(folder, patches);
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

static void a_refined_state_continues(void)
{
    const Motion growing = {.shift = 2.3f, .growth = 1.01f}, rest = {.growth = 1};
    g_autoptr(Scratch) folder = scratch_make();
    make_style(folder);
    g_autoptr(FlSliced) patches = fl_style_patches(folder, NULL);
    Disk *disk = disk_of_style(folder, patches), *other = disk_of_style(folder, patches);
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

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/refinement/" #name, name)
    TEST(ink_does_not_flicker);
    TEST(refined_ink_looks_like_its_style);
    TEST(refined_ink_does_not_decay);
    TEST(a_refined_state_continues);
    return g_test_run();
}
