#include "compose/paper_sheet.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "base/error.h"
#include "base/noise.h"
#include "base/page.h"
#include "base/rng.h"
#include "guides/blur.h"
#include "io/picture_file.h"
#include "io/sink.h"
#include "params/text.h"
#include <math.h>
#include <string.h>

#define FINE_PX 4       // wider structures are not part of the tooth
#define TOOTH_END 2.2f  // standard deviations
#define PATCH_PX 256    // side of the patch whose spreads are those of a whole sheet
#define SLOW_PX 8       // clouds and warmth are known every so many px
#define ROOM_PX 256     // that the sheet is larger than a frame if other parts of it are wanted
#define MOST_FINER 4    // times that small pages are made larger, at most
#define MOST_PIXELS 2e7 // of a page that has been made larger
#define BAND_ROWS 32    // of a sheet that is put away are read at a time

/* ---- making ---------------------------------------------------------------------------------- */

/* The planes of a sheet and a margin for blur and slope. */
typedef struct Surface {
    FlPaperPlace place;
    FlPaperSpread slope, fine; // of its slope and of its structures finer than FINE_PX
    float relief;
    int margin;
    FlRect box; // the sheet and the margin
    float *fibres, *height, *smooth;
    FlRect slow; // a point every SLOW_PX
    float *cloud, *warmth;
} Surface;

static void surface_clear(Surface *surface)
{
    free(surface->fibres);
    free(surface->height);
    free(surface->smooth);
    free(surface->cloud);
    free(surface->warmth);
}

static bool surface_alloc(Surface *surface, GError **error)
{
    const size_t n = fl_rect_pixels(surface->box), slow = fl_rect_pixels(surface->slow);
    return (surface->fibres = fl_alloc_unset(n, sizeof(float), "a sheet of paper", error)) &&
           (surface->height = fl_alloc_unset(n, sizeof(float), "a sheet of paper", error)) &&
           (surface->smooth = fl_alloc_unset(n, sizeof(float), "a sheet of paper", error)) &&
           (surface->cloud = fl_alloc_unset(slow, sizeof(float), "a sheet of paper", error)) &&
           (surface->warmth = fl_alloc_unset(slow, sizeof(float), "a sheet of paper", error));
}

static void fill_slow(Surface *surface)
{
#pragma omp parallel for schedule(static)
    for (int j = 0; j < surface->slow.height; j++)
        for (int i = 0; i < surface->slow.width; i++) {
            const size_t at = (size_t)j * (size_t)surface->slow.width + (size_t)i;
            const float x = (float)(i * SLOW_PX), y = (float)(j * SLOW_PX);
            surface->cloud[at] = fl_paper_cloud(&surface->place, x, y);
            surface->warmth[at] = fl_paper_warmth(&surface->place, x, y);
        }
}

/* The slope towards the light, which comes from above, as of the lamp that travels down a scan. */
static float slope_at(const Surface *surface, const float *height)
{
    const int row = surface->box.width;
    return .5f * surface->place.scale * (height[row] - height[-row]);
}

static bool find_smooth(Surface *surface, GError **error)
{
    memcpy(surface->smooth, surface->height, fl_rect_pixels(surface->box) * sizeof(float));
    return fl_blur(surface->smooth, surface->box.width, surface->box.height,
                   FINE_PX * surface->place.scale, error);
}

static FlPaperSpread spread_of(const float *values, size_t n)
{
    double sum = 0, squares = 0;
    for (size_t i = 0; i < n; i++)
        sum += (double)values[i], squares += (double)values[i] * (double)values[i];
    const double mean = sum / (double)n;
    return (FlPaperSpread){(float)mean, (float)sqrt(squares / (double)n - mean * mean)};
}

/* The spreads of a patch of scale 1, for a surface: those of a picture would be others in its
 * crops. */
