/* Checks a style: reports what was read and measured, and what will paint badly. */
#include "base/error.h"
#include "base/memory.h"
#include "io/pattern.h"
#include "params/text.h"
#include "style/estimate.h"
#include "style/manifest.h"
#include "style/measure.h"
#include "style/style_guides.h"

#include <fluidy/style.h>

/* The limits for a good style; more in find_frame_problems(). */
static const float LEAST_PAINT = 0.4f;   // of the last frame
static const float LEAST_FILLED = 0.95f; // of the frame that a tile looks like
static const float LEAST_TEXTURE = 2;    // levels; twelve scanned washes have 2.8 to 6.4
static const float LEAST_GRAIN = 1;      // levels, of paper under thin paint
static const float LEAST_DIFFERENCE =
    1.5f; // levels; the most similar blocks of those washes: 2.7 to 6.4
static const float LEAST_OCTANT = 0.02f; // of the outline
static const float MOST_PAPER_RANGE = 6; // levels
static const float MOST_EDGE = 0.6f;     // of the interior's density

typedef struct Check {
    const FlStyle *style;
    const FlMeasures *measures;
    GPtrArray *facts, *problems;
} Check;

G_GNUC_PRINTF(2, 3) static void add(GPtrArray *lines, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    g_ptr_array_add(lines, g_strdup_vprintf(format, args));
    va_end(args);
}

static const char *origin(const FlStyle *style, FlGuess guess)
{
    return style->guessed & (unsigned)guess ? "guessed" : "given";
}

static void add_given_facts(Check *check)
{
    const FlStyle *style = check->style;
    GPtrArray *facts = check->facts;
    add(facts, "name       %s", style->name);
    if (style->character)
        add(facts, "character  %s", style->character);
    add(facts, "folder     %s", style->path);
    add(facts, "author     %s", style->author ? style->author : "not given");
    add(facts, "licence    %s", style->licence && style->licence[0] ? style->licence : "not given");
    if (style->made_by)
        add(facts, "made by    %s", style->made_by);
    add(facts, "size       %dx%d, %d frame%s, %g per second (%s)", style->width, style->height,
        style->n_frames, style->n_frames == 1 ? "" : "s", style->fps, origin(style, FL_GUESS_FPS));
    g_autofree char *medium = fl_text_word(FL_MEDIUM_WORDS, (int)style->medium);
    add(facts, "medium     %s, scale %g", medium, style->scale);
    add(facts, "paper      #%02x%02x%02x (%s)", style->paper[0], style->paper[1], style->paper[2],
        origin(style, FL_GUESS_PAPER));
    add(facts, "border     %.1f px (%s)", style->border_px, origin(style, FL_GUESS_BORDER));
    add(facts, "masks      %s", origin(style, FL_GUESS_MASK));
    add(facts, "flow       %s", style->flow ? "given" : "guessed from the masks");
}

/* Medians over the frames: one odd frame does not decide. */
static float median_over_frames(const FlMeasures *measures, size_t field)
{
    g_autofree float *value = g_new(float, measures->n_frames);
    for (int i = 0; i < measures->n_frames; i++)
        value[i] = *(const float *)((const char *)&measures->frame[i] + field);
    qsort(value, (size_t)measures->n_frames, sizeof *value, fl_compare_floats);
    return value[measures->n_frames / 2];
}

#define MEDIAN(measures, field) median_over_frames(measures, offsetof(FlFrameMeasure, field))

static const char *const octants[FL_OCTANTS] = {"right", "down right", "down", "down left",
                                                "left",  "up left",    "up",   "up right"};

/* Returns: true if a list such as "left, up left" contains the name. */
static bool is_listed(const char *list, const char *name)
{
    g_auto(GStrv) words = g_strsplit_set(list ? list : "", ",;", -1);
    for (int i = 0; words[i]; i++)
        if (g_ascii_strcasecmp(g_strstrip(words[i]), name) == 0)
            return true;
    return false;
}

