/* The parameters of the synthesis as they are by default, for tests to change. */
#ifndef TESTS_DEFAULT_PARAMS_H
#define TESTS_DEFAULT_PARAMS_H

#include "params/params.h"

/* To be freed with g_free(). */
static inline FlParams *default_params(void)
{
    FlParams *params = g_new0(FlParams, 1);
    fl_params_defaults(params);
    return params;
}

#endif
