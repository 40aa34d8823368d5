/* The lint of path data. */
#include "svg/path_data.h"
#include "fuzz.h"
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    g_autofree char *text = fuzz_text(data, size);
    const char *where = fl_path_data_error(text);
    g_assert_true(!where || (where >= text && where <= text + strlen(text)));
    return 0;
}
