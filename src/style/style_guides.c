#include "style/style_guides.h"

#include <string.h>

FlGuideParams fl_guide_params(const FlParams *params)
{
    return (FlGuideParams){.flow_sigma_frames = params->flow_sigma,
                           .dist_sigma_frames = params->time_blur_sigma,
                           .dist_sigma_px = params->blur_sigma,
                           .still_px = params->flow_still,
                           .flow_limit = params->flow_limit};
}

static bool style_mask(void *data, int frame, uint8_t *coverage, GError **error)
{
    const FlStyle *style = data;
    const size_t pixels = (size_t)style->width * style->height;
    memcpy(coverage, style->mask + frame * pixels, pixels);
    return true;
}

static bool style_flow(void *data, int frame, float *flow, GError **error)
{
    const FlStyle *style = data;
    const size_t values = 2 * (size_t)style->width * style->height;
    memcpy(flow, style->flow + frame * values, values * sizeof *flow);
    return true;
}

FlGuideSequence *fl_style_guides(const FlStyle *style, const FlParams *params, GError **error)
{
    const FlGuideParams guide_params = fl_guide_params(params);
    const FlGuideSource source = {.width = style->width,
                                  .height = style->height,
                                  .n_frames = style->n_frames,
                                  .mask = style_mask,
                                  .flow = style->flow ? style_flow : NULL,
                                  .data = (void *)style};
    return fl_guide_sequence_new(&source, &guide_params, error);
}
