#include "serve.h"

#include "base/json.h"
#include "file_watch.h"
#include "live_config.h"
#include "live_drop.h"
#include "live_film.h"
#include "params/options.h"
#include "params/text.h"

#include <errno.h>
#include <libsoup/soup.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum {
    TICK_MS = 200,
    PING_S = 20,
    SILENT_S = 60,
    MOST_CONNECTIONS = 24,
    LONGEST_DROP = 256 << 20,
    SECRET_BYTES = 16,
    MOST_MESSAGES = 50,
};

typedef struct Live {
    const FlArgs *args;
    const volatile sig_atomic_t *stop;
    SoupServer *server;
    GSocketService *service; // hands it connections
    int n_connections;
    char *root;       // "/SECRET/": requests without it are refused
    char *hosts[2];   // names of this server in a browser
    GPtrArray *pages; // SoupWebsocketConnection
    FlLiveConfig *config;
    FlLiveFilm *film;
    char *facts;      // of the film, for pages that come later
    FlLiveDrop *drop; // files that were dropped on the page; NULL: those of the command line
    FlLiveDrop *last; // those before, until these are drafted
    FlFileWatch *files;
    GPtrArray *messages; // JSON objects, since the settings are as they are
    int generation;      // counts changes of the config and the files
    GMainLoop *loop;
    GSubprocess *window; // NULL: none
} Live;

/* ---- messages to pages ---------------------------------------------------------------------- */

static void say_to(SoupWebsocketConnection *page, const char *json)
{
    if (soup_websocket_connection_get_state(page) == SOUP_WEBSOCKET_STATE_OPEN)
        soup_websocket_connection_send_text(page, json);
}

static void say_to_all(const char *json, void *data)
{
    const Live *live = data;
    for (guint k = 0; k < live->pages->len; k++)
        say_to(live->pages->pdata[k], json);
}

/* {"KIND":"TEXT","key":"KEY"}, to be freed. key: of the choice that it is about, or NULL. */
static char *object_of(const char *kind, const char *text, const char *key)
{
    GString *json = g_string_new("{");
    fl_json_text(json, kind, text);
    fl_json_text(json, "key", key);
    g_string_append_c(json, '}');
    return g_string_free(json, FALSE);
}

static void answer_page(SoupWebsocketConnection *page, const char *kind, const char *text)
{
    g_autofree char *json = object_of(kind, text, NULL);
    say_to(page, json);
}

/* To all pages, and to those that come before the settings change. */
static void tell(Live *live, const char *kind, const char *text)
{
    char *json = object_of(kind, text, NULL);
    say_to_all(json, live);
    g_ptr_array_add(live->messages, json);
    if (live->messages->len > MOST_MESSAGES)
        g_ptr_array_remove_index(live->messages, 0);
}

/* All that the page shows besides the film and its pictures; to be freed. */
static char *state_of(const Live *live)
{
    const char *path = fl_live_config_path(live->config);
    g_autofree char *name = g_path_get_basename(path);
    g_autofree char *command = fl_live_film_command(live->args, path);
    char **undo = fl_live_config_choice(live->config, -1);
    char **redo = fl_live_config_choice(live->config, 1);
    GString *json = g_string_new("{\"state\":{");
    fl_json_number(json, "generation", live->generation, true);
    fl_json_text(json, "config", fl_live_config_text(live->config));
    fl_json_text(json, "file", name);
    fl_json_text(json, "undo", undo ? undo[1] : NULL); // the keys
    fl_json_text(json, "redo", redo ? redo[1] : NULL);
    fl_json_text(json, "command", command);
    g_string_append(json, ",\"messages\":[");
    for (guint k = 0; k < live->messages->len; k++)
        g_string_append_printf(json, k > 0 ? ",%s" : "%s", (char *)live->messages->pdata[k]);
    g_string_append(json, "]}}");
    return g_string_free(json, FALSE);
}

/* ---- painting ------------------------------------------------------------------------------- */

