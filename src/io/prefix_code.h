/* Huffman's prefix codes of limited length, as deflate has them [RFC 1951 §3.2.2]. */
#ifndef FLUIDY_IO_PREFIX_CODE_H
#define FLUIDY_IO_PREFIX_CODE_H

#include <stdint.h>

#define FL_CODE_SYMBOLS 286 // at most
#define FL_CODE_BITS 15     // of a symbol, at most

/** The code of each symbol. */
typedef struct FlPrefixCode {
    uint8_t length[FL_CODE_SYMBOLS]; // bits; 0: the symbol is not used
    uint16_t bits[FL_CODE_SYMBOLS];  // the first one is the lowest
} FlPrefixCode;

/** The code with which symbols that come count[s] times take least room, or next to that where a
 * length is at the limit. At least two are used, and all of them together less than 2^32 times. */
void fl_prefix_code_init(FlPrefixCode *code, const uint32_t count[FL_CODE_SYMBOLS]);

#endif
