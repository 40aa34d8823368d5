#include "io/ffmpeg.h"

#include <gio/gio.h>
#include <glib/gstdio.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

struct FlFfmpeg {
    char *path;
    GSubprocess *child;
    GInputStream *pictures; // owned by the child
    int complaints;         // file descriptor of an unlinked file: the child's standard error
};

/* A name that cannot be taken for an option or a protocol. */
static char *file_url(const char *path)
{
    g_autofree char *absolute = g_canonicalize_filename(path, NULL);
    return g_strconcat("file:", absolute, NULL);
}

static int open_unlinked(void)
{
    g_autofree char *name = NULL;
    const int fd = g_file_open_tmp("fluidy-XXXXXX", &name, NULL);
    if (name)
        g_unlink(name);
    return fd;
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
    *ffmpeg = (FlFfmpeg){.path = g_strdup(path), .complaints = open_unlinked()};
    g_autoptr(GSubprocessLauncher) launcher =
        g_subprocess_launcher_new(G_SUBPROCESS_FLAGS_STDOUT_PIPE);
    if (ffmpeg->complaints >= 0)
        g_subprocess_launcher_take_stderr_fd(launcher, dup(ffmpeg->complaints));
    g_autoptr(GError) below = NULL;
    ffmpeg->child = g_subprocess_launcher_spawnv(launcher, args, &below);
    if (!ffmpeg->child) {
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT,
                    "%s: the program ffmpeg is needed to read it: %s", path, below->message);
        return NULL;
    }
    ffmpeg->pictures = g_subprocess_get_stdout_pipe(ffmpeg->child);
    return g_steal_pointer(&ffmpeg);
}

void fl_ffmpeg_close(FlFfmpeg *ffmpeg)
{
    if (!ffmpeg)
        return;
    if (ffmpeg->child) {
        g_subprocess_force_exit(ffmpeg->child);
        g_subprocess_wait(ffmpeg->child, NULL, NULL);
        g_object_unref(ffmpeg->child);
    }
    if (ffmpeg->complaints >= 0)
        close(ffmpeg->complaints);
    g_free(ffmpeg->path);
    g_free(ffmpeg);
}

/* The last line of what ffmpeg said, which is what it gave up over. */
static void set_complaint(const FlFfmpeg *ffmpeg, GError **error)
{
    char text[4097];
    const ssize_t n =
        ffmpeg->complaints < 0 ? 0 : pread(ffmpeg->complaints, text, sizeof text - 1, 0);
    text[MAX(n, 0)] = '\0';
    g_autofree char *said = g_utf8_make_valid(g_strchomp(text), -1);
    const char *line = strrchr(said, '\n');
    if (strstr(said, "matches no streams")) {
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: has no pictures, only other streams",
                    ffmpeg->path);
        return;
    }
    g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: cannot be read as pictures: %s", ffmpeg->path,
                said[0] ? (line ? line + 1 : said) : "ffmpeg gave no reason");
}

/* One header line of a PAM picture, without its end; false at the end of the stream. */
static bool read_line(GInputStream *stream, char line[64])
{
    for (int i = 0; i < 63; i++) {
        if (g_input_stream_read(stream, line + i, 1, NULL, NULL) != 1)
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
    gsize got = 0;
    if (!read_line(ffmpeg->pictures, line)) {
        if (!g_subprocess_wait_check(ffmpeg->child, NULL, NULL))
            set_complaint(ffmpeg, error);
        return NULL;
    }
    while (read_line(ffmpeg->pictures, line) && strcmp(line, "ENDHDR") != 0) {
        sscanf(line, "WIDTH %9d", &width);
        sscanf(line, "HEIGHT %9d", &height);
    }
    g_autoptr(FlPicture) picture = fl_picture_new(width, height, error);
    if (!picture) {
        g_prefix_error(error, "%s: ", ffmpeg->path);
        return NULL;
    }
    const gsize bytes = (gsize)width * height * 4;
    if (!g_input_stream_read_all(ffmpeg->pictures, picture->rgba, bytes, &got, NULL, NULL) ||
        got < bytes) {
        set_complaint(ffmpeg, error);
        return NULL;
    }
    return g_steal_pointer(&picture);
}

double fl_ffmpeg_rate(const char *path)
{
    g_autofree char *url = file_url(path), *out = NULL;
    g_autoptr(GSubprocess) child = g_subprocess_new(
        G_SUBPROCESS_FLAGS_STDOUT_PIPE | G_SUBPROCESS_FLAGS_STDERR_SILENCE, NULL, "ffprobe", "-v",
        "error", "-protocol_whitelist", "file", "-select_streams", "v:0", "-show_entries",
        "stream=avg_frame_rate", "-of", "default=noprint_wrappers=1:nokey=1", url, NULL);
    int above = 0, below = 0;
    if (!child || !g_subprocess_communicate_utf8(child, NULL, NULL, &out, NULL, NULL) || !out ||
        sscanf(out, "%9d/%9d", &above, &below) != 2 || above <= 0 || below <= 0)
        return 0;
    return (double)above / below;
}
