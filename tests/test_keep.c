/* Paint that fits as it was carried is kept: of figures that move, and of shapes that are built. */
#include "default_params.h"
#include "small_style.h"
#include "synth/synth.h"

enum { SIDE = TARGET_SIDE, PIXELS = SIDE * SIDE };

/* A film of masks. */
typedef struct Film {
    double (*inside)(int frame, double x, double y); // px from the contour
    float u;                                         // px a frame to the right; NAN: unknown
    FlSynth *synth;
    FlGuideSequence *guides;
    FlParams *params;
    FlStyle *style;
    FlExemplar *exemplar;
} Film;

static bool film_mask(void *data, int frame, uint8_t *coverage, GError **error)
{
    const Film *film = data;
    for (int p = 0; p < PIXELS; p++)
        coverage[p] = (uint8_t)(CLAMP(film->inside(frame, p % SIDE, p / SIDE) + 0.5, 0, 1) * 255);
    return true;
}

static bool film_motion(void *data, int frame, const FlOutlinePair *outlines, float *motion,
                        GError **error)
{
    const Film *film = data;
    for (int p = 0; p < PIXELS; p++)
        motion[2 * p] = film->u, motion[2 * p + 1] = isnan(film->u) ? NAN : 0;
    return true;
}

static void film_open(Film *film, int n_frames)
{
    const FlGuideSource source = {SIDE, SIDE, n_frames, film_mask, NULL, film, film_motion};
    film->params = default_params();
    film->params->w_age = 0; // as it was laid
    film->style = small_style();
    film->exemplar = fl_exemplar_new(film->style, film->params, NULL);
    const FlGuideParams how = fl_guide_params(film->params);
    film->guides = fl_guide_sequence_new(&source, &how, NULL);
    film->synth =
        fl_synth_new(film->exemplar, film->params, (FlSynthSize){SIDE, SIDE, SIDE, SIDE}, 7);
}

static void film_close(Film *film)
{
    fl_synth_free(film->synth);
    fl_guide_sequence_free(film->guides);
    fl_exemplar_free(film->exemplar);
    fl_style_free(film->style);
    g_free(film->params);
}

static void paint_frame(Film *film, int frame, uint8_t *rgb)
{
    g_auto(FlGuides) guides = {0};
    g_assert_true(fl_guides_init(&guides, SIDE, SIDE, NULL) &&
                  fl_guide_sequence_get(film->guides, frame, &guides, NULL) &&
                  fl_synth_frame(film->synth, &guides, rgb, NULL, NULL, NULL));
}

static double sliding(int frame, double x, double y)
{
    return 14 - hypot(x - 18 - 2 * frame, y - 24);
}

static void a_figure_that_slides_has_the_same_paint(void)
{
    Film film = {.inside = sliding, .u = 2};
    uint8_t before[3 * PIXELS], now[3 * PIXELS];
    film_open(&film, 4);
    paint_frame(&film, 0, before);
    for (int f = 1; f < 4; f++) {
        paint_frame(&film, f, now);
        for (int p = 2; p < PIXELS; p++)
            if (sliding(f, p % SIDE, p / SIDE) > 3)
                for (int c = 0; c < 3; c++)
                    g_assert_cmpint(now[3 * p + c], ==, before[3 * (p - 2) + c]);
        memcpy(before, now, sizeof now);
    }
    film_close(&film);
}

/* A band that gets longer by 10 px a frame. */
static double built(int frame, double x, double y)
{
    return MIN(MIN(x - 3, 14 + 10 * frame - x), MIN(y - 8, 40 - y));
}

/* Whether anything of a column has changed that lies deeper than 4 px on both sides. */
static bool has_changed(const uint8_t *before, const uint8_t *now, int x)
{
    bool changed = false;
    for (int y = 14; y <= 34; y++)
        changed |= memcmp(before + 3 * (y * SIDE + x), now + 3 * (y * SIDE + x), 3) != 0;
    return changed;
}

static void what_is_built_stays_and_its_last_edge_is_laid_again(void)
{
    Film film = {.inside = built, .u = NAN};
    uint8_t picture[4][3 * PIXELS];
    film_open(&film, 4);
    for (int f = 0; f < 4; f++)
        paint_frame(&film, f, picture[f]);
    for (int x = 9; x < 15; x++) // the edge went from 34 to 44
        g_assert_false(has_changed(picture[2], picture[3], x));
    for (int x = 31; x < 34; x++)
        g_assert_true(has_changed(picture[2], picture[3], x));
    film_close(&film);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/keep/" #name, name)
    TEST(a_figure_that_slides_has_the_same_paint);
    TEST(what_is_built_stays_and_its_last_edge_is_laid_again);
#undef TEST
    return g_test_run();
}
