#include "worker/hand_line.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "base/noise.h"
#include "base/page.h"
#include "base/rng.h"
#include <math.h>
#include <stddef.h>

#define MITRE 4.f         // half widths that a corner reaches, at SVG's usual limit
#define FAR 1e30f         // squared distance of what no piece is near
#define FINEST_PX 2.4f    // of grain that is not blurred away, nor flickers as the line moves
#define FILL_EDGE 1.6f    // variation of a shape's edge, as a multiple of a line's
#define FILL_EDGE_PX 1.5f // by how much at most, px of the page
#define EDGE_COVERAGE 250 // a shape's edge has less than that in a pixel
#define SMALL .1f         // side of a shape that is a detail, share of the page's longer side;
#define LARGE .2f         // from here on it is none
#define AMPLE 2.f         // load that no grain shows in

enum { PLAY, LOAD, GRAIN, SIDE }; // uses of a hand's key

/** The place on the path that is nearest to each pixel of the box, of one subpath. */
typedef struct Nearest {
    FlRect box;
    float *square; // of the distance, px
    float *far;    // along the path, units
    float *aside;  // the distance again, px, below 0 on the left
} Nearest;

static void nearest_clear(Nearest *nearest)
{
    free(nearest->square);
    free(nearest->far);
    free(nearest->aside);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Nearest, nearest_clear)

static bool nearest_init(Nearest *nearest, FlRect box, GError **error)
{
    const size_t n = fl_rect_pixels(box);
    *nearest = (Nearest){.box = box};
    if (!(nearest->square = fl_alloc(n, sizeof(float), "a line", error)) ||
        !(nearest->far = fl_alloc(n, sizeof(float), "a line", error)) ||
        !(nearest->aside = fl_alloc(n, sizeof(float), "a line", error)))
        return false;
    for (size_t i = 0; i < n; i++)
        nearest->square[i] = FAR;
    return true;
}

/* ---- places ---------------------------------------------------------------------------------- */

static void note_pixel(Nearest *nearest, size_t i, FlLinePoint a, FlLinePoint b, float px, float py)
{
    const float x = b.x - a.x, y = b.y - a.y, l = x * x + y * y;
    const float qx = px - a.x, qy = py - a.y;
    const float t = l > 0 ? CLAMP((qx * x + qy * y) / l, 0, 1) : 0;
    const float dx = qx - t * x, dy = qy - t * y, square = dx * dx + dy * dy;
    if (square >= nearest->square[i])
        return;
    nearest->square[i] = square;
    nearest->far[i] = a.far + t * (b.far - a.far);
    nearest->aside[i] = x * qy - y * qx < 0 ? -sqrtf(square) : sqrtf(square);
}

/** The pixels of the box within reach of points; empty without points. */
static FlRect reached(FlRect box, const FlLinePoint *point, int n, float reach)
{
    float x0 = point->x, x1 = x0, y0 = point->y, y1 = y0;
    for (int k = 1; k < n; k++) {
        x0 = fminf(x0, point[k].x), x1 = fmaxf(x1, point[k].x);
        y0 = fminf(y0, point[k].y), y1 = fmaxf(y1, point[k].y);
    }
    const float right = (float)(box.x + box.width), bottom = (float)(box.y + box.height);
    const int left = (int)CLAMP(floorf(x0 - reach), (float)box.x, right);
    const int top = (int)CLAMP(floorf(y0 - reach), (float)box.y, bottom);
    return (FlRect){left, top, (int)CLAMP(ceilf(x1 + reach), (float)left, right) - left,
                    (int)CLAMP(ceilf(y1 + reach), (float)top, bottom) - top};
}

static size_t place_in(FlRect box, int x, int y)
{
    return (size_t)(y - box.y) * (size_t)box.width + (size_t)(x - box.x);
}

static void note_path(Nearest *nearest, const FlLinePoint *point, int n, float reach,
                      const uint8_t *coverage)
{
    for (int k = 0; k < MAX(n - 1, 1); k++) {
        const FlLinePoint a = point[k], b = point[MIN(k + 1, n - 1)];
        const FlRect part = reached(nearest->box, point + k, MIN(2, n), reach);
        for (int y = part.y; y < part.y + part.height; y++)
            for (int x = part.x; x < part.x + part.width; x++) {
                const size_t i = place_in(nearest->box, x, y);
                if (coverage[i])
                    note_pixel(nearest, i, a, b, (float)x + .5f, (float)y + .5f);
            }
    }
}

/* ---- the hand -------------------------------------------------------------------------------- */

/** Noise at a place on a path, -1..1 with few exceptions; where a closed path ends it goes on as
 * it begins. */
