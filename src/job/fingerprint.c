#include "job/fingerprint.h"

#include "base/build_id.h"
#include "base/file.h"
#include "base/style_parts.h"
#include "config.h"
#include "io/pattern.h"
#include "io/picture_file.h"
#include <cairo.h>
#include <librsvg/rsvg.h>
#include <string.h>

#define FACTS G_VARIANT_TYPE("a(ss)")
#define SUM "sha256 " // a value that starts so is no use to a reader

static void clear_fact(FlFact *fact)
{
    g_free(fact->name);
    g_free(fact->value);
}

FlFingerprint *fl_fingerprint_new_empty(void)
{
    FlFingerprint *print = g_new0(FlFingerprint, 1);
    print->facts = g_array_new(FALSE, TRUE, sizeof(FlFact));
    g_array_set_clear_func(print->facts, (GDestroyNotify)clear_fact);
    return print;
}

void fl_fingerprint_free(FlFingerprint *print)
{
    if (!print)
        return;
    g_array_unref(print->facts);
    g_free(print);
}

void fl_fingerprint_add(FlFingerprint *print, const char *name, const char *value)
{
    const FlFact fact = {g_utf8_make_valid(name, -1),
                         g_utf8_make_valid(value ? value : "not set", -1)};
    g_array_append_val(print->facts, fact);
}

static void add_number(FlFingerprint *print, const char *name, double value)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    fl_fingerprint_add(print, name, g_ascii_dtostr(text, sizeof text, value));
}

/* ---- files ---------------------------------------------------------------------------------- */

static bool mix_file(GChecksum *sum, const char *path, GError **error)
{
    g_autofree char *contents = NULL;
    size_t bytes;
    GError *problem = NULL;
    if (!fl_file_check(path, FL_ERROR_INPUT, error))
        return false;
    if (!g_file_get_contents(path, &contents, &bytes, &problem)) {
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s", problem->message);
        g_error_free(problem);
        return false;
    }
    g_checksum_update(sum, (const guchar *)contents, (gssize)bytes);
    return true;
}

static void add_sum(FlFingerprint *print, const char *name, GChecksum *sum)
{
    g_autofree char *value = g_strconcat(SUM, g_checksum_get_string(sum), NULL);
    fl_fingerprint_add(print, name, value);
}

