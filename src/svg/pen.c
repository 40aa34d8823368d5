#include "svg/pen.h"

#include "svg/css_scan.h"
#include <math.h>
#include <string.h>

static FlPoint between(FlPoint a, FlPoint b, double t)
{
    return (FlPoint){a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t};
}

FlPen fl_pen_new(void)
{
    return (FlPen){.subpath = g_array_new(FALSE, TRUE, sizeof(FlSubpath)),
                   .cubic = g_array_new(FALSE, TRUE, sizeof(FlCubic))};
}

void fl_pen_move(FlPen *pen, FlPoint p)
{
    pen->at = pen->start = p;
    pen->open = false;
}

static void curve_to(FlPen *pen, FlPoint a, FlPoint b, FlPoint end)
{
    if (!pen->open) {
        const FlSubpath fresh = {(int32_t)pen->cubic->len, 0, false};
        g_array_append_val(pen->subpath, fresh);
        pen->open = true;
    }
    const FlCubic cubic = {{pen->at, a, b, end}};
    g_array_append_val(pen->cubic, cubic);
    g_array_index(pen->subpath, FlSubpath, pen->subpath->len - 1).n++;
    pen->at = end;
}

void fl_pen_line(FlPen *pen, FlPoint end)
{
    curve_to(pen, between(pen->at, end, 1.0 / 3), between(pen->at, end, 2.0 / 3), end);
}

static void quadratic_to(FlPen *pen, FlPoint control, FlPoint end)
{
    curve_to(pen, between(pen->at, control, 2.0 / 3), between(end, control, 2.0 / 3), end);
}

/** Returns: true if a subpath ends at its start, up to the rounding of relative numbers. */
static bool is_back(const FlPen *pen)
{
    const FlSubpath *sub = &g_array_index(pen->subpath, FlSubpath, pen->subpath->len - 1);
    double reach = 0;
    for (int k = 0; k < sub->n; k++) {
        const FlPoint *p = g_array_index(pen->cubic, FlCubic, sub->first + k).p;
        reach = MAX(reach, MAX(fabs(p[3].x - pen->start.x), fabs(p[3].y - pen->start.y)));
    }
    return fabs(pen->at.x - pen->start.x) + fabs(pen->at.y - pen->start.y) <= 1e-3 * reach;
}

void fl_pen_close(FlPen *pen)
{
    if (pen->open) {
        if (!is_back(pen))
            fl_pen_line(pen, pen->start);
        g_array_index(pen->subpath, FlSubpath, pen->subpath->len - 1).closed = true;
    } else if (pen->last == 'M') { // a dot, if it has round caps
        fl_pen_line(pen, pen->start);
    }
    fl_pen_move(pen, pen->start);
}

/** The unit vector half way from a to b on the way from x to y, which may be more than half a turn.
 */
static FlPoint bisector(FlPoint a, FlPoint b, bool more_than_half)
{
    FlPoint sum = {a.x + b.x, a.y + b.y};
    const double length = sqrt(sum.x * sum.x + sum.y * sum.y);
    if (length < 1e-9) // half a turn
        return (FlPoint){-a.y, a.x};
    const double sign = more_than_half ? -1 : 1;
    return (FlPoint){sign * sum.x / length, sign * sum.y / length};
}

/** An arc of at most a quarter turn, from a to b on the unit circle, through the map m. */
static void quarter_to(FlPen *pen, const FlAffine *m, FlPoint a, FlPoint b)
{
    // 4/3 tan of a quarter of the angle, by halving it twice
    const double cosine = CLAMP(a.x * b.x + a.y * b.y, -1, 1);
    const double c2 = sqrt((1 + cosine) / 2), s2 = sqrt((1 - cosine) / 2);
    const double k = 4.0 / 3 * (s2 / (1 + c2));
    const FlPoint p = {a.x - k * a.y, a.y + k * a.x}, q = {b.x + k * b.y, b.y - k * b.x};
    curve_to(pen, fl_affine_apply(m, p), fl_affine_apply(m, q), fl_affine_apply(m, b));
}

/** Four cubics from a round to b, which may be more than half a turn on. */
static void turn_to(FlPen *pen, const FlAffine *m, FlPoint a, FlPoint b, bool more_than_half)
{
    const FlPoint half = bisector(a, b, more_than_half);
    const FlPoint first = bisector(a, half, false), third = bisector(half, b, false);
    quarter_to(pen, m, a, first);
    quarter_to(pen, m, first, half);
    quarter_to(pen, m, half, third);
    quarter_to(pen, m, third, b);
}

