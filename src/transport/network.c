#include "transport/network.h"

#include "base/alloc.h"
#include "base/file.h"
#include "base/row_kernels.h"
#include "base/schedule.h"
#include "style/style_folder.h"
#include "transport/potential.h"
#include <math.h>
#include <string.h>
#include <zlib.h>

#define MAGIC "FLNET001"
#define MAGIC_BYTES 8
#define HEADER_BYTES 8 // channels, bits, layers, 0: 16 bits each, the low byte first, as everywhere
#define MOST_CHANNELS 32
#define MOST_BITS 12
#define MOST_SHIFT 24
#define MOST_FILE_BYTES (4 << 20)
#define PAD 2         // columns beside a row, equal to its ends
#define LEAK_BITS 3   // what is below 0 is divided by 2^3
#define MOST_ROWS 448 // of inputs to one row of a layer: 7 * MOST_CHANNELS planes, 3 rows or fewer

typedef enum Name {
    STEM,
    E1A,
    E1B,
    E2A,
    E2B,
    E3A,
    E3B,
    E4A,
    E4B,
    D3A,
    D3B,
    D2A,
    D2B,
    D1A,
    D1B,
    O1,
    O2,
    O3,
    LAYERS
} Name;

/* Inputs and outputs in multiples of the network's channels; 0: the network's own, or one. */
static const struct Shape {
    uint8_t side, inputs, outputs;
} shapes[LAYERS] = {
    [STEM] = {5, 0, 1}, [E1A] = {3, 1, 1}, [E1B] = {3, 1, 1}, [E2A] = {3, 1, 2}, [E2B] = {3, 2, 2},
    [E3A] = {3, 2, 3},  [E3B] = {3, 3, 3}, [E4A] = {3, 3, 4}, [E4B] = {3, 4, 4}, [D3A] = {3, 7, 3},
    [D3B] = {3, 3, 3},  [D2A] = {3, 5, 2}, [D2B] = {3, 2, 2}, [D1A] = {3, 3, 1}, [D1B] = {3, 1, 1},
    [O1] = {3, 1, 0},   [O2] = {3, 2, 0},  [O3] = {3, 3, 0},
};

typedef struct Layer {
    int inputs, outputs, side, shift;
    int32_t *bias;   // of each output
    int16_t *weight; // by output, input, row, column
} Layer;

struct FlNetwork {
    int channels, bits;
    Layer layer[LAYERS];
    float *tanh_of[FL_NETWORK_HEADS]; // by activation + FL_NETWORK_MOST: px²
};

static const int amplitudes[FL_NETWORK_HEADS] = {3, 12, 40}; // px²

/* ---- the file ----------------------------------------------------------------------------------
 */

static char *network_path(const char *folder)
{
    return g_build_filename(folder, FL_STYLE_NETWORK, NULL);
}

bool fl_network_exists(const char *folder)
{
    g_autofree char *path = network_path(folder);
    return g_file_test(path, G_FILE_TEST_IS_REGULAR);
}

static bool reject(GError **error, const char *path, const char *what)
{
    g_set_error(error, FL_ERROR, FL_ERROR_STYLE,
                "%s: %s; expected what fluidy-style network has written", path, what);
    return false;
}

static uint32_t read_bytes(const uint8_t **at, int n)
{
    uint32_t value = 0;
    for (int i = 0; i < n; i++)
        value |= (uint32_t)(*at)[i] << 8 * i;
    *at += n;
    return value;
}

static size_t weights_of(const Layer *layer)
{
    return (size_t)layer->inputs * (size_t)layer->outputs * (size_t)(layer->side * layer->side);
}

/* The sizes that so many channels give. Returns: bytes of the body. */
static size_t size_layers(FlNetwork *network)
{
    size_t bytes = HEADER_BYTES;
    for (int l = 0; l < LAYERS; l++) {
        const struct Shape *shape = &shapes[l];
        Layer *layer = &network->layer[l];
        layer->side = shape->side;
        layer->inputs = shape->inputs ? shape->inputs * network->channels : FL_NETWORK_INPUTS;
        layer->outputs = shape->outputs ? shape->outputs * network->channels : 1;
        bytes += 4 + 4 * (size_t)layer->outputs + 2 * weights_of(layer);
    }
    return bytes;
}

