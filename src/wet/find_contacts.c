/* The contacts of a frame, from masks alone: those of the frame and of some before it, in which
 * paint has had time to run. */
#include "wet/wet.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "base/rng.h"
#include "cover/cover_map.h"
#include "guides/distance.h"
#include <math.h>

#define STEP_PX 2     // px of the page between points, about
#define RUN_FRAMES 10 // in which paint runs as far as it gets, and then is dry
#define REACH_PX 30   // of paint that runs, at most
#define OF_SIDE .22f  // of the smaller shape, which it reaches at most
#define CALM_PX 5     // by which a contact is farther away that lasts a third of the time
#define TOUCH_PX 1.5f // between shapes that touch
#define BLEED .6f     // of regions that a config calls wet together

/* The regions of a film, and their contacts in a frame so far. */
typedef struct Finder {
    const FlShapes *shapes;
    const FlComposeInput *input;
    const FlCover *cover; // of the frame
    int frame;
    FlWet grid;  // its cells alone
    float scale; // px of the page per cell
    FlContacts *contacts;
} Finder;

/* The two regions of a contact. */
typedef struct Pair {
    const Finder *f;
    const FlRegionPlan *own, *other;
    bool over;   // own lies over the other one
    float reach; // of the paint, px of the page
} Pair;

/* Paint's nearness in a frame, planes of a part of the cells. */
typedef struct Near {
    FlRect rect;
    float *distance; // to what is seen of the other region: below 0 outside, cells
    float *near;     // 0..1, 1 at the edge
} Near;

static void near_clear(Near *near)
{
    free(near->distance);
    free(near->near);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Near, near_clear)

/* The place, of a part of the cells, at which the edge is nearest to a cell. */
static void find_foot(const Near *near, int x, int y, float foot[2])
{
    const FlRect rect = near->rect;
    const float *d = near->distance + (size_t)y * (size_t)rect.width;
    const float *up = y > 0 ? d - rect.width : d, *down = y + 1 < rect.height ? d + rect.width : d;
    const float gx = d[MIN(x + 1, rect.width - 1)] - d[MAX(x - 1, 0)], gy = down[x] - up[x];
    const float far = -d[x] / (sqrtf(gx * gx + gy * gy) + 1e-3f);
    foot[0] = (float)x + far * gx, foot[1] = (float)y + far * gy;
}

/* Shapes that do not touch are as far away as they would be if the gap were some times as wide. */
static void find_near(const Pair *pair, const float *own, Near *near)
{
    const FlRect rect = near->rect;
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t i = (size_t)y * (size_t)rect.width + (size_t)x;
            float foot[2];
            find_foot(near, x, y, foot);
            const float gap = -fl_wet_plane_at(own, rect, foot[0], foot[1]) * pair->f->scale;
            const float apart = 6 * MAX(gap - TOUCH_PX, 0);
            near->near[i] = fl_fall((fabsf(near->distance[i]) * pair->f->scale + apart) / CALM_PX);
        }
}

/* The part of the other region that is seen: in the frame itself as all shapes leave it, in earlier
 * ones as the region does. */
static bool find_seen(const Pair *pair, int frame, FlRect rect, const uint8_t *own, uint8_t *seen,
                      GError **error)
{
    const FlRect px = fl_wet_px_of(&pair->f->grid, rect);
    const size_t n = fl_rect_pixels(rect);
    if (frame != pair->f->frame) {
        const bool read = fl_wet_get_mask(&pair->f->grid, pair->other->region,
                                          fl_wet_shown_by(pair->other, frame), rect, seen, error);
        for (size_t i = 0; read && i < n && pair->over; i++)
            seen[i] = (uint8_t)MAX(seen[i] - own[i], 0);
        return read;
    }
    g_autofree uint8_t *share = fl_alloc_unset(fl_rect_pixels(px), 1, "a contact", error);
    if (!share)
        return false;
    fl_cover_of_region(pair->f->cover, pair->other->region, px, share);
    fl_wet_find_means(&pair->f->grid, share, rect, seen);
    return true;
}

