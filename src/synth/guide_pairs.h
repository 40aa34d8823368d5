/* The input of a frame's synthesis, as pictures that other programs of guided synthesis read. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/** A guide of the exemplar and of the target, 8 bits a channel, interleaved. */
typedef struct FlGuidePair {
    const char *name; // static; part of a file's name
    int channels;     // 1: grey; 3: sRGB
    float weight;     // of each channel's squared difference
    uint8_t *source;  // as large as the style; NULL: the style itself
    uint8_t *target;
} FlGuidePair;

#define FL_GUIDE_PAIRS 8 // of a frame at most

/** Zeroed: empty. */
typedef struct FlGuidePairs {
    int source_width, source_height, width, height; // of exemplar and target, px
    int style_channels;                             // 3: sRGB; 4: sRGB and straight alpha
    float style_weight;                             // as a pair's
    uint8_t *style;                                 // the exemplar's frame
    int n;
    FlGuidePair pair[FL_GUIDE_PAIRS];
} FlGuidePairs;

/** The sizes, and the style's picture, zeroed. Returns: false with FL_ERROR_NO_MEMORY set. */
bool fl_guide_pairs_init(FlGuidePairs *pairs, const int source_size[2], const int size[2],
                         int style_channels, float style_weight, GError **error);
void fl_guide_pairs_clear(FlGuidePairs *pairs);

/**
 * Adds a pair, zeroed, unless its weight is 0. Returns: false with FL_ERROR_NO_MEMORY set; *pair:
 * the new one, or NULL.
 */
bool fl_guide_pairs_add(FlGuidePairs *pairs, const char *name, int channels, float weight,
                        bool of_style, FlGuidePair **pair, GError **error);

/** Takes back the last n pairs. */
void fl_guide_pairs_drop(FlGuidePairs *pairs, int n);

/**
 * Gives pixels whose weight is below half the value of a near pixel of more: such programs weigh
 * no pixels. weight: 0 … 1, width * height. Returns: whether any pixel had one.
 */
bool fl_guide_fill(uint8_t *target, int channels, const float *weight, int width, int height);

/** A value of 0 … 1 as a byte. */
static inline uint8_t fl_guide_byte(float value)
{
    return (uint8_t)(value <= 0 ? 0 : value >= 1 ? 255 : value * 255 + 0.5f);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlGuidePairs, fl_guide_pairs_clear)
