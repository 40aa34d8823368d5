#include "job/paint_cache.h"

#include "base/file.h"
#include <errno.h>
#include <fcntl.h>
#include <glib/gstdio.h>
#include <libdeflate.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utime.h>

#define MIB (1024.0 * 1024)
#define DEFAULT_MIB 8192
#define MAGIC "fluidyp1"
#define LEFT_S 3600 // an unfinished file so old is that of a process that was killed

static const char *const suffix[] = {"picture", "film", "render", "facts"};

/* The bytes before the parts. */
typedef struct Header {
    char magic[8];
    uint32_t sum, zero; // CRC-32 of the parts
} Header;

struct FlPaintCache {
    const FlRenderOptions *options;
    char *folder;
    double limit;  // bytes
    GMutex lock;   // of what follows
    char *problem; // to be told; NULL: none
    bool told;     // one was
    bool full;     // nothing can be written any more
    double added;  // bytes since the cache was last trimmed
};

FlPaintCache *fl_paint_cache_open(const FlRenderOptions *options)
{
    const char *folder = options->cache;
    if (!folder || g_str_equal(folder, "off"))
        return NULL;
    FlPaintCache *cache = g_new0(FlPaintCache, 1);
    cache->options = options;
    cache->folder = g_str_equal(folder, "auto")
                        ? g_build_filename(g_get_user_cache_dir(), "fluidy-svg", "paint", NULL)
                        : g_strdup(folder);
    cache->limit = MIB * (options->cache_size > 0 ? options->cache_size : DEFAULT_MIB);
    g_mutex_init(&cache->lock);
    return cache;
}

/* FOLDER/ab/cdef….picture: folders stay small. To be freed. */
static char *path_of(const FlPaintCache *cache, FlCacheKind kind, FlDigest name)
{
    g_autofree char *hex =
        g_strdup_printf("%016" G_GINT64_MODIFIER "x%016" G_GINT64_MODIFIER "x", name.a, name.b);
    return g_strdup_printf("%s/%.2s/%s.%s", cache->folder, hex, hex + 2, suffix[kind]);
}

/* Keeps the first problem; the caller has the lock. Takes the text. */
static void keep_problem(FlPaintCache *cache, char *text)
{
    if (cache->problem || cache->told)
        g_free(text);
    else
        cache->problem = text;
}

void fl_paint_cache_warn(FlPaintCache *cache)
{
    if (!cache)
        return;
    g_mutex_lock(&cache->lock);
    g_autofree char *text = g_steal_pointer(&cache->problem);
    cache->told = cache->told || text;
    g_mutex_unlock(&cache->lock);
    if (text && cache->options->warning)
        cache->options->warning(text, cache->options->data);
}

/* ---- files ---------------------------------------------------------------------------------- */

bool fl_paint_cache_has(const FlPaintCache *cache, FlCacheKind kind, FlDigest name)
{
    g_autofree char *path = path_of(cache, kind, name);
    return g_file_test(path, G_FILE_TEST_IS_REGULAR);
}

static bool is_whole(const char *data, gsize bytes)
{
    Header header;
    if (bytes < sizeof header)
        return false;
    memcpy(&header, data, sizeof header);
    return memcmp(header.magic, MAGIC, sizeof header.magic) == 0 &&
           header.sum == libdeflate_crc32(0, data + sizeof header, bytes - sizeof header);
}

GBytes *fl_paint_cache_get(FlPaintCache *cache, FlCacheKind kind, FlDigest name)
{
    g_autofree char *path = path_of(cache, kind, name);
    char *data = NULL;
    gsize bytes = 0;
    if (!g_file_get_contents(path, &data, &bytes, NULL))
        return NULL;
    g_autoptr(GBytes) whole = g_bytes_new_take(data, bytes);
    if (is_whole(data, bytes)) {
        (void)utime(path, NULL); // what is used last goes last
        return g_bytes_new_from_bytes(whole, sizeof(Header), bytes - sizeof(Header));
    }
    g_unlink(path);
    g_mutex_lock(&cache->lock);
    keep_problem(cache, g_strdup_printf("%s: was damaged; its paint is made again", path));
    g_mutex_unlock(&cache->lock);
    return NULL;
}

void fl_paint_cache_drop(FlPaintCache *cache, FlCacheKind kind, FlDigest name)
{
    g_autofree char *path = path_of(cache, kind, name);
    g_unlink(path);
}

