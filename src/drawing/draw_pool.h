/* Draws frames in child processes, which may crash, hang or run out of memory without ending the
 * render. */
#ifndef FLUIDY_DRAWING_DRAW_POOL_H
#define FLUIDY_DRAWING_DRAW_POOL_H

#include "drawing/drawing.h"
#include "svg/geometry.h"

/**
 * n child processes, each confined to the drawing's folders, the limit of memory and that of
 * seconds a frame. One that dies is replaced.
 *
 * They start as copies of this process, drawing included; what changes later, they are told.
 * drawing must outlive the pool. Returns: NULL if the process has other threads already and must
 * not fork, or if it cannot.
 */
typedef struct FlDrawPool FlDrawPool;
FlDrawPool *fl_draw_pool_new(FlDrawing *drawing, int n);

/**
 * fl_drawing_draw_by_hand() in whichever process is free next. Any thread. A frame that crashes,
 * hangs or asks for too much is an error with its file and number. Where no hand draws, it is asked
 * for several times: it is kept packed, as long as all that is kept takes 32 MiB at most.
 */
FlDrawList *fl_draw_pool_draw(FlDrawPool *pool, int frame, const FlHand *hand, GError **error);

/** fl_drawing_outlines() in whichever process is free next, likewise. */
FlOutlines *fl_draw_pool_outlines(FlDrawPool *pool, int frame, GError **error);

/**
 * Enables fallbacks, once every frame has been drawn successfully: a frame that fails is drawn
 * again, then with plain lines, then replaced by the frame before it.
 */
void fl_draw_pool_enable_fallbacks(FlDrawPool *pool);

/** How many draw lists have plain lines since they failed with hands; NULL is fine. */
int fl_draw_pool_plain(const FlDrawPool *pool);

/** How many frames were drawn, or their outlines read, as the one before; NULL is fine. */
int fl_draw_pool_lost(const FlDrawPool *pool);

/** Forgets the frames that it keeps, since they are drawn anew in another size; NULL is fine. */
void fl_draw_pool_forget(FlDrawPool *pool);

void fl_draw_pool_free(FlDrawPool *pool); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlDrawPool, fl_draw_pool_free)

#endif
