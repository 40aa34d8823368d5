/* The folders that hold the files of a style, relative to its own folder. */
#ifndef FLUIDY_BASE_STYLE_PARTS_H
#define FLUIDY_BASE_STYLE_PARTS_H

#define FL_STYLE_PARTS "", "frames", "masks", "flow"

#endif
