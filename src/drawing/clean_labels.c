#include "drawing/region_identity.h"

#include <string.h>

/*
 * Blender writes id="blender_frame_17" in frame 17. A number in a label counts as the frame's if
 * the label occurs in two frames or more, with one number in each and another in every next one.
 * "snow 9" beside "snow 8", and "arm 2" in all frames, keep theirs.
 */
typedef struct Stem {
    int frame; // last one it occurs in
    int number;
    int n_frames;
    bool steady; // not a frame number
} Stem;

/** The label with its last run of digits replaced by '#'; NULL if it has no digits. */
static char *stem_of(const char *label, int *number)
{
    size_t end = strlen(label);
    while (end > 0 && !g_ascii_isdigit(label[end - 1]))
        end--;
    size_t begin = end;
    while (begin > 0 && g_ascii_isdigit(label[begin - 1]))
        begin--;
    if (begin == end || end - begin > 9)
        return NULL;
    *number = (int)g_ascii_strtoll(label + begin, NULL, 10);
    return g_strdup_printf("%.*s#%s", (int)begin, label, label + end);
}

static void note(GHashTable *stems, const char *label, int t, bool held)
{
    int number = 0;
    g_autofree char *name = stem_of(label, &number);
    if (!name || held)
        return;
    Stem *stem = g_hash_table_lookup(stems, name);
    if (!stem) {
        stem = g_new(Stem, 1);
        *stem = (Stem){t, number, 1, false};
        g_hash_table_insert(stems, g_steal_pointer(&name), stem);
        return;
    }
    const bool same = stem->number == number;
    stem->steady |= (stem->frame == t) != same;
    stem->n_frames += stem->frame != t;
    stem->frame = t;
    stem->number = number;
}

static char *clean(GHashTable *stems, const char *labels)
{
    GString *out = g_string_new(NULL);
    g_auto(GStrv) items = g_strsplit(labels, "\n", -1);
    for (int i = 0; items[i]; i++) {
        int number = 0;
        g_autofree char *name = stem_of(items[i], &number);
        const Stem *stem = name ? g_hash_table_lookup(stems, name) : NULL;
        const bool numbered = stem && !stem->steady && stem->n_frames >= 2;
        const char *label = numbered ? g_strstrip(g_strdelimit(name, "#", ' ')) : items[i];
        if (label[0])
            g_string_append_printf(out, "%s%s", out->len ? "\n" : "", label);
    }
    return g_string_free(out, FALSE);
}

static void note_frame(const FlSurvey *survey, int t, GHashTable *stems)
{
    const GArray *parts = survey->frame[t].parts;
    const bool held = t > 0 && fl_sequence_same(survey->sequence, t, t - 1);
    for (guint i = 0; i < parts->len; i++) {
        const int labels = g_array_index(parts, FlSurveyPart, i).labels;
        if (i > 0 && labels == g_array_index(parts, FlSurveyPart, i - 1).labels)
            continue;
        g_auto(GStrv) items = g_strsplit(fl_strings_get(&survey->strings, labels), "\n", -1);
        for (int k = 0; items[k]; k++)
            note(stems, items[k], t, held);
    }
}

int *fl_clean_labels(FlSurvey *survey)
{
    g_autoptr(GHashTable) stems = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
    for (int t = 0; t < survey->n_frames; t++)
        note_frame(survey, t, stems);
    const int n = (int)survey->strings.text->len;
    int *cleaned = g_new(int, n);
    for (int i = 0; i < n; i++) {
        g_autofree char *text = clean(stems, fl_strings_get(&survey->strings, i));
        cleaned[i] = fl_strings_add(&survey->strings, text);
    }
    return cleaned;
}
