/* One pixel at a time; vqrdmulhq_s16 rounds as the contract asks. */
#include "synth/kernels.h"

#include <arm_neon.h>

uint32_t fl_patch_distance_neon(const FlTexel *centre, const int32_t *offsets,
                                const FlPacked *target, const FlPacked *weight, uint32_t limit)
{
    uint32_t total = 0;
    for (int p = 0; p < FL_PATCH_PIXELS;) {
        int32x4_t sum = vdupq_n_s32(0);
        for (const int end = p + FL_PATCH; p < end; p++) {
            const int16x8_t s = vreinterpretq_s16_u16(vshll_n_u8(vld1_u8(centre[offsets[p]].c), 4));
            const int16x8_t d = vsubq_s16(s, vld1q_s16(target[p].c));
            const int16x8_t dw = vqrdmulhq_s16(d, vld1q_s16(weight[p].c));
            sum = vmlal_s16(sum, vget_low_s16(d), vget_low_s16(dw));
            sum = vmlal_high_s16(sum, d, dw);
        }
        total += (uint32_t)vaddvq_s32(sum);
        if (total > limit)
            break;
    }
    return total;
}
