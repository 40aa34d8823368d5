#include "base/frame_cache.h"

#include <string.h>

static guint digest_hash(const void *key)
{
    return (guint)((const FlDigest *)key)->a;
}

static gboolean digest_equal(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(FlDigest)) == 0;
}

void fl_frame_cache_clear(FlFrameCache *cache)
{
    g_clear_pointer(&cache->last, g_hash_table_unref);
    g_clear_pointer(&cache->now, g_hash_table_unref);
}

void fl_frame_cache_keep(FlFrameCache *cache, FlDigest digest, GArray *things)
{
    if (!cache->now)
        cache->now =
            g_hash_table_new_full(digest_hash, digest_equal, g_free, (GDestroyNotify)g_array_unref);
    g_hash_table_replace(cache->now, g_memdup2(&digest, sizeof digest), things);
}

const GArray *fl_frame_cache_find(FlFrameCache *cache, FlDigest digest)
{
    if (!fl_digest_is_known(digest))
        return NULL;
    GArray *things = cache->now ? g_hash_table_lookup(cache->now, &digest) : NULL;
    if (!things && cache->last && (things = g_hash_table_lookup(cache->last, &digest)))
        fl_frame_cache_keep(cache, digest, g_array_ref(things));
    return things;
}

void fl_frame_cache_next_frame(FlFrameCache *cache)
{
    g_clear_pointer(&cache->last, g_hash_table_unref);
    cache->last = g_steal_pointer(&cache->now);
}
