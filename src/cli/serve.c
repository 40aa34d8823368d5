#include "serve.h"

#include "base/json.h"
#include "file_watch.h"
#include "live_clients.h"
#include "live_config.h"
#include "live_drop.h"
#include "live_socket.h"
#include "params/options.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum {
    TICK_MS = 200,
    LONGEST_BODY = 1 << 16,
    LONGEST_DROP = 64 << 20,
    SECRET_BYTES = 16,
    MOST_MESSAGES = 50,
};

typedef struct Live {
    const FlArgs *args;
    const volatile sig_atomic_t *stop;
    SoupServer *server;
    FlLiveSocket *socket;
    char *root;     // "/SECRET/": requests without it are refused
    char *hosts[2]; // names of this server in a browser
    FlLiveConfig *config;
    FlLiveFilm *film;
    FlLiveClients *clients;
    FlLiveDrop *drop;     // files that were dropped on the page; NULL: those of the command line
    FlLiveDrop *dropping; // files that are on their way
    FlFileWatch *files;
    GPtrArray *messages; // JSON objects, since the settings are as they are
    int generation;      // counts changes of the config and the files
    GMainLoop *loop;
    GSubprocess *window; // NULL: none
} Live;

/* ---- the state of the page --------------------------------------------------------------------
 */

static const char *config_path(const Live *live)
{
    const char *path = live->args->render.config;
    return path ? path : "film.conf";
}

static char *config_name(const Live *live)
{
    return g_path_get_basename(config_path(live));
}

static void append_command(GString *json, const Live *live)
{
    g_autoptr(GPtrArray) words = g_ptr_array_new_with_free_func(g_free);
    g_autoptr(GString) line = g_string_new("fluidy-svg");
    for (const char *const *input = live->args->render.inputs; *input; input++)
        g_ptr_array_add(words, g_strdup(*input));
    fl_live_film_options(live->args, words);
    g_ptr_array_add(words, g_strdup("-c"));
    g_ptr_array_add(words, g_strdup(config_path(live)));
    for (guint k = 0; k < words->len; k++) {
        const char *word = words->pdata[k];
        const bool plain = strspn(word, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                        "0123456789-_./=%,+") == strlen(word);
        g_autofree char *quoted = plain ? g_strdup(word) : g_shell_quote(word);
        g_string_append_printf(line, " %s", quoted);
    }
    fl_json_text(json, "command", line->str);
}

/* All that the page shows besides the film and its pictures; to be freed. */
static char *state_of(const Live *live)
{
    g_autofree char *name = config_name(live);
    GString *json = g_string_new("{\"state\":{");
    fl_json_number(json, "generation", live->generation, true);
    fl_json_text(json, "config", fl_live_config_text(live->config));
    fl_json_text(json, "file", name);
    append_command(json, live);
    g_string_append(json, ",\"settings\":");
    fl_live_config_json(live->config, json);
    g_string_append(json, ",\"messages\":[");
    for (guint k = 0; k < live->messages->len; k++)
        g_string_append_printf(json, k > 0 ? ",%s" : "%s", (char *)live->messages->pdata[k]);
    g_string_append(json, "]}}");
    return g_string_free(json, FALSE);
}

static void say_state(Live *live)
{
    g_autofree char *state = state_of(live);
    fl_live_clients_say(live->clients, state);
}

/* {"KIND":"TEXT"}, to all pages. */
static void say(Live *live, const char *kind, const char *text, bool stays)
{
    g_autoptr(GString) json = g_string_new("{");
    fl_json_text(json, kind, text);
    g_string_append_c(json, '}');
    fl_live_clients_say(live->clients, json->str);
    if (stays && live->messages->len < MOST_MESSAGES)
        g_ptr_array_add(live->messages, g_strdup(json->str));
}

/* ---- painting ------------------------------------------------------------------------------- */

/* anew: the files are read again. */
static void paint_anew(Live *live, bool anew)
{
    const char *const *inputs =
        live->drop ? fl_live_drop_inputs(live->drop) : live->args->render.inputs;
    g_ptr_array_set_size(live->messages, 0);
    live->generation++;
    fl_live_film_set(live->film, live->generation, inputs, anew, config_path(live),
                     fl_live_config_text(live->config));
    say_state(live);
    fl_live_clients_begin(live->clients, live->generation);
}

