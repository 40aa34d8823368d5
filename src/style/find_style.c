#include "base/error.h"
#include "style/style_folder.h"

#include "base/file.h"
#include "base/suggest.h"
#include "config.h"
#include "style/manifest.h"
#include <fluidy/style.h>

#include <string.h>

static void add_folder(GPtrArray *folders, char *folder)
{
    if (g_ptr_array_find_with_equal_func(folders, folder, g_str_equal, NULL))
        g_free(folder);
    else
        g_ptr_array_add(folders, folder);
}

/* Adds ../share of the program's folder, where a relocated package and the build folder have their
 * styles. */
static void add_beside_program(GPtrArray *folders)
{
    g_autofree char *program = g_file_read_link("/proc/self/exe", NULL);
    if (!program)
        return;
    g_autofree char *folder = g_path_get_dirname(program), *above = g_path_get_dirname(folder);
    add_folder(folders, g_build_filename(above, "share", "fluidy", "styles", NULL));
}

char **fl_style_folders(void)
{
    GPtrArray *folders = g_ptr_array_new();
    const char *own = g_getenv("FLUIDY_STYLES");
    g_auto(GStrv) listed = g_strsplit(own ? own : "", G_SEARCHPATH_SEPARATOR_S, -1);
    for (int i = 0; listed[i]; i++)
        if (listed[i][0])
            add_folder(folders, g_strdup(listed[i]));
    add_folder(folders, g_build_filename(g_get_user_data_dir(), "fluidy", "styles", NULL));
    const char *const *system = g_get_system_data_dirs();
    for (int i = 0; system[i]; i++)
        add_folder(folders, g_build_filename(system[i], "fluidy", "styles", NULL));
    add_folder(folders, g_strdup(FL_STYLE_DIR));
    add_beside_program(folders);
    g_ptr_array_add(folders, NULL);
    return (char **)g_ptr_array_free(folders, FALSE);
}

bool fl_is_style(const char *folder)
{
    g_autofree char *frames = g_build_filename(folder, "frames", NULL);
    return g_file_test(frames, G_FILE_TEST_IS_DIR);
}

/* The names of the styles in a folder, unordered. */
static void collect_names(const char *folder, GPtrArray *names)
{
    g_autoptr(GDir) dir = g_dir_open(folder, 0, NULL);
    const char *name;
    while (dir && (name = g_dir_read_name(dir))) {
        g_autofree char *path = g_build_filename(folder, name, NULL);
        if (fl_is_style(path))
            g_ptr_array_add(names, g_strdup(name));
    }
}

static void free_entry(void *data)
{
    FlStyleEntry *entry = data;
    g_free(entry->name);
    g_free(entry->path);
    g_free(entry->title);
    g_free(entry->character);
    g_free(entry);
}

/* The values of a folder's style.ini; an empty style if it is missing or broken. */
static FlStyle *read_manifest(const char *folder)
{
    g_autoptr(FlStyle) style = g_new0(FlStyle, 1);
    g_autofree char *file = g_build_filename(folder, "style.ini", NULL);
    const bool read = g_file_test(file, G_FILE_TEST_EXISTS) && fl_manifest_read(style, file, NULL);
    return read ? g_steal_pointer(&style) : g_new0(FlStyle, 1);
}

void fl_style_settings(const char *name, FlOverrides *settings)
{
    g_autofree char *folder = fl_style_find(name, NULL);
    g_autoptr(FlStyle) style = folder ? read_manifest(folder) : NULL;
    *settings = style ? style->settings : (FlOverrides){0};
    if (style)
        style->settings = (FlOverrides){0};
}

GPtrArray *fl_style_list(void)
{
    GPtrArray *entries = g_ptr_array_new_with_free_func(free_entry);
    g_autoptr(GHashTable) seen = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    g_auto(GStrv) folders = fl_style_folders();
    for (int i = 0; folders[i]; i++) {
        g_autoptr(GPtrArray) names = g_ptr_array_new_with_free_func(g_free);
        collect_names(folders[i], names);
        g_ptr_array_sort(names, fl_by_name);
        for (guint k = 0; k < names->len; k++) {
            const char *name = g_ptr_array_index(names, k);
            FlStyleEntry *entry = g_new(FlStyleEntry, 1);
            *entry = (FlStyleEntry){
                .name = g_strdup(name),
                .path = g_build_filename(folders[i], name, NULL),
                .hidden = !g_hash_table_add(seen, g_strdup(name)),
            };
            g_autoptr(FlStyle) style = read_manifest(entry->path);
            entry->title = g_steal_pointer(&style->name);
            entry->character = g_steal_pointer(&style->character);
            g_ptr_array_add(entries, entry);
        }
    }
    return entries;
}

