#include "synth/drying.h"

#include "base/curves.h"
#include <math.h>

#define BAND 18.0f      // units: how deep the contour's speed is felt
#define FULL 3.6f       // units a frame: at that speed an edge is wet by 1 - 1/e
#define STILL 0.06f     // units a frame: slower is no motion of an edge,
#define SURE 0.5f       // and faster surely is one
#define MOVING 0.3f     // wetness of the inside of what moves fast
#define FAST 4.8f       // units a frame: by 1 - 1/e
#define DAMP 0.15f      // wetness of an edge at rest
#define NEW 200         // of FL_WET: wetness of new paint
#define RISE 0.487f     // share of the way in a frame: 1.5 frames
#define FALL 0.154f     // 6 frames
#define FALL_LEFT 0.36f // 2.25 frames: of an edge that recedes
#define LEAST_STEP 2    // of FL_WET, so that it ends
#define PLAYED 1        // wetness of paint that has played the exemplar; 0: outside the mask
#define PALE 0.45f      // share of its density that fresh paint lacks
#define DRY_AT 0.30f    // wetness up to which paint is as dense as it gets,
#define FRESH_AT 0.80f  // and from which on it is fresh
#define GATHERS 0.45f   // added density at the rim of a receding edge
#define RIM 9.0f        // units: how wide it is
#define BESIDE 3.0f     // units outside the contour: there an edge meets paper or paint

/* The motion of contour and paint at a pixel. */
typedef struct Place {
    float band;        // 1 at the contour, 0 inside
    float lead, trail; // degree to which the contour advances and recedes
    float speed;       // of the paint, units
} Place;

static float band_of(const FlGuides *guides, size_t p, float unit_px)
{
    return CLAMP(1 - guides->distance[p] / (BAND * unit_px), 0, 1);
}

int fl_wet_at_rest(const FlGuides *guides, size_t pixel, float unit_px, bool plays)
{
    return plays ? PLAYED : (int)(band_of(guides, pixel, unit_px) * DAMP * FL_WET + 0.5f);
}

static float edge_of(float units)
{
    return units > STILL ? (1 - expf(-units / FULL)) * fl_smooth_between(STILL, SURE, units) : 0;
}

/* The share of bare paper just outside the contour, along the gradient g of the depth: at edges
 * over other paint no paper gets wet. */
static float bare_beside(const FlDrying *drying, size_t p, int x, int y, const float g[2])
{
    const FlGuides *guides = drying->guides;
    const float length = sqrtf(g[0] * g[0] + g[1] * g[1]);
    const float out = (guides->distance[p] + BESIDE * drying->unit_px) / MAX(length, 0.1f);
    const int i = CLAMP(x - (int)lrintf(out * g[0]), 0, guides->width - 1);
    const int j = CLAMP(y - (int)lrintf(out * g[1]), 0, guides->height - 1);
    return fl_smooth_between(
        0.1f, 0.9f, (float)guides->bare[(size_t)j * (size_t)guides->width + (size_t)i] / 255);
}

/* The flow that is constructed from the masks is the contour's own motion near the contour. */
static Place place_of(const FlDrying *drying, size_t p, int x, int y, bool first)
{
    const FlGuides *guides = drying->guides;
    const float unit = drying->unit_px, *flow = guides->flow + 2 * p;
    float g[2];
    fl_distance_gradient(guides->distance, guides->width, guides->height, x, y, g);
    const float v = -(flow[0] * g[0] + flow[1] * g[1]) * bare_beside(drying, p, x, y, g);
    float speed = 0;
    if (first)
        speed = hypotf(flow[0], flow[1]);
    else if (guides->has_motion && guides->motion[2 * p] != FL_MOTION_UNKNOWN)
        speed =
            hypotf((float)guides->motion[2 * p], (float)guides->motion[2 * p + 1]) / FL_MOTION_ONE;
    return (Place){.band = band_of(guides, p, unit),
                   .lead = edge_of(v / unit),
                   .trail = edge_of(-v / unit),
                   .speed = speed / unit};
}

/* The limit that the wetness approaches, 0 … 1. */
static float tends_to(const Place *place)
{
    const float inside = place->speed > 0 ? MOVING * (1 - expf(-place->speed / FAST)) : 0;
    const float edge = (DAMP + (1 - DAMP) * place->lead) * (1 - place->trail);
    return inside + place->band * (edge - inside);
}

static int next_wetness(const Place *place, int was)
{
    const int target = (int)(tends_to(place) * FL_WET + 0.5f);
    const float left = place->band * place->trail;
    const float share = target > was ? RISE : FALL + left * (FALL_LEFT - FALL);
    const int step = MAX((int)(share * (float)abs(target - was) + 0.5f), LEAST_STEP);
    return target > was ? MIN(was + step, target) : MAX(was - step, target);
}

