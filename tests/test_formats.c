#include "base/density.h"
#include "base/rng.h"
#include "config.h"
#include "io/ffmpeg.h"
#include "io/pattern.h"
#include "io/png.h"
#include "io/provenance.h"
#include "io/sink.h"
#include "scratch.h"

#include <fluidy/fluidy.h>
#include <gio/gio.h>
#include <math.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#if HAVE_EXR
#include "io/cryptomatte.h"
#include <OpenEXR/openexr.h>
#endif
#if HAVE_ORA
#include <zip.h>
#endif

enum { W = 34, H = 26, FRAMES = 5 };

static int count_files(const Scratch *scratch)
{
    g_autoptr(GDir) dir = g_dir_open(scratch, 0, NULL);
    int n = 0;
    while (g_dir_read_name(dir))
        n++;
    return n;
}

/** Smooth colour that moves, with alpha falling from left to right. */
static void fill(uint8_t *rgba, int frame)
{
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const uint8_t pixel[4] = {(uint8_t)(60 + 4 * x), (uint8_t)(200 - 5 * y),
                                      (uint8_t)(90 + 20 * frame), (uint8_t)(255 - 7 * x)};
            memcpy(rgba + 4 * (y * W + x), pixel, 4);
        }
}

/** Writes a film; returns whether it went well. */
static bool write_film(const char *path, bool opaque, GError **error)
{
    const FlSinkFormat *format = fl_sink_format(NULL, path, error);
    const FlSinkParams params = {
        .path = path, .width = W, .height = H, .fps = 12, .opaque = opaque};
    g_autoptr(FlSink) sink = format ? fl_sink_open(format, &params, error) : NULL;
    uint8_t rgba[4 * W * H];
    for (int k = 0; sink && k < FRAMES; k++) {
        fill(rgba, k);
        for (int i = 0; opaque && i < W * H; i++)
            rgba[4 * i + 3] = 255;
        const FlSinkFrame frame = {.number = k + 1, .rgba = rgba};
        if (!fl_sink_frame(sink, &frame, error))
            return false;
    }
    return sink && fl_sink_finish(sink, error);
}

/** Every byte of a file that is changed, and every length, is seen by its mark. */
static void check_mark(const char *path, FlDigest made_from, int step)
{
    g_autofree char *data = NULL;
    gsize bytes;
    FlDigest found = {0};
    g_assert_true(fl_mark_is(path, made_from));
    g_assert_true(g_file_get_contents(path, &data, &bytes, NULL));
    for (gsize k = 0; k < bytes; k += (gsize)step) {
        data[k] ^= 16;
        scratch_put(path, data, bytes);
        data[k] ^= 16;
        const FlMark mark = fl_mark_read(path, &found);
        if (mark == FL_MARK_WHOLE && fl_digest_is_same(found, made_from))
            g_error("%s: byte %zu of %zu was changed unseen", path, k, bytes);
        scratch_put(path, data, k);
        g_assert_false(fl_mark_is(path, made_from));
    }
}

/** What ffprobe says of the first stream: "key=value" lines; to be freed. */
static char *probe(const char *path)
{
    g_autoptr(GError) error = NULL;
    const char *const words[] = {
        "ffprobe",
        "-v",
        "error",
        "-count_frames",
        "-select_streams",
        "v:0",
        "-show_entries",
        "stream=codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames,color_space,"
        "color_primaries,color_transfer:stream_tags=alpha_mode",
        "-of",
        "default=noprint_wrappers=1",
        path,
        NULL};
    char *said = NULL;
    int status = 0;
    g_assert_true(g_spawn_sync(NULL, (char **)words, NULL, G_SPAWN_SEARCH_PATH, NULL, NULL, &said,
                               NULL, &status, &error));
    g_assert_no_error(error);
    return said;
}

static void assert_said(const char *said, const char *line)
{
    g_auto(GStrv) lines = g_strsplit(said, "\n", -1);
    if (!g_strv_contains((const char *const *)lines, line))
        g_error("expected %s in:\n%s", line, said);
}

static bool lacks(const char *program)
{
    g_autofree char *found = g_find_program_in_path(program);
    if (!found)
        g_test_skip("ffmpeg is not installed");
    return !found;
}

/** The last frame of a film as raw RGBA. */
static void decode_last(const char *path, uint8_t *rgba)
{
    g_autofree char *filter = g_strdup_printf("select=eq(n\\,%d)", FRAMES - 1);
    const char *const words[] = {"ffmpeg",   "-v",       "error",  "-i", path,
                                 "-vf",      filter,     "-vsync", "0",  "-f",
                                 "rawvideo", "-pix_fmt", "rgba",   "-",  NULL};
    g_autoptr(GError) error = NULL;
    g_autoptr(GSubprocess) child = g_subprocess_newv(words, G_SUBPROCESS_FLAGS_STDOUT_PIPE, &error);
    g_autoptr(GBytes) out = NULL;
    g_assert_true(g_subprocess_communicate(child, NULL, NULL, &out, NULL, &error));
    g_assert_cmpint(g_bytes_get_size(out), ==, 4 * W * H);
    memcpy(rgba, g_bytes_get_data(out, NULL), 4 * W * H);
}

