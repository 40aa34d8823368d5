/* Looks: how a film is painted, with all files that this takes, in one file. */
#include "base/error.h"
#include "base/file.h"
#include "base/limits.h"
#include "config.h"
#include "io/archive.h"
#include "io/png.h"
#include "params/config.h"
#include "params/keys.h"
#include "params/look.h"
#include "params/options.h"
#include "render/frames.h"
#include "style/style_folder.h"
#include <fluidy/fluidy.h>

#include <math.h>
#include <string.h>

#if HAVE_ORA

#define THUMBNAIL_PX 320

/* A look that is being packed. */
typedef struct Packing {
    FlArchive archive;
    GHashTable *names; // file or folder -> its name in the look
    double bytes;
    GBytes *thumbnail;
} Packing;

static bool add_file(Packing *packing, const char *path, const char *name, GError **error)
{
    char *data = NULL;
    size_t bytes;
    if (!fl_file_read(path, (size_t)fl_limit(FL_LIMIT_LOOK) << 20, NULL, &data, &bytes, error))
        return false;
    packing->bytes += (double)bytes;
    return fl_archive_add(&packing->archive, name, g_bytes_new_take(data, bytes)) &&
           fl_limit_check(FL_LIMIT_LOOK, ceil(packing->bytes / (1 << 20)), path, error);
}

/* Adds the regular files of a folder. */
static bool add_folder(Packing *packing, const char *folder, const char *name, GError **error)
{
    g_autoptr(GDir) dir = g_dir_open(folder, 0, NULL);
    g_autoptr(GPtrArray) files = g_ptr_array_new_with_free_func(g_free);
    for (const char *file; dir && (file = g_dir_read_name(dir));)
        g_ptr_array_add(files, g_strdup(file));
    g_ptr_array_sort(files, fl_by_name);
    for (guint k = 0; k < files->len; k++) {
        const char *file = files->pdata[k];
        g_autofree char *path = g_build_filename(folder, file, NULL);
        g_autofree char *inside = g_strdup_printf("%s/%s", name, file);
        if (*file != '.' && g_file_test(path, G_FILE_TEST_IS_REGULAR) &&
            !add_file(packing, path, inside, error))
            return false;
    }
    return true;
}

/* The name in the look of a file or folder, which is new if *is_new. Letters that some system lacks
 * in names are replaced. */
static const char *name_of(Packing *packing, const char *parent, const char *path, bool *is_new)
{
    const char *known = g_hash_table_lookup(packing->names, path);
    *is_new = !known;
    if (known)
        return known;
    g_autofree char *base = g_path_get_basename(path);
    for (char *c = base; *c; c++)
        if (!g_ascii_isalnum(*c) && !strchr("-_.", *c))
            *c = '_';
    char *name = g_strdup_printf("%s/%u-%s", parent, g_hash_table_size(packing->names) + 1, base);
    g_hash_table_insert(packing->names, g_strdup(path), name);
    return name;
}

/* Styles that come with the program stay names. */
static bool comes_along(const char *folder)
{
    g_auto(GStrv) folders = fl_style_folders();
    g_autofree char *parent = g_path_get_dirname(folder);
    const guint n = g_strv_length(folders);
    return g_str_equal(parent, FL_STYLE_DIR) || g_str_equal(parent, folders[n - 1]);
}

/* The name of a style in the look; to be freed. */
static char *pack_style(Packing *packing, const char *style, const char *folder, GError **error)
{
    static const char *const parts[] = {"", "frames", "masks", "flow"};
    g_autofree char *beside = folder ? g_build_filename(folder, style, NULL) : NULL;
    g_autofree char *path = beside && g_file_test(beside, G_FILE_TEST_IS_DIR)
                                ? g_steal_pointer(&beside)
                                : fl_style_find(style, error);
    bool is_new;
    if (!path || comes_along(path))
        return path ? g_strdup(style) : NULL;
    const char *name = name_of(packing, "styles", path, &is_new);
    for (size_t k = 0; k < G_N_ELEMENTS(parts) && is_new; k++) {
        g_autofree char *part = g_build_filename(path, parts[k], NULL);
        g_autofree char *inside =
            *parts[k] ? g_strdup_printf("%s/%s", name, parts[k]) : g_strdup(name);
        if (!add_folder(packing, part, inside, error))
            return NULL;
    }
    return g_strdup(name);
}

/* Each style of a value with keys, such as 02@1 wash@40~6. */
static char *pack_styles(Packing *packing, const char *value, const char *folder, GError **error)
{
    if (!fl_keys_are(value))
        return pack_style(packing, value, folder, error);
    g_auto(GStrv) words = g_strsplit_set(value, " \t", -1);
    for (char **word = words; *word; word++) {
        char *at = strrchr(*word, '@');
        g_autofree char *style = at ? g_strndup(*word, (gsize)(at - *word)) : NULL;
        g_autofree char *name = style ? pack_style(packing, style, folder, error) : NULL;
        if (style && !name)
            return NULL;
        char *keyed = style ? g_strconcat(name, at, NULL) : g_strdup(*word);
        g_free(*word);
        *word = keyed;
    }
    return g_strjoinv(" ", words);
}

