/* Style sheets that a drawing takes from other files. */
#ifndef FLUIDY_SVG_STYLE_SHEETS_H
#define FLUIDY_SVG_STYLE_SHEETS_H

#include "base/warnings.h"
#include <libxml/tree.h>

/**
 * Adds the real paths of the sheets that <?xml-stylesheet?> and @import name, those that these
 * import included, to `files`. A pipe or a device, for which librsvg would wait, is left out of the
 * document with a warning.
 */
void fl_style_sheets_check(xmlDoc *doc, const char *path, int number, GPtrArray *files,
                           FlWarnings *warnings);

#endif