/* The folder of a film may move; the names in it may not. */
static bool add_file(FlFingerprint *print, const char *path, GError **error)
{
    g_autoptr(GChecksum) sum = g_checksum_new(G_CHECKSUM_SHA256);
    g_autofree char *name = g_path_get_basename(path);
    if (!mix_file(sum, path, error))
        return false;
    add_sum(print, name, sum);
    return true;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* Names and contents of a folder's files, in the order of their names; no folder, no files. */
static bool mix_folder(GChecksum *sum, const char *folder, GError **error)
{
    g_autoptr(GDir) dir = g_dir_open(folder, 0, NULL);
    g_autoptr(GPtrArray) names = g_ptr_array_new_with_free_func(g_free);
    for (const char *name; dir && (name = g_dir_read_name(dir));)
        g_ptr_array_add(names, g_strdup(name));
    g_ptr_array_sort(names, by_name);
    for (guint i = 0; i < names->len; i++) {
        g_autofree char *path = g_build_filename(folder, names->pdata[i], NULL);
        if (!g_file_test(path, G_FILE_TEST_IS_REGULAR))
            continue;
        g_checksum_update(sum, names->pdata[i], (gssize)strlen(names->pdata[i]) + 1);
        if (!mix_file(sum, path, error))
            return false;
    }
    return true;
}

static bool add_style(FlFingerprint *print, const char *path, GError **error)
{
    static const char *const parts[] = {FL_STYLE_PARTS};
    g_autoptr(GChecksum) sum = g_checksum_new(G_CHECKSUM_SHA256);
    for (size_t i = 0; i < G_N_ELEMENTS(parts); i++) {
        g_autofree char *folder = g_build_filename(path, parts[i], NULL);
        if (!mix_folder(sum, folder, error))
            return false;
    }
    g_autofree char *base = g_path_get_basename(path);
    g_autofree char *name = g_strconcat("style ", base, NULL);
    add_sum(print, name, sum);
    return true;
}

/* ---- the parts of a plan -------------------------------------------------------------------- */

static void add_versions(FlFingerprint *print)
{
    g_autofree char *rsvg =
        g_strdup_printf("%u.%u.%u", rsvg_major_version, rsvg_minor_version, rsvg_micro_version);
    fl_fingerprint_add(print, "the version of fluidy-svg", FL_VERSION);
    fl_fingerprint_add(print, "the version of librsvg", rsvg);
    fl_fingerprint_add(print, "the version of cairo", cairo_version_string());
    add_number(print, "the byte order", G_BYTE_ORDER);
}

/* Pictures and drawings that the frames refer to. */
static bool add_linked(FlFingerprint *print, const FlDrawing *drawing, GError **error)
{
    g_autoptr(GPtrArray) paths = g_ptr_array_new();
    GHashTableIter at;
    gpointer path;
    g_hash_table_iter_init(&at, fl_drawing_linked_files(drawing));
    while (g_hash_table_iter_next(&at, &path, NULL))
        g_ptr_array_add(paths, path);
    g_ptr_array_sort(paths, by_name);
    for (guint k = 0; k < paths->len; k++)
        if (g_file_test(paths->pdata[k], G_FILE_TEST_IS_REGULAR) &&
            !add_file(print, paths->pdata[k], error))
            return false;
    return true;
}

static bool add_drawings(FlFingerprint *print, const FlDrawing *drawing, GError **error)
{
    add_number(print, "the number of frames", fl_drawing_frames(drawing));
    print->first_drawing = print->facts->len;
    for (int f = 0; f < fl_drawing_frames(drawing); f++)
        if (!add_file(print, fl_drawing_file(drawing, f), error))
            return false;
    if (!add_linked(print, drawing, error))
        return false;
    print->n_linked = print->facts->len - print->first_drawing - (guint)fl_drawing_frames(drawing);
    return true;
}

/* Those that decide frames, or those that decide paint. */
static void add_values(FlFingerprint *print, FlOptionScope scope, const void *object,
                       const char *region, bool of_frames)
{
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (option->scope != scope ||
            (option->bytes != FL_BYTES_VALUE && !(of_frames && option->bytes == FL_BYTES_FRAME)))
            continue;
        g_autofree char *value = fl_option_get(option, object);
        // the folder of a style may move; its contents may not change
        g_autofree char *base =
            value && option->type == FL_OPTION_STYLE ? g_path_get_basename(value) : NULL;
        g_autofree char *name =
            region ? g_strdup_printf("%s of region %s", option->name, region) : NULL;
        fl_fingerprint_add(print, name ? name : option->name, base ? base : value);
    }
}

void fl_fingerprint_add_options(FlFingerprint *print, FlOptionScope scope, const void *object,
                                const char *region)
{
    add_values(print, scope, object, region, true);
}

/* What an option's value leads to, and then the values. */
static void add_options(FlFingerprint *print, const FlPlan *plan)
{
    fl_fingerprint_add(print, "the format", plan->format->name);
    add_number(print, "the first frame's number", fl_drawing_number(plan->drawing, 0));
    add_number(print, "the width", plan->width);
    add_number(print, "the height", plan->height);
    add_number(print, "the hold", plan->hold);
    fl_fingerprint_add_options(print, FL_SCOPE_RENDER, &plan->options, NULL);
}

/* The files of an option that is a pattern of one file per frame, or one file. */
static bool add_pattern(FlFingerprint *print, const FlPlan *plan, const char *pattern,
                        const char *region, GError **error)
{
    const bool itself = g_file_test(pattern, G_FILE_TEST_EXISTS);
    const bool each = fl_input_is_pattern(pattern);
    const int first = each ? plan->first : 0, end = each ? plan->end : 1;
    g_autoptr(GChecksum) sum = g_checksum_new(G_CHECKSUM_SHA256);
    for (int f = first; f < end; f++) {
        g_autofree char *file =
            itself ? g_strdup(pattern)
                   : fl_output_name(pattern, fl_drawing_number(plan->drawing, f), region, error);
        if (!file)
            return false;
        if (g_file_test(file, G_FILE_TEST_IS_REGULAR) && !mix_file(sum, file, error))
            return false; // what is missing is told where it is used
    }
    add_sum(print, pattern, sum);
    return true;
}

