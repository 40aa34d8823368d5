/* The pages that look at the film: which pictures each of them has, and which comes next. */
#ifndef FLUIDY_CLI_LIVE_CLIENTS_H
#define FLUIDY_CLI_LIVE_CLIENTS_H

#include "live_film.h"
#include <libsoup/soup.h>

/**
 * A page says in text: "look FRAME", where it is; "more", once for each picture that it has taken;
 * "hide 1" and "hide 0"; "sample FRAME REGION", which asks for that frame in each style, of all
 * regions without a name. It gets the pictures of live_film.h, and JSON objects as text.
 */
typedef struct FlLiveClients FlLiveClients;

/** film is borrowed. */
FlLiveClients *fl_live_clients_new(FlLiveFilm *film);

/** greeting: text to be sent first. */
void fl_live_clients_add(FlLiveClients *clients, SoupWebsocketConnection *socket,
                         const char *greeting);

/** New settings, which the film has: all paint is outdated. */
void fl_live_clients_begin(FlLiveClients *clients, int generation);

/** Sends the pictures of a job that has not failed and looks for the next one; frees the job. */
void fl_live_clients_take(FlLiveClients *clients, FlLiveJob *job);

/** Sends a JSON object to all. */
void fl_live_clients_say(FlLiveClients *clients, const char *json);

/** True if a draft has failed since the settings are as they are: no job comes next. */
bool fl_live_clients_stuck(const FlLiveClients *clients);

void fl_live_clients_free(FlLiveClients *clients); // NULL is fine

#endif
