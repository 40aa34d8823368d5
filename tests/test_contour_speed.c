/* The speed of a contour: of a disk that slides, stops, grows, or does so without known motion. */
#include "guides/contour_speed.h"
#include "guides/guides.h"
#include <math.h>
#include <string.h>

enum { SIDE = 120, FRAMES = 12, CENTRE = 60 };

/* What a disk does in every frame. */
typedef struct Disk {
    double slide, grow; // px to the right, px of its radius
    bool known;         // whether the slide is the drawing's motion
    int stops;          // in this frame it no longer moves
} Disk;

static double moved(const Disk *disk, int frame)
{
    return MIN(frame, disk->stops);
}

static double distance(const Disk *disk, int frame, int x, int y)
{
    const double t = moved(disk, frame);
    return 22 + disk->grow * t - hypot(x - 48 - disk->slide * t, y - CENTRE);
}

static bool disk_mask(void *data, int frame, uint8_t *coverage, GError **error)
{
    for (int p = 0; p < SIDE * SIDE; p++)
        coverage[p] =
            (uint8_t)lround(255 * CLAMP(distance(data, frame, p % SIDE, p / SIDE) + 0.5, 0.0, 1.0));
    return true;
}

static bool disk_motion(void *data, int frame, const FlOutlinePair *outlines, float *motion,
                        GError **error)
{
    const Disk *disk = data;
    const double t = moved(disk, frame) - moved(disk, frame - 1);
    for (int p = 0; p < SIDE * SIDE; p++) {
        motion[2 * p] = disk->known ? (float)(disk->slide * t) : NAN;
        motion[2 * p + 1] = disk->known ? 0 : NAN;
    }
    return true;
}

/* The speed in a frame at a place that lies so far outside the contour, on the right or left. */
static float speed_beside(const Disk *disk, int frame, bool right, double outside)
{
    g_autoptr(GError) error = NULL;
    g_auto(FlGuides) guides = {0};
    const FlGuideParams params = {.still_px = 0.05f, .flow_limit = 0.1f, .contour_px = 0.5f};
    const FlGuideSource source = {SIDE, SIDE, FRAMES, disk_mask, NULL, (Disk *)disk, disk_motion};
    g_autoptr(FlGuideSequence) sequence = fl_guide_sequence_new(&source, &params, &error);
    g_assert_true(sequence && fl_guides_init(&guides, SIDE, SIDE, &error));
    g_assert_true(fl_guide_sequence_get(sequence, frame, &guides, &error));
    const double t = moved(disk, frame), radius = 22 + disk->grow * t + outside;
    const double x = 48 + disk->slide * t + (right ? radius : -radius);
    return guides.contour_speed[CENTRE * SIDE + lround(x)];
}

#define assert_near(value, expected, tolerance)                                                    \
    g_assert_cmpfloat_with_epsilon((double)(value), (double)(expected), (double)(tolerance))

static void a_slide_has_a_side_that_advances_and_one_that_recedes(void)
{
    for (int known = 0; known < 2; known++) {
        const Disk disk = {2, 0, known, FRAMES};
        for (double outside = -5; outside <= 8; outside += 13) {
            assert_near(speed_beside(&disk, 9, true, outside), 2, 0.15);
            assert_near(speed_beside(&disk, 9, false, outside), -2, 0.15);
        }
    }
}

static void growth_advances_on_all_sides(void)
{
    const Disk disk = {0, 1.5, false, FRAMES};
    assert_near(speed_beside(&disk, 9, true, 3), 1.5, 0.15);
    assert_near(speed_beside(&disk, 9, false, 3), 1.5, 0.15);
}

static void a_stop_is_felt_for_some_frames_and_then_no_more(void)
{
    const Disk disk = {2, 0, true, 4};
    assert_near(speed_beside(&disk, 0, true, 3), 0, 1e-6); // nothing was before
    const float first = speed_beside(&disk, 5, true, 3), second = speed_beside(&disk, 6, true, 3);
    g_assert_cmpfloat(first, >, 0.5f);
    g_assert_cmpfloat(second, <, 0.6f * first);
    g_assert_cmpfloat(second, >, 0.1f);
    assert_near(speed_beside(&disk, 11, true, 3), 0, 1e-6);
}

static void far_from_the_contour_there_is_none(void)
{
    const Disk disk = {2, 0, true, FRAMES};
    assert_near(speed_beside(&disk, 9, true, -20), 0, 1e-6);
    assert_near(speed_beside(&disk, 9, false, 15), 0, 1e-6);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/contour-speed/" #name, name)
    TEST(a_slide_has_a_side_that_advances_and_one_that_recedes);
    TEST(growth_advances_on_all_sides);
    TEST(a_stop_is_felt_for_some_frames_and_then_no_more);
    TEST(far_from_the_contour_there_is_none);
#undef TEST
    return g_test_run();
}
