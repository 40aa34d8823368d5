#include "io/provenance.h"

#include "base/file.h"
#include <fcntl.h>
#include <libdeflate.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

/* "fluidy-svg provenance 1 MADE-FROM SELF". SELF is the digest of the file without SELF, and in a
 * PNG without the sum of the chunk that has it. */
#define PREFIX "fluidy-svg provenance 1 "
#define DIGITS 32
#define SELF (sizeof PREFIX - 1 + DIGITS + 1) // its offset in the mark
#define MARK_BYTES (SELF + DIGITS)
#define SUM_BYTES 4

static const uint8_t png_head[] = {0x89, 'P', 'N', 'G'};

/** A file in memory. */
typedef struct Mapped {
    uint8_t *data; // NULL: the file is empty or cannot be mapped
    size_t bytes;
} Mapped;

static Mapped map_file(int fd)
{
    struct stat info;
    if (fstat(fd, &info) != 0 || !S_ISREG(info.st_mode) || info.st_size <= 0)
        return (Mapped){0};
    const size_t bytes = (size_t)info.st_size;
    void *data = mmap(NULL, bytes, PROT_READ, MAP_SHARED, fd, 0);
    if (data == MAP_FAILED)
        return (Mapped){0};
    return (Mapped){data, bytes};
}

static void unmap(Mapped *file)
{
    if (file->data)
        munmap(file->data, file->bytes);
    *file = (Mapped){0};
}

static bool is_png(const Mapped *file)
{
    return file->data && file->bytes > sizeof png_head &&
           memcmp(file->data, png_head, sizeof png_head) == 0;
}

static void put_digits(FlDigest digest, char text[DIGITS + 1])
{
    g_snprintf(text, DIGITS + 1, "%016" G_GINT64_MODIFIER "x%016" G_GINT64_MODIFIER "x", digest.a,
               digest.b);
}

static bool take_digits(const uint8_t *text, FlDigest *digest)
{
    char half[2][DIGITS / 2 + 1] = {{0}};
    for (int k = 0; k < 2; k++)
        memcpy(half[k], text + k * DIGITS / 2, DIGITS / 2);
    return g_ascii_string_to_unsigned(half[0], 16, 0, G_MAXUINT64, &digest->a, NULL) &&
           g_ascii_string_to_unsigned(half[1], 16, 0, G_MAXUINT64, &digest->b, NULL);
}

char *fl_mark_text(FlDigest made_from)
{
    char digits[DIGITS + 1];
    if (!fl_digest_is_known(made_from))
        return NULL;
    put_digits(made_from, digits);
    return g_strdup_printf(PREFIX "%s %0*d", digits, DIGITS, 0);
}

FlDigest fl_mark_of_frame(FlDigest film, int number)
{
    fl_digest_add(&film, &number, sizeof number);
    return film;
}

/** The mark in a file; NULL if it has none. */
static const uint8_t *find_mark(const Mapped *file)
{
    const uint8_t *at =
        file->data ? memmem(file->data, file->bytes, PREFIX, sizeof PREFIX - 1) : NULL;
    const size_t least = MARK_BYTES + (is_png(file) ? SUM_BYTES : 0);
    return at && (size_t)(file->data + file->bytes - at) >= least ? at : NULL;
}

static FlDigest digest_around(const Mapped *file, const uint8_t *mark)
{
    FlDigest digest = {0};
    const uint8_t *end = mark + MARK_BYTES + (is_png(file) ? SUM_BYTES : 0);
    fl_digest_add(&digest, file->data, (size_t)(mark + SELF - file->data));
    fl_digest_add(&digest, end, (size_t)(file->data + file->bytes - end));
    return digest;
}

/* ---- sealing --------------------------------------------------------------------------------- */

static void put_sum(uint32_t sum, uint8_t out[SUM_BYTES])
{
    for (int k = 0; k < SUM_BYTES; k++)
        out[k] = (uint8_t)(sum >> (24 - 8 * k));
}