/* Finds how near paint is to the edge in a frame. */
static bool near_init(const Pair *pair, int frame, FlRect rect, Near *near, GError **error)
{
    const size_t n = fl_rect_pixels(rect);
    g_autofree uint8_t *own = fl_alloc_unset(n, 1, "a contact", error);
    g_autofree uint8_t *seen = own ? fl_alloc_unset(n, 1, "a contact", error) : NULL;
    g_autofree float *depth = seen ? fl_alloc_unset(n, sizeof(float), "a contact", error) : NULL;
    *near = (Near){.rect = rect};
    if (!depth || !(near->distance = fl_alloc_unset(n, sizeof(float), "a contact", error)) ||
        !(near->near = fl_alloc_unset(n, sizeof(float), "a contact", error)) ||
        !fl_wet_get_mask(&pair->f->grid, pair->own->region, fl_wet_shown_by(pair->own, frame), rect,
                         own, error) ||
        !find_seen(pair, frame, rect, own, seen, error) ||
        !fl_distance(seen, rect.width, rect.height, near->distance, error) ||
        !fl_distance(own, rect.width, rect.height, depth, error))
        return false;
    find_near(pair, depth, near);
    return true;
}

/* The map from cells to the places that their middles had when an anchor was at rest, px of the
 * frame. */
static FlAffine rest_of(const FlAnchor *at, double cell)
{
    const double c = (double)at->cosine, s = (double)at->sine;
    const double dx = cell / 2 - (double)at->x, dy = cell / 2 - (double)at->y;
    return (FlAffine){.xx = c * cell,
                      .yx = -s * cell,
                      .xy = s * cell,
                      .yy = c * cell,
                      .x0 = (double)at->rest_x + c * dx + s * dy,
                      .y0 = (double)at->rest_y + c * dy - s * dx};
}

/* The cells of a frame to which both regions are near. */
static FlRect part_of(const Pair *pair, int frame)
{
    const Finder *f = pair->f;
    const FlMaskStore *masks = f->shapes->masks;
    const FlRect page = f->grid.sheet.page;
    const int room = (int)ceilf(2 * pair->reach / f->scale) + 2;
    const FlRect own =
        fl_mask_store_box(masks, pair->own->region, fl_wet_shown_by(pair->own, frame));
    const FlRect other =
        fl_mask_store_box(masks, pair->other->region, fl_wet_shown_by(pair->other, frame));
    if (own.width == 0 || other.width == 0)
        return (FlRect){0, 0, 0, 0};
    return fl_rect_and(fl_rect_grown(fl_wet_cells_of(&f->grid, own), room, page),
                       fl_rect_grown(fl_wet_cells_of(&f->grid, other), room, page));
}

/* The k-th frame before; below 0: the film begins later. */
static int frame_before(const Finder *f, int k)
{
    const int n = f->shapes->n_frames, before = f->frame - k;
    return f->shapes->loop ? (before % n + n) % n : before;
}

/* Returns: true if neither region of a pair has moved between two frames. */
static bool rests(const Pair *pair, int a, int b)
{
    const FlRegionPlan *both[] = {pair->own, pair->other};
    bool same = true;
    for (int k = 0; k < 2; k++) {
        const FlAnchor one = fl_drawing_anchor(pair->f->shapes->drawing, both[k]->region, a);
        const FlAnchor other = fl_drawing_anchor(pair->f->shapes->drawing, both[k]->region, b);
        same = same && one.x == other.x && one.y == other.y && one.cosine == other.cosine &&
               one.sine == other.sine &&
               fl_mask_store_same(pair->f->shapes->masks, both[k]->region,
                                  fl_wet_shown_by(both[k], a), fl_wet_shown_by(both[k], b));
    }
    return same;
}

/* Finds how near the paint of a part of the frame was to the edge in an earlier one. */
static bool find_earlier(const Pair *pair, int then, FlRect part, float *earlier, GError **error)
{
    const Finder *f = pair->f;
    const FlAnchor at = fl_drawing_anchor(f->shapes->drawing, pair->own->region, f->frame);
    const FlAnchor was = fl_drawing_anchor(f->shapes->drawing, pair->own->region, then);
    const FlAffine rest = rest_of(&at, f->grid.cell), rest_then = rest_of(&was, f->grid.cell);
    const FlRect rect = part_of(pair, then);
    FlAffine back;
    g_auto(Near) near = {0};
    memset(earlier, 0, fl_rect_pixels(part) * sizeof *earlier);
    if (rect.width == 0 || !fl_affine_invert(&rest_then, &back))
        return true; // one of them was missing
    if (!near_init(pair, then, rect, &near, error))
        return false;
    const FlAffine came = fl_affine_multiply(back, rest);
    for (int y = 0; y < part.height; y++)
        for (int x = 0; x < part.width; x++) {
            const FlPoint place = fl_affine_apply(&came, (FlPoint){part.x + x, part.y + y});
            const float u = (float)(place.x - rect.x), v = (float)(place.y - rect.y);
            if (u >= 0 && v >= 0 && u < (float)rect.width && v < (float)rect.height)
                earlier[y * part.width + x] = fl_wet_plane_at(near.near, rect, u, v);
        }
    return true;
}