/* anew: the files are read again. */
static void paint_anew(Live *live, bool anew)
{
    const char *const *inputs =
        live->drop ? fl_live_drop_inputs(live->drop) : live->args->render.inputs;
    g_ptr_array_set_size(live->messages, 0);
    live->generation++;
    fl_live_film_set(live->film, live->generation, inputs, anew, fl_live_config_path(live->config),
                     fl_live_config_text(live->config));
    g_autofree char *state = state_of(live);
    say_to_all(state, live);
}

/* Frees files that were dropped, unless they are the others. */
static void free_drop(FlLiveDrop *drop, const FlLiveDrop *others)
{
    if (drop != others)
        fl_live_drop_free(drop);
}

/* Takes back all that was chosen or dropped since the last draft. The words stand at the control of
 * a lone choice; of several, any may be wrong. */
static bool take_back(Live *live, const char *words)
{
    const bool dropped = live->last != live->drop;
    char **last = fl_live_config_choice(live->config, -1);
    g_autofree char *key = last ? g_strdup(last[1]) : NULL;
    const guint chosen = fl_live_config_revert(live->config);
    g_autofree char *all =
        g_strdup_printf("%s (the last %u choices were taken back)", words, chosen);
    g_autofree char *refused =
        object_of("refused", chosen > 1 ? all : words, chosen == 1 && !dropped ? key : NULL);
    free_drop(live->drop, live->last);
    live->drop = live->last;
    if (dropped || chosen > 0) {
        paint_anew(live, dropped);
        say_to_all(refused, live);
    }
    return dropped || chosen > 0;
}

/* The page of a sample that fails no longer waits for it. */
static void on_failed(Live *live, const FlLiveJob *job)
{
    g_autofree char *words = fl_live_drop_words(live->drop, job->error->message);
    if (job->work == FL_LIVE_SAMPLE)
        answer_page(job->asker, "lost", "a sample");
    else if (job->work != FL_LIVE_DRAFT || !take_back(live, words))
        tell(live, "error", words);
}

static void on_done(FlLiveJob *job, void *data)
{
    Live *live = data;
    const bool current = job->generation == live->generation;
    g_autoptr(SoupWebsocketConnection) page = job->asker;
    if (job->facts) {
        g_free(live->facts);
        live->facts = g_strdup_printf("{\"film\":%s}", job->facts);
        say_to_all(live->facts, live);
    }
    for (guint k = 0; current && k < job->pictures->len; k++)
        if (soup_websocket_connection_get_state(page) == SOUP_WEBSOCKET_STATE_OPEN)
            soup_websocket_connection_send_message(page, SOUP_WEBSOCKET_DATA_BINARY,
                                                   job->pictures->pdata[k]);
    if (current && job->error && !g_error_matches(job->error, FL_ERROR, FL_ERROR_INTERRUPTED))
        on_failed(live, job);
    else if (current && job->work == FL_LIVE_DRAFT) {
        free_drop(live->last, live->drop);
        live->last = live->drop;
        fl_live_config_keep(live->config);
    }
    fl_live_job_free(job);
}

static void on_warning(const char *message, void *data)
{
    Live *live = data;
    g_autofree char *words = fl_live_drop_words(live->drop, message);
    tell(live, "warning", words);
}

static void watch_input(const char *path, void *data)
{
    const Live *live = data;
    fl_file_watch_add(live->files, path);
}

static void watch_anew(Live *live)
{
    g_autoptr(FlFileWatch) before = live->files;
    live->files = fl_file_watch_new(live->args->render.inputs, live->args->render.config);
    if (before)
        fl_file_watch_add_all(live->files, before);
}

/* Looks whether it is time to end, and for changed files. */
static gboolean on_tick(void *data)
{
    Live *live = data;
    g_autoptr(GError) error = NULL;
    if (*live->stop)
        g_main_loop_quit(live->loop);
    if (*live->stop || !fl_file_watch_has_settled(live->files))
        return G_SOURCE_CONTINUE;
    watch_anew(live);
    const bool read = fl_live_config_reload(live->config, &error);
    paint_anew(live, true);
    if (!read)
        tell(live, "error", error->message);
    return G_SOURCE_CONTINUE;
}

/* ---- messages of pages ---------------------------------------------------------------------- */