/** A lossless film keeps every bit of its last frame, ProRes nearly. */
static void check_last(const char *path, int tolerance)
{
    uint8_t expected[4 * W * H], got[4 * W * H];
    fill(expected, FRAMES - 1);
    decode_last(path, got);
    for (int k = 0; k < 4 * W * H; k++)
        g_assert_cmpint(abs(got[k] - expected[k]), <=, tolerance);
}

static void a_film_reads_back_with_size_rate_colours_and_tags(void)
{
    const struct {
        const char *name, *codec, *pixels;
        bool opaque, bt709;
        int tolerance; // of the colours that are read back; 255: they are not looked at
    } films[] = {
        {"a.mov", "codec_name=prores", "pix_fmt=yuva444p12le", false, true, 6},
        {"b.mov", "codec_name=prores", "pix_fmt=yuv444p12le", true, true, 255},
        {"a.webm", "codec_name=vp9", "TAG:alpha_mode=1", false, true, 255},
        {"a.mkv", "codec_name=ffv1", "pix_fmt=bgra", false, false, 0},
        {"a.mp4", "codec_name=h264", "pix_fmt=yuv420p", true, true, 255},
        {"a.gif", "codec_name=gif", "pix_fmt=bgra", false, false, 255},
        {"a.apng", "codec_name=apng", "pix_fmt=rgba", false, false, 0},
    };
    if (lacks("ffmpeg") || lacks("ffprobe"))
        return;
    g_autoptr(Scratch) scratch = scratch_make();
    for (size_t i = 0; i < G_N_ELEMENTS(films); i++) {
        g_autoptr(GError) error = NULL;
        g_autofree char *path = g_build_filename(scratch, films[i].name, NULL);
        write_film(path, films[i].opaque, &error);
        g_assert_no_error(error);
        g_autofree char *said = probe(path);
        assert_said(said, films[i].codec);
        assert_said(said, films[i].pixels);
        assert_said(said, "width=34");
        assert_said(said, "height=26");
        assert_said(said, "nb_read_frames=5");
        if (!g_str_has_suffix(path, "gif")) // whose clock counts in 1/100 s
            assert_said(said, "r_frame_rate=12/1");
        if (films[i].bt709) {
            assert_said(said, "color_space=bt709");
            assert_said(said, "color_transfer=bt709");
            assert_said(said, "color_primaries=bt709");
        }
        if (films[i].tolerance < 255)
            check_last(path, films[i].tolerance);
        g_assert_cmpint(count_files(scratch), ==, (int)i + 1);
    }
}

static void transparent_frames_are_not_for_h264(void)
{
    if (lacks("ffmpeg"))
        return;
    g_autoptr(GError) error = NULL;
    g_autoptr(Scratch) scratch = scratch_make();
    g_autofree char *path = g_build_filename(scratch, "a.mp4", NULL);
    g_assert_false(write_film(path, false, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_USAGE);
    g_assert_cmpint(count_files(scratch), ==, 0);
}

static void an_unfinished_film_leaves_nothing(void)
{
    if (lacks("ffmpeg"))
        return;
    g_autoptr(GError) error = NULL;
    g_autoptr(Scratch) scratch = scratch_make();
    g_autofree char *path = g_build_filename(scratch, "a.mkv", NULL);
    const FlSinkParams params = {.path = path, .width = W, .height = H, .fps = 25};
    FlSink *sink = fl_sink_open(fl_sink_format(NULL, path, NULL), &params, &error);
    g_assert_no_error(error);
    uint8_t rgba[4 * W * H];
    fill(rgba, 0);
    g_assert_true(fl_sink_frame(sink, &(FlSinkFrame){.number = 1, .rgba = rgba}, &error));
    fl_sink_free(sink);
    g_assert_cmpint(count_files(scratch), ==, 0);
}

/** Puts a program called ffmpeg first into $PATH; NULL: none at all. Returns the old $PATH. */
static char *pretend_ffmpeg(const Scratch *scratch, const char *script)
{
    char *before = g_strdup(g_getenv("PATH"));
    g_autofree char *program = g_build_filename(scratch, "ffmpeg", NULL);
    g_autofree char *path = g_strconcat(scratch, ":", script ? before : "", NULL);
    if (script) {
        g_assert_true(g_file_set_contents(program, script, -1, NULL));
        g_chmod(program, 0755);
    }
    g_setenv("PATH", path, TRUE);
    return before;
}

static void the_death_of_ffmpeg_is_told_in_its_own_words(void)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(Scratch) scratch = scratch_make();
    g_autoptr(Scratch) bin = scratch_make();
    g_autofree char *before =
        pretend_ffmpeg(bin, "#!/bin/sh\necho first >&2\necho no such encoder >&2\nexit 1\n");
    g_autofree char *path = g_build_filename(scratch, "a.mkv", NULL);
    g_assert_false(write_film(path, false, &error));
    g_setenv("PATH", before, TRUE);
    g_assert_error(error, FL_ERROR, FL_ERROR_OUTPUT);
    g_assert_true(g_str_has_prefix(error->message, path));
    g_assert_true(g_str_has_suffix(error->message, "ffmpeg stopped: no such encoder"));
    g_assert_cmpint(count_files(scratch), ==, 0);
}

