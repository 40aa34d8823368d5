#include "svg/css_animation.h"

#include "svg/interpolate.h"
#include <math.h>
#include <string.h>

typedef enum Longhand {
    NAME,
    DURATION,
    TIMING,
    DELAY,
    COUNT,
    DIRECTION,
    FILL,
    STATE,
    COMPOSITION,
    TIMELINE,
    N_LONGHANDS
} Longhand;

static const char *const names[N_LONGHANDS] = {
    "animation-name",      "animation-duration",        "animation-timing-function",
    "animation-delay",     "animation-iteration-count", "animation-direction",
    "animation-fill-mode", "animation-play-state",      "animation-composition",
    "animation-timeline"};

static const char *const initial[N_LONGHANDS] = {"none",   "0s",   "ease",    "0s",      "1",
                                                 "normal", "none", "running", "replace", "auto"};

/** The animations of one element, from the values of its animation properties. */
typedef struct FlCssAnimations {
    char **list[N_LONGHANDS]; // NULL: not said
} FlCssAnimations;

static bool is_time(const char *word)
{
    const size_t n = strlen(word);
    return n > 1 && word[n - 1] == 's' &&
           (g_ascii_isdigit(word[n - 2]) || word[n - 2] == '.' || word[n - 2] == 'm') &&
           (g_ascii_isdigit(*word) || strchr("+-.", *word));
}

/** The longhand that a word of the shorthand is for; the first time is the duration. */
static Longhand longhand_of(const char *word, char *const *taken)
{
    static const struct {
        Longhand longhand;
        const char *words;
    } known[] = {
        {TIMING, "linear ease ease-in ease-out ease-in-out step-start step-end"},
        {COUNT, "infinite"},
        {DIRECTION, "normal reverse alternate alternate-reverse"},
        {FILL, "none forwards backwards both"},
        {STATE, "running paused"},
    };
    if (is_time(word) || g_str_has_prefix(word, "calc("))
        return taken[DURATION] ? DELAY : DURATION;
    if (strchr(word, '('))
        return TIMING;
    if (g_ascii_isdigit(*word) || *word == '.')
        return COUNT;
    for (size_t i = 0; i < G_N_ELEMENTS(known); i++)
        if (fl_css_has_word(known[i].words, word) && !taken[known[i].longhand])
            return known[i].longhand;
    return NAME;
}

/** Takes the shorthand apart. */
static void set_all(FlCssAnimations *animations, const char *value)
{
    g_auto(GStrv) part = fl_css_split(value, ',');
    const guint n = g_strv_length(part);
    for (int k = 0; k < N_LONGHANDS; k++) {
        g_strfreev(animations->list[k]);
        animations->list[k] = g_new0(char *, n + 1);
    }
    for (guint i = 0; i < n; i++) {
        char *taken[N_LONGHANDS] = {0};
        g_auto(GStrv) word = fl_css_split(part[i], ' ');
        for (int w = 0; word[w]; w++)
            taken[longhand_of(word[w], taken)] = word[w];
        for (int k = 0; k < N_LONGHANDS; k++)
            animations->list[k][i] = g_strdup(taken[k] ? taken[k] : initial[k]);
    }
}

static void set(FlCssAnimations *animations, const char *property, const char *value)
{
    if (strcmp(property, "animation") == 0)
        set_all(animations, value);
    for (int k = 0; k < N_LONGHANDS; k++)
        if (strcmp(property, names[k]) == 0) {
            g_strfreev(animations->list[k]);
            animations->list[k] = fl_css_split(value, ',');
        }
}

/** The i-th value of a longhand; lists that are too short start again. */
static const char *longhand(const FlCssAnimations *animations, Longhand k, int i)
{
    const int n = animations->list[k] ? (int)g_strv_length(animations->list[k]) : 0;
    return n > 0 ? animations->list[k][i % n] : initial[k];
}

static double seconds_of(const char *text)
{
    const FlCssUnits none = {0};
    double v = 0;
    return fl_css_number(text, &none, 0, &v) ? v : 0;
}

