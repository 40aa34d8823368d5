#include "compose/edge_map.h"
#include "scratch.h"

#include <string.h>

enum { WIDTH = 100, LEFT_PX = 50, BORDER_PX = 8 };

/** Two neighbours, the left one of x < 50 and the right one beyond. */
static FlDrawing *neighbours(const char *folder)
{
    g_free(scratch_svg(folder, "1.svg",
                       "<path d='M0 0H50V100H0z' fill='#36c'/>"
                       "<path d='M50 0H100V100H50z' fill='#c63'/>"));
    const char *const inputs[] = {folder};
    const FlDrawingOptions options = {.inputs = inputs, .n_inputs = 1};
    g_autoptr(GError) error = NULL;
    FlDrawing *drawing = fl_drawing_open(&options, NULL, &error);
    g_assert_no_error(error);
    return drawing;
}

/** How much paint the left one has at its right edge, in 1/FL_AMOUNT_ONE, with both that opaque; by
 * itself its rim is bare. */
static int at_the_edge(const FlDrawing *drawing, FlDrawList *draws, int left, int right)
{
    const FlStyleInstance style = {.border_px = BORDER_PX};
    const FlRegionSettings settings = {.edges = FL_EDGES_CLOSED};
    const FlPaintedRegion painted = {.settings = &settings, .style = &style};
    const FlPaintedRegion *const all[] = {&painted, &painted};
    const FlComposeInput input = {
        .drawing = drawing, .painted_of = (int[]){0, 1}, .n_painted = 2, .painted = all};
    g_assert_cmpint(draws->n, ==, 2);
    draws->draw[0].alpha = (uint8_t)left, draws->draw[1].alpha = (uint8_t)right;
    const FlRect box = draws->draw[0].area.box;
    g_autofree int16_t *amounts = g_new(int16_t, fl_rect_pixels(box));
    for (int y = 0; y < box.height; y++)
        for (int x = 0; x < box.width; x++) {
            const int depth = LEFT_PX - 1 - (box.x + x);
            const int full = MIN(depth * FL_AMOUNT_ONE / BORDER_PX, FL_AMOUNT_ONE);
            const bool inside = draws->draw[0].coverage[(size_t)y * (size_t)box.width + x] > 0;
            amounts[(size_t)y * (size_t)box.width + x] = (int16_t)(inside ? full : -1);
        }
    g_autoptr(GError) error = NULL;
    g_auto(FlEdgeMap) edges = {0};
    g_assert_true(fl_edges_init(&edges, &input, draws, &error));
    g_assert_true(fl_edges_close(&edges, 0, &painted, amounts, &error));
    g_assert_no_error(error);
    return amounts[50 * box.width + LEFT_PX - 2 - box.x];
}

static void a_neighbour_that_fades_gives_the_edge_its_rim_back_little_by_little(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing = neighbours(folder);
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, 0, NULL);
    const int closed = at_the_edge(drawing, draws, 255, 255);
    const int open = at_the_edge(drawing, draws, 255, 0);
    g_assert_cmpint(closed, >=, FL_AMOUNT_ONE * 3 / 4);
    g_assert_cmpint(open, <, FL_AMOUNT_ONE / 4);
    int last = closed;
    for (int alpha = 254; alpha >= 0; alpha--) {
        const int now = at_the_edge(drawing, draws, 255, alpha);
        g_assert_cmpint(now, <=, last);
        g_assert_cmpint(now, >=, last - (closed - open) / 16);
        last = now;
    }
}

static void neighbours_that_fade_together_stay_closed(void)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autoptr(FlDrawing) drawing = neighbours(folder);
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, 0, NULL);
    const int closed = at_the_edge(drawing, draws, 255, 255);
    for (int alpha = 254; alpha > 0; alpha -= 11)
        g_assert_cmpint(at_the_edge(drawing, draws, alpha, alpha), ==, closed);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/edge-map/" #name, name)
    TEST(a_neighbour_that_fades_gives_the_edge_its_rim_back_little_by_little);
    TEST(neighbours_that_fade_together_stay_closed);
    return g_test_run();
}