static bool find_spreads(Surface *surface, GError **error)
{
    const FlPaperSpread as_drawn = {0, 1};
    Surface patch = {.place = {surface->place.grain, 1, 1, as_drawn, as_drawn},
                     .box = {0, 0, PATCH_PX, PATCH_PX},
                     .slow = {0, 0, 1, 1}};
    const size_t n = fl_rect_pixels(patch.box);
    bool made = surface_alloc(&patch, error);
    if (made) {
        fl_paper_fibres(&patch.place, patch.box, patch.fibres);
        patch.place.fibre = spread_of(patch.fibres, n);
        fl_paper_centre(patch.place.fibre, patch.fibres, n);
        fl_paper_height(&patch.place, patch.box, patch.fibres, patch.height);
        patch.place.height = spread_of(patch.height, n);
        fl_paper_centre(patch.place.height, patch.height, n);
        made = find_smooth(&patch, error);
    }
    if (made) {
        surface->place.fibre = patch.place.fibre, surface->place.height = patch.place.height;
        for (size_t i = 0; i < n; i++)
            patch.smooth[i] = patch.height[i] - patch.smooth[i];
        surface->fine = spread_of(patch.smooth, n);
        for (size_t i = PATCH_PX + 1; i < n - PATCH_PX - 1; i++)
            patch.smooth[i] = slope_at(&patch, patch.height + i);
        surface->slope = spread_of(patch.smooth + PATCH_PX, n - 2 * PATCH_PX);
    }
    surface_clear(&patch);
    return made;
}

static bool surface_make(Surface *surface, const FlPaperSheet *sheet, GError **error)
{
    const int m = surface->margin;
    surface->box = (FlRect){-m, -m, sheet->width + 2 * m, sheet->height + 2 * m};
    surface->slow = (FlRect){0, 0, sheet->width / SLOW_PX + 2, sheet->height / SLOW_PX + 2};
    if (!find_spreads(surface, error) || !surface_alloc(surface, error))
        return false;
    fl_paper_fibres(&surface->place, surface->box, surface->fibres);
    fl_paper_height(&surface->place, surface->box, surface->fibres, surface->height);
    fill_slow(surface);
    return find_smooth(surface, error);
}

static float slow_at(const Surface *surface, const float *plane, int x, int y)
{
    const size_t at = (size_t)(y / SLOW_PX) * (size_t)surface->slow.width + (size_t)(x / SLOW_PX);
    const float *upper = plane + at, *lower = upper + surface->slow.width;
    const float tx = (float)(x % SLOW_PX) / SLOW_PX, ty = (float)(y % SLOW_PX) / SLOW_PX;
    const float a = upper[0] + (upper[1] - upper[0]) * tx;
    const float b = lower[0] + (lower[1] - lower[0]) * tx;
    return a + (b - a) * ty;
}

/* Hollows are darker, as scans are skewed that way. */
static float light_at(const Surface *surface, const float *height)
{
    const float slope = slope_at(surface, height) / surface->slope.dev;
    const float light = .6f * slope + .5f * height[0];
    return light * (light < 0 ? 1.2f : .85f);
}

static uint16_t factor_of(float share)
{
    return (uint16_t)(fl_clamp(1 + share, 0, 1.99f) * FL_PAPER_ONE + .5f);
}

static void fill_pixel(const Surface *surface, int x, int y, FlPaperHue hue, uint16_t factor[4],
                       int8_t *tooth)
{
    const FlPaperGrain *grain = surface->place.grain;
    const size_t at =
        (size_t)(y + surface->margin) * (size_t)surface->box.width + (size_t)(x + surface->margin);
    const float fibre = surface->fibres[at], height = surface->height[at];
    const float cloud = slow_at(surface, surface->cloud, x, y);
    const float light = (light_at(surface, surface->height + at) + .11f) / .82f;
    const float fleck = grain->flecks > 0 ? fl_paper_fleck(&surface->place, (float)x, (float)y) : 0;
    const float warm = .5f * slow_at(surface, surface->warmth, x, y) + .25f * fibre;
    const float share = grain->sheet.relief * grain->relief * light + grain->cloud * cloud +
                        .5f * grain->streak * fibre - grain->flecks * fleck;
    const float fine = (height - surface->smooth[at]) / surface->fine.dev;
    factor[0] = factor_of(surface->relief * (share + grain->warm * hue.red));
    factor[1] = factor_of(surface->relief * (share - grain->warm * (.3f * warm + .5f * hue.red)));
    factor[2] = factor_of(surface->relief * (share - grain->warm * (1.6f * warm + hue.yellow)));
    factor[3] = FL_PAPER_ONE;
    *tooth = (int8_t)lrintf(fl_clamp(fine, -TOOTH_END, TOOTH_END) * FL_TOOTH_ONE);
}