/* A choice whose first draft fails is taken back. */
static void on_done(FlLiveJob *job, void *data)
{
    Live *live = data;
    const bool current = job->generation == live->generation;
    const bool failed = current && job->error && job->work != FL_LIVE_SAMPLE &&
                        !g_error_matches(job->error, FL_ERROR, FL_ERROR_INTERRUPTED);
    g_autofree char *words = failed ? g_strdup(job->error->message) : NULL;
    const bool first = job->work == FL_LIVE_DRAFT;
    if (current && !failed && first)
        fl_live_config_keep(live->config);
    fl_live_clients_take(live->clients, job);
    if (failed && first && fl_live_config_revert(live->config)) {
        paint_anew(live, false);
        say(live, "refused", words, false);
    } else if (failed)
        say(live, "error", words, true);
}

static void on_progress(const char *stage, int done, int total, void *data)
{
    Live *live = data;
    g_autoptr(GString) json = g_string_new("{\"progress\":{");
    fl_json_text(json, "stage", stage);
    fl_json_number(json, "done", done, true);
    fl_json_number(json, "total", total, true);
    g_string_append(json, "}}");
    fl_live_clients_say(live->clients, json->str);
}

static void on_warning(const char *message, void *data)
{
    say(data, "warning", message, true);
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
        say(live, "error", error->message, true);
    return G_SOURCE_CONTINUE;
}

/* ---- answers -------------------------------------------------------------------------------- */

static void answer(SoupServerMessage *message, const char *type, const char *text, gsize bytes)
{
    soup_server_message_set_status(message, SOUP_STATUS_OK, NULL);
    soup_server_message_set_response(message, type, SOUP_MEMORY_COPY, text, bytes);
}

static void refuse(SoupServerMessage *message, guint status, const char *reason)
{
    g_autofree char *line = g_strdup_printf("%s\n", reason);
    soup_server_message_set_status(message, status, NULL);
    soup_server_message_set_response(message, "text/plain", SOUP_MEMORY_COPY, line, strlen(line));
}

static void attach(SoupServerMessage *message, const char *name)
{
    g_autoptr(GHashTable) params = g_hash_table_new(g_str_hash, g_str_equal);
    g_hash_table_insert(params, (gpointer) "filename", (gpointer)name);
    soup_message_headers_set_content_disposition(soup_server_message_get_response_headers(message),
                                                 "attachment", params);
}

static void get_page(Live *live, SoupServerMessage *message, GHashTable *query)
{
    g_autoptr(GBytes) page = fl_live_page();
    gsize bytes = 0;
    const char *text = g_bytes_get_data(page, &bytes);
    answer(message, "text/html; charset=utf-8", text, bytes);
}

static void get_options(Live *live, SoupServerMessage *message, GHashTable *query)
{
    g_autofree char *json = fl_live_config_options();
    answer(message, "application/json", json, strlen(json));
}

static void get_config(Live *live, SoupServerMessage *message, GHashTable *query)
{
    const char *text = fl_live_config_text(live->config);
    g_autofree char *name = config_name(live);
    answer(message, "text/plain; charset=utf-8", text, strlen(text));
    attach(message, name);
}

static GHashTable *form_of(SoupServerMessage *message)
{
    SoupMessageBody *body = soup_server_message_get_request_body(message);
    g_autofree char *text = g_strndup(body->data ? body->data : "", (gsize)body->length);
    return soup_form_decode(text);
}

/* A choice has section, key and value. The answer is the generation of the new settings. */
static void post_choice(Live *live, SoupServerMessage *message, GHashTable *query)
{
    g_autoptr(GHashTable) form = form_of(message);
    g_autoptr(GError) error = NULL;
    const char *section = g_hash_table_lookup(form, "section");
    const char *key = g_hash_table_lookup(form, "key");
    const char *value = g_hash_table_lookup(form, "value");
    if (!section || !key || !value) {
        refuse(message, SOUP_STATUS_BAD_REQUEST, "expected section, key and value");
        return;
    }
    if (!fl_live_config_choose(live->config, section, key, value, &error)) {
        refuse(message, SOUP_STATUS_BAD_REQUEST, error->message);
        return;
    }
    paint_anew(live, false);
    g_autofree char *generation = g_strdup_printf("%d\n", live->generation);
    answer(message, "text/plain", generation, strlen(generation));
}

