/* The tooth of a sheet of paper, which paint and pencils catch on. */
#ifndef FLUIDY_BASE_TOOTH_H
#define FLUIDY_BASE_TOOTH_H

#include <stddef.h>
#include <stdint.h>

#define FL_TOOTH_ONE 57 // a height of one standard deviation

/** The tooth below a frame; borrowed. */
typedef struct FlTooth {
    const int8_t *height; // FL_TOOTH_ONE is a standard deviation; NULL: flat
    size_t stride;        // of its rows
} FlTooth;

#endif
