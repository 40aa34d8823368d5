/* The settings of a region, and the overrides of config and command line. */
#pragma once

#include "params/params.h"
#include <stdint.h>

/** The rule by which paint composites over the layers below. */
typedef enum FlMedium {
    FL_MEDIUM_AUTO,        // opaque over the background, transparent over other paint
    FL_MEDIUM_TRANSPARENT, // density over the background, as watercolour
    FL_MEDIUM_OPAQUE,      // hides it the more the thicker it is, as gouache
    FL_MEDIUM_BODY,  // hides the layers below wherever there is paint, as if cut out of its paper
    FL_MEDIUM_SOLID, // hides the layers below even where it is thin; no word selects this medium
} FlMedium;

/** The words, in the enum's order: the form of fl_text_choice(). */
#define FL_MEDIUM_WORDS "auto|transparent|opaque|body"

/** The marks of a dry medium. */
typedef enum FlMarks {
    FL_MARKS_AUTO, // not set: the style's, which are off
    FL_MARKS_OFF,
    FL_MARKS_CHARCOAL,
    FL_MARKS_PASTEL,
    FL_MARKS_BRUSH, // nearly dry
} FlMarks;

#define FL_MARKS_WORDS "auto|off|charcoal|pastel|brush"

/** The effect of a region on the regions below. */
typedef enum FlStacking {
    FL_STACKING_KNOCKOUT, // removed: paper under the paint
    FL_STACKING_GLAZE,    // its density adds to theirs, as a wash over dry paint
    FL_STACKING_OVER, // seen as far as it is transparent; of paint with alpha of its own, no word
} FlStacking;

/** The treatment of edges that a shape shares with others. */
typedef enum FlEdges {
    FL_EDGES_CLOSED, // continues up to the edge: neither a line of paper nor a double rim
    FL_EDGES_SOFT,   // as at any other edge
} FlEdges;

/** The source of the drawing's motion. */
typedef enum FlMotion {
    FL_MOTION_AUTO,  // its own motion, which carries the paint along
    FL_MOTION_MASKS, // the motion of outlines, as in the papers: paint is not carried along
} FlMotion;

/** The fluid inside the outline, whose flow carries the paint: guides/fluid.h. */
typedef enum FlFluidKind {
    FL_FLUID_STYLE, // what the style says
    FL_FLUID_NONE,
    FL_FLUID_PLAIN,
    FL_FLUID_SMOKE,
    FL_FLUID_WATER, // with walls and a floor, through which it does not grow
    FL_FLUID_FIRE,
    FL_FLUID_HONEY,
} FlFluidKind;

/** The words from FL_FLUID_NONE on. */
#define FL_FLUID_KINDS "none|plain|smoke|water|fire|honey"

/** The engine that makes a region's paint: job/engine.h has the table. */
typedef enum FlEngineChoice {
    FL_ENGINE_AUTO, // the style's
    FL_ENGINE_PATCH,
    FL_ENGINE_LAZYFLUIDS,
    FL_ENGINE_TRANSPORT,
} FlEngineChoice;

/** The tool for lines that are not painted and for small shapes near these lines. */
typedef enum FlLine {
    FL_LINE_PLAIN, // as the drawing has them
    FL_LINE_PEN,
    FL_LINE_PENCIL,
    FL_LINE_BRUSH,
} FlLine;

/** The colour of the paint. */
typedef enum FlTint {
    FL_TINT_FILL, // the drawing's fill or any other: the picture if there is one, else the flat one
    FL_TINT_KEEP, // the exemplar's own colours
} FlTint;

/** The colours that fills become. */
typedef enum FlPalette {
    FL_PALETTE_DRAWING, // the drawing's
    FL_PALETTE_PAINT,   // nearly what two pigments on white paper mix to
} FlPalette;

/** Selects regions that are drawn unpainted. */
typedef enum FlPassthrough {
    FL_PASSTHROUGH_AUTO, // strokes and shading are not
    FL_PASSTHROUGH_NO,   // it is
    FL_PASSTHROUGH_YES,  // it is drawn as it is
} FlPassthrough;

/** The frame that follows the last one of a recording which is played in step with the film. */
typedef enum FlRecordingEnd {
    FL_RECORDING_WRAP,      // the first
    FL_RECORDING_PING_PONG, // the one before, and so back to the first
    FL_RECORDING_HOLD,      // the last
} FlRecordingEnd;

/** The dials of which a control map may leave a share at each pixel. */
typedef enum FlMapped {
    FL_MAP_CARRY,
    FL_MAP_STRENGTH,
    FL_MAP_WASH,
    FL_MAP_CALM,
    FL_MAP_FRONT,
    FL_MAP_STAIN,
    FL_MAPS,
} FlMapped;