/* A whole number from `least` to `most`; any other text is `least`. */
static int number_of(const char *text, int least, int most)
{
    int number = least;
    (void)fl_text_integer(text, least, most, &number);
    return number;
}

/* paint, GENERATION of the settings, WORK, FRAME, STYLE, REGION: a job. */
static void take_paint(Live *live, SoupWebsocketConnection *page, char **part)
{
    FlLiveJob *job = g_new(FlLiveJob, 1);
    *job = (FlLiveJob){.work = number_of(part[2], FL_LIVE_DRAFT, FL_LIVE_DRAWING),
                       .generation = number_of(part[1], 0, G_MAXINT),
                       .frame = number_of(part[3], 0, G_MAXINT),
                       .style = number_of(part[4], 0, G_MAXINT),
                       .region = *part[5] ? g_strdup(part[5]) : NULL,
                       .asker = g_object_ref(page)};
    fl_live_film_ask(live->film, job);
}

/* choose, SECTION, KEY, VALUE. */
static void take_choice(Live *live, SoupWebsocketConnection *page, char **part)
{
    g_autoptr(GError) error = NULL;
    const bool chosen = fl_live_config_choose(live->config, part[1], part[2], part[3], &error);
    if (chosen)
        paint_anew(live, false);
    answer_page(page, "taken", part[2]);
    g_autofree char *refused = chosen ? NULL : object_of("refused", error->message, part[2]);
    if (refused)
        say_to(page, refused);
}

/* step, BY: -1 takes a choice back, 1 makes it again. */
static void take_step(Live *live, SoupWebsocketConnection *page, char **part)
{
    if (fl_live_config_step(live->config, number_of(part[1], -1, 1)))
        paint_anew(live, false);
}

/* save, REPLACE: "1": a file that is there already as well. */
static void take_save(Live *live, SoupWebsocketConnection *page, char **part)
{
    g_autoptr(GError) error = NULL;
    if (live->drop)
        fl_fail(&error, FL_ERROR_USAGE,
                "the drawing was dropped here, so its folder is not known: download the "
                "config");
    else if (fl_live_config_save(live->config, *part[1] == '1', &error))
        watch_anew(live); // so the saved file does not count as changed
    const bool exists = g_error_matches(error, FL_ERROR, FL_ERROR_EXISTS);
    answer_page(page,
                exists  ? "exists"
                : error ? "unsaved"
                        : "saved",
                error ? error->message : fl_live_config_path(live->config));
}

/* Each part of a message is a line. The library has checked that text is UTF-8. */
static void on_message(SoupWebsocketConnection *page, int type, GBytes *message, void *data)
{
    static const struct {
        const char *name;
        guint parts;
        void (*take)(Live *live, SoupWebsocketConnection *page, char **part);
    } known[] = {{"paint", 6, take_paint},
                 {"choose", 4, take_choice},
                 {"step", 2, take_step},
                 {"save", 2, take_save}};
    gsize bytes;
    const char *letters = g_bytes_get_data(message, &bytes);
    g_autofree char *text = g_strndup(letters ? letters : "", bytes);
    g_auto(GStrv) part = g_strsplit(text, "\n", -1);
    for (size_t k = 0; k < G_N_ELEMENTS(known); k++)
        if (type == SOUP_WEBSOCKET_DATA_TEXT && g_strv_length(part) == known[k].parts &&
            strcmp(part[0], known[k].name) == 0) {
            known[k].take(data, page, part);
            return;
        }
    answer_page(page, "refused", "expected paint, choose, step or save, and a line for each value");
}

static void on_closed(SoupWebsocketConnection *page, void *data)
{
    const Live *live = data;
    g_ptr_array_remove_fast(live->pages, page);
}

/* ---- requests ------------------------------------------------------------------------------- */

static void answer(SoupServerMessage *message, guint status, const char *type, const char *text,
                   gsize bytes)
{
    soup_server_message_set_status(message, status, NULL);
    soup_server_message_set_response(message, type, SOUP_MEMORY_COPY, text, bytes);
}

static void answer_line(SoupServerMessage *message, guint status, const char *words)
{
    g_autofree char *line = g_strdup_printf("%s\n", words);
    answer(message, status, "text/plain; charset=utf-8", line, strlen(line));
}

