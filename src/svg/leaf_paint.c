#include "svg/leaf_paint.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/*
 * The commands come one a line, the operator last: "0.8 0.1 0.3 rgb set-source", "fill+". A group
 * with opacity or a mask is drawn on a surface "sN" of its own, which is then the source of a
 * "paint" or "0.5 a mask"; a pattern's tile is such a surface that repeats. A new surface starts
 * with black, which is not written.
 */
typedef struct Source {
    FlPaintKind kind;
    double rgba[4];
    double peak;      // most opaque stop
    char surface[16]; // name of the surface that is the source; "" for others
    bool repeats;
    GString *key;
} Source;

typedef struct Op {
    bool stroke;
    FlBlendMode blend_mode;
    double alpha; // of the groups around
    double width; // of a stroke, px; else 0
    Source source;
    char surface[16]; // the surface that it is drawn on
} Op;

typedef struct Context {
    char surface[16];
    Source source;
    FlBlendMode blend_mode;
    double line_width, scale; // of the pen
} Context;

typedef struct Reader {
    GArray *ops, *contexts;
    Source next;        // pattern that is being described
    double stop_offset; // of the last gradient stop; the sum up to that stop
    double stop_rgba[4];
    double sum[4], weight;
    int n_stops;
} Reader;

static void source_clear(Source *source)
{
    if (source->key)
        g_string_free(source->key, TRUE);
    source->key = NULL;
}

static Source source_copy(const Source *source)
{
    Source copy = *source;
    copy.key = source->key ? g_string_new(source->key->str) : NULL;
    return copy;
}

static void op_clear(void *data)
{
    source_clear(&((Op *)data)->source);
}

static void context_clear(void *data)
{
    source_clear(&((Context *)data)->source);
}

static Context *top(Reader *r)
{
    return &g_array_index(r->contexts, Context, r->contexts->len - 1);
}

static void push_context(Reader *r, const char *surface)
{
    Context context = {.source = {.kind = FL_PAINT_FLAT, .rgba = {0, 0, 0, 1}, .peak = 1},
                       .line_width = 2, // cairo's default is not written
                       .scale = 1};
    g_strlcpy(context.surface, surface, sizeof context.surface);
    g_array_append_val(r->contexts, context);
}

/** The word before the last, or the last but n; "" beyond the first. */
static void word_from_end(const char *line, int n, char *word, size_t bytes)
{
    const char *end = line + strlen(line);
    for (int i = 0;; i++) {
        while (end > line && end[-1] == ' ')
            end--;
        const char *begin = end;
        while (begin > line && begin[-1] != ' ')
            begin--;
        if (i == n) {
            g_strlcpy(word, begin, MIN(bytes, (size_t)(end - begin) + 1));
            return;
        }
        end = begin;
    }
}

static void start_source(Reader *r, FlPaintKind kind)
{
    source_clear(&r->next);
    r->next = (Source){.kind = kind, .rgba = {0, 0, 0, 1}, .peak = 1};
}

static void read_solid(Reader *r, const char *line)
{
    char *s = NULL, type[16];
    double v[4] = {0, 0, 0, 1};
    int n = 0;
    const char *from = line;
    for (; n < 4; n++, from = s) {
        const double value = g_ascii_strtod(from, &s);
        if (s == from)
            break;
        v[n] = value;
    }
    word_from_end(line, 1, type, sizeof type);
    start_source(r, FL_PAINT_FLAT);
    double *out = r->next.rgba;
    if (strcmp(type, "a") == 0)
        out[3] = v[0];
    else if (strcmp(type, "g") == 0)
        out[0] = out[1] = out[2] = v[0];
    else
        memcpy(out, v, sizeof v);
    r->next.peak = out[3];
}

static void start_gradient(Reader *r, const char *type)
{
    start_source(r, FL_PAINT_GRADIENT);
    r->next.key = g_string_new(type);
    r->next.peak = 0;
    r->n_stops = 0;
    r->stop_offset = r->weight = 0;
    memset(r->sum, 0, sizeof r->sum);
}

