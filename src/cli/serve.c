#include "serve.h"

#include "base/json.h"
#include "config_edit.h"
#include "file_watch.h"
#include "live_config.h"
#include "live_render.h"
#include "params/options.h"

#include <libsoup/soup.h>
#include <stdio.h>
#include <string.h>

enum { TICK_MS = 50, LONGEST_BODY = 1 << 16, ANSWER_BYTES = 4 << 20, SECRET_BYTES = 16 };

typedef struct Live {
    const FlArgs *args;
    const volatile sig_atomic_t *stop;
    SoupServer *server;
    char *root;     // "/SECRET/": requests without it are refused
    char *hosts[2]; // names of this server in a browser
    FlLiveConfig *config;
    FlLiveRender *render;
    FlFileWatch *files;
    char *preview;  // the frame on view, with its neighbours; or NULL
    char *problem;  // with the config file; or NULL
    int generation; // counts changes of the config and the files
    GMainLoop *loop;
} Live;

/* ---- painting ------------------------------------------------------------------------------- */

static void paint_anew(Live *live)
{
    g_autofree char *config = fl_live_config_portable(live->config);
    g_autofree char *detail = fl_config_edit_get(config, "defaults", "detail");
    live->generation++;
    fl_live_render_start(live->render, config, live->preview, g_strcmp0(detail, "draft") == 0);
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
    g_autoptr(FlFileWatch) before = live->files;
    live->files = fl_file_watch_new(&live->args->render);
    fl_file_watch_add_all(live->files, before);
    g_clear_pointer(&live->problem, g_free);
    if (!fl_live_config_reload(live->config, &error))
        live->problem = g_strdup(error->message);
    paint_anew(live);
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

static const char *config_name(const Live *live)
{
    const char *path = live->args->render.config;
    const char *slash = path ? strrchr(path, '/') : NULL;
    return slash ? slash + 1 : path ? path : "film.conf";
}

static void get_config(Live *live, SoupServerMessage *message, GHashTable *query)
{
    const char *text = fl_live_config_text(live->config);
    answer(message, "text/plain; charset=utf-8", text, strlen(text));
    attach(message, config_name(live));
}

static void get_report(Live *live, SoupServerMessage *message, GHashTable *query)
{
    const FlLiveState state = fl_live_render_state(live->render);
    if (state.step != FL_LIVE_DONE) {
        refuse(message, SOUP_STATUS_NOT_FOUND, "the film is still being painted");
        return;
    }
    answer(message, "text/html; charset=utf-8", state.page->str, state.page->len);
    attach(message, "index.html");
}

static int number_in(GHashTable *query, const char *name)
{
    const char *text = query ? g_hash_table_lookup(query, name) : NULL;
    return text ? (int)CLAMP(g_ascii_strtoll(text, NULL, 10), 0, G_MAXINT) : 0;
}

/* A name, and a list of what are JSON objects already: the first of many. */
static void append_objects(GString *json, const char *name, const GPtrArray *objects, guint from)
{
    const gsize start = json->len;
    g_string_append_printf(json, ",\"%s\":[", name);
    for (guint k = from; k < objects->len && json->len - start < ANSWER_BYTES; k++)
        g_string_append_printf(json, "%s%s", k > from ? "," : "", (const char *)objects->pdata[k]);
    g_string_append_c(json, ']');
}

static void append_command(GString *json, const Live *live)
{
    g_autoptr(GPtrArray) words = g_ptr_array_new_with_free_func(g_free);
    g_autoptr(GString) line = g_string_new("fluidy-svg");
    for (const char *const *input = live->args->render.inputs; *input; input++)
        g_ptr_array_add(words, g_strdup(*input));
    fl_live_render_options(live->args, words);
    g_ptr_array_add(words, g_strdup("-c"));
    g_ptr_array_add(
        words, g_strdup(live->args->render.config ? live->args->render.config : config_name(live)));
    for (guint k = 0; k < words->len; k++) {
        const char *word = words->pdata[k];
        const bool plain = strspn(word, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                        "0123456789-_./=%,+") == strlen(word);
        g_autofree char *quoted = plain ? g_strdup(word) : g_shell_quote(word);
        g_string_append_printf(line, " %s", quoted);
    }
    fl_json_text(json, "command", line->str);
}

/* Everything that changes; ?generation=N&from=K says which config the page has, and how many lines.
 */
static void get_state(Live *live, SoupServerMessage *message, GHashTable *query)
{
    const FlLiveState state = fl_live_render_state(live->render);
    const bool same = number_in(query, "generation") == live->generation;
    const guint from = same ? (guint)number_in(query, "from") : 0;
    g_autoptr(GString) json = g_string_new("{");
    fl_json_number(json, "from", from, true);
    fl_json_number(json, "generation", live->generation, true);
    fl_json_number(json, "total", state.lines->len, true);
    fl_json_text(json, "step", fl_live_step_name(state.step));
    fl_json_text(json, "problem", live->problem);
    g_string_append_printf(json, ",\"progress\":%s", state.progress ? state.progress : "null");
    append_objects(json, "messages", state.messages, 0);
    append_objects(json, "lines", state.lines, from);
    if (!same) {
        fl_json_text(json, "config", fl_live_config_text(live->config));
        fl_json_text(json, "file", config_name(live));
        append_command(json, live);
        g_string_append(json, ",\"settings\":");
        fl_live_config_json(live->config, json);
    }
    g_string_append_c(json, '}');
    answer(message, "application/json", json->str, json->len);
}

/* section, key, value: a choice; frame: the number of the frame that is looked at. */
static void post_choice(Live *live, SoupServerMessage *message, GHashTable *query)
{
    SoupMessageBody *body = soup_server_message_get_request_body(message);
    g_autofree char *text = g_strndup(body->data ? body->data : "", (gsize)body->length);
    g_autoptr(GHashTable) form = soup_form_decode(text);
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
    g_clear_pointer(&live->preview, g_free);
    if (g_hash_table_contains(form, "frame"))
        live->preview = g_strdup_printf("%d~1", number_in(form, "frame"));
    paint_anew(live);
    answer(message, "text/plain", "chosen\n", strlen("chosen\n"));
}

/* ---- requests ------------------------------------------------------------------------------- */

static const struct Resource {
    const char *method, *name;
    void (*answer)(Live *live, SoupServerMessage *message, GHashTable *query);
} resources[] = {
    {"GET", "", get_page},         {"GET", "state", get_state},   {"GET", "options", get_options},
    {"GET", "config", get_config}, {"GET", "report", get_report}, {"POST", "choice", post_choice},
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
    protect(message);
    if (!is_own_page(live, message))
        refuse(message, SOUP_STATUS_FORBIDDEN, "this page is for a browser on this machine");
    else if (!g_str_has_prefix(path, live->root))
        refuse(message, SOUP_STATUS_NOT_FOUND,
               "not found; open the full address that fluidy-svg printed");
    else if ((encoding != SOUP_ENCODING_NONE && encoding != SOUP_ENCODING_CONTENT_LENGTH) ||
             soup_message_headers_get_content_length(headers) > LONGEST_BODY)
        refuse(message, SOUP_STATUS_REQUEST_ENTITY_TOO_LARGE, "the request is larger than 64 KiB");
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

/* ---- the whole ------------------------------------------------------------------------------ */

/* Options that name outputs, or are for a render of its own. */
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
                    "nothing",
                    option->name);
        return false;
    }
    return true;
}

