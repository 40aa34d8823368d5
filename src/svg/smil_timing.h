/* The times of SMIL animations [SMIL 3 §5.4]: the intervals in which each one is active. */
#pragma once

#include "svg/document.h"

typedef struct FlInterval {
    double begin, end; // seconds; end may be INFINITY
} FlInterval;

typedef struct FlAnimation {
    xmlNode *node, *target;
    char *attribute; // its name without a prefix
    double dur;      // of one round; INFINITY: indefinite
    double active;   // of all rounds; INFINITY
    bool freezes;
    char restart;          // 'a'lways, 'w'hen it is not active, 'n'ever
    GArray *begin, *end;   // Condition, in smil_timing.c
    GArray *begins, *ends; // double: times that are known, in order
    GArray *interval;      // FlInterval, in order
} FlAnimation;

typedef struct FlTimeline {
    GArray *animation; // FlAnimation, in the order of the document
    GHashTable *ids;   // of elements
} FlTimeline;

/** The length of animations. */
typedef struct FlFilmLength {
    double end;    // seconds at which the last finite animation ends; 0: all are endless
    GArray *loops; // double: periods in seconds of those that go on for ever
} FlFilmLength;

/** Finds the animations of a document and their intervals in its first four minutes. */
FlTimeline fl_timeline_of(xmlDoc *doc);

/** Removes the animations from the document. */
void fl_timeline_clear(FlTimeline *timeline);

/** The last interval that has begun by then; NULL if it has ended and is not frozen. */
const FlInterval *fl_interval_at(const FlAnimation *a, double seconds);

/** The share of the round at a moment, 0 … 1, and the number of rounds before it. */
double fl_share_of_round(const FlAnimation *a, const FlInterval *interval, double seconds,
                         double *rounds);

/** Adds the end of an animation, or the period of an endless one. */
void fl_animation_add_length(const FlAnimation *a, FlFilmLength *length);

/** A trimmed attribute, to be freed; NULL if it is missing. */
char *fl_trimmed_attribute(const xmlNode *node, const char *name);

/** The element that a node's href points to, `missing` without href; NULL for an unknown one. */
xmlNode *fl_timeline_referred(const FlTimeline *timeline, const xmlNode *node, xmlNode *missing);
