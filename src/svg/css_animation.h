/* Animations of CSS [CSS Animations 1]: what @keyframes make of a value at one moment. */
#pragma once

#include "svg/css_sheet.h"
#include "svg/css_value.h"
#include "svg/smil.h"

/** Gives what a value of a property stands for; NULL: the value of the element without animations.
 * "" without a value. */
typedef const char *FlCssUnderlying(const void *data, const char *property, const char *value);

/** Takes the value of a property that an animation gives, and ownership of `value`. */
typedef void FlCssTake(void *data, const char *property, char *value);

/** The element whose values are read: its units and custom properties. */
typedef struct FlCssContext {
    const FlCssUnits *units;
    FlCssVariable *variable;
    const void *style; // is handed to `variable`
    FlCssUnderlying *underlying;
    FlCssTake *take;
    void *data; // is handed to the two before
} FlCssContext;

/**
 * Calls context->take for each property that is animated after so many seconds, those of later
 * animations last. Values may contain calc(); variables in them are put in.
 *
 * declared: FlCssDeclaration of `animation` and its longhands, in the order of the cascade.
 * length: collects the ends and loops of the animations; may be NULL.
 */
void fl_css_animations_apply(const GArray *declared, const FlCssSheet *sheet, double seconds,
                             const FlCssContext *context, FlFilmLength *length);
