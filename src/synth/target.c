#include "synth/target.h"

#include "base/alloc.h"

#define EXT_UNIT_SQUARED (FL_EXT_UNIT * FL_EXT_UNIT)
#define WEIGHTS_SUM 5   // 25 pixels * 5 * FL_ONE^2 < 2^31: the other terms still fit in 32 bits
#define TANGENT_CAP 8.0 // |tan| of 83 degrees: steeper is as bad

void fl_cost_scale_init(FlCostScale *scale, const FlParams *params)
{
    fl_rotation_init();
    const float w_colour = params->w_texture + params->w_temp,
                w_ext = params->w_ext / EXT_UNIT_SQUARED;
    const float sum = 3 * w_colour + params->w_bound + 2 * w_ext;
    scale->w_max = MAX(MAX(w_colour, params->w_bound), w_ext);
    scale->w_max = MAX(MAX(scale->w_max, sum / WEIGHTS_SUM), 1e-6f);
    scale->unit = (double)FL_ONE * FL_ONE / scale->w_max;
    scale->age = (float)(params->w_age * FL_PATCH_PIXELS * scale->unit / (FL_WET * FL_WET));
    for (int a = 0; a < FL_ANGLES; a++) {
        const double c = abs(fl_turns[a][0]), s = abs(fl_turns[a][1]);
        const double tangent = s < TANGENT_CAP * c ? s / c : TANGENT_CAP;
        scale->direction[a] =
            (uint32_t)MIN(params->w_dir * FL_PATCH_PIXELS * tangent * scale->unit + 0.5, 1 << 29);
    }
}

static bool level_init(FlTargetLevel *level, int width, int height, GError **error)
{
    const size_t pixels = (size_t)width * height;
    *level = (FlTargetLevel){.width = width, .height = height};
    for (int k = 0; k < FL_PATCH_PIXELS; k++)
        level->around[k] = fl_patch_offsets[k][1] * width + fl_patch_offsets[k][0];
    level->tile_columns = (width + FL_TILE - 1) / FL_TILE;
    const size_t tiles = (size_t)level->tile_columns * ((height + FL_TILE - 1) / FL_TILE);
    return (level->segment = fl_alloc_unset(pixels, 1, "a target", error)) &&
           (level->angle = fl_alloc_unset(pixels, 1, "a target", error)) &&
           (level->guide = fl_alloc_unset(pixels, sizeof(FlTargetTexel), "a target", error)) &&
           (level->distance = fl_alloc_unset(pixels, sizeof(float), "a target", error)) &&
           (level->tiles = fl_alloc_unset(tiles, sizeof(uint32_t), "a target", error));
}

static bool colours_init(FlTargetLevel *level, GError **error)
{
    const size_t pixels = (size_t)level->width * level->height;
    return (level->colour = fl_alloc_scratch(3 * pixels, sizeof(float), "a target", error));
}

bool fl_target_add_temporal(FlTarget *target, GError **error)
{
    for (int l = 0; l < target->n_levels; l++) {
        FlTargetLevel *level = &target->level[l];
        const size_t pixels = (size_t)level->width * level->height;
        level->temporal = fl_alloc_scratch(3 * pixels, sizeof(float), "a target", error);
        level->temporal_weight =
            level->temporal ? fl_alloc_scratch(pixels, sizeof(float), "a target", error) : NULL;
        if (!level->temporal_weight)
            return false;
    }
    return true;
}

/* Pixel `to` of a level from pixel p of its planes. */
static void fill_pixel(FlTargetLevel *level, size_t to, const FlPyramid *pyramid, size_t p,
                       const FlExemplar *exemplar)
{
    FlTargetTexel guide = {0};
    const float ext_scale = exemplar->ext_scale * FL_EXT_UNIT;
    level->distance[to] = pyramid->plane[FL_PLANE_DISTANCE][p];
    level->segment[to] =
        (uint8_t)fl_segment_of(pyramid->plane[FL_PLANE_INSIDE][p] > 0, level->distance[to],
                               exemplar->border_px, exemplar->separate);
    level->angle[to] = fl_pyramid_angle(pyramid, p);
    guide.c[FL_CH_SHAPE] = fl_pack_channel(pyramid->plane[FL_PLANE_SHAPE][p]);
    guide.c[FL_CH_EXT_PLUS] = fl_pack_channel(pyramid->plane[FL_PLANE_EXT_PLUS][p] * ext_scale);
    guide.c[FL_CH_EXT_MINUS] = fl_pack_channel(pyramid->plane[FL_PLANE_EXT_MINUS][p] * ext_scale);
    level->guide[to] = guide;
}

