#include "worker/probe.h"

#include <stdlib.h>
#include <string.h>

#define VISIBLE 24      // levels; a larger difference is visible
#define MOST_VISIBLE 12 // pixels that may differ this much; rounding at thin edges makes some
#define GROSS 16        // mean squared difference allowed for a channel, levels squared: 36 dB
#define HARD 1          // likewise where masks have a harder edge: 48 dB
#define MOST_JUDGED 100 // leaves of a frame that are compared with their parts
#define EDGE 8 // one in so many pixels of a masked group may differ: those at the mask's edge

struct FlSelfCheck {
    FlSvg *svg; // borrowed
    FlPageSize page;
    int width, height;
    bool gross, hard;
    int allowed; // pixels that differ at the edges of masks, where parts overlap
    cairo_surface_t *sum;
    GArray *pieces; // FlPiece: the parts, bottom up
    uint16_t *top;  // width * height: 1 + index in pieces of the last part drawn there
};

FlSelfCheck *fl_self_check_new(FlSvg *svg, FlPageSize page, int width, int height, GError **error)
{
    cairo_surface_t *sum = fl_surface_new(CAIRO_FORMAT_ARGB32, width, height, error);
    if (!sum)
        return NULL;
    FlSelfCheck *check = g_new0(FlSelfCheck, 1);
    *check = (FlSelfCheck){svg,
                           page,
                           width,
                           height,
                           .sum = sum,
                           .pieces = g_array_new(FALSE, FALSE, sizeof(FlPiece)),
                           .top = g_new0(uint16_t, (size_t)width * height)};
    return check;
}

void fl_self_check_free(FlSelfCheck *check)
{
    if (!check)
        return;
    cairo_surface_destroy(check->sum);
    g_array_unref(check->pieces);
    g_free(check->top);
    g_free(check);
}

/** Composites a premultiplied pixel over another with its blend mode. */
static void mix_pixel(uint32_t *below, uint32_t pixel, FlBlendMode blend_mode)
{
    uint8_t rgb[4], under[4];
    fl_straighten(pixel, 0, rgb);
    fl_straighten(*below, 0, under);
    fl_blend_mode_apply(blend_mode, under, (int)(*below >> 24), rgb);
    *below = fl_blend(*below, rgb, pixel >> 24);
}

static bool draw_piece(const FlSelfCheck *check, const FlPiece *piece, cairo_surface_t *surface,
                       GError **error)
{
    const bool plain = piece->blend_mode == FL_BLEND_MODE_OVER;
    /* A mixed one is drawn apart: librsvg mixes it only with what is in the group around it. */
    g_autoptr(cairo_surface_t) apart =
        plain ? NULL : fl_surface_new(CAIRO_FORMAT_ARGB32, check->width, check->height, error);
    if (!plain && !apart)
        return false;
    cairo_surface_mark_dirty(surface);
    cairo_t *cr = cairo_create(plain ? surface : apart);
    const bool drawn =
        piece->leaf ? fl_svg_draw(check->svg, piece->leaf, piece->part, cr, check->page, error)
                    : fl_svg_draw_group(check->svg, piece->group, cr, check->page, error);
    cairo_destroy(cr);
    cairo_surface_flush(plain ? surface : apart);
    uint32_t *below = (uint32_t *)cairo_image_surface_get_data(surface);
    const uint32_t *pixels = plain ? NULL : (const uint32_t *)cairo_image_surface_get_data(apart);
    for (size_t p = 0; drawn && pixels && p < (size_t)check->width * check->height; p++)
        if (pixels[p])
            mix_pixel(&below[p], pixels[p], piece->blend_mode);
    return drawn;
}

bool fl_self_check_add(FlSelfCheck *check, const FlLeaf *leaf, const FlSurveyPart *part,
                       cairo_surface_t *coverage, FlRect box, GError **error)
{
    const unsigned char *own = cairo_image_surface_get_data(coverage);
    const int stride = cairo_image_surface_get_stride(coverage);
    uint32_t *sum = (uint32_t *)cairo_image_surface_get_data(check->sum);
    const bool flat = part->kind == FL_PAINT_FLAT && part->blend_mode == FL_BLEND_MODE_OVER;
    const FlPiece piece = {.leaf = leaf, .part = part->part, .blend_mode = part->blend_mode};
    g_array_append_val(check->pieces, piece);
    const uint16_t index = (uint16_t)MIN(check->pieces->len, UINT16_MAX);
    for (int y = box.y; y < box.y + box.height; y++)
        for (int x = box.x; x < box.x + box.width; x++) {
            const size_t p = (size_t)y * check->width + x;
            const uint8_t cover = own[(size_t)y * stride + x];
            if (cover && flat)
                sum[p] = fl_blend(sum[p], part->rgb, cover);
            if (cover)
                check->top[p] = index;
        }
    return flat || draw_piece(check, &piece, check->sum, error);
}

