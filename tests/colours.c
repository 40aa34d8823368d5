/*
 * Checks that painted regions have the colours of the drawing, and the contrast of the paint.
 *
 * usage: colours STYLE FOLDER...
 *
 * Paints every sequence twice, without a wash and its hues and with them, and looks at each flat,
 * opaque fill of a region in each frame where it is seen, 2 px inside, if that is 64 pixels or
 * more; with a wash, 2000. Printed: the distance of the median colour from the fill, in CIEDE2000,
 * where it is beyond a bound; the number of fills within the bound; and the deviation of the
 * logarithm of the density where a fill is deeper than the paint's border, in 2000 pixels or more,
 * as a share of the exemplar's own. Status 1 if a fill without a wash is beyond 3, or more than
 * a fifth of the fills of a sequence with a wash are beyond 2.5.
 */
#include "base/alloc.h"
#include "delta_e.h"
#include "guides/distance.h"
#include "io/png.h"
#include "job/plan.h"
#include "scratch.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MARGIN_PX = 2, ENOUGH = 64, LARGE = 2000 };

#define BOUND 3.0         // of each fill
#define BOUND_OF_WASH 2.5 // of four fifths of them, when a wash makes them uneven

static void stop_on(GError *error)
{
    if (!error)
        return;
    fprintf(stderr, "colours: %s\n", error->message);
    exit(1);
}

/** The first run of the same region and fill. */
static int first_like(const FlDrawList *draws, int r)
{
    int first = 0;
    while (draws->draw[first].region != draws->draw[r].region ||
           memcmp(draws->draw[first].rgb, draws->draw[r].rgb, 3) != 0)
        first++;
    return first;
}

/** The run that is seen at each pixel, or the first like it, counted from 1; 0: none that is flat,
 * opaque and painted. */
static uint16_t *find_tops(const FlPlan *plan, const FlDrawList *draws)
{
    const FlShapes *shapes = &plan->shapes;
    const size_t width = (size_t)fl_drawing_width(shapes->drawing);
    uint16_t *top = g_new0(uint16_t, width * (size_t)fl_drawing_height(shapes->drawing));
    for (int r = 0; r < draws->n; r++) {
        const FlDraw *draw = &draws->draw[r];
        const bool plain = shapes->painted_of[draw->region] >= 0 && !draw->picture &&
                           draw->alpha == 255 && draw->blend_mode == FL_BLEND_MODE_OVER;
        const int first = first_like(draws, r);
        const FlRect box = draw->area.box;
        for (int y = 0; y < box.height; y++)
            for (int x = 0; x < box.width; x++) {
                const uint8_t coverage = draw->coverage[(size_t)y * (size_t)box.width + (size_t)x];
                if (coverage)
                    top[(size_t)(box.y + y) * width + (size_t)(box.x + x)] =
                        plain && coverage == 255 ? (uint16_t)(first + 1) : 0;
            }
    }
    return top;
}

/** The level below which half of the pixels are. */
static uint8_t median_of(const int count[256], int total)
{
    int level = 0;
    for (int sum = count[0]; 2 * sum < total; sum += count[level])
        level++;
    return (uint8_t)level;
}

/** Mean and deviation of the logarithm of paint's density over the paper's. */
typedef struct Contrast {
    double n, sum, squares;
} Contrast;

static void add_pixel(Contrast *contrast, const uint8_t *rgb, const uint8_t paper[3])
{
    double density = 0;
    for (int c = 0; c < 3; c++)
        density += log((paper[c] + 0.5) / (rgb[c] + 0.5));
    const double level = log(MAX(fabs(density), 0.01));
    contrast->n++, contrast->sum += level, contrast->squares += level * level;
}

static double deviation(const Contrast *c)
{
    const double mean = c->sum / c->n;
    return sqrt(MAX(c->squares / c->n - mean * mean, 0));
}

/** Depth below the contour of what a mask holds; to be freed with free(). */
static float *depth_of(const uint8_t *mask, int width, int height)
{
    GError *error = NULL;
    float *depth = fl_alloc((size_t)width * height, sizeof *depth, "depths", &error);
    if (depth)
        fl_distance(mask, width, height, depth, &error);
    stop_on(error);
    return depth;
}

static double contrast_of_style(const FlStyle *style)
{
    Contrast contrast = {0};
    const size_t pixels = (size_t)style->width * style->height;
    for (int t = 0; t < style->n_frames; t++) {
        const uint8_t *rgb = style->rgb + 3 * t * pixels;
        g_autofree float *depth = depth_of(style->mask + t * pixels, style->width, style->height);
        for (size_t p = 0; p < pixels; p++)
            if (depth[p] >= style->border_px)
                add_pixel(&contrast, rgb + 3 * p, style->paper);
    }
    return deviation(&contrast);
}

typedef struct Tally {
    double of_style; // deviation
    bool washed;
    int fills, within;
    double worst;
    double shares; // sum over the large ones
    int large;
    bool off; // too many fills are beyond the bound
} Tally;

/** CIEDE2000. */
static double bound_of(const Tally *tally)
{
    return tally->washed ? BOUND_OF_WASH : BOUND;
}

typedef struct Look {
    int count[3][256], total;
    Contrast contrast;
} Look;