/* Whether no sum over largest activations leaves 32 bits, with what rounding adds. */
static bool fits(const Layer *layer)
{
    const size_t n = weights_of(layer) / (size_t)layer->outputs;
    for (int o = 0; o < layer->outputs; o++) {
        int64_t most = llabs((long long)layer->bias[o]) + ((int64_t)1 << layer->shift);
        for (size_t i = 0; i < n; i++)
            most += (int64_t)abs(layer->weight[(size_t)o * n + i]) * FL_NETWORK_MOST;
        if (most > INT32_MAX)
            return false;
    }
    return true;
}

static bool read_layer(Layer *layer, const uint8_t **at, GError **error)
{
    const size_t n = weights_of(layer);
    const uint32_t shift = read_bytes(at, 4);
    layer->shift = (int)MIN(shift, MOST_SHIFT + 1);
    if (!(layer->bias = fl_alloc((size_t)layer->outputs, sizeof(int32_t), "a network", error)) ||
        !(layer->weight = fl_alloc(n, sizeof(int16_t), "a network", error)))
        return false;
    for (int o = 0; o < layer->outputs; o++)
        layer->bias[o] = (int32_t)read_bytes(at, 4);
    for (size_t i = 0; i < n; i++)
        layer->weight[i] = (int16_t)read_bytes(at, 2);
    return true;
}

/* Rounded to 1/1024 px², so that any libm gives the same. */
static bool make_tables(FlNetwork *network, GError **error)
{
    const int n = 2 * FL_NETWORK_MOST + 1;
    for (int h = 0; h < FL_NETWORK_HEADS; h++) {
        float *table = network->tanh_of[h] = fl_alloc((size_t)n, sizeof(float), "a network", error);
        for (int i = 0; table && i < n; i++)
            table[i] = (float)lrint(1024 * amplitudes[h] *
                                    tanh(ldexp(i - FL_NETWORK_MOST, -network->bits))) /
                       1024;
        if (!table)
            return false;
    }
    return true;
}

/* data: the whole file. */
static bool parse(FlNetwork *network, const uint8_t *data, size_t bytes, const char *path,
                  GError **error)
{
    if (bytes < MAGIC_BYTES + HEADER_BYTES + 4 || memcmp(data, MAGIC, MAGIC_BYTES) != 0)
        return reject(error, path, "not a network");
    const uint8_t *at = data + MAGIC_BYTES, *end = data + bytes - 4;
    const size_t body = (size_t)(end - at);
    if (read_bytes(&end, 4) != (uint32_t)crc32(0, at, (uInt)body))
        return reject(error, path, "its checksum is wrong");
    network->channels = (int)read_bytes(&at, 2);
    network->bits = (int)read_bytes(&at, 2);
    const bool layers = read_bytes(&at, 2) == LAYERS, zero = read_bytes(&at, 2) == 0;
    if (!layers || !zero || network->channels < 1 || network->channels > MOST_CHANNELS ||
        network->bits > MOST_BITS || size_layers(network) != body)
        return reject(error, path, "its sizes do not fit together");
    for (int l = 0; l < LAYERS; l++) {
        if (!read_layer(&network->layer[l], &at, error))
            return false;
        if (network->layer[l].shift > MOST_SHIFT || !fits(&network->layer[l]))
            return reject(error, path, "its weights are too large");
    }
    return make_tables(network, error);
}

FlNetwork *fl_network_load(const char *folder, GError **error)
{
    g_autofree char *path = network_path(folder), *data = NULL;
    g_autoptr(FlNetwork) network = g_new0(FlNetwork, 1);
    size_t bytes = 0;
    if (!fl_network_exists(folder)) {
        g_set_error(error, FL_ERROR, FL_ERROR_STYLE,
                    "%s: no such file; expected a style for which fluidy-style network has "
                    "trained one",
                    path);
        return NULL;
    }
    if (!fl_file_read(path, MOST_FILE_BYTES, &data, &bytes, error)) {
        if (error && (*error)->code == FL_ERROR_INPUT)
            (*error)->code = FL_ERROR_STYLE;
        return NULL;
    }
    return parse(network, (const uint8_t *)data, bytes, path, error) ? g_steal_pointer(&network)
                                                                     : NULL;
}

