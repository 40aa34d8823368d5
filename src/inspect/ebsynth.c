#include "inspect/ebsynth.h"

#include "base/alloc.h"
#include "io/atomic_file.h"
#include "io/png.h"

#define UNIFORMITY 3500 // ebsynth's own default

/* One frame of one region. */
typedef struct Step {
    const char *folder; // the region's
    int number;
} Step;

static bool write_text(const char *folder, const char *name, const char *text, GError **error)
{
    g_autofree char *path = g_build_filename(folder, name, NULL);
    g_auto(FlAtomicFile) file = {0};
    if (!fl_atomic_open(&file, path, true, error))
        return false;
    (void)fputs(text, file.stream); // a full disk fails the commit
    return fl_atomic_commit(&file, error);
}

static const char run_all[] = "#!/bin/sh\n"
                              "# Paints every region and frame: sh run.sh; $EBSYNTH is the "
                              "program. With several threads its\n"
                              "# results differ from run to run.\n"
                              "cd \"$(dirname \"$0\")\" || exit 1\n"
                              "export OMP_NUM_THREADS=\"${OMP_NUM_THREADS:-1}\"\n"
                              "for step in */run_*.sh; do\n"
                              "    sh \"$step\" || exit 1\n"
                              "done\n";

static const char readme[] =
    "What fluidy-svg synthesised each region's frames from, for ebsynth.\n"
    "\n"
    "  EBSYNTH=/path/to/ebsynth sh run.sh\n"
    "\n"
    "paints them; fluidy-svg, with the options as they were and merge, composes the frames.\n"
    "\n"
    "REGION/run_NUMBER.sh is a step: it makes out_NUMBER.png of style_NUMBER.png and the guides\n"
    "beside it. All steps have the pictures that fluidy-svg's own frame was made from, the frame\n"
    "before included, so that every frame is the same problem for both.\n"
    "\n"
    "ebsynth divides a weight by the channels that it finds in a picture; -weight is therefore "
    "that\n"
    "of one channel times their number. These differences remain:\n"
    "\n"
    "  - It weighs no pixels: where the frame before counts for less than half, the guide has the\n"
    "    colour nearby.\n"
    "  - It knows no masks: `segment' keeps border, interior and outside apart. It has one frame "
    "of\n"
    "    the recording, the one that our own result is mostly made of.\n"
    "  - It turns no patches, has no directions, and keeps its own uniformity (-uniformity), "
    "which\n"
    "    is soft.\n"
    "  - Of LazyFluids, the synthesised alpha counts as much as a colour instead of three times.\n";

bool fl_ebsynth_begin(const char *folder, GError **error)
{
    return write_text(folder, "run.sh", run_all, error) &&
           write_text(folder, "README", readme, error);
}

static char *picture_name(const Step *step, const char *name, const char *side)
{
    return g_strdup_printf("%s%s_%04d.png", name, side, step->number);
}

/* Writes a picture and appends its name to the command. */
static bool add_picture(const Step *step, const char *name, const char *side, const uint8_t *data,
                        const int size[2], int channels, GString *command, GError **error)
{
    g_autofree char *leaf = picture_name(step, name, side);
    g_autofree char *path = g_build_filename(step->folder, leaf, NULL);
    g_string_append_printf(command, " %s", leaf);
    return fl_png_write(path, data, size[0], size[1], channels, error);
}

static void add_weight(GString *command, double weight)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    g_string_append_printf(command, " -weight %s",
                           g_ascii_formatd(text, sizeof text, "%g", weight));
}

/* The channels that ebsynth will find in the style: alpha counts if any pixel is not opaque. */
static int style_channels(const FlGuidePairs *pairs)
{
    const size_t n = (size_t)pairs->source_width * (size_t)pairs->source_height;
    for (size_t p = 0; pairs->style_channels == 4 && p < n; p++)
        if (pairs->style[4 * p + 3] < 255)
            return 4;
    return 3;
}

static bool add_pair(const Step *step, const FlGuidePairs *pairs, const FlGuidePair *pair,
                     GString *command, GError **error)
{
    const int source[] = {pairs->source_width, pairs->source_height};
    const int target[] = {pairs->width, pairs->height};
    g_string_append(command, " \\\n    -guide");
    if (!pair->source) {
        g_autofree char *style = picture_name(step, "style", "");
        g_string_append_printf(command, " %s", style);
    } else if (!add_picture(step, pair->name, "_source", pair->source, source, pair->channels,
                            command, error))
        return false;
    if (!add_picture(step, pair->name, "_target", pair->target, target, pair->channels, command,
                     error))
        return false;
    add_weight(command, pair->weight * (float)pair->channels);
    return true;
}

static bool add_command(const Step *step, const FlGuidePairs *pairs, GString *command,
                        GError **error)
{
    const int size[] = {pairs->source_width, pairs->source_height};
    g_string_append(command, "exec \"${EBSYNTH:-ebsynth}\" -style");
    if (!add_picture(step, "style", "", pairs->style, size, pairs->style_channels, command, error))
        return false;
    add_weight(command, pairs->style_weight * (float)style_channels(pairs));
    for (int k = 0; k < pairs->n; k++)
        if (!add_pair(step, pairs, &pairs->pair[k], command, error))
            return false;
    g_string_append_printf(command, " \\\n    -patchsize %d -uniformity %d -output out_%04d.png\n",
                           FL_PATCH, UNIFORMITY, step->number);
    return true;
}

static bool write_step(const Step *step, const FlGuidePairs *pairs, int before, GError **error)
{
    g_autofree char *name = g_strdup_printf("run_%04d.sh", step->number);
    g_autoptr(GString) command = g_string_new("#!/bin/sh\ncd \"$(dirname \"$0\")\" || exit 1\n");
    if (!pairs)
        g_string_append_printf(command,
                               "copy() {\n    cp out_%04d.png out_%04d.png\n}\n"
                               "copy 2>/dev/null || { sh run_%04d.sh && copy; }\n",
                               before, step->number, before);
    else if (!add_command(step, pairs, command, error))
        return false;
    return write_text(step->folder, name, command->str, error);
}

bool fl_ebsynth_frame(const char *folder, const FlPaintedRegion *painted, const FlGuidePairs *pairs,
                      int number, int before, GError **error)
{
    g_autofree char *region = g_build_filename(folder, painted->name, NULL);
    const Step step = {region, number};
    g_mkdir_with_parents(region, 0777); // a failure is reported by the first file
    if (pairs || before >= 0)
        return write_step(&step, pairs, before, error);
    g_autofree char *name = picture_name(&step, "out", "");
    g_autofree char *path = g_build_filename(region, name, NULL);
    const FlRect rect = painted->rect;
    const size_t pixels = fl_rect_pixels(rect);
    if (!painted->alpha)
        return fl_png_write(path, painted->painted, rect.width, rect.height, 3, error);
    g_autofree uint8_t *rgba = fl_alloc(4 * pixels, 1, "a painted region", error);
    for (size_t p = 0; rgba && p < pixels; p++)
        fl_painted_pixel(painted, p, rgba + 4 * p);
    return rgba && fl_png_write(path, rgba, rect.width, rect.height, 4, error);
}
