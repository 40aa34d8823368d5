#include "base/spill.h"

#include "base/alloc.h"
#include "base/compress.h"
#include "base/error.h"
#include "base/file.h"
#include <errno.h>
#include <fcntl.h>
#include <glib/gstdio.h>
#include <stdint.h>
#include <unistd.h>

typedef struct Block {
    int64_t offset;
    size_t packed_bytes, bytes;
    bool stored;
} Block;

struct FlSpill {
    size_t n_blocks;
    Block *blocks;
};

/* The one file of all spills: with one each, a film of many regions had more than a process may
 * open. What a spill leaves is given back to the file system, but its place in the file is not used
 * again. */
static struct {
    GMutex lock;
    int n_spills; // that are alive; the file is open while there are any
    int fd;
    int64_t end;
} shared;

static bool open_file(GError **error)
{
    g_autofree char *name = g_build_filename(g_get_tmp_dir(), "fluidy-XXXXXX", NULL);
    shared.fd = g_mkstemp_full(name, O_RDWR | O_CLOEXEC, 0600);
    shared.end = 0;
    if (shared.fd < 0)
        return fl_fail(error, FL_ERROR_OUTPUT, "%s: cannot make a temporary file: %s",
                       g_get_tmp_dir(), g_strerror(errno));
    g_unlink(name);
    return true;
}

FlSpill *fl_spill_new(size_t n_blocks, GError **error)
{
    g_autoptr(GMutexLocker) locked = g_mutex_locker_new(&shared.lock);
    if (shared.n_spills == 0 && !open_file(error))
        return NULL;
    shared.n_spills++;
    FlSpill *spill = g_new0(FlSpill, 1);
    *spill = (FlSpill){.n_blocks = n_blocks, .blocks = g_new0(Block, n_blocks)};
    return spill;
}

/** Gives the room of a block back, where the file system can: best effort. */
static void give_back(const Block *block)
{
#ifdef FALLOC_FL_PUNCH_HOLE
    if (block->packed_bytes > 0)
        (void)!fallocate(shared.fd, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, block->offset,
                         (off_t)block->packed_bytes);
#else
    (void)block;
#endif
}

void fl_spill_free(FlSpill *spill)
{
    if (!spill)
        return;
    g_autoptr(GMutexLocker) locked = g_mutex_locker_new(&shared.lock);
    if (--shared.n_spills == 0)
        close(shared.fd);
    for (size_t i = 0; i < spill->n_blocks && shared.n_spills > 0; i++)
        give_back(&spill->blocks[i]);
    g_free(spill->blocks);
    g_free(spill);
}

/** A place of its own for a block. */
static int64_t reserve(size_t bytes)
{
    g_autoptr(GMutexLocker) locked = g_mutex_locker_new(&shared.lock);
    const int64_t offset = shared.end;
    shared.end += (int64_t)bytes;
    return offset;
}

bool fl_spill_put(FlSpill *spill, size_t block, const void *data, size_t bytes, GError **error)
{
    g_assert(block < spill->n_blocks);
    const FlSpan part = {(void *)(uintptr_t)data, bytes}; // const: the data is only read
    g_autoptr(GBytes) packed = fl_pack(NULL, 0, &part, 1, error);
    if (!packed)
        return false;
    const size_t packed_bytes = g_bytes_get_size(packed);
    const int64_t offset = reserve(packed_bytes);
    if (!fl_pwrite_all(shared.fd, g_bytes_get_data(packed, NULL), packed_bytes, offset))
        return fl_fail(error, FL_ERROR_OUTPUT, "%s: cannot write a temporary file: %s",
                       g_get_tmp_dir(), g_strerror(errno));
    spill->blocks[block] = (Block){offset, packed_bytes, bytes, true};
    return true;
}

static bool cannot_read(const char *why, GError **error)
{
    return fl_fail(error, FL_ERROR_INPUT, "%s: cannot read a temporary file back: %s",
                   g_get_tmp_dir(), why);
}

bool fl_spill_get(const FlSpill *spill, size_t block, void *data, size_t bytes, GError **error)
{
    g_assert(block < spill->n_blocks && spill->blocks[block].stored &&
             spill->blocks[block].bytes == bytes);
    const Block *b = &spill->blocks[block];
    g_autofree uint8_t *packed = fl_alloc_unset(b->packed_bytes, 1, "a temporary block", error);
    if (!packed)
        return false;
    if (!fl_pread_all(shared.fd, packed, b->packed_bytes, b->offset))
        return cannot_read(errno ? g_strerror(errno) : "it is shorter than what was written",
                           error);
    return fl_unpack(packed, b->packed_bytes, &(FlSpan){data, bytes}, 1) ||
           cannot_read("it is damaged", error);
}

size_t fl_spill_bytes(const FlSpill *spill, size_t block)
{
    g_assert(block < spill->n_blocks && spill->blocks[block].stored);
    return spill->blocks[block].bytes;
}