/* The wetness of paint in the frame before, between its pixels: outside the mask it is fresh,
 * beyond the page as at its side. */
static float wet_before(const FlDrying *drying, float x, float y)
{
    const int x0 = (int)floorf(x), y0 = (int)floorf(y);
    float wet = 0;
    for (int k = 0; k < 4; k++) {
        const float u = (float)(x0 + (k & 1)), v = (float)(y0 + (k >> 1));
        const int i = CLAMP((int)u, 0, drying->width - 1);
        const int j = CLAMP((int)v, 0, drying->guides->height - 1);
        const int was = drying->before[(size_t)j * (size_t)drying->width + (size_t)i];
        wet += (1 - fabsf(x - u)) * (1 - fabsf(y - v)) * (float)(was > 0 ? was : FL_WET);
    }
    return wet;
}

/* The wetness of paint that plays: one frame of the exemplar less fresh than it was. */
static int next_age(const FlDrying *drying, size_t p, int x, int y)
{
    const FlGuides *guides = drying->guides;
    const int32_t *motion = guides->motion + 2 * p;
    if (!drying->before || !guides->has_motion || motion[0] == FL_MOTION_UNKNOWN)
        return FL_WET;
    const float was = wet_before(drying, (float)x - (float)motion[0] / FL_MOTION_ONE,
                                 (float)y - (float)motion[1] / FL_MOTION_ONE);
    const float fresh = was * was / FL_WET - (float)FL_WET / (float)drying->plays;
    return MAX((int)lrintf(sqrtf(fmaxf(fresh, 0) * FL_WET)), PLAYED);
}

/* The tone of a pixel of some wetness and depth. */
static uint8_t tone_of(const FlDrying *drying, const Place *place, int wet, float depth)
{
    const float at = MAX(depth, 0) / (RIM * drying->unit_px);
    const float pale = PALE * fl_smooth_between(DRY_AT, FRESH_AT, (float)wet / FL_WET);
    const float tone = 1 + drying->wets * (GATHERS * place->trail * expf(-at * at) - pale);
    return (uint8_t)(FL_TONE_ONE * tone + 0.5f);
}

/* True if a place came inward from beyond a side of the page, or from so near to it that its patch
 * was cut off; along one axis. */
static bool came_in(float is, int32_t motion, int size)
{
    const float margin = FL_PATCH_RADIUS + 1; // paint is carried from a pixel beside that place
    const float was = is - (float)motion / FL_MOTION_ONE;
    return (was < is && was < margin) || (was > is && was > (float)size - 1 - margin);
}

/* True if a place of the body came in at a side of the page: paint that is laid there now is not
 * new. */
static bool came_into_view(const FlGuides *guides, size_t p, int x, int y)
{
    const int32_t *motion = guides->motion + 2 * p;
    return guides->has_motion && motion[0] != FL_MOTION_UNKNOWN &&
           (came_in((float)x, motion[0], guides->width) ||
            came_in((float)y, motion[1], guides->height));
}

static int wetness(const FlDrying *drying, const Place *place, const FlCarried *carried, size_t q,
                   size_t p, int x, int y)
{
    const bool fresh = carried && carried->nnf.match[q].frame == FL_NO_MATCH;
    if (!carried || (fresh && came_into_view(drying->guides, p, x, y)))
        return (int)(tends_to(place) * FL_WET + 0.5f);
    return fresh ? NEW : next_wetness(place, carried->wet[q]);
}

bool fl_drying_step(const FlDrying *drying, FlRect rect, const FlCarried *carried, uint8_t *wet,
                    uint8_t *tone)
{
    const FlGuides *guides = drying->guides;
    bool dries = false;
#pragma omp parallel for schedule(static) reduction(|| : dries)
    for (int y = rect.y; y < rect.y + rect.height; y++)
        for (int x = rect.x; x < rect.x + rect.width; x++) {
            const size_t p = fl_guides_at(guides, x, y);
            const size_t q = (size_t)(y - rect.y) * (size_t)rect.width + (size_t)(x - rect.x);
            tone[q] = FL_TONE_ONE;
            if (guides->mask[p] < FL_INSIDE)
                continue;
            uint8_t *const at = wet + (size_t)y * (size_t)drying->width + (size_t)x;
            if (drying->plays > 0) {
                *at = (uint8_t)next_age(drying, p, x, y);
                dries = dries || *at > PLAYED;
                continue;
            }
            const Place place = place_of(drying, p, x, y, !carried);
            const int now = wetness(drying, &place, carried, q, p, x, y);
            *at = (uint8_t)now;
            tone[q] = tone_of(drying, &place, now, guides->distance[p]);
            dries = dries || now != fl_wet_at_rest(guides, p, drying->unit_px, false);
        }
    return dries;
}

/* ---- appearance ------------------------------------------------------------------------------ */