static void fill_row(const Surface *surface, int y, FlPaperSheet *sheet)
{
    FlPaperHue hue[FL_NOISE_ROW];
    for (int x = 0; x < sheet->width; x++) {
        const size_t at = (size_t)y * (size_t)sheet->width + (size_t)x;
        const int i = x % FL_NOISE_ROW;
        if (i == 0)
            fl_paper_hues(&surface->place, x, y, MIN(sheet->width - x, FL_NOISE_ROW), hue);
        fill_pixel(surface, x, y, hue[i], sheet->factor + 4 * at, sheet->tooth + at);
    }
}

static bool make_kind(FlPaperSheet *sheet, const FlPaperPlace *place, float relief, GError **error)
{
    Surface surface = {
        .place = *place, .relief = relief, .margin = (int)ceilf(3 * FINE_PX * place->scale) + 1};
    const bool made = surface_make(&surface, sheet, error);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < (made ? sheet->height : 0); y++)
        fill_row(&surface, y, sheet);
    surface_clear(&surface);
    return made;
}

static bool sheet_alloc(FlPaperSheet *sheet, GError **error)
{
    const size_t n = (size_t)sheet->width * (size_t)sheet->height;
    return (sheet->factor =
                fl_alloc_unset(4 * n, sizeof *sheet->factor, "a sheet of paper", error)) &&
           (sheet->tooth = fl_alloc_unset(n, 1, "a sheet of paper", error));
}

static bool fill_sheet(FlPaperSheet *sheet, const FlPaperChoice *choice, int kind, float scale,
                       GError **error)
{
    FlPaperGrain grain = *fl_paper_grain((FlPaperKind)MAX(kind, 0));
    if (choice->sheet && (!choice->paper || g_str_equal(choice->paper, "auto")))
        grain.sheet = *choice->sheet;
    const FlPaperPlace place = {.grain = &grain, .seed = choice->seed, .scale = scale};
    if (!sheet_alloc(sheet, error))
        return false;
    const FlPaperPlanes planes = {sheet->width, sheet->height, sheet->factor, sheet->tooth};
    return kind >= 0
               ? make_kind(sheet, &place, (float)choice->relief, error)
               : fl_paper_file_fill(&planes, choice->paper, scale, (float)choice->relief, error);
}

/* The means over squares of n px of a sheet that is n times as large. */
static void fill_by_means(FlPaperSheet *sheet, const FlPaperSheet *large, int n)
{
#pragma omp parallel for schedule(static)
    for (int y = 0; y < sheet->height; y++)
        for (int x = 0; x < sheet->width; x++) {
            uint32_t factor[4] = {0};
            int32_t tooth = 0;
            for (int p = 0; p < n * n; p++) {
                const size_t from =
                    (size_t)(n * y + p / n) * (size_t)large->width + (size_t)(n * x + p % n);
                tooth += large->tooth[from];
                for (int c = 0; c < 4; c++)
                    factor[c] += large->factor[4 * from + (size_t)c];
            }
            const size_t at = (size_t)y * (size_t)sheet->width + (size_t)x;
            sheet->tooth[at] = (int8_t)(tooth / (n * n));
            for (int c = 0; c < 4; c++)
                sheet->factor[4 * at + (size_t)c] =
                    (uint16_t)((factor[c] + (uint32_t)(n * n) / 2) / (uint32_t)(n * n));
        }
}

/* A sheet whose grain is finer than its px would be another one, of noise: the sheet is made n
 * times as large and then averaged. */
static int finer(const FlPaperSheet *sheet, float scale, int most)
{
    const double pixels = (double)sheet->width * sheet->height;
    int n = 1;
    while ((float)n * scale < 1 && n < most && 4 * n * n * pixels <= MOST_PIXELS)
        n *= 2;
    return n;
}

static bool fill_reduced(FlPaperSheet *sheet, const FlPaperChoice *choice, int kind, float scale,
                         int n, GError **error)
{
    g_autoptr(FlPaperSheet) large = g_new0(FlPaperSheet, 1);
    large->width = n * sheet->width, large->height = n * sheet->height;
    if (!sheet_alloc(sheet, error) || !fill_sheet(large, choice, kind, (float)n * scale, error))
        return false;
    fill_by_means(sheet, large, n);
    return true;
}

