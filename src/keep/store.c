#include "keep/store.h"

#include "base/each.h"
#include "keep/sealed.h"
#include <errno.h>
#include <fcntl.h>
#include <glib/gstdio.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utime.h>

#define MIB (1024.0 * 1024)
#define DEFAULT_MIB 8192
#define LEFT_S 3600 // an unfinished file so old is that of a process that was killed

static const char *const suffix[] = {"picture", "film", "record", "facts"};

/* A picture in memory. */
typedef struct HeldPicture {
    FlDigest name;
    GBytes *bytes;
} HeldPicture;

struct FlStore {
    FlStoreOptions options; // without the folder
    char *folder;           // NULL: there is only memory
    double limit;           // bytes
    GMutex lock;            // of what follows
    GHashTable *link;       // of the pictures in `held`, by name
    GQueue held;            // of HeldPicture; the one used last is the first
    size_t held_bytes;
    char *problem; // to be reported; may be NULL
    bool reported; // one was
    bool full;     // writing has failed
    double added;  // bytes since the store was last trimmed
};

FlStore *fl_store_open(const FlStoreOptions *options)
{
    const char *folder = options->folder;
    const bool files = folder && !g_str_equal(folder, "off");
    if (!files && options->memory == 0)
        return NULL;
    FlStore *store = g_new0(FlStore, 1);
    store->options = *options;
    if (files)
        store->folder = g_str_equal(folder, "auto")
                            ? g_build_filename(g_get_user_cache_dir(), "fluidy-svg", "paint", NULL)
                            : g_strdup(folder);
    store->limit = MIB * (options->mib > 0 ? options->mib : DEFAULT_MIB);
    store->link = g_hash_table_new(fl_digest_hash, fl_digest_equal);
    g_mutex_init(&store->lock);
    return store;
}

/* ---- memory ---------------------------------------------------------------------------------- */

/* The caller has the lock. */
static void let_go(FlStore *store, GList *link)
{
    HeldPicture *held = link->data;
    g_hash_table_remove(store->link, &held->name);
    g_queue_delete_link(&store->held, link);
    store->held_bytes -= g_bytes_get_size(held->bytes);
    g_bytes_unref(held->bytes);
    g_free(held);
}

/* To be freed; NULL: it is not in memory. */
static GBytes *held_bytes(FlStore *store, FlKept kind, FlDigest name)
{
    GBytes *bytes = NULL;
    g_mutex_lock(&store->lock);
    GList *link = kind == FL_KEPT_PICTURE ? g_hash_table_lookup(store->link, &name) : NULL;
    if (link) {
        g_queue_unlink(&store->held, link);
        g_queue_push_head_link(&store->held, link);
        bytes = g_bytes_ref(((HeldPicture *)link->data)->bytes);
    }
    g_mutex_unlock(&store->lock);
    return bytes;
}

static void remember(FlStore *store, FlDigest name, const FlSpan *parts, int n)
{
    g_autoptr(GByteArray) all = g_byte_array_new();
    for (int k = 0; k < n; k++)
        g_byte_array_append(all, parts[k].data, (guint)parts[k].bytes);
    HeldPicture *held = g_new(HeldPicture, 1);
    *held = (HeldPicture){name, g_bytes_new(all->data, all->len)}; // an array has room to grow
    g_mutex_lock(&store->lock);
    GList *before = g_hash_table_lookup(store->link, &name);
    if (before)
        let_go(store, before);
    g_queue_push_head(&store->held, held);
    g_hash_table_insert(store->link, &held->name, store->held.head);
    store->held_bytes += g_bytes_get_size(held->bytes);
    while (store->held_bytes > store->options.memory)
        let_go(store, store->held.tail);
    g_mutex_unlock(&store->lock);
}

/* FOLDER/ab/cdef….picture: folders stay small. To be freed. */
static char *path_of(const FlStore *store, FlKept kind, FlDigest name)
{
    g_autofree char *hex =
        g_strdup_printf("%016" G_GINT64_MODIFIER "x%016" G_GINT64_MODIFIER "x", name.a, name.b);
    return g_strdup_printf("%s/%.2s/%s.%s", store->folder, hex, hex + 2, suffix[kind]);
}

/* Keeps the first problem; the caller has the lock. Takes the text. */
static void keep_problem(FlStore *store, char *text)
{
    if (store->problem || store->reported)
        g_free(text);
    else
        store->problem = text;
}

void fl_store_warn(FlStore *store)
{
    if (!store)
        return;
    g_mutex_lock(&store->lock);
    g_autofree char *text = g_steal_pointer(&store->problem);
    store->reported = store->reported || text;
    g_mutex_unlock(&store->lock);
    if (text && store->options.warning)
        store->options.warning(text, store->options.data);
}