static int difference(uint32_t a, uint32_t b)
{
    int most = 0;
    for (int c = 0; c < 32; c += 8)
        most = MAX(most, abs((int)((a >> c) & 255) - (int)((b >> c) & 255)));
    return most;
}

/** Draws pieces over each other; NULL with an error. */
static cairo_surface_t *draw_pieces(const FlSelfCheck *check, const FlPiece *piece, int n,
                                    GError **error)
{
    g_autoptr(cairo_surface_t) surface =
        fl_surface_new(CAIRO_FORMAT_ARGB32, check->width, check->height, error);
    bool drawn = surface != NULL;
    for (int i = 0; i < n && drawn; i++)
        drawn = draw_piece(check, &piece[i], surface, error);
    return drawn ? g_steal_pointer(&surface) : NULL;
}

static const uint32_t *pixels_of(cairo_surface_t *surface)
{
    return (const uint32_t *)cairo_image_surface_get_data(surface);
}

static bool is_masked(const FlLeaf *leaf)
{
    return strcmp(leaf->layer, leaf->id) != 0;
}

/** Counts the pixels that differ visibly with all around them, as those along an edge do not. */
static int count_inner(const uint32_t *a, const uint32_t *b, int width, int height)
{
    int n = 0;
    for (int y = 1; y < height - 1; y++)
        for (int x = 1; x < width - 1; x++) {
            const size_t centre = (size_t)y * (size_t)width + (size_t)x;
            bool inner = a[centre] != b[centre];
            for (int k = 0; k < 9 && inner; k++) {
                const size_t p = (size_t)(y + k / 3 - 1) * (size_t)width + (size_t)(x + k % 3 - 1);
                inner = difference(a[p], b[p]) > VISIBLE;
            }
            n += inner;
        }
    return n;
}

int fl_looks_alike(FlSelfCheck *check, const FlLeaf *group, const FlPiece *piece, int n,
                   GError **error)
{
    const int width = check->width, height = check->height;
    g_autoptr(cairo_surface_t) one = draw_pieces(check, &(FlPiece){.leaf = group}, 1, error);
    g_autoptr(cairo_surface_t) all = one ? draw_pieces(check, piece, n, error) : NULL;
    if (!all)
        return -1;
    const uint32_t *a = pixels_of(one), *b = pixels_of(all);
    int ink = 0, visible = 0;
    for (size_t p = 0; p < (size_t)width * height; p++) {
        ink += a[p] != 0;
        visible += difference(a[p], b[p]) > VISIBLE;
    }
    if (visible * EDGE > ink ||
        (visible > MOST_VISIBLE && count_inner(a, b, width, height) > MOST_VISIBLE))
        return 0;
    if (is_masked(piece[0].leaf))
        check->allowed += visible;
    return 1;
}

/** Counts the pixels that differ visibly; the worst one goes to *where. */
static int compare(const uint32_t *a, const uint32_t *b, size_t n, size_t *where)
{
    int visible = 0, most = 0;
    for (size_t p = 0; p < n; p++) {
        const int d = difference(a[p], b[p]);
        visible += d > VISIBLE;
        *where = d > most ? p : *where;
        most = MAX(most, d);
    }
    return visible;
}

/** Counts the pixels in which one piece visibly differs from n others; -1 with an error. */
static int count_differing(const FlSelfCheck *check, FlPiece whole, const FlPiece *piece, int n,
                           GError **error)
{
    g_autoptr(cairo_surface_t) one = draw_pieces(check, &whole, 1, error);
    g_autoptr(cairo_surface_t) all = one ? draw_pieces(check, piece, n, error) : NULL;
    size_t where = 0;
    return all ? compare(pixels_of(one), pixels_of(all), (size_t)check->width * check->height,
                         &where)
               : -1;
}

/** True if a group looks as its leaves do. */
static FlVerdict judge(const FlSelfCheck *check, const char *group, GError **error)
{
    g_autoptr(GArray) inner = g_array_new(FALSE, FALSE, sizeof(FlPiece));
    FL_EACH (const FlPiece, piece, check->pieces) {
        g_auto(GStrv) groups = g_strsplit(piece->leaf->groups, "\n", -1);
        if (g_strv_contains((const char *const *)groups, group))
            g_array_append_val(inner, *piece);
    }
    const int visible = count_differing(check, (FlPiece){.group = group},
                                        (const FlPiece *)inner->data, (int)inner->len, error);
    return visible < 0                               ? FL_VERDICT_ERROR
           : visible > MOST_VISIBLE + check->allowed ? FL_VERDICT_DIFFERS
                                                     : FL_VERDICT_ALIKE;
}

