#include "live_clients.h"

#include <stdlib.h>
#include <string.h>

enum {
    CREDIT = 16, // pictures on their way to a page
    LEAST = 6,   // of them for two jobs, which give up to three each
    LAG = 6,     // frames by which drafts follow the one that is looked at, one after the other
    AROUND = 12, // frames that are drafted in turn after and before one that stays
    PING_S = 20,
};

/* Parts of a frame that a page has. */
enum { HAS_DRAFT = 1, HAS_FRAME = 2, HAS_DRAWING = 4 };

typedef struct Client {
    FlLiveClients *clients;
    SoupWebsocketConnection *socket;
    int look, next; // frames: that is looked at, and that follows the last draft
    int credit;
    bool hidden, plays;
    uint8_t *has;  // by frame
    char *region;  // of samples; "": all
    int sampled;   // the frame of samples
    guint samples; // number that it has; all of them if it has not asked
} Client;

struct FlLiveClients {
    FlLiveFilm *film;
    GPtrArray *all;    // Client
    GPtrArray *styles; // FlStyleEntry
    int generation;
    int n_frames; // 0: not known yet
    char *facts;  // for those who come later
    int n_asked;  // jobs on their way: a second one, so that the film never waits
    bool stuck;   // drafts fail
    bool spoilt;  // frames do
};

static void client_free(void *data)
{
    Client *client = data;
    g_signal_handlers_disconnect_by_data(client->socket, client);
    g_object_unref(client->socket);
    g_free(client->has);
    g_free(client->region);
    g_free(client);
}

FlLiveClients *fl_live_clients_new(FlLiveFilm *film)
{
    FlLiveClients *clients = g_new0(FlLiveClients, 1);
    clients->film = film;
    clients->styles = fl_style_list();
    clients->all = g_ptr_array_new_with_free_func(client_free);
    return clients;
}

void fl_live_clients_free(FlLiveClients *clients)
{
    if (!clients)
        return;
    g_ptr_array_unref(clients->all);
    g_ptr_array_unref(clients->styles);
    g_free(clients->facts);
    g_free(clients);
}

bool fl_live_clients_stuck(const FlLiveClients *clients)
{
    return clients->stuck;
}

/* ---- the next job -----------------------------------------------------------------------------
 */

/* The first frame from `start` on, in a loop, that lacks one of the parts; -1: no frame does. In
 * turn so many frames `around` from there on and so many before, each from the earliest on, since a
 * frame that follows the last one is drafted sooner. */
static int find_lack(const Client *client, int start, int around, int parts)
{
    const int n = client->clients->n_frames;
    for (int k = 0; k < n + 2 * around; k++) {
        const int turn = k / around, blocks = turn % 2 == 0 ? turn / 2 : -(turn + 1) / 2;
        const int frame = ((start + blocks * around + k % around) % n + n) % n;
        if (!(client->has[frame] & parts))
            return frame;
    }
    return -1;
}

static bool wants_draft(Client *client, FlLiveJob *job)
{
    const int n = client->clients->n_frames;
    const int lag = n > 0 ? (client->look - client->next + n) % n : 0;
    const bool goes_on = lag > 0 && lag <= LAG && !(client->has[client->look % n] & HAS_DRAFT) &&
                         client->has[(client->next + n - 1) % n] & HAS_DRAFT;
    const int start = goes_on ? client->next : client->look;
    const int frame =
        n > 0 ? find_lack(client, start, client->plays ? n : AROUND, HAS_DRAFT) : client->look;
    job->work = FL_LIVE_DRAFT;
    job->frame = frame;
    job->with_drawing = n == 0 || (frame >= 0 && !(client->has[frame] & HAS_DRAWING));
    return frame >= 0;
}