/** SVG's arc [SVG 1.1 F.6]; v: rx ry rotation large sweep. */
static void arc_to(FlPen *pen, const double *v, FlPoint end)
{
    double rx = fabs(v[0]), ry = fabs(v[1]), s, c;
    const FlPoint from = pen->at, d = {(from.x - end.x) / 2, (from.y - end.y) / 2};
    if (rx == 0 || ry == 0 || (d.x == 0 && d.y == 0)) {
        for (int k = 0; k < 4; k++) // as many segments as an arc has
            fl_pen_line(pen, between(from, end, (k + 1) / 4.0));
        return;
    }
    fl_sincos_degrees(v[2], &s, &c);
    FlPoint p = {(c * d.x + s * d.y) / rx, (-s * d.x + c * d.y) / ry};
    const double reach = p.x * p.x + p.y * p.y;
    if (reach > 1) {
        const double grow = sqrt(reach);
        rx *= grow, ry *= grow, p.x /= grow, p.y /= grow;
    }
    const bool large = v[3] != 0, sweep = v[4] != 0;
    double h = reach < 1 ? sqrt((1 - reach) / reach) : 0;
    h = large != sweep ? h : -h;
    const FlPoint centre = {h * p.y, -h * p.x}; // on the unit circle's plane, p.x = (1 - x) / 2
    FlPoint a = {p.x - centre.x, p.y - centre.y}, b = {-p.x - centre.x, -p.y - centre.y};
    const FlPoint mid = between(from, end, 0.5);
    FlAffine m = {c * rx, s * rx, -s * ry, c * ry, 0, 0};
    if (!sweep) { // clockwise: mirrored, it is not
        m.xy = -m.xy, m.yy = -m.yy, a.y = -a.y, b.y = -b.y;
    }
    const FlPoint at = fl_affine_apply(&m, (FlPoint){centre.x, sweep ? centre.y : -centre.y});
    m.x0 = mid.x + at.x, m.y0 = mid.y + at.y;
    turn_to(pen, &m, a, b, large && reach < 1);
    pen->at = g_array_index(pen->cubic, FlCubic, pen->cubic->len - 1).p[3] = end; // to the bit
}

static FlPoint reflected(const FlPen *pen, const char *after)
{
    if (!strchr(after, pen->last))
        return pen->at;
    return (FlPoint){2 * pen->at.x - pen->control.x, 2 * pen->at.y - pen->control.y};
}

/** A step that draws a curve; a and b are its first two points, o what the rest is relative to. */
static void curve_step(FlPen *pen, char upper, const double *v, FlPoint o, FlPoint a, FlPoint b)
{
    const FlPoint smooth = reflected(pen, upper == 'S' ? "CS" : "QT");
    switch (upper) {
    case 'C':
        pen->control = b;
        curve_to(pen, a, b, (FlPoint){o.x + v[4], o.y + v[5]});
        break;
    case 'S':
        pen->control = a;
        curve_to(pen, smooth, a, b);
        break;
    case 'Q':
        pen->control = a;
        quadratic_to(pen, a, b);
        break;
    case 'T':
        pen->control = smooth;
        quadratic_to(pen, smooth, a);
        break;
    case 'A':
        arc_to(pen, v, (FlPoint){o.x + v[5], o.y + v[6]});
        break;
    default:
        break;
    }
}

void fl_pen_step(void *data, char command, const double *v)
{
    FlPen *pen = data;
    const char upper = g_ascii_toupper(command);
    const FlPoint o = command == upper ? (FlPoint){0, 0} : pen->at;
    const FlPoint a = {o.x + v[0], o.y + v[1]}, b = {o.x + v[2], o.y + v[3]};
    switch (upper) {
    case 'M':
        fl_pen_move(pen, a);
        break;
    case 'L':
        fl_pen_line(pen, a);
        break;
    case 'H':
        fl_pen_line(pen, (FlPoint){a.x, pen->at.y});
        break;
    case 'V':
        fl_pen_line(pen, (FlPoint){pen->at.x, o.y + v[0]});
        break;
    case 'Z':
        fl_pen_close(pen);
        break;
    default:
        curve_step(pen, upper, v, o, a, b);
        break;
    }
    pen->last = upper;
}

void fl_pen_ellipse(FlPen *pen, double cx, double cy, double rx, double ry)
{
    static const FlPoint corner[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    const FlAffine m = {rx, 0, 0, ry, cx, cy};
    fl_pen_move(pen, (FlPoint){cx + rx, cy});
    for (int k = 0; k < 4; k++)
        quarter_to(pen, &m, corner[k], corner[(k + 1) % 4]);
    pen->at = pen->start;
    fl_pen_close(pen);
}

void fl_pen_rect(FlPen *pen, double x, double y, double w, double h, const double rx[4],
                 const double ry[4])
{
    static const FlPoint corner[4] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
    fl_pen_move(pen, (FlPoint){x + rx[0], y});
    for (int k = 0; k < 4; k++) {
        const int i = (k + 1) % 4; // from the top right on
        const double cx = k < 2 ? x + w - rx[i] : x + rx[i];
        const double cy = k % 3 ? y + h - ry[i] : y + ry[i];
        const FlAffine m = {rx[i], 0, 0, ry[i], cx, cy};
        fl_pen_line(pen, fl_affine_apply(&m, corner[k]));
        quarter_to(pen, &m, corner[k], corner[i]);
    }
    pen->at = pen->start;
    fl_pen_close(pen);
}

bool fl_pen_points(FlPen *pen, const char *points, bool closed)
{
    double v[2];
    int n = 0;
    const char *s = points;
    for (;; n++) {
        s += strspn(s, " \t\r\n\f,");
        if (!fl_number_read(&s, &v[n % 2]))
            break;
        if (n == 1)
            fl_pen_move(pen, (FlPoint){v[0], v[1]});
        else if (n % 2 == 1)
            fl_pen_line(pen, (FlPoint){v[0], v[1]});
    }
    if (closed)
        fl_pen_close(pen);
    return !*s;
}
