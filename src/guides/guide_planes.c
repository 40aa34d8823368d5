#include "guides/guide_planes.h"

#include "guides/plane_store.h"

bool fl_guide_sequence_shape(const FlGuideSequence *sequence, int frame, uint8_t *coverage_angle,
                             GError **error)
{
    const FlFrameRecord *record = &sequence->frames[frame];
    return fl_spill_get(sequence->spill,
                        fl_guide_plane_block(record->holder[FL_GUIDE_PLANE_COVERAGE_ANGLE],
                                             FL_GUIDE_PLANE_COVERAGE_ANGLE),
                        coverage_angle, 2 * fl_rect_pixels(record->box), error);
}

bool fl_guide_sequence_plane(const FlGuideSequence *sequence, int frame, FlGuidePlane plane,
                             int32_t *values, GError **error)
{
    const FlFrameRecord *record = &sequence->frames[frame];
    const size_t step = fl_plane_step(plane);
    return fl_plane_store_get(sequence->spill, fl_guide_plane_block(record->holder[plane], plane),
                              values, step * fl_rect_pixels(record->box), step, error);
}