/* Bit-reversed order of a 4x4 pattern: tiles of consecutive classes are far from each other. */
static const uint8_t class_of[4][4] = {
    {0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};

static bool tile_is_searched(const FlTargetLevel *level, int column, int row)
{
    for (int y = row * FL_TILE; y < MIN((row + 1) * FL_TILE, level->height); y++)
        for (int x = column * FL_TILE; x < MIN((column + 1) * FL_TILE, level->width); x++)
            if (fl_target_searches(level, (size_t)y * (size_t)level->width + (size_t)x))
                return true;
    return false;
}

static void list_tiles(FlTargetLevel *level)
{
    const int rows = (level->height + FL_TILE - 1) / FL_TILE;
    int n = 0;
    for (int c = 0; c < FL_TILE_CLASSES; c++) {
        level->n_tiles[c] = n; // first of the class; the last entry is the end
        for (int row = 0; row < rows; row++)
            for (int column = 0; column < level->tile_columns; column++)
                if (class_of[row & 3][column & 3] == c && tile_is_searched(level, column, row))
                    level->tiles[n++] = (uint32_t)(row * level->tile_columns + column);
    }
    level->n_tiles[FL_TILE_CLASSES] = n;
}

static void find_blocks(FlTargetLevel *level)
{
    fl_blocks_init(&level->blocks, level->segment, level->width, level->height, FL_PATCH_RADIUS);
}

/* The mean freshness of the paint in the four pixels that make one. */
static void halve_freshness(const FlTargetLevel *fine, FlTargetLevel *coarse)
{
    for (int y = 0; y < coarse->height; y++)
        for (int x = 0; x < coarse->width; x++) {
            int sum = 0, n = 0;
            for (int cy = 2 * y; cy < MIN(2 * y + 2, fine->height); cy++)
                for (int cx = 2 * x; cx < MIN(2 * x + 2, fine->width); cx++) {
                    const size_t p = (size_t)cy * (size_t)fine->width + (size_t)cx;
                    if (fine->segment[p] != FL_SEGMENT_OUTSIDE)
                        sum += fine->fresh[p], n++;
                }
            coarse->fresh[(size_t)y * (size_t)coarse->width + (size_t)x] =
                (uint8_t)(n > 0 ? (sum + n / 2) / n : 0);
        }
}

bool fl_target_take_wetness(FlTarget *target, const uint8_t *wet, int width, GError **error)
{
    const FlRect rect = target->rect;
    for (int l = 0; l < target->n_levels; l++) {
        FlTargetLevel *level = &target->level[l];
        const size_t pixels = (size_t)level->width * (size_t)level->height;
        if (!(level->fresh = fl_alloc_unset(pixels, 1, "a target", error)))
            return false;
        if (l > 0)
            halve_freshness(level - 1, level);
        for (size_t p = 0; l == 0 && p < pixels; p++) {
            const size_t x = (size_t)rect.x + p % (size_t)rect.width;
            const size_t y = (size_t)rect.y + p / (size_t)rect.width;
            level->fresh[p] = (uint8_t)fl_freshness(wet[y * (size_t)width + x]);
        }
    }
    return true;
}

bool fl_target_level_search(FlTargetLevel *level, bool all, GError **error)
{
    const size_t pixels = (size_t)level->width * (size_t)level->height;
    list_tiles(level);
    if (all)
        return true;
    g_autofree uint8_t *searched = fl_alloc_unset(pixels, 1, "a target", error);
    if (!searched)
        return false;
    for (size_t p = 0; p < pixels; p++)
        searched[p] = fl_target_searches(level, p);
    fl_blocks_clear(&level->blocks);
    fl_blocks_init(&level->blocks, searched, level->width, level->height, FL_PATCH_RADIUS);
    return true;
}

/* The rows of a level from row y on; the planes are of these alone. */
static void fill_rows(FlTargetLevel *level, int y, const FlPyramid *rows,
                      const FlExemplar *exemplar)
{
    const size_t first = (size_t)y * level->width, pixels = (size_t)rows->width * rows->height;
#pragma omp parallel for schedule(dynamic, 4096)
    for (size_t p = 0; p < pixels; p++)
        fill_pixel(level, first + p, rows, p, exemplar);
}

static void count_segments(FlTargetLevel *level)
{
    for (size_t p = 0; p < (size_t)level->width * level->height; p++)
        level->n_inside[level->segment[p]]++;
}

#define STRIP_ROWS 128 // even

/* The input of a target. */
typedef struct Source {
    const FlGuides *guides;
    const FlParams *params;
    const FlExemplar *exemplar;
    float *shape; // of the frame; NULL: it follows from the depth, pixel by pixel
} Source;

static void fill_strip(FlPyramid *strip, const Source *source, FlRect rect)
{
    const float border = source->exemplar->border_px;
    fl_pyramid_fill(strip, source->guides, source->shape, rect);
    if (!source->shape)
        fl_shape_edge(strip->plane[FL_PLANE_DISTANCE], strip->width, strip->height, border,
                      source->params->shape_edge * border, strip->plane[FL_PLANE_SHAPE]);
}

/* Level 0, and the planes of level 1 if there is one; those of level 0, which would take more than
 * anything else of a target, are made strip by strip. */
static bool fill_finest(FlTarget *target, const Source *source, FlPyramid *coarse, GError **error)
{
    const FlRect rect = target->rect;
    g_auto(FlPyramid) strip = {0};
    if (!fl_pyramid_init(&strip, rect.width, MIN(rect.height, STRIP_ROWS), FL_PLANE_R, error))
        return false;
    for (int y = 0; y < rect.height; y += STRIP_ROWS) {
        strip.height = MIN(rect.height - y, STRIP_ROWS);
        fill_strip(&strip, source, (FlRect){rect.x, rect.y + y, rect.width, strip.height});
        fill_rows(&target->level[0], y, &strip, source->exemplar);
        if (coarse->height > 0) {
            FlPyramid rows = fl_pyramid_rows(coarse, y / 2, (strip.height + 1) / 2);
            fl_pyramid_halve(&strip, &rows);
        }
    }
    return true;
}

static bool fill_levels(FlTarget *target, const Source *source, GError **error)
{
    g_auto(FlPyramid) fine = {0};
    for (int l = 0; l < target->n_levels; l++) {
        FlTargetLevel *level = &target->level[l];
        g_auto(FlPyramid) coarse = {0};
        if (l + 1 < target->n_levels &&
            !fl_pyramid_init(&coarse, (level->width + 1) / 2, (level->height + 1) / 2, FL_PLANE_R,
                             error))
            return false;
        if (l == 0 && !fill_finest(target, source, &coarse, error))
            return false;
        if (l > 0) {
            fill_rows(level, 0, &fine, source->exemplar);
            if (coarse.height > 0)
                fl_pyramid_halve(&fine, &coarse);
        }
        const FlPyramid done = fine;
        fine = coarse, coarse = done;
    }
    return true;
}

/* Shapes that are blurred need the whole frame, and are given as the thesis' ramp is. */
static bool fill_from_guides(FlTarget *target, Source *source, GError **error)
{
    const size_t pixels = (size_t)source->guides->width * source->guides->height;
    g_autofree float *shape = NULL;
    if (!fl_knows_depth(source->params)) {
        shape = source->shape = fl_alloc(pixels, sizeof(float), "a guide", error);
        if (!shape || !fl_shape_guide(source->guides, source->params, source->exemplar->border_px,
                                      shape, error))
            return false;
    }
    return fill_levels(target, source, error);
}

bool fl_target_init(FlTarget *target, const FlGuides *guides, const FlParams *params, FlRect rect,
                    int n_levels, const FlExemplar *exemplar, GError **error)
{
    Source source = {guides, params, exemplar, NULL};
    *target = (FlTarget){.rect = rect, .n_levels = n_levels};
    int width = rect.width, height = rect.height;
    for (int l = 0; l < n_levels; l++, width = (width + 1) / 2, height = (height + 1) / 2)
        if (!level_init(&target->level[l], width, height, error))
            return false;
    if (!fill_from_guides(target, &source, error))
        return false;
    for (int l = 0; l < n_levels; l++) {
        count_segments(&target->level[l]);
        list_tiles(&target->level[l]);
        find_blocks(&target->level[l]);
        if (!colours_init(&target->level[l], error))
            return false;
    }
    return true;
}

void fl_target_level_clear(FlTargetLevel *level)
{
    free(level->segment);
    free(level->angle);
    free(level->guide);
    free(level->colour);
    free(level->temporal);
    free(level->temporal_weight);
    free(level->kept);
    free(level->fresh);
    free(level->distance);
    free(level->tiles);
    fl_blocks_clear(&level->blocks);
    *level = (FlTargetLevel){0};
}

void fl_target_clear(FlTarget *target)
{
    for (int l = 0; l < target->n_levels; l++)
        fl_target_level_clear(&target->level[l]);
    *target = (FlTarget){0};
}

/* Pixels without T_temp do not count in the colour; they do in the weight. */
static void halve_temporal(const FlTargetLevel *fine, FlTargetLevel *coarse, int x, int y)
{
    const size_t to = (size_t)y * coarse->width + x;
    float sum[3] = {0}, weight = 0;
    int n = 0;
    for (int cy = 2 * y; cy < MIN(2 * y + 2, fine->height); cy++)
        for (int cx = 2 * x; cx < MIN(2 * x + 2, fine->width); cx++) {
            const size_t from = (size_t)cy * fine->width + cx;
            const float m = fine->temporal_weight[from];
            for (int c = 0; c < 3; c++)
                sum[c] += m * fine->temporal[3 * from + c];
            weight += m, n++;
        }
    for (int c = 0; c < 3; c++)
        coarse->temporal[3 * to + c] = weight > 0 ? sum[c] / weight : 0;
    coarse->temporal_weight[to] = weight / (float)n;
}

void fl_target_temporal_pyramid(FlTarget *target, int from)
{
    for (int l = from + 1; l < target->n_levels; l++) {
        FlTargetLevel *coarse = &target->level[l];
#pragma omp parallel for schedule(dynamic, 8)
        for (int y = 0; y < coarse->height; y++)
            for (int x = 0; x < coarse->width; x++)
                halve_temporal(&target->level[l - 1], coarse, x, y);
    }
}

static int16_t quantise_weight(float w, const FlCostScale *scale)
{
    return (int16_t)MIN(w / scale->w_max * 32767 + 0.5f, 32767);
}

/* Of pixel p. */
static void blend_pixel(FlTargetLevel *level, size_t p, float w_temp, const FlCostScale *scale,
                        float w_texture)
{
    const float w_temporal = level->temporal ? w_temp * level->temporal_weight[p] : 0;
    const float w = w_texture + w_temporal;
    FlTargetTexel *guide = &level->guide[p];
    for (size_t c = 0; c < 3; c++) {
        const float past = level->temporal ? level->temporal[3 * p + c] : 0;
        const float mean =
            w > 0 ? (w_texture * level->colour[3 * p + c] + w_temporal * past) / w : 0;
        guide->c[FL_CH_R + c] = fl_pack_channel(mean);
    }
    guide->c[FL_CH_COLOUR_WEIGHT] = quantise_weight(w, scale);
}

void fl_target_blend(FlTargetLevel *level, const FlParams *params, const FlCostScale *scale,
                     float w_texture)
{
    const int16_t w_ext =
        level->fresh ? 0 : quantise_weight(params->w_ext / EXT_UNIT_SQUARED, scale);
    level->rest.c[FL_CH_SHAPE] = quantise_weight(params->w_bound, scale);
    level->rest.c[FL_CH_EXT_PLUS] = level->rest.c[FL_CH_EXT_MINUS] = w_ext;
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = 0; k < level->blocks.n; k++) {
        const FlRect block = level->blocks.block[k];
        for (int y = block.y; y < block.y + block.height; y++)
            for (int x = block.x; x < block.x + block.width; x++)
                blend_pixel(level, (size_t)y * (size_t)level->width + (size_t)x, params->w_temp,
                            scale, w_texture);
    }
}

static void gather_at_border(const FlTargetLevel *level, int x, int y, FlTargetPatch *patch)
{
    for (int k = 0; k < FL_PATCH_PIXELS; k++) {
        const int px = CLAMP(x + fl_patch_offsets[k][0], 0, level->width - 1);
        const int py = CLAMP(y + fl_patch_offsets[k][1], 0, level->height - 1);
        patch->guide[k] = level->guide[(size_t)py * level->width + px];
    }
}

void fl_target_gather(const FlTargetLevel *level, int x, int y, FlTargetPatch *patch)
{
    const int r = FL_PATCH_RADIUS;
    if (x < r || y < r || x >= level->width - r || y >= level->height - r) {
        gather_at_border(level, x, y, patch);
        return;
    }
    const FlTargetTexel *centre = level->guide + (size_t)y * level->width + x;
    for (int k = 0; k < FL_PATCH_PIXELS; k++)
        patch->guide[k] = centre[level->around[k]];
}
