#include "io/ffmpeg.h"

#include "io/child_process.h"

#include <stdio.h>
#include <string.h>

struct FlFfmpeg {
    char *path;
    FlChild *child;
};

/* A name that ffmpeg cannot mistake for an option or a protocol. */
static char *file_url(const char *path)
{
    g_autofree char *absolute = g_canonicalize_filename(path, NULL);
    return g_strconcat("file:", absolute, NULL);
}

FlFfmpeg *fl_ffmpeg_open(const char *path, int first, int last, int step, GError **error)
{
    g_autofree char *url = file_url(path);
    g_autofree char *end = last ? g_strdup_printf("*lte(n\\,%d)", last - 1) : g_strdup("");
    g_autofree char *select = g_strdup_printf("select=gte(n\\,%d)%s*not(mod(n-%d\\,%d))", first - 1,
                                              end, first - 1, step);
    g_autofree char *count = g_strdup_printf("%d", last ? (last - first) / step + 1 : INT32_MAX);
    const char *const args[] = {
        "ffmpeg",   "-v",   "error",      "-nostdin",    "-protocol_whitelist",
        "file",     "-i",   url,          "-map",        "0:v:0",
        "-vf",      select, "-fps_mode",  "passthrough", "-frames:v",
        count,      "-f",   "image2pipe", "-c:v",        "pam",
        "-pix_fmt", "rgba", "pipe:1",     NULL};
    g_autoptr(FlFfmpeg) ffmpeg = g_new(FlFfmpeg, 1);
    g_autoptr(GError) below = NULL;
    *ffmpeg = (FlFfmpeg){.path = g_strdup(path)};
    ffmpeg->child = fl_child_start_reader(args, path, &below);
    if (!ffmpeg->child) {
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT,
                    "%s: cannot be read without the ffmpeg program: %s", path, below->message);
        return NULL;
    }
    return g_steal_pointer(&ffmpeg);
}

void fl_ffmpeg_close(FlFfmpeg *ffmpeg)
{
    if (!ffmpeg)
        return;
    fl_child_free(ffmpeg->child);
    g_free(ffmpeg->path);
    g_free(ffmpeg);
}

/* The first error, which causes the others, without the parts of ffmpeg that it names as
 * "[mjpeg @ 0x55df] ". Only libraries warn. To be freed. */
static char *cause_of(const char *messages)
{
    const char *end;
    while (g_str_has_prefix(messages, "Warning: ") && (end = strchr(messages, '\n')))
        messages = end + 1;
    while (*messages == '[' && (end = strstr(messages, "] ")))
        messages = end + 2;
    return g_strndup(messages, strcspn(messages, "\n"));
}

/* Waits for the child after its last output. whole: the output ended with a picture. */
static bool end(const FlFfmpeg *ffmpeg, bool whole, GError **error)
{
    g_autoptr(GError) below = NULL;
    const bool well = fl_child_finish(ffmpeg->child, &below);
    if (well && whole)
        return true;
    g_autofree char *words = fl_child_stderr_tail(ffmpeg->child);
    g_autofree char *cause = cause_of(words);
    if (strstr(words, "matches no streams"))
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: has no video stream", ffmpeg->path);
    else
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: cannot be read as pictures: %s",
                    ffmpeg->path,
                    well     ? "the last one is truncated"
                    : *cause ? cause
                             : below->message);
    return false;
}

/* Bytes of a picture; false at the end of the stream, with an error if the child does not go on. */
static bool take(const FlFfmpeg *ffmpeg, void *data, size_t bytes, GError **error)
{
    size_t got;
    if (fl_child_read(ffmpeg->child, data, bytes, &got, error))
        return got == bytes;
    g_prefix_error(error, "%s: ", ffmpeg->path);
    return false;
}

/* One header line of a PAM picture, without its end; false as take(). */
static bool read_line(const FlFfmpeg *ffmpeg, char line[64], GError **error)
{
    for (int i = 0; i < 63; i++) {
        if (!take(ffmpeg, line + i, 1, error))
            return false;
        if (line[i] == '\n') {
            line[i] = '\0';
            return true;
        }
    }
    return false;
}

FlPicture *fl_ffmpeg_read(FlFfmpeg *ffmpeg, GError **error)
{
    char line[64];
    int width = 0, height = 0;
    g_autoptr(GError) below = NULL;
    if (!read_line(ffmpeg, line, &below)) {
        if (below)
            g_propagate_error(error, g_steal_pointer(&below));
        else
            end(ffmpeg, true, error);
        return NULL;
    }
    while (read_line(ffmpeg, line, &below) && strcmp(line, "ENDHDR") != 0) {
        sscanf(line, "WIDTH %9d", &width);
        sscanf(line, "HEIGHT %9d", &height);
    }
    g_autoptr(FlPicture) picture = below ? NULL : fl_picture_new(width, height, error);
    if (!picture && !below) {
        g_prefix_error(error, "%s: ", ffmpeg->path);
        return NULL;
    }
    if (picture && take(ffmpeg, picture->rgba, (size_t)width * height * 4, &below))
        return g_steal_pointer(&picture);
    if (below)
        g_propagate_error(error, g_steal_pointer(&below));
    else
        end(ffmpeg, false, error);
    return NULL;
}

FlPicture *fl_ffmpeg_picture(const char *path, GError **error)
{
    g_autoptr(FlFfmpeg) ffmpeg = fl_ffmpeg_open(path, 1, 1, 1, error);
    g_autoptr(GError) below = NULL;
    FlPicture *picture = ffmpeg ? fl_ffmpeg_read(ffmpeg, &below) : NULL;
    if (below)
        g_propagate_error(error, g_steal_pointer(&below));
    else if (!picture && ffmpeg)
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: contains no picture", path);
    return picture;
}

double fl_ffmpeg_rate(const char *path)
{
    g_autofree char *url = file_url(path);
    const char *const args[] = {"ffprobe",
                                "-v",
                                "error",
                                "-protocol_whitelist",
                                "file",
                                "-select_streams",
                                "v:0",
                                "-show_entries",
                                "stream=avg_frame_rate",
                                "-of",
                                "default=noprint_wrappers=1:nokey=1",
                                url,
                                NULL};
    g_autoptr(FlChild) child = fl_child_start_reader(args, path, NULL);
    char out[64] = "";
    size_t got;
    int above = 0, below = 0;
    if (!child || !fl_child_read(child, out, sizeof out - 1, &got, NULL) ||
        sscanf(out, "%9d/%9d", &above, &below) != 2 || above <= 0 || below <= 0)
        return 0;
    return (double)above / below;
}
