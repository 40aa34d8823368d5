#include "live_drop.h"

#include "base/error.h"
#include "base/file.h"

#include <gio/gio.h>

#define KNOWN "^[^./[:cntrl:]][^/[:cntrl:]]{0,190}\\.(svgz?|css|json|lottie)$"

struct FlLiveDrop {
    char *folder, *files; // files are in a folder of it, whose name may be the film's
    char *inputs[2];
};

/* Writes a part of the form; the first one alone is the input. */
static bool add_file(FlLiveDrop *drop, SoupMessageHeaders *headers, GBytes *body, GError **error)
{
    g_autoptr(GHashTable) params = NULL;
    g_autofree char *disposition = NULL;
    gsize bytes;
    const char *data = g_bytes_get_data(body, &bytes), *name = NULL;
    if (soup_message_headers_get_content_disposition(headers, &disposition, &params))
        name = g_hash_table_lookup(params, "filename");
    if (!name || !g_regex_match_simple(KNOWN, name, 0, 0))
        return fl_fail(error, FL_ERROR_INPUT,
                       "%s: expected drawings, .svg or .svgz, and their style sheets, .css, or an "
                       "animation, .json or .lottie",
                       name ? name : "a file without a name");
    g_autofree char *file = g_build_filename(drop->files, name, NULL);
    const bool first = !drop->inputs[0];
    g_free(drop->inputs[0]);
    drop->inputs[0] = g_strdup(first ? file : drop->files);
    return g_file_set_contents(file, data ? data : "", (gssize)bytes, error);
}

FlLiveDrop *fl_live_drop_new(SoupServerMessage *message, GError **error)
{
    g_autoptr(GBytes) body =
        soup_message_body_flatten(soup_server_message_get_request_body(message));
    g_autoptr(SoupMultipart) form =
        soup_multipart_new_from_message(soup_server_message_get_request_headers(message), body);
    const int n = form ? soup_multipart_get_length(form) : 0;
    g_autoptr(FlLiveDrop) drop = g_new0(FlLiveDrop, 1);
    drop->folder = g_dir_make_tmp("fluidy-svg-XXXXXX", error);
    if (!drop->folder)
        return NULL;
    drop->files = g_build_filename(drop->folder, "drawing", NULL);
    (void)g_mkdir_with_parents(drop->files, 0700); // an error is told when a file is written
    bool good = n > 0;
    if (!good)
        g_set_error_literal(error, FL_ERROR, FL_ERROR_INPUT, "expected files");
    for (int k = 0; k < n && good; k++) {
        SoupMessageHeaders *headers;
        GBytes *part;
        good = soup_multipart_get_part(form, k, &headers, &part) &&
               add_file(drop, headers, part, error);
    }
    return good ? g_steal_pointer(&drop) : NULL;
}

const char *const *fl_live_drop_inputs(const FlLiveDrop *drop)
{
    return (const char *const *)drop->inputs;
}

char *fl_live_drop_words(const FlLiveDrop *drop, const char *words)
{
    GString *text = g_string_new(words);
    for (int k = 0; k < 2 && drop; k++) {
        g_autofree char *folder = g_strconcat(k == 0 ? drop->files : drop->folder, "/", NULL);
        g_string_replace(text, folder, "", 0);
    }
    return g_string_free(text, FALSE);
}

void fl_live_drop_free(FlLiveDrop *drop)
{
    if (!drop)
        return;
    if (drop->folder)
        fl_file_remove(drop->folder, NULL);
    g_free(drop->inputs[0]);
    g_free(drop->folder);
    g_free(drop->files);
    g_free(drop);
}
