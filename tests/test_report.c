/* The page to look at: what is written into it. */
#include "base/json.h"
#include "inspect/region_watch.h"
#include "inspect/page_script.h"
#include <math.h>
#include <string.h>

/* The script, without what stands around it. To be freed. */
static char *script_of(const char *value)
{
    char *text = NULL;
    size_t n = 0;
    FILE *out = open_memstream(&text, &n);
    g_autoptr(GString) json = g_string_new(NULL);
    fl_json_text(json, NULL, value);
    fl_script_write(out, "a(", json, ");");
    fclose(out);
    g_assert_true(g_str_has_prefix(text, "<script>a(") && g_str_has_suffix(text, ");</script>\n"));
    char *script = g_strndup(text + 10, n - 10 - strlen(");</script>\n"));
    free(text);
    return script;
}

static void a_name_cannot_end_the_script(void)
{
    g_autofree char *text = script_of("a</script>\"\\\n\xe2\x80\xa8é");
    g_assert_cmpstr(text, ==, "\"a\\u003c/script\\u003e\\\"\\\\\\u000a\\u2028é\"");
}

static void bytes_that_are_no_text_become_text(void)
{
    g_autofree char *text = script_of("\xff!");
    g_assert_cmpstr(text, ==, "\"\xef\xbf\xbd!\"");
    g_autofree char *nothing = script_of(NULL);
    g_assert_cmpstr(nothing, ==, "null");
}

static void numbers_are_whole_or_short_or_unknown(void)
{
    const double values[] = {NAN, INFINITY, 0.25, 12345678, 1.23456789};
    g_autoptr(GString) json = g_string_new("[");
    for (size_t k = 0; k < G_N_ELEMENTS(values); k++)
        fl_json_number(json, NULL, values[k], true);
    fl_json_number(json, "name", 1, false);
    g_assert_cmpstr(json->str, ==, "[null,null,0.25,12345678,1.23457,\"name\":null");
}

static void a_picture_is_a_data_uri(void)
{
    uint8_t rgba[] = {255, 0, 0, 128};
    const FlPicture picture = {1, 1, rgba};
    g_autoptr(GString) json = g_string_new("{");
    g_assert_true(fl_script_picture(json, "it", &picture, false, NULL));
    g_assert_true(g_str_has_prefix(json->str, "{\"it\":\"data:image/png;base64,iVBORw0KGgo"));
    g_assert_true(g_str_has_suffix(json->str, "\""));
}

enum { WIDTH = 12, HEIGHT = 5 };

/* Stripes that have moved by shift px, in a mask that fills the frame. */
static void paint_stripes(FlPaintedRegion *painted, FlGuides *guides, int shift, float flow)
{
    for (int p = 0; p < WIDTH * HEIGHT; p++) {
        memset(painted->painted + 3 * p, (p % WIDTH + WIDTH - shift) % 4 * 60, 3);
        guides->mask[p] = 255;
        guides->flow[2 * p] = flow;
        guides->flow[2 * p + 1] = 0;
    }
}

static void paint_that_moves_with_its_region_does_not_flicker(void)
{
    uint8_t part[3 * WIDTH * HEIGHT];
    FlExemplar exemplar = {0};
    const FlStyleInstance style = {.exemplar = &exemplar};
    FlPaintedRegion painted = {.painted = part, .style = &style, .rect = {0, 0, WIDTH, HEIGHT}};
    g_auto(FlGuides) guides = {0};
    g_assert_true(fl_guides_init(&guides, WIDTH, HEIGHT, NULL));
    FlFlicker flicker = {0};
    paint_stripes(&painted, &guides, 0, 2);
    g_assert_true(fl_flicker_measure(&flicker, &painted, &guides, NULL));
    g_assert_true(isnan(flicker.change)); // nothing came before
    paint_stripes(&painted, &guides, 2, 0);
    g_assert_true(fl_flicker_measure(&flicker, &painted, &guides, NULL));
    g_assert_cmpfloat(flicker.change, ==, 0);
    paint_stripes(&painted, &guides, 4, 0);
    g_assert_true(fl_flicker_measure(&flicker, &painted, &guides, NULL));
    g_assert_cmpfloat(flicker.change, ==, 120);
    fl_flicker_clear(&flicker);
}