static bool add_painted(FlFingerprint *print, const FlPlan *plan, GError **error)
{
    for (int p = 0; p < plan->n_painted; p++) {
        const FlRegionPlan *painted = &plan->painted[p];
        fl_fingerprint_add_options(print, FL_SCOPE_REGION, &painted->settings, painted->name);
        if (painted->flow_files &&
            !add_pattern(print, plan, painted->flow_files, painted->name, error))
            return false;
        if (painted->paint_files &&
            !add_pattern(print, plan, painted->paint_files, painted->name, error))
            return false;
        bool known = false;
        for (int q = 0; q < p; q++)
            known = known || g_str_equal(plan->painted[q].style->path, painted->style->path);
        if (!known && !add_style(print, painted->style->path, error))
            return false;
        if (painted->tile && !add_style(print, painted->tile->path, error))
            return false;
    }
    return true;
}

/* Which leaves a region is made of shows in its figures. */
static void add_leaves(FlFingerprint *print, const FlRegion *region)
{
    char area[G_ASCII_DTOSTR_BUF_SIZE];
    g_autofree char *name = g_strdup_printf("what region %s is made of", region->name);
    g_autofree char *value =
        g_strdup_printf("%s, %s, %d leaves in %d frames from %d on, %s px", region->label,
                        region->paint, region->n_leaves, region->n_present, region->first_frame,
                        g_ascii_dtostr(area, sizeof area, region->area_px));
    fl_fingerprint_add(print, name, value);
}

static void add_regions(FlFingerprint *print, const FlPlan *plan)
{
    for (int r = 0; r < fl_drawing_regions(plan->drawing); r++) {
        const FlRegion *region = fl_drawing_region(plan->drawing, r);
        g_autofree char *name = g_strdup_printf("what becomes of region %s", region->name);
        add_leaves(print, region);
        fl_fingerprint_add(print, name,
                           plan->painted_of[r] >= 0                   ? "painted"
                           : plan->painted_of[r] == FL_DRAWN_AS_IT_IS ? "drawn"
                                                                      : "left out");
        const FlRegionHand hand = plan->hands[r];
        g_autofree char *line = g_strdup_printf("line and line-boil of region %s", region->name);
        g_autofree char *drawn = g_strdup_printf("%d, %d", hand.line, hand.boil);
        if (hand.line != FL_LINE_PLAIN)
            fl_fingerprint_add(print, line, drawn);
    }
}

FlFingerprint *fl_fingerprint_new(const FlPlan *plan, GError **error)
{
    g_autoptr(FlFingerprint) print = fl_fingerprint_new_empty();
    const char *background = plan->options.background, *paper = plan->options.paper;
    add_versions(print);
    add_options(print, plan);
    if (!add_drawings(print, plan->drawing, error))
        return NULL;
    add_regions(print, plan); // after what may be the reason
    if (paper && g_file_test(paper, G_FILE_TEST_IS_REGULAR) && !add_file(print, paper, error))
        return NULL;
    if (!add_painted(print, plan, error) || (background && fl_picture_named(background) &&
                                             !add_pattern(print, plan, background, NULL, error)))
        return NULL;
    return g_steal_pointer(&print);
}

/* ---- the paint of one region ------------------------------------------------------------------
 */

/* The build stands for the method and for all that it is made from. */
static void add_method(FlFingerprint *print, const FlShapes *shapes, const FlRegionPlan *painted)
{
    fl_fingerprint_add(print, "the build of fluidy-svg", fl_build_id());
    add_versions(print);
    fl_fingerprint_add(print, "the engine", painted->engine->name);
    add_number(print, "the seed", (double)shapes->seed);
    fl_fingerprint_add(print, "the region's name", painted->name);
    add_number(print, "the number of frames", shapes->n_frames);
    add_number(print, "the width of the paint", shapes->width);
    add_number(print, "the height of the paint", shapes->height);
    add_number(print, "whether it is a loop", painted->loops);
}

