#include "io/ffmpeg.h"

#include "base/error.h"
#include "base/file.h"
#include "io/child_process.h"

#include <errno.h>
#include <glib/gstdio.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

struct FlFfmpeg {
    char *path;
    const char *kind; // of what is read: "pictures" or "sound"
    FlChild *child;
};

/* Arguments, with a name between the words that ffmpeg cannot mistake for an option or a protocol.
 */
static GPtrArray *arguments_for(const char *before, const char *path, const char *after)
{
    g_autofree char *absolute = g_canonicalize_filename(path, NULL);
    GPtrArray *arguments = g_ptr_array_new_with_free_func(g_free);
    fl_arguments_add(arguments, before);
    g_ptr_array_add(arguments, g_strconcat("file:", absolute, NULL));
    fl_arguments_add(arguments, after);
    g_ptr_array_add(arguments, NULL);
    return arguments;
}

#define FFMPEG "ffmpeg -v error -nostdin -protocol_whitelist file "

static FlFfmpeg *start(const char *path, const char *kind, const char *before, const char *after,
                       GError **error)
{
    g_autoptr(FlFfmpeg) ffmpeg = g_new(FlFfmpeg, 1);
    g_autoptr(GPtrArray) arguments = arguments_for(before, path, after);
    g_autoptr(GError) below = NULL;
    *ffmpeg = (FlFfmpeg){.path = g_strdup(path), .kind = kind};
    if (!fl_file_check(path, FL_ERROR_INPUT, error))
        return NULL;
    ffmpeg->child = fl_child_start_reader((const char *const *)arguments->pdata, path, &below);
    if (!ffmpeg->child)
        return fl_none(error, FL_ERROR_INPUT, "%s: cannot be read without the ffmpeg program: %s",
                       path, below->message);
    return g_steal_pointer(&ffmpeg);
}

FlFfmpeg *fl_ffmpeg_open(const char *path, int first, int last, int step, GError **error)
{
    g_autofree char *end = last ? g_strdup_printf("*lte(n\\,%d)", last - 1) : g_strdup("");
    g_autofree char *after = g_strdup_printf(
        "-map 0:v:0 -vf select=gte(n\\,%d)%s*not(mod(n-%d\\,%d)) -fps_mode passthrough -frames:v "
        "%d "
        "-f image2pipe -c:v pam -pix_fmt rgba pipe:1",
        first - 1, end, first - 1, step, last ? (last - first) / step + 1 : INT32_MAX);
    return start(path, "pictures", FFMPEG "-i", after, error);
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
        fl_fail(error, FL_ERROR_INPUT, "%s: has no %s", ffmpeg->path, ffmpeg->kind);
    else
        fl_fail(error, FL_ERROR_INPUT, "%s: cannot be read as %s: %s", ffmpeg->path, ffmpeg->kind,
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
        fl_fail(error, FL_ERROR_INPUT, "%s: contains no picture", path);
    return picture;
}

/* Copies what the child writes, at most so many bytes. Returns: how many; -1 with an error. */
static int64_t copy_sound(const FlFfmpeg *ffmpeg, int fd, int64_t most, GError **error)
{
    static const size_t block_bytes = 1 << 16;
    g_autofree uint8_t *block = g_malloc(block_bytes);
    int64_t all = 0;
    size_t got = block_bytes;
    while (got == block_bytes && all < most) {
        if (!fl_child_read(ffmpeg->child, block, block_bytes, &got, error)) {
            g_prefix_error(error, "%s: ", ffmpeg->path);
            return -1;
        }
        const size_t wanted = (size_t)MIN((int64_t)got, most - all);
        if (!fl_write_all(fd, block, wanted)) {
            fl_fail(error, FL_ERROR_OUTPUT, "sound cannot be kept: %s", g_strerror(errno));
            return -1;
        }
        all += (int64_t)wanted;
    }
    return all;
}

/* A temporary file that is gone when it is closed; -1 with FL_ERROR_OUTPUT. */
static int open_temporary(GError **error)
{
    g_autofree char *name = NULL;
    const int fd = g_file_open_tmp("fluidy-XXXXXX", &name, NULL);
    if (fd >= 0)
        g_unlink(name);
    else
        fl_fail(error, FL_ERROR_OUTPUT, "%s: cannot be written to", g_get_tmp_dir());
    return fd;
}

static FlFfmpeg *start_sound(const char *path, double from_s, double seconds, GError **error)
{
    char from[G_ASCII_DTOSTR_BUF_SIZE], length[G_ASCII_DTOSTR_BUF_SIZE];
    g_ascii_formatd(from, sizeof from, "%.6f", from_s);
    g_ascii_formatd(length, sizeof length, "%.6f", seconds);
    g_autofree char *before = g_strdup_printf(FFMPEG "-ss %s -i", from);
    g_autofree char *after = g_strdup_printf("-map 0:a:0 -t %s -ac %d -ar %d -f s16le pipe:1",
                                             length, FL_SOUND_CHANNELS, FL_SOUND_RATE);
    return start(path, "sound", before, after, error);
}

int fl_ffmpeg_sound(const char *path, double from_s, double seconds, GError **error)
{
    const int64_t most = (int64_t)(seconds * FL_SOUND_RATE + .5) * FL_SOUND_CHANNELS * 2;
    g_autoptr(FlFfmpeg) ffmpeg = start_sound(path, from_s, seconds, error);
    const int fd = ffmpeg ? open_temporary(error) : -1;
    const int64_t bytes = fd >= 0 ? copy_sound(ffmpeg, fd, most, error) : -1;
    if (bytes > 0)
        return fd;
    if (bytes == 0 && end(ffmpeg, true, error))
        fl_fail(error, FL_ERROR_INPUT, "%s: has no sound %g seconds from its beginning", path,
                from_s);
    if (fd >= 0)
        close(fd);
    return -1;
}

double fl_ffmpeg_rate(const char *path)
{
    g_autoptr(GPtrArray) arguments =
        arguments_for("ffprobe -v error -protocol_whitelist file -select_streams v:0 -show_entries "
                      "stream=avg_frame_rate -of default=noprint_wrappers=1:nokey=1",
                      path, "");
    g_autoptr(FlChild) child =
        fl_child_start_reader((const char *const *)arguments->pdata, path, NULL);
    char out[64] = "";
    size_t got;
    int above = 0, below = 0;
    if (!child || !fl_child_read(child, out, sizeof out - 1, &got, NULL) ||
        sscanf(out, "%9d/%9d", &above, &below) != 2 || above <= 0 || below <= 0)
        return 0;
    return (double)above / below;
}
