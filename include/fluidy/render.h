/** @file
 * Paint a drawing: the whole job, from SVG frames to painted frames.
 *
 * Threads: any thread may render, several at a time with outputs of their own; each render uses a
 * team of threads of its own. Processes: while the calling process has a single thread, drawings
 * are read and drawn in child processes, which are confined; a process with more threads is not
 * forked, and reads and draws them itself.
 */
#ifndef FLUIDY_RENDER_H
#define FLUIDY_RENDER_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

G_BEGIN_DECLS

/** The treatment of gaps in the frame numbers. */
typedef enum FlMissing {
    FL_MISSING_UNSET, /**< the config's, else FL_MISSING_ERROR */
    FL_MISSING_ERROR, /**< FL_ERROR_INPUT, which lists them */
    FL_MISSING_HOLD,  /**< the frame before is repeated */
    FL_MISSING_SKIP,  /**< no output for them */
} FlMissing;

/** The source of the frames: files, or layers, pages or moments of one file. */
typedef enum FlFramesFrom {
    FL_FRAMES_UNSET,  /**< the config's, else FL_FRAMES_AUTO */
    FL_FRAMES_AUTO,   /**< each file is one; of a lone file its pages are, if it has several, or
                           moments, if it moves by SMIL or CSS */
    FL_FRAMES_FILES,  /**< each file is one, also a lone one that moves: as it is without motion */
    FL_FRAMES_LAYERS, /**< the layers of one file are, the lowest first */
    FL_FRAMES_PAGES,  /**< the pages of one file are, of Inkscape or FBF.SVG */
    FL_FRAMES_TIME,   /**< moments of one file are, FlRenderOptions.fps in a second */
} FlFramesFrom;

/** The key by which leaves of different frames are grouped into one region. */
typedef enum FlRegionKey {
    FL_KEY_UNSET, /**< the config's, else FL_KEY_AUTO */
    FL_KEY_AUTO,  /**< the layer label without frame numbers, and the paint; else by overlap */
    FL_KEY_FILL,  /**< the computed paint alone */
    FL_KEY_ID,    /**< the leaf's id, without the frame's number */
    FL_KEY_CLASS, /**< the innermost class attributes */
    FL_KEY_LABEL, /**< the layer label alone */
    FL_KEY_TREE,  /**< the place in the document tree */
} FlRegionKey;

/** The rendering of the drawing's strokes. */
typedef enum FlStrokes {
    FL_STROKES_UNSET, /**< the config's, else FL_STROKES_AUTO */
    FL_STROKES_AUTO,  /**< drawn over the paint; but painted where the drawing is mostly strokes,
                           and those without a fill that are 3 % of the page's side or wider */
    FL_STROKES_KEEP,  /**< drawn over the paint */
    FL_STROKES_PAINT, /**< painted as regions */
    FL_STROKES_DROP,  /**< left out */
} FlStrokes;

/** Registration of frames that an exporter has shifted. */
typedef enum FlRegistration {
    FL_REGISTRATION_UNSET, /**< the config's, else FL_REGISTRATION_OFF */
    FL_REGISTRATION_OFF,
    FL_REGISTRATION_ON, /**< for exporters that shift each frame to begin at 0,0, as OpenToonz
                           does: each is moved back so that most of it stands still */
} FlRegistration;

/** The sandbox of the processes that read and draw untrusted files. */
typedef enum FlSandboxing {
    FL_SANDBOXING_UNSET, /**< FL_SANDBOXING_AUTO */
    FL_SANDBOXING_AUTO,  /**< as far as the system lets them, with a warning if a part is missing */
    FL_SANDBOXING_REQUIRE, /**< FL_ERROR_USAGE or FL_ERROR_INPUT if a part is missing */
    FL_SANDBOXING_OFF,     /**< processes of their own, but not confined */
} FlSandboxing;

/** The colour space in which layers are blended. */
typedef enum FlBlendSpace {
    FL_BLEND_UNSET, /**< the config's, else FL_BLEND_SRGB */
    FL_BLEND_SRGB,  /**< the colour space of SVG by default */
    FL_BLEND_LINEAR,
} FlBlendSpace;

/** The size of the files of a region's paint. */
typedef enum FlPaintArea {
    FL_PAINT_AREA_UNSET,  /**< FL_PAINT_AREA_FRAME */
    FL_PAINT_AREA_FRAME,  /**< as the frames, so that other programs can stack them */
    FL_PAINT_AREA_REGION, /**< as the region in all frames, which a merge reads sooner */
} FlPaintArea;

/** The treatment of output files that exist. */
typedef enum FlOverwrite {
    FL_OVERWRITE_REFUSE, /**< FL_ERROR_EXISTS before anything is painted */
    FL_OVERWRITE_YES,    /**< replace each one, once the new file is complete */
    FL_OVERWRITE_KEEP,   /**< keep them; write only those that are missing */
} FlOverwrite;

