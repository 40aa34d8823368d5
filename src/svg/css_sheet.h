/* Style sheets as a list of rules: conditions decided, nesting and imports resolved. */
#pragma once

#include "svg/css_condition.h"
#include "svg/css_selector.h"

typedef struct FlCssDeclaration {
    const char *name; // interned; lower case but for custom properties
    char *value;      // without comments and "!important"
    bool important;
} FlCssDeclaration;

/** One selector with its declarations. */
typedef struct FlCssRule {
    FlSelector *selector; // borrowed from the sheet
    GArray *declarations; // FlCssDeclaration; shared with other rules of the sheet
    int layer;            // later layers win; rules outside of layers have the highest
    int order;            // among all rules
} FlCssRule;

/** @keyframes NAME: the declarations at shares of an animation's duration. */
typedef struct FlCssKeyframe {
    double share; // 0 … 1
    GArray *declarations;
    int layer; // of the rule, counted as they appear
    bool prefixed;
} FlCssKeyframe;

/** All sheets of a document. */
typedef struct FlCssSheet {
    GArray *rules;         // FlCssRule
    GPtrArray *selectors;  // GPtrArray of FlSelector: owns them
    GHashTable *keyframes; // name -> GArray of FlCssKeyframe
    GHashTable *initial;   // values of @property, interned name -> text
    GHashTable *own;       // interned names of @property that children do not inherit
    bool embeds_font;
} FlCssSheet;

/**
 * Reads the <style> elements and <?xml-stylesheet?> of a document, with the files beside it that
 * they import, and takes them out of the document.
 *
 * The real paths of files are added to `files`. Warns about files that cannot be read or lie
 * outside the drawing's folder, and about rules that are not understood.
 */
FlCssSheet *fl_css_sheet_take(xmlDoc *doc, const char *path, int number, FlCssPage page,
                              GPtrArray *files, FlWarnings *warnings);

void fl_css_sheet_free(FlCssSheet *sheet); // NULL is fine

/** Reads declarations, those of a style attribute; an array of FlCssDeclaration, to be unref'd. */
GArray *fl_css_declarations(const char *text);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlCssSheet, fl_css_sheet_free)
