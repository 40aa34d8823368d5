/* style.ini: what the artist says about a style, with the line it is said on. */
#pragma once

#include "params/key_table.h"
#include "style/style_folder.h"

/** Values that style.ini did not give and that have to be found from the pictures. */
typedef enum FlGuess {
    FL_GUESS_BORDER = 1 << 0,
    FL_GUESS_PAPER = 1 << 1,
    FL_GUESS_MASK = 1 << 2,
    FL_GUESS_FLOW = 1 << 3,
    FL_GUESS_FPS = 1 << 4,
} FlGuess;

/** The keys of FlStyle and of its parts, of which recipes have sections, too. */
extern const FlKeyTable fl_style_table, fl_front_table, fl_wash_table, fl_sheet_table;

/**
 * Reads the [style] section of the key file at `path` into the fields it names, and takes what is
 * given out of style->guessed.
 *
 * Returns: false with FL_ERROR_STYLE set: file, line, what was wrong and what was expected.
 */
bool fl_manifest_read(FlStyle *style, const char *path, GError **error);

/** The text of a style.ini that says what the style holds. Guessed values are left out. */
char *fl_manifest_text(const FlStyle *style);
