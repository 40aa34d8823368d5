/* A style: a folder of recorded paint, read into memory. */
#pragma once

#include "base/error.h"
#include "params/region_settings.h"
#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/** The behaviour of a style's paint at wet fronts and on the paper behind; see fluidy-style(5). */
typedef struct FlFrontStyle {
    float width;       // of its fronts, 0..1; 0 for dry paint
    float stain;       // share of the paint that stays in the paper, 0..1
    float film;        // of water that stays wet for some frames, 0..1
    float soft;        // edge of a front, a share of its width
    float base;        // density of the front at its tip, 0..1
    float line;        // strength of the pigment line at the tip, 0..1
    float fingers;     // unevenness of the front, 0..1
    float granulation; // settling of pigment in hollows, 0..1
    float bleed;       // of its paint into a neighbour's, 0..1
} FlFrontStyle;

#define FL_FRONT_DEFAULTS                                                                          \
    {                                                                                              \
        .width = 1, .stain = 0.42f, .film = 0.4f, .soft = 0.2f, .base = 0.5f, .line = 0.15f,       \
        .fingers = 0.55f, .granulation = 0.45f                                                     \
    }

/** The wash that a style's paint leaves in a shape; see fluidy-style(5). 0 turns a part of it off.
 */
typedef struct FlWashStyle {
    float wash;   // strength of all but hue, 0..2
    float passes; // of passes of the brush, 0..2
    float tide;   // of drying lines, 0..2
    float pool;   // of paint that gathers at lower edges, 0..2
    float blooms; // of blooms, 0..2
    float calm;   // share of the recording's unevenness that is lost behind the rim, 0..1
    float heart;  // of a lighter middle, 0..1
    float hue;    // wander between two pigments, CIE76, 0..12
} FlWashStyle;

#define FL_WASH_DEFAULTS                                                                           \
    {                                                                                              \
        .wash = 1, .passes = 1, .tide = 1, .pool = 1, .blooms = 1, .hue = 4.4f                     \
    }

/** The sheet of paper that a style is painted on unless one is chosen; see fluidy-style(5). */
typedef struct FlSheetStyle {
    float grain;   // size of its bumps, px of a page of 1000 px, > 0
    float stretch; // how much wider than high they are, > 0
    float tooth;   // weight of the finer roughness on them, 0..4
    float fibre;   // weight of fibres, 0..4
    float relief;  // strength of its light, as a share of the usual one, 0..4
} FlSheetStyle;

#define FL_SHEET_DEFAULTS                                                                          \
    {                                                                                              \
        .grain = 2.7f, .stretch = 2.4f, .tooth = 1.8f, .fibre = 0.15f, .relief = 1                 \
    }

/** A style in memory. Frames follow each other without padding, rows from the top. */
typedef struct FlStyle {
    char *name;      // the folder's name, or style.ini's
    char *path;      // the folder
    char *character; // its looks and purpose, a line; may be NULL
    char *author, *licence;
    int width, height, n_frames;
    float fps;         // frames per second, > 0
    float border_px;   // width of the boundary region b [F21 §3.1], px of the style, > 0
    float scale;       // suggested px of the target per px of the style, > 0
    uint8_t paper[3];  // sRGB of the bare paper
    FlMedium medium;   // FL_MEDIUM_AUTO: not given
    FlMarks marks;     // FL_MARKS_AUTO: none
    float granulation; // of its paint on paper: see fl_granulate()
    FlFluidKind fluid; // that carries its paint; FL_FLUID_STYLE: none is given
    FlFrontStyle front;
    FlWashStyle wash;
    FlSheetStyle sheet;
    float melt;       // 0..1: 1 if its pieces melt into each other when they are put together
    float smoothness; // of its recording: see fl_style_smoothness()
    uint8_t *rgb;     // n_frames * height * width * 3, sRGB
    uint8_t *mask;    // n_frames * height * width, coverage 0..255
    bool cut_out;     // mask is the frames' own alpha, over the paper
    float *flow;      // n_frames * height * width * 2, px per frame; NULL: to be constructed
    char *made_by;    // source of the frames, such as a recipe's file name; may be NULL
    char *missing_orientations; // directions that no outline faces, by style.ini; "none" or NULL
    FlOverrides settings;       // of regions with this style, before all others
    unsigned guessed;           // FlGuess bits (manifest.h): values that are estimated
    const FlStop *stop;         // of its reading
} FlStyle;

#define FL_STYLE_TILE "transport.png" // a file of styles that move ink: transport/tile.h
#define FL_GRANULATION 0.07f          // default for styles

/** A style without frames, of which all is as usual. */
FlStyle *fl_style_new(void);

/** A copy of a style, at scale 1, without its frames and settings of regions. */
FlStyle *fl_style_like(const FlStyle *style);

/**
 * Reads a folder. Estimates what it lacks from its frames: the paper's colour, the masks, the
 * border. Without flow files the flow is NULL.
 *
 * Returns: NULL with FL_ERROR_STYLE, naming the file and what was expected; FL_ERROR_LIMIT;
 * FL_ERROR_INPUT for a flow field; FL_ERROR_NO_MEMORY.
 */
FlStyle *fl_style_load(const char *folder, GError **error);

/** Likewise, unless it is stopped: FL_ERROR_INTERRUPTED. */
FlStyle *fl_style_load_until(const char *folder, const FlStop *stop, GError **error);

/**
 * Finds a style by path, if it has a slash or is a folder; else by the name of its folder in
 * $FLUIDY_STYLES, the user's and the system's data folders, the installed one, the source tree's;
 * else there by its folder's name or the one in its style.ini, whatever the case.
 *
 * Returns: the folder; NULL with FL_ERROR_STYLE, which lists similar names.
 */
char *fl_style_find(const char *name, GError **error);

/** The settings that the style.ini of a style gives to its regions, to be cleared; none if there is
 * no such style, or its style.ini is broken: who loads the style says so. */
void fl_style_settings(const char *name, FlOverrides *settings);

/** Returns: true if a folder contains a `frames` folder, which makes it a style. */
bool fl_is_style(const char *folder);

/**
 * The smoothness of the paint: from 0 if grain would hide a seam, as in dry media, to 1 if paint
 * only runs from light to dark, as in a wash. Compares pixels close together that lie a border
 * inside the masks; distances are px of the size in which the style is shown, so that a recording
 * twice as large is as smooth. 0 without such pixels.
 */
float fl_style_smoothness(const FlStyle *style);

void fl_style_free(FlStyle *style); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlStyle, fl_style_free)