/* A shape of three columns whose content moved by `step` px into the frame; width 0: none. */
static void draw_shape(FlGuides *guides, int column, int width, float step)
{
    for (int p = 0; p < WIDTH * HEIGHT; p++) {
        const int x = p % WIDTH - column, y = p / WIDTH;
        const bool inside = x >= 0 && x < width;
        guides->mask[p] = inside ? 255 : 0;
        guides->distance[p] = inside ? (float)(MIN(MIN(x + 1, width - x), MIN(y, 4 - y) + 1)) : -1;
        guides->flow[2 * p] = 0.25f; // less than half of it, as flow from masks may be
        guides->motion[2 * p] = inside ? (int32_t)(step * FL_MOTION_ONE) : FL_MOTION_UNKNOWN;
        guides->motion[2 * p + 1] = inside ? 0 : FL_MOTION_UNKNOWN;
        guides->turn[p] = inside ? 1024 : 0;
    }
    guides->has_motion = step != 0;
}

static void a_point_goes_and_turns_as_the_drawing_does(void)
{
    const FlRect rect = {100, 50, WIDTH, HEIGHT};
    g_auto(FlGuides) guides = {0};
    g_assert_true(fl_guides_init(&guides, WIDTH, HEIGHT, NULL));
    FlFollowedPoint point = {0};
    draw_shape(&guides, 2, 3, 0);
    fl_followed_point_move(&point, rect, &guides);
    g_assert_true(point.here && point.found);
    g_assert_cmpfloat(point.x, ==, 103); // the middle of the middle column
    g_assert_cmpfloat(point.y, ==, 51);
    point.found = false;
    for (int k = 0; k < 4; k++) {
        draw_shape(&guides, 3 + k, 3, 1.25f);
        fl_followed_point_move(&point, rect, &guides);
    }
    g_assert_false(point.found);
    g_assert_cmpfloat(point.x, ==, 108);
    g_assert_cmpfloat(point.y, ==, 51);
    g_assert_cmpfloat(point.turn, ==, 4.0f / 64);
    draw_shape(&guides, 6, 3, 0);
    fl_followed_point_move(&point, rect, &guides);
    g_assert_cmpfloat(point.x, ==, 108.25f); // where no motion is known, along the flow
}

static void a_point_that_is_lost_is_found_anew(void)
{
    const FlRect rect = {0, 0, WIDTH, HEIGHT};
    g_auto(FlGuides) guides = {0};
    g_assert_true(fl_guides_init(&guides, WIDTH, HEIGHT, NULL));
    FlFollowedPoint point = {.here = true, .x = 2, .y = 2, .turn = 0.5f};
    draw_shape(&guides, 6, 5, 5);
    fl_followed_point_move(&point, rect, &guides);
    g_assert_true(point.here && !point.found && point.x == 7);
    point.x = 2;
    draw_shape(&guides, 6, 5, 0.5f);
    fl_followed_point_move(&point, rect, &guides);
    g_assert_true(point.here && point.found && point.x == 8 && point.y == 2 && point.turn == 0);
    draw_shape(&guides, 0, 0, 0);
    fl_followed_point_move(&point, rect, &guides);
    g_assert_false(point.here);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/report/a name cannot end the script", a_name_cannot_end_the_script);
    g_test_add_func("/report/bytes that are no text become text",
                    bytes_that_are_no_text_become_text);
    g_test_add_func("/report/numbers are whole, short or unknown", numbers_are_whole_or_short_or_unknown);
    g_test_add_func("/report/a picture is a data URI", a_picture_is_a_data_uri);
    g_test_add_func("/report/paint that moves with its region does not flicker",
                    paint_that_moves_with_its_region_does_not_flicker);
    g_test_add_func("/report/a point goes and turns as the drawing does",
                    a_point_goes_and_turns_as_the_drawing_does);
    g_test_add_func("/report/a point that is lost is found anew",
                    a_point_that_is_lost_is_found_anew);
    return g_test_run();
}
