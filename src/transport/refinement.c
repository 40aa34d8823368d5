#include "transport/refinement.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "base/state_bytes.h"
#include "transport/solve.h"
#include <assert.h>
#include <math.h>
#include <string.h>

#define FIRST 10     // times the iterations of a later frame
#define NEW 0.4f     // of what is shown in a frame that moves; the rest is carried
#define MOVING 0.25f // px of the style, from where on a frame is refined in full
#define ROOM 4       // px of the style around a region
#define FARTHEST 1e7f

void fl_refinement_clear(FlRefinement *refinement)
{
    free(refinement->potential);
    free(refinement->shown);
    *refinement = (FlRefinement){0};
}

/* A frame on its region plane. */
typedef struct Frame {
    const FlRefinementInput *input;
    const FlMaterialLayers *layers;
    const FlGuides *guides;
    FlRegionPlane plane;
    float *coverage, *taper, *density; // by pixel of the plane; density NULL: flat
    float *velocity;                   // 2 by pixel: without the refinement
    float *before, *shown;             // carried from the last frame
} Frame;

static void frame_clear(Frame *frame)
{
    free(frame->coverage), free(frame->taper), free(frame->density), free(frame->velocity);
    free(frame->before), free(frame->shown);
}
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Frame, frame_clear)

static bool frame_init(Frame *frame, const FlRefinementInput *input, const FlMaterialLayers *layers,
                       const FlGuides *guides, GError **error)
{
    *frame = (Frame){.input = input, .layers = layers, .guides = guides};
    frame->plane = fl_region_plane(layers, guides, input->scale, ROOM);
    const size_t n = fl_rect_pixels(frame->plane.box);
    return (frame->coverage = fl_alloc(n, sizeof(float), "a coverage", error)) &&
           (frame->taper = fl_alloc(n, sizeof(float), "a taper", error)) &&
           (frame->velocity = fl_alloc(2 * n, sizeof(float), "a velocity", error)) &&
           (frame->before = fl_alloc(n, sizeof(float), "a potential", error)) &&
           (frame->shown = fl_alloc(n, sizeof(float), "a potential", error)) &&
           (input->style->density == FL_DENSITY_FLAT ||
            (frame->density = fl_alloc(n, sizeof(float), "a density", error)));
}

/* The alignment of the pattern at a pixel with the plane, 0..1: a turned pattern would be bent
 * back, and is therefore not refined. Smooth: 1 up to 15 degrees, 0 from 35; of two layers by how
 * much each is seen. */
static float aligned(const Frame *frame, const FlFour *four)
{
    const FlMaterialLayers *layers = frame->layers;
    const FlRect r = layers->old.rect;
    const FlRigid *lies = &frame->plane.lies;
    const size_t p = four->p[0];
    float weight[2], sum = 0;
    fl_material_layers_weights(layers, p, &weight[0], &weight[1]);
    for (int l = 0; l < 2; l++) {
        float f[2][2];
        if (weight[l] <= 0)
            continue;
        fl_material_gradient(l == 0 ? &layers->old : &layers->fresh, (int)(p % (size_t)r.width),
                             (int)(p / (size_t)r.width), f);
        const float a = f[0][0] + f[1][1], b = f[1][0] - f[0][1];
        const float along = a * (float)lies->cosine + b * (float)lies->sine;
        const float t = (along / fmaxf(hypotf(a, b), 1e-6f) - 0.82f) / (0.966f - 0.82f);
        const float held = fminf(fmaxf(t, 0), 1);
        sum += weight[l] * weight[l] * held * held * (3 - 2 * held);
    }
    return sum;
}

static void read_pixel(const Frame *frame, int x, int y, const float *velocity)
{
    const FlRect r = frame->layers->old.rect, b = frame->plane.box;
    const size_t p = (size_t)y * (size_t)b.width + (size_t)x;
    const FlTransportStyle *style = frame->input->style;
    float at[2];
    fl_region_plane_to_frame(&frame->plane, x, y, at);
    const float depth = fl_region_plane_depth(&frame->plane, frame->guides, r, at[0], at[1]);
    frame->coverage[p] = fminf(fmaxf(depth + 0.5f, 0), 1);
    frame->taper[p] = fl_smooth(depth / style->taper_px);
    if (frame->density)
        frame->density[p] =
            depth > 0 ? fl_ring_density(depth / style->ring_px + 0.25f, style->ring_px) : 1;
    if (depth <= 0)
        return;
    const FlFour four = fl_four_around(at[0] - (float)r.x, at[1] - (float)r.y, r.width, r.height);
    const float v[2] = {fl_mean_of_four(velocity, 2, &four),
                        fl_mean_of_four(velocity + 1, 2, &four)};
    fl_region_plane_turn(&frame->plane, v, frame->velocity + 2 * p);
    const float share = aligned(frame, &four);
    frame->coverage[p] *= share, frame->taper[p] *= share;
}

