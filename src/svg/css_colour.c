#include "svg/css_colour.h"

#include "svg/css_value.h"
#include "svg/transform.h"
#include <math.h>
#include <pango/pango.h>
#include <string.h>

#define MOST_NESTED 8 // color-mix() in color-mix()

/** sRGB, not cut, and opacity; 0 … 1. */
typedef struct Rgba {
    double c[3], alpha;
} Rgba;

typedef double Matrix[3][3];

static void multiply(const Matrix m, const double in[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = m[i][0] * in[0] + m[i][1] * in[1] + m[i][2] * in[2];
}

static double encode(double linear)
{
    const double x = fabs(linear);
    return copysign(x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055, linear);
}

static double decode(double encoded)
{
    const double x = fabs(encoded);
    return copysign(x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4), encoded);
}

/* ---- spaces [CSS Color 4 §18] ---------------------------------------------------------------- */

/** CIE XYZ of D65 to linear sRGB. */
static const Matrix xyz_to_rgb = {{3.2409699419045213, -1.5373831775700935, -0.4986107602930033},
                                  {-0.9692436362808798, 1.8759675015077206, 0.0415550574071756},
                                  {0.0556300796969937, -0.2039769588889765, 1.0569715142428786}};

static const Matrix d50_to_d65 = {{0.9554734527042182, -0.0230985368742614, 0.0632593086610217},
                                  {-0.0283697069632081, 1.0099954580058226, 0.0210413989669430},
                                  {0.0123140016883199, -0.0205076964334771, 1.3303659366080753}};

static void from_xyz(const double xyz[3], double rgb[3])
{
    multiply(xyz_to_rgb, xyz, rgb);
    for (int i = 0; i < 3; i++)
        rgb[i] = encode(rgb[i]);
}

static void from_oklab(const double lab[3], double rgb[3])
{
    static const Matrix to_lms = {{1, 0.3963377773761749, 0.2158037573099136},
                                  {1, -0.1055613458156586, -0.0638541728258133},
                                  {1, -0.0894841775298119, -1.2914855480194092}};
    static const Matrix to_rgb = {{4.0767416613479942, -3.3077115904081933, 0.2309699287294279},
                                  {-1.2684380040921763, 2.6097574006633715, -0.3413193963102197},
                                  {-0.0041960865418371, -0.7034186144594493, 1.7076147009309444}};
    double lms[3], linear[3];
    multiply(to_lms, lab, lms);
    for (int i = 0; i < 3; i++)
        lms[i] = lms[i] * lms[i] * lms[i];
    multiply(to_rgb, lms, linear);
    for (int i = 0; i < 3; i++)
        rgb[i] = encode(linear[i]);
}

static void to_oklab(const double rgb[3], double lab[3])
{
    static const Matrix to_lms = {{0.4122214694707629, 0.5363325372617349, 0.0514459932675022},
                                  {0.2119034958178251, 0.6806995506452344, 0.1073969535369405},
                                  {0.0883024591900564, 0.2817188391361215, 0.6299787016738222}};
    static const Matrix to_lab = {{0.2104542683093140, 0.7936177747023054, -0.0040720430116193},
                                  {1.9779985324311684, -2.4285922420485799, 0.4505937096174110},
                                  {0.0259040424655478, 0.7827717124575296, -0.8086757549230774}};
    double linear[3], lms[3];
    for (int i = 0; i < 3; i++)
        linear[i] = decode(rgb[i]);
    multiply(to_lms, linear, lms);
    for (int i = 0; i < 3; i++)
        lms[i] = cbrt(lms[i]);
    multiply(to_lab, lms, lab);
}

static void from_lab(const double lab[3], double rgb[3])
{
    static const double white[3] = {0.9642956764295677, 1, 0.8251046025104602};
    const double fy = (lab[0] + 16) / 116, f[3] = {fy + lab[1] / 500, fy, fy - lab[2] / 200};
    double d50[3], d65[3];
    for (int i = 0; i < 3; i++) {
        const double cube = f[i] * f[i] * f[i];
        d50[i] = white[i] * (cube > 216.0 / 24389 ? cube : (116 * f[i] - 16) * 27 / 24389);
    }
    multiply(d50_to_d65, d50, d65);
    from_xyz(d65, rgb);
}