/* Dropped files are painted in place of the others; see take_back(). */
static void take_drop(Live *live, SoupServerMessage *message)
{
    g_autoptr(GError) error = NULL;
    FlLiveDrop *drop = fl_live_drop_new(message, &error);
    if (drop) {
        free_drop(live->drop, live->last);
        live->drop = drop;
        paint_anew(live, true);
    }
    answer_line(message, drop ? SOUP_STATUS_OK : SOUP_STATUS_BAD_REQUEST,
                drop ? "dropped" : error->message);
}

static bool is_own_host(const Live *live, const char *host)
{
    return host && (strcmp(host, live->hosts[0]) == 0 || strcmp(host, live->hosts[1]) == 0);
}

/* A page of another site may send forms here, and by a name of its own that leads to this machine
 * even read answers. Neither knows the address's secret; both say who they are. */
static bool is_own_page(const Live *live, SoupServerMessage *message)
{
    SoupMessageHeaders *headers = soup_server_message_get_request_headers(message);
    const char *origin = soup_message_headers_get_one(headers, "Origin");
    const bool posts = strcmp(soup_server_message_get_method(message), "POST") == 0;
    const bool same = origin && g_str_has_prefix(origin, "http://") &&
                      is_own_host(live, origin + strlen("http://"));
    return is_own_host(live, soup_message_headers_get_one(headers, "Host")) &&
           (origin || posts ? same : true);
}

static void protect(SoupServerMessage *message)
{
    static const char *const headers[][2] = {
        {"Cache-Control", "no-store"},
        {"Referrer-Policy", "no-referrer"},
        {"X-Content-Type-Options", "nosniff"},
        {"X-Frame-Options", "DENY"},
        {"Cross-Origin-Resource-Policy", "same-origin"},
    };
    SoupMessageHeaders *sent = soup_server_message_get_response_headers(message);
    for (size_t k = 0; k < G_N_ELEMENTS(headers); k++)
        soup_message_headers_replace(sent, headers[k][0], headers[k][1]);
}

/* Before the body is read. A request that gets a status here goes no further, and its body is
 * not kept. */
static void on_headers(SoupServer *server, SoupServerMessage *message, const char *path,
                       GHashTable *query, void *data)
{
    const Live *live = data;
    SoupMessageHeaders *headers = soup_server_message_get_request_headers(message);
    const bool drops = g_str_has_suffix(path, "/drop");
    protect(message);
    if (!is_own_page(live, message))
        answer_line(message, SOUP_STATUS_FORBIDDEN, "this page is for a browser on this machine");
    else if (!g_str_has_prefix(path, live->root))
        answer_line(message, SOUP_STATUS_NOT_FOUND,
                    "not found; open the full address that fluidy-svg printed");
    else if (soup_message_headers_get_encoding(headers) == SOUP_ENCODING_CHUNKED ||
             soup_message_headers_get_content_length(headers) > (drops ? LONGEST_DROP : 0))
        answer_line(message, SOUP_STATUS_REQUEST_ENTITY_TOO_LARGE,
                    "the files are larger than 256 MiB; give the program their folder");
    if (soup_server_message_get_status(message) != SOUP_STATUS_NONE)
        soup_message_body_set_accumulate(soup_server_message_get_request_body(message), FALSE);
}

static void on_request(SoupServer *server, SoupServerMessage *message, const char *path,
                       GHashTable *query, void *data)
{
    Live *live = data;
    const char *method = soup_server_message_get_method(message);
    const char *name = path + strlen(live->root);
    g_autoptr(GBytes) page = fl_live_page();
    if (strcmp(method, "GET") == 0 && !*name)
        answer(message, SOUP_STATUS_OK, "text/html; charset=utf-8", g_bytes_get_data(page, NULL),
               g_bytes_get_size(page));
    else if (strcmp(method, "POST") == 0 && strcmp(name, "drop") == 0)
        take_drop(live, message);
    else
        answer_line(message, SOUP_STATUS_NOT_FOUND, "not found");
}