static void read_frame(const Frame *frame, const float *velocity)
{
    for (int y = 0; y < frame->plane.box.height; y++)
        for (int x = 0; x < frame->plane.box.width; x++)
            read_pixel(frame, x, y, velocity);
}

/* ---- carrying ----------------------------------------------------------------------------------
 */

/* Pixels beyond the plane repeat its nearest pixel. */
static float sample(const float *plane, int width, int height, float x, float y)
{
    return fl_cubic_sample(plane, width, height, fminf(fmaxf(x, 0), (float)(width - 1)),
                           fminf(fmaxf(y, 0), (float)(height - 1)));
}

/* The last frame's potentials where the drawing has moved to. */
static void carry(const Frame *frame, const FlRefinement *last)
{
    const FlRect b = frame->plane.box, before = last->plane.box, r = frame->layers->old.rect;
    const float *motion = frame->layers->motion.shift;
    for (int y = 0; y < b.height; y++)
        for (int x = 0; x < b.width; x++) {
            const size_t p = (size_t)y * (size_t)b.width + (size_t)x;
            float at[2];
            fl_region_plane_to_frame(&frame->plane, x, y, at);
            const FlFour four =
                fl_four_around(at[0] - (float)r.x, at[1] - (float)r.y, r.width, r.height);
            const float dx = fl_mean_of_four(motion, 2, &four);
            const float dy = fl_mean_of_four(motion + 1, 2, &four);
            fl_region_plane_from_frame(&last->plane, at[0] - dx, at[1] - dy, at);
            frame->before[p] = sample(last->potential, before.width, before.height, at[0], at[1]);
            frame->shown[p] = sample(last->shown, before.width, before.height, at[0], at[1]);
        }
}

/* The share of a frame's refinement that is made, 0..1: 1 while the region moves, 0 at rest. */
static float share_of_motion(const Frame *frame)
{
    const float *motion = frame->layers->motion.shift;
    const size_t n = fl_rect_pixels(frame->layers->old.rect);
    float farthest = 0;
    for (size_t p = 0; p < n; p++)
        farthest = fmaxf(farthest, hypotf(motion[2 * p], motion[2 * p + 1]));
    return fminf(farthest / (MOVING * frame->input->scale), 1);
}

/* ---- refining ---------------------------------------------------------------------------------
 */

/* Adds to `before` what the style asks for. */
static bool refine(Frame *frame, int iterations, float share, GError **error)
{
    const FlRect b = frame->plane.box;
    const size_t n = fl_rect_pixels(b);
    const FlTransportStyle *style = frame->input->style;
    g_auto(FlPotential) more = {0};
    g_autofree float *sum = fl_alloc(n, sizeof *sum, "a potential", error);
    const FlTransportProblem problem = {.width = b.width,
                                        .height = b.height,
                                        .style = frame->input->patches,
                                        .density = frame->density,
                                        .coverage = frame->coverage,
                                        .taper = frame->taper,
                                        .velocity = frame->velocity,
                                        .before = frame->before,
                                        .mode = style->mode,
                                        .pace = share * style->pace,
                                        .key = frame->input->seed};
    if (!sum || !fl_potential_init(&more, b.width, b.height, error) ||
        !fl_transport_refine(&problem, iterations, &more, error))
        return false;
    fl_potential_sum(&more, sum);
    for (size_t p = 0; p < n; p++)
        frame->before[p] += sum[p];
    return true;
}

static bool next(FlRefinement *refinement, Frame *frame, GError **error)
{
    const size_t n = fl_rect_pixels(frame->plane.box);
    const bool first = !refinement->potential;
    const float share = first ? 1 : share_of_motion(frame);
    const bool rests = share == 0 && fl_region_plane_same(&refinement->plane, &frame->plane);
    if (!first && !rests)
        carry(frame, refinement);
    if (rests)
        return true;
    if (share > 0 && !refine(frame, (first ? FIRST : 1) * frame->input->iterations, share, error))
        return false;
    for (size_t p = 0; p < n; p++)
        frame->shown[p] =
            first ? frame->before[p]
                  : frame->shown[p] + share * NEW * (frame->before[p] - frame->shown[p]);
    fl_refinement_clear(refinement);
    *refinement = (FlRefinement){frame->plane, g_steal_pointer(&frame->before),
                                 g_steal_pointer(&frame->shown)};
    return true;
}

