/* The CSS properties that determine how drawings look: kinds, initial values, inheritance. */
#pragma once

#include <stdbool.h>

typedef enum FlCssKind {
    FL_CSS_PAINT,     // a colour, none, url()
    FL_CSS_LENGTH,    // a length or percentage
    FL_CSS_LENGTHS,   // a list of such
    FL_CSS_NUMBER,    // a number or percentage
    FL_CSS_ABSENT,    // only none can be drawn
    FL_CSS_REFERENCE, // url() and functions, which become those of SVG 1.1
    FL_CSS_TEXT,      // librsvg reads it as a browser does
    FL_CSS_GEOMETRY,  // a length that librsvg knows as an attribute only
    FL_CSS_TRANSFORM, // becomes the attribute `transform`
    FL_CSS_RESOLVED,  // is put into effect by the cascade in another way
    FL_CSS_ANIMATION, // moves the element
    FL_CSS_IGNORED,   // changes no still picture of a drawing
} FlCssKind;

typedef struct FlCssProperty {
    const char *name;
    FlCssKind kind;
    bool inherited;
    const char *initial; // NULL: it may be left out instead
    const char *words;   // that are its values, one of them the initial one; NULL: any text
} FlCssProperty;

/** A property by its name in lower case; NULL if it is unknown. */
const FlCssProperty *fl_css_property(const char *name);

/** The i-th of all that are known; NULL after the last. */
const FlCssProperty *fl_css_property_at(int i);

/** The word among those of the property, however it is written; to be freed; NULL: it has no such
 * word. */
char *fl_css_word(const FlCssProperty *property, const char *value);

/**
 * Returns: true if `value` can be one of the property, or is one for all properties. Lengths that
 * HTML has as well need a unit, but in an attribute (`bare`).
 */
bool fl_css_is_valid(const FlCssProperty *property, const char *value, bool bare);
