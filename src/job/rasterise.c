#include "job/region_plan.h"

#include "base/error.h"
#include "cover/cover_map.h"
#include <fluidy/render.h>
#include <stdatomic.h>

#define LARGE_PX 3000000

double fl_shapes_share_of_page(const FlShapes *shapes, int region)
{
    const FlRegion *r = fl_drawing_region(shapes->drawing, region);
    const double page = (double)shapes->page_width * shapes->page_height;
    return r->area_px * r->n_present / MAX(shapes->n_frames, 1) / page;
}

bool fl_shapes_are_large(const FlShapes *shapes)
{
    return (size_t)shapes->page_width * (size_t)shapes->page_height > LARGE_PX;
}

double fl_shapes_least_bytes(const FlShapes *shapes)
{
    const double pixels = (double)shapes->page_width * shapes->page_height;
    return 50e6 + 30 * pixels; // measured: the libraries, paper, a frame
}

/* Notes the edges that regions of a frame share. */
static bool note_edges(FlShapes *shapes, FlNeighbours *neighbours, int frame, GError **error)
{
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(shapes->drawing, frame, error);
    if (draws)
        fl_neighbours_note(neighbours, draws, shapes->edge_limits);
    return draws;
}

/* Shapes that are held longer than others are shown below those of later frames. */
static bool all_hold_alike(const FlShapes *shapes)
{
    for (int r = 0; r < fl_drawing_regions(shapes->drawing); r++)
        if (shapes->hold_of[r] != shapes->hold)
            return false;
    return true;
}

bool fl_shapes_hide(const FlShapes *shapes, int region)
{
    return shapes->seen && !shapes->seen[region];
}

static void begin_visible_regions(FlShapes *shapes)
{
    const int n = fl_drawing_regions(shapes->drawing);
    g_clear_pointer(&shapes->seen, g_free);
    if (!shapes->frames_alone || !all_hold_alike(shapes))
        return;
    shapes->seen = g_new(bool, MAX(n, 1));
    for (int r = 0; r < n; r++)
        shapes->seen[r] = shapes->painted_of[r] < 0;
}

/* True if some of every region has been seen, or if this is not asked for. */
static bool all_seen(const FlShapes *shapes)
{
    for (int p = 0; p < shapes->n_painted && shapes->seen; p++)
        if (!__atomic_load_n(&shapes->seen[shapes->painted[p].region], __ATOMIC_RELAXED))
            return false;
    return true;
}

/* Every style's rim, and a pixel where drafts are enlarged. */
static bool note_visible_regions(const FlShapes *shapes, const FlDrawList *draws, GError **error)
{
    if (all_seen(shapes))
        return true;
    const int n_regions = fl_drawing_regions(shapes->drawing);
    g_autofree bool *sheer = g_new(bool, MAX(n_regions, 1));
    FlHiding hiding = {.sheer = sheer, .rim_px = 1};
    for (int r = 0; r < n_regions; r++)
        sheer[r] = shapes->edge_limits[r] != FL_EDGE_ADJACENT;
    for (int p = 0; p < shapes->n_painted; p++)
        hiding.rim_px = MAX(hiding.rim_px, (int)(shapes->painted[p].style->border_px + 0.5f) + 1);
    return fl_cover_note_seen(draws, shapes->width, shapes->height, hiding, shapes->seen, error);
}

/* Looks what a frame shows, unless something of every region was seen before. */
static bool look(FlShapes *shapes, FlNeighbours *neighbours, int frame, GError **error)
{
    if (all_seen(shapes))
        return true;
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(shapes->drawing, frame, error);
    return draws && note_visible_regions(shapes, draws, error);
}

/* Stores the masks of all painted regions in a frame, and what is around them. */
static bool store_masks(FlShapes *shapes, FlNeighbours *neighbours, int frame, GError **error)
{
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(shapes->drawing, frame, error);
    return draws && note_visible_regions(shapes, draws, error) &&
           fl_surround_put(shapes->surround, frame, draws, shapes->edge_limits, shapes->painted_of,
                           shapes->ground, neighbours, error);
}

/* A pass over all frames. */
typedef struct Pass {
    FlShapes *shapes;
    const FlCaller *caller;
    FlNeighbours *neighbours;
    bool (*work)(FlShapes *, FlNeighbours *, int, GError **);
    double before, share; // of this stage: done in earlier passes, and this one's
    atomic_int done;      // frames
    GThread *thread;      // the thread that tells the progress
} Pass;

static bool tell_masks(Pass *pass, int frame, GError **error)
{
    const FlShapes *shapes = pass->shapes;
    const FlCaller *caller = pass->caller;
    const int frames = shapes->n_frames;
    const int done = atomic_fetch_add(&pass->done, 1) + 1;
    if (!caller->progress || g_thread_self() != pass->thread)
        return true;
    const FlProgress progress = {.stage = "masks",
                                 .region_index = -1,
                                 .n_regions = shapes->n_painted,
                                 .frame = fl_drawing_number(shapes->drawing, frame),
                                 .done = (int)(pass->before * frames + pass->share * done),
                                 .total = frames,
                                 .elapsed_s = fl_seconds_since(caller->start),
                                 .remaining_s = -1};
    if (caller->progress(&progress, caller->data))
        return true;
    return fl_fail(error, FL_ERROR_INTERRUPTED, "interrupted before the first frame");
}

static bool each_frame(Pass *pass, GError **error)
{
    const int n = pass->shapes->n_frames;
    GError *first = NULL;
    int failed = 0;
#pragma omp parallel for schedule(dynamic, 1) reduction(+ : failed)
    for (int f = 0; f < n; f++) {
        GError *failure = NULL;
        if (failed == 0 && !(pass->work(pass->shapes, pass->neighbours, f, &failure) &&
                             tell_masks(pass, f, &failure)))
            failed++;
        fl_parallel_error_keep(&first, failure);
    }
    return fl_parallel_error_propagate(error, first);
}

bool fl_shapes_rasterise(FlShapes *shapes, const FlCaller *caller, GError **error)
{
    g_autoptr(FlNeighbours) neighbours = fl_neighbours_new(fl_drawing_regions(shapes->drawing));
    const bool alone = fl_drawing_regions(shapes->drawing) < 2;
    begin_visible_regions(shapes);
    const double share = alone ? 1 : .5;
    Pass note = {shapes, caller, neighbours, note_edges, 0, share, 0, g_thread_self()};
    Pass store = {shapes, caller, neighbours, store_masks, 1 - share, share, 0, g_thread_self()};
    shapes->rasterised = (alone || each_frame(&note, error)) && each_frame(&store, error);
    return shapes->rasterised;
}

bool fl_shapes_find_hidden(FlShapes *shapes, const FlCaller *caller, GError **error)
{
    Pass pass = {shapes, caller, NULL, look, 0, 1, 0, g_thread_self()};
    begin_visible_regions(shapes);
    return !shapes->seen || each_frame(&pass, error);
}