static void a_missing_ffmpeg_is_one_plain_message(void)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(Scratch) scratch = scratch_make();
    g_autofree char *before = pretend_ffmpeg(scratch, NULL);
    g_autofree char *path = g_build_filename(scratch, "a.mov", NULL);
    g_assert_false(write_film(path, false, &error));
    g_setenv("PATH", before, TRUE);
    g_assert_error(error, FL_ERROR, FL_ERROR_OUTPUT);
    g_assert_nonnull(strstr(error->message, "not installed"));
    g_assert_cmpint(count_files(scratch), ==, 0);
}

static void an_existing_film_is_kept(void)
{
    if (lacks("ffmpeg"))
        return;
    g_autoptr(GError) error = NULL;
    g_autoptr(Scratch) scratch = scratch_make();
    g_autofree char *path = g_build_filename(scratch, "a.mov", NULL), *now = NULL;
    g_file_set_contents(path, "precious", -1, NULL);
    g_assert_false(write_film(path, false, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_EXISTS);
    g_file_get_contents(path, &now, NULL, NULL);
    g_assert_cmpstr(now, ==, "precious");
}

/** Noise, which no format makes small; returns whether all went well. */
static bool write_noise(const char *path, const FlSinkFormat *format, GError **error)
{
    enum { SIDE = 32 };
    static uint8_t rgba[4 * SIDE * SIDE];
    static uint16_t rgba16[4 * SIDE * SIDE];
    FlRng rng = {1};
    for (int i = 0; i < 4 * SIDE * SIDE; i++)
        rgba[i] = i % 4 == 3 ? 255 : (uint8_t)fl_rng_u32(&rng),
        rgba16[i] = (uint16_t)(rgba[i] * 257);
    const FlDigest made_from = {7, 9};
    const FlSinkParams params = {.path = path,
                                 .made_from = made_from,
                                 .width = SIDE,
                                 .height = SIDE,
                                 .fps = 25,
                                 .opaque = true};
    const FlSinkLayer layer = {"all", "all", 0, 0, SIDE, SIDE, rgba};
    g_autoptr(FlSink) sink = fl_sink_open(format, &params, error);
    for (int k = 0; sink && k < 8; k++) {
        const FlSinkFrame frame = {
            .number = k, .rgba = rgba, .rgba16 = rgba16, .layers = &layer, .n_layers = 1};
        if (!fl_sink_frame(sink, &frame, error))
            return false;
    }
    return sink && fl_sink_finish(sink, error);
}

static bool has_mark(const FlSinkFormat *format)
{
    return strcmp(format->name, "null") != 0 && strcmp(format->name, "hash") != 0;
}

static void files_of_all_formats_know_when_they_were_changed(void)
{
    enum { STEP = 251 };
    if (lacks("ffmpeg"))
        return;
    for (const FlSinkFormat *const *format = fl_sink_formats(); *format; format++) {
        g_autoptr(GError) error = NULL;
        g_autoptr(Scratch) scratch = scratch_make();
        g_autofree char *name = g_strdup_printf("a%s%s", (*format)->film ? "" : "_%02d",
                                                (*format)->suffix ? (*format)->suffix : "");
        g_autofree char *pattern = g_build_filename(scratch, name, NULL);
        g_autofree char *path = fl_output_name(pattern, 3, NULL, NULL);
        if (!has_mark(*format))
            continue;
        g_test_message("%s", (*format)->name);
        g_assert_true(write_noise(pattern, *format, &error));
        const FlDigest of_film = {7, 9};
        if ((*format)->film)
            check_mark(pattern, of_film, STEP);
        else
            check_mark(path, fl_mark_of_frame(of_film, 3), STEP);
    }
}

static void a_full_disk_is_an_error_and_leaves_no_litter(void)
{
    struct rlimit before;
    getrlimit(RLIMIT_FSIZE, &before);
    for (const FlSinkFormat *const *format = fl_sink_formats(); *format; format++) {
        g_autoptr(GError) error = NULL;
        g_autoptr(Scratch) scratch = scratch_make();
        g_autofree char *name = g_strdup_printf("a%s%s", (*format)->film ? "" : "_%02d",
                                                (*format)->suffix ? (*format)->suffix : "");
        g_autofree char *path = g_build_filename(scratch, name, NULL);
        if (strcmp((*format)->name, "null") == 0)
            continue;
        g_test_message("%s", (*format)->name);
        /* A file that grows beyond the limit fails as on a full disk, for our children as well. */
        signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &(struct rlimit){300, before.rlim_max});
        const bool written = write_noise(path, *format, &error);
        setrlimit(RLIMIT_FSIZE, &before);
        g_assert_false(written);
        g_assert_error(error, FL_ERROR, FL_ERROR_OUTPUT);
        g_assert_true(g_str_has_prefix(error->message, scratch));
        g_assert_cmpint(count_files(scratch), ==, 0);
    }
}