/** Adds the stretch up to offset, whose colours change evenly from the last stop's to rgba. */
static void add_stretch(Reader *r, double offset, const double rgba[4])
{
    const double length = offset - r->stop_offset;
    for (int c = 0; c < 4; c++)
        r->sum[c] += length * (r->stop_rgba[c] + rgba[c]) / 2;
    r->weight += length;
    memcpy(r->stop_rgba, rgba, sizeof r->stop_rgba);
    r->stop_offset = offset;
}

static void read_stop(Reader *r, const char *line)
{
    double v[5] = {0, 0, 0, 0, 1};
    char *s = (char *)line;
    for (int i = 0; i < 5; i++)
        v[i] = g_ascii_strtod(s, &s);
    if (r->n_stops++ == 0)
        memcpy(r->stop_rgba, v + 1, sizeof r->stop_rgba);
    r->next.peak = MAX(r->next.peak, v[4]);
    add_stretch(r, CLAMP(v[0], r->stop_offset, 1), v + 1);
    if (r->next.key)
        g_string_append_printf(r->next.key, " %d:%02x%02x%02x%02x", (int)lround(v[0] * 100),
                               (int)lround(v[1] * 255), (int)lround(v[2] * 255),
                               (int)lround(v[3] * 255), (int)lround(v[4] * 255));
}

static void finish_gradient(Reader *r)
{
    if (r->n_stops == 0)
        return;
    add_stretch(r, 1, r->stop_rgba);
    for (int c = 0; c < 4; c++)
        r->next.rgba[c] = r->weight > 0 ? r->sum[c] / r->weight : r->stop_rgba[c];
}

static void set_source(Reader *r, const char *line)
{
    char type[16];
    word_from_end(line, 1, type, sizeof type);
    if (strcmp(type, "rgb") == 0 || strcmp(type, "rgba") == 0 || strcmp(type, "g") == 0 ||
        strcmp(type, "a") == 0)
        read_solid(r, line);
    if (r->next.kind == FL_PAINT_GRADIENT)
        finish_gradient(r);
    source_clear(&top(r)->source);
    top(r)->source = source_copy(&r->next);
}

/** A group's surface is drawn: its ops now belong to the current surface. */
static void merge_surface(Reader *r, const char *surface, double alpha, FlBlendMode blend_mode)
{
    for (guint i = 0; i < r->ops->len; i++) {
        Op *op = &g_array_index(r->ops, Op, i);
        if (strcmp(op->surface, surface) != 0)
            continue;
        op->alpha *= alpha;
        op->blend_mode = blend_mode == FL_BLEND_MODE_OVER ? op->blend_mode : blend_mode;
        g_strlcpy(op->surface, top(r)->surface, sizeof op->surface);
    }
}

static void drop_surface(Reader *r, const char *surface)
{
    for (guint i = r->ops->len; i-- > 0;)
        if (strcmp(g_array_index(r->ops, Op, i).surface, surface) == 0)
            g_array_remove_index(r->ops, i);
}

static void draw(Reader *r, bool stroke, double alpha)
{
    Context *context = top(r);
    const Source *source = &context->source;
    if (source->surface[0] && !source->repeats) {
        merge_surface(r, source->surface, alpha, context->blend_mode);
        return;
    }
    Op op = {.stroke = stroke,
             .blend_mode = context->blend_mode,
             .alpha = alpha,
             .width = stroke ? context->line_width * context->scale : 0,
             .source = source_copy(source)};
    if (source->surface[0]) {
        drop_surface(r, source->surface);
        op.source.kind = FL_PAINT_IMAGE;
    }
    g_strlcpy(op.surface, context->surface, sizeof op.surface);
    g_array_append_val(r->ops, op);
}

static void read_pattern(Reader *r, const char *line)
{
    char name[16];
    word_from_end(line, 1, name, sizeof name);
    start_source(r, FL_PAINT_IMAGE);
    if (name[0] == 's' && g_ascii_isdigit(name[1]))
        g_strlcpy(r->next.surface, name, sizeof r->next.surface);
}

