#include "svg/interpolate.h"

#include "svg/css_colour.h"
#include "svg/path_data.h"
#include "svg/transform.h"
#include <math.h>
#include <string.h>

/* ---- easing ---------------------------------------------------------------------------------- */

static double bezier(double a, double b, double t)
{
    const double u = 1 - t;
    return 3 * u * u * t * a + 3 * u * t * t * b + t * t * t;
}

double fl_ease(const double control[4], double x)
{
    double low = 0, high = 1;
    for (int k = 0; k < 40; k++) { // x grows with t
        const double middle = (low + high) / 2;
        if (bezier(control[0], control[2], middle) < x)
            low = middle;
        else
            high = middle;
    }
    return x <= 0 ? 0 : x >= 1 ? 1 : bezier(control[1], control[3], (low + high) / 2);
}

/** steps(n, position) [CSS Easing 1 §2.3]. */
static double ease_in_steps(const char *arguments, double x)
{
    g_auto(GStrv) part = fl_css_split(arguments, ',');
    const char *position = part[0] && part[1] ? part[1] : "end";
    const bool none = strcmp(position, "jump-none") == 0, both = strcmp(position, "jump-both") == 0;
    const bool start =
        strcmp(position, "start") == 0 || strcmp(position, "jump-start") == 0 || both;
    const int n = part[0] ? MAX((int)g_ascii_strtoll(part[0], NULL, 10), 1) : 1;
    const int jumps = n + both - none;
    const double step = floor(x * n + 1e-9) + start;
    return jumps > 0 ? CLAMP(step, 0, jumps) / jumps : x;
}

/** The points of linear(0, .5 20% 60%, 1), FlPoint [CSS Easing 2 §2.1]; x is NAN where none is
 * said.
 */
static GArray *points_of(const char *arguments)
{
    GArray *points = g_array_new(FALSE, FALSE, sizeof(FlPoint));
    g_auto(GStrv) stop = fl_css_split(arguments, ',');
    for (int i = 0; stop[i]; i++) {
        g_auto(GStrv) word = fl_css_split(stop[i], ' ');
        const bool said = word[0] && word[1], end = i == 0 || !stop[i + 1];
        FlPoint p = {end ? i > 0 : NAN, word[0] ? g_ascii_strtod(word[0], NULL) : 0};
        for (int k = 1; said && word[k]; k++) {
            p.x = g_ascii_strtod(word[k], NULL) / 100;
            g_array_append_val(points, p);
        }
        if (!said)
            g_array_append_val(points, p);
    }
    return points;
}

/** Spreads the points whose x is not said between those on both sides. */
static void spread(GArray *points)
{
    FlPoint *p = (FlPoint *)points->data;
    for (guint i = 1, last = 0; i < points->len; i++) {
        if (isnan(p[i].x))
            continue;
        p[i].x = fmax(p[i].x, p[last].x);
        for (guint k = last + 1; k < i; k++)
            p[k].x = p[last].x + (p[i].x - p[last].x) * (k - last) / (i - last);
        last = i;
    }
}

static double ease_by_list(const char *arguments, double x)
{
    g_autoptr(GArray) points = points_of(arguments);
    const FlPoint *p = (const FlPoint *)points->data;
    guint i = 1;
    spread(points);
    while (i + 1 < points->len && x >= p[i].x)
        i++;
    if (points->len < 2)
        return points->len ? p[0].y : x;
    const double length = p[i].x - p[i - 1].x;
    return length > 0 ? p[i - 1].y + (p[i].y - p[i - 1].y) * (x - p[i - 1].x) / length : p[i].y;
}

double fl_css_ease(const char *function, double x)
{
    static const struct {
        const char *name;
        double control[4];
    } known[] = {{"ease", {.25, .1, .25, 1}},
                 {"ease-in", {.42, 0, 1, 1}},
                 {"ease-out", {0, 0, .58, 1}},
                 {"ease-in-out", {.42, 0, .58, 1}},
                 {"linear", {0, 0, 1, 1}}};
    g_autofree char *name = NULL, *arguments = NULL;
    double c[4];
    for (size_t i = 0; i < G_N_ELEMENTS(known); i++)
        if (strcmp(known[i].name, function) == 0)
            return strcmp(function, "linear") == 0 ? x : fl_ease(known[i].control, x);
    if (strcmp(function, "step-start") == 0 || strcmp(function, "step-end") == 0)
        return ease_in_steps(strcmp(function, "step-start") == 0 ? "1, start" : "1", x);
    if (!fl_css_call(function, &name, &arguments))
        return x;
    if (strcmp(name, "steps") == 0)
        return ease_in_steps(arguments, x);
    if (strcmp(name, "linear") == 0)
        return ease_by_list(arguments, x);
    g_auto(GStrv) part = fl_css_split(arguments, ',');
    if (strcmp(name, "cubic-bezier") != 0 || g_strv_length(part) != 4)
        return x;
    for (int i = 0; i < 4; i++)
        c[i] = g_ascii_strtod(part[i], NULL);
    return fl_ease(c, x);
}

