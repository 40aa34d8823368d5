/* Digests of data in memory: names of what is kept for later, made faster than it is packed. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** 128 bits in this machine's byte order; zero: no digest. Not cryptographic: collisions are
 * unlikely but can be made on purpose. */
typedef struct FlDigest {
    uint64_t a, b;
} FlDigest;

/** Returns: true unless the digest is zero, which means unknown. */
static inline bool fl_digest_is_known(FlDigest digest)
{
    return digest.a || digest.b;
}

static inline bool fl_digest_is_same(FlDigest x, FlDigest y)
{
    return x.a == y.a && x.b == y.b;
}

/** GHashFunc and GEqualFunc of digests. */
static inline unsigned fl_digest_hash(const void *digest)
{
    return (unsigned)((const FlDigest *)digest)->a;
}

static inline int fl_digest_equal(const void *x, const void *y)
{
    return fl_digest_is_same(*(const FlDigest *)x, *(const FlDigest *)y);
}

/** Adds a piece; where it begins and ends counts, as does the order of pieces. */
void fl_digest_add(FlDigest *digest, const void *data, size_t bytes);

/** The same with a text; NULL is a piece of its own. */
void fl_digest_add_text(FlDigest *digest, const char *text);
