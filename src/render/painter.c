#include "render/painter.h"

#include "base/alloc.h"
#include "base/rng.h"
#include "guides/flow_file.h"
#include "output/name.h"

static bool painter_mask(void *data, int frame, uint8_t *coverage, GError **error)
{
    const FlPainter *painter = data;
    return fl_masks_get(painter->masks, painter->region, frame * painter->treatment.hold, coverage,
                        error);
}

static bool painter_flow(void *data, int frame, float *flow, GError **error)
{
    const FlPainter *painter = data;
    const int number = fl_film_number(painter->film, frame * painter->treatment.hold);
    g_autofree char *file = fl_output_name(painter->flow_pattern, number, painter->name, error);
    return file && fl_flow_load(file, painter->width, painter->height, flow, error);
}

bool fl_painter_init(FlPainter *painter, uint64_t seed, GError **error)
{
    const int hold = painter->treatment.hold;
    const FlGuideSource source = {.width = painter->width,
                                  .height = painter->height,
                                  .n_frames = (fl_film_frames(painter->film) - 1) / hold + 1,
                                  .mask = painter_mask,
                                  .flow = painter->flow_pattern ? painter_flow : NULL,
                                  .data = painter};
    const FlGuideParams how = fl_guide_params(&painter->treatment.params);
    const size_t pixels = (size_t)painter->width * painter->height;
    return (painter->guides = fl_guide_sequence_new(&source, &how, error)) &&
           (painter->synth =
                fl_synth_new(painter->box->exemplar, &painter->treatment.params, painter->width,
                             painter->height, fl_key(seed, g_str_hash(painter->name)), error)) &&
           (painter->painted = fl_alloc(3 * pixels, 1, "a painted region", error));
}

void fl_painter_clear(FlPainter *painter)
{
    fl_treatment_clear(&painter->treatment);
    fl_guide_sequence_free(painter->guides);
    fl_synth_free(painter->synth);
    free(painter->painted);
    g_free(painter->flow_pattern);
    *painter = (FlPainter){0};
}

bool fl_painter_frame(FlPainter *painter, int frame, FlGuides *guides, GError **error)
{
    const gint64 start = g_get_monotonic_time();
    if (frame % painter->treatment.hold != 0)
        return true;
    if (!fl_guide_sequence_get(painter->guides, frame / painter->treatment.hold, guides, error) ||
        !fl_synth_frame(painter->synth, guides, painter->painted, &painter->stats, &painter->view,
                        error))
        return false;
    painter->seconds = (double)(g_get_monotonic_time() - start) * 1e-6;
    return true;
}
