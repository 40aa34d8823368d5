#include "drawing/survey.h"

/** The trees of all leaves that are drawn one by one, as texts. */
static GHashTable *single_trees(const FlSurvey *survey)
{
    GHashTable *trees = g_hash_table_new(g_direct_hash, g_direct_equal);
    FL_EACH_PART (survey, t, s)
        if (s->unit == 0)
            g_hash_table_add(trees, GINT_TO_POINTER(s->tree));
    return trees;
}

/** True if a leaf below the group `tree` is drawn by itself in any frame. */
static bool fades_only(const FlSurvey *survey, GHashTable *singles, int tree)
{
    g_autofree char *prefix = g_strconcat(fl_strings_get(&survey->strings, tree), "/", NULL);
    GHashTableIter iter;
    gpointer single;
    g_hash_table_iter_init(&iter, singles);
    while (g_hash_table_iter_next(&iter, &single, NULL))
        if (g_str_has_prefix(fl_strings_get(&survey->strings, GPOINTER_TO_INT(single)), prefix))
            return true;
    return false;
}

/** Keeps one of unit and leaves in a frame. A unit follows its leaves. */
static void choose(const FlSurvey *survey, GHashTable *singles, GHashTable *known, GArray *parts)
{
    guint kept = 0;
    bool leaves_stay = false;
    for (guint i = parts->len; i-- > 0;) { // from the top: the unit first
        FlSurveyPart *s = &g_array_index(parts, FlSurveyPart, i);
        if (s->unit > 0 && s->leaf < 0) {
            gpointer fades = NULL, key = GINT_TO_POINTER(s->tree);
            if (!g_hash_table_lookup_extended(known, key, NULL, &fades)) {
                fades = GINT_TO_POINTER(fades_only(survey, singles, s->tree));
                g_hash_table_insert(known, key, fades);
            }
            const bool has_leaves =
                i > 0 && g_array_index(parts, FlSurveyPart, i - 1).unit == s->unit;
            leaves_stay = fades && has_leaves;
        }
        if (s->unit == 0 || (s->leaf >= 0) == leaves_stay)
            g_array_index(parts, FlSurveyPart, parts->len - ++kept) = *s;
    }
    g_array_remove_range(parts, 0, parts->len - kept);
}

void fl_survey_choose_units(FlSurvey *survey)
{
    g_autoptr(GHashTable) singles = single_trees(survey);
    g_autoptr(GHashTable) known = g_hash_table_new(g_direct_hash, g_direct_equal);
    for (int t = 0; t < survey->n_frames; t++)
        choose(survey, singles, known, survey->frame[t].parts);
}
