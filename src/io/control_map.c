#include "io/control_map.h"

#include "base/alloc.h"
#include "base/error.h"
#include "io/pattern.h"
#include "io/picture_file.h"
#include "io/picture_series.h"

#include <stdlib.h>
#include <string.h>

/* A picture as shares of a dial. */
typedef struct Shares {
    int picture; // index in the series
    int width, height;
    uint8_t *share; // NULL: none was read yet
} Shares;

struct FlControlMap {
    FlSeries *series;
    GMutex lock;    // of what follows
    Shares last[2]; // the pictures that were read last
    int oldest;     // of these
};

FlControlMap *fl_control_map_open(const char *pattern, GError **error)
{
    g_autoptr(FlSeries) series = fl_input_is_pattern(pattern) ? fl_series_of_pattern(pattern, error)
                                                              : fl_series_of_file(pattern);
    if (!series)
        return NULL;
    if (!g_file_test(series->path[0], G_FILE_TEST_IS_REGULAR))
        return fl_none(error, FL_ERROR_INPUT,
                       "%s: there is no such file; expected a picture, or a pattern such as "
                       "map_%%04d.png",
                       pattern);
    FlControlMap *map = g_new0(FlControlMap, 1);
    map->series = g_steal_pointer(&series);
    g_mutex_init(&map->lock);
    return map;
}

void fl_control_map_free(FlControlMap *map)
{
    if (!map)
        return;
    free(map->last[0].share);
    free(map->last[1].share);
    fl_series_free(map->series);
    g_mutex_clear(&map->lock);
    g_free(map);
}

const char *const *fl_control_map_files(const FlControlMap *map)
{
    return (const char *const *)map->series->path;
}

/* ---- a picture ------------------------------------------------------------------------------- */

/* Grey levels over white, so that bare places leave the dial as it is. */
static bool read_shares(const char *path, Shares *shares, GError **error)
{
    g_autoptr(FlPicture) picture = fl_picture_read(path, error);
    if (!picture)
        return false;
    const size_t n = (size_t)picture->width * (size_t)picture->height;
    if (!(shares->share = fl_alloc_unset(n, 1, path, error)))
        return false;
    shares->width = picture->width, shares->height = picture->height;
    for (size_t p = 0; p < n; p++) {
        const uint8_t *rgba = picture->rgba + 4 * p;
        const int grey = (54 * rgba[0] + 183 * rgba[1] + 19 * rgba[2] + 128) / 256;
        shares->share[p] = (uint8_t)(255 - ((255 - grey) * rgba[3] + 127) / 255);
    }
    return true;
}

/* The map's lock is held. */
static const Shares *shares_of(FlControlMap *map, int picture, GError **error)
{
    for (int k = 0; k < 2; k++)
        if (map->last[k].share && map->last[k].picture == picture) {
            map->oldest = 1 - k;
            return &map->last[k];
        }
    Shares *shares = &map->last[map->oldest];
    g_clear_pointer(&shares->share, free);
    shares->picture = picture;
    map->oldest = 1 - map->oldest;
    return read_shares(map->series->path[picture], shares, error) ? shares : NULL;
}

/* The two pixels between which a place lies, and the weight of the second. */
static float between(double place, int n, int *first, int *second)
{
    const double at = CLAMP(place, 0, n - 1);
    *first = (int)at, *second = MIN(*first + 1, n - 1);
    return (float)(at - *first);
}

/* Adds weight * the shares to each pixel of rect. */
static void add_shares(const Shares *shares, FlRect rect, double width, double height, float weight,
                       float *value)
{
    for (int y = 0; y < rect.height; y++) {
        int upper, lower, left, right;
        const float down = between((rect.y + y + .5) * shares->height / height - .5, shares->height,
                                   &upper, &lower);
        const uint8_t *above = shares->share + (size_t)upper * (size_t)shares->width;
        const uint8_t *below = shares->share + (size_t)lower * (size_t)shares->width;
        for (int x = 0; x < rect.width; x++) {
            const float across = between((rect.x + x + .5) * shares->width / width - .5,
                                         shares->width, &left, &right);
            const float top = (float)above[left] + across * (float)(above[right] - above[left]);
            const float bottom = (float)below[left] + across * (float)(below[right] - below[left]);
            *value++ += weight * (top + down * (bottom - top)) / 255;
        }
    }
}

/* ---- a frame --------------------------------------------------------------------------------- */

bool fl_control_map_read(FlControlMap *map, int number, FlRect rect, double width, double height,
                         float *value, GError **error)
{
    const FlSeries *series = map->series;
    int after = 0;
    while (after < series->n - 1 && series->number[after] < number)
        after++;
    const int before = series->number[after] > number ? MAX(after - 1, 0) : after;
    const int apart = series->number[after] - series->number[before];
    const float late = apart > 0 ? (float)(number - series->number[before]) / (float)apart : 0;
    g_autoptr(GMutexLocker) held = g_mutex_locker_new(&map->lock);
    const Shares *first = shares_of(map, before, error);
    const Shares *second = first ? shares_of(map, after, error) : NULL;
    if (!second)
        return false;
    memset(value, 0, fl_rect_pixels(rect) * sizeof *value);
    add_shares(first, rect, width, height, 1 - late, value);
    if (late > 0)
        add_shares(second, rect, width, height, late, value);
    return true;
}

bool fl_control_map_make(FlControlMap *map, int number, FlRect rect, double width, double height,
                         float **value, GError **error)
{
    if (!map)
        return true;
    *value = fl_alloc_unset(fl_rect_pixels(rect), sizeof **value, "a control map", error);
    return *value && fl_control_map_read(map, number, rect, width, height, *value, error);
}
