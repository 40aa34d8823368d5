/* The colours of an exemplar at twice its size, for pictures of twice the size of their field. */
#pragma once

#include "style/style_guides.h"
#include "synth/exemplar_level.h"

/** Colours of a style, of which an exemplar has those of half the size. */
typedef struct FlEnlargement FlEnlargement;

/**
 * The colours of a style at twice the size of an exemplar's level 0, `half`, in its window.
 * style: the full-size style; the exemplar was made of its half, fl_style_halve().
 *
 * Returns: to be freed with fl_enlargement_free(); NULL with FL_ERROR_NO_MEMORY or FL_ERROR_OUTPUT.
 */
FlEnlargement *fl_enlargement_new(const FlStyle *style, const FlExemplarLevel *half,
                                  GError **error);
void fl_enlargement_free(FlEnlargement *enlargement); // NULL is fine

/** Its frames: their size, window and colours. */
const FlExemplarLevel *fl_enlargement_level(const FlEnlargement *enlargement);

/** An estimate of its bytes. */
double fl_enlargement_bytes(const FlEnlargement *enlargement);

/** Moves the window to begin with frame `first`. FL_ERROR_INPUT, FL_ERROR_NO_MEMORY. */
bool fl_enlargement_seek(FlEnlargement *enlargement, int first, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlEnlargement, fl_enlargement_free)