/* Not synced, unlike frames: what a crash of the machine damages is seen and painted again. */
static bool write_file(const char *path, const FlSpan *parts, int n)
{
    g_autofree char *folder = g_path_get_dirname(path);
    g_autofree char *temporary = g_build_filename(folder, "new-XXXXXX", NULL);
    Header header = {MAGIC, 0, 0};
    for (int k = 0; k < n; k++)
        header.sum = libdeflate_crc32(header.sum, parts[k].data, parts[k].bytes);
    if (g_mkdir_with_parents(folder, 0777) != 0)
        return false;
    const int fd = g_mkstemp_full(temporary, O_WRONLY | O_CLOEXEC, 0666);
    if (fd < 0)
        return false;
    bool written = fl_write_all(fd, &header, sizeof header);
    for (int k = 0; k < n && written; k++)
        written = fl_write_all(fd, parts[k].data, parts[k].bytes);
    if (close(fd) == 0 && written && g_rename(temporary, path) == 0)
        return true;
    const int problem = errno;
    g_unlink(temporary);
    errno = problem;
    return false;
}

static void trim(FlPaintCache *cache);

void fl_paint_cache_put(FlPaintCache *cache, FlCacheKind kind, FlDigest name, const FlSpan *parts,
                        int n)
{
    g_autofree char *path = path_of(cache, kind, name);
    g_mutex_lock(&cache->lock);
    const bool full = cache->full;
    g_mutex_unlock(&cache->lock);
    if (full)
        return;
    const bool written = write_file(path, parts, n);
    const int problem = errno;
    g_mutex_lock(&cache->lock);
    for (int k = 0; k < n; k++)
        cache->added += (double)parts[k].bytes;
    if (!written) {
        cache->full = true;
        keep_problem(cache,
                     g_strdup_printf("%s: cannot be written: %s; this render goes on without "
                                     "keeping its paint",
                                     path, g_strerror(problem)));
    }
    if (cache->added > cache->limit / 8)
        trim(cache);
    g_mutex_unlock(&cache->lock);
}

/* ---- the limit ------------------------------------------------------------------------------ */

typedef struct KeptFile {
    char *path;
    double bytes;
    gint64 used; // nanoseconds
} KeptFile;

static void clear_kept(KeptFile *file)
{
    g_free(file->path);
}

static void list_folder(const char *folder, GArray *files)
{
    g_autoptr(GDir) dir = g_dir_open(folder, 0, NULL);
    for (const char *name; dir && (name = g_dir_read_name(dir));) {
        g_autofree char *path = g_build_filename(folder, name, NULL);
        struct stat status;
        if (lstat(path, &status) != 0 || !S_ISREG(status.st_mode))
            continue;
        bool ours = g_str_has_prefix(name, "new-");
        if (ours && status.st_mtime + LEFT_S > time(NULL))
            continue;
        for (size_t k = 0; k < G_N_ELEMENTS(suffix) && !ours; k++)
            ours = g_str_has_suffix(name, suffix[k]);
        const KeptFile file = {g_steal_pointer(&path), (double)status.st_size,
                               (gint64)status.st_mtim.tv_sec * 1000000000 + status.st_mtim.tv_nsec};
        if (ours)
            g_array_append_val(files, file);
        else
            g_free(file.path);
    }
}

static int by_use(const void *a, const void *b)
{
    const gint64 x = ((const KeptFile *)a)->used, y = ((const KeptFile *)b)->used;
    return (x > y) - (x < y);
}

/* A tenth below the limit, so that it is not met again at once. The caller has the lock. */
static void trim(FlPaintCache *cache)
{
    g_autoptr(GArray) files = g_array_new(FALSE, FALSE, sizeof(KeptFile));
    g_array_set_clear_func(files, (GDestroyNotify)clear_kept);
    double bytes = 0;
    for (int k = 0; k < 256; k++) {
        g_autofree char *folder = g_strdup_printf("%s/%02x", cache->folder, k);
        list_folder(folder, files);
    }
    for (guint k = 0; k < files->len; k++)
        bytes += g_array_index(files, KeptFile, k).bytes;
    cache->added = 0;
    if (bytes <= cache->limit)
        return;
    g_array_sort(files, by_use);
    for (guint k = 0; k < files->len && bytes > .9 * cache->limit; k++) {
        const KeptFile *file = &g_array_index(files, KeptFile, k);
        if (g_unlink(file->path) == 0)
            bytes -= file->bytes;
    }
}

void fl_paint_cache_close(FlPaintCache *cache)
{
    if (!cache)
        return;
    if (cache->added > 0)
        trim(cache);
    fl_paint_cache_warn(cache);
    g_mutex_clear(&cache->lock);
    g_free(cache->folder);
    g_free(cache);
}
