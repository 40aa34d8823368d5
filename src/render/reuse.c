#include "render/reuse.h"

#include "base/reader.h"
#include "render/loop.h"

/* A slot that every render of the same drawing and region uses: what it was painted by last. */
static FlDigest slot_of(const FlShapes *shapes, int p)
{
    FlDigest slot = {0};
    g_autofree char *path = g_canonicalize_filename(fl_drawing_file(shapes->drawing, 0), NULL);
    fl_digest_add_text(&slot, path);
    fl_digest_add_text(&slot, shapes->painted[p].name);
    return slot;
}

/* Held ones counted once, those of a lead-in twice. */
static guint pictures_of(const FlShapes *shapes, int p)
{
    const FlRegionPlan *region = &shapes->painted[p];
    const int n = (shapes->n_frames - 1) / region->settings.hold + 1;
    return (guint)(n + (region->loops ? fl_loop_length(n) : 0));
}

/* The digests of all pictures, if they and every picture are kept; an empty list for a region that
 * is hidden in all frames, which counts if only frames are made. */
static void recall(FlReuse *reuse, const FlShapes *shapes, int p)
{
    const FlRect page = {0, 0, shapes->width, shapes->height};
    g_autoptr(GBytes) film = fl_store_get(reuse->cache, FL_KEPT_FILM, reuse->film);
    FlReader reader = fl_reader_of(film);
    const guint n = (guint)fl_reader_count(&reader, pictures_of(shapes, p));
    const FlRect rect = n > 0 ? fl_reader_rect(&reader, page) : (FlRect){0};
    const uint8_t *digests = fl_reader_take(&reader, n, sizeof(FlDigest));
    if (!fl_reader_ends(&reader) || (n == 0 ? !shapes->frames_alone : n != pictures_of(shapes, p)))
        return;
    g_autoptr(GArray) known = g_array_new(FALSE, FALSE, sizeof(FlDigest));
    g_array_append_vals(known, digests, n);
    for (guint k = 0; k < n; k++)
        if (!fl_store_has(reuse->cache, FL_KEPT_PICTURE, g_array_index(known, FlDigest, k)))
            return;
    reuse->rect = rect;
    reuse->known = g_steal_pointer(&known);
}

void fl_reuse_init(FlReuse *reuse, FlStore *cache, const FlShapes *shapes,
                   const FlRegionPlan *region, FlInputs *inputs)
{
    *reuse = (FlReuse){.cache = cache, .takes = true};
    reuse->made = g_array_new(FALSE, TRUE, sizeof(FlDigest));
    if (!cache)
        return;
    reuse->facts = fl_region_facts(shapes, region, inputs);
    reuse->last = reuse->method = fl_facts_digest(reuse->facts);
}

void fl_reuse_recall(FlReuse *reuse, const FlKeeping *keeping, const FlShapes *shapes, int p)
{
    reuse->takes = keeping->takes;
    if (!reuse->cache)
        return;
    reuse->slot = slot_of(shapes, p);
    fl_facts_append(reuse->facts, keeping->film);
    fl_region_facts_add_flow(reuse->facts, shapes, p, keeping->inputs);
    reuse->film = fl_facts_digest(reuse->facts);
    if (reuse->takes)
        recall(reuse, shapes, p);
    reuse->drafts = keeping->drafts && !reuse->known && !shapes->painted[p].loops;
}

void fl_reuse_clear(FlReuse *reuse)
{
    fl_facts_free(reuse->facts);
    g_clear_pointer(&reuse->made, g_array_unref);
    g_clear_pointer(&reuse->known, g_array_unref);
    g_clear_pointer(&reuse->state, g_bytes_unref);
    *reuse = (FlReuse){0};
}

void fl_reuse_begin(FlReuse *reuse, FlRect rect)
{
    reuse->rect = rect;
    fl_digest_add(&reuse->last, &rect, sizeof rect);
}

/* ---- pictures ------------------------------------------------------------------------------- */

static void add_guides(FlDigest *digest, const FlGuides *guides)
{
    const FlRect part = fl_guides_rect(guides);
    const size_t n = fl_rect_pixels(part);
    fl_digest_add(digest, &part, sizeof part);
    fl_digest_add(digest, guides->mask, n);
    fl_digest_add(digest, guides->distance, n * sizeof *guides->distance);
    fl_digest_add(digest, guides->depth, n * sizeof *guides->depth);
    fl_digest_add(digest, guides->flow, 2 * n * sizeof *guides->flow);
    fl_digest_add(digest, guides->angle, n);
    fl_digest_add(digest, guides->ext_plus, n * sizeof *guides->ext_plus);
    fl_digest_add(digest, guides->ext_minus, n * sizeof *guides->ext_minus);
    fl_digest_add(digest, guides->bare, n);
    if (!guides->has_motion)
        return;
    fl_digest_add(digest, guides->motion, 2 * n * sizeof *guides->motion);
    fl_digest_add(digest, guides->turn, n * sizeof *guides->turn);
}

/* The digests of pictures, as far as they are known. */
static const GArray *digests_of(const FlReuse *reuse)
{
    return reuse->known ? reuse->known : reuse->made;
}

