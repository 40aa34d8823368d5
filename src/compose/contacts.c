#include "compose/contacts.h"

#include "base/curves.h"
#include "base/density.h"
#include "base/noise.h"
#include "base/rng.h"
#include "base/schedule.h"
#include "compose/ink.h"

enum { KEY_RUN = 501, KEY_FINGERS, KEY_LOST, KEY_BACKRUN, KEY_CRINKLE };

#define SHARES 64     // that are told apart of the other colour
#define DARKEST 10    // level below which a channel has no density
#define RUN_PX 96     // from where paint of one side runs to where that of the other does
#define FINGER_PX 34  // from finger to finger
#define LOST_PX 75    // along which the edge is lost or found
#define BACKRUN_PX 48 // along which a run has a drying line
#define CRINKLE_PX 13 // of that line
#define RIM_PX 15     // of the recording's rim, which is lost where paint runs over it

void fl_contacts_clear(FlContacts *contacts)
{
    for (int k = 0; k < contacts->n; k++)
        free(contacts->contact[k].away);
    g_free(contacts->contact);
    *contacts = (FlContacts){0};
}

/* Some pixels of a row: at the edge of the contact. */
typedef struct Edge {
    float away[FL_NOISE_ROW];
    float foot[2][FL_NOISE_ROW], place[2][FL_NOISE_ROW]; // at rest, px of the page
    float run[FL_NOISE_ROW], finger[FL_NOISE_ROW], crinkle[FL_NOISE_ROW];
    float where[FL_NOISE_ROW], backrun[FL_NOISE_ROW];
} Edge;

/* A plane between its points at n pixels of the frame from (x, y) on. */
static void read_plane(const FlContact *contact, const float *plane, int x, int y, int n, float *to)
{
    const float step = (float)contact->step, half = .5f * (step - 1);
    const float v = ((float)(y - contact->box.y) - half) / step;
    const float row = fl_clamp(v, 0, (float)(contact->height - 1));
    const int j = MIN((int)row, MAX(contact->height - 2, 0));
    const float *upper = plane + (size_t)j * (size_t)contact->width;
    const float *lower = upper + (j + 1 < contact->height ? contact->width : 0);
    const float ty = row - (float)j;
    for (int k = 0; k < n; k++) {
        const float u = ((float)(x + k - contact->box.x) - half) / step;
        const float column = fl_clamp(u, 0, (float)(contact->width - 1));
        const int i = MIN((int)column, MAX(contact->width - 2, 0));
        const int next = MIN(i + 1, contact->width - 1);
        const float tx = column - (float)i;
        const float a = upper[i] + (lower[i] - upper[i]) * ty;
        const float b = upper[next] + (lower[next] - upper[next]) * ty;
        to[k] = a + (b - a) * tx;
    }
}

static void noise_at(uint64_t key, float at[2][FL_NOISE_ROW], float cell, int octaves, int n,
                     float *noise)
{
    float x[FL_NOISE_ROW], y[FL_NOISE_ROW];
    for (int i = 0; i < n; i++)
        x[i] = at[0][i] / cell, y[i] = at[1][i] / cell;
    fl_noise_octaves_row(key, x, y, n, octaves, .6f, noise);
}

/* The paint of a pixel at the edge. */
typedef struct Run {
    float share; // of the other paint, 0..1
    float tone;  // ln of the factor on the amount
    float lost;  // 0..1: 1 at an edge that is not seen any more
} Run;

/* The edge stays where it is found; where it is lost it has moved to one side, as paint ran over
 * it, and both paints mix around it: softly, or up to the drying line of a backrun. Seen from both
 * sides the mixture at the edge is the same. */
static Run run_at(const FlContact *contact, const Edge *edge, int i)
{
    const FlFrontStyle *style = contact->style;
    const float away = edge->away[i], reach = contact->reach_px;
    const float lost = fl_smooth(.8f + 2.2f * edge->where[i]);
    const float side =
        (contact->first ? 1 : -1) * (edge->run[i] + .6f * style->fingers * edge->finger[i]);
    const float moved = .8f * reach * lost * fl_clamp(1.8f * side, -1, 1);
    const float crisp = fl_smooth(.75f - .8f * style->soft + 2.4f * edge->backrun[i]);
    const float soft = MAX(lost * reach * (1.25f - .95f * crisp), .8f);
    const float crinkle = .5f * lost * reach * edge->crinkle[i] * away / (away + 4);
    const float within = (moved - away - crinkle) / soft, share = fl_smooth(.5f + .5f * within);
    const float line = crisp * lost * fl_bell(1.5f * (within + .8f)) * (1 - fl_decay(away / 3));
    const float light = crisp * lost * share * (1 - share);
    return (Run){.share = share,
                 .tone = contact->strength * ((.24f + style->line) * line - .8f * light),
                 .lost = MIN(1.4f * contact->strength, 1) * lost * fl_decay(away / RIM_PX)};
}