static bool shows(const FlExemplarLevel *level, FlMatch m, int segment)
{
    return m.x_16 <= 16 * (level->width - 1) && m.y_16 <= 16 * (level->height - 1) &&
           fl_exemplar_at(level, fl_match_x(m), fl_match_y(m), m.frame)->c[FL_CH_SEGMENT] ==
               segment;
}

static const float *distances(const FlExemplar *exemplar, int frame)
{
    const FlExemplarLevel *level = &exemplar->level[0];
    return exemplar->distance + (size_t)frame * (size_t)level->height * (size_t)level->width;
}

/* The place in another frame that lies as deep, as far as it is beside the rim. */
static FlMatch in_frame(const FlExemplar *exemplar, FlMatch m, int frame)
{
    static const float nearest[2] = {0.5f, 0.5f};
    const size_t at =
        (size_t)fl_match_y(m) * (size_t)exemplar->level[0].width + (size_t)fl_match_x(m);
    const float beside = fl_beside_rim(exemplar, m);
    const float rises = distances(exemplar, m.frame)[at] - distances(exemplar, frame)[at];
    m.frame = (int16_t)frame;
    return beside > 0 ? fl_match_deeper(exemplar, m, 16 * beside * rises, nearest) : m;
}

/* was: the wetness that the match shows; below 0: unknown, since paint plays. */
static FlMatch shown(const FlExemplar *exemplar, FlMatch m, int was, int wet)
{
    const FlExemplarLevel *level = &exemplar->level[0];
    const int segment =
        fl_exemplar_at(level, fl_match_x(m), fl_match_y(m), m.frame)->c[FL_CH_SEGMENT];
    const int now = fl_frame_of_freshness(level, fl_freshness(wet));
    const int then = was < 0 ? m.frame : fl_frame_of_freshness(level, fl_freshness(was));
    const int frame = CLAMP(m.frame + now - then, level->first, level->first + level->window - 1);
    const FlMatch next = frame == m.frame ? m : in_frame(exemplar, m, frame);
    return shows(level, next, segment) ? next : m;
}

void fl_drying_show(const FlDrying *drying, FlRect rect, const uint8_t *wet,
                    const FlExemplar *exemplar, FlCarried *carried)
{
#pragma omp parallel for schedule(dynamic, 8)
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t p = (size_t)y * (size_t)rect.width + (size_t)x;
            FlMatch *m = &carried->nnf.match[p];
            const int now =
                wet[(size_t)(rect.y + y) * (size_t)drying->width + (size_t)(rect.x + x)];
            const int was = drying->plays > 0 ? -1 : carried->wet[p];
            if (m->frame != FL_NO_MATCH && now != was)
                *m = shown(exemplar, *m, was, now);
        }
}

/* The tone between pixels, for pixel (x, y) of a picture. */
static float tone_at(const uint8_t *tone, FlRect rect, int px, int x, int y)
{
    const float fx = ((float)x + 0.5f) / (float)px - 0.5f - (float)rect.x;
    const float fy = ((float)y + 0.5f) / (float)px - 0.5f - (float)rect.y;
    const int x0 = CLAMP((int)floorf(fx), 0, rect.width - 1), x1 = MIN(x0 + 1, rect.width - 1);
    const int y0 = CLAMP((int)floorf(fy), 0, rect.height - 1), y1 = MIN(y0 + 1, rect.height - 1);
    const float u = CLAMP(fx - (float)x0, 0, 1), v = CLAMP(fy - (float)y0, 0, 1);
    const uint8_t *above = tone + (size_t)y0 * (size_t)rect.width;
    const uint8_t *below = tone + (size_t)y1 * (size_t)rect.width;
    return ((1 - v) * ((1 - u) * (float)above[x0] + u * (float)above[x1]) +
            v * ((1 - u) * (float)below[x0] + u * (float)below[x1])) /
           FL_TONE_ONE;
}

void fl_tone_picture(const uint8_t *tone, FlRect rect, int px, const uint8_t paper[3], int width,
                     int height, uint8_t *rgb)
{
    float density[3][256];
    for (int c = 0; c < 3; c++)
        for (int v = 0; v < 256; v++)
            density[c][v] = -logf(MAX((float)v, 0.5f) / MAX((float)paper[c], 1));
#pragma omp parallel for schedule(dynamic, 16)
    for (int y = px * rect.y; y < MIN(px * (rect.y + rect.height), height); y++)
        for (int x = px * rect.x; x < MIN(px * (rect.x + rect.width), width); x++) {
            const float t = tone_at(tone, rect, px, x, y);
            uint8_t *pixel = rgb + 3 * ((size_t)y * (size_t)width + (size_t)x);
            for (int c = 0; c < 3 && t != 1; c++)
                if (pixel[c] < paper[c])
                    pixel[c] = (uint8_t)((float)paper[c] * expf(-t * density[c][pixel[c]]) + 0.5f);
        }
}
