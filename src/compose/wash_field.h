/* A wash in the making; private to the files of washes. */
#pragma once

#include "base/curves.h"
#include "compose/wash.h"

/** A part of a wash that moves as one: a whole region, or a limb. */
typedef struct FlWashPart {
    int region;
    FlAnchor anchor;
    const FlLimb *limb; // NULL: all of it
    float light[2];     // FlWashField.light, turned against its motion
    float *weight;      // of the part in the wash, at each point
} FlWashPart;

#define FL_WASH_ROOMS 5

/** A wash in the making. Lengths are px of the page, unless said. */
typedef struct FlWashField {
    FlWash *wash;
    const FlComposeInput *input;
    float size;     // of its shapes through the film
    float drops;    // strength of drops of paint
    float light[2]; // unit vector to the side of the shadow
    FlWashPart *part;
    int n_parts;
    float *planes;      // memory of the planes below and of the parts' weights
    float *mask;        // coverage at each point, as if no other shape lay over it
    float *light_at[2]; // of its parts, at each point
    float *side;        // -1 light side .. 1 shadow side
    float *around;      // the mask, spread as far as the shapes are large
    float *room[FL_WASH_ROOMS];
    float *map[FL_MAPS]; // shares of dials at each point, from control maps; NULL: all of them
    float *turned;       // three planes: scratch of blurs
} FlWashField;

static inline size_t fl_wash_points(const FlWash *wash)
{
    return (size_t)wash->width * (size_t)wash->height;
}

#define FL_WASH_NEAR 4 // points beyond a shape at which its wash is known
#define FL_WASH_JOINT_PX                                                                           \
    12 // half the width over which the washes of parts that move apart are mixed

bool fl_field_alloc(FlWashField *field, GError **error);
void fl_field_clear(FlWashField *field);

/** Blurs a plane of all points by sigma_px of the page. */
void fl_field_blur(const FlWashField *field, float *plane, float sigma_px);

/** Takes from a plane so many shares at each point that the mean of `all`, of which it is a part,
 * is 0 over what the shape holds around each point, and the fill stays the fill. Shapes apart have
 * means of their own. */
void fl_field_centre(const FlWashField *field, const float *all, const float *share, float *plane);

/** The masks of the draws of wash w, and of its regions as far as the others leave them in sight.
 */
void fl_field_fill_masks(const FlWashField *field, const FlWashes *washes, int w,
                         const FlDrawList *draws);

/** Divides the points of a wash among its parts: the weights become shares, 0..1, of which limbs
 * have the more the nearer they are. A lone part keeps its coverage. */
void fl_field_divide(const FlWashField *field);

/** Finds FlWashField.light_at. */
void fl_field_find_light(const FlWashField *field);

/** Finds FlWashField.side: the place of each point along the light, from the middle of the shape
 * around the point, as a share of its extent: a small shape is taken whole, a large one near the
 * point. */
void fl_field_find_side(const FlWashField *field);

/** Wet paint gathers inside contours that face the shadow. The page's edge is no contour. */
void fl_field_find_pools(const FlWashField *field, float *pool);

/** A share at each point by which it lies in the middle of something large. */
void fl_field_find_heart(const FlWashField *field, float *heart);

/** At each point 0 on the rim, rising to 1 behind it. */
void fl_field_find_middle(const FlWashField *field, float *middle);

/** At each point 0 in lines and dots, which have no wash, rising to 1 in large parts. */
void fl_field_find_breadth(const FlWashField *field, float *breadth);

/** Fills the planes of the wash with noise at the places where its parts were first seen. */
void fl_field_fill_noise(const FlWashField *field);