/* Mixes a share of another colour into a fill, halfway between pigments and light: pigments alone
 * become black where two pure colours meet. */
static void mix_in(uint8_t *fill, const uint8_t other[3], int share)
{
    for (int c = 0; c < 3 && share > 0; c++) {
        const int32_t own = fl_density(MAX(fill[c], DARKEST));
        const int32_t more = fl_density(MAX(other[c], DARKEST)) - own;
        const int mixed = (fl_density_level(own + more * share / SHARES) + 128) >> 8;
        fill[c] = (uint8_t)((mixed + fill[c] + (other[c] - fill[c]) * share / SHARES + 1) / 2);
    }
}

static float exp_of(float x)
{
    return x > 0 ? 1 / fl_fall(x) : fl_fall(-x);
}

/* n pixels of the frame from (x, y) on, whose first one is pixel p of the box. Both washes fade
 * where the edge is lost, and so leave no line at it. */
static void lay_pixels(const FlContact *contact, const FlRunning *to, int x, int y, int n, size_t p)
{
    Edge edge = {0}; // cppcheck does not see that rows are filled
    const float most = 2 * contact->reach_px;
    const uint64_t key = contact->key;
    bool any = false;
    read_plane(contact, contact->away, x, y, n, edge.away);
    for (int i = 0; i < n && !any; i++)
        any = edge.away[i] < most && to->amounts[p + (size_t)i] >= 0;
    if (!any)
        return;
    for (int k = 0; k < 2; k++)
        read_plane(contact, contact->foot[k], x, y, n, edge.foot[k]);
    fl_anchor_rest_row(&contact->anchor, x, y, 1, n, contact->page, edge.place[0], edge.place[1]);
    noise_at(fl_key(key, KEY_RUN), edge.foot, RUN_PX, 2, n, edge.run);
    noise_at(fl_key(key, KEY_FINGERS), edge.foot, FINGER_PX, 2, n, edge.finger);
    noise_at(fl_key(key, KEY_LOST), edge.foot, LOST_PX, 1, n, edge.where);
    noise_at(fl_key(key, KEY_BACKRUN), edge.place, BACKRUN_PX, 1, n, edge.backrun);
    noise_at(fl_key(key, KEY_CRINKLE), edge.place, CRINKLE_PX, 3, n, edge.crinkle);
    for (int i = 0; i < n; i++, p++) {
        if (to->amounts[p] < 0 || edge.away[i] >= most)
            continue;
        const Run run = run_at(contact, &edge, i);
        const float own = (float)to->amounts[p];
        const float even = own + run.lost * (FL_AMOUNT_ONE - own);
        to->amounts[p] = (int16_t)fl_clamp(even * exp_of(run.tone) + .5f, 0, FL_AMOUNTS - 1);
        mix_in(to->fills + 4 * p, to->other, (int)(SHARES * run.share + .5f));
        if (to->play)
            to->play[p] = (int8_t)((1 - run.lost) * to->play[p]);
        if (to->knockout)
            to->knockout[p] += (uint8_t)(run.lost * (float)(255 - to->knockout[p]));
    }
}

void fl_contact_lay(const FlContact *contact, const FlArea *area, const FlRunning *to)
{
    const FlRect both = fl_rect_and(contact->box, area->box);
#pragma omp parallel for schedule(dynamic, 8) if (fl_schedule_worth_threads(fl_rect_pixels(both)))
    for (int y = both.y; y < both.y + both.height; y++) {
        const FlColumns span = fl_area_row(area, y - area->box.y);
        const size_t row = (size_t)(y - area->box.y) * (size_t)area->box.width;
        const int first = MAX(area->box.x + span.first, both.x);
        const int last = MIN(area->box.x + span.last, both.x + both.width);
        for (int x = first; x < last; x += FL_NOISE_ROW)
            lay_pixels(contact, to, x, y, MIN(FL_NOISE_ROW, last - x),
                       row + (size_t)(x - area->box.x));
    }
}
