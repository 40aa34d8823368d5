#include "guides/connected_parts.h"

#include "base/alloc.h"

/** The root of a label in the union-find forest; halves the path to the root. */
static int32_t root_of(GArray *parents, int32_t label)
{
    int32_t *parent = (int32_t *)(void *)parents->data;
    while (parent[label] != label)
        label = parent[label] = parent[parent[label]];
    return label;
}

static int32_t join(GArray *parents, int32_t a, int32_t b)
{
    a = root_of(parents, a), b = root_of(parents, b);
    g_array_index(parents, int32_t, MAX(a, b)) = MIN(a, b);
    return MIN(a, b);
}

/** Gives every pixel a preliminary label, from the left or from above, and joins equivalent ones.
 */
static void label_pixels(const uint8_t *plane, int width, int height, uint8_t least, uint8_t most,
                         int32_t *part, GArray *parents)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, part++, plane++) {
            if (*plane < least || *plane > most) {
                *part = 0;
                continue;
            }
            const int32_t left = x > 0 ? part[-1] : 0, up = y > 0 ? part[-width] : 0;
            if (left && up && left != up) {
                *part = join(parents, left, up);
            } else if (left || up) {
                *part = left ? left : up;
            } else {
                *part = (int32_t)parents->len;
                g_array_append_val(parents, *part);
            }
        }
}

bool fl_connected_parts_init(FlConnectedParts *parts, const uint8_t *plane, int width, int height,
                             uint8_t least, uint8_t most, GError **error)
{
    const size_t n = (size_t)width * height;
    *parts = (FlConnectedParts){.n_pixels = n};
    if (!(parts->part = fl_alloc_unset(n, sizeof *parts->part, "the parts of a mask", error)))
        return false;
    const int32_t outside = 0;
    g_autoptr(GArray) parents = g_array_new(FALSE, FALSE, sizeof(int32_t));
    g_array_append_val(parents, outside);
    label_pixels(plane, width, height, least, most, parts->part, parents);
    g_autofree int32_t *number =
        fl_alloc(parents->len, sizeof *number, "the parts of a mask", error);
    if (!number)
        return false;
    for (guint label = 1; label < parents->len; label++) { // a root comes before its labels
        const int32_t root = root_of(parents, (int32_t)label);
        number[label] = root == (int32_t)label ? ++parts->n_parts : number[root];
    }
    parts->size = g_new0(uint32_t, (size_t)parts->n_parts + 1);
    for (size_t p = 0; p < n; p++) {
        const int32_t part = parts->part[p] = number[parts->part[p]];
        parts->size[part] += part > 0;
    }
    return true;
}

void fl_connected_parts_drop(const FlConnectedParts *parts, size_t n_pixels, uint8_t value,
                             uint8_t *plane)
{
    for (size_t p = 0; p < parts->n_pixels; p++)
        if (parts->part[p] && parts->size[parts->part[p]] < n_pixels)
            plane[p] = value;
}

void fl_connected_parts_clear(FlConnectedParts *parts)
{
    g_free(parts->part);
    g_free(parts->size);
    *parts = (FlConnectedParts){0};
}

void fl_boxes_of_labels(const int32_t *label, FlRect plane, int most, FlRect *box)
{
    typedef struct Edges {
        int left, top, right, bottom;
    } Edges;
    g_autofree Edges *edges = g_new0(Edges, most + 1);
    for (int l = 0; l <= most; l++)
        edges[l] = (Edges){plane.x + plane.width, plane.y + plane.height, plane.x, plane.y};
    for (int y = 0; y < plane.height; y++, label += plane.width)
        for (int x = 0, end; x < plane.width; x = end) {
            Edges *e = &edges[label[x]];
            for (end = x + 1; end < plane.width && label[end] == label[x];)
                end++;
            e->left = MIN(e->left, plane.x + x), e->right = MAX(e->right, plane.x + end);
            e->top = MIN(e->top, plane.y + y), e->bottom = plane.y + y + 1;
        }
    for (int l = 0; l <= most; l++)
        box[l] = fl_rect_between(edges[l].left, edges[l].top, edges[l].right, edges[l].bottom);
}