static bool wants_sample(Client *client, FlLiveJob *job)
{
    const GPtrArray *styles = client->clients->styles;
    while (client->samples < styles->len &&
           ((const FlStyleEntry *)styles->pdata[client->samples])->hidden)
        client->samples++;
    job->work = FL_LIVE_SAMPLE;
    job->frame = MIN(client->sampled, client->clients->n_frames - 1);
    job->region = *client->region ? client->region : NULL;
    job->style = (int)client->samples;
    return client->samples < styles->len;
}

/* Each frame follows from those before. */
static bool wants_frame(Client *client, FlLiveJob *job)
{
    job->work = FL_LIVE_FRAME;
    const int n = client->clients->n_frames;
    job->frame = client->clients->spoilt || n == 0 ? -1 : find_lack(client, 0, n, HAS_FRAME);
    return job->frame >= 0;
}

/* The parts of a frame that a job gives. */
static int parts_of(const FlLiveJob *job)
{
    return job->work == FL_LIVE_SAMPLE  ? 0
           : job->work == FL_LIVE_FRAME ? HAS_FRAME | HAS_DRAFT
           : job->with_drawing          ? HAS_DRAFT | HAS_DRAWING
                                        : HAS_DRAFT;
}

/* Notes the parts as if the asker had them already, so that its next job is another one. Drawings
 * are noted when they come: they outlast a change of settings, which interrupts jobs. */
static void ask(Client *client, FlLiveJob *job)
{
    FlLiveClients *clients = client->clients;
    job->generation = clients->generation;
    job->asker = client;
    clients->n_asked++;
    if (clients->n_frames > 0)
        client->has[job->frame] |= (uint8_t)(parts_of(job) & ~HAS_DRAWING);
    if (job->work == FL_LIVE_DRAFT)
        client->next = job->frame + 1;
    if (job->work == FL_LIVE_SAMPLE)
        client->samples++;
    fl_live_film_ask(clients->film, job);
}

static void go_on(FlLiveClients *clients)
{
    static bool (*const wants[])(Client *, FlLiveJob *) = {wants_draft, wants_sample, wants_frame};
    const int most = clients->n_frames > 0 ? 2 : 1;
    for (size_t w = 0; w < G_N_ELEMENTS(wants); w++)
        for (guint k = 0; k < clients->all->len && !clients->stuck; k++) {
            Client *client = clients->all->pdata[k];
            FlLiveJob job = {0};
            while (clients->n_asked < most && !client->hidden && client->credit >= LEAST &&
                   wants[w](client, &job))
                ask(client, &job);
        }
}

/* ---- messages of pages --------------------------------------------------------------------------
 */

static int number_after(const char *text, const char *word, int most)
{
    return CLAMP(atoi(text + strlen(word)), 0, most);
}

static void on_text(SoupWebsocketConnection *socket, int type, GBytes *message, void *data)
{
    Client *client = data;
    FlLiveClients *clients = client->clients;
    gsize n = 0;
    const char *bytes = g_bytes_get_data(message, &n);
    g_autofree char *text = g_strndup(bytes ? bytes : "", n);
    const int last = MAX(clients->n_frames - 1, 0);
    if (g_str_has_prefix(text, "look ") || g_str_has_prefix(text, "play ")) {
        client->look = number_after(text, "look ", last);
        client->plays = *text == 'p';
    } else if (strcmp(text, "more") == 0)
        client->credit = MIN(client->credit + 1, CREDIT);
    else if (g_str_has_prefix(text, "hide "))
        client->hidden = number_after(text, "hide ", 1);
    else if (g_str_has_prefix(text, "sample ")) {
        const char *region = strchr(text + strlen("sample "), ' ');
        client->sampled = number_after(text, "sample ", last);
        client->samples = 0;
        g_free(client->region);
        client->region = g_strdup(region ? region + 1 : "");
    }
    go_on(clients);
}

static void on_closed(SoupWebsocketConnection *socket, void *data)
{
    Client *client = data;
    g_ptr_array_remove_fast(client->clients->all, client);
}

