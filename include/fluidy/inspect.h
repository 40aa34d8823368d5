/* What a drawing is made of, before it is painted. */
#ifndef FLUIDY_INSPECT_H
#define FLUIDY_INSPECT_H

#include <fluidy/render.h>

G_BEGIN_DECLS

typedef enum FlListing {
    FL_LISTING_TABLE,  /**< a line per region, the columns padded with spaces */
    FL_LISTING_CONFIG, /**< a config file with a section per region, to start from */
} FlListing;

/**
 * The regions of a drawing as text. Of the options, those under "What is read" count, and the
 * config, the size and the warning callback.
 *
 * Returns: to be freed with g_free(); NULL with an error of FL_ERROR.
 */
FL_API char *fl_list_regions(const FlRenderOptions *options, FlListing listing, GError **error);

/**
 * Writes a map of every frame to options->output (NULL: "fluidy/NAME_map_%04d.png"): every region
 * that is painted in a colour of its own, the others grey, with a legend at the right.
 *
 * options->note is told where the maps are. Returns: false with an error of FL_ERROR.
 */
FL_API bool fl_map_regions(const FlRenderOptions *options, GError **error);

G_END_DECLS

#endif
