#include "base/error.h"
#include "svg/svg_frame.h"

/* Reads a number at *text, after `sign` unless that is 0, and moves *text behind the number. */
static bool part(const char **text, char sign, double *value)
{
    if (sign && **text != sign)
        return false;
    *text += sign != 0;
    char *end;
    *value = g_ascii_strtod(*text, &end);
    const bool read = end != *text && g_ascii_isdigit(**text);
    *text = end;
    return read;
}

bool fl_canvas_parse(const char *text, FlCanvas *canvas, GError **error)
{
    const char *at = text;
    *canvas = (FlCanvas){0};
    const bool size = part(&at, 0, &canvas->width) && part(&at, 'x', &canvas->height) &&
                      canvas->width > 0 && canvas->height > 0;
    const bool corner =
        size && (*at == '\0' || (part(&at, '+', &canvas->x) && part(&at, '+', &canvas->y)));
    if (corner && *at == '\0')
        return true;
    return fl_fail(error, FL_ERROR_USAGE, "canvas “%s”: expected WxH or WxH+X+Y, such as %s", text,
                   "1000x800");
}