/* A style's sum is made once for all regions that have it. */
static bool add_style_once(FlFingerprint *print, const char *path, GHashTable *sums, GError **error)
{
    FlFingerprint *sum = g_hash_table_lookup(sums, path);
    if (!sum) {
        sum = fl_fingerprint_new_empty();
        g_hash_table_insert(sums, g_strdup(path), sum);
        if (!add_style(sum, path, error))
            return false;
    }
    for (guint k = 0; k < sum->facts->len; k++) {
        const FlFact *fact = &g_array_index(sum->facts, FlFact, k);
        fl_fingerprint_add(print, fact->name, fact->value);
    }
    return true;
}

/* Where its paint goes on into other shapes, all of which a guide of its depth may know. */
static void add_joins(FlFingerprint *print, const FlPlan *plan)
{
    g_autoptr(GString) joins = g_string_new(NULL);
    for (int r = 0; r < fl_drawing_regions(plan->drawing); r++)
        g_string_append_c(joins, (char)('0' + plan->joins[r]));
    fl_fingerprint_add(print, "which edges are shared", joins->str);
}

GHashTable *fl_style_sums_new(void)
{
    return g_hash_table_new_full(g_str_hash, g_str_equal, g_free,
                                 (GDestroyNotify)fl_fingerprint_free);
}

FlFingerprint *fl_fingerprint_of_method(const FlShapes *shapes, const FlRegionPlan *painted,
                                        GHashTable *styles, GError **error)
{
    g_autoptr(FlFingerprint) print = fl_fingerprint_new_empty();
    add_method(print, shapes, painted);
    add_values(print, FL_SCOPE_REGION, &painted->settings, NULL, false);
    if (!add_style_once(print, painted->style->path, styles, error) ||
        (painted->tile && !add_style_once(print, painted->tile->path, styles, error)))
        return NULL;
    return g_steal_pointer(&print);
}

bool fl_fingerprint_add_film(FlFingerprint *print, const FlPlan *plan, int p,
                             const FlFingerprint *whole, GError **error)
{
    const FlRegionPlan *painted = &plan->painted[p];
    const guint n = (guint)fl_drawing_frames(plan->drawing) + whole->n_linked;
    for (guint k = whole->first_drawing; k < whole->first_drawing + n; k++) {
        const FlFact *fact = &g_array_index(whole->facts, FlFact, k);
        fl_fingerprint_add(print, fact->name, fact->value);
    }
    for (int f = 0; f < fl_drawing_frames(plan->drawing); f++) // layers of one file differ in it
        add_number(print, "the number of a frame", fl_drawing_number(plan->drawing, f));
    add_values(print, FL_SCOPE_RENDER, &plan->options, NULL, false);
    add_number(print, "the hold", plan->hold);
    add_joins(print, plan);
    for (int r = 0; r < fl_drawing_regions(plan->drawing); r++)
        add_leaves(print, fl_drawing_region(plan->drawing, r));
    return !painted->flow_files ||
           add_pattern(print, plan, painted->flow_files, painted->name, error);
}

GBytes *fl_fingerprint_pack(const FlFingerprint *print)
{
    GVariantBuilder facts;
    g_variant_builder_init(&facts, FACTS);
    for (guint i = 0; i < print->facts->len; i++) {
        const FlFact *fact = &g_array_index(print->facts, FlFact, i);
        g_variant_builder_add(&facts, "(ss)", fact->name, fact->value);
    }
    g_autoptr(GVariant) variant = g_variant_ref_sink(g_variant_builder_end(&facts));
    return g_variant_get_data_as_bytes(variant);
}