/** The progress of one animation, 0 … 1; false if it has no effect then. */
static bool progress_at(const FlCssAnimations *animations, int i, double seconds, double *progress)
{
    const double duration = fmax(seconds_of(longhand(animations, DURATION, i)), 0);
    const char *count = longhand(animations, COUNT, i),
               *direction = longhand(animations, DIRECTION, i);
    const char *fill = longhand(animations, FILL, i);
    const double rounds =
        strcmp(count, "infinite") == 0 ? INFINITY : fmax(g_ascii_strtod(count, NULL), 0);
    const bool paused = strcmp(longhand(animations, STATE, i), "paused") == 0;
    double t = (paused ? 0 : seconds) - seconds_of(longhand(animations, DELAY, i));
    const double active = duration > 0 ? rounds * duration : 0;
    const bool both = strcmp(fill, "both") == 0;
    if (t < 0 && !both && strcmp(fill, "backwards") != 0)
        return false;
    if (t >= active && !both && strcmp(fill, "forwards") != 0)
        return false;
    t = CLAMP(t, 0, active);
    double round = duration > 0 ? t / duration : isfinite(rounds) ? rounds : 0;
    double whole = floor(round + 1e-9);
    if (t >= active && whole > 0 && fabs(round - whole) < 1e-9)
        whole--; // the end of the last round
    double p = CLAMP(round - whole, 0, 1);
    const bool odd = fmod(whole, 2) == 1;
    const bool alternates = g_str_has_prefix(direction, "alternate");
    const bool reversed = g_str_has_suffix(direction, "reverse") != (alternates && odd);
    *progress = reversed ? 1 - p : p;
    return true;
}

static void add_length(const FlCssAnimations *animations, int i, FlFilmLength *length)
{
    const double duration = fmax(seconds_of(longhand(animations, DURATION, i)), 0);
    const char *count = longhand(animations, COUNT, i);
    const bool alternates = g_str_has_prefix(longhand(animations, DIRECTION, i), "alternate");
    const double delay = seconds_of(longhand(animations, DELAY, i));
    if (strcmp(count, "infinite") == 0 && duration > 0) {
        const double period = alternates ? 2 * duration : duration;
        g_array_append_val(length->loops, period);
    } else {
        length->end = fmax(length->end, delay + duration * g_ascii_strtod(count, NULL));
    }
}

static const char *find(const GArray *declarations, const char *property)
{
    const char *value = NULL;
    FL_EACH (const FlCssDeclaration, d, declarations) {
        if (strcmp(d->name, property) == 0 && !d->important) // key frames have no such priority
            value = d->value;
    }
    return value;
}

/** The data of path("M…"), to be interpolated; other values stay. To be freed. */
static char *plain_path(const char *value)
{
    g_autofree char *name = NULL, *arguments = NULL;
    char *data = fl_css_call(value, &name, &arguments) && strcmp(name, "path") == 0
                     ? fl_css_string_or_url(arguments)
                     : NULL;
    return data ? data : g_strdup(value);
}

static char *between_paths(const char *from, const char *to, double q)
{
    g_autofree char *a = plain_path(from), *b = plain_path(to), *data = fl_interpolate(a, b, q);
    return g_strdup_printf("path(\"%s\")", data ? data : q < .5 ? a : b);
}

/** A value with its variables put in, or what it stands for; to be freed. */
static char *substituted(const char *property, const char *value, const FlCssContext *context)
{
    if (g_ascii_strcasecmp(value, "currentcolor") == 0)
        return g_strdup(context->variable(context->style, value));
    char *text =
        strstr(value, "var(") ? fl_css_substitute(value, context->variable, context->style) : NULL;
    if (!text)
        return g_strdup(context->underlying(context->data, property, value));
    return g_strstrip(text);
}

/** A value between those of the keyframes around a progress; `typed`: a variable of @property. */
static char *between(const GArray *frames, const char *property, double p, const char *timing,
                     const char *underlying, bool typed, const FlCssContext *context)
{
    const char *from = underlying, *to = underlying, *usual = timing;
    double start = 0, end = 1;
    bool has_end = false;
    FL_EACH (const FlCssKeyframe, frame, frames) {
        const char *value = find(frame->declarations, property);
        if (!value)
            continue;
        if (frame->share <= p && frame->share >= start) {
            const char *own = find(frame->declarations, "animation-timing-function");
            from = value, start = frame->share;
            timing = own ? own : usual;
        }
        if (frame->share > p && (!has_end || frame->share < end)) {
            to = value, end = frame->share;
            has_end = true;
        }
    }
    g_autofree char *own_from = substituted(property, from, context),
                    *own_to = substituted(property, to, context);
    from = own_from, to = own_to;
    if (!has_end && start >= 1)
        return g_strdup(from);
    const double q = end > start ? fl_css_ease(timing, (p - start) / (end - start)) : 0;
    char *text = NULL;
    if (strcmp(property, "transform") == 0)
        text = fl_interpolate_transform(from, to, q, context->units);
    else if (strcmp(property, "d") == 0)
        text = between_paths(from, to, q);
    else if (strcmp(property, "filter") == 0)
        text = fl_interpolate_functions(from, to, q, ' ');
    else if (strcmp(property, "translate") == 0 || strcmp(property, "rotate") == 0 ||
             strcmp(property, "scale") == 0)
        text = fl_interpolate_words(property, from, to, q);
    else if (strcmp(property, "visibility") == 0 && q > 0 && q < 1)
        text = g_strdup(strcmp(from, "visible") == 0 ? from : to);
    else if (strcmp(property, "display") == 0 && q > 0 && q < 1)
        text = g_strdup(strcmp(from, "none") == 0 ? to : from);
    else if (*from && *to && (typed || strncmp(property, "--", 2) != 0))
        text = fl_interpolate(from, to, q);
    return text ? text : g_strdup(q < .5 ? from : to);
}