/** Lightness, chroma, hue in degrees to lightness and two opposing axes. */
static void from_polar(const double lch[3], double lab[3])
{
    double s, c;
    fl_sincos_degrees(lch[2], &s, &c);
    lab[0] = lch[0], lab[1] = lch[1] * c, lab[2] = lch[1] * s;
}

static void to_polar(const double lab[3], double lch[3])
{
    const double chroma = hypot(lab[1], lab[2]), hue = atan2(lab[2], lab[1]) * 180 / G_PI;
    lch[0] = lab[0], lch[1] = chroma, lch[2] = hue;
}

/** Hue in degrees, saturation and lightness 0 … 1. */
static void from_hsl(const double hsl[3], double rgb[3])
{
    const double a = hsl[1] * MIN(hsl[2], 1 - hsl[2]);
    for (int i = 0; i < 3; i++) {
        const double k = fmod(fmod((i == 0 ? 0 : i == 1 ? 8 : 4) + hsl[0] / 30, 12) + 12, 12);
        rgb[i] = hsl[2] - a * MAX(-1, MIN(MIN(k - 3, 9 - k), 1));
    }
}

/** To lightness, saturation and hue, in the order of other polar spaces; of the nearest levels that
 * sRGB has. */
static void to_hsl(const double wide[3], double lsh[3])
{
    const double rgb[3] = {CLAMP(wide[0], 0, 1), CLAMP(wide[1], 0, 1), CLAMP(wide[2], 0, 1)};
    const double high = MAX(rgb[0], MAX(rgb[1], rgb[2])), low = MIN(rgb[0], MIN(rgb[1], rgb[2]));
    const double d = high - low, l = (high + low) / 2;
    const double hue = d <= 0           ? 0
                       : high == rgb[0] ? (rgb[1] - rgb[2]) / d
                       : high == rgb[1] ? (rgb[2] - rgb[0]) / d + 2
                                        : (rgb[0] - rgb[1]) / d + 4;
    lsh[0] = l, lsh[1] = d > 0 ? d / (1 - fabs(2 * l - 1)) : 0, lsh[2] = 60 * hue;
}

static void from_hwb(const double hwb[3], double rgb[3])
{
    const double sum = hwb[1] + hwb[2], pure[3] = {hwb[0], 1, 0.5};
    from_hsl(pure, rgb);
    for (int i = 0; i < 3; i++)
        rgb[i] = sum >= 1 ? hwb[1] / sum : rgb[i] * (1 - sum) + hwb[1];
}

/** A space of color(); false if it is unknown. */
static bool from_space(const char *name, const double v[3], double rgb[3])
{
    static const Matrix p3 = {{0.4865709486482162, 0.2656676931690931, 0.1982172852343625},
                              {0.2289745640697488, 0.6917385218365064, 0.0792869140937450},
                              {0, 0.0451133818589026, 1.0439443689009760}};
    static const Matrix adobe = {{0.5766690429101305, 0.1855582379065463, 0.1882286462349947},
                                 {0.2973449752505360, 0.6273635662554661, 0.0752914584939978},
                                 {0.0270313613864123, 0.0706888525358272, 0.9913375368376388}};
    static const Matrix rec2020 = {{0.6369580483012914, 0.1446169035862083, 0.1688809751641721},
                                   {0.2627002120112671, 0.6779980715188708, 0.0593017164698620},
                                   {0, 0.0280726930490874, 1.0609850577107910}};
    static const Matrix prophoto = {{0.7977666449006423, 0.1351812974005331, 0.0313477341283922},
                                    {0.2880748288194013, 0.7118352342418731, 0.0000899369387256},
                                    {0, 0, 0.8251046025104602}};
    double linear[3], xyz[3], d65[3];
    for (int i = 0; i < 3; i++)
        linear[i] = decode(v[i]);
    if (strcmp(name, "srgb") == 0) {
        memcpy(rgb, v, 3 * sizeof *v);
        return true;
    }
    if (strcmp(name, "srgb-linear") == 0) {
        for (int i = 0; i < 3; i++)
            rgb[i] = encode(v[i]);
        return true;
    }
    const double gamma = strcmp(name, "a98-rgb") == 0        ? 563.0 / 256
                         : strcmp(name, "prophoto-rgb") == 0 ? 1.8
                                                             : 0;
    for (int i = 0; i < 3 && gamma > 0; i++)
        linear[i] = copysign(pow(fabs(v[i]), gamma), v[i]);
    if (strcmp(name, "display-p3") == 0)
        multiply(p3, linear, xyz);
    else if (strcmp(name, "a98-rgb") == 0)
        multiply(adobe, linear, xyz);
    else if (strcmp(name, "rec2020") == 0)
        multiply(rec2020, linear, xyz);
    else if (strcmp(name, "prophoto-rgb") == 0) {
        multiply(prophoto, linear, d65);
        multiply(d50_to_d65, d65, xyz);
    } else if (strcmp(name, "xyz-d50") == 0)
        multiply(d50_to_d65, v, xyz);
    else if (strcmp(name, "xyz") == 0 || strcmp(name, "xyz-d65") == 0)
        memcpy(xyz, v, sizeof xyz);
    else
        return false;
    from_xyz(xyz, rgb);
    return true;
}