/* The directions that no outline faces, without those in `known`, which may be NULL. */
static char *missing_octants(const FlMeasures *measures, const char *known)
{
    g_autoptr(GPtrArray) names = g_ptr_array_new();
    for (int i = 0; i < FL_OCTANTS; i++)
        if (measures->orientation[i] < LEAST_OCTANT && !is_listed(known, octants[i]))
            g_ptr_array_add(names, (gpointer)octants[i]);
    g_ptr_array_add(names, NULL);
    return g_strjoinv(", ", (char **)names->pdata);
}

static bool has_outline(const FlMeasures *measures)
{
    for (int i = 0; i < FL_OCTANTS; i++)
        if (measures->orientation[i] > 0)
            return true;
    return false;
}

/* Paint changes while it is fresh: it is dry once it changes half as much as at first. */
static void add_ages(Check *check)
{
    const FlMeasures *m = check->measures;
    int dry = 1;
    while (dry < m->n_frames && m->frame[dry].change > m->frame[0].change / 2)
        dry++;
    if (m->n_frames > 1 && dry < m->n_frames)
        add(check->facts, "fresh      frames 1 to %d; it dries within %.2g s", dry,
            (double)dry / (double)check->style->fps);
    else if (m->n_frames > 1)
        add(check->facts, "fresh      all frames: it does not dry in the recording");
}

static bool add_wash(Check *check, float wet, GError **error)
{
    FlWashEstimate found;
    if (!fl_wash_estimate(check->style, wet, &found, error))
        return false;
    if (found.kurtosis > 0)
        add(check->facts,
            "[wash]     calm %g, hue %g by the recording: kurtosis %.1f (noise: 3, scanned washes: "
            "6 to 18), its hue wanders by %.1f",
            (double)found.wash.calm, (double)found.wash.hue, (double)found.kurtosis,
            (double)found.hue);
    return true;
}

/* The numbers that import would write. */
static bool add_estimates(Check *check, GError **error)
{
    FlFrontStyle f;
    if (!fl_front_estimate(check->style, &f, error))
        return false;
    add(check->facts,
        "[front]    width %g, stain %g, film %g, soft %g, base %g, line %g, fingers %g, "
        "granulation %g by the recording",
        (double)f.width, (double)f.stain, (double)f.film, (double)f.soft, (double)f.base,
        (double)f.line, (double)f.fingers, (double)f.granulation);
    return add_wash(check, f.width, error);
}

static void add_measured_facts(Check *check)
{
    const FlMeasures *m = check->measures;
    const FlFrameMeasure *first = &m->frame[0], *last = &m->frame[m->n_frames - 1];
    GPtrArray *facts = check->facts;
    g_autofree char *missing = missing_octants(m, NULL);
    add(facts, "paint      %.0f %% of the first frame, %.0f %% of the last", 100 * first->paint,
        100 * last->paint);
    add(facts, "interior   %.0f %% of the paint of the last frame", 100 * last->interior);
    add(facts, "at rest    %.0f %% of the paint (slower than %g px/frame)",
        100 * MEDIAN(m, resting), FL_RESTING_PX);
    add(facts, "moving     %.0f %% of the paint (%g px/frame or faster)", 100 * MEDIAN(m, moving),
        FL_MOVING_PX);
    add(facts, "front      %.2f px/frame; %.0f %% of it at %g to %g", MEDIAN(m, front),
        100 * MEDIAN(m, steady), FL_MOVING_PX, FL_TOO_FAST_PX);
    if (has_outline(m))
        add(facts, "outward    all directions%s%s", missing[0] ? " but " : "", missing);
    add(facts, "texture    %.1f levels of fine detail (scanned washes: 2.8 to 6.4)", m->texture);
    if (m->thin_texture >= 0)
        add(facts, "grain      %.1f levels under thin paint", m->thin_texture);
    if (m->paper_texture >= 0)
        add(facts, "paper      %.1f levels of fine detail; its light varies by %.0f",
            m->paper_texture, m->paper_range);
    if (m->n_blocks > 1)
        add(facts, "variety    %d blocks of 16x16; the two most similar differ by %.1f levels",
            m->n_blocks, m->alike);
    add(facts, "life       paint changes by %.1f levels from frame to frame", MEDIAN(m, change));
}