static void forget(Client *client, int n_frames)
{
    g_free(client->has);
    client->has = g_new0(uint8_t, MAX(n_frames, 1));
    client->look = CLAMP(client->look, 0, MAX(n_frames - 1, 0));
}

static void say_to(const Client *client, const char *json)
{
    if (soup_websocket_connection_get_state(client->socket) == SOUP_WEBSOCKET_STATE_OPEN)
        soup_websocket_connection_send_text(client->socket, json);
}

void fl_live_clients_add(FlLiveClients *clients, SoupWebsocketConnection *socket,
                         const char *greeting)
{
    Client *client = g_new0(Client, 1);
    *client = (Client){.clients = clients,
                       .socket = g_object_ref(socket),
                       .credit = CREDIT,
                       .region = g_strdup(""),
                       .samples = clients->styles->len};
    forget(client, clients->n_frames);
    soup_websocket_connection_set_keepalive_interval(socket, PING_S);
    g_ptr_array_add(clients->all, client);
    g_signal_connect(socket, "message", G_CALLBACK(on_text), client);
    g_signal_connect(socket, "closed", G_CALLBACK(on_closed), client);
    say_to(client, greeting);
    if (clients->facts)
        say_to(client, clients->facts);
    go_on(clients);
}

void fl_live_clients_say(FlLiveClients *clients, const char *json)
{
    for (guint k = 0; k < clients->all->len; k++)
        say_to(clients->all->pdata[k], json);
}

/* ---- pictures ---------------------------------------------------------------------------------
 */

void fl_live_clients_begin(FlLiveClients *clients, int generation)
{
    clients->generation = generation;
    clients->stuck = clients->spoilt = false;
    for (guint k = 0; k < clients->all->len; k++) {
        Client *client = clients->all->pdata[k];
        for (int f = 0; f < clients->n_frames; f++)
            client->has[f] &= HAS_DRAWING;
    }
    go_on(clients);
}

static void take_facts(FlLiveClients *clients, const FlLiveJob *job)
{
    const bool anew = job->reread || job->n_frames != clients->n_frames;
    g_free(clients->facts);
    clients->facts = g_strdup_printf("{\"film\":%s}", job->facts);
    for (guint k = 0; k < clients->all->len && anew; k++)
        forget(clients->all->pdata[k], job->n_frames);
    clients->n_frames = job->n_frames;
    fl_live_clients_say(clients, clients->facts);
}

/* Pictures go to the page that has asked and to all that lack them, samples only to the asker. */
static void give(Client *client, const FlLiveJob *job)
{
    const int parts = parts_of(job);
    const bool outdated = job->work == FL_LIVE_SAMPLE && job->style >= (int)client->samples;
    const bool wanted = client == job->asker ? !outdated
                                             : !client->hidden && client->credit >= LEAST &&
                                                   parts & ~client->has[job->frame];
    if (!wanted)
        return;
    client->has[job->frame] |= (uint8_t)parts;
    for (guint k = 0; k < job->pictures->len; k++) {
        client->credit--;
        if (soup_websocket_connection_get_state(client->socket) == SOUP_WEBSOCKET_STATE_OPEN)
            soup_websocket_connection_send_message(client->socket, SOUP_WEBSOCKET_DATA_BINARY,
                                                   job->pictures->pdata[k]);
    }
}

void fl_live_clients_take(FlLiveClients *clients, FlLiveJob *job)
{
    const bool current = job->generation == clients->generation;
    clients->n_asked--;
    if (job->facts)
        take_facts(clients, job);
    if (current && job->error && job->work != FL_LIVE_SAMPLE) {
        clients->stuck |= job->work == FL_LIVE_DRAFT;
        clients->spoilt = true;
    } else if (current)
        for (guint k = 0; k < clients->all->len; k++)
            give(clients->all->pdata[k], job);
    fl_live_job_free(job);
    go_on(clients);
}
