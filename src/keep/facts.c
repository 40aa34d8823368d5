#include "keep/facts.h"

#include "config.h"
#include <cairo.h>
#include <dlfcn.h>
#include <fluidy/fluidy.h>
#include <librsvg/rsvg.h>

#define DIGEST "digest " // begins a value that a reader cannot interpret

static void clear_fact(FlFact *fact)
{
    g_free(fact->name);
    g_free(fact->value);
}

FlFacts *fl_facts_new(void)
{
    FlFacts *facts = g_new0(FlFacts, 1);
    facts->list = g_array_new(FALSE, TRUE, sizeof(FlFact));
    g_array_set_clear_func(facts->list, (GDestroyNotify)clear_fact);
    return facts;
}

void fl_facts_free(FlFacts *facts)
{
    if (!facts)
        return;
    g_array_unref(facts->list);
    g_free(facts);
}

void fl_facts_add(FlFacts *facts, const char *name, const char *value)
{
    const FlFact fact = {g_utf8_make_valid(name, -1),
                         g_utf8_make_valid(value ? value : "not set", -1)};
    g_array_append_val(facts->list, fact);
}

void fl_facts_add_number(FlFacts *facts, const char *name, double value)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    fl_facts_add(facts, name, g_ascii_dtostr(text, sizeof text, value));
}

void fl_facts_add_digest(FlFacts *facts, const char *name, FlDigest digest)
{
    g_autofree char *value = g_strdup_printf(
        DIGEST "%016" G_GINT64_MODIFIER "x%016" G_GINT64_MODIFIER "x", digest.a, digest.b);
    fl_facts_add(facts, name, value);
}

void fl_facts_add_versions(FlFacts *facts)
{
    g_autofree char *rsvg =
        g_strdup_printf("%u.%u.%u", rsvg_major_version, rsvg_minor_version, rsvg_micro_version);
    fl_facts_add(facts, "the version of fluidy-svg", FL_VERSION);
    fl_facts_add(facts, "the version of librsvg", rsvg);
    fl_facts_add(facts, "the version of cairo", cairo_version_string());
    fl_facts_add_number(facts, "the byte order", G_BYTE_ORDER);
}

const char *fl_version(void)
{
    return FL_VERSION;
}

/* The file of the library; of a program that holds it, where the system tells that one. */
static GMappedFile *map_code(void)
{
    Dl_info own;
    GMappedFile *file = dladdr((const void *)(uintptr_t)fl_facts_add_build, &own)
                            ? g_mapped_file_new(own.dli_fname, FALSE, NULL)
                            : NULL;
    return file ? file : g_mapped_file_new("/proc/self/exe", FALSE, NULL);
}

void fl_facts_add_build(FlFacts *facts)
{
    static char *id;
    if (!id) {
        FlDigest digest = {0};
        g_autoptr(GMappedFile) file = map_code();
        if (file)
            fl_digest_add(&digest, g_mapped_file_get_contents(file),
                          g_mapped_file_get_length(file));
        id = g_strdup_printf(FL_VERSION " %016" G_GINT64_MODIFIER "x%016" G_GINT64_MODIFIER "x",
                             digest.a, digest.b);
    }
    fl_facts_add(facts, "the build of fluidy-svg", id);
}

void fl_facts_append(FlFacts *facts, const FlFacts *other)
{
    for (guint k = 0; other && k < other->list->len; k++) {
        const FlFact *fact = &g_array_index(other->list, FlFact, k);
        fl_facts_add(facts, fact->name, fact->value);
    }
}

FlDigest fl_facts_digest(const FlFacts *facts)
{
    FlDigest digest = {0};
    for (guint k = 0; k < facts->list->len; k++) {
        const FlFact *fact = &g_array_index(facts->list, FlFact, k);
        fl_digest_add_text(&digest, fact->name);
        fl_digest_add_text(&digest, fact->value);
    }
    return digest;
}

static const FlFact *fact_at(const FlFacts *facts, guint k)
{
    return k < facts->list->len ? &g_array_index(facts->list, FlFact, k) : NULL;
}

char *fl_facts_difference(const FlFacts *before, const FlFacts *now)
{
    const guint n = MAX(before->list->len, now->list->len);
    for (guint k = 0; k < n; k++) {
        const FlFact *old = fact_at(before, k), *new = fact_at(now, k);
        if (!old)
            return g_strdup_printf("%s is new", new->name);
        if (!new)
            return g_strdup_printf("%s is gone", old->name);
        if (!g_str_equal(old->name, new->name))
            return g_strdup_printf("%s has taken the place of %s", new->name, old->name);
        if (g_str_equal(old->value, new->value))
            continue;
        return g_str_has_prefix(new->value, DIGEST)
                   ? g_strdup_printf("%s has other contents", new->name)
                   : g_strdup_printf("%s was %s and is %s", new->name, old->value, new->value);
    }
    return NULL;
}

void fl_facts_put(GByteArray *out, const FlFacts *facts)
{
    fl_put_int(out, (int)facts->list->len);
    for (guint k = 0; k < facts->list->len; k++) {
        const FlFact *fact = &g_array_index(facts->list, FlFact, k);
        fl_put_text(out, fact->name);
        fl_put_text(out, fact->value);
    }
}

FlFacts *fl_facts_take(FlReader *reader)
{
    FlFacts *facts = fl_facts_new();
    const int n = fl_take_count(reader, 2);
    for (int k = 0; k < n && !reader->failed; k++) {
        const char *name = fl_take_text(reader);
        fl_facts_add(facts, name, fl_take_text(reader));
    }
    return facts;
}