/* The frames for which a test fails, from `first` on, counted from 1; NULL if all pass. */
static char *failing_frames(const FlMeasures *measures, int first, size_t field, float least)
{
    g_autoptr(GArray) failing = g_array_new(FALSE, FALSE, sizeof(int));
    for (int i = first + 1; i <= measures->n_frames; i++)
        if (*(const float *)((const char *)&measures->frame[i - 1] + field) < least)
            g_array_append_val(failing, i);
    return failing->len > 0 ? fl_range_text(failing) : NULL;
}

static void find_frame_problems(Check *check)
{
    const FlMeasures *m = check->measures;
    static const struct {
        size_t field;
        int first;
        float least;
        const char *what;
    } tests[] = {
        {offsetof(FlFrameMeasure, paint), 0, 1e-6f, "the mask is empty"},
        {offsetof(FlFrameMeasure, interior), 3, 0.02f, "no interior: the border is too wide"},
        {offsetof(FlFrameMeasure, resting), 3, 0.02f, "no paint rests: there is no still core"},
        {offsetof(FlFrameMeasure, moving), 3, 0.02f, "no paint moves: there is no moving fringe"},
        {offsetof(FlFrameMeasure, steady), 3, 0.5f,
         "less than half of the front moves at 0.5 to 4 px/frame"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(tests); i++) {
        const bool of_motion = tests[i].field == offsetof(FlFrameMeasure, moving) ||
                               tests[i].field == offsetof(FlFrameMeasure, steady);
        if (of_motion && MEDIAN(m, front) < 0.1f)
            continue; // find_motion_problems() reports this once
        g_autofree char *frames = failing_frames(m, tests[i].first, tests[i].field, tests[i].least);
        if (frames)
            add(check->problems, "%s (frame %s)", tests[i].what, frames);
    }
}

static void find_mask_problems(Check *check)
{
    static const char *const sides[] = {"left", "top", "right", "bottom"};
    const FlMeasures *m = check->measures;
    GPtrArray *problems = check->problems;
    const float last = m->frame[m->n_frames - 1].paint;
    if (last < LEAST_PAINT)
        add(problems, "paint fills %.0f %% of the last frame: expected 40 %% or more", 100 * last);
    for (int side = 0; side < 4; side++)
        if (m->rim[side] > 0)
            add(problems, "the mask touches the frame's %s edge (%.0f %% of it)", sides[side],
                100 * m->rim[side]);
    if (m->edge > MOST_EDGE)
        add(problems,
            "the outline cuts through paint (%.0f %% as dense as the interior): the masks should "
            "reach a little over bare paper",
            100 * m->edge);
    g_autofree char *missing = missing_octants(m, check->style->missing_orientations);
    if (!has_outline(m))
        add(problems, "no outline is within the frame: edges have no paint of their own");
    else if (missing[0])
        add(problems,
            "no outline faces %s: such edges are painted with rotated ones (list them as "
            "missing-orientations in style.ini if you know)",
            missing);
}

static void find_motion_problems(Check *check)
{
    const FlMeasures *m = check->measures;
    if (m->n_frames == 1)
        add(check->problems, "there is only one frame: the paint will not flow");
    else if (MEDIAN(m, front) < 0.1f)
        add(check->problems, "the paint never moves");
    if (m->n_frames > 1 && MEDIAN(m, change) < 0.05f)
        add(check->problems, "all frames look the same");
    find_frame_problems(check);
}

static void find_texture_problems(Check *check)
{
    const FlMeasures *m = check->measures;
    float low = 255, high = 0;
    for (int i = 0; i < m->n_frames; i++)
        if (m->frame[i].paper >= 0) {
            low = MIN(low, m->frame[i].paper);
            high = MAX(high, m->frame[i].paper);
        }
    if (m->texture < LEAST_TEXTURE)
        add(check->problems,
            "the interior is smooth (%.1f levels of fine detail): it will look flat", m->texture);
    if (m->thin_texture >= 0 && m->thin_texture < LEAST_GRAIN)
        add(check->problems, "no paper grain shows under thin paint (%.1f levels)",
            m->thin_texture);
    if (m->alike >= 0 && m->alike < LEAST_DIFFERENCE)
        add(check->problems, "two blocks of 16x16 px look alike (%.1f levels apart)", m->alike);
    if (m->paper_range > MOST_PAPER_RANGE)
        add(check->problems, "the paper's colour varies by %.0f levels over the frame",
            m->paper_range);
    if (high - low > MOST_PAPER_RANGE)
        add(check->problems, "the light changes by %.0f levels between frames", high - low);
}

/* A style with a tile gives its look only, neither edges nor motion nor paint to copy: all it needs
 * is a frame full of ink. */
static bool moves_ink(const FlStyle *style)
{
    g_autofree char *tile = g_build_filename(style->path, FL_STYLE_TILE, NULL);
    return g_file_test(tile, G_FILE_TEST_IS_REGULAR);
}

static void check_all(Check *check)
{
    const bool recorded = !moves_ink(check->style);
    add_given_facts(check);
    if (!recorded)
        add(check->facts,
            "tile       transport.png: ink is moved, the frame is what it looks like");
    add_measured_facts(check);
    if (recorded) {
        add_ages(check);
        find_mask_problems(check);
        find_motion_problems(check);
        find_texture_problems(check);
    } else if (check->measures->frame[0].paint < LEAST_FILLED)
        add(check->problems, "paint fills %.0f %% of the frame: expected 95 %% or more",
            100 * check->measures->frame[0].paint);
    if (!check->style->licence || !check->style->licence[0])
        add(check->problems, "no licence is given in style.ini");
}

static char *report_text(const Check *check)
{
    GString *text = g_string_new(NULL);
    for (guint i = 0; i < check->facts->len; i++)
        g_string_append_printf(text, "%s\n", (char *)g_ptr_array_index(check->facts, i));
    for (guint i = 0; i < check->problems->len; i++)
        g_string_append_printf(text, "problem    %s\n",
                               (char *)g_ptr_array_index(check->problems, i));
    return g_string_free(text, FALSE);
}

FlStyleReport *fl_style_check(const char *name, const char *sheet, bool overwrite, GError **error)
{
    g_autofree char *folder = fl_headroom_check(error) ? fl_style_find(name, error) : NULL;
    if (!folder)
        return NULL;
    if (sheet && !overwrite && !fl_check_not_exists(sheet, error))
        return NULL;
    g_autoptr(FlStyle) style = fl_style_load(folder, error);
    FlParams params;
    fl_params_defaults(&params);
    g_autoptr(FlGuideSequence) guides = style ? fl_style_guides(style, &params, error) : NULL;
    g_autoptr(FlMeasures) measures = guides ? fl_measure(style, guides, error) : NULL;
    if (!measures)
        return NULL;
    g_autoptr(GPtrArray) facts = g_ptr_array_new_with_free_func(g_free);
    g_autoptr(GPtrArray) problems = g_ptr_array_new_with_free_func(g_free);
    Check check = {style, measures, facts, problems};
    check_all(&check);
    if (!moves_ink(style) && !add_estimates(&check, error))
        return NULL;
    const FlCheckSheet drawing = {style, measures, guides, facts, problems};
    if (sheet && !fl_check_sheet_write(&drawing, sheet, error))
        return NULL;
    FlStyleReport *report = g_new(FlStyleReport, 1);
    *report = (FlStyleReport){report_text(&check), (int)problems->len};
    return report;
}

void fl_style_report_free(FlStyleReport *report)
{
    if (!report)
        return;
    g_free(report->text);
    g_free(report);
}
