#include "params/look.h"

#include "base/error.h"
#include "base/file.h"
#include "base/limits.h"
#include <config.h> // not params/config.h

#include <errno.h>
#include <glib/gstdio.h>
#include <math.h>
#include <string.h>
#include <time.h>

enum { MOST_FILES = 4096, LONGEST_NAME = 200 };

#if HAVE_ORA
#include <zip.h>

/* A look that is being unpacked. */
typedef struct Unpacking {
    const char *path;
    const char *folder;
    zip_t *zip;
    double bytes; // so far
} Unpacking;

static bool refuse(const Unpacking *unpacking, const char *name, const char *why, GError **error)
{
    g_autofree char *shown = g_strescape(name, NULL);
    return fl_fail(error, FL_ERROR_INPUT, "%s: the file “%s” in it %s", unpacking->path, shown,
                   why);
}

/* Names that stay in the folder, of letters that every system has in names. */
static bool is_plain(const char *name)
{
    g_auto(GStrv) parts = g_strsplit(name, "/", -1);
    bool plain = strlen(name) <= LONGEST_NAME && g_utf8_validate(name, -1, NULL);
    for (char **part = parts; *part; part++)
        plain = plain && **part && **part != '.' && !strpbrk(*part, "\\:*?\"<>|");
    for (const char *c = name; *c; c++)
        plain = plain && !g_ascii_iscntrl(*c);
    return plain;
}

static bool is_of_look(const char *name)
{
    return is_plain(name) &&
           (strcmp(name, FL_LOOK_CONFIG) == 0 || strcmp(name, "thumbnail.png") == 0 ||
            g_str_has_prefix(name, "styles/") || g_str_has_prefix(name, "files/"));
}

/* Counts what comes out, whatever size the archive says. */
static bool copy_file(Unpacking *unpacking, zip_file_t *file, FILE *to, const char *name,
                      GError **error)
{
    char block[65536];
    zip_int64_t n;
    while ((n = zip_fread(file, block, sizeof block)) > 0) {
        unpacking->bytes += (double)n;
        if (!fl_limit_check(FL_LIMIT_LOOK, ceil(unpacking->bytes / (1 << 20)), unpacking->path,
                            error))
            return false;
        if (fwrite(block, 1, (size_t)n, to) != (size_t)n)
            return fl_fail(error, FL_ERROR_OUTPUT, "%s: cannot be written: %s", unpacking->folder,
                           g_strerror(errno));
    }
    return n == 0 || refuse(unpacking, name, "is damaged", error);
}

static bool unpack_file(Unpacking *unpacking, zip_uint64_t k, GError **error)
{
    const char *name = zip_get_name(unpacking->zip, k, ZIP_FL_ENC_RAW);
    if (!name || !is_of_look(name))
        return refuse(unpacking, name ? name : "",
                      "does not belong to a look; expected " FL_LOOK_CONFIG
                      ", thumbnail.png, styles/… or files/…",
                      error);
    g_autofree char *path = g_build_filename(unpacking->folder, name, NULL);
    g_autofree char *parent = g_path_get_dirname(path);
    zip_file_t *file = zip_fopen_index(unpacking->zip, k, 0);
    if (!file)
        return refuse(unpacking, name, "cannot be unpacked", error);
    FILE *to = g_mkdir_with_parents(parent, 0700) == 0 ? fopen(path, "wbx") : NULL;
    bool done = to ? copy_file(unpacking, file, to, name, error)
                   : refuse(unpacking, name, "is there twice, or cannot be written", error);
    if (to && fclose(to) != 0 && done)
        done = fl_fail(error, FL_ERROR_OUTPUT, "%s: %s", path, g_strerror(errno));
    zip_fclose(file);
    return done;
}

