#include "guides/flow_file.h"

#include "base/alloc.h"
#include "base/error.h"
#include "base/file.h"
#include "base/rect.h"

#include <gio/gio.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

enum { FLO_HEADER_BYTES = 12 };
static const float flo_magic = 202021.25f, flo_unknown = 1e9f, most_px = 1e5f;
static const float flo_no_value = 1.666666752e9f; // value of other programs for unknown

static bool is_flo(const char *path)
{
    return g_str_has_suffix(path, ".flo");
}

static uint32_t read_u32(const uint8_t *bytes)
{
    uint32_t value;
    memcpy(&value, bytes, sizeof value);
    return GUINT32_FROM_LE(value);
}

static void write_u32(uint8_t *bytes, uint32_t value)
{
    value = GUINT32_TO_LE(value);
    memcpy(bytes, &value, sizeof value);
}

static float float_of_bits(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint32_t bits_of_float(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static bool check_flo_header(const char *path, const uint8_t *data, size_t bytes, int width,
                             int height, GError **error)
{
    if (bytes < FLO_HEADER_BYTES || float_of_bits(read_u32(data)) != flo_magic)
        return fl_fail(error, FL_ERROR_INPUT, "%s: not a .flo file: it does not start with PIEH",
                       path);
    const int32_t w = (int32_t)read_u32(data + 4), h = (int32_t)read_u32(data + 8);
    if (w != width || h != height)
        return fl_fail(error, FL_ERROR_INPUT,
                       "%s: the flow is %dx%d pixels, but the frames are %dx%d", path, w, h, width,
                       height);
    return true;
}

static bool is_unknown(float value)
{
    return fabsf(value) > flo_unknown && isfinite(value);
}

static bool check_component(const char *path, float value, size_t index, int width, GError **error)
{
    if (fabsf(value) <= most_px)
        return true;
    const size_t pixel = index / 2;
    return fl_fail(error, FL_ERROR_INPUT,
                   "%s: the flow at column %zu, row %zu is %g, expected a number of at most %g px",
                   path, pixel % width, pixel / width, value, most_px);
}

bool fl_flow_load(const char *path, int width, int height, float unknown, float *flow,
                  GError **error)
{
    if (!fl_file_check(path, FL_ERROR_INPUT, error))
        return false;
    g_autoptr(GError) cause = NULL;
    g_autoptr(GMappedFile) file = g_mapped_file_new(path, FALSE, &cause);
    if (!file)
        return fl_fail(error, FL_ERROR_INPUT, "%s: cannot read the flow: %s", path, cause->message);
    const bool flo = is_flo(path);
    const uint8_t *data = (const uint8_t *)g_mapped_file_get_contents(file);
    const size_t bytes = g_mapped_file_get_length(file), header = flo ? FLO_HEADER_BYTES : 0;
    const size_t n = 2 * (size_t)width * height, expected = header + n * sizeof(float);
    if (flo && !check_flo_header(path, data, bytes, width, height, error))
        return false;
    if (bytes != expected)
        return fl_fail(error, FL_ERROR_INPUT,
                       "%s: the flow has %zu bytes, expected %zu for %dx%d pixels", path, bytes,
                       expected, width, height);
    for (size_t k = 0; k < n; k++) {
        flow[k] = float_of_bits(read_u32(data + header + k * sizeof(float)));
        if (!(flo && is_unknown(flow[k])) && !check_component(path, flow[k], k, width, error))
            return false;
    }
    for (float *pair = flow; flo && pair < flow + n; pair += 2)
        if (is_unknown(pair[0]) || is_unknown(pair[1]))
            pair[0] = pair[1] = unknown;
    return true;
}

bool fl_flow_save(const char *path, int width, int height, const float *flow, GError **error)
{
    const size_t header = is_flo(path) ? FLO_HEADER_BYTES : 0, n = 2 * (size_t)width * height;
    g_autofree uint8_t *data = fl_alloc(header + n * sizeof(float), 1, "a flow file", error);
    g_autoptr(GError) cause = NULL;
    if (!data) {
        g_prefix_error(error, "%s: ", path);
        return false;
    }
    if (header) {
        write_u32(data, bits_of_float(flo_magic));
        write_u32(data + 4, (uint32_t)width);
        write_u32(data + 8, (uint32_t)height);
    }
    for (size_t k = 0; k < n; k++)
        write_u32(data + header + k * sizeof(float),
                  bits_of_float(isnan(flow[k]) ? flo_no_value : flow[k]));
    if (!g_file_set_contents_full(path, (const char *)data, (gssize)(header + n * sizeof(float)),
                                  G_FILE_SET_CONTENTS_CONSISTENT, 0666, &cause))
        return fl_fail(error, FL_ERROR_OUTPUT, "%s: cannot write the flow: %s", path,
                       cause->message);
    return true;
}

/* The four pixels of a small one; at an odd border the last ones are met twice. */
static void children(int width, int height, int x, int y, size_t child[4])
{
    const int x1 = MIN(2 * x + 1, width - 1), y1 = MIN(2 * y + 1, height - 1);
    child[0] = (size_t)2 * y * width + 2 * x;
    child[1] = (size_t)2 * y * width + x1;
    child[2] = (size_t)y1 * width + 2 * x;
    child[3] = (size_t)y1 * width + x1;
}

void fl_flow_halve(const float *flow, int width, int height, float *half)
{
    const int w = fl_half_side(width), h = fl_half_side(height);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            size_t child[4];
            float most = -1;
            children(width, height, x, y, child);
            for (int k = 0; k < 4; k++) { // the fastest: pixels beside a shape do not move
                const float *at = flow + 2 * child[k], speed = at[0] * at[0] + at[1] * at[1];
                float *to = half + 2 * ((size_t)y * w + x);
                if (speed > most || k == 0 || isnan(most))
                    most = speed, to[0] = at[0] * 0.5f, to[1] = at[1] * 0.5f;
            }
        }
}
