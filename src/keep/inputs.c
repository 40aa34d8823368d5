#include "keep/inputs.h"

#include "base/error.h"
#include "base/file.h"
#include "io/pattern.h"
#include "io/picture_series.h"
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#define BLOCK_BYTES ((size_t)1 << 18)

struct FlInputs {
    GPtrArray *paths;     // char *
    GHashTable *listed;   // the same, as a set
    GHashTable *digests;  // char * -> FlDigest *: of files
    GHashTable *styles;   // likewise, of folders of styles
    GHashTable *by_inode; // of files that exist, a set of char *; NULL: not made yet
    void (*tell)(const char *path, void *data);
    void *data;
};

FlInputs *fl_inputs_new(void (*tell)(const char *path, void *data), void *data)
{
    FlInputs *inputs = g_new0(FlInputs, 1);
    inputs->paths = g_ptr_array_new_with_free_func(g_free);
    inputs->listed = g_hash_table_new(g_str_hash, g_str_equal);
    inputs->digests = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
    inputs->styles = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
    inputs->tell = tell, inputs->data = data;
    return inputs;
}

void fl_inputs_free(FlInputs *inputs)
{
    if (!inputs)
        return;
    g_hash_table_unref(inputs->listed);
    g_ptr_array_unref(inputs->paths);
    g_hash_table_unref(inputs->digests);
    g_hash_table_unref(inputs->styles);
    g_clear_pointer(&inputs->by_inode, g_hash_table_unref);
    g_free(inputs);
}

int fl_inputs_count(const FlInputs *inputs)
{
    return (int)inputs->paths->len;
}

const char *fl_inputs_path(const FlInputs *inputs, int index)
{
    return inputs->paths->pdata[index];
}

/* ---- the list -------------------------------------------------------------------------------- */

/* Returns: false if the path is listed already. */
static bool list(FlInputs *inputs, const char *path)
{
    if (g_hash_table_contains(inputs->listed, path))
        return false;
    char *copy = g_strdup(path);
    g_ptr_array_add(inputs->paths, copy);
    g_hash_table_add(inputs->listed, copy);
    g_clear_pointer(&inputs->by_inode, g_hash_table_unref);
    return true;
}

void fl_inputs_add(FlInputs *inputs, const char *path)
{
    if (path && list(inputs, path) && inputs->tell)
        inputs->tell(path, inputs->data);
}

void fl_inputs_add_quietly(FlInputs *inputs, const char *path)
{
    (void)list(inputs, path);
}

/* The folders of a style, each before its files; to be freed. */
static GPtrArray *files_of_style(const char *style)
{
    static const char *const parts[] = {"", "frames", "masks", "flow"};
    GPtrArray *files = g_ptr_array_new_with_free_func(g_free);
    for (size_t k = 0; k < G_N_ELEMENTS(parts); k++) {
        char *folder = g_build_filename(style, parts[k], NULL);
        g_autoptr(GPtrArray) names = fl_folder_names(folder, NULL);
        g_ptr_array_add(files, folder);
        for (guint i = 0; names && i < names->len; i++)
            g_ptr_array_add(files, g_build_filename(folder, names->pdata[i], NULL));
    }
    return files;
}

void fl_inputs_add_style(FlInputs *inputs, const char *folder)
{
    g_autoptr(GPtrArray) files = files_of_style(folder);
    for (guint k = 0; k < files->len; k++)
        if (g_file_test(files->pdata[k], G_FILE_TEST_IS_DIR))
            fl_inputs_add(inputs, files->pdata[k]);
        else
            (void)list(inputs, files->pdata[k]);
}

void fl_inputs_add_drawing(FlInputs *inputs, const FlDrawing *drawing)
{
    g_autofree const char **linked = fl_drawing_linked_files(drawing);
    for (int f = 0; f < fl_drawing_frames(drawing); f++)
        (void)list(inputs, fl_drawing_file(drawing, f));
    for (const char **path = linked; *path; path++)
        fl_inputs_add(inputs, *path);
}

void fl_inputs_add_frames(FlInputs *inputs, const FlDrawing *drawing, const char *pattern,
                          const char *region)
{
    fl_inputs_add(inputs, pattern);
    for (int f = 0; pattern && fl_input_is_pattern(pattern) && f < fl_drawing_frames(drawing);
         f++) {
        g_autofree char *path =
            fl_output_name(pattern, fl_drawing_number(drawing, f), region, NULL);
        fl_inputs_add(inputs, path);
    }
}