/* ---- files ---------------------------------------------------------------------------------- */

bool fl_store_has(FlStore *store, FlKept kind, FlDigest name)
{
    g_autoptr(GBytes) held = held_bytes(store, kind, name);
    if (held || !store->folder)
        return held != NULL;
    g_autofree char *path = path_of(store, kind, name);
    struct stat status;
    return lstat(path, &status) == 0 && S_ISREG(status.st_mode);
}

GBytes *fl_store_get(FlStore *store, FlKept kind, FlDigest name)
{
    GBytes *held = held_bytes(store, kind, name);
    if (held || !store->folder)
        return held;
    g_autofree char *path = path_of(store, kind, name);
    bool damaged;
    GBytes *bytes = fl_sealed_read(path, &damaged);
    if (bytes)
        (void)utime(path, NULL); // the least recently used go first
    if (damaged) {
        g_unlink(path);
        g_mutex_lock(&store->lock);
        keep_problem(store, g_strdup_printf("%s: is damaged; its paint is made again", path));
        g_mutex_unlock(&store->lock);
    }
    return bytes;
}

void fl_store_drop(FlStore *store, FlKept kind, FlDigest name)
{
    g_mutex_lock(&store->lock);
    GList *link = kind == FL_KEPT_PICTURE ? g_hash_table_lookup(store->link, &name) : NULL;
    if (link)
        let_go(store, link);
    g_mutex_unlock(&store->lock);
    if (!store->folder)
        return;
    g_autofree char *path = path_of(store, kind, name);
    g_unlink(path);
}

/* Not synced, unlike frames: what a crash of the machine damages is seen and painted again. */
static bool write_file(const char *path, const FlSpan *parts, int n)
{
    g_autofree char *folder = g_path_get_dirname(path);
    g_autofree char *temporary = g_build_filename(folder, "new-XXXXXX", NULL);
    if (g_mkdir_with_parents(folder, 0777) != 0)
        return false;
    const int fd = g_mkstemp_full(temporary, O_WRONLY | O_CLOEXEC, 0666);
    if (fd < 0)
        return false;
    const bool written = fl_sealed_write(fd, parts, n);
    if (close(fd) == 0 && written && g_rename(temporary, path) == 0)
        return true;
    const int problem = errno;
    g_unlink(temporary);
    errno = problem;
    return false;
}

static void trim(FlStore *store);

void fl_store_put(FlStore *store, FlKept kind, FlDigest name, const FlSpan *parts, int n)
{
    if (kind == FL_KEPT_PICTURE && store->options.memory > 0)
        remember(store, name, parts, n);
    if (!store->folder)
        return;
    g_autofree char *path = path_of(store, kind, name);
    g_mutex_lock(&store->lock);
    const bool full = store->full;
    g_mutex_unlock(&store->lock);
    if (full)
        return;
    const bool written = write_file(path, parts, n);
    const int problem = errno;
    g_mutex_lock(&store->lock);
    for (int k = 0; k < n; k++)
        store->added += (double)parts[k].bytes;
    if (!written) {
        store->full = true;
        keep_problem(store,
                     g_strdup_printf("%s: cannot be written: %s; this render keeps no more paint",
                                     path, g_strerror(problem)));
    }
    if (store->added > store->limit / 8)
        trim(store);
    g_mutex_unlock(&store->lock);
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
static void trim(FlStore *store)
{
    g_autoptr(GArray) files = fl_array_of(KeptFile, clear_kept);
    double bytes = 0;
    for (int k = 0; k < 256; k++) {
        g_autofree char *folder = g_strdup_printf("%s/%02x", store->folder, k);
        list_folder(folder, files);
    }
    for (guint k = 0; k < files->len; k++)
        bytes += g_array_index(files, KeptFile, k).bytes;
    store->added = 0;
    if (bytes <= store->limit)
        return;
    g_array_sort(files, by_use);
    for (guint k = 0; k < files->len && bytes > .9 * store->limit; k++) {
        const KeptFile *file = &g_array_index(files, KeptFile, k);
        if (g_unlink(file->path) == 0)
            bytes -= file->bytes;
    }
}

void fl_store_close(FlStore *store)
{
    if (!store)
        return;
    if (store->added > 0)
        trim(store);
    while (store->held.tail)
        let_go(store, store->held.tail);
    g_hash_table_unref(store->link);
    fl_store_warn(store);
    g_mutex_clear(&store->lock);
    g_free(store->folder);
    g_free(store);
}
