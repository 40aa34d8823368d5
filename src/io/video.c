/* Films, through the ffmpeg program. */
#include "base/error.h"
#include "io/child_process.h"
#include "io/ffmpeg.h"
#include "io/sink.h"

#include <errno.h>
#include <fcntl.h>
#include <unistd.h>

/** ffmpeg's arguments for a film format. */
typedef struct Codec {
    const FlSinkFormat *format;
    const char *muxer;
    const char *with_alpha;    // words between spaces; NULL: the format has no transparency
    const char *without_alpha; // the same for opaque frames
    const char *sound;         // the same for sound; NULL: the format has none
    bool yuv;                  // stored as Rec. 709 luma and chroma; else as sRGB
} Codec;

/* One palette per frame keeps ffmpeg from holding the whole film, and suits paint that changes. */
#define PALETTE                                                                                    \
    "-filter_complex "                                                                             \
    "[0:v]split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1:dither=sierra2_"   \
    "4a "

/* Without sums of the container, since the mark in it is completed afterwards; slices have sums. */
#define FFV1 "-c:v ffv1 -level 3 -g 1 -slicecrc 1 -write_crc32 0 -pix_fmt "

static const Codec codecs[] = {
    {&fl_sink_mov, "mov",
     "-c:v prores_ks -profile:v 4444 -alpha_bits 16 -vendor apl0 -pix_fmt yuva444p10le",
     "-c:v prores_ks -profile:v 4444 -vendor apl0 -pix_fmt yuv444p10le", "-c:a pcm_s16le", true},
    {&fl_sink_webm, "webm",
     "-c:v libvpx-vp9 -crf 18 -b:v 0 -row-mt 1 -auto-alt-ref 0 -pix_fmt yuva420p",
     "-c:v libvpx-vp9 -crf 18 -b:v 0 -row-mt 1 -pix_fmt yuv420p", "-c:a libopus -b:a 192k", true},
    {&fl_sink_mkv, "matroska", FFV1 "bgra", FFV1 "bgr0", "-c:a flac", false},
    {&fl_sink_mp4, "mp4", NULL,
     "-c:v libx264 -crf 16 -preset medium -movflags +faststart -pix_fmt yuv420p",
     "-c:a aac -b:a 192k", true},
    {&fl_sink_gif, "gif", PALETTE "-loop 0", PALETTE "-loop 0", NULL, false},
    {&fl_sink_apng, "apng", "-c:v apng -pred mixed -plays 0 -pix_fmt rgba",
     "-c:v apng -pred mixed -plays 0 -pix_fmt rgb24", NULL, false},
};

/** A film that is being written. */
typedef struct Video {
    FlChild *child;
    int sound; // a file; -1: none
} Video;

static const Codec *codec_of(const FlSinkFormat *format)
{
    const Codec *codec = codecs;
    while (codec->format != format)
        codec++;
    return codec;
}

/** -xerror: else ffmpeg reports success although the disk was full at the end. */
static void add_input(GPtrArray *arguments, const FlSinkParams *params)
{
    char fps[G_ASCII_DTOSTR_BUF_SIZE];
    g_ascii_formatd(fps, sizeof fps, "%.6f", params->fps);
    fl_arguments_add(
        arguments, "ffmpeg -hide_banner -loglevel error -xerror -y -f rawvideo -pixel_format rgba");
    g_ptr_array_add(arguments, g_strdup("-video_size"));
    g_ptr_array_add(arguments, g_strdup_printf("%dx%d", params->width, params->height));
    g_ptr_array_add(arguments, g_strdup("-framerate"));
    g_ptr_array_add(arguments, g_strdup(fps));
    fl_arguments_add(arguments, "-i pipe:0");
}

/** ffmpeg opens our file without a name. */
static void add_sound(GPtrArray *arguments, const Codec *codec, int sound)
{
    if (sound < 0) {
        fl_arguments_add(arguments, "-an");
        return;
    }
    fl_arguments_add(arguments, "-f s16le -ar " G_STRINGIFY(FL_SOUND_RATE) " -ac " G_STRINGIFY(
                                    FL_SOUND_CHANNELS) " -i");
    g_ptr_array_add(arguments, g_strdup_printf("file:/proc/%d/fd/%d", (int)getpid(), sound));
    fl_arguments_add(arguments, "-map 0:v -map 1:a -flags:a +bitexact");
    fl_arguments_add(arguments, codec->sound);
}

/**
 * Sets the colour format and its tags. The tags go onto the frames: ffmpeg's options for the
 * encoder do not reach ProRes. H.264 cuts odd sizes to even ones.
 */
static void add_colour(GPtrArray *arguments, const Codec *codec)
{
    static const char convert[] =
        "scale=flags=accurate_rnd+full_chroma_int:out_color_matrix=bt709:out_range=tv,"
        "setparams=range=tv:colorspace=bt709:color_primaries=bt709:color_trc=bt709";
    static const char even[] = "crop=trunc(iw/2)*2:trunc(ih/2)*2:0:0,";
    if (codec->yuv) {
        g_ptr_array_add(arguments, g_strdup("-vf"));
        g_ptr_array_add(arguments, g_strconcat(codec->with_alpha ? "" : even, convert, NULL));
    }
    fl_arguments_add(arguments, "-fflags +bitexact -flags:v +bitexact");
}