static void sums_are_a_line_per_frame(void)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(Scratch) scratch = scratch_make();
    g_autofree char *path = g_build_filename(scratch, "a.sha256", NULL), *text = NULL;
    write_film(path, false, &error);
    g_assert_no_error(error);
    g_assert_true(g_file_get_contents(path, &text, NULL, NULL));
    g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
    g_assert_cmpint(g_strv_length(lines), ==, FRAMES + 1);
    g_assert_true(g_str_has_suffix(lines[2], "  3"));
    g_assert_cmpint(strlen(lines[0]), ==, 64 + 3);
}

enum { RATE = FL_SOUND_RATE }; // samples a second

/** A WAV file of one second without sound and one of a square wave, in one channel. */
static char *write_sound(const Scratch *scratch)
{
    const uint32_t bytes = 2 * 2 * RATE, all = 36 + bytes, kind = 16, rate = RATE, flow = 2 * RATE;
    const uint16_t words[] = {1, 1, 2, 16}; // PCM, channels, bytes a sample, bits
    g_autoptr(GByteArray) wav = g_byte_array_new();
    char *path = g_build_filename(scratch, "sound.wav", NULL);
    g_byte_array_append(wav, (const guint8 *)"RIFF", 4);
    g_byte_array_append(wav, (const guint8 *)&all, 4);
    g_byte_array_append(wav, (const guint8 *)"WAVEfmt ", 8);
    g_byte_array_append(wav, (const guint8 *)&kind, 4);
    g_byte_array_append(wav, (const guint8 *)words, 4);
    g_byte_array_append(wav, (const guint8 *)&rate, 4);
    g_byte_array_append(wav, (const guint8 *)&flow, 4);
    g_byte_array_append(wav, (const guint8 *)(words + 2), 4);
    g_byte_array_append(wav, (const guint8 *)"data", 4);
    g_byte_array_append(wav, (const guint8 *)&bytes, 4);
    for (int k = 0; k < 2 * RATE; k++) {
        const int16_t sample = k < RATE ? 0 : k / 50 % 2 ? 8000 : -8000;
        g_byte_array_append(wav, (const guint8 *)&sample, 2);
    }
    scratch_put(path, (const char *)wav->data, wav->len);
    return path;
}

/** The mean loudness of a part of the sound of a file, in one channel; *n: samples there are. */
static double loudness(const char *path, double from_s, double seconds, int *n)
{
    g_autoptr(GError) error = NULL;
    const int fd = fl_ffmpeg_sound(path, from_s, seconds, &error);
    int16_t sample[2];
    double sum = 0;
    g_assert_no_error(error);
    for (*n = 0; pread(fd, sample, sizeof sample, (off_t)*n * (off_t)sizeof sample) > 0; ++*n)
        sum += abs(sample[0]);
    close(fd);
    return sum / MAX(*n, 1);
}