/* ---- digests --------------------------------------------------------------------------------- */

static FlDigest names_digest(const char *kind, char *const *name, int n)
{
    FlDigest digest = {0};
    fl_digest_add_text(&digest, kind);
    for (int k = 0; k < n; k++)
        fl_digest_add_text(&digest, name[k]);
    return digest;
}

static FlDigest folder_digest(const char *path)
{
    g_autoptr(GPtrArray) names = fl_folder_names(path, NULL);
    return names_digest("folder", names ? (char **)names->pdata : NULL,
                        names ? (int)names->len : 0);
}

static FlDigest pattern_digest(const char *pattern)
{
    g_autoptr(FlSeries) series = fl_series_of_pattern(pattern, NULL);
    return names_digest("pattern", series ? series->path : NULL, series ? series->n : 0);
}

FlDigest fl_file_digest(const char *path)
{
    FlDigest digest = {0};
    if (fl_input_is_pattern(path))
        return pattern_digest(path);
    if (g_file_test(path, G_FILE_TEST_IS_DIR))
        return folder_digest(path);
    size_t bytes = 0;
    const int fd = fl_open_regular(path, 0, &bytes);
    FILE *file = fd >= 0 ? fdopen(fd, "rb") : NULL;
    g_autofree uint8_t *block = g_malloc(BLOCK_BYTES);
    size_t n = file ? BLOCK_BYTES : 0;
    while (n == BLOCK_BYTES) {
        n = fread(block, 1, BLOCK_BYTES, file);
        fl_digest_add(&digest, block, n);
    }
    fl_digest_add_text(&digest, file && !ferror(file) ? "is read" : "cannot be read");
    if (file)
        fclose(file);
    return digest;
}

FlDigest fl_inputs_digest(FlInputs *inputs, const char *path)
{
    FlDigest *known = g_hash_table_lookup(inputs->digests, path);
    if (!known) {
        known = g_new(FlDigest, 1);
        *known = fl_file_digest(path);
        g_hash_table_insert(inputs->digests, g_strdup(path), known);
    }
    return *known;
}

FlDigest fl_inputs_digest_of_style(FlInputs *inputs, const char *folder)
{
    FlDigest *known = g_hash_table_lookup(inputs->styles, folder);
    if (!known) {
        g_autoptr(GPtrArray) files = files_of_style(folder);
        known = g_new0(FlDigest, 1);
        for (guint k = 0; k < files->len; k++) {
            const FlDigest digest = fl_inputs_digest(inputs, files->pdata[k]);
            fl_digest_add(known, &digest, sizeof digest);
        }
        g_hash_table_insert(inputs->styles, g_strdup(folder), known);
    }
    return *known;
}

/* ---- the guard ------------------------------------------------------------------------------- */

/* The key of a file, the same under all its names; to be freed. */
static char *inode_key(const struct stat *status)
{
    return g_strdup_printf("%ju:%ju", (uintmax_t)status->st_dev, (uintmax_t)status->st_ino);
}

/* A symlink and its target are both inputs. */
static void add_inodes(GHashTable *keys, const char *path)
{
    struct stat status;
    if (lstat(path, &status) == 0)
        g_hash_table_add(keys, inode_key(&status));
    if (stat(path, &status) == 0)
        g_hash_table_add(keys, inode_key(&status));
}

static void find_inodes(FlInputs *inputs, const FlDrawing *drawing)
{
    inputs->by_inode = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    for (int k = 0; k < fl_inputs_count(inputs); k++)
        add_inodes(inputs->by_inode, fl_inputs_path(inputs, k));
    for (const char *const *file = fl_drawing_found_files(drawing); *file; file++)
        add_inodes(inputs->by_inode, *file);
}

bool fl_inputs_may_write(FlInputs *inputs, const FlDrawing *drawing, char *output, GError **error)
{
    g_autofree char *path = output;
    struct stat status;
    if (!path || lstat(path, &status) != 0)
        return true;
    if (!inputs->by_inode)
        find_inodes(inputs, drawing);
    g_autofree char *key = inode_key(&status);
    if (!g_hash_table_contains(inputs->by_inode, key))
        return true;
    return fl_fail(error, FL_ERROR_USAGE,
                   "%s: is read by this render; expected another name for what it writes", path);
}