static float noise_at(uint64_t key, const FlLinePath *path, float far, float aside, float wave,
                      float across)
{
    const float v = aside / across + .37f;
    const float n = fl_noise(key, far / wave, v);
    const float blend = fminf(path->length / 2, 1.5f * wave);
    const float b =
        path->closed && blend > 0 ? fl_smooth_between(path->length - blend, path->length, far) : 0;
    if (b <= 0)
        return n;
    const float again = fl_noise(key, (far - path->length) / wave, v);
    return (n * (1 - b) + again * b) / sqrtf((1 - b) * (1 - b) + b * b);
}

/** Such noise from 0 to 1, of one of the hand's movements. */
static float play_at(const FlHandLine *hand, int what, const FlLinePath *path, float far,
                     float wave)
{
    const float n = noise_at(fl_key(hand->key, (uint64_t)what), path, far, 0, wave, 1);
    return .5f + .5f * CLAMP(1.3f * n, -1, 1);
}

/**
 * Grain of about the wanted size, deviation about 1. Its octaves are fixed on the path; which of
 * them are heard depends on their size on the page, gradually, so that it neither swims when the
 * line grows nor flickers where it is small.
 */
static float grain_at(const FlHandLine *hand, const FlLinePath *path, float far, float aside,
                      float streak)
{
    enum { COARSEST = -3, FINEST = 6 };
    const float unit = hand->paths->unit_px;
    const float wanted = fmaxf(hand->kind->grain_px * hand->page, FINEST_PX);
    float sum = 0, squares = 0, size = 8;
    for (int k = COARSEST; k <= FINEST; k++, size /= 2) {
        const float px = size * unit, ratio = px / wanted;
        const float weight = fl_smooth_between(.3f, .8f, ratio) *
                             (1 - fl_smooth_between(1.1f, 3, ratio)) *
                             fl_smooth_between(.5f * FINEST_PX, FINEST_PX, px);
        if (weight <= 0)
            continue;
        const uint64_t key = fl_key(fl_key(hand->key, GRAIN), (uint64_t)(k - COARSEST));
        sum += weight * noise_at(key, path, far, aside, size * streak, size);
        squares += weight * weight;
    }
    return 2 * sum / fmaxf(sqrtf(squares), .6f);
}

static float tooth_at(const FlTooth *tooth, int x, int y)
{
    return tooth->height
               ? (float)tooth->height[(size_t)y * tooth->stride + (size_t)x] / FL_TOOTH_ONE
               : 0;
}

/** The width that an end's taper leaves, as a share. A stroke of few widths, such as a leg, keeps
 * its ends: two tapers alone would make a seed of it. */
static float taper_at(const FlLineKind *kind, const FlLinePath *path, float far)
{
    const float over = fminf(kind->taper, path->length / 3);
    const float thinner = (1 - kind->tip) * fl_smooth_between(4, 10, path->length);
    float share = 1;
    for (int end = 0; end < 2 && !path->closed && over > 0; end++) {
        const float t = 1 - CLAMP((end ? path->length - far : far) / over, 0, 1);
        share *= 1 - path->bare[end] * thinner * t * t;
    }
    return share;
}

/** The share of a pixel that lies in a band, by its distance from the middle. */
static float band(float distance, float half)
{
    return fmaxf(fminf(half, distance + .5f) - fmaxf(-half, distance - .5f), 0);
}

/** The middle of the part of a pixel that a line covers, measured across the line. */
static float middle_of(float aside, float half)
{
    const float d = fminf(fabsf(aside), half + .5f);
    const float middle = (fminf(half, d + .5f) + fmaxf(-half, d - .5f)) / 2;
    return aside < 0 ? -middle : middle;
}

/** The share of a pixel of a line that the varying width leaves. */
static float width_at(const FlHandLine *hand, const FlLinePath *path, float far, float aside)
{
    const FlLineKind *kind = hand->kind;
    const float half = hand->paths->unit_px / 2, d = fminf(fabsf(aside), half + .25f);
    const float fine = fl_smooth_between(1, FINEST_PX, kind->rough_wave * hand->paths->unit_px);
    const int side = SIDE + (aside < 0);
    const float thin = play_at(hand, PLAY, path, far, kind->wave);
    float share = 1 - kind->play * thin * thin; // mostly the drawing's width
    share -= kind->rough * fine * play_at(hand, side, path, far, kind->rough_wave);
    share *= taper_at(kind, path, far);
    return fminf(band(d, share * half) / band(d, half), 1);
}

