/* Contacts: edges at which two regions are wet together, so that their paints run into each other.
 */
#pragma once

#include "drawing/drawing.h"
#include "style/style_folder.h"

/** A region at the edge of another one, whose paint runs into it. Lengths are px of the page. */
typedef struct FlContact {
    int region, other;
    float strength;            // 0..1
    float reach_px;            // of the paint where it runs farthest
    const FlFrontStyle *style; // of the paint that runs: borrowed
    bool first;                // of the two contacts of a pair: paint runs where noise is above 0
    uint64_t key;              // of the pair
    FlAnchor anchor;           // of the smaller one, with which all that has run moves
    float page;                // px of the page per px of the frame
    FlRect box;                // px of the frame
    int step;                  // px of the frame from point to point
    int width, height;         // points; the first is half a step inside the box's corner
    float *away;    // from the edge, at each point; more where the contact is young or has ended
    float *foot[2]; // the place on the edge that is nearest to each point: where the anchor had it
                    // at rest, x and y on the page
} FlContact;

/** The contacts of a frame. */
typedef struct FlContacts {
    int n;
    FlContact *contact;
} FlContacts;

void fl_contacts_clear(FlContacts *contacts);

/** A layer into which paint runs, planes of its box. */
typedef struct FlRunning {
    uint8_t other[3];  // colour of the paint that runs
    int16_t *amounts;  // of paint, which gathers at the tips of the fingers that have run
    int8_t *play;      // of its pigments, see fl_wash_lay(); NULL: it has no wash
    uint8_t *fills;    // RGBA: become mixtures of both colours
    uint8_t *knockout; // rises where the rim is lost; NULL: the layer has none
} FlRunning;

/** Lets the paint of a contact run into an area of the layer of its region. */
void fl_contact_lay(const FlContact *contact, const FlArea *area, const FlRunning *to);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlContacts, fl_contacts_clear)