/** "[a b c d x y] set-matrix": the pen's; a pattern's is indented. */
static void set_matrix(Reader *r, const char *line)
{
    double v[4] = {1, 0, 0, 1};
    char *s = (char *)line + 1;
    for (int i = 0; i < 4 && line[0] == '['; i++)
        v[i] = g_ascii_strtod(s, &s);
    top(r)->scale = sqrt(fabs(v[0] * v[3] - v[1] * v[2]));
}

static void exchange_contexts(Reader *r)
{
    if (r->contexts->len < 2)
        return;
    Context *last = top(r), before = last[-1];
    last[-1] = last[0];
    last[0] = before;
}

/** "//MULTIPLY set-operator"; what is no blend mode is librsvg's own business. */
static FlBlendMode blend_mode_of(const char *line)
{
    static const char *const names[FL_N_BLEND_MODES] = {
        "OVER",    "MULTIPLY",       "SCREEN",     "OVERLAY",       "DARKEN",     "LIGHTEN",
        "DODGE",   "BURN",           "HARD_LIGHT", "SOFT_LIGHT",    "DIFFERENCE", "EXCLUSION",
        "HSL_HUE", "HSL_SATURATION", "HSL_COLOR",  "HSL_LUMINOSITY"};
    const char *name = g_str_has_prefix(line, "//") ? line + 2 : line;
    const size_t n = strcspn(name, " ");
    for (int blend_mode = 0; blend_mode < FL_N_BLEND_MODES; blend_mode++)
        if (strlen(names[blend_mode]) == n && strncmp(name, names[blend_mode], n) == 0)
            return (FlBlendMode)blend_mode;
    return FL_BLEND_MODE_OVER;
}

static void read_line(Reader *r, const char *line)
{
    char op[24];
    word_from_end(line, 0, op, sizeof op);
    if (g_str_has_prefix(line, "exch "))
        exchange_contexts(r);
    if (strcmp(op, "context") == 0) {
        const char *def = strstr(line, " /s");
        char name[16] = "";
        if (def)
            sscanf(def, " /%15s", name);
        push_context(r, name);
    } else if (strcmp(op, "pop") == 0 && r->contexts->len > 1) {
        g_array_remove_index(r->contexts, r->contexts->len - 1);
    } else if (strcmp(op, "undef") == 0 && line[0] == '/') {
        char name[16];
        word_from_end(line + 1, 1, name, sizeof name);
        drop_surface(r, name); // never drawn, such as a group of opacity 0
    } else if (strcmp(op, "linear") == 0 || strcmp(op, "radial") == 0) {
        start_gradient(r, op);
    } else if (strcmp(op, "add-color-stop") == 0) {
        read_stop(r, line);
    } else if (strcmp(op, "pattern") == 0) {
        read_pattern(r, line);
    } else if (strcmp(op, "set-extend") == 0) {
        r->next.repeats = strstr(line, "REPEAT") || strstr(line, "REFLECT");
    } else if (strcmp(op, "set-source") == 0) {
        set_source(r, line);
    } else if (strcmp(op, "set-line-width") == 0) {
        top(r)->line_width = g_ascii_strtod(line, NULL);
    } else if (strcmp(op, "set-matrix") == 0 && line[0] != ' ') {
        set_matrix(r, line);
    } else if (strcmp(op, "set-operator") == 0) {
        top(r)->blend_mode = blend_mode_of(line);
    } else if (strcmp(op, "mask") == 0) {
        draw(r, false, strstr(line, " a mask") ? g_ascii_strtod(line, NULL) : 1);
    } else if (strcmp(op, "stroke+") == 0 || strcmp(op, "stroke") == 0) {
        draw(r, true, 1);
    } else if (strcmp(op, "fill+") == 0 || strcmp(op, "fill") == 0 || strcmp(op, "paint") == 0 ||
               g_str_has_prefix(op, "show-")) {
        draw(r, false, 1);
    }
}

static uint8_t to_byte(double v)
{
    return (uint8_t)CLAMP(lround(v * 255), 0, 255);
}