static bool make(FlPaperSheet *sheet, const FlPaperChoice *choice, int kind, float scale,
                 GError **error)
{
    const int n = finer(sheet, scale, choice->draft ? 2 : MOST_FINER);
    return n > 1 ? fill_reduced(sheet, choice, kind, scale, n, error)
                 : fill_sheet(sheet, choice, kind, scale, error);
}

const uint8_t *fl_paper_ground(const char *paper)
{
    int kind = 0;
    if (!paper || !fl_text_choice(paper, FL_PAPER_WORDS, &kind))
        return NULL;
    const FlPaperGrain *grain = fl_paper_grain((FlPaperKind)kind);
    return grain->tinted ? grain->colour : NULL;
}

/* *kind becomes a word's, or -1 for a file or "none". */
static bool kind_of(const char *paper, int *kind, GError **error)
{
    *kind = g_str_equal(paper, "auto") ? FL_PAPER_COLD : -1;
    if (*kind >= 0 || g_str_equal(paper, "none") || fl_text_choice(paper, FL_PAPER_WORDS, kind) ||
        fl_picture_named(paper))
        return true;
    return fl_fail(error, FL_ERROR_USAGE,
                   "paper “%s”: expected none, cold, hot, rough, laid, kraft or a " FL_PICTURE_FILES
                   " file",
                   paper);
}

bool fl_paper_check(const char *paper, GError **error)
{
    int kind;
    return kind_of(paper ? paper : "auto", &kind, error);
}

bool fl_paper_sheet_make(const FlPaperChoice *choice, bool plain, int width, int height,
                         FlPaperSheet **sheet, GError **error)
{
    const char *paper = choice->paper ? choice->paper : "auto";
    const bool is_auto = g_str_equal(paper, "auto");
    int kind;
    *sheet = NULL;
    if (!kind_of(paper, &kind, error))
        return false;
    if (g_str_equal(paper, "none"))
        return true;
    const float scale = choice->scale > 0 ? (float)choice->scale : fl_page_scale(width, height);
    const int room = choice->boil > 0 ? ROOM_PX : 0;
    g_autoptr(FlPaperSheet) made = g_new0(FlPaperSheet, 1);
    *made = (FlPaperSheet){.width = width + room,
                           .height = height + room,
                           .boil = choice->boil,
                           .seed = choice->seed,
                           .lights = (!is_auto || plain) && choice->relief > 0};
    if (!make(made, choice, kind, scale, error))
        return false;
    *sheet = g_steal_pointer(&made);
    return true;
}

void fl_paper_sheet_free(FlPaperSheet *sheet)
{
    if (!sheet)
        return;
    free(sheet->factor);
    fl_spill_free(sheet->bands);
    free(sheet->tooth);
    g_free(sheet);
}

/* ---- use ------------------------------------------------------------------------------------- */

/* The rows of a band. */
static int band_rows(const FlPaperSheet *sheet, int band)
{
    return MIN(BAND_ROWS, sheet->height - band * BAND_ROWS);
}

/* Bytes of so many rows of the light. */
static size_t light_bytes(const FlPaperSheet *sheet, int rows)
{
    return 4 * (size_t)sheet->width * (size_t)rows * sizeof *sheet->factor;
}

bool fl_paper_sheet_put_away(FlPaperSheet *sheet, GError **error)
{
    const int n = (sheet->height + BAND_ROWS - 1) / BAND_ROWS;
    if (!(sheet->bands = fl_spill_new((size_t)n, error)))
        return false;
    for (int b = 0; b < n; b++) {
        const uint8_t *rows = (const uint8_t *)sheet->factor + light_bytes(sheet, b * BAND_ROWS);
        if (!fl_spill_put(sheet->bands, (size_t)b, rows, light_bytes(sheet, band_rows(sheet, b)),
                          error))
            return false;
    }
    g_clear_pointer(&sheet->factor, free);
    return true;
}

int fl_paper_sheet_since(const FlPaperSheet *sheet, int frame)
{
    return sheet->boil > 0 ? frame / sheet->boil * sheet->boil : 0;
}

void fl_paper_sheet_origin(const FlPaperSheet *sheet, int frame, int *x, int *y)
{
    const int sheets = sheet->boil > 0 ? frame / sheet->boil : 0;
    FlRng rng = {fl_key(sheet->seed, (uint64_t)sheets)};
    *x = sheet->boil > 0 ? 2 * (int)fl_rng_below(&rng, ROOM_PX / 2) : 0;
    *y = sheet->boil > 0 ? 2 * (int)fl_rng_below(&rng, ROOM_PX / 2) : 0;
}