#define FL_MAP_OPTION "map-" // before the dial's name

/** The settings of one region, completely resolved. */
typedef struct FlRegionSettings {
    char *style; // a name or a path; NULL: not set
    FlEngineChoice engine;
    double strength; // of transport: factor on the way of the ink
    FlTint tint;
    bool has_colour;   // with FL_TINT_FILL: `colour` instead of the drawing's fill
    uint8_t colour[3]; // sRGB
    FlDetail detail;
    FlStacking stacking;
    FlMedium medium;    // FL_MEDIUM_AUTO: the style's, if that has one
    double granulation; // as of fl_granulate(); NAN: the style's
    double wash;        // of FlWashStyle, as those below; NAN: the style's
    double light;       // the side on which the shadow lies, degrees; 90: below
    double hue, passes, tide, pool, blooms, calm;
    FlPalette palette;
    FlMarks marks;      // FL_MARKS_AUTO: the style's
    double marks_angle; // direction of the strokes, degrees; 90: down; NAN: the shape's axis
    double front;       // fronts on the paper ahead of what moves, 0..2
    double stain;       // stains behind the front, 0..1
    double gaps;        // how far edges are off, 0..1
    char *wet_with;     // names of regions, with commas, into which its paint runs; or NULL
    double bleed;       // how far, 0..1; NAN: the style's
    FlEdges edges;
    FlLine line;   // of a region that is not painted
    int line_boil; // frames until it is drawn anew; 0: never
    FlMotion motion;
    FlFluidKind fluid;
    double fluid_swirl, fluid_buoyancy, fluid_memory, fluid_emit; // NAN: the kind's
    double fluid_up;                                              // degrees, clockwise from above
    double fluid_drag;
    double wetness; // share of the fluid in the motion; NAN: the engine's
    int hold;       // frames, 1..1000
    bool reverse;
    FlRecordingEnd recording_end; // of LazyFluids
    FlPassthrough passthrough;
    char *merge_with;   // another region's name, or NULL
    char *map[FL_MAPS]; // paths or patterns of control maps, with {region} perhaps; or NULL
    FlParams params;
    GPtrArray *keyed; // of FlKeys: options whose fields have the first key's value; NULL: none
} FlRegionSettings;

void fl_region_settings_init(FlRegionSettings *settings); // the defaults
void fl_region_settings_clear(FlRegionSettings *settings);

/**
 * Sets one thing from text: an option of FL_SCOPE_REGION; "scale" is read as style-scale. A preset
 * also sets the motion: the presets of the papers use the motion of masks only, and paint as the
 * synthesis makes it, without granulation, wash, hue, marks and drawn lines. The engine LazyFluids
 * brings the parameters of the preset lazyfluids-steady, unless a preset chose the engine.
 *
 * A relative path of a style is taken from `folder`; NULL: the working directory. A value may be
 * keyed, as fl_keys_read() has it, if the option can be; a plain one takes such keys away.
 * Returns: false with FL_ERROR_USAGE; the settings are then unchanged.
 */
bool fl_region_settings_set(FlRegionSettings *settings, const char *key, const char *value,
                            const char *folder, GError **error);

/** Sets the fields of keyed options to their amounts in a frame, by its number. Copies of settings
 * share the keys: those of a plan stay as they are while a painter's move. */
void fl_region_settings_move(FlRegionSettings *settings, int frame);

/** All keys that fl_region_settings_set() knows, NULL-terminated; static storage. */
const char *const *fl_region_settings_keys(void);

/** Overrides of regions: keys and values in the order of the file, already checked. */
typedef struct FlOverride {
    char *region; // the only one that it is for; NULL: all of a section, or of the film
    char *key, *value;
    char *folder; // relative paths start here; NULL: the working directory
} FlOverride;

typedef struct FlOverrides {
    int n;
    FlOverride *override;
} FlOverrides;

/** Adds a copy; the last value of a key wins. Errors as fl_region_settings_set(). */
bool fl_overrides_add(FlOverrides *overrides, const char *region, const char *key,
                      const char *value, const char *folder, GError **error);

/** Returns: the last one of a key and for `region`, or NULL. */
const FlOverride *fl_overrides_find(const FlOverrides *overrides, const char *region,
                                    const char *key);

void fl_overrides_clear(FlOverrides *overrides);

/** Applies those for `region`, a preset first, then the engine and the detail. fl_overrides_add()
 * has checked them. */
void fl_overrides_apply(const FlOverrides *overrides, const char *region,
                        FlRegionSettings *settings);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlRegionSettings, fl_region_settings_clear)
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlOverrides, fl_overrides_clear)