/** A setting of a region, which overrides the config; what neither sets is the default. */
typedef struct FlSetting {
    const char *region; /**< a region's name; NULL: every region */
    const char *name;   /**< a key of a [region] section: "style", "tint", "w-temp", … */
    const char *value;  /**< as in a config file; paths are relative to the working directory */
} FlSetting;

/** The progress of a render. */
typedef struct FlProgress {
    const char *stage;  /**< "read", "masks", "style" (one is made larger), "guides", "lead-in" of a
                             loop, "paint"; static */
    const char *region; /**< the region's name; NULL: all of them */
    int region_index;   /**< from 0; -1: all of them */
    int n_regions;      /**< painted regions; 0: not known yet */
    int frame;          /**< the frame's number, as in its file name */
    int done;           /**< frames of this stage and region */
    int total;          /**< to be done; 0: not known yet */
    double share;       /**< of the whole render, 0..1; of the style in the stage “style” */
    double elapsed_s;   /**< seconds since the start */
    double frame_s;     /**< seconds that the last frame of this stage took; 0 before the first */
    double remaining_s; /**< estimate for the rest; negative: not known yet */
} FlProgress;

/**
 * The options of a render. Zero the struct and set `size`, so that a program and a library of
 * different versions understand each other: new fields come last. A zero means the default; inputs
 * are required. The config gives what is not set here; a negative gap means no gap.
 *
 * Strings belong to the caller and must stay until fl_render() returns. Paths and patterns are
 * relative to the working directory. A pattern has one frame number, written %d, %04d or ####.
 */
