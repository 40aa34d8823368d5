#include "params/medium.h"

#include "params/text.h"

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

FlMedium fl_medium_of_word(const char *word)
{
    int medium = FL_MEDIUM_AUTO;
    fl_text_choice(word, FL_MEDIUM_WORDS, &medium);
    return (FlMedium)medium;
}