/* ---- texts with numbers ---------------------------------------------------------------------- */

/** The length of the number at the start of `s`; 0 without a number. Digits inside names do not
 * count. */
static size_t number_length(const char *s, const char *begin)
{
    const char *end = s;
    double ignored;
    if (s > begin && (g_ascii_isalpha(s[-1]) || strchr("-_#", s[-1])))
        return 0;
    return fl_number_read(&end, &ignored) ? (size_t)(end - s) : 0;
}

/** The length of a unit behind a number. */
static size_t unit_length(const char *s)
{
    return *s == '%' ? 1 : strspn(s, "abcdefghijklmnopqrstuvwxyz");
}

/** Skips separators of numbers, which may differ: "1,2" and "1 2". */
static const char *skip_separators(const char *s)
{
    return s + strspn(s, FL_CSS_SPACE ",");
}

/**
 * Walks two texts that differ in numbers. Returns: a * wa + b * wb number by number, NULL if more
 * differs. *distance: of the numbers.
 */
static char *combine(const char *a, const char *b, double wa, double wb, double *distance)
{
    char *path = fl_path_data_combine(a, b, wa, wb);
    *distance = 1;
    if (path)
        return path;
    GString *out = g_string_new(NULL);
    const char *pa = a, *pb = b;
    double sum = 0;
    bool same = true;
    for (pa = skip_separators(pa), pb = skip_separators(pb); same && *pa && *pb;) {
        const size_t na = number_length(pa, a), nb = number_length(pb, b);
        if (na > 0 && nb > 0) {
            const double va = g_ascii_strtod(pa, NULL), vb = g_ascii_strtod(pb, NULL);
            const size_t ua = unit_length(pa + na), ub = unit_length(pb + nb);
            g_autofree char *text = fl_css_number_text(wa * va + wb * vb);
            g_string_append_printf(
                out, "%s%s", out->len && g_ascii_isdigit(out->str[out->len - 1]) ? " " : "", text);
            sum += (vb - va) * (vb - va);
            pa += na, pb += nb;
            const bool only_a = ua > 0 && ub == 0 && vb == 0, only_b = ub > 0 && ua == 0 && va == 0;
            if (only_a || only_b) { // 0 has any unit
                g_string_append_len(out, only_a ? pa : pb, (gssize)(only_a ? ua : ub));
                pa += ua, pb += ub;
            }
        } else {
            same = na == 0 && nb == 0 && *pa == *pb;
            g_string_append_c(out, *pa);
            pa++, pb++;
        }
        const char *next_a = skip_separators(pa), *next_b = skip_separators(pb);
        if (next_a != pa || next_b != pb)
            g_string_append_c(out, memchr(pa, ',', (size_t)(next_a - pa)) ? ',' : ' ');
        pa = next_a, pb = next_b;
    }
    *distance = sqrt(sum);
    same = same && !*pa && !*pb;
    return g_string_free(out, !same);
}

/** The components of a colour, 0 … 255, and its opacity; false for another paint. */
static bool colour_parts(const char *text, double v[4])
{
    uint8_t rgba[4];
    if (!fl_css_rgba(text, rgba))
        return false;
    for (int i = 0; i < 4; i++)
        v[i] = i < 3 ? rgba[i] : rgba[i] / 255.0;
    return true;
}

/** Between colours, weighted by their opacity. */
static char *mix_colours(const double a[4], const double b[4], double p)
{
    double v[3];
    const double alpha = CLAMP(a[3] + (b[3] - a[3]) * p, 0, 1);
    for (int i = 0; i < 3; i++) {
        const double sum = a[i] * a[3] * (1 - p) + b[i] * b[3] * p;
        v[i] = CLAMP(alpha > 0 ? sum / alpha : 0, 0, 255);
    }
    g_autofree char *text = fl_css_number_text(alpha);
    return g_strdup_printf("rgba(%d, %d, %d, %s)", (int)(v[0] + .5), (int)(v[1] + .5),
                           (int)(v[2] + .5), text);
}