/** The film begins half a second before the sound is heard, and lasts one. */
static void a_film_has_the_sound_that_it_is_given(void)
{
    if (lacks("ffmpeg"))
        return;
    g_autoptr(Scratch) scratch = scratch_make();
    g_autofree char *sound = write_sound(scratch), *path = g_build_filename(scratch, "a.mkv", NULL);
    g_autofree char *gif = g_build_filename(scratch, "a.gif", NULL);
    g_autofree char *text = scratch_write(scratch, "text.wav", "no sound");
    g_autoptr(GError) error = NULL;
    FlSinkParams params = {.path = path,
                           .width = W,
                           .height = H,
                           .fps = FRAMES,
                           .opaque = true,
                           .audio = sound,
                           .audio_from = .5,
                           .seconds = 1};
    g_autoptr(FlSink) sink = fl_sink_open(&fl_sink_mkv, &params, &error);
    uint8_t rgba[4 * W * H];
    int n;
    g_assert_no_error(error);
    for (int f = 0; f < FRAMES; f++) {
        fill(rgba, f);
        fl_sink_frame(sink, &(FlSinkFrame){.number = f, .rgba = rgba}, &error);
        g_assert_no_error(error);
    }
    g_assert_true(fl_sink_finish(sink, &error));
    g_assert_cmpfloat(loudness(path, 0, .5, &n), <, 1);
    g_assert_cmpint(n, ==, RATE / 2);
    g_assert_cmpfloat(loudness(path, .5, 9, &n), >, 4000); // one channel is less in each of two
    g_assert_cmpint(n, ==, RATE / 2);
    params.path = gif;
    g_assert_null(fl_sink_open(&fl_sink_gif, &params, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_USAGE);
    g_clear_error(&error);
    params.audio = text, params.path = path, params.overwrite = true;
    g_assert_null(fl_sink_open(&fl_sink_mkv, &params, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, text));
    g_clear_error(&error);
    g_assert_cmpint(remove(text), ==, 0);
    g_assert_cmpint(mkfifo(text, 0600), ==, 0); // nobody writes to it
    g_assert_null(fl_sink_open(&fl_sink_mkv, &params, &error));
    g_assert_nonnull(strstr(error->message, "a pipe"));
}

#if HAVE_EXR || HAVE_ORA

#define HAIR "CryptoRegion9" // a layer that is no matte

static uint8_t small[4 * 4 * 4], whole[4 * W * H];

/** Writes frame 7 of two layers; returns its file. */
static char *write_layered(const Scratch *scratch, const char *name)
{
    g_autoptr(GError) error = NULL;
    g_autofree char *pattern = g_build_filename(scratch, name, NULL);
    const FlSinkParams params = {.path = pattern, .width = W, .height = H};
    g_autoptr(FlSink) sink = fl_sink_open(fl_sink_format(NULL, pattern, &error), &params, &error);
    g_assert_no_error(error);
    fill(whole, 1);
    for (int i = 0; i < 16; i++)
        memcpy(small + 4 * i, (uint8_t[]){255, 128, 0, 51}, 4);
    g_autoptr(GRand) random = g_rand_new_with_seed(1); // rows that do not compress
    for (int i = 0; i < 16 * 4 * W; i++)
        whole[i] = (uint8_t)g_rand_int(random);
    const FlSinkLayer layers[2] = {{"back-ground", "sky", 0, 0, W, H, whole},
                                   {HAIR, "hair", 5, 20, 4, 4, small}};
    const FlSinkFrame frame = {
        .number = 7, .rgba = whole, .layers = layers, .n_layers = 2, .thickness = true};
    fl_sink_frame(sink, &frame, &error);
    g_assert_no_error(error);
    g_assert_true(fl_sink_finish(sink, &error));
    return fl_sink_file(&params, 7, NULL);
}

#endif

#if HAVE_EXR

static float float_of(uint16_t half)
{
    const int exponent = half >> 10, fraction = half & 1023;
    return exponent ? ldexpf((float)(1024 + fraction), exponent - 25)
                    : ldexpf((float)fraction, -24);
}

enum { MOST_CHANNELS = 40 };

static uint16_t planes[MOST_CHANNELS][H][W]; // of the channels of a file
static float mattes[MOST_CHANNELS][H][W];
static char names[MOST_CHANNELS][32];

/** Reads the rows from y on of all channels. */
static void read_chunk(exr_context_t context, int y)
{
    exr_chunk_info_t info;
    exr_decode_pipeline_t pipe = {0};
    g_assert_cmpint(exr_read_scanline_chunk_info(context, 0, y, &info), ==, EXR_ERR_SUCCESS);
    g_assert_cmpint(exr_decoding_initialize(context, 0, &info, &pipe), ==, EXR_ERR_SUCCESS);
    g_assert_cmpint(pipe.channel_count, <, MOST_CHANNELS);
    for (int c = 0; c < pipe.channel_count; c++) {
        g_strlcpy(names[c], pipe.channels[c].channel_name, sizeof names[c]);
        const bool matte = pipe.channels[c].data_type == EXR_PIXEL_FLOAT;
        pipe.channels[c].decode_to_ptr = matte ? (uint8_t *)mattes[c][y] : (uint8_t *)planes[c][y];
        pipe.channels[c].user_bytes_per_element = matte ? 4 : 2;
        pipe.channels[c].user_data_type = matte ? EXR_PIXEL_FLOAT : EXR_PIXEL_HALF;
        pipe.channels[c].user_pixel_stride = matte ? 4 : 2;
        pipe.channels[c].user_line_stride = (matte ? 4 : 2) * W;
    }
    g_assert_cmpint(exr_decoding_choose_default_routines(context, 0, &pipe), ==, EXR_ERR_SUCCESS);
    g_assert_cmpint(exr_decoding_run(context, 0, &pipe), ==, EXR_ERR_SUCCESS);
    exr_decoding_destroy(context, &pipe);
}

/** Compares a channel with the pixels of its layer at x, y in the frame. */
static void expect_layer(const char *name, int component, const uint8_t *rgba, FlRect at)
{
    int c = 0;
    while (strcmp(names[c], name) != 0)
        c++;
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const bool inside =
                x >= at.x && x < at.x + at.width && y >= at.y && y < at.y + at.height;
            const uint8_t *pixel = inside ? rgba + 4 * ((y - at.y) * at.width + x - at.x) : NULL;
            const double level = !pixel          ? 0
                                 : component < 3 ? fl_srgb_to_linear(pixel[component]) / 65535.0
                                                 : 1;
            const double expected = pixel ? level * pixel[3] / 255 : 0;
            g_assert_cmpfloat_with_epsilon(float_of(planes[c][y][x]), expected,
                                           expected / 2048 + 1e-7);
        }
}