/** All properties of the keyframes, once each. */
static GPtrArray *properties_of(const GArray *frames)
{
    GPtrArray *properties = g_ptr_array_new();
    for (guint i = 0; i < frames->len; i++) {
        const GArray *list = g_array_index(frames, FlCssKeyframe, i).declarations;
        for (guint k = 0; k < list->len; k++) {
            const char *name = g_array_index(list, FlCssDeclaration, k).name;
            if (!g_str_has_prefix(name, "animation-") && find(list, name) &&
                !g_ptr_array_find(properties, name, NULL))
                g_ptr_array_add(properties, (gpointer)name); // interned
        }
    }
    return properties;
}

/** Adds the value of an animation, which is freed, to the one without it, as animation-composition
 * wants it; to be freed. */
static char *sum_of(const char *property, const char *base, char *value)
{
    const bool list = strcmp(property, "transform") == 0;
    const bool across =
        strcmp(property, "translate") == 0 && strchr(value, ' ') && !strchr(base, ' ');
    g_autofree char *full = g_strconcat(base, across ? " 0px" : "", NULL);
    char *sum = list ? g_strconcat(strcmp(base, "none") == 0 ? "" : base, " ",
                                   strcmp(value, "none") == 0 ? "" : value, NULL)
                     : fl_add_values(full, value, 1);
    if (!sum)
        return value;
    g_free(value);
    return sum;
}

static void apply(const FlCssAnimations *animations, const FlCssSheet *sheet, double seconds,
                  const FlCssContext *context, FlFilmLength *length)
{
    for (int i = 0; animations->list[NAME] && animations->list[NAME][i]; i++) {
        g_autofree char *plain = fl_css_string_or_url(animations->list[NAME][i]);
        const GArray *frames =
            g_hash_table_lookup(sheet->keyframes, plain ? plain : animations->list[NAME][i]);
        double p;
        if (!frames || strcmp(longhand(animations, TIMELINE, i), "auto") != 0) // nothing scrolls
            continue;
        if (length)
            add_length(animations, i, length);
        if (!progress_at(animations, i, seconds, &p))
            continue;
        g_autoptr(GPtrArray) properties = properties_of(frames);
        for (guint k = 0; k < properties->len; k++) {
            const char *property = properties->pdata[k],
                       *base = context->underlying(context->data, property, NULL);
            const char *typed = g_hash_table_lookup(sheet->initial, property);
            base = *base || !typed ? base : typed;
            const bool adds = strcmp(longhand(animations, COMPOSITION, i), "replace") != 0;
            g_autofree char *zero = adds ? fl_add_values(base, base, -1) : NULL;
            const char *missing = adds && strcmp(property, "transform") == 0 ? "none"
                                  : zero                                     ? zero
                                                                             : base;
            char *value = between(frames, property, p, longhand(animations, TIMING, i), missing,
                                  typed != NULL, context);
            context->take(context->data, property, adds ? sum_of(property, base, value) : value);
        }
    }
}

void fl_css_animations_apply(const GArray *declared, const FlCssSheet *sheet, double seconds,
                             const FlCssContext *context, FlFilmLength *length)
{
    FlCssAnimations animations = {0};
    FL_EACH (const FlCssDeclaration, d, declared)
        set(&animations, d->name, d->value);
    apply(&animations, sheet, seconds, context, length);
    for (int k = 0; k < N_LONGHANDS; k++)
        g_strfreev(animations.list[k]);
}
