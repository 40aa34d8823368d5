#include "keep/sealed.h"

#include "base/alloc.h"
#include "base/error.h"
#include "base/file.h"
#include <fcntl.h>
#include <libdeflate.h>
#include <string.h>
#include <unistd.h>

#define MAGIC "fluidyk1"
#define LONGEST_KEY 65536
#define MAC_BYTES 32 // of SHA-256

typedef struct Seal {
    char magic[8];
    uint32_t sum, keyed; // CRC-32 of the parts; 1: a keyed digest follows
} Seal;

static GBytes *key; // may be NULL; set once, before threads start

bool fl_sealed_read_key(GError **error)
{
    const char *path = g_getenv("FLUIDY_CACHE_KEY");
    char *data = NULL;
    size_t bytes = 0;
    g_autoptr(GError) problem = NULL;
    if (key || !path)
        return true;
    const bool read = fl_file_read(path, LONGEST_KEY, NULL, &data, &bytes, &problem);
    if (read && bytes > 0 && bytes <= LONGEST_KEY) {
        key = g_bytes_new_take(data, bytes);
        return true;
    }
    g_free(data);
    return fl_fail(error, FL_ERROR_USAGE, "FLUIDY_CACHE_KEY: %s; expected a file of 1 to %d bytes",
                   read ? path : problem->message, LONGEST_KEY);
}

static void make_mac(const FlSpan *parts, int n, uint8_t mac[MAC_BYTES])
{
    gsize bytes = MAC_BYTES, key_bytes;
    const guchar *data = g_bytes_get_data(key, &key_bytes);
    g_autoptr(GHmac) hmac = g_hmac_new(G_CHECKSUM_SHA256, data, key_bytes);
    for (int k = 0; k < n; k++)
        for (size_t at = 0; at < parts[k].bytes; at += G_MAXINT) // as GLib counts them
            g_hmac_update(hmac, (const guchar *)parts[k].data + at,
                          (gssize)MIN(parts[k].bytes - at, G_MAXINT));
    g_hmac_get_digest(hmac, mac, &bytes);
}

bool fl_sealed_write(int fd, const FlSpan *parts, int n)
{
    Seal seal = {MAGIC, 0, key != NULL};
    uint8_t mac[MAC_BYTES];
    for (int k = 0; k < n; k++)
        if (parts[k].bytes > 0) // a NULL would begin the sum anew
            seal.sum = libdeflate_crc32(seal.sum, parts[k].data, parts[k].bytes);
    if (key)
        make_mac(parts, n, mac);
    bool written =
        fl_write_all(fd, &seal, sizeof seal) && (!key || fl_write_all(fd, mac, sizeof mac));
    for (int k = 0; k < n && written; k++)
        written = fl_write_all(fd, parts[k].data, parts[k].bytes);
    return written;
}

/* Constant time, so that a digest cannot be guessed byte by byte. */
static bool is_equal(const uint8_t *a, const uint8_t *b, size_t n)
{
    uint8_t differs = 0;
    for (size_t k = 0; k < n; k++)
        differs |= a[k] ^ b[k];
    return differs == 0;
}

/* Returns: where the parts begin; 0: the file is another reader's, or damaged. */
static size_t break_seal(const uint8_t *data, size_t bytes, bool *damaged)
{
    const size_t front = sizeof(Seal) + (key ? MAC_BYTES : 0);
    uint8_t mac[MAC_BYTES];
    Seal seal;
    *damaged = true;
    if (bytes < sizeof seal)
        return 0;
    memcpy(&seal, data, sizeof seal);
    if (memcmp(seal.magic, MAGIC, sizeof seal.magic) != 0 || bytes < front)
        return 0;
    if (seal.keyed != (key != NULL)) {
        *damaged = false;
        return 0;
    }
    const FlSpan parts = {(void *)(uintptr_t)(data + front), bytes - front}; // it is only read
    if (seal.sum != libdeflate_crc32(0, parts.data, parts.bytes))
        return 0;
    *damaged = false;
    if (key)
        make_mac(&parts, 1, mac);
    return !key || is_equal(mac, data + sizeof seal, sizeof mac) ? front : 0;
}

GBytes *fl_sealed_read(const char *path, bool *damaged)
{
    size_t bytes = 0;
    bool unused = false;
    bool *bad = damaged ? damaged : &unused;
    *bad = false;
    const int fd = fl_open_regular(path, O_NOFOLLOW, &bytes);
    if (fd < 0)
        return NULL;
    uint8_t *data = fl_alloc_unset(bytes, 1, "a file of the cache", NULL);
    const bool read = data && fl_pread_all(fd, data, bytes, 0);
    close(fd);
    const size_t front = read ? break_seal(data, bytes, bad) : 0;
    *bad = *bad || !read;
    if (front == 0) {
        free(data);
        return NULL;
    }
    g_autoptr(GBytes) whole = g_bytes_new_with_free_func(data, bytes, free, data);
    return g_bytes_new_from_bytes(whole, front, bytes - front);
}