/* ---- reading --------------------------------------------------------------------------------- */

static bool read_colour(const char *text, Rgba *colour, int depth);

/** Reads a component: a number, a percentage of `whole`, an angle, or none. */
static bool read_component(const char *text, double whole, double *value)
{
    const FlCssUnits none = {0};
    *value = 0;
    return g_ascii_strcasecmp(text, "none") == 0 || fl_css_number(text, &none, whole, value);
}

/** Splits "a b c / alpha" or "a, b, c, alpha". Returns: the components; *alpha is 1 without one. */
static char **components(const char *arguments, double *alpha)
{
    const char *slash = fl_css_find(arguments, "/");
    g_autofree char *before = g_strndup(arguments, (gsize)(slash - arguments));
    const bool commas = *fl_css_find(before, ",") == ',';
    char **part = fl_css_split(before, commas ? ',' : ' ');
    g_autofree char *after = *slash ? g_strstrip(g_strdup(slash + 1)) : NULL;
    const char *text = after ? after : commas && g_strv_length(part) == 4 ? part[3] : NULL;
    *alpha = 1;
    if (text && !read_component(text, 1, alpha)) {
        g_strfreev(part);
        return NULL;
    }
    *alpha = CLAMP(*alpha, 0, 1);
    return part;
}

/** One of the functions whose components are three numbers; false if it is another one. */
static bool from_function(const char *name, char **part, Rgba *colour)
{
    static const struct {
        const char *name;
        double whole[3];
    } known[] = {{"rgb", {255, 255, 255}},  {"rgba", {255, 255, 255}}, {"hsl", {360, 100, 100}},
                 {"hsla", {360, 100, 100}}, {"hwb", {360, 100, 100}},  {"lab", {100, 125, 125}},
                 {"lch", {100, 150, 360}},  {"oklab", {1, 0.4, 0.4}},  {"oklch", {1, 0.4, 360}}};
    double v[3], lab[3];
    size_t k = 0;
    while (k < G_N_ELEMENTS(known) && strcmp(known[k].name, name) != 0)
        k++;
    if (k == G_N_ELEMENTS(known) || g_strv_length(part) < 3)
        return false;
    for (int i = 0; i < 3; i++)
        if (!read_component(part[i], known[k].whole[i], &v[i]))
            return false;
    if (name[0] == 'r')
        for (int i = 0; i < 3; i++)
            colour->c[i] = v[i] / 255;
    else if (name[0] == 'h') {
        const double h[3] = {v[0], CLAMP(v[1] / 100, 0, 1), CLAMP(v[2] / 100, 0, 1)};
        (name[1] == 's' ? from_hsl : from_hwb)(h, colour->c);
    } else {
        const bool polar = g_str_has_suffix(name, "ch");
        if (polar)
            from_polar(v, lab);
        (name[0] == 'o' ? from_oklab : from_lab)(polar ? lab : v, colour->c);
    }
    return true;
}

/** The components of a colour in the space of a function, named by its letters; false if it takes
 * no colour to begin with. */