static Look look_at(const FlPicture *picture, const uint16_t *top, uint16_t draw,
                    const uint8_t paper[3], float border_px)
{
    Look look = {0};
    const size_t pixels = (size_t)picture->width * picture->height;
    g_autofree uint8_t *mask = g_malloc(pixels);
    for (size_t p = 0; p < pixels; p++)
        mask[p] = top[p] == draw ? 255 : 0;
    g_autofree float *depth = depth_of(mask, picture->width, picture->height);
    for (size_t p = 0; p < pixels; p++) {
        const uint8_t *rgb = picture->rgba + 4 * p;
        if (depth[p] < MARGIN_PX)
            continue;
        look.total++;
        for (int c = 0; c < 3; c++)
            look.count[c][rgb[c]]++;
        if (depth[p] >= border_px)
            add_pixel(&look.contrast, rgb, paper);
    }
    return look;
}

static void judge_frame(const FlPlan *plan, int frame, const FlPicture *picture, Tally *tally)
{
    const FlShapes *shapes = &plan->shapes;
    GError *error = NULL;
    const double bound = bound_of(tally);
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(shapes->drawing, frame, &error);
    stop_on(error);
    g_autofree uint16_t *top = find_tops(plan, draws);
    for (int r = 0; r < draws->n; r++) {
        uint8_t median[3];
        if (shapes->painted_of[draws->draw[r].region] < 0 || first_like(draws, r) < r)
            continue;
        const FlRegionPlan *painted = &shapes->painted[shapes->painted_of[draws->draw[r].region]];
        const Look look =
            look_at(picture, top, (uint16_t)(r + 1), plan->paper, painted->style->border_px);
        if (look.total < (tally->washed ? LARGE : ENOUGH))
            continue;
        for (int c = 0; c < 3; c++)
            median[c] = median_of(look.count[c], look.total);
        const uint8_t *fill = draws->draw[r].rgb;
        const double d = delta_e(median, fill);
        tally->fills++, tally->within += d <= bound, tally->worst = MAX(tally->worst, d);
        if (d > bound)
            printf("  frame %d, %s: #%02x%02x%02x for #%02x%02x%02x, %.1f, %d pixels\n",
                   fl_drawing_number(shapes->drawing, frame),
                   fl_drawing_region(shapes->drawing, draws->draw[r].region)->name, median[0],
                   median[1], median[2], fill[0], fill[1], fill[2], d, look.total);
        if (look.contrast.n >= LARGE)
            tally->large++, tally->shares += deviation(&look.contrast) / tally->of_style;
    }
}

static void print(const char *name, const Tally *tally)
{
    printf("%-22s %s a wash: %4d of %4d within %.1f, worst %4.1f", name,
           tally->washed ? "with" : "without", tally->within, tally->fills, bound_of(tally),
           tally->worst);
    if (tally->large > 0)
        printf("; contrast %3.0f %% in %d", 100 * tally->shares / tally->large, tally->large);
    printf("\n");
    fflush(stdout);
}

static void judge(const char *folder, const char *style, Tally *all)
{
    GError *error = NULL;
    g_autoptr(Scratch) scratch = scratch_make();
    g_autofree char *output = g_build_filename(scratch, "%d.png", NULL);
    const char *const inputs[] = {folder, NULL};
    const FlSetting settings[] = {{.name = "style", .value = style},
                                  {.name = "wash", .value = "0"},
                                  {.name = "hue", .value = "0"}};
    const FlRenderOptions options = {.size = sizeof options,
                                     .inputs = inputs,
                                     .settings = settings,
                                     .n_settings = all->washed ? 1 : 3,
                                     .output = output};
    fl_render(&options, &error);
    stop_on(error);
    FlRenderOptions again = options;
    again.overwrite = FL_OVERWRITE_YES;
    g_autoptr(FlPlan) plan = fl_plan_new(&again, &error);
    stop_on(error);
    Tally tally = {.of_style = all->of_style, .washed = all->washed};
    for (int f = 0; f < plan->shapes.n_frames; f++) {
        g_autofree char *file =
            g_strdup_printf("%s/%d.png", scratch, fl_drawing_number(plan->shapes.drawing, f));
        g_autoptr(FlPicture) picture = fl_picture_read_png(file, &error);
        stop_on(error);
        judge_frame(plan, f, picture, &tally);
    }
    g_autofree char *name = g_path_get_basename(folder);
    print(name, &tally);
    all->off |= 5 * tally.within < (tally.washed ? 4 : 5) * tally.fills;
    all->fills += tally.fills, all->within += tally.within;
    all->worst = MAX(all->worst, tally.worst);
    all->shares += tally.shares, all->large += tally.large;
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "usage: colours STYLE FOLDER...\n");
        return 2;
    }
    GError *error = NULL;
    g_autofree char *path = fl_style_find(argv[1], &error);
    stop_on(error);
    g_autoptr(FlStyle) style = fl_style_load(path, &error);
    stop_on(error);
    const double of_style = contrast_of_style(style);
    Tally all[2] = {{.of_style = of_style}, {.of_style = of_style, .washed = true}};
    for (int k = 0; k < 2; k++) {
        for (int i = 2; i < argc; i++)
            judge(argv[i], path, &all[k]);
        print("all", &all[k]);
    }
    return all[0].off || all[1].off;
}
