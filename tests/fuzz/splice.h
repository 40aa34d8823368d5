/* A mutator that knows what drawings are made of: it cuts pieces out of one and pastes them into
 * another where they are well-formed. Pure: the result depends on its arguments alone. */
#ifndef FLUIDY_TESTS_SPLICE_H
#define FLUIDY_TESTS_SPLICE_H

#include <glib.h>
#include <stdint.h>

/** Stands between the frames of a film in one file. */
#define FRAME_MARK "<?frame?>"

/** Changes n bytes with room for `most`, such as LLVMFuzzerMutate(). Returns: how many there are. */
typedef size_t ByteMutator(uint8_t *data, size_t n, size_t most);

/**
 * Changes a drawing, or a film of them, in one to four places: elements, attributes, path data,
 * styles and transforms are repeated, moved, wrapped or deleted, numbers become hostile, ids and
 * references are exchanged, frames are repeated and deleted. `bytes` changes a value now and then.
 */
void splice_mutate(GString *text, unsigned seed, ByteMutator *bytes);

/** Pastes a piece of `other` into the text: an element with what it refers to, an attribute, a
 * frame. */
void splice_cross(GString *text, const GString *other, unsigned seed);

#endif
