#include "svg/passes.h"

#include "svg/document.h"
#include <fontconfig/fontconfig.h>

#define USUAL "Times New Roman" // librsvg's font for text without a font-family

typedef struct Wanted {
    GString *css;       // declarations of fonts, and more
    FcCharSet *letters; // of all text
} Wanted;

static void add_letters(Wanted *wanted, const xmlNode *text)
{
    g_autoptr(xmlChar) content = xmlNodeGetContent(text);
    for (const char *at = (const char *)content; at && *at; at = g_utf8_next_char(at))
        FcCharSetAddChar(wanted->letters, g_utf8_get_char(at));
}

static void add_declarations(Wanted *wanted, const xmlNode *node)
{
    static const char *const names[] = {"font-family", "font", "style"};
    for (size_t k = 0; k < G_N_ELEMENTS(names); k++) {
        const char *value = fl_attribute(node, names[k]);
        if (value)
            g_string_append_printf(wanted->css, k < 2 ? "%s:%s;" : "%.0s%s;", names[k], value);
    }
}

static void look_at(Wanted *wanted, const xmlNode *node)
{
    add_declarations(wanted, node);
    if (fl_is(node, "text"))
        add_letters(wanted, node);
    FL_EACH_ELEMENT (child, node)
        look_at(wanted, child);
}

/* The families that declarations name, as a set; of `font`, the words after the size. */
static GHashTable *families_in(const char *css)
{
    GHashTable *families = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    g_autoptr(GRegex) declaration = g_regex_new(
        "font(?:-family\\s*:|\\s*:[^;}]*?\\d\\S*\\s)([^;}]+)", G_REGEX_CASELESS, 0, NULL);
    g_autoptr(GMatchInfo) match = NULL;
    g_hash_table_add(families, g_strdup(USUAL));
    g_regex_match(declaration, css, 0, &match);
    for (; g_match_info_matches(match); g_match_info_next(match, NULL)) {
        g_autofree char *list = g_match_info_fetch(match, 1);
        g_auto(GStrv) names = g_strsplit(list, ",", -1);
        for (char **name = names; *name; name++) {
            g_strdelimit(*name, "\"'", ' ');
            g_hash_table_add(families, g_strdup(g_strstrip(*name)));
        }
    }
    return families;
}

static void add_file(GPtrArray *files, const char *path)
{
    if (!g_ptr_array_find_with_equal_func(files, path, g_str_equal, NULL))
        g_ptr_array_add(files, g_strdup(path));
}

/* The first font of a family's order, and others that have letters which those before lack. */
static void add_fonts(GPtrArray *files, const char *family, int weight, int slant,
                      const FcCharSet *letters)
{
    FcResult result;
    FcPattern *pattern =
        FcPatternBuild(NULL, FC_FAMILY, FcTypeString, family, FC_WEIGHT, FcTypeInteger, weight,
                       FC_SLANT, FcTypeInteger, slant, NULL);
    FcConfigSubstitute(NULL, pattern, FcMatchPattern);
    FcDefaultSubstitute(pattern);
    FcFontSet *fonts = FcFontSort(NULL, pattern, FcTrue, NULL, &result);
    FcCharSet *missing = FcCharSetCopy((FcCharSet *)(uintptr_t)letters); // only counted
    for (int k = 0; fonts && k < fonts->nfont && (k == 0 || FcCharSetCount(missing) > 0); k++) {
        FcCharSet *own = NULL;
        FcChar8 *path = NULL;
        if (FcPatternGetCharSet(fonts->fonts[k], FC_CHARSET, 0, &own) != FcResultMatch ||
            FcPatternGetString(fonts->fonts[k], FC_FILE, 0, &path) != FcResultMatch ||
            (k > 0 && FcCharSetIntersectCount(missing, own) == 0))
            continue;
        FcCharSet *left = FcCharSetSubtract(missing, own);
        FcCharSetDestroy(missing);
        missing = left;
        add_file(files, (const char *)path);
    }
    FcCharSetDestroy(missing);
    if (fonts)
        FcFontSetDestroy(fonts);
    FcPatternDestroy(pattern);
}

static void add_folders(GPtrArray *files)
{
    FcStrList *folders = FcConfigGetFontDirs(NULL);
    for (const FcChar8 *folder; folders && (folder = FcStrListNext(folders));)
        add_file(files, (const char *)folder);
    if (folders)
        FcStrListDone(folders);
}

/* The files for these families and letters, found once for all frames that have them; the cache's
 * own. */
static const GPtrArray *fonts_for(GHashTable *families, const FcCharSet *letters)
{
    static GHashTable *found; // letters and families -> GPtrArray *
    g_autofree const char **names = (const char **)g_hash_table_get_keys_as_array(families, NULL);
    g_autofree char *list = g_strjoinv(",", (char **)names);
    FcPattern *pattern = FcPatternBuild(NULL, FC_CHARSET, FcTypeCharSet, letters, NULL);
    FcChar8 *text = FcNameUnparse(pattern);
    g_autofree char *key = g_strdup_printf("%s %s", (const char *)text, list);
    FcStrFree(text);
    FcPatternDestroy(pattern);
    if (!found)
        found = g_hash_table_new_full(g_str_hash, g_str_equal, g_free,
                                      (GDestroyNotify)g_ptr_array_unref);
    GPtrArray *files = g_hash_table_lookup(found, key);
    if (files)
        return files;
    files = g_ptr_array_new_with_free_func(g_free);
    for (const char **name = names; *name; name++)
        for (int k = 0; k < 4; k++)
            add_fonts(files, *name, k & 1 ? FC_WEIGHT_BOLD : FC_WEIGHT_REGULAR,
                      k & 2 ? FC_SLANT_ITALIC : FC_SLANT_ROMAN, letters);
    add_folders(files);
    g_hash_table_insert(found, g_steal_pointer(&key), files);
    return files;
}

void fl_fonts_add(xmlDoc *doc, GPtrArray *files)
{
    static GMutex lock; // of what is found
    Wanted wanted = {g_string_new(NULL), FcCharSetCreate()};
    look_at(&wanted, xmlDocGetRootElement(doc));
    if (FcCharSetCount(wanted.letters) > 0) {
        g_autoptr(GHashTable) families = families_in(wanted.css->str);
        g_mutex_lock(&lock);
        const GPtrArray *fonts = fonts_for(families, wanted.letters);
        for (guint k = 0; k < fonts->len; k++)
            add_file(files, fonts->pdata[k]);
        g_mutex_unlock(&lock);
    }
    FcCharSetDestroy(wanted.letters);
    g_string_free(wanted.css, TRUE);
}