/**
 * ffmpeg gets a descriptor, not a name: a slow ffmpeg of a killed process would open by name what
 * the next process writes. The descriptor is a new one, since the lock must stay ours alone.
 */
static FlChild *start_ffmpeg(const FlSink *sink, int sound, GError **error)
{
    const Codec *codec = codec_of(sink->format);
    g_autoptr(GPtrArray) arguments = g_ptr_array_new_with_free_func(g_free);
    add_input(arguments, &sink->params);
    add_sound(arguments, codec, sound);
    fl_arguments_add(arguments, sink->params.opaque ? codec->without_alpha : codec->with_alpha);
    add_colour(arguments, codec);
    if (sink->mark) {
        fl_arguments_add(arguments, "-metadata");
        g_ptr_array_add(arguments, g_strconcat("comment=", sink->mark, NULL));
    }
    fl_arguments_add(arguments, "-f");
    g_ptr_array_add(arguments, g_strdup(codec->muxer));
    fl_arguments_add(arguments, "file:" FL_CHILD_FILE);
    g_ptr_array_add(arguments, NULL);
    const int fd = open(sink->file.temporary, O_RDWR | O_CLOEXEC);
    if (fd < 0)
        return fl_none(error, FL_ERROR_OUTPUT, "%s", g_strerror(errno));
    FlChild *child = fl_child_start((const char *const *)arguments->pdata, FL_CHILD_INPUT, fd,
                                    &sink->params.patience, error);
    close(fd);
    return child;
}

static bool video_open(FlSink *sink, GError **error)
{
    const FlSinkParams *params = &sink->params;
    g_autofree char *program = g_find_program_in_path("ffmpeg");
    if (!program)
        return fl_fail(
            error, FL_ERROR_OUTPUT,
            "%s: films are written by the ffmpeg program, which is not installed; install "
            "it, or write frames such as film_%%04d.png",
            params->path);
    if (!params->opaque && !codec_of(sink->format)->with_alpha)
        return fl_fail(error, FL_ERROR_USAGE,
                       "%s: H.264 has no transparency; expected a background, or a .mov, .webm or "
                       ".mkv file",
                       params->path);
    if (params->audio && !codec_of(sink->format)->sound)
        return fl_fail(error, FL_ERROR_USAGE,
                       "%s: has no sound; expected a .mov, .webm, .mkv or .mp4 file", params->path);
    const int sound = params->audio ? fl_ffmpeg_sound(params->audio, MAX(params->audio_from, 0),
                                                      params->seconds, error)
                                    : -1;
    if ((params->audio && sound < 0) || !fl_sink_begin(sink, error)) {
        if (sound >= 0)
            close(sound);
        return false;
    }
    Video *video = sink->state = g_new(Video, 1);
    *video = (Video){start_ffmpeg(sink, sound, error), sound};
    if (!video->child)
        g_prefix_error(error, "%s: ", params->path);
    return video->child != NULL;
}

static bool video_frame(FlSink *sink, const FlSinkFrame *frame, GError **error)
{
    const size_t bytes = (size_t)sink->params.width * (size_t)sink->params.height * 4;
    if (fl_child_write(((Video *)sink->state)->child, frame->rgba, bytes, error))
        return true;
    g_prefix_error(error, "%s: ", sink->params.path);
    return false;
}

static bool video_finish(FlSink *sink, GError **error)
{
    if (fl_child_finish(((Video *)sink->state)->child, error))
        return true;
    g_prefix_error(error, "%s: ", sink->params.path);
    return false;
}

static void video_clear(FlSink *sink)
{
    Video *video = sink->state;
    if (!video)
        return;
    fl_child_free(video->child);
    if (video->sound >= 0)
        close(video->sound);
    g_free(video);
}

#define FILM(word, end, text)                                                                      \
    const FlSinkFormat fl_sink_##word = {                                                          \
        .name = #word,                                                                             \
        .suffix = end,                                                                             \
        .help = text,                                                                              \
        .film = true,                                                                              \
        .moving = true,                                                                            \
        .open = video_open,                                                                        \
        .frame = video_frame,                                                                      \
        .finish = video_finish,                                                                    \
        .clear = video_clear,                                                                      \
    }

FILM(mov, ".mov", "a film: ProRes 4444, with alpha");
FILM(webm, ".webm", "a film: VP9, with alpha");
FILM(mkv, ".mkv", "a film: FFV1, lossless, with alpha");
FILM(mp4, ".mp4", "a film: H.264; needs a background");
FILM(gif, ".gif", "an animated GIF, a palette per frame");
FILM(apng, ".apng", "an animated PNG, lossless, with alpha");