static bool to_function(const char *name, const Rgba *from, double v[3])
{
    double lab[3];
    if (strcmp(name, "rgb") == 0)
        for (int i = 0; i < 3; i++)
            v[i] = from->c[i] * 255;
    else if (strcmp(name, "hsl") == 0) {
        to_hsl(from->c, lab);
        v[0] = lab[2], v[1] = lab[1] * 100, v[2] = lab[0] * 100;
    } else if (strcmp(name, "oklab") == 0 || strcmp(name, "oklch") == 0) {
        to_oklab(from->c, lab);
        name[3] == 'c' ? to_polar(lab, v) : (void)memcpy(v, lab, sizeof lab);
    } else
        return false;
    return true;
}

/** Writes the numbers of another colour for their names: "from red calc(r / 2) g b" is
 * "calc(255 / 2) 0 0 / 1". Returns: NULL if that cannot be done; to be freed. */
static char *without_origin(const char *name, const char *arguments, int depth)
{
    g_auto(GStrv) part = fl_css_split(arguments, ' ');
    Rgba from;
    double v[4];
    if (g_strv_length(part) < 3 || !read_colour(part[1], &from, depth + 1) ||
        !to_function(name, &from, v))
        return NULL;
    const char *letters = name + strlen(name) - 3;
    g_autofree char *rest = g_strjoinv(" ", part + 2);
    GString *out = g_string_new(NULL);
    v[3] = from.alpha;
    for (const char *s = rest; *s;) {
        const size_t n = MAX(fl_css_identifier(s), 1);
        const char *letter = n == 1 ? strchr(letters, *s) : NULL;
        const bool alpha = n == 5 && g_str_has_prefix(s, "alpha");
        g_autofree char *number =
            letter || alpha ? fl_css_number_text(v[letter ? letter - letters : 3]) : NULL;
        g_string_append_len(out, number ? number : s, number ? -1 : (gssize)n);
        s += n;
    }
    g_autofree char *alpha = fl_css_number_text(from.alpha);
    if (!strchr(rest, '/'))
        g_string_append_printf(out, " / %s", alpha);
    return g_string_free(out, FALSE);
}

static bool from_color(char **part, Rgba *colour)
{
    double v[3] = {0};
    if (g_strv_length(part) != 4)
        return false;
    for (int i = 0; i < 3; i++)
        if (!read_component(part[i + 1], 1, &v[i]))
            return false;
    g_autofree char *space = g_ascii_strdown(part[0], -1);
    return from_space(space, v, colour->c);
}

/** Reads "red 30%" of color-mix(); *share stays as it is without a percentage. */
static bool read_share(const char *text, Rgba *colour, double *share, int depth)
{
    g_auto(GStrv) part = fl_css_split(text, ' ');
    const guint n = g_strv_length(part);
    if (n < 1 || n > 2)
        return false;
    const bool leads = n == 2 && g_str_has_suffix(part[0], "%");
    if (n == 2 && !read_component(part[leads ? 0 : 1], 1, share))
        return false;
    return read_colour(part[leads ? 1 : 0], colour, depth + 1);
}

/** What color-mix() mixes in; Oklab stands for Lab and XYZ, and its polar form for LCH. */
typedef struct MixSpace {
    bool oklab, polar, linear;
} MixSpace;

/** The components of a colour; a polar one has its hue last. */
static void enter_space(MixSpace space, const double rgb[3], double v[3])
{
    double lab[3];
    for (int i = 0; i < 3; i++)
        v[i] = space.linear ? decode(rgb[i]) : rgb[i];
    if (space.oklab)
        to_oklab(rgb, space.polar ? lab : v);
    else if (space.polar)
        to_hsl(rgb, v);
    if (space.oklab && space.polar)
        to_polar(lab, v);
}

static void leave_space(MixSpace space, const double v[3], double rgb[3])
{
    double lab[3] = {v[0], v[1], v[2]};
    if (space.oklab && space.polar)
        from_polar(v, lab);
    for (int i = 0; i < 3; i++)
        rgb[i] = space.linear ? encode(v[i]) : v[i];
    if (space.oklab)
        from_oklab(lab, rgb);
    else if (space.polar)
        from_hsl((const double[]){v[2], v[1], v[0]}, rgb);
}

/** The hue to mix with the first one, on the arc that is named. */
static double hue_on_arc(const char *method, double first, double second)
{
    const double way = fmod(fmod(second - first, 360) + 360, 360); // increasing
    const bool increasing =
        strstr(method, "increasing") ||
        (!strstr(method, "decreasing") && (way <= 180) == !strstr(method, "longer"));
    return first + (increasing ? way : way - 360);
}