/* Returns: true if a typed word is a style's title or its folder's name, in any case, or its number
 * without the leading zero. */
static bool is_meant(const FlStyleEntry *entry, const char *word)
{
    const char *number = entry->name + (entry->name[0] == '0');
    return !entry->hidden &&
           ((entry->title && fl_edit_distance(word, entry->title) == 0) ||
            fl_edit_distance(word, entry->name) == 0 || g_str_equal(word, number));
}

static bool contains(const char *name, const char *word)
{
    g_autofree char *in = g_ascii_strdown(name, -1), *part = g_ascii_strdown(word, -1);
    return *part && strstr(in, part);
}

/* The name by which a style may have been meant; NULL if it is far from both. */
static const char *near_name(const FlStyleEntry *entry, const char *word)
{
    if (entry->title && (fl_resembles(word, entry->title) || contains(entry->title, word)))
        return entry->title;
    return fl_resembles(word, entry->name) ? entry->name : NULL;
}

/* "; did you mean “Dry brush”?", or the list of all names if no name is similar. */
static char *other_names(const GPtrArray *entries, const char *word)
{
    const int most = 3;
    g_autoptr(GString) near = g_string_new(NULL), all = g_string_new(NULL);
    int n = 0;
    for (guint i = 0; i < entries->len; i++) {
        const FlStyleEntry *entry = entries->pdata[i];
        const char *name = entry->hidden ? NULL : near_name(entry, word);
        if (!entry->hidden)
            g_string_append_printf(all, "%s%s", all->len ? ", " : "",
                                   entry->title ? entry->title : entry->name);
        if (name && n++ < most)
            g_string_append_printf(near, "%s“%s”", near->len ? " or " : "", name);
    }
    return near->len  ? g_strdup_printf("; did you mean %s?", near->str)
           : all->len ? g_strdup_printf("; there are %s", all->str)
                      : g_strdup("");
}

/* Styles of earlier releases, and what is nearest to each. */
static const struct Retired {
    const char *number, *title, *instead;
} retired[] = {{"12", "Batik", "Pools"}, {"13", "Suminagashi", "Smoke"}};

static void set_not_found(const GPtrArray *entries, const char *name, GError **error)
{
    for (size_t i = 0; i < G_N_ELEMENTS(retired); i++)
        if (fl_edit_distance(name, retired[i].number) == 0 ||
            fl_edit_distance(name, retired[i].title) == 0) {
            fl_fail(error, FL_ERROR_STYLE,
                    "style %s, %s, does not come with the program any more: take %s",
                    retired[i].number, retired[i].title, retired[i].instead);
            return;
        }
    g_auto(GStrv) folders = fl_style_folders();
    g_autofree char *where = g_strjoinv(", ", folders);
    g_autofree char *others = other_names(entries, name);
    fl_fail(error, FL_ERROR_STYLE, "no style “%s” in %s%s", name, where, others);
}

/* The first style whose folder has the name, which is found without the others' titles; NULL: none
 * has. */
static char *named_folder(const char *name)
{
    g_auto(GStrv) folders = fl_style_folders();
    for (char **folder = folders; *folder; folder++) {
        g_autofree char *path = g_build_filename(*folder, name, NULL);
        if (*name && fl_is_style(path))
            return g_steal_pointer(&path);
    }
    return NULL;
}

char *fl_style_find(const char *name, GError **error)
{
    if (strchr(name, G_DIR_SEPARATOR) || fl_is_style(name)) {
        if (g_file_test(name, G_FILE_TEST_IS_DIR))
            return g_strdup(name);
        return fl_none(error, FL_ERROR_STYLE, "%s: no such folder: expected a style", name);
    }
    char *path = named_folder(name);
    if (path)
        return path;
    g_autoptr(GPtrArray) entries = fl_style_list();
    for (guint i = 0; i < entries->len; i++)
        if (is_meant(entries->pdata[i], name))
            return g_strdup(((FlStyleEntry *)entries->pdata[i])->path);
    set_not_found(entries, name, error);
    return NULL;
}
