/* The guides of a style's frames, and the parameters of guides. */
#pragma once

#include "guides/guides.h"
#include "params/params.h"
#include "style/style_folder.h"

/** The parameters of guides that are among params; lengths in px are halved at half the size. */
FlGuideParams fl_guide_params(const FlParams *params);

/** The guides of a style, which must stay as long as they do. NULL with an error of theirs set. */
FlGuideSequence *fl_style_guides(const FlStyle *style, const FlParams *params, GError **error);