/** Returns: true if a text is one number of those kinds, or calc() of such. */
static bool measures(const char *text, int kinds)
{
    const FlCssUnits any = {1, 1, 1, 1, 1, 1};
    double value;
    return fl_css_amount(text, kinds, &any, 1, &value);
}

/** The factor by which a number without unit can be added to `other`. */
static const char *unit_beside(const char *number, const char *other)
{
    return !measures(number, FL_CSS_PLAIN) || measures(other, FL_CSS_PLAIN | FL_CSS_SHARE) ? ""
           : measures(other, FL_CSS_SIZE) ? " * 1px"
                                          : " * 1deg";
}

/** Returns: true for a colour that mixes in Oklab [CSS Color 4 §12.1]. */
static bool is_modern(const char *colour)
{
    return strchr(colour, '(') && !g_str_has_prefix(colour, "rgb") &&
           !g_str_has_prefix(colour, "hsl") && !g_str_has_prefix(colour, "hwb");
}

/** The sum of two texts, number by number, or of lengths in different units; NULL: neither. */
static char *weighted_sum(const char *a, const char *b, double p, double q)
{
    double distance;
    char *text = combine(a, b, p, q, &distance);
    if (text || !measures(a, ~0) || !measures(b, ~0))
        return text;
    g_autofree char *wa = fl_css_number_text(p), *wb = fl_css_number_text(q);
    return g_strdup_printf("calc((%s) * %s%s + (%s) * %s%s)", a, wa, unit_beside(a, b), b, wb,
                           unit_beside(b, a));
}

char *fl_interpolate(const char *a, const char *b, double p)
{
    double ca[4], cb[4];
    if (is_modern(a) || is_modern(b)) {
        g_autofree char *share = fl_css_number_text(CLAMP(p, 0, 1) * 100);
        g_autofree char *mix = g_strdup_printf("color-mix(in oklab, %s, %s %s%%)", a, b, share);
        char *colour = fl_css_colour(mix);
        if (colour)
            return colour;
    }
    if (colour_parts(a, ca) && colour_parts(b, cb))
        return mix_colours(ca, cb, p);
    return weighted_sum(a, b, 1 - p, p);
}

char *fl_add_values(const char *a, const char *b, double n)
{
    double ca[4], cb[4];
    if (colour_parts(a, ca) && colour_parts(b, cb)) {
        for (int i = 0; i < 3; i++)
            ca[i] = CLAMP(ca[i] + n * cb[i], 0, 255);
        return mix_colours(ca, ca, 0);
    }
    return weighted_sum(a, b, 1, n);
}

double fl_value_distance(const char *a, const char *b)
{
    double ca[4], cb[4], distance = 0;
    if (colour_parts(a, ca) && colour_parts(b, cb)) {
        for (int i = 0; i < 3; i++)
            distance += (cb[i] - ca[i]) * (cb[i] - ca[i]);
        return sqrt(distance);
    }
    g_autofree char *text = combine(a, b, 1, 0, &distance);
    return text ? distance : 1;
}

/* ---- lists ----------------------------------------------------------------------------------- */

/** The i-th word of a function or property `kind` with n words, to be freed; of one that is
 * missing, a word that changes nothing in place of the other one. */
static char *word_at(const char *kind, char **own, guint n, char **others, guint i)
{
    const char *other = n <= i ? others[i] : NULL;
    double number;
    if (n > i || (n == 1 && strcmp(kind, "scale") == 0)) // scale(x) is scale(x, x)
        return g_strdup(own[MIN(i, n - 1)]);
    if (strcmp(kind, "drop-shadow") == 0 && !fl_number_read(&other, &number))
        return g_strdup("transparent");
    return g_strdup(fl_css_has_word("brightness contrast opacity saturate scale", kind) ||
                            g_str_has_prefix(kind, "scale")
                        ? "1"
                        : "0");
}

/** Appends the words between two lists. Returns: false if any have no value between them. */
static bool mix_words(GString *out, const char *kind, char **a, char **b, double p,
                      const char *separator)
{
    const guint na = g_strv_length(a), nb = g_strv_length(b);
    bool mixed = true;
    for (guint i = 0; i < MAX(na, nb) && mixed; i++) {
        g_autofree char *x = word_at(kind, a, na, b, i), *y = word_at(kind, b, nb, a, i);
        g_autofree char *word = fl_interpolate(x, y, p);
        mixed = word != NULL;
        g_string_append_printf(out, "%s%s", i ? separator : "", mixed ? word : "");
    }
    return mixed;
}

