/* An SVG sequence as regions: which parts of the drawing are painted as one, in every frame. */
#ifndef FLUIDY_REGIONS_FILM_H
#define FLUIDY_REGIONS_FILM_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/** A region: the leaves that are one area of paint through the whole film [DESIGN §4]. */
typedef struct FlRegion {
    char *name;      // unique, made of [a-z0-9-], stable for the same input; used in file names
    char *label;     // the layer label path without frame numbers; "" if the drawing has none
    char *paint;     // "#rrggbb", "gradient", "image": what it is mostly filled with
    int n_present;   // frames in which it is drawn
    int first_frame; // index of the first of them
    double area_px;  // mean area over those frames
    int n_leaves;    // most leaves it had in a frame
    bool paintable;  // false: drawn as it is over the paint (strokes, shading overlays, images)
} FlRegion;

/**
 * One step of a frame's stack, from the bottom up: leaves of one region that follow each other in
 * paint order. A region that lies both below and above another has several runs in a frame.
 */
typedef struct FlRun {
    int region;        // index into the film's regions
    uint8_t *coverage; // width * height, 0..255: the whole shape, hidden parts included
    uint8_t *picture;  // width * height * 4 straight sRGBA as the SVG draws it; NULL: flat `rgb`
    uint8_t rgb[3];    // the fill
    uint8_t alpha;     // opacity of the run, 255 opaque; coverage is without it
} FlRun;

typedef struct FlRuns {
    int n;
    FlRun *run;
} FlRuns;

typedef struct FlFilm FlFilm;

int fl_film_frames(const FlFilm *film);
int fl_film_width(const FlFilm *film);
int fl_film_height(const FlFilm *film);
int fl_film_regions(const FlFilm *film);
const FlRegion *fl_film_region(const FlFilm *film, int region);

/** The file and the frame number (as in the file's name) of a frame index; for messages. */
const char *fl_film_file(const FlFilm *film, int frame);
int fl_film_number(const FlFilm *film, int frame);

/** Rasterises a frame. Any thread may call it. Returns: to be freed with fl_runs_free(). */
FlRuns *fl_film_runs(const FlFilm *film, int frame, GError **error);

/** The region's whole-shape mask in a frame: the union of its runs' coverage. */
void fl_runs_mask(const FlRuns *runs, int region, int width, int height, uint8_t *coverage);

void fl_runs_free(FlRuns *runs); // NULL is fine
void fl_film_free(FlFilm *film); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlRuns, fl_runs_free)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlFilm, fl_film_free)

#endif
