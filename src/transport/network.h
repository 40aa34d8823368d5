/*
 * The feed-forward network of a style: from the shape of a region and noise on its material, the
 * potential that moves its ink [Berlanga20 §3.2]. Everything is in integers, so that every
 * processor gives the same bytes.
 */
#ifndef FLUIDY_TRANSPORT_NETWORK_H
#define FLUIDY_TRANSPORT_NETWORK_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define FL_NETWORK_INPUTS 4  // density - 1, coverage - 0.5, noise every 4 px, noise every 12 px
#define FL_NETWORK_HEADS 3   // grids of the potential, of 2, 4 and 8 px
#define FL_NETWORK_GRID 16   // px; sides are multiples of it, as those of a FlRegionPlane are
#define FL_NETWORK_MOST 8191 // an input or activation at most, and - FL_NETWORK_MOST at least

/** A U-Net of convolutions of 3x3, which starts with one of 5x5 that halves its input. */
typedef struct FlNetwork FlNetwork;

/** Whether a style's folder holds a network. */
bool fl_network_exists(const char *folder);

/**
 * Reads DIR/transport.net: bytes that fluidy-style network has written. They need not be trusted:
 * sizes, the checksum and that no sum can overflow are checked. FL_ERROR_STYLE, FL_ERROR_NO_MEMORY.
 */
FlNetwork *fl_network_load(const char *folder, GError **error);
void fl_network_free(FlNetwork *network); // NULL is fine

/** An input of 1 is this much. */
float fl_network_one(const FlNetwork *network);

/**
 * The heads before their tanh, finest first. inputs: FL_NETWORK_INPUTS planes of width * height,
 * which are continued beyond their rims; head[i]: (width >> i + 1) * (height >> i + 1).
 * FL_ERROR_NO_MEMORY.
 */
bool fl_network_run(const FlNetwork *network, const int16_t *inputs, int width, int height,
                    int16_t *const head[FL_NETWORK_HEADS], GError **error);

/** The potential, width * height px², for the same inputs. FL_ERROR_NO_MEMORY. */
bool fl_network_potential(const FlNetwork *network, const int16_t *inputs, int width, int height,
                          float *potential, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlNetwork, fl_network_free)

#endif
