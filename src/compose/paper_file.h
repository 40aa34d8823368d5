/* A picture as a sheet of paper: a scan, or a relief of one's own. */
#ifndef FLUIDY_COMPOSE_PAPER_FILE_H
#define FLUIDY_COMPOSE_PAPER_FILE_H

#include "compose/paper_sheet.h"

/**
 * Fills a sheet with a PNG file side by side: its light is the file's colours over their mean, and
 * its tooth what is light and fine in it. scale: output px per px of the file.
 *
 * Returns: false with FL_ERROR_INPUT or FL_ERROR_LIMIT, naming the file, or FL_ERROR_NO_MEMORY.
 */
bool fl_paper_file_fill(FlPaperSheet *sheet, const char *path, float scale, float relief,
                        GError **error);

#endif
