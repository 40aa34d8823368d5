#include "render/reuse.h"

#include "base/alloc.h"
#include "inspect/report.h"
#include <string.h>

/* The start of a kept film; the digests follow. */
typedef struct FilmHeader {
    FlRect rect;
} FilmHeader;

/* A slot that every render of the same drawing and region uses: what it was painted by last. */
static FlDigest slot_of(const FlPlan *plan, int p)
{
    FlDigest slot = {0};
    g_autofree char *path = g_canonicalize_filename(fl_drawing_file(plan->drawing, 0), NULL);
    fl_digest_add_text(&slot, path);
    fl_digest_add_text(&slot, plan->painted[p].name);
    return slot;
}

/* The digests of all pictures, if they are kept and so is every picture; of what is hidden in all
 * frames none, which does for frames alone. */
static void recall(FlReuse *reuse, bool frames_alone)
{
    g_autoptr(GBytes) film = fl_paint_cache_get(reuse->cache, FL_CACHE_FILM, reuse->film);
    gsize bytes = 0;
    const uint8_t *data = film ? g_bytes_get_data(film, &bytes) : NULL;
    if (bytes < sizeof(FilmHeader) || (bytes - sizeof(FilmHeader)) % sizeof(FlDigest) != 0)
        return;
    const guint n = (guint)((bytes - sizeof(FilmHeader)) / sizeof(FlDigest));
    if (n == 0 && !frames_alone)
        return;
    g_autoptr(GArray) known = g_array_new(FALSE, FALSE, sizeof(FlDigest));
    memcpy(&reuse->rect, data, sizeof reuse->rect);
    g_array_append_vals(known, data + sizeof(FilmHeader), n);
    for (guint k = 0; k < n; k++)
        if (!fl_paint_cache_has(reuse->cache, FL_CACHE_PICTURE, g_array_index(known, FlDigest, k)))
            return;
    reuse->known = g_steal_pointer(&known);
}

bool fl_reuse_init(FlReuse *reuse, FlPaintCache *cache, const FlShapes *shapes,
                   const FlRegionPlan *region, GHashTable *styles, GError **error)
{
    *reuse = (FlReuse){.cache = cache, .takes = true};
    reuse->made = g_array_new(FALSE, FALSE, sizeof(FlDigest));
    if (!cache)
        return true;
    reuse->facts = fl_fingerprint_of_method(shapes, region, styles, error);
    if (!reuse->facts)
        return false;
    reuse->last = fl_fingerprint_digest(reuse->facts);
    return true;
}

bool fl_reuse_recall(FlReuse *reuse, const FlPlan *plan, int p, const FlFingerprint *whole,
                     GError **error)
{
    const FlRenderOptions *o = &plan->options;
    reuse->takes = !fl_report_measures(o) && !o->dump && !o->ebsynth;
    if (!reuse->cache)
        return true;
    reuse->slot = slot_of(plan, p);
    if (!fl_fingerprint_add_film(reuse->facts, plan, p, whole, error))
        return false;
    reuse->film = fl_fingerprint_digest(reuse->facts);
    if (reuse->takes)
        recall(reuse, fl_plan_frames_alone(plan));
    return true;
}

void fl_reuse_clear(FlReuse *reuse)
{
    fl_fingerprint_free(reuse->facts);
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
    const FlRestingParts *resting = &guides->resting;
    const size_t n = fl_rect_pixels(part);
    fl_digest_add(digest, &part, sizeof part);
    if (resting->keeps)
        fl_digest_add(digest, resting->keeps,
                      (size_t)resting->columns * (size_t)resting->rows * sizeof *resting->keeps);
    fl_digest_add(digest, guides->mask, n);
    fl_digest_add(digest, guides->distance, n * sizeof *guides->distance);
    fl_digest_add(digest, guides->depth, n * sizeof *guides->depth);
    fl_digest_add(digest, guides->flow, 2 * n * sizeof *guides->flow);
    fl_digest_add(digest, guides->angle, n);
    fl_digest_add(digest, guides->ext_plus, n * sizeof *guides->ext_plus);
    fl_digest_add(digest, guides->ext_minus, n * sizeof *guides->ext_minus);
    if (!guides->has_motion)
        return;
    fl_digest_add(digest, guides->motion, 2 * n * sizeof *guides->motion);
    fl_digest_add(digest, guides->turn, n * sizeof *guides->turn);
}

void fl_reuse_next(FlReuse *reuse, int k, const FlGuides *guides, int window)
{
    if (!reuse->cache)
        return;
    reuse->n_done = (guint)k + 1;
    if (reuse->known) {
        reuse->last = g_array_index(reuse->known, FlDigest, k);
        return;
    }
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
    uint64_t state_bytes;
    gsize bytes;
    const uint8_t *data = g_bytes_get_data(kept, &bytes);
    if (bytes < sizeof state_bytes)
        return NULL;
    memcpy(&state_bytes, data, sizeof state_bytes);
    if (state_bytes > bytes - sizeof state_bytes)
        return NULL;
    *packed = (FlSpan){(void *)(uintptr_t)(data + sizeof state_bytes + state_bytes), // only read
                       bytes - sizeof state_bytes - state_bytes};
    return g_bytes_new_from_bytes(kept, sizeof state_bytes, state_bytes);
}

