#include "drawing/outlines.h"

#include "drawing/drawing_data.h"
#include <string.h>

FlOutlines *fl_drawing_outlines(const FlDrawing *drawing, int frame, GError **error)
{
    const FlRequest request = fl_drawing_request(drawing, frame, FL_VERB_OUTLINES);
    g_auto(FlAnswer) answer = {0};
    if (!fl_workers_ask(drawing->workers, &request, NULL, &answer, error))
        return NULL;
    FlOutlines *outlines = fl_outlines_unpack(answer.reader.at, answer.reader.left);
    if (!outlines)
        fl_answer_set_damaged(request.file, error);
    return outlines;
}

/** Calls for the leaf of a step, or for all leaves that are drawn together. */
static void add_leaves(const FlDrawStep *step, const FlOutlines *outlines, GArray *list)
{
    const int unit = -1 - step->leaf;
    FlRegionLeaf one = {.part = (FlPart)step->part, .flat = step->flat};
    memcpy(one.box, step->box, sizeof one.box);
    memcpy(one.rgb, step->rgb, sizeof one.rgb);
    const int first = step->leaf >= 0 ? step->leaf : 0;
    const int end = step->leaf >= 0 ? step->leaf + 1 : outlines->n_leaves;
    for (one.leaf = first; one.leaf < MIN(end, outlines->n_leaves); one.leaf++)
        if (step->leaf >= 0 || outlines->leaf[one.leaf].unit == unit)
            g_array_append_val(list, one);
}

GArray *fl_drawing_region_leaves(const FlDrawing *drawing, int frame, int region,
                                 const FlOutlines *outlines)
{
    const FlDrawingFrame *f = &drawing->frame[frame];
    GArray *list = g_array_new(FALSE, FALSE, sizeof(FlRegionLeaf));
    for (int i = 0; i < f->n; i++)
        if (region < 0 || f->step[i].region == region)
            add_leaves(&f->step[i], outlines, list);
    return list;
}

FlLeafFill *fl_drawing_leaf_fills(const FlDrawing *drawing, int frame, const FlOutlines *outlines)
{
    const FlDrawingFrame *f = &drawing->frame[frame];
    FlLeafFill *fill = g_new0(FlLeafFill, outlines->n_leaves + 1);
    for (int i = 0; i < outlines->n_leaves; i++)
        fill[i] = (FlLeafFill){.region = -1};
    g_autoptr(GArray) list = g_array_new(FALSE, FALSE, sizeof(FlRegionLeaf));
    for (int i = 0; i < f->n; i++) {
        g_array_set_size(list, 0);
        add_leaves(&f->step[i], outlines, list);
        FL_EACH (const FlRegionLeaf, leaf, list) {
            if (fill[leaf->leaf].region < 0)
                fill[leaf->leaf] = (FlLeafFill){f->step[i].region,
                                                f->step[i].nth,
                                                leaf->flat,
                                                {leaf->rgb[0], leaf->rgb[1], leaf->rgb[2]}};
        }
    }
    return fill;
}

bool fl_drawing_same_file(const FlDrawing *drawing, int a, int b)
{
    return a == b || fl_sequence_same(drawing->sequence, a, b);
}