/** A mix of colours without chroma has the hue of the other one. */
static void fix_hues(const char *method, double p[3], double q[3])
{
    const double grey = 1e-4;
    if (p[1] < grey)
        p[2] = q[2];
    else
        q[2] = q[1] < grey ? p[2] : hue_on_arc(method, p[2], q[2]);
}

static bool from_mix(const char *arguments, Rgba *colour, int depth)
{
    g_auto(GStrv) part = fl_css_split(arguments, ',');
    Rgba one, two;
    double a = -1, b = -1, p[3], q[3];
    if (g_strv_length(part) != 3 || !g_str_has_prefix(part[0], "in ") ||
        !read_share(part[1], &one, &a, depth) || !read_share(part[2], &two, &b, depth))
        return false;
    a = a < 0 ? (b < 0 ? 0.5 : 1 - b) : a, b = b < 0 ? 1 - a : b;
    if (!(a + b > 0))
        return false;
    const char *name = part[0] + 3;
    const bool hsl = g_str_has_prefix(name, "hsl") || g_str_has_prefix(name, "hwb");
    const bool lch = g_str_has_prefix(name, "lch") || g_str_has_prefix(name, "oklch");
    const MixSpace space = {.oklab = !hsl && !g_str_has_prefix(name, "srgb"),
                            .polar = hsl || lch,
                            .linear = g_str_has_prefix(name, "srgb-linear")};
    const double total = a + b, wa = a / total * one.alpha, wb = b / total * two.alpha;
    const double alpha = wa + wb;
    enter_space(space, one.c, p), enter_space(space, two.c, q);
    if (space.polar)
        fix_hues(name, p, q);
    for (int i = 0; i < 3; i++) {
        const bool hue = space.polar && i == 2; // not multiplied by opacity
        p[i] = hue         ? (p[i] * a + q[i] * b) / total
               : alpha > 0 ? (p[i] * wa + q[i] * wb) / alpha
                           : 0;
    }
    leave_space(space, p, colour->c);
    colour->alpha = alpha * MIN(total, 1);
    return true;
}

static bool from_hex(const char *text, Rgba *colour)
{
    const size_t n = strlen(text);
    if ((n != 3 && n != 4 && n != 6 && n != 8) || strspn(text, "0123456789abcdefABCDEF") != n)
        return false;
    const size_t digits = n > 4 ? 2 : 1;
    double v[4] = {0, 0, 0, 1};
    for (size_t i = 0; i < n / digits; i++) {
        const int high = g_ascii_xdigit_value(text[i * digits]);
        const int low = g_ascii_xdigit_value(text[i * digits + digits - 1]);
        v[i] = (high * 16 + low) / 255.0;
    }
    *colour = (Rgba){{v[0], v[1], v[2]}, v[3]};
    return true;
}

/** Reads a name, also of a colour that the system has in a light scheme. */
static bool from_name(const char *text, Rgba *colour)
{
    static const struct {
        const char *name, *hex;
    } of_system[] = {
        {"canvas", "ffffff"},       {"canvastext", "000000"},       {"linktext", "0000ee"},
        {"visitedtext", "551a8b"},  {"activetext", "ff0000"},       {"buttonface", "f0f0f0"},
        {"buttontext", "000000"},   {"buttonborder", "000000"},     {"field", "ffffff"},
        {"fieldtext", "000000"},    {"highlight", "b5d5ff"},        {"highlighttext", "000000"},
        {"selecteditem", "0078d7"}, {"selecteditemtext", "ffffff"}, {"mark", "ffff00"},
        {"marktext", "000000"},     {"graytext", "808080"}};
    g_autofree char *lower = g_ascii_strdown(text, -1);
    PangoColor named;
    for (size_t i = 0; i < G_N_ELEMENTS(of_system); i++)
        if (strcmp(lower, of_system[i].name) == 0)
            return from_hex(of_system[i].hex, colour);
    if (lower[strspn(lower, G_CSET_a_2_z)] ||
        fl_css_has_word("lightgoldenrod lightslateblue navyblue violetred", lower) ||
        !pango_color_parse(&named, lower))
        return false;
    *colour = (Rgba){{named.red / 65535.0, named.green / 65535.0, named.blue / 65535.0}, 1};
    return true;
}