static bool unpack_files(Unpacking *unpacking, GError **error)
{
    const zip_int64_t n = zip_get_num_entries(unpacking->zip, 0);
    if (n > MOST_FILES)
        return fl_fail(error, FL_ERROR_LIMIT, "%s: has %d files; expected at most %d",
                       unpacking->path, (int)n, MOST_FILES);
    if (zip_name_locate(unpacking->zip, FL_LOOK_CONFIG, 0) < 0)
        return fl_fail(error, FL_ERROR_INPUT, "%s: is no look: it has no " FL_LOOK_CONFIG,
                       unpacking->path);
    for (zip_uint64_t k = 0; k < (zip_uint64_t)n; k++)
        if (!unpack_file(unpacking, k, error))
            return false;
    return true;
}

/* Removes folders of looks whose unpacking was killed more than a day ago. */
static void remove_leftovers(const char *parent)
{
    g_autoptr(GDir) dir = g_dir_open(parent, 0, NULL);
    for (const char *name; dir && (name = g_dir_read_name(dir));) {
        g_autofree char *path = g_build_filename(parent, name, NULL);
        GStatBuf about;
        if (strchr(name, '.') && g_stat(path, &about) == 0 &&
            about.st_mtime < time(NULL) - 24 * 3600)
            fl_file_remove(path, NULL);
    }
}

/* Unpacks beside the folder, which then appears whole; another process may have been faster. */
static bool unpack_beside(Unpacking *unpacking, const char *folder, GError **error)
{
    g_autofree char *beside = g_strconcat(folder, ".XXXXXX", NULL);
    g_autofree char *parent = g_path_get_dirname(folder);
    if (g_mkdir_with_parents(parent, 0700) != 0 || !g_mkdtemp(beside))
        return fl_fail(error, FL_ERROR_OUTPUT, "%s: cannot be written: %s", parent,
                       g_strerror(errno));
    remove_leftovers(parent);
    unpacking->folder = beside;
    bool done = unpack_files(unpacking, error);
    if (done && g_rename(beside, folder) != 0 && errno != EEXIST && errno != ENOTEMPTY)
        done =
            fl_fail(error, FL_ERROR_OUTPUT, "%s: cannot be written: %s", folder, g_strerror(errno));
    fl_file_remove(beside, NULL);
    return done;
}

static bool unpack(const char *path, char *bytes, size_t n, const char *folder, GError **error)
{
    zip_error_t problem;
    Unpacking unpacking = {.path = path};
    zip_error_init(&problem);
    zip_source_t *source = zip_source_buffer_create(bytes, n, 0, &problem);
    unpacking.zip = source ? zip_open_from_source(source, ZIP_RDONLY, &problem) : NULL;
    if (source && !unpacking.zip)
        zip_source_free(source);
    zip_error_fini(&problem);
    if (!unpacking.zip)
        return fl_fail(error, FL_ERROR_INPUT, "%s: is no look, which is a ZIP archive", path);
    const bool done = unpack_beside(&unpacking, folder, error);
    zip_discard(unpacking.zip);
    return done;
}

char *fl_look_unpack(const char *path, GError **error)
{
    const size_t most = (size_t)fl_limit(FL_LIMIT_LOOK) << 20;
    g_autofree char *bytes = NULL;
    size_t n;
    if (!fl_file_read(path, most, NULL, &bytes, &n, error) ||
        !fl_limit_check(FL_LIMIT_LOOK, ceil((double)n / (1 << 20)), path, error))
        return NULL;
    g_autofree char *sum = g_compute_checksum_for_data(G_CHECKSUM_SHA256, (const guchar *)bytes, n);
    g_autofree char *folder =
        g_build_filename(g_get_user_cache_dir(), "fluidy-svg", "looks", sum, NULL);
    return g_file_test(folder, G_FILE_TEST_IS_DIR) || unpack(path, bytes, n, folder, error)
               ? g_steal_pointer(&folder)
               : NULL;
}

#else

char *fl_look_unpack(const char *path, GError **error)
{
    return fl_none(error, FL_ERROR_INPUT, "%s: this build reads no looks; it needs libzip", path);
}

#endif
