#include "base/picture.h"

#include "base/alloc.h"
#include "base/error.h"
#include "base/limits.h"

FlPicture *fl_picture_new(int width, int height, GError **error)
{
    g_autofree char *where = g_strdup_printf("a picture of %dx%d pixels", width, height);
    if (width < 1 || height < 1)
        return fl_none(error, FL_ERROR_INPUT, "%s: expected 1 or more", where);
    if (!fl_limit_check(FL_LIMIT_IMAGE, (double)width * height / 1e6, where, error))
        return NULL;
    uint8_t *rgba = fl_alloc((size_t)width * height, 4, "a picture", error);
    if (!rgba)
        return NULL;
    FlPicture *picture = g_new(FlPicture, 1);
    *picture = (FlPicture){width, height, rgba};
    return picture;
}

void fl_picture_free(FlPicture *picture)
{
    if (!picture)
        return;
    free(picture->rgba);
    g_free(picture);
}
