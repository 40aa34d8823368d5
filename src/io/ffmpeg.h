/* Videos, and pictures other than PNG, through the ffmpeg program: a child process and a pipe. */
#pragma once

#include "base/picture.h"

/** A recording that is being read. */
typedef struct FlFfmpeg FlFfmpeg;

/**
 * Begins to read frames first, first + step ... last of a file's first video, from 1; last 0: to
 * the end. No shell is involved, and the program is confined to the file. Returns: NULL with
 * FL_ERROR_INPUT set.
 */
FlFfmpeg *fl_ffmpeg_open(const char *path, int first, int last, int step, GError **error);

/**
 * The next frame, which the caller frees. NULL without an error is the end; an error quotes the
 * child's message.
 */
FlPicture *fl_ffmpeg_read(FlFfmpeg *ffmpeg, GError **error);

/** Ends the child. NULL is fine. */
void fl_ffmpeg_close(FlFfmpeg *ffmpeg);

/** The first picture of a file, which is a still. Returns: NULL with FL_ERROR_INPUT set. */
FlPicture *fl_ffmpeg_picture(const char *path, GError **error);

#define FL_SOUND_RATE 48000
#define FL_SOUND_CHANNELS 2

/**
 * Decodes the first sound of a file, so many seconds from one on, into a temporary file without a
 * name: 16 bits, little end first, channels interleaved. Returns: its descriptor; -1 with
 * FL_ERROR_INPUT or FL_ERROR_OUTPUT set.
 */
int fl_ffmpeg_sound(const char *path, double from_s, double seconds, GError **error);

/** Frames per second of a file's first video; 0 if ffprobe does not know. */
double fl_ffmpeg_rate(const char *path);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlFfmpeg, fl_ffmpeg_close)