/* replace=1: a file that is there already as well. */
static void post_save(Live *live, SoupServerMessage *message, GHashTable *query)
{
    g_autoptr(GHashTable) form = form_of(message);
    g_autoptr(GError) error = NULL;
    const bool replace = g_strcmp0(g_hash_table_lookup(form, "replace"), "1") == 0;
    if (live->drop) {
        refuse(message, SOUP_STATUS_BAD_REQUEST,
               "the drawing was dropped here, so its folder is not known: download the config");
        return;
    }
    g_autofree char *path = fl_live_config_save(live->config, replace, &error);
    if (!path) {
        const bool exists = g_error_matches(error, FL_ERROR, FL_ERROR_EXISTS);
        refuse(message, exists ? SOUP_STATUS_CONFLICT : SOUP_STATUS_BAD_REQUEST, error->message);
        return;
    }
    watch_anew(live); // so the saved file does not count as changed
    answer(message, "text/plain; charset=utf-8", path, strlen(path));
}

typedef struct Dropped {
    Live *live;
    SoupServerMessage *message;
} Dropped;

static void on_dropped(const GError *error, void *data)
{
    g_autofree Dropped *dropped = data;
    Live *live = dropped->live;
    if (error)
        refuse(dropped->message, SOUP_STATUS_BAD_REQUEST, error->message);
    else {
        fl_live_drop_free(live->drop);
        live->drop = g_steal_pointer(&live->dropping);
        paint_anew(live, true);
        answer(dropped->message, "text/plain", "dropped\n", strlen("dropped\n"));
    }
    soup_server_message_unpause(dropped->message);
    g_object_unref(dropped->message);
}

/* ?name=NAME&first=1&last=1: one of several files, which are the drawing from the last one on. */
static void post_drop(Live *live, SoupServerMessage *message, GHashTable *query)
{
    g_autoptr(GError) error = NULL;
    SoupMessageBody *body = soup_server_message_get_request_body(message);
    const char *name = query ? g_hash_table_lookup(query, "name") : NULL;
    const bool first = query && g_hash_table_contains(query, "first");
    if (first)
        fl_live_drop_begin(&live->dropping);
    if (!name || !fl_live_drop_add(live->dropping, name, body->data, (gsize)body->length, &error)) {
        refuse(message, SOUP_STATUS_BAD_REQUEST, error ? error->message : "expected a name");
        return;
    }
    if (!g_hash_table_contains(query, "last")) {
        answer(message, "text/plain", "dropped\n", strlen("dropped\n"));
        return;
    }
    Dropped *dropped = g_new(Dropped, 1);
    *dropped = (Dropped){live, g_object_ref(message)};
    soup_server_message_pause(message);
    fl_live_drop_end(live->dropping, on_dropped, dropped);
}

/* ---- requests ------------------------------------------------------------------------------- */

static const struct Resource {
    const char *method, *name;
    void (*answer)(Live *live, SoupServerMessage *message, GHashTable *query);
} resources[] = {
    {"GET", "", get_page},           {"GET", "options", get_options}, {"GET", "config", get_config},
    {"POST", "choice", post_choice}, {"POST", "save", post_save},     {"POST", "drop", post_drop},
};

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

/* Before the body is read. What gets a status here goes no further. */
static void on_headers(SoupServer *server, SoupServerMessage *message, const char *path,
                       GHashTable *query, void *data)
{
    const Live *live = data;
    SoupMessageHeaders *headers = soup_server_message_get_request_headers(message);
    const SoupEncoding encoding = soup_message_headers_get_encoding(headers);
    const bool drops = g_str_has_suffix(path, "/drop");
    protect(message);
    if (!is_own_page(live, message))
        refuse(message, SOUP_STATUS_FORBIDDEN, "this page is for a browser on this machine");
    else if (!g_str_has_prefix(path, live->root))
        refuse(message, SOUP_STATUS_NOT_FOUND,
               "not found; open the full address that fluidy-svg printed");
    else if ((encoding != SOUP_ENCODING_NONE && encoding != SOUP_ENCODING_CONTENT_LENGTH) ||
             soup_message_headers_get_content_length(headers) >
                 (drops ? LONGEST_DROP : LONGEST_BODY))
        refuse(message, SOUP_STATUS_REQUEST_ENTITY_TOO_LARGE,
               drops ? "the file is larger than 64 MiB" : "the request is larger than 64 KiB");
}