FlFingerprint *fl_fingerprint_unpack(GBytes *bytes)
{
    g_autoptr(GVariant) variant = g_variant_ref_sink(g_variant_new_from_bytes(FACTS, bytes, FALSE));
    if (!g_variant_is_normal_form(variant))
        return NULL;
    FlFingerprint *print = fl_fingerprint_new_empty();
    const char *name, *value;
    GVariantIter at;
    g_variant_iter_init(&at, variant);
    while (g_variant_iter_next(&at, "(&s&s)", &name, &value))
        fl_fingerprint_add(print, name, value);
    return print;
}

FlDigest fl_fingerprint_digest(const FlFingerprint *print)
{
    FlDigest digest = {0};
    for (guint k = 0; k < print->facts->len; k++) {
        const FlFact *fact = &g_array_index(print->facts, FlFact, k);
        fl_digest_add_text(&digest, fact->name);
        fl_digest_add_text(&digest, fact->value);
    }
    return digest;
}

/* ---- what was asked for -----------------------------------------------------------------------
 */

/* Those that decide bytes in whatever way; not how frames become a film. */
static void add_requested(FlFingerprint *print, const FlRenderOptions *options)
{
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (option->scope != FL_SCOPE_RENDER || option->bytes == FL_BYTES_NEVER ||
            g_str_equal(option->name, "format") || g_str_equal(option->name, "fps"))
            continue;
        g_autofree char *value = fl_option_get(option, options);
        fl_fingerprint_add(print, option->name, value);
    }
    for (size_t i = 0; i < options->n_settings; i++) {
        const FlSetting *setting = &options->settings[i];
        fl_fingerprint_add(print, "region", setting->region);
        fl_fingerprint_add(print, setting->name, setting->value);
    }
}

FlDigest fl_fingerprint_of_request(const FlPlan *plan, const FlSequence *sequence)
{
    g_autoptr(FlFingerprint) print = fl_fingerprint_new_empty();
    g_autofree char *folder = g_get_current_dir(); // where relative names begin
    fl_fingerprint_add(print, "the build of fluidy-svg", fl_build_id());
    add_versions(print);
    fl_fingerprint_add(print, "the working directory", folder);
    fl_fingerprint_add(print, "the format", plan->format->name);
    add_requested(print, &plan->options);
    for (int f = 0; f < sequence->n; f++) {
        add_number(print, sequence->file[f], sequence->number[f]);
        add_number(print, "whether it stands in", sequence->stand_in[f]);
        add_number(print, "the layer", sequence->layer[f]);
    }
    return fl_fingerprint_digest(print);
}

/* ---- comparing ------------------------------------------------------------------------------ */

static const FlFact *fact_at(const FlFingerprint *print, guint i)
{
    return i < print->facts->len ? &g_array_index(print->facts, FlFact, i) : NULL;
}

bool fl_fingerprint_check_drawing(const FlFingerprint *print, const FlDrawing *drawing, int frame,
                                  GError **error)
{
    const char *path = fl_drawing_file(drawing, frame);
    g_autoptr(FlFingerprint) now = fl_fingerprint_new_empty();
    if (!add_file(now, path, error))
        return false;
    const FlFact *before = fact_at(print, print->first_drawing + (guint)frame);
    if (before && g_str_equal(before->value, fact_at(now, 0)->value))
        return true;
    g_set_error(error, FL_ERROR, FL_ERROR_CHANGED, "%s: has changed since the render began", path);
    return false;
}

char *fl_fingerprint_difference(const FlFingerprint *before, const FlFingerprint *now)
{
    const guint n = MAX(before->facts->len, now->facts->len);
    for (guint i = 0; i < n; i++) {
        const FlFact *old = fact_at(before, i), *new = fact_at(now, i);
        if (!old)
            return g_strdup_printf("%s is new", new->name);
        if (!new)
            return g_strdup_printf("%s is gone", old->name);
        if (!g_str_equal(old->name, new->name))
            return g_strdup_printf("%s has taken the place of %s", new->name, old->name);
        if (g_str_equal(old->value, new->value))
            continue;
        return g_str_has_prefix(new->value, SUM)
                   ? g_strdup_printf("%s has other contents", new->name)
                   : g_strdup_printf("%s was %s and is %s", new->name, old->value, new->value);
    }
    return NULL;
}
