#include "render/edges.h"

#include "base/alloc.h"
#include "compose/closing.h"

#define SHOWN 128      // coverage from which on a shape is uppermost
#define TRAP_PX 4      // neighbours overlap by so much at most where a program traps them
#define MOST_RUNS 4095 // whose overlaps are known

/** Whether a run hides what it lies over. Shading does not: the edges below it are seen. */
static bool hides(const FlPlan *plan, const FlRun *run)
{
    const bool painted = plan->painter_of[run->region] >= 0;
    return run->mix == FL_MIX_OVER && run->alpha >= SHOWN && (painted || run->alpha == 255);
}

/** Whether a shape holds the corners of a square of TRAP_PX from pixel i on. */
static bool holds_square(const uint8_t *coverage, size_t i, size_t width)
{
    const size_t down = i + TRAP_PX * width;
    return coverage[i] >= SHOWN && coverage[i + TRAP_PX] >= SHOWN && coverage[down] >= SHOWN &&
           coverage[down + TRAP_PX] >= SHOWN;
}

/** The run that is uppermost at all of these corners; 0: none. */
static uint16_t top_of_square(const uint16_t *top, size_t i, size_t width)
{
    const size_t down = i + TRAP_PX * width;
    const bool same =
        top[i + TRAP_PX] == top[i] && top[down] == top[i] && top[down + TRAP_PX] == top[i];
    return same ? top[i] : 0;
}

/** Notes which runs a run, put over those below it, overlaps in some square of TRAP_PX. */
static void note_overlaps(FlEdgeMap *edges, int run)
{
    const FlBox *box = &edges->boxes[run];
    const uint8_t *coverage = edges->runs->run[run].coverage;
    const size_t width = (size_t)fl_film_width(edges->plan->film), n = (size_t)edges->n;
    for (int y = box->y; y < box->y + box->height - TRAP_PX; y++) {
        const size_t row = (size_t)y * width + (size_t)box->x;
        for (size_t i = row; i + TRAP_PX < row + (size_t)box->width; i++) {
            if (!holds_square(coverage, i, width))
                continue;
            const size_t other = top_of_square(edges->top, i, width), own = (size_t)run + 1;
            edges->overlap[own * n + other] = edges->overlap[other * n + own] = true;
        }
    }
}

static void put_on_top(FlEdgeMap *edges, int run)
{
    const FlBox *box = &edges->boxes[run];
    const FlRun *r = &edges->runs->run[run];
    const size_t width = (size_t)fl_film_width(edges->plan->film);
    for (int y = box->y; y < box->y + box->height; y++) {
        const size_t row = (size_t)y * width + (size_t)box->x;
        for (size_t i = row; i < row + (size_t)box->width; i++)
            if (r->coverage[i] >= SHOWN)
                edges->top[i] = (uint16_t)(run + 1);
    }
}

bool fl_edges_init(FlEdgeMap *edges, const FlPlan *plan, const FlRuns *runs, const FlBox *boxes,
                   GError **error)
{
    const size_t pixels = (size_t)fl_film_width(plan->film) * (size_t)fl_film_height(plan->film);
    *edges = (FlEdgeMap){.plan = plan, .runs = runs, .boxes = boxes};
    edges->n = MIN(runs->n, MOST_RUNS) + 1;
    const size_t pairs = (size_t)edges->n * (size_t)edges->n;
    if (!(edges->top = fl_alloc(pixels, sizeof *edges->top, "a matte", error)) ||
        !(edges->overlap = fl_alloc(pairs, sizeof *edges->overlap, "a matte", error)))
        return false;
    for (int r = 0; r < edges->n - 1; r++) {
        note_overlaps(edges, r);
        if (hides(plan, &runs->run[r]))
            put_on_top(edges, r);
    }
    return true;
}

void fl_edges_clear(FlEdgeMap *edges)
{
    free(edges->top);
    free(edges->overlap);
    *edges = (FlEdgeMap){0};
}

/** The share of the edges of a run, with all others or with those that it does not overlap; others:
 * room for a frame. */
static bool find_share(const FlEdgeMap *edges, int run, bool with_all, int radius_px,
                       uint8_t *others, uint8_t *share, GError **error)
{
    const FlBox *box = &edges->boxes[run];
    const uint8_t *coverage = edges->runs->run[run].coverage;
    const bool *overlap = edges->overlap + (size_t)(run + 1) * (size_t)edges->n;
    const int width = fl_film_width(edges->plan->film);
    const int height = fl_film_height(edges->plan->film);
    const int x0 = MAX(box->x - radius_px, 0), x1 = MIN(box->x + box->width + radius_px, width);
    const int y0 = MAX(box->y - radius_px, 0), y1 = MIN(box->y + box->height + radius_px, height);
    for (int y = y0; y < y1; y++) {
        const size_t row = (size_t)y * (size_t)width;
        for (size_t i = row + (size_t)x0; i < row + (size_t)x1; i++) {
            const uint16_t top = edges->top[i];
            const bool other = top && top != run + 1 && (with_all || !overlap[top]);
            others[i] = other ? 255 : 0;
        }
    }
    return fl_closing_share(coverage, others, width, height, *box, radius_px, share, error);
}

