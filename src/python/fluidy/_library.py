"""The library's declarations, and its errors as exceptions. Private to the package."""
import os

from cffi import FFI

DECLARATIONS = """
typedef struct { uint32_t domain; int code; char *message; } GError;
void g_error_free(GError *error);

uint32_t fl_error_quark(void);
bool fl_start_workers(void);
const char *fl_version(void);

typedef struct FlFilm FlFilm;
FlFilm *fl_film_open(const char *const *inputs);
void fl_film_close(FlFilm *film);
bool fl_film_set(FlFilm *film, const char *region, const char *name, const char *value, GError **error);
bool fl_film_set_config(FlFilm *film, const char *path, const char *text, GError **error);
typedef struct FlProgress {
    const char *stage;
    const char *region;
    int region_index;
    int n_regions;
    int frame;
    int done;
    int total;
    double share;
    double elapsed_s;
    double frame_s;
    double remaining_s;
} FlProgress;
typedef struct FlFilmCalls {
    size_t size;
    bool (*progress)(const FlProgress *progress, void *data);
    void (*warning)(const char *message, void *data);
    void (*note)(const char *message, void *data);
    void *data;
    bool (*stopped)(void *data);
    void (*reads)(const char *path, void *data);
} FlFilmCalls;
void fl_film_set_calls(FlFilm *film, const FlFilmCalls *calls);
typedef struct FlFilmInfo {
    int n_frames;
    int width;
    int height;
    int n_regions;
    const char *name;
    double fps;
    bool transparent;
} FlFilmInfo;
const FlFilmInfo *fl_film_info(FlFilm *film, GError **error);
const FlFilmInfo *fl_film_draft_info(FlFilm *film, GError **error);
typedef struct FlFilmFrame {
    int frame;
    int number;
    int width;
    int height;
    const uint8_t *rgba;
} FlFilmFrame;
const FlFilmFrame *fl_film_frame(FlFilm *film, int frame, GError **error);
void fl_film_set_draft_side(FlFilm *film, int most_side);
const FlFilmFrame *fl_film_draft(FlFilm *film, int frame, GError **error);
const FlFilmFrame *fl_film_drawing(FlFilm *film, int frame, GError **error);
const FlFilmFrame *fl_film_map(FlFilm *film, int frame, GError **error);
typedef struct FlFilmRegion {
    const char *name;
    const char *layer;
    const char *paint;
    const char *style;
    bool left_out;
    uint8_t colour[3];
} FlFilmRegion;
const FlFilmRegion *fl_film_regions(FlFilm *film, int *n, GError **error);
typedef struct FlFilmStats {
    int n_read;
    int n_painted;
    int n_composed;
} FlFilmStats;
const FlFilmStats *fl_film_stats(FlFilm *film);
bool fl_film_render(FlFilm *film, GError **error);

typedef struct FlSetting {
    const char *region;
    const char *name;
    const char *value;
} FlSetting;
typedef struct FlPaintedFrame {
    int frame;
    int width;
    int height;
    const uint8_t *paint;
    const uint8_t *layer;
} FlPaintedFrame;
typedef struct FlRegionPaint {
    size_t size;
    int width;
    int height;
    int n_frames;
    bool (*mask)(void *data, int frame, uint8_t *coverage);
    bool (*flow)(void *data, int frame, float *flow);
    bool (*take)(void *data, const FlPaintedFrame *painted);
    void *data;
    const char *name;
    const FlSetting *settings;
    size_t n_settings;
    uint64_t seed;
    int threads;
    const char *cache;
    int cache_size;
} FlRegionPaint;
bool fl_paint_region(const FlRegionPaint *region, GError **error);
"""

os.environ.setdefault("OMP_WAIT_POLICY", "passive")  # threads that wait for others take no time from them

ffi = FFI()
ffi.cdef(DECLARATIONS)
library = ffi.dlopen("libfluidy.so.0")
glib = ffi.dlopen("libglib-2.0.so.0")
library.fl_start_workers()  # before numpy starts threads, which would prevent it


class Error(Exception):
    """An error of the library, in its words. The subclass says what to do next."""


class UsageError(Error, ValueError):
    """An option, a value or a config is wrong."""


class InputError(Error):
    """A drawing, a mask or a flow file is missing or broken."""


class StyleError(Error):
    """A style is missing or broken."""


class OutputError(Error, OSError):
    """A file cannot be written."""


class ExistsError(Error, FileExistsError):
    """A file that is not ours would be overwritten."""


class LimitError(Error):
    """A file asks for more than the limits allow."""


class NoMemoryError(Error, MemoryError):
    """Out of memory."""


class ChangedError(Error):
    """The saved state of an earlier run does not match this one."""


class InterruptedError(Error):
    """Stopped on request."""


class TimeError(Error):
    """A drawing takes longer than it may."""


# in the order of FlError
KINDS = (UsageError, InputError, StyleError, OutputError, ExistsError, LimitError, NoMemoryError, ChangedError,
         InterruptedError, TimeError)


def text(chars):
    """A str of a C string; "" for NULL."""
    return ffi.string(chars).decode("utf-8", "replace") if chars else ""


def chars(words):
    """A C string that Python owns; NULL for None."""
    return ffi.NULL if words is None else ffi.new("char[]", str(words).encode())


def check(call, *arguments):
    """The result of a call whose last parameter is a GError; raises its error."""
    error = ffi.new("GError **")
    result = call(*arguments, error)
    if error[0] == ffi.NULL:
        return result
    words, ours = text(error[0].message), error[0].domain == library.fl_error_quark()
    kind = KINDS[error[0].code] if ours and error[0].code < len(KINDS) else Error
    glib.g_error_free(error[0])
    raise kind(words)
