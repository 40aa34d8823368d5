/* Numbers as colours. */
#ifndef FLUIDY_REPORT_RAMP_H
#define FLUIDY_REPORT_RAMP_H

#include <stdint.h>

/** 0 … 1 from dark violet over green to yellow, of even steps in lightness; beyond is cut. */
void fl_ramp(float value, uint8_t rgb[3]);

#endif