static float matte_at(const char *name, int x, int y)
{
    int c = 0;
    while (strcmp(names[c], name) != 0)
        c++;
    return mattes[c][y][x];
}

/** The share of a region in a pixel, as Cryptomatte has it in two of six ranks. */
static float share_of(const char *region, int x, int y)
{
    const union {
        guint32 u;
        float f;
    } id = {fl_matte_id(region)};
    return (matte_at(FL_MATTES "00.R", x, y) == id.f ? matte_at(FL_MATTES "00.G", x, y) : 0) +
           (matte_at(FL_MATTES "00.B", x, y) == id.f ? matte_at(FL_MATTES "00.A", x, y) : 0);
}

static void expect_mattes(void)
{
    g_assert_cmphex(fl_matte_id("hello"), ==, 0x248bfa47); // of the reference implementation
    g_assert_cmphex(fl_matte_id("hello, world"), ==, 0x149bbb7f);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const bool inside = x >= 5 && x < 9 && y >= 20 && y < 24;
            const float hair = inside ? 0.2f : 0, back = (float)whole[4 * (y * W + x) + 3] / 255;
            g_assert_cmpfloat_with_epsilon(share_of("hair", x, y), hair, 1e-6);
            g_assert_cmpfloat_with_epsilon(share_of("sky", x, y), back * (1 - hair), 1e-6);
            g_assert_cmpfloat(matte_at(FL_MATTES "00.G", x, y), >=,
                              matte_at(FL_MATTES "00.A", x, y));
        }
}

/** Reads all channels of a file of W * H pixels. */
static void read_exr(const char *path)
{
    exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t context;
    int32_t rows;
    g_assert_cmpint(exr_start_read(&context, path, &how), ==, EXR_ERR_SUCCESS);
    exr_attr_chromaticities_t primaries = {0};
    exr_attr_get_chromaticities(context, 0, "chromaticities", &primaries);
    g_assert_cmpfloat_with_epsilon(primaries.red_x, .64f, 1e-6);
    g_assert_cmpfloat_with_epsilon(primaries.white_y, .329f, 1e-6);
    exr_get_scanlines_per_chunk(context, 0, &rows);
    for (int y = 0; y < H; y += rows)
        read_chunk(context, y);
    exr_finish(&context);
}

/** The mean optical density of the channels of a pixel, times its alpha. */
static double density_of(const uint8_t *rgba)
{
    double sum = 0;
    for (int c = 0; c < 3; c++) // that of black is finite
        sum += log10(65535.0 / MAX(fl_srgb_to_linear(rgba[c]), 20));
    return sum / 3 * rgba[3] / 255;
}

static void expect_thickness(void)
{
    const double below = density_of(whole + 4 * (21 * W + 6)), above = density_of(small);
    g_assert_cmpfloat_with_epsilon(matte_at("paint.thickness", 2, 2),
                                   density_of(whole + 4 * (2 * W + 2)), 1e-4);
    g_assert_cmpfloat_with_epsilon(matte_at("paint.thickness", 6, 21), below + above, 1e-4);
}

static void an_exr_holds_linear_premultiplied_layers(void)
{
    g_autoptr(Scratch) scratch = scratch_make();
    g_autofree char *path = write_layered(scratch, "a_%02d.exr");
    read_exr(path);
    expect_layer("G", 1, whole, (FlRect){0, 0, W, H});
    expect_layer("A", 3, whole, (FlRect){0, 0, W, H});
    expect_layer(HAIR ".R", 0, small, (FlRect){5, 20, 4, 4});
    expect_layer(HAIR ".G", 1, small, (FlRect){5, 20, 4, 4});
    expect_layer(HAIR ".A", 3, small, (FlRect){5, 20, 4, 4});
    expect_layer("back-ground.B", 2, whole, (FlRect){0, 0, W, H});
    expect_mattes();
    expect_thickness();
}

