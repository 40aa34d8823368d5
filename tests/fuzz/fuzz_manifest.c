/* What an artist says of a style, style.ini. */
#include "fuzz.h"
#include "style/manifest.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[32];
    const int fd = fuzz_file(data, size, path);
    g_autoptr(GError) error = NULL;
    g_autoptr(FlStyle) style = g_new0(FlStyle, 1);
    const bool read = fl_manifest_read(style, path, &error);
    g_assert_true(read == (error == NULL));
    if (read) {
        g_autofree char *text = fl_manifest_text(style);
        g_assert_nonnull(text);
    }
    fuzz_file_end(fd);
    return 0;
}
