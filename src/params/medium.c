#include "params/medium.h"

const char *fl_medium_word(FlMedium medium)
{
    static const char *const words[] = {"auto", "transparent", "opaque", "body"};
    return words[medium];
}

const char *fl_marks_word(FlMarks marks)
{
    static const char *const words[] = {"auto", "off", "charcoal", "pastel", "brush"};
    return words[marks];
}