/** A square that moves by 3, -2 px into its second frame, over one that stays. */
static void an_exr_says_where_pixels_come_from_and_how_thick_paint_is(void)
{
    g_autoptr(Scratch) scratch = scratch_make();
    g_autofree char *input = g_build_filename(scratch, "d_%d.svg", NULL);
    g_autofree char *output = g_build_filename(scratch, "o_%d.exr", NULL);
    g_autofree char *second = g_build_filename(scratch, "o_2.exr", NULL);
    g_autofree char *style = g_test_build_filename(G_TEST_DIST, "style-small", NULL);
    const FlSetting settings[] = {{.name = "style", .value = style}};
    const char *const inputs[] = {input, NULL};
    const FlRenderOptions options = {.size = sizeof options,
                                     .inputs = inputs,
                                     .output = output,
                                     .background = "#ffffff",
                                     .paper = "none",
                                     .settings = settings,
                                     .n_settings = 1,
                                     .vectors = true,
                                     .thickness = true};
    g_autoptr(GError) error = NULL;
    for (int k = 0; k < 2; k++) {
        g_autofree char *name = g_strdup_printf("d_%d.svg", k + 1);
        g_autofree char *svg =
            g_strdup_printf("<svg xmlns='http://www.w3.org/2000/svg' width='%d' height='%d'>"
                            "<g id='low'><path d='M16 6h16v18h-16z' fill='#d04030'/></g>"
                            "<g id='up'><path d='M%d %dh14v14h-14z' fill='#224466'/></g></svg>",
                            W, H, 4 + 3 * k, 8 - 2 * k);
        g_free(scratch_write(scratch, name, svg));
    }
    fl_render(&options, &error);
    g_assert_no_error(error);
    read_exr(second);
    g_assert_cmpfloat_with_epsilon(matte_at("backward.u", 12, 12), -3, 1e-3);
    g_assert_cmpfloat_with_epsilon(matte_at("backward.v", 12, 12), -2, 1e-3); // upwards
    g_assert_cmpfloat_with_epsilon(matte_at("backward.u", 18, 12), -3, 1e-3); // the upper one
    g_assert_cmpfloat(matte_at("backward.u", 26, 12), ==, 0);
    g_assert_cmpfloat(matte_at("backward.v", 2, 22), ==, 0);
    g_assert_cmpfloat(matte_at("paint.thickness", 2, 22), ==, 0);
    g_assert_cmpfloat(matte_at("paint.thickness", 12, 12), >, .3f);
    const FlSetting drafts[] = {settings[0], {.name = "detail", .value = "draft"}};
    FlRenderOptions draft = options;
    draft.settings = drafts, draft.n_settings = 2, draft.overwrite = FL_OVERWRITE_YES;
    fl_render(&draft, &error);
    g_assert_no_error(error);
    read_exr(second);
    g_assert_cmpfloat_with_epsilon(matte_at("backward.u", 12, 12), -3, .1);
    g_assert_cmpfloat_with_epsilon(matte_at("backward.v", 12, 12), -2, .1);
    g_autofree char *pictures = g_build_filename(scratch, "o_%d.png", NULL);
    FlRenderOptions wrong = options;
    wrong.output = pictures;
    g_assert_false(fl_render(&wrong, &error));
    g_assert_error(error, FL_ERROR, FL_ERROR_USAGE);
}

#endif

#if HAVE_ORA

static char *read_part(zip_t *zip, const char *name, size_t *bytes)
{
    zip_stat_t stat;
    g_assert_cmpint(zip_stat(zip, name, 0, &stat), ==, 0);
    char *data = g_malloc0(stat.size + 1);
    zip_file_t *part = zip_fopen(zip, name, 0);
    g_assert_cmpint(zip_fread(part, data, stat.size), ==, (gint64)stat.size);
    zip_fclose(part);
    *bytes = stat.size;
    return data;
}

static void an_openraster_file_has_its_layers_in_order(void)
{
    g_autoptr(Scratch) scratch = scratch_make();
    g_autofree char *path = write_layered(scratch, "a_%02d.ora");
    g_autofree char *again = write_layered(scratch, "b_%02d.ora");
    g_autofree char *file = NULL, *file_again = NULL;
    size_t length = 0, length_again = 0, bytes = 0;
    g_file_get_contents(path, &file, &length, NULL);
    g_file_get_contents(again, &file_again, &length_again, NULL);
    g_assert_cmpmem(file, (int)length, file_again, (int)length_again);
    g_assert_cmpmem(file + 30, 8 + 16, "mimetypeimage/openraster", 24);
    zip_t *zip = zip_open(path, ZIP_RDONLY, NULL);
    g_autofree char *xml = read_part(zip, "stack.xml", &bytes);
    g_assert_nonnull(strstr(xml, "w=\"34\" h=\"26\""));
    g_assert_true(strstr(xml, "name=\"" HAIR "\"") < strstr(xml, "name=\"back-ground\""));
    g_assert_nonnull(strstr(xml, "src=\"data/layer001.png\" x=\"5\" y=\"20\""));
    g_autofree char *png = read_part(zip, "data/layer001.png", &bytes);
    g_autofree char *out = g_build_filename(scratch, "layer.png", NULL);
    g_file_set_contents(out, png, (gssize)bytes, NULL);
    g_autoptr(FlPicture) layer = fl_picture_read_png(out, NULL);
    g_assert_cmpmem(layer->rgba, 64, small, 64);
    G_GNUC_UNUSED g_autofree char *merged = read_part(zip, "mergedimage.png", &bytes);
    G_GNUC_UNUSED g_autofree char *thumbnail = read_part(zip, "Thumbnails/thumbnail.png", &bytes);
    zip_close(zip);
}

