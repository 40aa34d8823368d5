#include "drawing/region_identity.h"

#define DEEPEST 15
#define TOO_MANY 600 // leaves in a frame; the search is cubic
#define LARGE 0.004f // share of the page from which on an inner leaf counts; not a glint in an eye
#define INSIDE 0.95f // share of a leaf's box that lies in the box of the one it is in
#define ALWAYS 0.9f  // share of its frames in which a track has the same depth
#define MOSTLY 0.5f  // share of all frames that a track is in

static float area(const float b[4])
{
    return (b[2] - b[0]) * (b[3] - b[1]);
}

static bool lies_in(const FlSurveyPart *inner, const FlSurveyPart *outer)
{
    const float *a = inner->box, *b = outer->box;
    const float w = MIN(a[2], b[2]) - MAX(a[0], b[0]), h = MIN(a[3], b[3]) - MAX(a[1], b[1]);
    return w > 0 && h > 0 && w * h >= INSIDE * area(a);
}

static bool same_kind(const FlSurveyPart *a, const FlSurveyPart *b, const int *label_of)
{
    return a->paint == b->paint && a->stroke == b->stroke &&
           label_of[a->labels] == label_of[b->labels];
}

/** True if something of another paint lies between leaves j < i of a frame and under all of i. */
static bool is_parted(const FlSurveyPart *part, int j, int i, const int *label_of)
{
    for (int k = j + 1; k < i; k++)
        if (!same_kind(&part[k], &part[i], label_of) && lies_in(&part[i], &part[k]))
            return true;
    return false;
}

static void find_levels(const GArray *frame, const int *label_of, float least, int *level)
{
    const FlSurveyPart *part = (const FlSurveyPart *)frame->data;
    for (int i = 0; i < (int)frame->len; i++) {
        level[i] = 0;
        for (int j = 0; j < i && part[i].area_px >= least; j++)
            if (level[j] >= level[i] && level[j] < DEEPEST &&
                same_kind(&part[i], &part[j], label_of) && lies_in(&part[i], &part[j]) &&
                is_parted(part, j, i, label_of))
                level[i] = level[j] + 1;
    }
}

void fl_find_nesting(const FlSurvey *survey, const int *label_of, GArray *tracks)
{
    const float least = LARGE * (float)survey->width * (float)survey->height;
    int(*count)[DEEPEST + 1] = g_malloc0_n((gsize)tracks->len + 1, sizeof *count);
    for (int t = 0; t < survey->n_frames; t++) {
        const GArray *frame = survey->frame[t].parts;
        g_autofree int *level = g_new0(int, frame->len + 1);
        if (frame->len <= TOO_MANY)
            find_levels(frame, label_of, least, level);
        for (guint i = 0; i < frame->len; i++)
            count[g_array_index(frame, FlSurveyPart, i).nth][level[i]]++;
    }
    for (guint k = 0; k < tracks->len; k++) {
        int best = 1, nested = 0;
        for (int l = 1; l <= DEEPEST; l++) {
            nested += count[k][l];
            best = count[k][l] > count[k][best] ? l : best;
        }
        const int frames = nested + count[k][0];
        if ((float)nested >= ALWAYS * (float)frames &&
            (float)frames >= MOSTLY * (float)survey->n_frames)
            g_array_index(tracks, FlTrack, k).depth = best; // the most frequent
    }
    g_free(count);
}