static void light_row8(const uint16_t *factor, uint8_t *restrict rgba, int n)
{
    for (int i = 0; i < n; i++) {
        const uint32_t value = ((uint32_t)rgba[i] * factor[i] + FL_PAPER_ONE / 2) / FL_PAPER_ONE;
        rgba[i] = (uint8_t)MIN(value, 255);
    }
}

static void light_row16(const uint16_t *factor, uint16_t *rgba, int n)
{
    for (int i = 0; i < n; i++)
        rgba[i] =
            (uint16_t)MIN(((uint64_t)rgba[i] * factor[i] + FL_PAPER_ONE / 2) / FL_PAPER_ONE, 65535);
}

/* The thing that is laid on a sheet: a frame, one of the two, whose corner is at (x, y). */
typedef struct Lit {
    const FlPaperSheet *sheet;
    int x, y, width, height;
    uint8_t *rgba;
    uint16_t *rgba16;
} Lit;

/* A row of the sheet, whose light is `factor`. */
static void light_row(const Lit *lit, int row, const uint16_t *factor)
{
    const size_t at = 4 * (size_t)(row - lit->y) * (size_t)lit->width;
    factor += 4 * (size_t)lit->x;
    if (lit->rgba)
        light_row8(factor, lit->rgba + at, 4 * lit->width);
    if (lit->rgba16)
        light_row16(factor, lit->rgba16 + at, 4 * lit->width);
}

/* The light of a band, from memory or in `room`, which is made; NULL with an error set. */
static const uint16_t *band_of(const FlPaperSheet *sheet, int band, void **room, GError **error)
{
    const size_t bytes = light_bytes(sheet, band_rows(sheet, band));
    if (sheet->factor)
        return sheet->factor + 4 * (size_t)sheet->width * (size_t)(band * BAND_ROWS);
    *room = fl_alloc_scratch(bytes, 1, "a sheet of paper", error);
    return *room && fl_spill_get(sheet->bands, (size_t)band, *room, bytes, error) ? *room : NULL;
}

/* The frame's rows in a band of the sheet. */
static bool light_band(const Lit *lit, int band, GError **error)
{
    const int first = band * BAND_ROWS, end = first + band_rows(lit->sheet, band);
    g_autofree void *room = NULL;
    const uint16_t *factor = band_of(lit->sheet, band, &room, error);
    for (int y = MAX(first, lit->y); factor && y < MIN(end, lit->y + lit->height); y++)
        light_row(lit, y, factor + 4 * (size_t)(y - first) * (size_t)lit->sheet->width);
    return factor != NULL;
}

bool fl_paper_sheet_light(const FlPaperSheet *sheet, int frame, int width, int height,
                          uint8_t *rgba, uint16_t *rgba16, GError **error)
{
    Lit lit = {sheet, 0, 0, width, height, rgba, rgba16};
    GError *first = NULL;
    fl_paper_sheet_origin(sheet, frame, &lit.x, &lit.y);
#pragma omp parallel for schedule(static)
    for (int band = lit.y / BAND_ROWS; band <= (lit.y + height - 1) / BAND_ROWS; band++) {
        GError *failure = NULL;
        if (!light_band(&lit, band, &failure))
            fl_parallel_error_keep(&first, failure);
    }
    return fl_parallel_error_propagate(error, first);
}

bool fl_paper_sheet_picture(const FlPaperSheet *sheet, int frame, int width, int height,
                            uint8_t *rgba, GError **error)
{
    memset(rgba, FL_SINK_ONE, 4 * (size_t)width * (size_t)height);
    if (!fl_paper_sheet_light(sheet, frame, width, height, rgba, NULL, error))
        return false;
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
        rgba[4 * i + 3] = 255;
    return true;
}

FlTooth fl_paper_sheet_tooth(const FlPaperSheet *sheet, int frame)
{
    int x0, y0;
    if (!sheet)
        return (FlTooth){0};
    fl_paper_sheet_origin(sheet, frame, &x0, &y0);
    const size_t stride = (size_t)sheet->width;
    return (FlTooth){sheet->tooth + (size_t)y0 * stride + (size_t)x0, stride};
}
