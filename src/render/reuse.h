/* The part of a region's paint that earlier renders left in the cache, and that this render
 * adds. */
#pragma once

#include "guides/guides.h"
#include "job/region_plan.h"
#include "keep/store.h"

/**
 * The pictures of a region form a chain: the digest of each is made from that of the one before and
 * from its own guides, which are all that an engine knows of the film. So what an edited frame
 * changes is found where guides begin to differ, wherever that is, and the first picture that is
 * not in the cache is painted from the state that was kept with the one before.
 *
 * If all inputs of the guides are unchanged in the whole film, the digests are known from the last
 * render, and neither masks nor guides are made.
 */
typedef struct FlReuse {
    FlStore *cache;  // borrowed; NULL: pictures are neither taken nor kept
    bool drafts;     // a picture is known by its index, whichever pictures came before
    bool takes;      // false while guides or statistics are inspected: then everything is painted
    FlFacts *facts;  // of method and film
    FlDigest method; // of the facts that decide the paint besides the shapes
    FlDigest film, slot; // of all facts; of where those of the last render are kept
    FlDigest last;       // of the picture painted or taken last
    GArray *made;        // of FlDigest: the pictures so far, where they follow from the guides
    GArray *known;       // of FlDigest: all pictures of the film; NULL: not known
    FlRect rect;         // the painter's, if known
    bool stale;          // a known picture is gone, so that this render cannot go on
    GBytes *state;       // after the last picture, which was taken; NULL: the engine has its own
    FlDigest state_of;   // the picture with that state
    int n_taken, n_painted;
} FlReuse;

/** Begins with the method by which a region of `shapes` is painted. cache: NULL: keeps no pictures;
 * inputs: knows the digests of styles. */
void fl_reuse_init(FlReuse *reuse, FlStore *cache, const FlShapes *shapes,
                   const FlRegionPlan *region, FlInputs *inputs);
void fl_reuse_clear(FlReuse *reuse);

/** The store in which paint is kept, and the facts of a film that decide it. Borrowed. */
typedef struct FlKeeping {
    FlStore *cache;      // NULL: pictures are neither taken nor kept
    FlInputs *inputs;    // know the digests of styles and flow
    const FlFacts *film; // NULL without a cache
    bool takes;          // false while guides or statistics are inspected
    bool drafts;         // of a film, but for regions that loop
} FlKeeping;

/** Looks up the pictures of shapes->painted[p]. */
void fl_reuse_recall(FlReuse *reuse, const FlKeeping *keeping, const FlShapes *shapes, int p);

/** Begins the chain of a region whose pictures are not known and have this place in the frame. */
void fl_reuse_begin(FlReuse *reuse, FlRect rect);

/** True if picture k, counted as they are painted, from 0, can be taken: its digest is known, or
 * the draft of it is kept. */
bool fl_reuse_has(const FlReuse *reuse, int k);

/** Advances to picture k. Its digest is known, or follows from its guides (NULL: they are the same
 * as before) and a style that has this window. */
void fl_reuse_next(FlReuse *reuse, int k, const FlGuides *guides, int window);

/** Takes the picture, colours and alpha, and the state that follows. Returns: true if the cache had
 * the picture. */
bool fl_reuse_take(FlReuse *reuse, uint8_t *rgb, size_t bytes);

/** Drops the picture whose state the engine has refused; a second try of the render paints that
 * picture. */
void fl_reuse_refuse_state(FlReuse *reuse);

/** Keeps the picture that was painted instead, and the state that follows. */
void fl_reuse_keep(FlReuse *reuse, const uint8_t *rgb, size_t bytes, GBytes *state);

/** Keeps the digests of the whole film, and the facts that decided them. */
void fl_reuse_finish(FlReuse *reuse);

/** The reason why the region is painted anew, such as "w-temp was 5 and is 8"; NULL: not known. To
 * be freed. */
char *fl_reuse_reason(const FlReuse *reuse);
