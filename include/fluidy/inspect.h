/** @file
 * The regions of a drawing, as lists and maps, without painting.
 *
 * Threads: any thread may call these functions, several at a time with outputs of their own. They
 * read and draw as fl_render() does, which may fork.
 */
#ifndef FLUIDY_INSPECT_H
#define FLUIDY_INSPECT_H

#include <fluidy/render.h>

G_BEGIN_DECLS

/** The format of a list of regions. */
typedef enum FlListing {
    FL_LISTING_TABLE,  /**< a line per region, the columns padded with spaces */
    FL_LISTING_CONFIG, /**< a config file with a section per region, as a starting point */
    FL_LISTING_JSON,   /**< an object with the drawing's size and frames, and a list of regions */
} FlListing;

/**
 * The regions of a drawing as text. Uses the options under "What is read", the config, the size
 * and the warning callback.
 *
 * Returns: to be freed with g_free(); NULL with an error of FL_ERROR.
 */
FL_API char *fl_list_regions(const FlRenderOptions *options, FlListing listing, GError **error);

/** A region of a drawing. Strings are its own. */
typedef struct FlRegionInfo {
    char *name;      /**< unique, of [a-z0-9-]; the name in settings and file names */
    char *paint;     /**< "#rrggbb", "gradient" or "image": of most of its area */
    char *layer;     /**< path of the layers that contain it, with / between; "": not in a layer */
    char *section;   /**< the config section that made the region; NULL: no section did */
    int n_frames;    /**< in which it is drawn */
    int first_frame; /**< the number of the first of them; 0 if no frame has it */
    int n_shapes;    /**< most that it had in a frame */
    double area_px;  /**< mean over those frames, px */
    bool painted;    /**< false: it is drawn over the paint as it is */
} FlRegionInfo;

/** A drawing and its regions, from the bottom up. Later versions may add fields at the end. */
typedef struct FlRegionList {
    int width;                   /**< px */
    int height;                  /**< px */
    int n_frames;                /**< of the drawing */
    int n_regions;               /**< in `region` */
    FlRegionInfo *const *region; /**< of n_regions */
} FlRegionList;

/**
 * The regions of a drawing as data; uses the same options as fl_list_regions().
 *
 * Returns: to be freed with fl_region_list_free(); NULL with an error of FL_ERROR.
 */
FL_API FlRegionList *fl_region_list_new(const FlRenderOptions *options, GError **error);

FL_API void fl_region_list_free(FlRegionList *list); /**< NULL is fine */

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlRegionList, fl_region_list_free)

/**
 * Writes a map of every frame to options->output (NULL: "fluidy/NAME_map_%04d.png"): each painted
 * region in a colour of its own, the others grey, with a legend at the right.
 *
 * options->note receives the path of the maps. Returns: false with an error of FL_ERROR.
 */
FL_API bool fl_map_regions(const FlRenderOptions *options, GError **error);

/**
 * Writes every frame as it is understood, to options->output (NULL: "fluidy/NAME_flat_%04d.png"):
 * its regions over each other, filled as in the drawing, not painted. What looks different from
 * the drawing there will do so in paint.
 *
 * options->note is told where the pictures are. Returns: false with an error of FL_ERROR.
 */
FL_API bool fl_flatten(const FlRenderOptions *options, GError **error);

/**
 * Writes a look, one file that holds how the options paint: their config and settings, styles that
 * do not come with the program, pictures of paper and background, and a thumbnail of a frame in the
 * middle, 320 px wide. FlRenderOptions.config may name it then.
 *
 * path ends in .fluidy; it is replaced if options->overwrite says so. options->note is told.
 * Returns: false with an error of FL_ERROR: FL_ERROR_LIMIT if the look gets too large.
 */
FL_API bool fl_save_look(const FlRenderOptions *options, const char *path, GError **error);

G_END_DECLS

#endif
