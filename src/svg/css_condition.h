/* The conditions of @media [Media Queries 4] and @supports [CSS Conditional 4]. */
#pragma once

#include <stdbool.h>

/** The page that conditions such as @media (min-width: 500px) ask about. */
typedef struct FlCssPage {
    double width, height; // px
} FlCssPage;

/** Returns: true if a light colour screen that shows the page matches a list of queries. */
bool fl_css_media_matches(const char *query, const FlCssPage *page);

/** Returns: true if the condition of an @supports holds for this program. */
bool fl_css_supports(const char *condition);