static bool read_colour(const char *text, Rgba *colour, int depth)
{
    g_autofree char *name = NULL, *arguments = NULL;
    colour->alpha = 1;
    if (depth > MOST_NESTED)
        return false;
    if (*text == '#')
        return from_hex(text + 1, colour);
    if (g_ascii_strcasecmp(text, "transparent") == 0) {
        *colour = (Rgba){{0}, 0};
        return true;
    }
    if (!fl_css_call(text, &name, &arguments))
        return from_name(text, colour);
    if (strcmp(name, "color-mix") == 0)
        return from_mix(arguments, colour, depth);
    g_auto(GStrv) schemes = strcmp(name, "light-dark") == 0 ? fl_css_split(arguments, ',') : NULL;
    if (schemes)
        return schemes[0] && read_colour(schemes[0], colour, depth + 1);
    const bool relative = g_str_has_prefix(arguments, "from ");
    g_autofree char *numbers = relative ? without_origin(name, arguments, depth) : NULL;
    if (relative && !numbers)
        return false;
    g_auto(GStrv) part = components(relative ? numbers : arguments, &colour->alpha);
    return part && (strcmp(name, "color") == 0 ? from_color(part, colour)
                                               : from_function(name, part, colour));
}

static uint8_t level_of(double share)
{
    return (uint8_t)floor(255 * fmin(fmax(share, 0), 1) + 0.5); // NAN: 0
}

static char *text_of(const Rgba *colour)
{
    int v[3];
    for (int i = 0; i < 3; i++)
        v[i] = level_of(colour->c[i]);
    if (colour->alpha >= 1)
        return g_strdup_printf("rgb(%d, %d, %d)", v[0], v[1], v[2]);
    g_autofree char *alpha = fl_css_number_text(colour->alpha);
    return g_strdup_printf("rgba(%d, %d, %d, %s)", v[0], v[1], v[2], alpha);
}

bool fl_css_rgba(const char *text, uint8_t rgba[4])
{
    Rgba colour;
    if (!read_colour(text, &colour, 0))
        return false;
    for (int i = 0; i < 4; i++)
        rgba[i] = level_of(i < 3 ? colour.c[i] : colour.alpha);
    return true;
}

char *fl_css_colour(const char *text)
{
    g_autofree char *bare = g_strstrip(g_strdup(text));
    g_autofree char *lower = g_ascii_strdown(bare, -1);
    Rgba colour;
    if (fl_css_has_word("none currentcolor transparent context-fill context-stroke", lower))
        return g_strdup(strcmp(lower, "currentcolor") == 0 ? bare : lower);
    if (g_str_has_prefix(lower, "url(")) {
        const char *end = fl_css_find(bare + 4, ")");
        const char *rest = *end ? fl_css_space(end + 1) : end;
        g_autofree char *fallback = *rest ? fl_css_colour(rest) : NULL;
        return *rest && !fallback ? NULL
                                  : g_strdup_printf("%.*s)%s%s", (int)(end - bare), bare,
                                                    fallback ? " " : "", fallback ? fallback : "");
    }
    if (!read_colour(bare, &colour, 0))
        return NULL;
    return *bare == '#' ? g_steal_pointer(&bare) : text_of(&colour);
}

char *fl_css_colour_with(const char *text, const char *current)
{
    static const char word[] = "currentcolor";
    g_autoptr(GString) out = g_string_new(NULL);
    if (!strchr(text, '(') || !strpbrk(text, "cC"))
        current = NULL;
    for (; current && *text; text++)
        if (g_ascii_strncasecmp(text, word, sizeof word - 1) == 0) {
            g_string_append(out, current);
            text += sizeof word - 2;
        } else
            g_string_append_c(out, *text);
    return fl_css_colour(current ? out->str : text);
}

char *fl_css_colour_in_linear_light(const char *text)
{
    Rgba colour;
    if (!read_colour(text, &colour, 0))
        return NULL;
    for (int i = 0; i < 3; i++)
        colour.c[i] = decode(colour.c[i]);
    return text_of(&colour);
}
