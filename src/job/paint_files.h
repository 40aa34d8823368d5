/* The paint of regions as files: written by one run, composed by another. */
#ifndef FLUIDY_JOB_PAINT_FILES_H
#define FLUIDY_JOB_PAINT_FILES_H

#include "job/region_plan.h"

/** The file of a region's paint that ebsynth writes, below the folder of --ebsynth. */
#define FL_EBSYNTH_OUTPUT "{region}/out_%04d.png"

/**
 * The file of a region's paint in a frame; held frames share the file of the first.
 *
 * Returns: to be freed with g_free(); NULL with FL_ERROR_USAGE.
 */
char *fl_paint_file_name(const char *pattern, const FlDrawing *drawing, const FlRegionPlan *region,
                         int frame, GError **error);

/**
 * Writes the paint of a region, in the exemplar's colours, as PNG: as large as the frame, or as
 * painted->rect, with its place. mark: see fl_mark_text().
 */
bool fl_paint_file_save(const FlPaintedRegion *painted, FlPaintArea area, const char *path,
                        const char *mark, bool overwrite, GError **error);

/** Sets region->place if the file of its paint in the first frame exists and has a place. */
void fl_paint_file_find_place(const FlDrawing *drawing, FlRegionPlan *region);

/** Reads the part painted->rect of such a file, or one that has that part alone. FL_ERROR_INPUT. */
bool fl_paint_file_load(FlPaintedRegion *painted, const char *path, GError **error);

#endif
