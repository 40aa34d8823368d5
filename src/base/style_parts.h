/* Where the files of a style lie: in its folder, and in these below it. */
#ifndef FLUIDY_BASE_STYLE_PARTS_H
#define FLUIDY_BASE_STYLE_PARTS_H

#define FL_STYLE_PARTS "", "frames", "masks", "flow"

#endif
