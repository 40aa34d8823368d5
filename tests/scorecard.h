/* What a painted film looks like in numbers, and the same numbers of its exemplar. */
#ifndef TESTS_SCORECARD_H
#define TESTS_SCORECARD_H

#include "guides/guides.h"
#include "style/style_folder.h"

#define DEPTHS 12 // px below the contour that the profile looks at

/** Frames with their guides; rgb is n_frames * height * width * 3. */
typedef struct Film {
    int width, height, n_frames;
    uint8_t *rgb;
    FlGuides *guides;
} Film;

/** Luminances are 0 … 255. */
typedef struct Score {
    double sharp;           // mean gradient deeper than 2 px
    double deviation;       // of the luminance there
    double profile[DEPTHS]; // mean luminance by depth, 1 px each
    double flicker;         // mean difference of one frame to the next there
    double rest;            // the same where nothing moves faster than 0.1 px/frame; 0: nowhere
    double rim;             // luminance 2 to 8 px inside edges that advance, minus that of the others
} Score;

/** A sum with its count. */
typedef struct Mean {
    double sum;
    int n;
} Mean;

/** What a score is made of; several films, such as the regions of one, are counted together. */
typedef struct ScoreSums {
    Mean gradient, tone, square, depth[DEPTHS], change, rest, leading, others;
} ScoreSums;

/** An empty film with the guides of a sequence. Exits on errors, which only memory can cause. */
Film *film_new(const FlGuideSource *source, const FlGuideParams *how);
/** Depths count from below its margin of bare paper, FlExemplar's margin_px. */
Film *film_of_style(const FlStyle *style, const FlGuideParams *how, float margin_px);
void film_free(Film *drawing);
Score film_score(const Film *drawing);

/** Counts a film; sums start zeroed. */
void film_count(const Film *drawing, ScoreSums *sums);
Score score_of(const ScoreSums *sums);

/** Root mean square difference of the profiles. */
double profile_error(const Score *a, const Score *b);

#endif