/* A page that has connected gets its controls, the state and the facts of the film. */
static void on_page(SoupServer *server, SoupServerMessage *message, const char *path,
                    SoupWebsocketConnection *page, void *data)
{
    Live *live = data;
    if (!is_own_page(live, message)) { // this connection needs no answer of on_headers()
        soup_websocket_connection_close(page, SOUP_WEBSOCKET_CLOSE_POLICY_VIOLATION, NULL);
        return;
    }
    g_autofree char *state = state_of(live), *controls = fl_live_config_options();
    soup_websocket_connection_set_keepalive_interval(page, PING_S);
    g_ptr_array_add(live->pages, g_object_ref(page));
    g_signal_connect(page, "message", G_CALLBACK(on_message), live);
    g_signal_connect(page, "closed", G_CALLBACK(on_closed), live);
    say_to(page, controls);
    say_to(page, state);
    if (live->facts)
        say_to(page, live->facts);
}

/* ---- the whole ------------------------------------------------------------------------------ */

/* Refuses options that name outputs or choose another task. */
static bool check_options(const FlArgs *args, GError **error)
{
    static const char *const others[] = {"output", "report",  "layers", "paint",  "stats",
                                         "dump",   "ebsynth", "merge",  "format", "no-frames",
                                         "resume", "dry-run", "watch",  NULL};
    for (const char *const *name = others; *name; name++)
        if (fl_option_is_set(fl_option_find(FL_SCOPE_RENDER, *name), &args->render))
            return fl_fail(error, FL_ERROR_USAGE,
                           "--serve and --%s contradict each other; the page shows the film and "
                           "writes no frames",
                           *name);
    return true;
}

/* 128 random bits from the kernel, as text. */
static char *new_secret(GError **error)
{
    guint8 bytes[SECRET_BYTES];
    if (getentropy(bytes, sizeof bytes) != 0)
        return fl_none(error, FL_ERROR_OUTPUT, "--serve: there are no random numbers: %s",
                       g_strerror(errno));
    g_autofree char *digest = g_compute_checksum_for_data(G_CHECKSUM_SHA256, bytes, sizeof bytes);
    return g_strdup_printf("/%.*s/", 2 * SECRET_BYTES, digest);
}

static void on_end(void *data, GObject *connection)
{
    Live *live = data;
    live->n_connections--;
}

/* Connections beyond the most are closed at once, so that files can still be opened. */
static gboolean on_connection(GSocketService *service, GSocketConnection *connection,
                              GObject *source, void *data)
{
    Live *live = data;
    g_autoptr(GSocketAddress) here = g_socket_connection_get_local_address(connection, NULL);
    g_autoptr(GSocketAddress) there = g_socket_connection_get_remote_address(connection, NULL);
    if (live->n_connections >= MOST_CONNECTIONS)
        return TRUE;
    live->n_connections++;
    g_object_weak_ref(G_OBJECT(connection), on_end, live);
    g_socket_set_timeout(g_socket_connection_get_socket(connection), SILENT_S);
    soup_server_accept_iostream(live->server, G_IO_STREAM(connection), here, there, NULL);
    return TRUE;
}

/* Returns: the port of 127.0.0.1; 0: an error. */
static int listen_here(Live *live, GError **error)
{
    g_autoptr(GInetAddress) loopback = g_inet_address_new_loopback(G_SOCKET_FAMILY_IPV4);
    g_autoptr(GSocketAddress) bound = NULL;
    g_autoptr(GSocketAddress) address =
        g_inet_socket_address_new(loopback, (guint16)live->args->port);
    g_autoptr(GError) problem = NULL;
    live->service = g_socket_service_new();
    g_signal_connect(live->service, "incoming", G_CALLBACK(on_connection), live);
    if (g_socket_listener_add_address(G_SOCKET_LISTENER(live->service), address,
                                      G_SOCKET_TYPE_STREAM, G_SOCKET_PROTOCOL_TCP, NULL, &bound,
                                      &problem))
        return g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(bound));
    fl_fail(error, FL_ERROR_OUTPUT,
            "--serve: port %d of 127.0.0.1: %s; choose another one, or none for any",
            live->args->port, problem->message);
    return 0;
}

