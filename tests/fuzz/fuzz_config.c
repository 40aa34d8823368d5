/* Config files. */
#include "fuzz.h"
#include "params/config.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[32];
    const int fd = fuzz_file(data, size, path);
    g_autoptr(GError) error = NULL;
    g_autoptr(FlConfig) config = fl_config_load(path, NULL, &error);
    g_assert_true((config == NULL) == (error != NULL));
    for (int r = -1; config && r < config->n_rules; r++) {
        g_auto(FlRegionSettings) settings = {0};
        fl_config_region_settings(config, r, "hair", NULL, &settings);
    }
    fuzz_file_end(fd);
    return 0;
}