/** Whether a run is seen at pixel i: nothing that hides it lies over it. */
static bool is_seen(const FlEdgeMap *edges, int run, size_t i)
{
    return edges->runs->run[run].coverage[i] >= SHOWN && edges->top[i] <= run + 1;
}

/** 0 where a run is seen, else -1; of the run's box, to be freed with free(). */
static int16_t *find_seen(const FlEdgeMap *edges, int run, GError **error)
{
    const FlBox *box = &edges->boxes[run];
    const size_t width = (size_t)fl_film_width(edges->plan->film);
    int16_t *seen = fl_alloc(fl_box_pixels(*box), sizeof *seen, "a matte", error);
    for (int y = 0; seen && y < box->height; y++) {
        const size_t row = (size_t)(box->y + y) * width + (size_t)box->x;
        for (int x = 0; x < box->width; x++)
            seen[(size_t)y * (size_t)box->width + (size_t)x] =
                is_seen(edges, run, row + (size_t)x) ? 0 : -1;
    }
    return seen;
}

bool fl_edges_close(const FlEdgeMap *edges, int run, const FlPainter *painter, int16_t *amounts,
                    GError **error)
{
    const FlTreatment *t = &painter->treatment;
    const FlRenderOptions *options = &edges->plan->options;
    const FlBox box = edges->boxes[run];
    const size_t n = fl_box_pixels(box);
    const size_t pixels =
        (size_t)fl_film_width(edges->plan->film) * (size_t)fl_film_height(edges->plan->film);
    if (t->edges == FL_EDGES_SOFT || t->stacking == FL_STACKING_GLAZE || options->gap > 0 ||
        options->feather > 0 || n == 0 || run >= edges->n - 1)
        return true;
    const float border = painter->box->exemplar->border_px;
    const int radius = CLAMP((int)(border + 0.5f), 2, FL_CLOSING_MAX_PX);
    g_autofree uint8_t *ends = fl_alloc(n, 1, "a matte", error);
    g_autofree uint8_t *meets = ends ? fl_alloc(n, 1, "a matte", error) : NULL;
    g_autofree int16_t *seen = meets ? find_seen(edges, run, error) : NULL;
    g_autofree uint8_t *others = seen ? fl_alloc(pixels, 1, "a matte", error) : NULL;
    return others && find_share(edges, run, false, radius, others, ends, error) &&
           find_share(edges, run, true, radius, others, meets, error) &&
           fl_closing_apply(amounts, seen, ends, meets, box, radius, error);
}

/** Whether a run is seen at a pixel and 2 px around it. */
static bool is_inside(const FlEdgeMap *edges, int run, int x, int y)
{
    enum { MARGIN_PX = 2 };
    const int width = fl_film_width(edges->plan->film);
    const int height = fl_film_height(edges->plan->film);
    for (int dy = -MARGIN_PX; dy <= MARGIN_PX; dy += MARGIN_PX)
        for (int dx = -MARGIN_PX; dx <= MARGIN_PX; dx += MARGIN_PX) {
            const int xx = CLAMP(x + dx, 0, width - 1), yy = CLAMP(y + dy, 0, height - 1);
            if (!is_seen(edges, run, (size_t)yy * width + xx))
                return false;
        }
    return true;
}

void fl_edges_level(const FlEdgeMap *edges, int run, int16_t *amounts)
{
    const FlBox box = edges->boxes[run];
    g_autofree FlAmountCounts *counts = g_new0(FlAmountCounts, 1);
    for (int y = 0; y < box.height; y++)
        for (int x = 0; x < box.width; x++) {
            const int amount = amounts[(size_t)y * box.width + x];
            if (amount >= 0 && is_inside(edges, run, box.x + x, box.y + y))
                counts->count[amount]++, counts->total++;
        }
    const int tone = CLAMP(fl_counts_tone(counts), FL_TONE_ONE * 2 / 3, FL_TONE_ONE * 3 / 2);
    for (size_t i = 0; i < fl_box_pixels(box); i++)
        if (amounts[i] > 0)
            amounts[i] = (int16_t)MIN(amounts[i] * tone / FL_TONE_ONE, FL_AMOUNTS - 1);
}
