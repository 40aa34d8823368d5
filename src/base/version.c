#include "config.h"

#include <fluidy/fluidy.h>

const char *fl_version(void)
{
    return FL_VERSION;
}
