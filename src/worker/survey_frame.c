#include "worker/verbs.h"

#include "svg/normalise.h"
#include "worker/probe.h"
#include <string.h>

#define MOST_WHOLE 8 // groups of a frame that become one leaf, each after another probe

/* ---- strings --------------------------------------------------------------------------------- */

int fl_strings_add(FlStrings *strings, const char *text)
{
    if (!strings->text) {
        strings->text = g_ptr_array_new_with_free_func(g_free);
        strings->number = g_hash_table_new(g_str_hash, g_str_equal);
        fl_strings_add(strings, "");
    }
    gpointer known = NULL;
    if (g_hash_table_lookup_extended(strings->number, text, NULL, &known))
        return GPOINTER_TO_INT(known);
    const int number = (int)strings->text->len;
    char *copy = g_strdup(text);
    g_ptr_array_add(strings->text, copy);
    g_hash_table_insert(strings->number, copy, GINT_TO_POINTER(number));
    return number;
}

const char *fl_strings_get(const FlStrings *strings, int number)
{
    return g_ptr_array_index(strings->text, number);
}

void fl_strings_clear(FlStrings *strings)
{
    if (strings->text) {
        g_hash_table_unref(strings->number);
        g_ptr_array_unref(strings->text);
    }
    *strings = (FlStrings){0};
}

void fl_survey_frame_clear(FlSurveyFrame *frame)
{
    if (frame->parts)
        g_array_unref(frame->parts);
    g_strfreev(frame->whole);
    g_strfreev(frame->files);
    *frame = (FlSurveyFrame){.canvas = frame->canvas};
}

/* ---- one frame ------------------------------------------------------------------------------- */

/** The survey of one frame in progress. */
typedef struct Survey {
    const FlRequest *request;
    FlSurveyFrame *frame;
    FlWarnings *warnings;
} Survey;

static char **copy_of(const GPtrArray *texts)
{
    char **copy = g_new0(char *, texts->len + 1);
    for (guint i = 0; i < texts->len; i++)
        copy[i] = g_strdup(g_ptr_array_index(texts, i));
    return copy;
}

/** Opens a frame and sets its page in the picture. */
static bool open_frame(Survey *s, FlFrameProbe *probe, GError **error)
{
    double width, height;
    const FlRequest *r = s->request;
    FlSvgOptions options = r->svg;
    options.whole = (const char *const *)s->frame->whole;
    g_autoptr(FlSvg) svg = fl_svg_open(r->file, r->number, &options, s->warnings, error);
    if (!svg || !fl_svg_size(svg, &width, &height, error))
        return false;
    s->frame->page = (FlPageSize){width * r->scale, height * r->scale};
    s->frame->n_nameless = fl_svg_nameless_groups(svg);
    g_strfreev(s->frame->files);
    s->frame->files = copy_of(fl_svg_files(svg));
    return fl_frame_probe_init(probe, g_steal_pointer(&svg), s->frame->page, r->width, r->height,
                               error);
}

/** Draws a frame leaf by leaf and compares it with the file; see fl_self_check_finish(). */
static FlVerdict try_frame(Survey *s, FlFrameProbe *f, char **group, const char **leaf,
                           GError **error)
{
    if (!open_frame(s, f, error) || !fl_frame_probe_run(f, error))
        return FL_VERDICT_ERROR;
    return fl_self_check_finish(f->check, group, leaf, error);
}

bool fl_has_group(char **groups, const char *group)
{
    return groups && g_strv_contains((const char *const *)groups, group);
}

void fl_keep_whole(FlSurveyFrame *frame, const char *group)
{
    const guint n = frame->whole ? g_strv_length(frame->whole) : 0;
    frame->whole = g_renew(char *, frame->whole, n + 2);
    frame->whole[n] = g_strdup(group);
    frame->whole[n + 1] = NULL;
}

static void warn_of_whole(FlWarnings *warnings, const char *file, int number, const char *group)
{
    const bool made = g_str_has_prefix(group, FL_GROUP_ID);
    const bool shape = g_str_has_prefix(group, FL_SHAPE_AT);
    const guint64 i = made ? g_ascii_strtoull(group + strlen(FL_GROUP_ID), NULL, 10) : 0;
    g_autofree char *which =
        made ? g_strdup_printf("no. %" G_GUINT64_FORMAT " of the groups without an id ", i + 1)
             : g_strdup(shape ? "a shape without an id " : "");
    const bool all = strcmp(group, FL_WHOLE_ALL) == 0;
    fl_warnings_add(warnings, file, number, made || all || shape ? NULL : group,
                    "%slooks different when it is drawn shape by shape: drawn as one in "
                    "every frame",
                    which);
}

