#include <fluidy/error.h>

GQuark fl_error_quark(void)
{
    return g_quark_from_static_string("fl-error-quark");
}