/** Writes SELF, and in a PNG the sum of the chunk. */
static bool complete(int fd, const Mapped *file, const uint8_t *mark)
{
    char self[DIGITS + 1];
    uint8_t sum[SUM_BYTES];
    put_digits(digest_around(file, mark), self);
    if (!fl_pwrite_all(fd, self, DIGITS, mark + SELF - file->data))
        return false;
    if (!is_png(file))
        return true;
    const size_t front = 4 + sizeof FL_MARK_KEY; // "tEXt" and the keyword with its NUL
    put_sum(libdeflate_crc32(0, mark - front, front + MARK_BYTES), sum); // the map has SELF
    return fl_pwrite_all(fd, sum, sizeof sum, mark + MARK_BYTES - file->data);
}

/** The last chunk of a PNG moves behind a new one with the mark. */
static bool append_to_png(int fd, size_t bytes, const char *mark)
{
    static const uint8_t last[] = {0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xae, 0x42, 0x60, 0x82};
    g_autoptr(GByteArray) out = g_byte_array_new();
    uint8_t head[SUM_BYTES], sum[SUM_BYTES] = {0};
    put_sum(sizeof FL_MARK_KEY + MARK_BYTES, head);
    g_byte_array_append(out, head, sizeof head);
    g_byte_array_append(out, (const guint8 *)"tEXt" FL_MARK_KEY, 4 + sizeof FL_MARK_KEY);
    g_byte_array_append(out, (const guint8 *)mark, MARK_BYTES);
    g_byte_array_append(out, sum, sizeof sum);
    g_byte_array_append(out, last, sizeof last);
    return fl_pwrite_all(fd, out->data, out->len, (int64_t)(bytes - sizeof last));
}

/** The last byte of a GIF moves behind a comment with the mark. */
static bool append_to_gif(int fd, size_t bytes, const char *mark)
{
    g_autofree char *out = g_strdup_printf("\x21\xfe%c%s", (int)MARK_BYTES, mark);
    return fl_pwrite_all(fd, out, MARK_BYTES + 3, (int64_t)(bytes - 1)) &&
           fl_pwrite_all(fd, "\0;", 2, (int64_t)(bytes + MARK_BYTES + 2));
}

static bool append(int fd, const Mapped *file, const char *mark)
{
    if (is_png(file))
        return append_to_png(fd, file->bytes, mark);
    return memcmp(file->data, "GIF8", 4) != 0 || append_to_gif(fd, file->bytes, mark);
}

bool fl_mark_seal(int fd, const char *mark)
{
    Mapped file = mark ? map_file(fd) : (Mapped){0};
    bool good = !mark || file.bytes > SUM_BYTES;
    if (file.data && !find_mark(&file)) {
        good = append(fd, &file, mark);
        unmap(&file);
        file = map_file(fd);
    }
    const uint8_t *at = find_mark(&file);
    good = good && (!at || complete(fd, &file, at));
    unmap(&file);
    return good;
}

/* ---- reading --------------------------------------------------------------------------------- */

FlMark fl_mark_read(const char *path, FlDigest *made_from)
{
    const int fd = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    Mapped file = fd >= 0 ? map_file(fd) : (Mapped){0};
    FlMark state = file.data ? FL_MARK_NONE : FL_MARK_MISSING;
    const uint8_t *mark = find_mark(&file);
    FlDigest self;
    if (mark && take_digits(mark + sizeof PREFIX - 1, made_from) && take_digits(mark + SELF, &self))
        state =
            fl_digest_is_same(self, digest_around(&file, mark)) ? FL_MARK_WHOLE : FL_MARK_ALTERED;
    unmap(&file);
    if (fd >= 0)
        close(fd);
    return state;
}

bool fl_mark_is(const char *path, FlDigest made_from)
{
    FlDigest found;
    return fl_mark_read(path, &found) == FL_MARK_WHOLE && fl_digest_is_same(found, made_from);
}