static FlSvgPaint op_paint(const Op *op)
{
    const double *v = op->source.rgba;
    FlSvgPaint paint = {op->source.kind,
                        {to_byte(v[0]), to_byte(v[1]), to_byte(v[2])},
                        to_byte(v[3] * op->alpha),
                        to_byte(op->source.peak * op->alpha),
                        NULL};
    if (op->source.kind == FL_PAINT_FLAT)
        paint.key = g_strdup_printf("#%02x%02x%02x", paint.rgb[0], paint.rgb[1], paint.rgb[2]);
    else
        paint.key = g_strdup(op->source.key ? op->source.key->str : "image");
    return paint;
}

static bool same_paint(const FlSvgPaint *a, const FlSvgPaint *b)
{
    return a->kind == b->kind && a->alpha == b->alpha && strcmp(a->key, b->key) == 0;
}

/** The paint of all ops that fit, MIXED if they differ. which: 0 fills, 1 strokes, 2 both. */
static FlPainted join(const GArray *ops, int which, FlPart part)
{
    FlPainted painted = {.part = part, .stroke = true};
    bool first = true;
    for (guint i = 0; i < ops->len; i++) {
        const Op *op = &g_array_index(ops, Op, i);
        if (which != 2 && op->stroke != (which == 1))
            continue;
        painted.stroke = painted.stroke && op->stroke;
        painted.blend_mode =
            first || op->blend_mode == painted.blend_mode ? op->blend_mode : FL_BLEND_MODE_OVER;
        painted.width = MAX(painted.width, (float)op->width);
        FlSvgPaint paint = op_paint(op);
        if (first) {
            painted.paint = paint;
        } else {
            if (!same_paint(&paint, &painted.paint)) {
                painted.paint.kind = FL_PAINT_MIXED;
                painted.paint.alpha = MAX(painted.paint.alpha, paint.alpha);
                painted.paint.peak = MAX(painted.paint.peak, paint.peak);
                g_free(painted.paint.key);
                painted.paint.key = g_strdup("mixed");
            }
            fl_svg_paint_clear(&paint);
        }
        first = false;
    }
    return painted;
}

static int take_apart(const GArray *ops, bool whole, FlPainted parts[FL_MOST_PARTS])
{
    guint strokes = 0;
    for (guint i = 0; i < ops->len; i++)
        strokes += g_array_index(ops, Op, i).stroke;
    if (ops->len == 0)
        return 0;
    parts[0] = join(ops, 2, FL_PART_WHOLE);
    const FlSvgPaint *paint = &parts[0].paint;
    const bool uniform = paint->kind == FL_PAINT_FLAT && (paint->alpha == 255 || ops->len == 1);
    if (whole || uniform || parts[0].blend_mode != FL_BLEND_MODE_OVER || strokes == 0 ||
        strokes == ops->len)
        return 1;
    fl_svg_paint_clear(&parts[0].paint);
    const int first = g_array_index(ops, Op, 0).stroke;
    parts[0] = join(ops, first, first ? FL_PART_STROKE : FL_PART_FILL);
    parts[1] = join(ops, !first, first ? FL_PART_FILL : FL_PART_STROKE);
    return 2;
}

int fl_svg_paint_parse(const char *script, bool whole, FlPainted parts[FL_MOST_PARTS])
{
    Reader r = {.ops = g_array_new(FALSE, FALSE, sizeof(Op)),
                .contexts = g_array_new(FALSE, FALSE, sizeof(Context))};
    g_array_set_clear_func(r.ops, op_clear);
    g_array_set_clear_func(r.contexts, context_clear);
    push_context(&r, "");
    g_auto(GStrv) lines = g_strsplit(script, "\n", -1);
    for (int i = 0; lines[i]; i++)
        read_line(&r, lines[i]);
    for (guint i = r.ops->len; i-- > 0;) {
        const Op *op = &g_array_index(r.ops, Op, i);
        if (op->source.rgba[3] * op->alpha < 1 / 510.0)
            g_array_remove_index(r.ops, i);
    }
    const int n = take_apart(r.ops, whole, parts);
    source_clear(&r.next);
    g_array_unref(r.ops);
    g_array_unref(r.contexts);
    return n;
}

void fl_svg_paint_clear(FlSvgPaint *paint)
{
    g_clear_pointer(&paint->key, g_free);
}