char *fl_interpolate_words(const char *property, const char *a, const char *b, double p)
{
    g_auto(GStrv) x = fl_css_split(strcmp(a, "none") == 0 ? "" : a, ' ');
    g_auto(GStrv) y = fl_css_split(strcmp(b, "none") == 0 ? "" : b, ' ');
    GString *out = g_string_new(NULL);
    const bool mixed = mix_words(out, property, x, y, p, " ");
    return g_string_free(out, !mixed || out->len == 0);
}

/** Cuts the function at *s off a list; the end of the list is a function without a name. Returns:
 * false if something else is there. */
static bool take_function(const char **s, char separator, char **name, char ***words)
{
    const char *open = *s + fl_css_identifier(*s);
    const char *close = *open == '(' ? fl_css_find(open + 1, ")") : open;
    const bool end = !**s || strcmp(*s, "none") == 0;
    const bool whole = open > *s && close > open && *close == ')';
    g_autofree char *inside = g_strndup(open + 1, whole ? (gsize)(close - open) - 1 : 0);
    *name = g_ascii_strdown(*s, end ? 0 : open - *s);
    *words = fl_css_split(inside, separator);
    *s = end ? *s + strlen(*s) : fl_css_space(*close ? close + 1 : close);
    return end || whole;
}

char *fl_interpolate_functions(const char *a, const char *b, double p, char separator)
{
    const char *s = fl_css_space(a), *t = fl_css_space(b);
    GString *out = g_string_new(NULL);
    bool mixed = true;
    while (mixed && (*s || *t)) {
        g_autofree char *name = NULL, *other = NULL;
        g_auto(GStrv) x = NULL, y = NULL;
        mixed = take_function(&s, separator, &name, &x) && take_function(&t, separator, &other, &y);
        const char *kind = *name ? name : other;
        g_string_append_printf(out, "%s%s(", out->len ? " " : "", kind);
        mixed = mixed && (!*name || !*other || strcmp(name, other) == 0) &&
                !g_str_has_prefix(kind, "matrix") &&
                mix_words(out, kind, x, y, p, separator == ',' ? ", " : " ");
        g_string_append_c(out, ')');
    }
    mixed = mixed && out->len > 2; // not "none" twice
    return g_string_free(out, !mixed);
}

/* ---- transforms ------------------------------------------------------------------------------ */

/** A transform in the plane, taken apart: translation, turn, scale and skew. */
typedef struct Parts {
    double x, y, turn, sx, sy, skew;
} Parts;

static bool take_apart(FlAffine m, Parts *parts)
{
    const double sx = hypot(m.xx, m.yx), determinant = m.xx * m.yy - m.xy * m.yx;
    if (!(sx > 0) || determinant == 0)
        return false;
    const double c = m.xx / sx, s = m.yx / sx;
    *parts = (Parts){m.x0, m.y0, atan2(s, c), sx, determinant / sx, (c * m.xy + s * m.yy) / sx};
    return true;
}

static FlAffine put_together(const Parts *p)
{
    const FlAffine turn = fl_affine_rotation(p->turn * 180 / G_PI);
    const FlAffine shape = {p->sx, 0, p->sx * p->skew, p->sy, 0, 0};
    FlAffine m = fl_affine_multiply(turn, shape);
    m.x0 = p->x, m.y0 = p->y;
    return m;
}

static char *mix_matrices(const char *a, const char *b, double p, const FlCssUnits *units)
{
    FlAffine ma, mb;
    Parts x, y;
    if (!fl_affine_parse_css(a, units, &ma, NULL) || !fl_affine_parse_css(b, units, &mb, NULL))
        return NULL;
    if (!take_apart(ma, &x) || !take_apart(mb, &y))
        return g_strdup(p < .5 ? a : b);
    double turn = y.turn - x.turn; // the shorter way; half a turn as it is
    if (fabs(turn) > G_PI + 1e-9)
        turn -= copysign(2 * G_PI, turn);
    const Parts between = {x.x + (y.x - x.x) * p,    x.y + (y.y - x.y) * p,
                           x.turn + turn * p,        x.sx + (y.sx - x.sx) * p,
                           x.sy + (y.sy - x.sy) * p, x.skew + (y.skew - x.skew) * p};
    const FlAffine m = put_together(&between);
    return fl_affine_text(&m);
}

char *fl_interpolate_transform(const char *a, const char *b, double p, const FlCssUnits *units)
{
    char *list = fl_interpolate_functions(a, b, p, ',');
    return list ? list : mix_matrices(a, b, p, units);
}