void fl_network_free(FlNetwork *network)
{
    if (!network)
        return;
    for (int l = 0; l < LAYERS; l++) {
        free(network->layer[l].bias);
        free(network->layer[l].weight);
    }
    for (int h = 0; h < FL_NETWORK_HEADS; h++)
        free(network->tanh_of[h]);
    g_free(network);
}

float fl_network_one(const FlNetwork *network)
{
    return (float)(1 << network->bits);
}

/* ---- layers ------------------------------------------------------------------------------------
 */

/* Planes of activations; each row has PAD columns before and behind it. */
typedef struct Planes {
    int channels, width, height;
    int16_t *value;
} Planes;

static void planes_clear(Planes *planes)
{
    free(planes->value);
    *planes = (Planes){0};
}

static bool planes_init(Planes *planes, int channels, int width, int height, GError **error)
{
    planes_clear(planes);
    *planes = (Planes){channels, width, height, NULL};
    const size_t rows = (size_t)channels * (size_t)height;
    return (planes->value = fl_alloc_scratch(rows * (size_t)(width + 2 * PAD), sizeof(int16_t),
                                             "a layer of a network", error));
}

/* A row that may lie beyond the rim, where the last one is continued. */
static int16_t *row_of(const Planes *planes, int channel, int y)
{
    const int inside = CLAMP(y, 0, planes->height - 1);
    return planes->value +
           ((size_t)channel * (size_t)planes->height + (size_t)inside) *
               (size_t)(planes->width + 2 * PAD) +
           PAD;
}

static void continue_row(int16_t *row, int width)
{
    for (int i = 1; i <= PAD; i++)
        row[-i] = row[0], row[width - 1 + i] = row[width - 1];
}

/* What sums become: with the bits of activations, less below 0 unless it is a head. */
static void finish_row(const Layer *layer, const int32_t *sum, bool leaks, int width, int16_t *row)
{
    const int shift = layer->shift, half = 1 << shift >> 1;
    for (int x = 0; x < width; x++) {
        int v = (sum[x] + half) >> shift;
        if (leaks && v < 0)
            v = (v + (1 << LEAK_BITS >> 1)) >> LEAK_BITS;
        row[x] = (int16_t)CLAMP(v, -FL_NETWORK_MOST, FL_NETWORK_MOST);
    }
}

/* One row of one output: rows of inputs, three taps each. */
static void convolve_row(const Layer *layer, int output, const int16_t *const *rows,
                         const int16_t *taps, int n, bool leaks, Planes *out, int y, int32_t *sum)
{
    fl_row_kernels()->convolve(sum, layer->bias[output], rows, taps, n, out->width);
    int16_t *row = row_of(out, output, y);
    finish_row(layer, sum, leaks, out->width, row);
    continue_row(row, out->width);
}

static bool convolve(const Layer *layer, bool leaks, const Planes *in, Planes *out, GError **error)
{
    if (!planes_init(out, layer->outputs, in->width, in->height, error))
        return false;
    g_autofree int32_t *sums =
        fl_alloc((size_t)out->height * (size_t)out->width, sizeof *sums, "a layer", error);
    const int n = 3 * layer->inputs;
#pragma omp parallel for schedule(static) if (fl_schedule_worth_threads((size_t)n * 16))
    for (int y = 0; y < (sums ? out->height : 0); y++) {
        const int16_t *rows[3 * 7 * MOST_CHANNELS];
        for (int i = 0; i < n; i++)
            rows[i] = row_of(in, i / 3, y + i % 3 - 1) - 1;
        for (int o = 0; o < layer->outputs; o++)
            convolve_row(layer, o, rows, layer->weight + (size_t)o * (size_t)n * 3, n, leaks, out,
                         y, sums + (size_t)y * (size_t)out->width);
    }
    return sums;
}