/* The velocity of what is shown, tapered in the plane. */
static bool add_shown(const FlRefinement *refinement, const Frame *frame, float *velocity,
                      GError **error)
{
    const FlRect b = frame->plane.box, rect = frame->layers->old.rect;
    const FlFlowMap of_plane = {.width = b.width, .height = b.height};
    const size_t n = 2 * fl_rect_pixels(rect);
    g_autofree float *added = fl_alloc(n, sizeof *added, "a velocity", error);
    if (!added)
        return false;
    fl_velocity(&of_plane, refinement->shown, frame->taper, frame->input->style->mode,
                frame->velocity);
    fl_region_plane_velocity(&frame->plane, frame->velocity, rect, added);
    for (size_t i = 0; i < n; i++)
        velocity[i] += added[i];
    return true;
}

bool fl_refinement_advance(FlRefinement *refinement, const FlRefinementInput *input,
                           const FlMaterialLayers *layers, const FlGuides *guides, float *velocity,
                           GError **error)
{
    g_auto(Frame) frame = {0};
    if (!frame_init(&frame, input, layers, guides, error))
        return false;
    read_frame(&frame, velocity);
    return next(refinement, &frame, error) && add_shown(refinement, &frame, velocity, error);
}

/* ---- the state ---------------------------------------------------------------------------------
 */

/* The bytes start with this; the two potentials follow. */
typedef struct Header {
    double lies[6]; // of the plane
    int32_t x, y, width, height;
    float scale;
    int32_t unused;
} Header;

static_assert(sizeof(Header) == 72, "the header has no padding");

static size_t pixels(const FlRefinement *refinement)
{
    return refinement->potential ? fl_rect_pixels(refinement->plane.box) : 0;
}

size_t fl_refinement_bytes(const FlRefinement *refinement)
{
    return sizeof(Header) + 2 * pixels(refinement) * sizeof(float);
}

void fl_refinement_write(const FlRefinement *refinement, uint8_t *bytes)
{
    const size_t plane = pixels(refinement) * sizeof(float);
    const FlRigid lies = refinement->plane.lies;
    const FlRect b = refinement->plane.box;
    const Header header = {{lies.cosine, lies.sine, lies.x, lies.y, lies.u, lies.v},
                           b.x,
                           b.y,
                           b.width,
                           b.height,
                           refinement->plane.scale,
                           0};
    memcpy(bytes, &header, sizeof header);
    if (plane == 0)
        return;
    memcpy(bytes + sizeof header, refinement->potential, plane);
    memcpy(bytes + sizeof header + plane, refinement->shown, plane);
}

static bool is_number(double value)
{
    return fabs(value) <= (double)FARTHEST;
}

static bool is_plane(const Header *header, int most_px)
{
    const int grid = FL_REGION_PLANE_GRID, w = header->width, h = header->height;
    for (int k = 0; k < 6; k++)
        if (!is_number(header->lies[k]))
            return false;
    return header->scale > 0 && is_number((double)header->scale) && is_number(header->x) &&
           is_number(header->y) && w > 0 && h > 0 && w <= most_px && h <= most_px &&
           w % grid == 0 && h % grid == 0;
}

static float *read_plane(const uint8_t *bytes, size_t n, GError **error)
{
    g_autofree float *plane = fl_alloc(n, sizeof *plane, "a potential", error);
    if (!plane)
        return NULL;
    memcpy(plane, bytes, n * sizeof *plane);
    for (size_t i = 0; i < n; i++)
        if (!is_number((double)plane[i])) {
            fl_state_bytes_damaged("its refinement is no number", error);
            return NULL;
        }
    return g_steal_pointer(&plane);
}

bool fl_refinement_read(FlRefinement *refinement, const uint8_t *bytes, size_t size, int most_px,
                        GError **error)
{
    Header h;
    fl_refinement_clear(refinement);
    if (size < sizeof h)
        return fl_state_bytes_damaged("its refinement is missing", error);
    memcpy(&h, bytes, sizeof h);
    bytes += sizeof h, size -= sizeof h;
    if (size == 0)
        return true;
    const FlRect box = {h.x, h.y, h.width, h.height};
    const size_t n = is_plane(&h, most_px) ? fl_rect_pixels(box) : 0;
    if (n == 0 || size != 2 * n * sizeof(float))
        return fl_state_bytes_damaged("its refinement has another size", error);
    refinement->plane = (FlRegionPlane){
        {h.lies[0], h.lies[1], h.lies[2], h.lies[3], h.lies[4], h.lies[5]}, h.scale, box};
    return (refinement->potential = read_plane(bytes, n, error)) &&
           (refinement->shown = read_plane(bytes + n * sizeof(float), n, error));
}