typedef struct FlRenderOptions {
    size_t size; /**< sizeof(FlRenderOptions); required */

    /* Input. */
    const char *const
        *inputs;        /**< NULL-terminated list of patterns, globs, SVG files or one folder */
    const char *frames; /**< "1001-1096", "1-96x2", "1,5,9"; NULL: all that are found */
    FlMissing missing;  /**< treatment of gaps in the numbers */
    FlFramesFrom frames_from; /**< source of the frames */
    double from_s;            /**< of FL_FRAMES_TIME: the first moment, seconds */
    double to_s;              /**< its end, seconds; 0: all */
    const char *canvas; /**< "WxH" or "WxH+X+Y" in px, for SVGs without a size; NULL: theirs */
    FlRegistration registration; /**< of frames that an exporter has shifted */
    const char *flow; /**< pattern of files, one per frame, may hold {region}: the motion into it
                         from the frame before; NULL: no flow files */
    FlRegionKey key;  /**< key that groups leaves into regions */
    FlStrokes stroke; /**< rendering of strokes */
    bool strict;      /**< a warning is an error: FL_ERROR_INPUT, of a style FL_ERROR_STYLE */
    FlSandboxing sandbox; /**< confines the processes that read drawings */

    /* Painting. */
    const char *config; /**< a file as in fluidy-svg.conf(5), or several, separated by semicolons,
                           of which later ones override earlier ones; NULL: no config */
    const char *config_text; /**< text in place of that file's, which need not exist; its paths are
                                relative to the file's folder; NULL: the file's */
    const FlSetting *settings; /**< override the config's; of several, the last wins */
    size_t n_settings;         /**< in `settings` */
    const char *only_region;   /**< name, or several with commas between: paint these regions alone,
                                  on a transparent page; NULL: all */
    bool loop;                 /**< the end leads into the beginning, for films that are repeated */
    uint64_t seed; /**< same input, options and seed: same bytes; 0: the config's, else 1 */

    /* Output. */
    const char *output; /**< pattern; NULL: the config's, else "fluidy/NAME_%04d.png", NAME from the
                           input */
    const char *format; /**< "png", "png16", "exr", "mov", …; NULL: as the output's name ends */
    bool vectors;       /**< of OpenEXR files: also the motion of each pixel, backward.u and .v */
    bool thickness;     /**< of OpenEXR files: also the thickness of the paint at each pixel */
    bool no_frames; /**< if the output is a film, write the film alone, without its frames as PNG
                       files */
    const char *layers; /**< pattern with {region} for one RGBA file per region; NULL: those of the
                           config; "": no layers */
    const char *paint;  /**< the same for the paint itself, before colours and stacking; NULL: no
                           paint files */
    FlPaintArea paint_area; /**< size of the files of `paint` */
    bool merge; /**< do not paint: compose the files of `paint` that other runs have written */
    /** "K/N": merge the K-th of N parts of the frames alone, without their film; "film": make the
     *  film of the frames that such merges have composed; NULL: all */
    const char *part;
    const char *directions; /**< PNG or JPEG of directions, see fluidy-svg(1); NULL: none */
    const char *background; /**< "#rrggbb", "none", an image or a pattern; NULL: the paper */
    double stain_time;      /**< frames at 24 per second in which stains fade to a third; 0: 7 */
    double overrun; /**< px on a page of 480 px that fronts go beyond shapes, ..40; 0: 5, below 0:
                       no overrun */
    const char *camera; /**< the region that the paper moves with; "none"; "auto", NULL: the largest
                           that covers two fifths of the page or more */
    /** "cold", "hot", "rough", "laid", "kraft", a PNG or JPEG file or "none"; "auto", NULL: cold
     * where there is no background, else its tooth alone */
    const char *paper;
    double paper_scale;  /**< factor on the grain's size, which follows the page's; 0: 1 */
    double paper_relief; /**< ..2; 0: 1, below 0: no relief */
    uint64_t paper_seed; /**< 0: 1 */
    int paper_boil;      /**< frames after which another part of the sheet is taken; 0: never */
    int width;           /**< px; 0: from the height, by the drawing's aspect; both 0: scale */
    int height;          /**< likewise */
    double scale;        /**< px of output per px of the drawing; 0: 1 */
    int most_side;       /**< px of the longer side: a larger picture is made as small; 0: any */
    double dpi;          /**< px per inch, for drawings sized in mm, cm, in, pt; 0: 96 */
    double gap;          /**< px of paper around a region that hides others, 0..32 */
    FlBlendSpace blend;  /**< in which layers are blended */
    const char *audio;   /**< a file whose first sound films have; NULL: none */
    double audio_from;   /**< seconds of it before the first frame */
    double fps; /**< frames per second of an output that is a film; 0: the config's, else 24 */
    FlOverwrite overwrite; /**< treatment of files that exist */
    /** Resume an interrupted render even with FL_OVERWRITE_YES, which otherwise starts anew. The
     *  others always resume. */
    bool resume;
    /** A folder in which paint is kept and from which it is taken while all that decides it is the
     *  same; "auto": paint below the user's cache folder; NULL, "off": no cache. */
    const char *cache;
    int cache_size;         /**< MiB, beyond which the cache drops what was used least; 0: 8192 */
    const char *stats;      /**< a file for JSON lines about every frame, region and level; NULL: no
                               statistics */
    const char *provenance; /**< a file for JSON of all that the files of this render were made
                               from, and their SHA-256; NULL: none */
    const char *report;     /**< a folder for the HTML report, index.html; NULL: no report */
    const char
        *dump; /**< a folder for guides, fields and T_temp as pictures and data; NULL: no dump */
    const char *ebsynth; /**< a folder for pairs of guides and ebsynth's command lines; with `merge`
                            and no `paint`, the folder with the pictures that ebsynth painted; NULL:
                            no export */

    /* How it runs. */
    bool watch;   /**< it is rendered again and again: an interrupted render leaves no state, since
                       its paint is in the cache. The program's loop is not part of fl_render() */
    bool dry_run; /**< check everything and estimate the time, without writing files */
    /** Paint nothing, and tell which files are as they would be made now: frames, layers, paint and
     *  film carry a digest of the drawings, fonts, styles, settings and versions that they were
     * made from, and one of themselves. Each file that differs is a note, and together they are
     *  FL_ERROR_CHANGED. Lists of sums carry none. */
    bool verify;
    int threads; /**< 0: one per processor. The output bytes are the same for every number of
                    threads */
    /** Called after every frame of a stage, now and then while frames are read, from the calling
     * thread; false stops the render with FL_ERROR_INTERRUPTED. NULL: no progress is reported. */
    bool (*progress)(const FlProgress *progress, void *data);
    /** Called now and then, from any thread, while another program is waited for; true stops the
     * render with FL_ERROR_INTERRUPTED. NULL: the render cannot be stopped there. */
    bool (*stopped)(void *data);
    /** Called with one line about something odd in the input; the message has no line feed. */
    void (*warning)(const char *message, void *data);
    /** Called with one line about what was done, such as where the frames are. */
    void (*note)(const char *message, void *data);
    /** Called with the path of each file and folder that the render reads, but for
     *  the drawings' own files: what they refer to, folders of styles, papers, flow. */
    void (*reads)(const char *path, void *data);
    bool verbose; /**< also notes about decisions, such as the style of a region */
    void *data;   /**< handed to progress, stopped, warning, note and reads */
} FlRenderOptions;

/**
 * Starts the processes that read and draw drawings, in a sandbox, for all drawings of this program.
 *
 * The library starts them with the first drawing, but only a process with one thread may fork: call
 * this first in a program that starts threads. It forks; the processes end with the program.
 *
 * Returns: false if none could be started; drawings are then read without a sandbox, with a
 * warning.
 */
FL_API bool fl_start_workers(void);

/**
 * Renders. Each file appears under its name when it is complete.
 *
 * While frames are painted, a hidden file beside them, .NAME.state, holds the state that the next
 * frame needs; it is removed when the render is complete. The same call resumes a render that was
 * stopped or killed, and gives the same bytes as an uninterrupted one. A film without its frames
 * starts anew. FL_ERROR_CHANGED if anything that decides the bytes has changed meanwhile.
 *
 * Returns: false with an error of FL_ERROR; the frames written so far stay.
 */
FL_API bool fl_render(const FlRenderOptions *options, GError **error);

G_END_DECLS

#endif