static void keep(const FlFrameProbe *f, FlStrings *s, FlSurveyFrame *frame)
{
    GArray *parts = g_array_sized_new(FALSE, FALSE, sizeof(FlSurveyPart), f->probes->len);
    for (guint i = 0; i < f->probes->len; i++) {
        const FlProbe *probe = &g_array_index(f->probes, FlProbe, i);
        g_array_append_val(parts, probe->found);
        FlSurveyPart *one = &g_array_index(parts, FlSurveyPart, i);
        one->paint = fl_strings_add(s, probe->paint);
        one->name = fl_strings_add(s, probe->leaf->name);
        one->labels = fl_strings_add(s, probe->leaf->labels);
        one->layers = fl_strings_add(s, probe->leaf->layers);
        one->ids = fl_strings_add(s, probe->leaf->ids);
        one->classes = fl_strings_add(s, probe->leaf->classes);
        one->tree = fl_strings_add(s, probe->leaf->tree);
        const FlRect box = probe->box;
        const int corner[4] = {box.x - 1, box.y - 1, box.x + box.width + 1, box.y + box.height + 1};
        for (int c = 0; c < 4; c++)
            one->box[c] = (float)(corner[c] * f->factor);
    }
    frame->parts = parts;
}

/** The isolated groups in which something blends, unless they are one leaf already; NULL: none. */
static char *isolated_groups(const FlFrameProbe *f, const FlSurveyFrame *frame)
{
    const GArray *units = fl_svg_leaves(f->svg)->unit;
    GString *groups = g_string_new(NULL);
    FL_EACH (const FlGroupUnit, unit, units)
        if (unit->isolated && !fl_has_group(frame->whole, unit->leaf.id))
            g_string_append_printf(groups, "%s%s", groups->len ? "\n" : "", unit->leaf.id);
    return g_string_free(groups, groups->len == 0);
}

/** Tells which groups are one region for their filter or blend mode alone. */
static void warn_of_units(const FlFrameProbe *f, const Survey *s)
{
    const GArray *units = fl_svg_leaves(f->svg)->unit;
    FL_EACH (const FlGroupUnit, unit, units) {
        const bool named = !g_str_has_prefix(unit->leaf.id, FL_GROUP_ID);
        if (unit->inseparable && unit->n > 1)
            fl_warnings_add(s->warnings, s->request->file, s->request->number,
                            named ? unit->leaf.id : NULL,
                            "a filter or blend mode makes the %d shapes of a group one picture; "
                            "without it each is painted",
                            unit->n);
    }
}

/** Probes a frame, again for each group that becomes one leaf. */
static bool scan_frame(Survey *s, FlFrameProbe *f, GError **error)
{
    const char *file = s->request->file;
    const int number = s->request->number;
    FlSurveyFrame *frame = s->frame;
    FlWarnings *warnings = s->warnings;
    for (int tries = 0;; tries++) {
        g_autofree char *group = NULL;
        const char *leaf = NULL;
        const FlVerdict verdict = try_frame(s, f, &group, &leaf, error);
        if (verdict == FL_VERDICT_ERROR)
            return false;
        if (verdict == FL_VERDICT_DIFFERS && (!group || tries >= MOST_WHOLE) &&
            fl_self_check_is_gross(f->check) && !fl_has_group(frame->whole, FL_WHOLE_ALL)) {
            g_free(group);
            group = isolated_groups(f, frame);
            group = group ? group : g_strdup(FL_WHOLE_ALL);
            tries = 0;
        }
        if (verdict == FL_VERDICT_DIFFERS && group && tries < MOST_WHOLE) {
            g_auto(GStrv) groups = g_strsplit(group, "\n", -1);
            for (int i = 0; groups[i]; i++) {
                warn_of_whole(warnings, file, number, groups[i]);
                fl_keep_whole(frame, groups[i]);
            }
            fl_frame_probe_clear(f);
            *f = (FlFrameProbe){0};
            continue;
        }
        if (verdict == FL_VERDICT_DIFFERS)
            fl_warnings_add(warnings, file, number, leaf,
                            "the frame looks slightly different when it is drawn shape by shape");
        else if (fl_self_check_has_hard_masks(f->check))
            fl_warnings_add(warnings, file, number, NULL,
                            "shapes that overlap below a mask have a harder edge there");
        warn_of_units(f, s);
        return true;
    }
}

bool fl_survey_frame(const FlRequest *request, FlSurveyFrame *frame, FlStrings *strings,
                     FlWarnings *warnings, GError **error)
{
    *frame = (FlSurveyFrame){.whole = g_strdupv((char **)request->svg.whole)};
    fl_strings_add(strings, "");
    Survey s = {request, frame, warnings};
    g_auto(FlFrameProbe) probe = {0};
    const bool good = scan_frame(&s, &probe, error);
    if (good)
        keep(&probe, strings, frame);
    return good;
}
