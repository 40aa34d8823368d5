/** @file
 * A film as an object: open a drawing, change a setting, ask for any frame, close. Threads and
 * processes: see FlFilm.
 */
#ifndef FLUIDY_FILM_H
#define FLUIDY_FILM_H

#include <fluidy/render.h>

G_BEGIN_DECLS

/**
 * A drawing that is painted frame by frame, in any order, while its options change.
 *
 * Another "tint" or "paper" only composes the frames again; another "style" of a region only paints
 * that region again; no option of the paint reads the drawing again. Painted pictures stay in
 * memory, so that a choice that is taken back shows the earlier ones at once: up to 192 MiB of
 * frames and 64 of drafts, each at most an eighth of the limit ‘memory’.
 *
 * Threads: one film belongs to one thread at a time; several threads may have a film each. While
 * the process has a single thread, drawings are read and drawn in child processes, which are
 * confined; a process with more threads is not forked, and reads and draws them itself.
 */
typedef struct FlFilm FlFilm;

/**
 * The film of a drawing; no file is read yet.
 *
 * inputs: NULL-terminated list of patterns, globs, SVG files or one folder; copied.
 * Returns: to be freed with fl_film_close().
 */
FL_API FlFilm *fl_film_open(const char *const *inputs);

FL_API void fl_film_close(FlFilm *film); /**< NULL is fine */

/**
 * Changes an option by its name on the command line, without the dashes: "width", "style", "tint",
 * "paper", "w-temp", … The value is written as on the command line. It holds from the next call on;
 * options of files, such as "output", are for fl_film_render() alone.
 *
 * region: the name of the region that it is for; NULL: all of them, or the whole film. value:
 * copied; NULL: the default again.
 *
 * Returns: false with FL_ERROR_USAGE, which names the option, the value and what was expected; all
 * options then keep their values. A region that does not exist is told by the next frame.
 */
FL_API bool fl_film_set(FlFilm *film, const char *region, const char *name, const char *value,
                        GError **error);

/**
 * Takes the config of a text, whose path gives the folder of its paths and a name for messages; no
 * file is read. Settings that equal those of the earlier config keep their paint.
 *
 * text: as in fluidy-svg.conf(5), copied; NULL: the file `path`, which is read again; both NULL: no
 * config. Returns: false with FL_ERROR_USAGE; the earlier config then stays.
 */
FL_API bool fl_film_set_config(FlFilm *film, const char *path, const char *text, GError **error);

/** Calls to the program. Zero it and set `size`, so that versions understand each other. */
typedef struct FlFilmCalls {
    size_t size; /**< sizeof(FlFilmCalls); required */
    /** Called now and then from the calling thread; false stops with FL_ERROR_INTERRUPTED. */
    bool (*progress)(const FlProgress *progress, void *data);
    /** Called with one line about something odd in the input, without a line feed. */
    void (*warning)(const char *message, void *data);
    /** Called with one line about what was done. */
    void (*note)(const char *message, void *data);
    void *data; /**< handed to each of them */
    /** Called now and then, from any thread, also within a frame; true stops what is being done
     * with FL_ERROR_INTERRUPTED. */
    bool (*stopped)(void *data);
    /** Called with the path of each file and folder that is read, but for the drawings' own. */
    void (*reads)(const char *path, void *data);
} FlFilmCalls;

/** Sets the calls of a film; they hold from the next call on. NULL: no calls. */
FL_API void fl_film_set_calls(FlFilm *film, const FlFilmCalls *calls);

/** Facts about a drawing. Belongs to the film; later versions may add fields at the end. */
typedef struct FlFilmInfo {
    int n_frames;     /**< of the drawing, without those that are left out */
    int width;        /**< of the frames, px */
    int height;       /**< of the frames, px */
    int n_regions;    /**< that are painted */
    const char *name; /**< common to the names of the files */
    double fps;       /**< frames per second at which it is played */
    bool transparent; /**< frames have no background */
} FlFilmInfo;

