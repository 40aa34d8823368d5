#include <fluidy/error.h>

G_DEFINE_QUARK(fl-error, fl_error)