/** The share of colour that the tool leaves on the paper, 0..1. */
static float deposit(const FlHandLine *hand, float load, float grain, int x, int y)
{
    if (load >= AMPLE)
        return hand->kind->opacity;
    const float tooth = hand->kind->tooth * tooth_at(&hand->tooth, x, y);
    return hand->kind->opacity * fl_smooth_between(0, 1, load + hand->kind->grain * grain + tooth);
}

static float line_pixel(const FlHandLine *hand, const FlLinePath *path, const Nearest *nearest,
                        int x, int y)
{
    const FlLineKind *kind = hand->kind;
    const size_t i = place_in(nearest->box, x, y);
    const float far = nearest->far[i], aside = nearest->aside[i], unit = hand->paths->unit_px;
    const float across = middle_of(aside, unit / 2) / unit; // -.5 to .5
    const float load = kind->load - kind->soft * 4 * across * across -
                       kind->load_play * play_at(hand, LOAD, path, far, kind->load_wave);
    return width_at(hand, path, far, aside) *
           deposit(hand, load, grain_at(hand, path, far, across, kind->streak), x, y);
}

/**
 * Notes what lies within `reach` of the hand's k-th path. own: the hand, with a key for this path;
 * part: the pixels that may be noted.
 */
static const FlLinePath *approach(const FlHandLine *hand, guint k, float reach,
                                  const uint8_t *coverage, Nearest *nearest, FlHandLine *own,
                                  FlRect *part)
{
    const FlLinePath *path = &g_array_index(hand->paths->path, FlLinePath, k);
    const FlLinePoint *point = &g_array_index(hand->paths->point, FlLinePoint, path->first);
    *own = *hand;
    own->key = fl_key(hand->key, k);
    *part = reached(nearest->box, point, path->n, reach);
    note_path(nearest, point, path->n, reach, coverage);
    return path;
}

/* ---- flat shapes ----------------------------------------------------------------------------- */

/** True if the place on the outline next to a pixel is an edge: outlines may run inside a shape. */
static bool is_edge(const Nearest *nearest, const uint8_t *coverage, const FlLinePoint *foot)
{
    const FlRect box = nearest->box;
    const int x = (int)floorf(foot->x), y = (int)floorf(foot->y);
    for (int v = y - 1; v <= y + 1; v++)
        for (int u = x - 1; u <= x + 1; u++)
            if (u < box.x || v < box.y || u >= box.x + box.width || v >= box.y + box.height ||
                coverage[place_in(box, u, v)] < EDGE_COVERAGE)
                return true;
    return false;
}

/** The point at a distance along a subpath. */
static FlLinePoint point_at(const FlLinePoint *point, int n, float far)
{
    int low = 0, high = n - 1;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        *(point[middle].far <= far ? &low : &high) = middle;
    }
    const float l = point[high].far - point[low].far;
    const float t = l > 0 ? (far - point[low].far) / l : 0;
    return (FlLinePoint){point[low].x + t * (point[high].x - point[low].x),
                         point[low].y + t * (point[high].y - point[low].y), far};
}

/** 1 for a small shape, falling to 0 for one too large to be drawn with a pen. */
static float detail_of(const FlHandLine *hand)
{
    const FlLinePoint *point = (const FlLinePoint *)(const void *)hand->paths->point->data;
    float x0 = FAR, x1 = -FAR, y0 = FAR, y1 = -FAR;
    for (guint k = 0; k < hand->paths->point->len; k++) {
        x0 = fminf(x0, point[k].x), x1 = fmaxf(x1, point[k].x);
        y0 = fminf(y0, point[k].y), y1 = fmaxf(y1, point[k].y);
    }
    return 1 - fl_smooth_between(SMALL, LARGE, fmaxf(x1 - x0, y1 - y0) / (FL_PAGE_PX * hand->page));
}

/** The px by which the edge of a shape is drawn in at a place of its outline. */
static float inset_at(const FlHandLine *hand, const FlLinePath *path, float far)
{
    const FlLineKind *kind = hand->kind;
    const float unit = FILL_EDGE * hand->paths->unit_px, most = FILL_EDGE_PX * hand->page;
    const float inset = unit * (kind->play * play_at(hand, PLAY, path, far, kind->wave) +
                                kind->rough * play_at(hand, SIDE, path, far, 2 * kind->rough_wave));
    return fminf(inset, most);
}

