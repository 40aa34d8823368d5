#include "io/cryptomatte.h"

#include <string.h>

static guint32 turned(guint32 value, int bits)
{
    return value << bits | value >> (32 - bits);
}

static guint32 mixed(guint32 word)
{
    return turned(word * 0xcc9e2d51u, 15) * 0x1b873593u;
}

/* MurmurHash3_x86_32 with seed 0. */
static guint32 hash_of(const char *text)
{
    const guint8 *bytes = (const guint8 *)text;
    const size_t n = strlen(text);
    guint32 hash = 0, last = 0;
    for (size_t i = 0; i + 4 <= n; i += 4) {
        const guint32 word = bytes[i] | (guint32)bytes[i + 1] << 8 | (guint32)bytes[i + 2] << 16 |
                             (guint32)bytes[i + 3] << 24;
        hash = turned(hash ^ mixed(word), 13) * 5 + 0xe6546b64u;
    }
    for (size_t i = n; i-- > n / 4 * 4;)
        last = last << 8 | bytes[i];
    hash ^= mixed(last);
    hash ^= (guint32)n;
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

guint32 fl_matte_id(const char *name)
{
    const guint32 hash = hash_of(name), exponent = hash >> 23 & 255;
    return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

char *fl_mattes_key(const char *attribute)
{
    g_autofree char *hash = g_strdup_printf("%08x", hash_of(FL_MATTES));
    return g_strdup_printf("cryptomatte/%.7s/%s", hash, attribute);
}

void fl_matte_row_begin(FlMatteRow row)
{
    memset(row.value, 0, sizeof *row.value * FL_MATTES_CHANNELS * (size_t)row.width);
    for (int x = 0; x < row.width; x++)
        row.light[x] = 1;
}

/* Adds to the share of an id, and keeps the shares sorted; a new id may replace the last one. */
static void add_share(FlMatteRow row, int x, guint32 id, float share)
{
    const union {
        guint32 u;
        float f;
    } name = {id};
    const size_t step = 2 * (size_t)row.width; // from rank to rank
    float *ids = row.value + x, *shares = ids + row.width;
    int k = 0;
    while (k < FL_MATTES_RANKS - 1 && shares[k * step] > 0 && ids[k * step] != name.f)
        k++;
    if (ids[k * step] == name.f)
        share += shares[k * step];
    else if (shares[k * step] >= share)
        return;
    for (; k > 0 && shares[(k - 1) * step] < share; k--) {
        ids[k * step] = ids[(k - 1) * step];
        shares[k * step] = shares[(k - 1) * step];
    }
    ids[k * step] = name.f, shares[k * step] = share;
}

void fl_matte_row_add(FlMatteRow row, guint32 id, const guint8 *alpha)
{
    for (int x = 0; x < row.width; x++) {
        const float covers = alpha[4 * x] / 255.0f;
        if (alpha[4 * x] > 0 && row.light[x] > 0)
            add_share(row, x, id, covers * row.light[x]);
        row.light[x] *= 1 - covers;
    }
}
