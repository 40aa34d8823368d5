/* Names of regions, for people: "leg-fb-865b52". */
#ifndef FLUIDY_DRAWING_REGION_NAMES_H
#define FLUIDY_DRAWING_REGION_NAMES_H

#include "drawing/region_identity.h"

/**
 * A name for every group, unique, of [a-z0-9-]: that of its rule, else the innermost label and the
 * colour, or without a label a word for the colour. What all labels share is not repeated.
 *
 * Returns: a NULL-terminated list of groups->len names, to be freed with g_strfreev().
 */
char **fl_name_groups(const FlSurvey *survey, const GArray *groups, const FlRegionRule *rules);

#endif
