/* A picture as a sheet of paper: a scan, or a relief of one's own. */
#pragma once

#include "base/page.h"
#include "compose/paper_height.h"
#include <fluidy/error.h>

#define FL_PAPER_ONE 32768 // a factor of one

/** The planes of a sheet; borrowed. */
typedef struct FlPaperPlanes {
    int width, height;
    uint16_t *factor; // width * height * 4: of R, G, B, and FL_PAPER_ONE for alpha
    int8_t *tooth;    // width * height: the fine part of the height
} FlPaperPlanes;

/**
 * Fills the planes with a PNG file side by side: its light is the file's colours over their mean,
 * and its tooth what is light and fine in it. scale: output px per px of the file.
 *
 * Returns: false with FL_ERROR_INPUT or FL_ERROR_LIMIT, naming the file, or FL_ERROR_NO_MEMORY.
 */
bool fl_paper_file_fill(const FlPaperPlanes *sheet, const char *path, float scale, float relief,
                        GError **error);