/* Even columns and odd ones as planes of their own: two for each. */
static bool split(const int16_t *inputs, int width, int height, Planes *halves, GError **error)
{
    if (!planes_init(halves, 2 * FL_NETWORK_INPUTS, width / 2, height, error))
        return false;
    for (int c = 0; c < 2 * FL_NETWORK_INPUTS; c++)
        for (int y = 0; y < height; y++) {
            const int16_t *from =
                inputs + ((size_t)(c / 2) * (size_t)height + (size_t)y) * (size_t)width;
            int16_t *to = row_of(halves, c, y);
            for (int x = 0; x < width / 2; x++)
                to[x] = from[2 * x + c % 2];
            for (int i = 1; i <= PAD; i++)
                to[-i] = from[0], to[width / 2 - 1 + i] = from[width - 1];
        }
    return true;
}

/* 5x5 taps around every other pixel: columns -2, 0, 2 are even ones, -1 and 1 odd ones. */
static bool stem(const Layer *layer, const Planes *in, Planes *out, GError **error)
{
    const int n = 5 * in->channels;
    if (!planes_init(out, layer->outputs, in->width, in->height / 2, error))
        return false;
    g_autofree int16_t *taps =
        fl_alloc((size_t)layer->outputs * (size_t)n * 3, sizeof *taps, "a layer", error);
    g_autofree int32_t *sums =
        fl_alloc((size_t)out->height * (size_t)out->width, sizeof *sums, "a layer", error);
    if (!taps || !sums)
        return false;
    for (int i = 0; i < layer->outputs * n; i++) { // output, input, half, row
        const int16_t *w = layer->weight + 25 * (size_t)(i / 10) + 5 * (size_t)(i % 5) + i / 5 % 2;
        for (int k = 0; k < 3; k++)
            taps[3 * i + k] = (int16_t)(i / 5 % 2 && k == 2 ? 0 : w[2 * k]);
    }
#pragma omp parallel for schedule(static)
    for (int y = 0; y < out->height; y++) {
        const int16_t *rows[10 * FL_NETWORK_INPUTS];
        for (int i = 0; i < n; i++)
            rows[i] = row_of(in, i / 5, 2 * y + i % 5 - 2) - 1;
        for (int o = 0; o < layer->outputs; o++)
            convolve_row(layer, o, rows, taps + (size_t)o * (size_t)n * 3, n, true, out, y,
                         sums + (size_t)y * (size_t)out->width);
    }
    return true;
}

static bool halve(const Planes *in, Planes *out, GError **error)
{
    if (!planes_init(out, in->channels, in->width / 2, in->height / 2, error))
        return false;
#pragma omp parallel for schedule(static)
    for (int c = 0; c < out->channels; c++)
        for (int y = 0; y < out->height; y++) {
            const int16_t *upper = row_of(in, c, 2 * y), *lower = row_of(in, c, 2 * y + 1);
            int16_t *row = row_of(out, c, y);
            for (int x = 0; x < out->width; x++)
                row[x] = (int16_t)((upper[2 * x] + upper[2 * x + 1] + lower[2 * x] +
                                    lower[2 * x + 1] + 2) >>
                                   2);
            continue_row(row, out->width);
        }
    return true;
}

/* One row of the planes twice as large, 9 : 3 : 3 : 1. */
static void double_row(const int16_t *near, const int16_t *far, int width, int16_t *row)
{
    for (int x = 0; x < width; x++) {
        const int here = 3 * near[x] + far[x];
        row[2 * x] = (int16_t)((3 * here + 3 * near[x - 1] + far[x - 1] + 8) >> 4);
        row[2 * x + 1] = (int16_t)((3 * here + 3 * near[x + 1] + far[x + 1] + 8) >> 4);
    }
    continue_row(row, 2 * width);
}

