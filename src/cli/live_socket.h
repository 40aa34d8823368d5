/* The port of the live page: connections to this machine alone, so many at a time. */
#ifndef FLUIDY_CLI_LIVE_SOCKET_H
#define FLUIDY_CLI_LIVE_SOCKET_H

#include <libsoup/soup.h>
#include <stdbool.h>

typedef struct FlLiveSocket FlLiveSocket;

/**
 * Listens at a port of 127.0.0.1, 0: any that is free, and hands connections to the server. Up to
 * 64 are open at a time, further ones are closed. Where no connection can be accepted, since the
 * process has no more descriptors, it waits for a moment and goes on.
 *
 * Returns: to be freed with fl_live_socket_free(); NULL with FL_ERROR_OUTPUT.
 */
FlLiveSocket *fl_live_socket_new(SoupServer *server, int port, GError **error);

/** The port that it has got. */
int fl_live_socket_port(const FlLiveSocket *socket);

void fl_live_socket_free(FlLiveSocket *socket); // NULL is fine

#endif
