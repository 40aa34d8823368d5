/*
 * usage: flat FOLDER... prints for each sequence the least and the mean PSNR of its frames, drawn
 * region by region in the drawing's own fills, to librsvg's pictures of the files.
 */
#include "flat.h"
#include <stdio.h>

static void print_sequence(const char *folder)
{
    GError *error = NULL;
    const char *const inputs[] = {folder, NULL};
    const FlDrawingOptions options = {.frames = {inputs, 1}};
    const gint64 start = g_get_monotonic_time();
    g_autoptr(FlDrawing) drawing = fl_drawing_open(&options, NULL, &error);
    g_assert_no_error(error);
    const double read_s = (double)(g_get_monotonic_time() - start) * 1e-6;
    const int n = fl_drawing_frames(drawing);
    double sum = 0, least = 99;
    int where = 0;
    for (int t = 0; t < n; t++) {
        const double psnr = flat_psnr(drawing, t);
        sum += psnr;
        where = psnr < least ? t : where;
        least = MIN(least, psnr);
    }
    g_autofree char *name = g_path_get_basename(folder);
    printf("%-22s %5.1f %5.1f  frame %3d of %3d, %2d regions, read in %.3f s a frame\n", name,
           least, sum / n, fl_drawing_number(drawing, where), n, fl_drawing_regions(drawing),
           read_s / n);
    fflush(stdout);
}

int main(int argc, char **argv)
{
    printf("%-22s %5s %5s\n", "sequence", "least", "mean");
    for (int i = 1; i < argc; i++)
        print_sequence(argv[i]);
    return 0;
}