/* The mean nearness through the last frames, along the region's own motion. */
static bool find_mean(const Pair *pair, const Near *near, float *mean, GError **error)
{
    const Finder *f = pair->f;
    const size_t n = fl_rect_pixels(near->rect);
    g_autofree float *last = fl_alloc_unset(n, sizeof *last, "a contact", error);
    if (!last)
        return false;
    memcpy(last, near->near, n * sizeof *last);
    memcpy(mean, near->near, n * sizeof *mean);
    int frames = 1;
    for (; frames < RUN_FRAMES && frame_before(f, frames) >= 0; frames++) {
        const int then = frame_before(f, frames);
        if (!rests(pair, then, frame_before(f, frames - 1)) &&
            !find_earlier(pair, then, near->rect, last, error))
            return false;
        for (size_t i = 0; i < n; i++)
            mean[i] += last[i];
    }
    for (size_t i = 0; i < n; i++)
        mean[i] /= (float)frames;
    return true;
}

/* Finds the place on the edge that is nearest to each point. */
static void find_feet(const Pair *pair, const Near *near, FlContact *contact)
{
    const FlRect rect = near->rect;
    const FlAffine rest = rest_of(&contact->anchor, pair->f->grid.cell);
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t i = (size_t)y * (size_t)rect.width + (size_t)x;
            float foot[2];
            find_foot(near, x, y, foot);
            const FlPoint place = fl_affine_apply(
                &rest, (FlPoint){rect.x + (double)foot[0], rect.y + (double)foot[1]});
            contact->foot[0][i] = (float)place.x * contact->page;
            contact->foot[1][i] = (float)place.y * contact->page;
        }
}

/* The planes of a contact, whose cells are a part of the page. */
static bool find_planes(const Pair *pair, FlRect part, FlContact *contact, GError **error)
{
    const size_t n = fl_rect_pixels(part);
    g_auto(Near) near = {0};
    if (!(contact->away = fl_alloc_unset(3 * n, sizeof(float), "a contact", error)))
        return false;
    contact->foot[0] = contact->away + n, contact->foot[1] = contact->away + 2 * n;
    if (!near_init(pair, pair->f->frame, part, &near, error) ||
        !find_mean(pair, &near, contact->away, error))
        return false;
    find_feet(pair, &near, contact);
    for (size_t i = 0; i < n; i++) {
        const float lasting = -CALM_PX * logf(MAX(contact->away[i], 1e-6f));
        contact->away[i] = MAX(lasting, fabsf(near.distance[i]) * pair->f->scale);
    }
    return true;
}

/* ---- a frame --------------------------------------------------------------------------------- */

static bool names(const FlRegionSettings *settings, const char *region)
{
    g_auto(GStrv) list = g_strsplit(settings->wet_with ? settings->wet_with : "", ",", -1);
    const char *const *words = (const char *const *)list;
    return g_strv_contains(words, region) || g_strv_contains(words, "all");
}

/* The bleed of a region, 0..1: as it says, or its style; NAN: neither does. */
static float bleed_of(const FlRegionPlan *region, double said)
{
    const float style = region->style->front.bleed;
    return !isnan(said) ? (float)said : style > 0 ? style : NAN;
}

/* The bleed of two regions that are wet together. */
static float mean_bleed(float a, float b)
{
    if (isnan(a) && isnan(b))
        return BLEED;
    return isnan(a) ? b : isnan(b) ? a : .5f * (a + b);
}

/* Returns: true if one of two regions names the other, or the styles of both bleed. */
static bool are_wet(const FlRegionPlan *a, const FlRegionPlan *b)
{
    return names(&a->settings, b->name) || names(&b->settings, a->name) ||
           (a->style->front.bleed > 0 && b->style->front.bleed > 0);
}

