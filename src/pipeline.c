/* The whole render, stage by stage. */
#include "config.h"
#include "params/config.h"
#include <fluidy/fluidy.h>

const char *fl_version(void)
{
    return FL_VERSION;
}

bool fl_render(const FlRenderOptions *options, GError **error)
{
    g_autoptr(FlConfig) config = fl_config_load(options->config, error);
    if (!config)
        return false;
    g_auto(FlTreatment) treatment = {0};
    if (!fl_config_treatment(config, -1, "", options, &treatment, error))
        return false;
    g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: this version cannot paint yet",
                options->inputs[0]);
    return false;
}
