/* The sheet of paper under a film: its light, which is multiplied into the frames, and its tooth,
 * on which paint settles. */
#pragma once

#include "base/spill.h"
#include "compose/paper_file.h"
#include "style/style_folder.h"

/** Which paper. */
typedef struct FlPaperChoice {
    const char *paper; // a word of FL_PAPER_WORDS, a PNG file, "none" or "auto"; NULL: "auto"
    const FlSheetStyle *sheet; // that "auto" is; NULL: it is cold
    double scale;              // output px per px of the sheet; 0: as the page asks for
    double relief;             // strength of its light, 0..2
    uint64_t seed;
    int boil;   // frames after which another sheet is taken; 0: never
    bool draft; // a grain finer than a px may come out coarser
} FlPaperChoice;

/**
 * A sheet of paper, made once for a film. Every frame has the same part of it; with boil, parts
 * that are chosen at random.
 */
typedef struct FlPaperSheet {
    int width, height; // the frame's, and with boil some room
    uint16_t *factor;  // width * height * 4: of R, G, B, and FL_PAPER_ONE for alpha; NULL: put away
    FlSpill *bands;    // then it is here, some rows in a block
    int8_t *tooth;     // width * height: the fine part of the height
    int boil;
    uint64_t seed;
    bool lights; // the frames are multiplied by the sheet: requested, or no other background is
                 // given
} FlPaperSheet;

/** The colour of a tinted paper, by its word: the ground of a film that is painted on it. Returns:
 * NULL if `paper` is another word, a file or NULL. */
const uint8_t *fl_paper_ground(const char *paper);

/** Returns: true if this paper can be asked for; NULL: "auto". Does not open its file.
 * FL_ERROR_USAGE. */
bool fl_paper_check(const char *paper, GError **error);

/**
 * Makes the sheet for frames of a size. `plain`: they lie on paper and nothing else, so that "auto"
 * is seen; else it has its tooth alone.
 *
 * *sheet becomes NULL if the paper is none; to be freed with fl_paper_sheet_free().
 * Returns: false with FL_ERROR_USAGE, FL_ERROR_INPUT about the file, FL_ERROR_NO_MEMORY.
 */
bool fl_paper_sheet_make(const FlPaperChoice *choice, bool plain, int width, int height,
                         FlPaperSheet **sheet, GError **error);

void fl_paper_sheet_free(FlPaperSheet *sheet); // NULL is fine

/** Puts the light away into a temporary file, for large pages: it takes more than a frame does, and
 * is only read when one is finished. The tooth stays. */
bool fl_paper_sheet_put_away(FlPaperSheet *sheet, GError **error);

/** The first frame that has the same part of the sheet. */
int fl_paper_sheet_since(const FlPaperSheet *sheet, int frame);

/** The corner of a frame in the sheet: even numbers. */
void fl_paper_sheet_origin(const FlPaperSheet *sheet, int frame, int *x, int *y);

/**
 * Lays a frame's straight sRGBA, one of the two, on the sheet: colours are multiplied by its light,
 * in sRGB levels, alpha stays.
 *
 * Returns: false with FL_ERROR_INPUT or FL_ERROR_NO_MEMORY set, if the light was put away.
 */
bool fl_paper_sheet_light(const FlPaperSheet *sheet, int frame, int width, int height,
                          uint8_t *rgba, uint16_t *rgba16, GError **error);

/**
 * The light of a frame's sheet as an opaque picture that multiplies the frame: level 240 stands for
 * one, since the light is above and below one. rgba: width * height * 4.
 */
bool fl_paper_sheet_picture(const FlPaperSheet *sheet, int frame, int width, int height,
                            uint8_t *rgba, GError **error);

/** The tooth of a frame. sheet may be NULL. */
FlTooth fl_paper_sheet_tooth(const FlPaperSheet *sheet, int frame);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlPaperSheet, fl_paper_sheet_free)
