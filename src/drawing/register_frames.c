#include "drawing/survey.h"

#include <math.h>

#define PAGE_PX 1000.0  // of the page on which shapes are measured, one user unit a pixel
#define SIZE_PX 0.35    // by how much the size of a shape may differ; files have one decimal
#define MOVE_PX 0.6     // by how much two moves may differ to be one
#define MOST_RESTS 20   // frames after which a shape does not count for more
#define MOST_KNOWN 4000 // shapes that are remembered

/** A shape in its place on the page of the first frame, where it was seen last. */
typedef struct Known {
    FlShape shape;
    int rests; // frames in which it was there before
    bool here; // in this frame
} Known;

/** The place of the frame that a shape votes for, by that where it was. */
typedef struct Vote {
    double x, y, weight;
} Vote;

static bool is_same(const FlShape *a, const FlShape *b)
{
    return a->paint == b->paint && fabs(a->width - b->width) <= SIZE_PX &&
           fabs(a->height - b->height) <= SIZE_PX;
}

/** Shapes that have rested for long count more than those that move, and large ones more than small
 * ones. */
static GArray *votes_of(const GArray *known, const GArray *now)
{
    GArray *votes = g_array_new(FALSE, FALSE, sizeof(Vote));
    for (guint i = 0; i < known->len; i++)
        for (guint j = 0; j < now->len; j++) {
            const Known *k = &g_array_index(known, Known, i);
            const FlShape *a = &k->shape, *b = &g_array_index(now, FlShape, j);
            if (!is_same(a, b))
                continue;
            const double area = (a->width + 1) * (a->height + 1);
            const Vote vote = {a->x - b->x, a->y - b->y, area * (1 + MIN(k->rests, MOST_RESTS))};
            g_array_append_val(votes, vote);
        }
    return votes;
}

/** The nearest to a shape of this frame of all known shapes that the frame has not shown yet. */
static Known *nearest(const GArray *known, const FlShape *shape, double *away)
{
    Known *found = NULL;
    *away = INFINITY;
    FL_EACH (Known, k, known) {
        const double d = hypot(k->shape.x - shape->x, k->shape.y - shape->y);
        if (!k->here && is_same(&k->shape, shape) && d < *away)
            found = k, *away = d;
    }
    return found;
}

/** Notes where the shapes of a frame at `place` are. Those that rest keep their first place, so
 * that errors of frames do not add up. */
static void learn(GArray *known, const GArray *now, const double place[2])
{
    for (guint i = 0; i < known->len; i++)
        g_array_index(known, Known, i).here = false;
    for (guint j = 0; j < now->len; j++) {
        FlShape shape = g_array_index(now, FlShape, j);
        double away;
        shape.x += place[0], shape.y += place[1];
        Known *k = nearest(known, &shape, &away);
        if (k && away <= MOVE_PX)
            k->rests++, k->here = true;
        else if (k)
            *k = (Known){shape, 0, true};
        else if (known->len < MOST_KNOWN)
            g_array_append_val(known, ((Known){shape, 0, true}));
    }
}

static bool agree(const Vote *a, const Vote *b)
{
    return fabs(a->x - b->x) <= MOVE_PX && fabs(a->y - b->y) <= MOVE_PX;
}

static int compare_votes(const void *a, const void *b)
{
    const double d = ((const Vote *)b)->weight - ((const Vote *)a)->weight;
    return d > 0 ? 1 : d < 0 ? -1 : 0;
}

#define MOST_CANDIDATES 500 // the largest shapes decide

/** The place with the most votes; its weight is 0 without votes. */
static Vote decide(GArray *votes)
{
    Vote best = {0};
    g_array_sort(votes, compare_votes);
    for (guint i = 0; i < MIN(votes->len, MOST_CANDIDATES); i++) {
        const Vote *candidate = &g_array_index(votes, Vote, i);
        Vote sum = {0};
        FL_EACH (const Vote, vote, votes) {
            if (!agree(candidate, vote))
                continue;
            sum.x += vote->x * vote->weight, sum.y += vote->y * vote->weight;
            sum.weight += vote->weight;
        }
        if (sum.weight > best.weight)
            best = sum;
    }
    if (best.weight > 0)
        best.x /= best.weight, best.y /= best.weight;
    return best;
}

/** Widens the page, in the first frame's units, by the shapes of a frame that lies at x, y. */
static void widen(FlCanvas *page, const GArray *shapes, double x, double y, bool *any)
{
    FL_EACH (const FlShape, box, shapes) {
        const double x0 = floor(box->x + x), x1 = ceil(box->x + x + box->width);
        const double y0 = floor(box->y + y), y1 = ceil(box->y + y + box->height);
        if (!*any)
            *page = (FlCanvas){x0, y0, x1 - x0, y1 - y0};
        const double right = MAX(page->x + page->width, x1);
        const double bottom = MAX(page->y + page->height, y1);
        page->x = MIN(page->x, x0), page->y = MIN(page->y, y0);
        page->width = right - page->x, page->height = bottom - page->y;
        *any = true;
    }
}

/** The place of each frame, as pairs x, y; the page that holds all goes to *page. */
static double *places_of(FlSurvey *survey, FlCanvas *page, FlWarnings *warnings, GError **error)
{
    g_autofree double *place = g_new0(double, 2 * (gsize)survey->n_frames);
    g_autoptr(GArray) known = g_array_new(FALSE, FALSE, sizeof(Known));
    bool any = false, good = true;
    for (int t = 0; t < survey->n_frames; t++) {
        const char *file = survey->sequence->frame[t].file;
        const int number = survey->sequence->frame[t].number;
        FlPageMeasures measures;
        if (!fl_survey_measure(survey, t, &(FlCanvas){0, 0, PAGE_PX, PAGE_PX}, true, &measures,
                               good ? error : NULL)) {
            good = false;
            if (survey->options->frames.missing > FL_MISSING_ERROR)
                continue; // all bad frames are left out together
            return NULL;
        }
        g_autoptr(GArray) now = measures.shapes;
        g_autoptr(GArray) votes = votes_of(known, now);
        const Vote found = decide(votes);
        double *own = &place[2 * t];
        if (known->len > 0 && now->len > 0 && found.weight <= 0)
            fl_warnings_add(warnings, file, number, NULL,
                            "no shape in common with the frames before: not moved by ‘register’");
        for (int c = 0; c < 2 && t > 0; c++)
            own[c] = found.weight > 0 ? (c ? found.y : found.x) : own[c - 2];
        widen(page, now, own[0], own[1], &any);
        learn(known, now, own);
    }
    return good ? g_steal_pointer(&place) : NULL;
}

bool fl_register(FlSurvey *survey, FlWarnings *warnings, GError **error)
{
    FlCanvas page = {0, 0, 1, 1};
    g_autofree double *place = places_of(survey, &page, warnings, error);
    if (!place)
        return false;
    if (survey->options->canvas.width > 0)
        page = survey->options->canvas;
    for (int t = 0; t < survey->n_frames; t++)
        survey->frame[t].canvas =
            (FlCanvas){page.x - place[2 * t], page.y - place[2 * t + 1], page.width, page.height};
    return true;
}
