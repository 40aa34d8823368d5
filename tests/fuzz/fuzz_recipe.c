/* What a simulated recording is made of, recipe.ini. */
#include "fuzz.h"
#include "watercolour/recipe.h"
#include <math.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[32];
    const int fd = fuzz_file(data, size, path);
    g_autoptr(GError) error = NULL;
    g_autoptr(FlRecipe) recipe = fl_recipe_load(path, &error);
    g_assert_true((recipe == NULL) == (error != NULL));
    if (recipe)
        g_assert_true(isfinite(recipe->style->fps) && recipe->n_events <= FL_MAX_EVENTS);
    fuzz_file_end(fd);
    return 0;
}
