/* One pixel at a time; vqrdmulhq_s16 rounds as the contract asks. */
#include "synth/kernels.h"

#include <arm_neon.h>

uint32_t fl_patch_distance_neon(const FlTexel *centre, const int16_t *offsets, bool opposed,
                                const FlTargetTexel *target, const FlTargetTexel *rest,
                                uint32_t limit)
{
    static const uint8_t orders[2][8] = {{0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 5, 4, 6, 7}};
    static const uint16_t colours[8] = {0xffff, 0xffff, 0xffff, 0, 0, 0, 0, 0};
    static const uint16_t others[8] = {0, 0, 0, 0xffff, 0xffff, 0xffff, 0, 0};
    const uint8x8_t order = vld1_u8(orders[opposed]);
    const int16x8_t colour = vreinterpretq_s16_u16(vld1q_u16(colours));
    const int16x8_t other = vandq_s16(vreinterpretq_s16_u16(vld1q_u16(others)), vld1q_s16(rest->c));
    uint32_t total = 0;
    for (int p = 0; p < FL_PATCH_PIXELS;) {
        int32x4_t sum = vdupq_n_s32(0);
        for (const int end = p + FL_PATCH; p < end; p++) {
            const uint8x8_t texel = vtbl1_u8(vld1_u8(centre[offsets[p]].c), order);
            const int16x8_t t = vld1q_s16(target[p].c);
            const int16x8_t d = vsubq_s16(vreinterpretq_s16_u16(vshll_n_u8(texel, 4)), t);
            const int16x8_t own = vandq_s16(colour, vdupq_laneq_s16(t, FL_CH_COLOUR_WEIGHT));
            const int16x8_t dw = vqrdmulhq_s16(d, vorrq_s16(own, other));
            sum = vmlal_s16(sum, vget_low_s16(d), vget_low_s16(dw));
            sum = vmlal_high_s16(sum, d, dw);
        }
        total += (uint32_t)vaddvq_s32(sum);
        if (total > limit)
            break;
    }
    return total;
}
