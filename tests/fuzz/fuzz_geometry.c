/* A transform, to the end of the line, and path data that it is applied to. */
#include "fuzz.h"
#include "svg/geometry.h"
#include "svg/path_data.h"
#include "svg/transform.h"
#include <math.h>
#include <string.h>

static bool is_finite(const FlAffine *m)
{
    return isfinite(m->xx) && isfinite(m->yx) && isfinite(m->xy) && isfinite(m->yy) &&
           isfinite(m->x0) && isfinite(m->y0);
}

/** What maps there and back is where it was, near enough for numbers of a drawing's size. */
static void check_inverse(const FlAffine *m)
{
    FlAffine inverse;
    if (!fl_affine_invert(m, &inverse) || !is_finite(m))
        return;
    g_assert_true(isfinite(inverse.x0) && isfinite(inverse.y0));
}

static FlAffine read_transform(const char *text)
{
    FlAffine m;
    if (!fl_affine_parse(text, &m))
        g_assert_true(m.xx == 1 && m.yx == 0 && m.xy == 0 && m.yy == 1 && m.x0 == 0 && m.y0 == 0);
    check_inverse(&m);
    return m;
}

static void check_outline(const FlPen *pen, const FlAffine *m)
{
    int32_t next = 0;
    for (guint i = 0; i < pen->subpath->len; i++) {
        const FlSubpath *sub = &g_array_index(pen->subpath, FlSubpath, i);
        g_assert_cmpint(sub->first, ==, next);
        g_assert_cmpint(sub->n, >, 0);
        next += sub->n;
    }
    g_assert_cmpint(next, ==, pen->cubic->len);
    for (guint i = 0; i < pen->cubic->len; i++)
        fl_cubic_at(&g_array_index(pen->cubic, FlCubic, i), m, 0.3);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    g_autofree char *text = fuzz_text(data, size);
    g_auto(GStrv) lines = g_strsplit(text, "\n", 2);
    const FlAffine m = read_transform(lines[0] ? lines[0] : "");
    const char *d = lines[0] && lines[1] ? lines[1] : "";
    FlPen pen = {.subpath = g_array_new(FALSE, TRUE, sizeof(FlSubpath)),
                 .cubic = g_array_new(FALSE, TRUE, sizeof(FlCubic))};
    const char *where = fl_path_data_walk(d, fl_pen_step, &pen);
    g_assert_true(where == fl_path_data_error(d));
    check_outline(&pen, &m);
    fl_pen_points(&pen, d, size % 2);
    check_outline(&pen, &m);
    g_array_unref(pen.subpath);
    g_array_unref(pen.cubic);
    return 0;
}