/**
 * The smallest group around a leaf that does not look as its leaves do: *group, or NULL if all look
 * the same. Groups inside a group with a mask cannot be checked alone: librsvg draws them without
 * the mask.
 */
static bool find_group(const FlSelfCheck *check, const FlLeaf *leaf, char **group, GError **error)
{
    g_auto(GStrv) groups = g_strsplit(leaf->groups, "\n", -1);
    bool masked = is_masked(leaf);
    for (guint i = g_strv_length(groups); i-- > 0 && groups[i][0];) {
        masked = masked && strcmp(groups[i], leaf->layer) != 0;
        if (masked)
            continue;
        const FlVerdict verdict = judge(check, groups[i], error);
        if (verdict == FL_VERDICT_ERROR)
            return false;
        if (verdict == FL_VERDICT_ALIKE)
            continue;
        *group = g_strdup(groups[i]);
        return true;
    }
    return true;
}

/** True if two pictures differ by more than 36 dB PSNR. */
static bool differ_much(const uint32_t *a, const uint32_t *b, size_t n, int most)
{
    int64_t sum = 0;
    for (size_t p = 0; p < n; p++)
        for (int c = 0; c < 32; c += 8) {
            const int d = (int)((a[p] >> c) & 255) - (int)((b[p] >> c) & 255);
            sum += d * d;
        }
    return sum > (int64_t)n * 4 * most;
}

/** Counts the pieces from i on that belong to one leaf. */
static int parts_from(const FlSelfCheck *check, guint i)
{
    const FlPiece *piece = (const FlPiece *)check->pieces->data;
    guint n = 1;
    while (i + n < check->pieces->len && piece[i + n].leaf == piece[i].leaf)
        n++;
    return (int)n;
}

/**
 * If a leaf does not look as its parts do, such as a stroke over a fill below one opacity: it and
 * others like it, by fl_leaf_key(), one a line in *keys.
 */
static bool find_leaves(const FlSelfCheck *check, const FlLeaf *leaf, char **keys, GError **error)
{
    g_autoptr(GString) list = g_string_new(NULL);
    bool found = false;
    int judged = 0, n;
    for (guint i = 0; i < check->pieces->len && judged < MOST_JUDGED; i += (guint)n) {
        const FlPiece *piece = &g_array_index(check->pieces, FlPiece, i);
        n = parts_from(check, i);
        if (n < 2)
            continue;
        judged++;
        const int visible = count_differing(check, (FlPiece){.leaf = piece->leaf}, piece, n, error);
        const bool alike = visible <= MOST_VISIBLE;
        if (visible < 0)
            return false;
        g_autofree char *key = fl_leaf_key(piece->leaf);
        if (!alike)
            g_string_append_printf(list, "%s%s", list->len ? "\n" : "", key);
        found = found || (!alike && piece->leaf == leaf);
    }
    *keys = found ? g_string_free(g_steal_pointer(&list), FALSE) : NULL;
    return true;
}

bool fl_self_check_has_hard_masks(const FlSelfCheck *check)
{
    return check->hard;
}

bool fl_self_check_is_gross(const FlSelfCheck *check)
{
    return check->gross;
}

FlVerdict fl_self_check_finish(FlSelfCheck *check, char **group, const char **leaf, GError **error)
{
    g_autoptr(cairo_surface_t) truth = draw_pieces(check, &(FlPiece){0}, 1, error);
    if (!truth)
        return FL_VERDICT_ERROR;
    size_t where = 0;
    const uint32_t *is = pixels_of(truth), *sum = pixels_of(check->sum);
    const size_t n = (size_t)check->width * (size_t)check->height;
    const int visible = compare(is, sum, n, &where);
    *group = NULL;
    *leaf = NULL;
    check->hard = check->allowed > 0 && differ_much(is, sum, n, HARD);
    if (visible <= MOST_VISIBLE + check->allowed)
        return FL_VERDICT_ALIKE;
    check->gross = differ_much(is, sum, n, GROSS);
    if (check->top[where] == 0)
        return FL_VERDICT_DIFFERS;
    const FlLeaf *top = g_array_index(check->pieces, FlPiece, check->top[where] - 1).leaf;
    *leaf = top->name[0] ? top->name : NULL;
    const bool judged =
        find_leaves(check, top, group, error) && (*group || find_group(check, top, group, error));
    return judged ? FL_VERDICT_DIFFERS : FL_VERDICT_ERROR;
}