/* An FlConfigPath: words and colours stay, files are packed. */
static char *pack_path(const FlOption *option, const char *value, const char *folder, void *data,
                       GError **error)
{
    Packing *packing = data;
    bool is_new;
    if (option->type == FL_OPTION_STYLE)
        return pack_styles(packing, value, folder, error);
    if (!g_file_test(value, G_FILE_TEST_IS_REGULAR)) {
        g_autofree char *words = fl_option_words(option);
        g_auto(GStrv) word = g_strsplit(words ? words : "", " ", -1);
        if (*value == '#' || g_strv_contains((const char *const *)word, value))
            return g_strdup(value);
        return fl_none(error, FL_ERROR_USAGE, "%s: ‘%s’ in a look is one file; expected no pattern",
                       value, option->name);
    }
    const char *name = name_of(packing, "files", value, &is_new);
    return !is_new || add_file(packing, value, name, error) ? g_strdup(name) : NULL;
}

/* An FlTakeFrame: the last one stays. */
static bool take_thumbnail(void *taker, const FlSinkFrame *frame, int width, int height,
                           GError **error)
{
    Packing *packing = taker;
    const FlPng png = {.width = width, .height = height, .rgba = frame->rgba};
    g_clear_pointer(&packing->thumbnail, g_bytes_unref);
    packing->thumbnail = fl_png_encode(&png);
    return packing->thumbnail ||
           fl_fail(error, FL_ERROR_NO_MEMORY, "not enough memory for a thumbnail");
}

static bool pack(Packing *packing, const FlConfig *config, const FlRenderOptions *options,
                 GError **error)
{
    FlRenderOptions small = *options, whole = *options;
    small.width = THUMBNAIL_PX, small.height = 0, small.scale = 0;
    small.note = NULL; // the thumbnail's paint is no frame of a file
    if (!small.frames)
        small.frames = "~1";
    for (int i = 0; i < fl_option_count(); i++) { // without the defaults
        const FlOption *option = fl_option_at(i);
        if (option->scope == FL_SCOPE_RENDER && !fl_option_is_set(option, &whole))
            fl_option_copy(option, &config->project, &whole);
    }
    g_autofree char *text = fl_config_text(config, &whole, pack_path, packing, error);
    return text && fl_render_frames(&small, take_thumbnail, packing, error) &&
           fl_archive_add_text(&packing->archive, FL_LOOK_CONFIG, text) &&
           (options->dry_run || fl_archive_add(&packing->archive, "thumbnail.png",
                                               g_steal_pointer(&packing->thumbnail)));
}

static bool store(FlArchive *archive, const char *path, bool overwrite, GError **error)
{
    FlAtomicFile file;
    if (!fl_atomic_open(&file, path, overwrite, error))
        return false;
    const bool stored =
        (fl_archive_store(archive, file.stream) ||
         fl_fail(error, FL_ERROR_OUTPUT, "%s: cannot be written; is the disk full?", path)) &&
        fl_atomic_commit(&file, error);
    fl_atomic_clear(&file);
    return stored;
}

bool fl_save_look(const FlRenderOptions *given, const char *path, GError **error)
{
    FlRenderOptions options;
    Packing packing = {0};
    if (!fl_options_take(given, &options, error))
        return false;
    const bool overwrite = options.overwrite == FL_OVERWRITE_YES;
    if (!fl_look_named(path))
        return fl_fail(error, FL_ERROR_USAGE, "%s: expected a name such as wash" FL_LOOK_SUFFIX,
                       path);
    if (!overwrite && !fl_check_not_exists(path, error))
        return false;
    g_autoptr(FlConfig) config = fl_config_load(options.config, &options, error);
    if (!config || !fl_config_give(config, options.settings, options.n_settings, error))
        return false;
    packing.names = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
    GError *problem = NULL;
    const bool saved = fl_archive_open(&packing.archive) &&
                       pack(&packing, config, &options, &problem) &&
                       (options.dry_run || store(&packing.archive, path, overwrite, &problem));
    if (!saved && !problem)
        fl_fail(&problem, FL_ERROR_NO_MEMORY, "not enough memory for a look");
    fl_archive_clear(&packing.archive);
    g_hash_table_unref(packing.names);
    g_clear_pointer(&packing.thumbnail, g_bytes_unref);
    if (problem)
        g_propagate_error(error, problem);
    const FlCaller caller = fl_caller_of(&options);
    if (saved)
        fl_note(&caller, "%s the look: %s", options.dry_run ? "would save" : "saved", path);
    return saved;
}

#else

bool fl_save_look(const FlRenderOptions *given, const char *path, GError **error)
{
    return fl_fail(error, FL_ERROR_USAGE, "this build saves no looks; it needs libzip");
}

#endif