/* The planes of `coarse`, doubled, and behind them those of `fine`. */
static bool join(const Planes *coarse, const Planes *fine, Planes *out, GError **error)
{
    if (!planes_init(out, coarse->channels + fine->channels, fine->width, fine->height, error))
        return false;
#pragma omp parallel for schedule(static)
    for (int c = 0; c < out->channels; c++)
        for (int y = 0; y < out->height; y++) {
            int16_t *row = row_of(out, c, y);
            if (c < coarse->channels)
                double_row(row_of(coarse, c, y / 2), row_of(coarse, c, y / 2 + (y % 2 ? 1 : -1)),
                           coarse->width, row);
            else
                memcpy(row - PAD, row_of(fine, c - coarse->channels, y) - PAD,
                       (size_t)(out->width + 2 * PAD) * sizeof *row);
        }
    return true;
}

/* ---- the network -------------------------------------------------------------------------------
 */

/* Two layers, the first of which is `first`; `in` is cleared. */
static bool block(const FlNetwork *network, Name first, Planes *in, Planes *out, GError **error)
{
    Planes between = {0};
    const bool good = convolve(&network->layer[first], true, in, &between, error) &&
                      convolve(&network->layer[first + 1], true, &between, out, error);
    planes_clear(&between);
    planes_clear(in);
    return good;
}

static bool head(const FlNetwork *network, Name name, const Planes *in, int16_t *to, GError **error)
{
    Planes out = {0};
    const bool good = convolve(&network->layer[name], false, in, &out, error);
    for (int y = 0; good && y < out.height; y++)
        memcpy(to + (size_t)y * (size_t)out.width, row_of(&out, 0, y),
               (size_t)out.width * sizeof *to);
    planes_clear(&out);
    return good;
}

/* From fine to coarse: level[i] has pixels of 2^(i + 1) px. */
static bool go_down(const FlNetwork *network, Planes *first, Planes level[4], GError **error)
{
    static const Name names[4] = {E1A, E2A, E3A, E4A};
    for (int i = 0; i < 4; i++)
        if ((i > 0 && !halve(&level[i - 1], first, error)) ||
            !block(network, names[i], first, &level[i], error))
            return false;
    return true;
}

/* And back: level[i] becomes what its head sees. */
static bool go_up(const FlNetwork *network, Planes level[4], GError **error)
{
    static const Name names[3] = {D1A, D2A, D3A};
    Planes joined = {0};
    bool good = true;
    for (int i = 2; i >= 0 && good; i--)
        good = join(&level[i + 1], &level[i], &joined, error) &&
               block(network, names[i], &joined, &level[i], error);
    planes_clear(&joined);
    return good;
}

bool fl_network_run(const FlNetwork *network, const int16_t *inputs, int width, int height,
                    int16_t *const to[FL_NETWORK_HEADS], GError **error)
{
    Planes halves = {0}, first = {0}, level[4] = {{0}};
    const bool good = split(inputs, width, height, &halves, error) &&
                      stem(&network->layer[STEM], &halves, &first, error) &&
                      go_down(network, &first, level, error) && go_up(network, level, error) &&
                      head(network, O1, &level[0], to[0], error) &&
                      head(network, O2, &level[1], to[1], error) &&
                      head(network, O3, &level[2], to[2], error);
    planes_clear(&halves);
    planes_clear(&first);
    for (int i = 0; i < 4; i++)
        planes_clear(&level[i]);
    return good;
}

bool fl_network_potential(const FlNetwork *network, const int16_t *inputs, int width, int height,
                          float *potential, GError **error)
{
    g_auto(FlPotential) grids = {0};
    const size_t n = (size_t)width * (size_t)height;
    g_autofree int16_t *value = fl_alloc(n, sizeof *value, "a network", error);
    if (!value || !fl_potential_init(&grids, width, height, error))
        return false;
    int16_t *heads[FL_NETWORK_HEADS], *at = value;
    for (int h = 0; h < FL_NETWORK_HEADS; h++)
        heads[h] = at, at += fl_potential_nodes(&grids, h);
    if (!fl_network_run(network, inputs, width, height, heads, error))
        return false;
    for (int h = 0; h < FL_NETWORK_HEADS; h++)
        for (size_t i = 0; i < fl_potential_nodes(&grids, h); i++)
            grids.grid[h][i] = network->tanh_of[h][heads[h][i] + FL_NETWORK_MOST];
    fl_potential_sum(&grids, potential);
    return true;
}