bool fl_reuse_take(FlReuse *reuse, uint8_t *rgb, size_t bytes)
{
    if (!reuse->cache || !reuse->takes)
        return false;
    g_autoptr(GBytes) kept = fl_paint_cache_get(reuse->cache, FL_CACHE_PICTURE, reuse->last);
    FlSpan packed = {0};
    g_autoptr(GBytes) state = kept ? take_state(kept, &packed) : NULL;
    if (state && fl_decompress(packed.data, packed.bytes, &(FlSpan){rgb, bytes}, 1)) {
        g_clear_pointer(&reuse->state, g_bytes_unref);
        reuse->state = g_steal_pointer(&state);
        reuse->n_taken++;
        return true;
    }
    if (!reuse->known)
        return false;
    fl_paint_cache_drop(reuse->cache, FL_CACHE_FILM, reuse->film);
    reuse->stale = true;
    return false;
}

void fl_reuse_keep(FlReuse *reuse, const uint8_t *rgb, size_t bytes, GBytes *state)
{
    gsize state_bytes;
    const void *data = g_bytes_get_data(state, &state_bytes);
    const FlSpan picture = {(void *)(uintptr_t)rgb, bytes}; // which is only read
    const size_t room = fl_compress_bound(&picture, 1);
    g_autofree uint8_t *packed = fl_alloc(room, 1, "a picture", NULL);
    const size_t packed_bytes = packed ? fl_compress(&picture, 1, packed, room) : 0;
    uint64_t first = state_bytes;
    if (packed_bytes == 0)
        return; // without memory for it, it is painted again next time
    const FlSpan parts[] = {
        {&first, sizeof first}, {(void *)(uintptr_t)data, state_bytes}, {packed, packed_bytes}};
    fl_paint_cache_put(reuse->cache, FL_CACHE_PICTURE, reuse->last, parts, G_N_ELEMENTS(parts));
}

/* ---- renders that are resumed --------------------------------------------------------------- */

GBytes *fl_reuse_save(const FlReuse *reuse)
{
    const GArray *digests = reuse->known ? reuse->known : reuse->made;
    const guint n = reuse->cache ? reuse->n_done : 0;
    return g_bytes_new(n > 0 ? digests->data : NULL, n * sizeof(FlDigest));
}

/* The state that was kept with the last picture; NULL: it is gone. */
static GBytes *state_in_cache(const FlReuse *reuse)
{
    FlSpan packed;
    g_autoptr(GBytes) kept = fl_paint_cache_get(reuse->cache, FL_CACHE_PICTURE, reuse->last);
    return kept ? take_state(kept, &packed) : NULL;
}

bool fl_reuse_load(FlReuse *reuse, GBytes *digests, GBytes *state)
{
    gsize bytes;
    const void *data = g_bytes_get_data(digests, &bytes);
    const guint n = (guint)(bytes / sizeof(FlDigest));
    if (reuse->known)
        return true;
    g_clear_pointer(&reuse->state, g_bytes_unref);
    if (n == 0)
        reuse->cache = NULL; // the chain lacks its first pictures
    if (reuse->cache) {
        g_array_set_size(reuse->made, 0);
        g_array_append_vals(reuse->made, data, n);
        reuse->n_done = n;
        reuse->last = g_array_index(reuse->made, FlDigest, n - 1);
    }
    if (g_bytes_get_size(state) > 0)
        reuse->state = g_bytes_ref(state);
    else if (reuse->cache)
        reuse->state = state_in_cache(reuse);
    return reuse->state != NULL;
}

/* ---- the end -------------------------------------------------------------------------------- */

void fl_reuse_finish(FlReuse *reuse)
{
    if (!reuse->cache || reuse->known || reuse->made->len != reuse->n_done)
        return;
    FilmHeader header = {reuse->rect};
    const FlSpan film[] = {{&header, sizeof header},
                           {reuse->made->data, reuse->n_done * sizeof(FlDigest)}};
    const int n_spans = reuse->n_done > 0 ? G_N_ELEMENTS(film) : 1; // empty arrays have no data
    fl_paint_cache_put(reuse->cache, FL_CACHE_FILM, reuse->film, film, n_spans);
    g_autoptr(GBytes) facts = fl_fingerprint_pack(reuse->facts);
    gsize bytes;
    const void *data = g_bytes_get_data(facts, &bytes);
    fl_paint_cache_put(reuse->cache, FL_CACHE_FACTS, reuse->slot,
                       &(FlSpan){(void *)(uintptr_t)data, bytes}, 1);
}

char *fl_reuse_reason(const FlReuse *reuse)
{
    g_autoptr(GBytes) bytes =
        reuse->cache ? fl_paint_cache_get(reuse->cache, FL_CACHE_FACTS, reuse->slot) : NULL;
    g_autoptr(FlFingerprint) before = bytes ? fl_fingerprint_unpack(bytes) : NULL;
    return before ? fl_fingerprint_difference(before, reuse->facts) : NULL;
}
