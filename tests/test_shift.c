/* The temporal shift: a target that moves against its exemplar plays it backwards. */
#include "default_params.h"
#include "small_style.h"
#include "synth/shift.h"
#include "synth/synth.h"

#define FRAME ((size_t)STYLE_W * STYLE_H)

static FlExemplar *exemplar_new(void)
{
    g_autofree FlParams *params = default_params();
    g_autoptr(FlStyle) style = small_style();
    FlExemplar *exemplar = fl_exemplar_new(style, params, NULL);
    g_assert_nonnull(exemplar);
    return exemplar;
}

/* Gives the exemplar paint everywhere, whose extents after frame t are forwards[t] and, played
 * backwards, backwards[t]. */
static void set_extents(FlExemplar *exemplar, const float forwards[STYLE_FRAMES],
                        const float backwards[STYLE_FRAMES])
{
    memset(exemplar->mask, 255, STYLE_FRAMES * FRAME);
    for (size_t p = 0; p < STYLE_FRAMES * FRAME; p++) {
        exemplar->ext_plus[p] = forwards[p / FRAME];
        exemplar->ext_minus[p] = backwards[p / FRAME];
    }
}

/* The frame that a match in the middle goes to when the target moves so far. */
static int shifted(const FlExemplar *exemplar, int frame, float motion_px, bool against)
{
    const uint8_t direction =
        fl_exemplar_at(&exemplar->level[0], STYLE_W / 2, STYLE_H / 2, frame)->c[FL_CH_ANGLE];
    const uint8_t angle = (uint8_t)(direction + (against ? 128 : 0));
    const FlTargetMotion motion = {.speed = &motion_px, .angle = &angle, .still = -1};
    FlMatch match = {16 * STYLE_W / 2, 16 * STYLE_H / 2, .frame = (int16_t)frame};
    FlNnf nnf = {.width = 1, .height = 1, .match = &match};
    fl_nnf_shift(&nnf, exemplar, &motion);
    return match.frame;
}

/* Motion of 1, 2, 3 … px between frames: which frame is nearest differs by direction. */
static void a_target_against_its_exemplar_plays_it_backwards(void)
{
    static const float forwards[STYLE_FRAMES] = {0, 1, 3, 6, 10, 15};
    static const float backwards[STYLE_FRAMES] = {15, 14, 12, 9, 5, 0};
    g_autoptr(FlExemplar) exemplar = exemplar_new();
    set_extents(exemplar, forwards, backwards);
    g_assert_cmpint(shifted(exemplar, 2, 3, false), ==, 3);
    g_assert_cmpint(shifted(exemplar, 2, 7, false), ==, 4);
    g_assert_cmpint(shifted(exemplar, 2, 12, false), ==, 5);
    g_assert_cmpint(shifted(exemplar, 3, 3, true), ==, 2);
    g_assert_cmpint(shifted(exemplar, 3, 5, true), ==, 1);
    g_assert_cmpint(shifted(exemplar, 5, 5, true), ==, 4);
    g_assert_cmpint(shifted(exemplar, 5, 9, true), ==, 3);
    g_assert_cmpint(shifted(exemplar, 0, 3, true), ==, 0); // none is before it
    g_assert_cmpint(shifted(exemplar, 5, 3, false), ==, 5);
}

/* The exemplar reversed in time, whose extents change places. */
static void backwards_is_forwards_in_the_reversed_exemplar(void)
{
    static const float a[STYLE_FRAMES] = {0, 2, 2.5f, 6, 6, 11};
    static const float b[STYLE_FRAMES] = {9, 8, 7.5f, 4, 3, 0};
    g_autoptr(FlExemplar) exemplar = exemplar_new(), reversed = exemplar_new();
    float a_back[STYLE_FRAMES], b_back[STYLE_FRAMES];
    for (int t = 0; t < STYLE_FRAMES; t++)
        a_back[t] = a[STYLE_FRAMES - 1 - t], b_back[t] = b[STYLE_FRAMES - 1 - t];
    set_extents(exemplar, a, b);
    set_extents(reversed, b_back, a_back);
    for (int t = 0; t < STYLE_FRAMES; t++)
        for (int against = 0; against < 2; against++)
            for (float px = 0; px < 12; px += 0.7f)
                g_assert_cmpint(shifted(exemplar, t, px, against), ==,
                                STYLE_FRAMES - 1 -
                                    shifted(reversed, STYLE_FRAMES - 1 - t, px, !against));
}

/* Extents grow in their own direction of time, from the disc that grows in the style. */
static void extents_grow_in_their_direction_of_time(void)
{
    g_autoptr(FlExemplar) exemplar = exemplar_new();
    const size_t near_rim = (STYLE_H / 2) * STYLE_W + STYLE_W / 2 + 10;
    const float *plus = exemplar->ext_plus + near_rim, *minus = exemplar->ext_minus + near_rim;
    for (size_t t = 1; t < STYLE_FRAMES; t++) {
        g_assert_cmpfloat(plus[t * FRAME], >, plus[(t - 1) * FRAME]);
        g_assert_cmpfloat(minus[t * FRAME], <, minus[(t - 1) * FRAME]);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/shift/" #name, name)
    TEST(a_target_against_its_exemplar_plays_it_backwards);
    TEST(backwards_is_forwards_in_the_reversed_exemplar);
    TEST(extents_grow_in_their_direction_of_time);
    return g_test_run();
}