static void on_request(SoupServer *server, SoupServerMessage *message, const char *path,
                       GHashTable *query, void *data)
{
    Live *live = data;
    const char *method = soup_server_message_get_method(message);
    for (size_t k = 0; k < G_N_ELEMENTS(resources); k++)
        if (strcmp(resources[k].method, method) == 0 &&
            strcmp(resources[k].name, path + strlen(live->root)) == 0) {
            resources[k].answer(live, message, query);
            return;
        }
    refuse(message, SOUP_STATUS_NOT_FOUND, "not found");
}

/* A page that looks: its first message is the state. */
static void on_page(SoupServer *server, SoupServerMessage *message, const char *path,
                    SoupWebsocketConnection *socket, void *data)
{
    Live *live = data;
    if (!is_own_page(live, message)) { // this connection needs no answer of on_headers()
        soup_websocket_connection_close(socket, SOUP_WEBSOCKET_CLOSE_POLICY_VIOLATION, NULL);
        return;
    }
    if (fl_live_clients_stuck(live->clients)) // the cause may be mended
        paint_anew(live, false);
    g_autofree char *state = state_of(live);
    fl_live_clients_add(live->clients, socket, state);
}

/* ---- the whole ------------------------------------------------------------------------------ */

/* Refuses options that name outputs or choose another task. */
static bool check_options(const FlArgs *args, GError **error)
{
    static const char *const others[] = {"output", "report",  "layers", "paint",  "stats",
                                         "dump",   "ebsynth", "merge",  "format", "no-frames",
                                         "resume", "dry-run", "watch",  NULL};
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (option->scope != FL_SCOPE_RENDER || !fl_option_is_set(option, &args->render) ||
            !g_strv_contains(others, option->name))
            continue;
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "--serve and --%s contradict each other; the page shows the film and writes "
                    "no frames",
                    option->name);
        return false;
    }
    return true;
}

/* 128 random bits from the kernel, as text. */
static char *new_secret(GError **error)
{
    guint8 bytes[SECRET_BYTES];
    if (getentropy(bytes, sizeof bytes) != 0) {
        g_set_error(error, FL_ERROR, FL_ERROR_OUTPUT, "--serve: there are no random numbers: %s",
                    g_strerror(errno));
        return NULL;
    }
    GString *text = g_string_new("/");
    for (size_t k = 0; k < sizeof bytes; k++)
        g_string_append_printf(text, "%02x", bytes[k]);
    g_string_append_c(text, '/');
    return g_string_free(text, FALSE);
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
    live->socket = fl_live_socket_new(live->server, live->args->port, error);
    if (!live->socket)
        return false;
    const int bound = fl_live_socket_port(live->socket);
    live->hosts[0] = g_strdup_printf("127.0.0.1:%d", bound);
    live->hosts[1] = g_strdup_printf("localhost:%d", bound);
    return true;
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
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
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
    const FlLiveCalls calls = {on_done, on_progress, on_warning, watch_input, live};
    live->messages = g_ptr_array_new_with_free_func(g_free);
    live->film = fl_live_film_new(live->args, &calls);
    live->clients = fl_live_clients_new(live->film);
    watch_anew(live);
    const guint tick = g_timeout_add(TICK_MS, on_tick, live);
    printf("http://%s%s\n", live->hosts[0], live->root);
    fflush(stdout);
    paint_anew(live, false);
    g_main_loop_run(live->loop);
    g_source_remove(tick);
}

static void clear(Live *live)
{
    if (live->window)
        g_subprocess_force_exit(live->window);
    if (live->server)
        soup_server_disconnect(live->server);
    fl_live_film_free(live->film);
    fl_live_clients_free(live->clients);
    fl_live_socket_free(live->socket);
    g_clear_object(&live->server);
    g_clear_object(&live->window);
    fl_live_config_free(live->config);
    fl_file_watch_free(live->files);
    fl_live_drop_free(live->drop);
    fl_live_drop_free(live->dropping);
    g_clear_pointer(&live->messages, g_ptr_array_unref);
    g_clear_pointer(&live->loop, g_main_loop_unref);
    g_free(live->hosts[0]);
    g_free(live->hosts[1]);
    g_free(live->root);
}

bool fl_serve(const FlArgs *args, const volatile sig_atomic_t *stop, GError **error)
{
    Live live = {.args = args, .stop = stop, .loop = g_main_loop_new(NULL, FALSE)};
    const bool served = check_options(args, error) && prepare(&live, error);
    if (served)
        run(&live);
    clear(&live);
    return served;
}