/** The share of an edge pixel that is left, by its distance from the outline. */
static float edge_pixel(const FlHandLine *hand, const FlLinePath *path, const Nearest *nearest,
                        const uint8_t *coverage, size_t i)
{
    const FlLinePoint *point = &g_array_index(hand->paths->point, FlLinePoint, path->first);
    const FlLinePoint foot = point_at(point, path->n, nearest->far[i]);
    const float d = (coverage[i] < 128 ? -1.f : 1.f) * sqrtf(nearest->square[i]);
    const float whole = CLAMP(d + .5f, .05f, 1);
    const float left = CLAMP(d + .5f - inset_at(hand, path, nearest->far[i]), 0, 1);
    return is_edge(nearest, coverage, &foot) ? fminf(left / whole, 1) : 1;
}

/** Grain within a shape lies in the shape's own coordinates. */
static float shape_deposit(const FlHandLine *hand, int x, int y)
{
    static const FlLinePath endless = {.closed = false};
    const FlLineKind *kind = hand->kind;
    const FlPoint p =
        fl_affine_apply(&hand->paths->to_units, (FlPoint){(double)x + .5, (double)y + .5});
    const float streak = fminf(kind->streak, 3);
    const float load = kind->load - .5f * kind->load_play;
    return deposit(hand, load, grain_at(hand, &endless, (float)p.x, (float)p.y, streak), x, y);
}

/* ---- drawing --------------------------------------------------------------------------------- */

/** Of several subpaths of a line the one counts that leaves most, of a shape that which leaves
 * least. Takes the places back for the next. */
static void draw_path(const FlHandLine *hand, const FlLinePath *path, FlRect part, Nearest *nearest,
                      const uint8_t *coverage, float *share)
{
    for (int y = part.y; y < part.y + part.height; y++)
        for (int x = part.x; x < part.x + part.width; x++) {
            const size_t i = place_in(nearest->box, x, y);
            if (nearest->square[i] == FAR)
                continue;
            share[i] = hand->fill ? fminf(share[i], edge_pixel(hand, path, nearest, coverage, i))
                                  : fmaxf(share[i], line_pixel(hand, path, nearest, x, y));
            nearest->square[i] = FAR;
        }
}

bool fl_hand_line_draw(const FlHandLine *hand, FlRect box, uint8_t *coverage, GError **error)
{
    const float reach =
        hand->fill ? FILL_EDGE_PX * hand->page + 1.5f : MITRE * hand->paths->unit_px / 2 + 1;
    const float detail = hand->fill ? detail_of(hand) : 1;
    const size_t n = fl_rect_pixels(box);
    if (detail <= 0)
        return true;
    g_auto(Nearest) nearest = {0};
    g_autofree float *share = fl_alloc(n, sizeof *share, "a line", error);
    if (!share || !nearest_init(&nearest, box, error))
        return false;
    for (size_t i = 0; i < n; i++)
        share[i] = hand->fill ? 1 : -1; // -1: no path is near, and it stays as it was drawn
    for (guint k = 0; k < hand->paths->path->len; k++) {
        FlHandLine own;
        FlRect part;
        const FlLinePath *path = approach(hand, k, reach, coverage, &nearest, &own, &part);
        draw_path(&own, path, part, &nearest, coverage, share);
    }
    for (int y = box.y; y < box.y + box.height; y++)
        for (int x = box.x; x < box.x + box.width; x++) {
            const size_t i = place_in(box, x, y);
            if (!coverage[i] || share[i] < 0)
                continue;
            const float left = share[i] * (hand->fill ? shape_deposit(hand, x, y) : 1);
            coverage[i] = (uint8_t)((float)coverage[i] * (1 - detail + detail * left) + .5f);
        }
    return true;
}

/* ---- tools ----------------------------------------------------------------------------------- */

static const FlLineKind kinds[] = {
    // in the order of the type's fields
    // Ink from a nib: dark and sharp, a little thinner where the hand is fast.
    [FL_LINE_PEN] = {.30f, 9, .08f, 1.6f, 1.16f, .24f, 13, 0, .08f, 2.4f, 1, .06f, 3, .35f, 1},
    // Graphite: catches on the paper, greyer where the hand is light, with soft sides.
    [FL_LINE_PENCIL] = {.18f, 11, .16f, 1.1f, .98f, .30f, 7, .30f, .14f, 1.9f, 1, .11f, 2.5f, .5f,
                        .92f},
    // A pointed brush: swells and thins, ends in points, and streaks where it runs dry.
    [FL_LINE_BRUSH] = {.50f, 12, .12f, 2.5f, 1.25f, .55f, 16, .15f, .30f, 2.6f, 9, .12f, 5, .12f,
                       .97f},
};

const FlLineKind *fl_line_kind(FlLine line)
{
    return line == FL_LINE_PLAIN ? NULL : &kinds[line];
}