static FlDigest draft_of(const FlReuse *reuse, int k)
{
    FlDigest digest = reuse->film;
    fl_digest_add(&digest, &reuse->rect, sizeof reuse->rect);
    fl_digest_add(&digest, &k, sizeof k);
    return digest;
}

bool fl_reuse_has(const FlReuse *reuse, int k)
{
    const GArray *digests = digests_of(reuse);
    if (reuse->known || !reuse->cache || !reuse->takes)
        return reuse->known;
    if (!reuse->drafts && (guint)k >= digests->len)
        return false;
    return fl_store_has(reuse->cache, FL_KEPT_PICTURE,
                        reuse->drafts ? draft_of(reuse, k) : g_array_index(digests, FlDigest, k));
}

void fl_reuse_next(FlReuse *reuse, int k, const FlGuides *guides, int window)
{
    if (!reuse->cache)
        return;
    if (reuse->drafts) {
        reuse->last = draft_of(reuse, k);
        return;
    }
    if ((guint)k < digests_of(reuse)->len) {
        reuse->last = g_array_index(digests_of(reuse), FlDigest, k);
        return;
    }
    g_array_set_size(reuse->made, (guint)k); // those of pictures that no frame shows stay 0
    if (guides)
        add_guides(&reuse->last, guides);
    else
        fl_digest_add_text(&reuse->last, "rests");
    fl_digest_add(&reuse->last, &window, sizeof window);
    g_array_append_val(reuse->made, reuse->last);
}

/* A kept picture: the packed state's size, the state, the packed picture. */
static GBytes *take_state(GBytes *kept, FlSpan *packed)
{
    FlReader reader = fl_reader_of(kept);
    const size_t state_bytes = fl_reader_count(&reader, reader.left);
    const size_t from = sizeof(uint64_t);
    if (!fl_reader_take(&reader, state_bytes, 1))
        return NULL;
    *packed = (FlSpan){(void *)(uintptr_t)reader.at, reader.left}; // read only
    return g_bytes_new_from_bytes(kept, from, state_bytes);
}

bool fl_reuse_take(FlReuse *reuse, uint8_t *rgb, size_t bytes)
{
    if (!reuse->cache || !reuse->takes)
        return false;
    g_autoptr(GBytes) kept = fl_store_get(reuse->cache, FL_KEPT_PICTURE, reuse->last);
    FlSpan packed = {0};
    g_autoptr(GBytes) state = kept ? take_state(kept, &packed) : NULL;
    if (state && fl_unpack(packed.data, packed.bytes, &(FlSpan){rgb, bytes}, 1)) {
        g_clear_pointer(&reuse->state, g_bytes_unref);
        reuse->state = g_steal_pointer(&state);
        reuse->state_of = reuse->last;
        reuse->n_taken++;
        return true;
    }
    if (!reuse->known)
        return false;
    fl_store_drop(reuse->cache, FL_KEPT_FILM, reuse->film);
    reuse->stale = true;
    return false;
}

void fl_reuse_refuse_state(FlReuse *reuse)
{
    fl_store_drop(reuse->cache, FL_KEPT_PICTURE, reuse->state_of);
    reuse->stale = true;
}

void fl_reuse_keep(FlReuse *reuse, const uint8_t *rgb, size_t bytes, GBytes *state)
{
    gsize state_bytes;
    const void *data = g_bytes_get_data(state, &state_bytes);
    const FlSpan picture = {(void *)(uintptr_t)rgb, bytes}; // read only
    g_autoptr(GBytes) packed = fl_pack(NULL, 0, &picture, 1, NULL);
    uint64_t first = state_bytes;
    if (!packed)
        return; // without memory the picture is not cached; the next render paints it again
    const FlSpan parts[] = {
        {&first, sizeof first},
        {(void *)(uintptr_t)data, state_bytes},
        {(void *)(uintptr_t)g_bytes_get_data(packed, NULL), g_bytes_get_size(packed)}};
    fl_store_put(reuse->cache, FL_KEPT_PICTURE, reuse->last, parts, G_N_ELEMENTS(parts));
}

/* ---- the end -------------------------------------------------------------------------------- */

void fl_reuse_finish(FlReuse *reuse)
{
    if (!reuse->cache || reuse->known || reuse->drafts)
        return;
    uint64_t n = reuse->made->len;
    const FlSpan film[] = {{&n, sizeof n},
                           {&reuse->rect, sizeof reuse->rect},
                           {reuse->made->data, n * sizeof(FlDigest)}};
    fl_store_put(reuse->cache, FL_KEPT_FILM, reuse->film, film, n > 0 ? G_N_ELEMENTS(film) : 1);
    g_autoptr(GByteArray) facts = g_byte_array_new();
    fl_facts_put(facts, reuse->facts);
    fl_store_put(reuse->cache, FL_KEPT_FACTS, reuse->slot, &(FlSpan){facts->data, facts->len}, 1);
}

char *fl_reuse_reason(const FlReuse *reuse)
{
    g_autoptr(GBytes) bytes =
        reuse->cache ? fl_store_get(reuse->cache, FL_KEPT_FACTS, reuse->slot) : NULL;
    FlReader reader = fl_reader_of(bytes);
    g_autoptr(FlFacts) before = fl_facts_take(&reader);
    return fl_reader_ends(&reader) ? fl_facts_difference(before, reuse->facts) : NULL;
}