static bool open_server(Live *live, GError **error)
{
    live->root = new_secret(error);
    if (!live->root)
        return false;
    g_autofree char *pictures = g_strconcat(live->root, "pictures", NULL);
    live->server = soup_server_new("server-header", "fluidy-svg", NULL);
    soup_server_add_early_handler(live->server, NULL, on_headers, live, NULL);
    soup_server_add_handler(live->server, NULL, on_request, live, NULL);
    soup_server_add_websocket_handler(live->server, pictures, NULL, NULL, on_page, live, NULL);
    const int port = listen_here(live, error);
    live->hosts[0] = g_strdup_printf("127.0.0.1:%d", port);
    live->hosts[1] = g_strdup_printf("localhost:%d", port);
    return port > 0;
}

static void on_window_closed(GObject *window, GAsyncResult *result, void *data)
{
    const Live *live = data;
    g_main_loop_quit(live->loop);
}

/* The window is a program beside this one, which would start later with all that WebKit needs. */
static bool open_window(Live *live, GError **error)
{
    if (live->args->task != FL_COMMAND_WINDOW)
        return true;
    g_autofree char *self = g_file_read_link("/proc/self/exe", NULL);
    g_autofree char *folder = g_path_get_dirname(self ? self : "");
    g_autofree char *program = g_build_filename(folder, "fluidy-window", NULL);
    g_autofree char *address = g_strconcat("http://", live->hosts[0], live->root, NULL);
    live->window = g_subprocess_new(G_SUBPROCESS_FLAGS_NONE, NULL, program, address, NULL);
    if (!live->window)
        fl_fail(error, FL_ERROR_USAGE,
                "--window: %s cannot be run; this build has no window, which needs WebKitGTK",
                program);
    else
        g_subprocess_wait_async(live->window, NULL, on_window_closed, live);
    return live->window;
}

/* Reads a frame, which finds mistakes in the command line. */
static bool prepare(Live *live, GError **error)
{
    FlRenderOptions few = live->args->render;
    if (!few.frames)
        few.frames = "~1";
    (void)fl_start_workers(); // before there are threads
    g_autoptr(FlRegionList) list = fl_region_list_new(&few, error);
    return list && (live->config = fl_live_config_new(live->args, error)) &&
           open_server(live, error) && open_window(live, error);
}

static void run(Live *live)
{
    const FlLiveCalls calls = {on_done, say_to_all, on_warning, watch_input, live};
    live->film = fl_live_film_new(live->args, &calls);
    watch_anew(live);
    const guint tick = g_timeout_add(TICK_MS, on_tick, live);
    printf("http://%s%s\n", live->hosts[0], live->root);
    fflush(stdout);
    paint_anew(live, false);
    g_autoptr(GError) blind = NULL;
    if (!fl_file_watch_works(&blind))
        tell(live, "warning", blind->message);
    g_main_loop_run(live->loop);
    g_source_remove(tick);
}

static void clear(Live *live)
{
    if (live->window)
        g_subprocess_force_exit(live->window);
    if (live->service)
        g_socket_service_stop(live->service);
    if (live->server)
        soup_server_disconnect(live->server);
    fl_live_film_free(live->film);
    g_ptr_array_unref(live->pages);
    g_clear_object(&live->server);
    g_clear_object(&live->service);
    g_clear_object(&live->window);
    free_drop(live->last, live->drop);
    fl_live_drop_free(live->drop);
    fl_live_config_free(live->config);
    fl_file_watch_free(live->files);
    g_ptr_array_unref(live->messages);
    g_main_loop_unref(live->loop);
    g_free(live->facts);
    g_free(live->hosts[0]);
    g_free(live->hosts[1]);
    g_free(live->root);
}

bool fl_serve(const FlArgs *args, const volatile sig_atomic_t *stop, GError **error)
{
    Live live = {.args = args,
                 .stop = stop,
                 .pages = g_ptr_array_new_with_free_func(g_object_unref),
                 .messages = g_ptr_array_new_with_free_func(g_free),
                 .loop = g_main_loop_new(NULL, FALSE)};
    const bool served = check_options(args, error) && prepare(&live, error);
    if (served)
        run(&live);
    clear(&live);
    return served;
}