/* 128 random bits from the kernel, as text. */
static char *new_secret(GError **error)
{
    guint8 bytes[SECRET_BYTES];
    g_autoptr(GFile) file = g_file_new_for_path("/dev/urandom");
    g_autoptr(GFileInputStream) random = g_file_read(file, NULL, error);
    gsize n = 0;
    if (!random ||
        !g_input_stream_read_all(G_INPUT_STREAM(random), bytes, sizeof bytes, &n, NULL, error))
        return NULL;
    GString *text = g_string_new("/");
    for (size_t k = 0; k < sizeof bytes; k++)
        g_string_append_printf(text, "%02x", bytes[k]);
    g_string_append_c(text, '/');
    return g_string_free(text, FALSE);
}

static bool open_server(Live *live, GError **error)
{
    g_autoptr(GError) problem = NULL;
    const int port = live->args->port;
    live->root = new_secret(error);
    if (!live->root)
        return false;
    live->server = soup_server_new("server-header", "fluidy-svg", NULL);
    soup_server_add_early_handler(live->server, NULL, on_headers, live, NULL);
    soup_server_add_handler(live->server, NULL, on_request, live, NULL);
    if (!soup_server_listen_local(live->server, (guint)port, SOUP_SERVER_LISTEN_IPV4_ONLY,
                                  &problem)) {
        g_set_error(error, FL_ERROR, FL_ERROR_OUTPUT,
                    "--serve: port %d of 127.0.0.1: %s; choose another one, or none for any", port,
                    problem->message);
        return false;
    }
    GSList *uris = soup_server_get_uris(live->server);
    const int bound = g_uri_get_port(uris->data);
    g_slist_free_full(uris, (GDestroyNotify)g_uri_unref);
    live->hosts[0] = g_strdup_printf("127.0.0.1:%d", bound);
    live->hosts[1] = g_strdup_printf("localhost:%d", bound);
    return true;
}

static void watch_input(const char *path, void *data)
{
    const Live *live = data;
    fl_file_watch_add(live->files, path);
}

/* Reads a few frames, which shows what is wrong with the command line, and how large they are. */
static bool prepare(Live *live, GError **error)
{
    FlRenderOptions few = live->args->render;
    if (!few.frames)
        few.frames = "~1";
    g_autoptr(FlRegionList) list = fl_region_list_new(&few, error);
    if (!list || !(live->config = fl_live_config_new(live->args, error)))
        return false;
    live->preview = live->args->render.frames ? NULL : g_strdup("~1");
    live->render = fl_live_render_new(live->args, list->width, MAX(list->width, list->height),
                                      watch_input, live, error);
    return live->render && open_server(live, error);
}

static void run(Live *live)
{
    live->files = fl_file_watch_new(&live->args->render);
    live->loop = g_main_loop_new(NULL, FALSE);
    const guint tick = g_timeout_add(TICK_MS, on_tick, live);
    printf("http://%s%s\n", live->hosts[0], live->root);
    fflush(stdout);
    paint_anew(live);
    g_main_loop_run(live->loop);
    g_source_remove(tick);
}

static void clear(Live *live)
{
    if (live->server)
        soup_server_disconnect(live->server);
    g_clear_object(&live->server);
    fl_live_render_free(live->render);
    fl_live_config_free(live->config);
    fl_file_watch_free(live->files);
    g_clear_pointer(&live->loop, g_main_loop_unref);
    g_free(live->hosts[0]);
    g_free(live->hosts[1]);
    g_free(live->root);
    g_free(live->preview);
    g_free(live->problem);
}

bool fl_serve(const FlArgs *args, const volatile sig_atomic_t *stop, GError **error)
{
    Live live = {.args = args, .stop = stop};
    const bool served = check_options(args, error) && prepare(&live, error);
    if (served)
        run(&live);
    clear(&live);
    return served;
}