/** Writes a frame whose only layer is `whole`; the layer's file. */
static GBytes *layer_of_frame(FlSink *sink, int number, int since)
{
    g_autoptr(GError) error = NULL;
    const FlSinkLayer layer = {
        .name = "paper", .width = W, .height = H, .rgba = whole, .since = since, .multiply = true};
    const FlSinkFrame frame = {.number = number, .rgba = whole, .layers = &layer, .n_layers = 1};
    fl_sink_frame(sink, &frame, &error);
    g_assert_no_error(error);
    g_autofree char *path = fl_sink_file(&sink->params, number, NULL);
    zip_t *zip = zip_open(path, ZIP_RDONLY, NULL);
    size_t bytes;
    char *png = read_part(zip, "data/layer000.png", &bytes);
    zip_close(zip);
    return g_bytes_new_take(png, bytes);
}

static void a_layer_that_stays_is_encoded_once(void)
{
    g_autoptr(Scratch) scratch = scratch_make();
    g_autofree char *pattern = g_build_filename(scratch, "a_%02d.ora", NULL);
    const FlSinkParams params = {.path = pattern, .width = W, .height = H};
    g_autoptr(FlSink) sink = fl_sink_open(fl_sink_format(NULL, pattern, NULL), &params, NULL);
    fill(whole, 1);
    g_autoptr(GBytes) first = layer_of_frame(sink, 1, 1);
    fill(whole, 2);
    g_autoptr(GBytes) stays = layer_of_frame(sink, 2, 1), other = layer_of_frame(sink, 3, 3);
    g_autoptr(GBytes) unknown = layer_of_frame(sink, 4, 0);
    g_assert_true(g_bytes_equal(first, stays));
    g_assert_false(g_bytes_equal(first, other));
    g_assert_true(g_bytes_equal(other, unknown));
}

#endif

int main(int argc, char **argv)
{
    g_setenv("G_TEST_SRCDIR", g_getenv("FLUIDY_FIXTURES"), true);
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/formats/a-film-reads-back-with-size-rate-colours-and-tags",
                    a_film_reads_back_with_size_rate_colours_and_tags);
    g_test_add_func("/formats/transparent-frames-are-not-for-h264",
                    transparent_frames_are_not_for_h264);
    g_test_add_func("/formats/an-unfinished-film-leaves-nothing",
                    an_unfinished_film_leaves_nothing);
    g_test_add_func("/formats/the-death-of-ffmpeg-is-told-in-its-own-words",
                    the_death_of_ffmpeg_is_told_in_its_own_words);
    g_test_add_func("/formats/a-missing-ffmpeg-is-one-plain-message",
                    a_missing_ffmpeg_is_one_plain_message);
    g_test_add_func("/formats/a-film-has-the-sound-that-it-is-given",
                    a_film_has_the_sound_that_it_is_given);
    g_test_add_func("/formats/an-existing-film-is-kept", an_existing_film_is_kept);
    g_test_add_func("/formats/a-full-disk-is-an-error-and-leaves-no-litter",
                    a_full_disk_is_an_error_and_leaves_no_litter);
    g_test_add_func("/formats/files-of-all-formats-know-when-they-were-changed",
                    files_of_all_formats_know_when_they_were_changed);
    g_test_add_func("/formats/sums-are-a-line-per-frame", sums_are_a_line_per_frame);
#if HAVE_EXR
    g_test_add_func("/formats/an-exr-holds-linear-premultiplied-layers",
                    an_exr_holds_linear_premultiplied_layers);
    g_test_add_func("/formats/an-exr-says-where-pixels-come-from-and-how-thick-paint-is",
                    an_exr_says_where_pixels_come_from_and_how_thick_paint_is);
#endif
#if HAVE_ORA
    g_test_add_func("/formats/an-openraster-file-has-its-layers-in-order",
                    an_openraster_file_has_its_layers_in_order);
    g_test_add_func("/formats/a-layer-that-stays-is-encoded-once",
                    a_layer_that_stays_is_encoded_once);
#endif
    return g_test_run();
}
