#include "compose/background.h"

#include "base/error.h"
#include "io/pattern.h"
#include "io/picture_file.h"
#include "io/png.h"
#include "params/text.h"
#include "style/resample.h"
#include <string.h>

static char *backdrop_file(const FlBackground *background, const FlDrawing *drawing, int frame,
                           GError **error)
{
    const int number = fl_drawing_number(drawing, frame);
    return fl_input_is_pattern(background->pattern)
               ? fl_output_name(background->pattern, number, NULL, error)
               : g_strdup(background->pattern);
}

/* Returns: true if all pictures of the background are opaque; one that cannot be read is told when
 * it is its turn. */
static bool pictures_are_opaque(const FlBackground *background, const FlDrawing *drawing)
{
    const int n = fl_input_is_pattern(background->pattern) ? fl_drawing_frames(drawing) : 1;
    for (int f = 0; f < n; f++) {
        g_autofree char *file = backdrop_file(background, drawing, f, NULL);
        if (file && !fl_picture_is_opaque(file))
            return false;
    }
    return true;
}

bool fl_background_init(FlBackground *background, const char *text, const uint8_t paper[3],
                        const FlDrawing *drawing, GError **error)
{
    *background = (FlBackground){.opaque = true};
    memcpy(background->flat, paper, 3);
    memcpy(background->paper, paper, 3);
    if (!text)
        return true;
    if (g_str_equal(text, "none")) {
        background->none = true, background->opaque = false;
    } else if (fl_text_colour(text, background->flat)) {
        memcpy(background->paper, background->flat, 3);
    } else if (fl_picture_named(text)) {
        background->pattern = text;
        background->opaque = pictures_are_opaque(background, drawing);
    } else {
        return fl_fail(error, FL_ERROR_USAGE,
                       "background “%s”: expected #rrggbb, none, a " FL_PICTURE_FILES
                       " file or a pattern of them",
                       text);
    }
    return true;
}

FlPicture *fl_background_picture(const FlBackground *background, const FlDrawing *drawing,
                                 int frame, int width, int height, GError **error)
{
    g_autofree char *file = backdrop_file(background, drawing, frame, error);
    g_autoptr(FlPicture) picture = file ? fl_picture_read(file, error) : NULL;
    if (picture && (picture->width != width || picture->height != height))
        return fl_picture_resize(picture, width, height, error);
    return g_steal_pointer(&picture);
}
