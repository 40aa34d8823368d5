#include "live_socket.h"

#include <fluidy/error.h>

enum { MOST = 64, PAUSE_MS = 250, SILENT_S = 60 };

struct FlLiveSocket {
    SoupServer *server;
    GSocket *socket;
    GSource *source; // waits for connections, or for the pause to end
    int n;           // open connections
    bool freed;      // but for the connections that count
};

static void free_all(FlLiveSocket *listener)
{
    g_clear_object(&listener->socket);
    g_free(listener);
}

static void on_end(void *data, GObject *connection)
{
    FlLiveSocket *listener = data;
    if (--listener->n == 0 && listener->freed)
        free_all(listener);
}

static void wait_for(FlLiveSocket *listener, GSource *source, GSourceFunc call)
{
    if (listener->source) {
        g_source_destroy(listener->source);
        g_source_unref(listener->source);
    }
    listener->source = source;
    if (!source)
        return;
    g_source_set_callback(source, call, listener, NULL);
    g_source_attach(source, NULL);
}

static void open_door(FlLiveSocket *listener);

static gboolean on_pause(void *data)
{
    open_door(data);
    return G_SOURCE_REMOVE;
}

static gboolean on_connection(GSocket *socket, GIOCondition condition, void *data)
{
    FlLiveSocket *listener = data;
    g_autoptr(GError) error = NULL;
    g_autoptr(GSocket) accepted = g_socket_accept(socket, NULL, &error);
    if (!accepted && g_error_matches(error, G_IO_ERROR, G_IO_ERROR_WOULD_BLOCK))
        return G_SOURCE_CONTINUE;
    if (!accepted) {
        wait_for(listener, g_timeout_source_new(PAUSE_MS), on_pause);
        return G_SOURCE_REMOVE;
    }
    if (listener->n >= MOST)
        return G_SOURCE_CONTINUE;
    g_socket_set_timeout(accepted, SILENT_S);
    GSocketConnection *connection = g_socket_connection_factory_create_connection(accepted);
    g_autoptr(GSocketAddress) here = g_socket_get_local_address(accepted, NULL);
    g_autoptr(GSocketAddress) there = g_socket_get_remote_address(accepted, NULL);
    listener->n++;
    g_object_weak_ref(G_OBJECT(connection), on_end, listener);
    soup_server_accept_iostream(listener->server, G_IO_STREAM(connection), here, there, NULL);
    g_object_unref(connection);
    return G_SOURCE_CONTINUE;
}

static void open_door(FlLiveSocket *listener)
{
    wait_for(listener, g_socket_create_source(listener->socket, G_IO_IN, NULL),
             G_SOURCE_FUNC(on_connection));
}

FlLiveSocket *fl_live_socket_new(SoupServer *server, int port, GError **error)
{
    g_autoptr(GError) problem = NULL;
    g_autoptr(GInetAddress) here = g_inet_address_new_loopback(G_SOCKET_FAMILY_IPV4);
    g_autoptr(GSocketAddress) address = g_inet_socket_address_new(here, (guint16)port);
    g_autoptr(GSocket) socket =
        g_socket_new(G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_STREAM, G_SOCKET_PROTOCOL_TCP, &problem);
    if (!socket || !g_socket_bind(socket, address, TRUE, &problem) ||
        !g_socket_listen(socket, &problem)) {
        g_set_error(error, FL_ERROR, FL_ERROR_OUTPUT,
                    "--serve: port %d of 127.0.0.1: %s; choose another one, or none for any", port,
                    problem->message);
        return NULL;
    }
    FlLiveSocket *listener = g_new0(FlLiveSocket, 1);
    *listener = (FlLiveSocket){.server = server, .socket = g_steal_pointer(&socket)};
    g_socket_set_blocking(listener->socket, FALSE);
    open_door(listener);
    return listener;
}

int fl_live_socket_port(const FlLiveSocket *listener)
{
    g_autoptr(GSocketAddress) address = g_socket_get_local_address(listener->socket, NULL);
    return g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(address));
}

void fl_live_socket_free(FlLiveSocket *listener)
{
    if (!listener)
        return;
    wait_for(listener, NULL, NULL);
    listener->freed = true;
    if (listener->n == 0)
        free_all(listener);
}
