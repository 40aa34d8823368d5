/* What a render leaves in the process that asked for it. */
#include "scratch.h"
#include "threads.h"
#include <fluidy/fluidy.h>

/* A drawing painted with the small style, to a list of sums unless `output` is set. */
static void paint(FlRenderOptions options)
{
    g_autoptr(Scratch) folder = scratch_make();
    g_autofree char *drawing =
        scratch_svg(folder, "d_1.svg", "<circle cx='50' cy='50' r='30' fill='#335588'/>");
    g_autofree char *output = g_build_filename(folder, "d.sha256", NULL);
    g_autofree char *style = g_test_build_filename(G_TEST_DIST, "style-small", NULL);
    const FlSetting settings[] = {{.name = "style", .value = style}};
    const char *const inputs[] = {drawing, NULL};
    g_autoptr(GError) error = NULL;
    options.inputs = inputs, options.output = output, options.width = 32;
    options.settings = settings, options.n_settings = 1;
    fl_render(&options, &error);
    g_assert_no_error(error);
}

static void the_number_of_threads_is_the_render_s_own(void)
{
    const int before = omp_get_max_threads();
    paint((FlRenderOptions){.threads = before + 1});
    g_assert_cmpint(omp_get_max_threads(), ==, before);
    paint((FlRenderOptions){.threads = 1});
    g_assert_cmpint(omp_get_max_threads(), ==, before);
}

int main(int argc, char **argv)
{
    g_setenv("G_TEST_SRCDIR", g_getenv("FLUIDY_FIXTURES"), true);
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/render/" #name, name)
    TEST(the_number_of_threads_is_the_render_s_own);
    return g_test_run();
}