bool fl_contacts_wanted(const FlShapes *shapes)
{
    bool wanted = false;
    for (int p = 0; p < shapes->n_painted; p++)
        for (int q = 0; q < p && !wanted; q++)
            wanted = are_wet(&shapes->painted[p], &shapes->painted[q]);
    return wanted;
}

/* The place in the stack of a region's upper shape; -1: the frame has none. */
static int place_of(const FlDrawList *draws, int region)
{
    int place = draws->n - 1;
    while (place >= 0 && draws->draw[place].region != region)
        place--;
    return place;
}

static bool add_contact(const Pair *pair, const FlContact *like, GError **error)
{
    const Finder *f = pair->f;
    const FlRect part = part_of(pair, f->frame);
    if (part.width == 0)
        return true;
    f->contacts->contact = g_renew(FlContact, f->contacts->contact, f->contacts->n + 1);
    FlContact *contact = &f->contacts->contact[f->contacts->n++];
    *contact = *like;
    contact->region = pair->own->region, contact->other = pair->other->region;
    contact->style = &pair->other->style->front;
    contact->first = pair->own->area_px < pair->other->area_px;
    contact->box = fl_wet_px_of(&f->grid, part);
    contact->step = f->grid.cell;
    contact->width = part.width, contact->height = part.height;
    return find_planes(pair, part, contact, error);
}

/* Adds both contacts of a pair. */
static bool add_pair(const Finder *f, const FlRegionPlan *a, const FlRegionPlan *b, GError **error)
{
    const FlShapes *shapes = f->shapes;
    const int upper = place_of(f->cover->draws, a->region);
    const int lower = place_of(f->cover->draws, b->region);
    const FlRegionSettings *of_a = f->input->painted[a - shapes->painted]->settings;
    const FlRegionSettings *of_b = f->input->painted[b - shapes->painted]->settings;
    if (upper < 0 || lower < 0 || a->region == b->region || !are_wet(a, b))
        return true;
    const float bleed = mean_bleed(bleed_of(a, of_a->bleed), bleed_of(b, of_b->bleed));
    const float side = MIN(fl_drawing_anchor(shapes->drawing, a->region, f->frame).side,
                           fl_drawing_anchor(shapes->drawing, b->region, f->frame).side);
    const int figure = (a->area_px < b->area_px ? a : b)->region;
    const FlContact like = {
        .strength = bleed,
        .anchor = fl_drawing_anchor(shapes->drawing, figure, f->frame),
        .page = 1 / shapes->paper_px,
        .reach_px = bleed * MIN(REACH_PX, OF_SIDE * side / shapes->paper_px),
        .key = fl_key(fl_key(f->input->seed, g_str_hash(a->name)), g_str_hash(b->name))};
    const Pair pair = {f, a, b, upper > lower, like.reach_px};
    const Pair back = {f, b, a, upper < lower, like.reach_px};
    return like.reach_px < .5f ||
           (add_contact(&pair, &like, error) && add_contact(&back, &like, error));
}

/* Returns: true if a region that has styles with keys was listed before. */
static bool is_later_style(const FlShapes *shapes, int p)
{
    return p > 0 && shapes->painted[p - 1].more;
}

bool fl_contacts_find(FlContacts *contacts, const FlShapes *shapes, const FlComposeInput *input,
                      const FlDrawList *draws, int frame, GError **error)
{
    const int width = shapes->width, height = shapes->height;
    const int cell = MAX((int)(STEP_PX * shapes->paper_px + .5f), 1);
    g_auto(FlCover) cover = {0};
    const Finder finder = {
        .shapes = shapes,
        .input = input,
        .cover = &cover,
        .frame = frame,
        .grid = {.shapes = shapes,
                 .cell = cell,
                 .sheet.page = {0, 0, (width + cell - 1) / cell, (height + cell - 1) / cell}},
        .scale = (float)cell / shapes->paper_px,
        .contacts = contacts};
    bool found = fl_cover_init(&cover, draws, width, height, (FlHiding){0}, error);
    for (int p = 0; p < shapes->n_painted && found; p++)
        for (int q = 0; q < p && found; q++)
            found = is_later_style(shapes, p) || is_later_style(shapes, q) ||
                    add_pair(&finder, &shapes->painted[p], &shapes->painted[q], error);
    return found;
}