/**
 * Reads the drawing, if it is not read or its options have changed.
 *
 * Returns: valid until the next call; NULL with an error of FL_ERROR.
 */
FL_API const FlFilmInfo *fl_film_info(FlFilm *film, GError **error);

/** A frame. Belongs to the film; later versions may add fields at the end. */
typedef struct FlFilmFrame {
    int frame;           /**< from 0 */
    int number;          /**< as in the name of its file */
    int width;           /**< px */
    int height;          /**< px */
    const uint8_t *rgba; /**< width * height * 4 straight sRGBA, row-major without padding */
} FlFilmFrame;

/**
 * Paints and composes a frame: the bytes that fl_render() writes with the same options, whatever
 * was asked for before. Frames may come in any order; one that follows from pictures that are not
 * kept has these painted first, and where fronts or stains mark the paper, earlier frames are
 * composed first.
 *
 * frame: 0 to n_frames - 1. Returns: valid until the next call; NULL with an error of FL_ERROR,
 * after which the film can still be used.
 */
FL_API const FlFilmFrame *fl_film_frame(FlFilm *film, int frame, GError **error);

/**
 * Makes drafts small: px of which no side is longer than the half; 0: half as long as in the
 * frames. Without effect on the frames.
 */
FL_API void fl_film_set_draft_side(FlFilm *film, int most_side);

/** The number of a frame of the last info, as in the name of its file; frame: 0 to n_frames - 1. */
FL_API int fl_film_number(const FlFilm *film, int frame);

/** As fl_film_info(), of drafts: they have their own size, and the drawing is read for them. */
FL_API const FlFilmInfo *fl_film_draft_info(FlFilm *film, GError **error);

/**
 * Drafts a frame, to be seen at once: with detail "draft", in the half size in which that is
 * painted, and as if the film began with this frame, unless the one before was drafted already. So
 * it depends on the order of the calls, and later frames follow it; it is kept as it is until an
 * option of its paint changes. Paint of a loop, whose beginning follows from its end, is painted
 * from there.
 */
FL_API const FlFilmFrame *fl_film_draft(FlFilm *film, int frame, GError **error);

/** The drawing in a frame, without paint, in the size in which drafts are drawn. Returns: valid
 * until the next call. */
FL_API const FlFilmFrame *fl_film_drawing(FlFilm *film, int frame, GError **error);

/** The same with each region in a colour of its own. */
FL_API const FlFilmFrame *fl_film_map(FlFilm *film, int frame, GError **error);

/** A region of a film. Belongs to the film; later versions may add fields at the end. */
typedef struct FlFilmRegion {
    const char *name;  /**< unique; the name in settings */
    const char *layer; /**< path of the layers that contain it, with / between; "": none */
    const char *paint; /**< "#rrggbb", "gradient" or "image": of most of its area */
    const char *style; /**< that paints it; NULL: it is drawn as it is, or left out */
    bool left_out;     /**< it is neither painted nor drawn */
    uint8_t colour[3]; /**< in fl_film_map() */
} FlFilmRegion;

/** The regions of the drawing, *n of them. Returns: valid until the next call; NULL with an error
 * of FL_ERROR. */
FL_API const FlFilmRegion *fl_film_regions(FlFilm *film, int *n, GError **error);

/** Counts of the work that a film has done so far. Belongs to the film; later versions may add
 * fields at the end. */
typedef struct FlFilmStats {
    int n_read;     /**< number of times that the drawing was read */
    int n_painted;  /**< pictures of regions that an engine has made or kept at rest */
    int n_composed; /**< frames */
} FlFilmStats;

/** Returns: valid until the next call. */
FL_API const FlFilmStats *fl_film_stats(FlFilm *film);

/** Writes the film to files, as fl_render() with its options. */
FL_API bool fl_film_render(FlFilm *film, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlFilm, fl_film_close)

G_END_DECLS

#endif
