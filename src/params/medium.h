/* Media: the rule by which paint composites over the layers below, and the marks of dry ones. */
#ifndef FLUIDY_PARAMS_MEDIUM_H
#define FLUIDY_PARAMS_MEDIUM_H

typedef enum FlMedium {
    FL_MEDIUM_AUTO,        // not set: what suits the background
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

#endif
