/* One level of an exemplar: packed frames, and which of their pixels can be matched. */
#ifndef FLUIDY_SYNTH_EXEMPLAR_LEVEL_H
#define FLUIDY_SYNTH_EXEMPLAR_LEVEL_H

#include "synth/exemplar.h"

/** Makes room for n_frames frames of width * height, of which `window` are in memory at a time.
 * FL_ERROR_NO_MEMORY; the level is to be cleared in any case. */
bool fl_exemplar_level_init(FlExemplarLevel *level, int width, int height, int n_frames, int window,
                            GError **error);
void fl_exemplar_level_clear(FlExemplarLevel *level); // all 0 is fine

/** An array for all frames of a level, to be freed with free(); with a shorter window only its
 * frames take memory. NULL with FL_ERROR_NO_MEMORY set. */
void *fl_exemplar_level_alloc(const FlExemplarLevel *level, size_t frame_elements,
                              size_t element_bytes, GError **error);

/** Packs frame t from the planes of its pyramid in the level's size. planes: scratch for three of
 * them. Any thread; a frame once. */
void fl_exemplar_level_pack(FlExemplarLevel *level, const FlPyramid *pyramid,
                            const FlExemplar *exemplar, int t, float *planes);

/** Adds the pixels of each segment of frame t to the counts. */
void fl_exemplar_level_count(const FlExemplarLevel *level, int t, size_t count[FL_SEGMENTS]);

/** Makes border of all of frame t's mask, as it is where segments are not separate. */
void fl_exemplar_level_merge(FlExemplarLevel *level, int t);

/** Lists the pixels of each segment in the window anew. FL_ERROR_NO_MEMORY. */
bool fl_exemplar_level_list(FlExemplarLevel *level, GError **error);

#endif
