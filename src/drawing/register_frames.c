#include "drawing/survey.h"

#include <math.h>
#include <string.h>

#define PAGE_PX 1000.0 // of the page on which shapes are measured, one user unit a pixel
#define SIZE_PX 0.35   // by how much the size of a shape may differ; files have one decimal
#define MOVE_PX 0.6    // by how much two moves may differ to be one

/** The move that a pair of shapes votes for. */
typedef struct Vote {
    double x, y, weight;
} Vote;

static GArray *votes_of(const GArray *before, const GArray *now)
{
    GArray *votes = g_array_new(FALSE, FALSE, sizeof(Vote));
    for (guint i = 0; i < before->len; i++)
        for (guint j = 0; j < now->len; j++) {
            const FlShape *a = &g_array_index(before, FlShape, i),
                          *b = &g_array_index(now, FlShape, j);
            if (a->paint != b->paint || fabs(a->width - b->width) > SIZE_PX ||
                fabs(a->height - b->height) > SIZE_PX)
                continue;
            const Vote vote = {a->x - b->x, a->y - b->y, (a->width + 1) * (a->height + 1)};
            g_array_append_val(votes, vote);
        }
    return votes;
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

/** The move with the most votes; its weight is 0 without votes. */
static Vote decide(GArray *votes)
{
    Vote best = {0};
    g_array_sort(votes, compare_votes);
    for (guint i = 0; i < MIN(votes->len, MOST_CANDIDATES); i++) {
        const Vote *candidate = &g_array_index(votes, Vote, i);
        Vote sum = {0};
        for (guint j = 0; j < votes->len; j++) {
            const Vote *vote = &g_array_index(votes, Vote, j);
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
    for (guint i = 0; i < shapes->len; i++) {
        const FlShape *box = &g_array_index(shapes, FlShape, i);
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
    g_autoptr(GArray) before = NULL;
    bool any = false, good = true;
    for (int t = 0; t < survey->n_frames; t++) {
        const char *file = survey->sequence->file[t];
        const int number = survey->sequence->number[t];
        FlPageMeasures measures;
        if (!fl_survey_measure(survey, t, &(FlCanvas){0, 0, PAGE_PX, PAGE_PX}, true, &measures,
                               good ? error : NULL)) {
            good = false;
            if (survey->options->missing > FL_MISSING_ERROR)
                continue; // all bad frames are left out together
            return NULL;
        }
        g_autoptr(GArray) now = measures.shapes;
        g_autoptr(GArray) votes = before ? votes_of(before, now) : NULL;
        const Vote move = votes ? decide(votes) : (Vote){0};
        if (votes && before->len > 0 && now->len > 0 && move.weight <= 0)
            fl_warnings_add(warnings, file, number, NULL,
                            "no shape in common with the frame before: not moved by ‘register’");
        for (int c = 0; c < 2 && t > 0; c++)
            place[2 * t + c] = place[2 * (t - 1) + c] + (c ? move.y : move.x);
        widen(page, now, place[2 * t], place[2 * t + 1], &any);
        if (now->len > 0 || !before) { // an empty frame is stepped over
            g_clear_pointer(&before, g_array_unref);
            before = g_steal_pointer(&now);
        }
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
