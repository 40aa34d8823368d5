/* The pigments of [C97 fig. 5]; checked against two public programs. */
#include "watercolour/kubelka_munk.h"

#include <glib.h>

static const FlPigment pigments[] = {
    // name, K, S, rho, omega, gamma, diffusion (ours: the finer, the faster)
    {"Quinacridone Rose", {.22, 1.47, .57}, {.05, .003, .03}, .02, 5.5, .81, .08},
    {"Indian Red", {.46, 1.07, 1.50}, {1.28, .38, .21}, .05, 7.0, .40, .02},
    {"Cadmium Yellow", {.10, .36, 3.45}, {.97, .65, .007}, .05, 3.4, .81, .03},
    {"Hooker's Green", {1.62, .61, 1.64}, {.01, .012, .003}, .09, 1.0, .41, .06},
    {"Cerulean Blue", {1.52, .32, .25}, {.06, .26, .40}, .01, 1.0, .31, .03},
    {"Burnt Umber", {.74, 1.54, 2.10}, {.09, .09, .004}, .09, 9.3, .90, .03},
    {"Cadmium Red", {.14, 1.08, 1.68}, {.77, .015, .018}, .02, 1.0, .63, .03},
    {"Brilliant Orange", {.13, .81, 3.45}, {.005, .009, .007}, .01, 1.0, .14, .08},
    {"Hansa Yellow", {.06, .21, 1.78}, {.50, .88, .009}, .06, 1.0, .08, .06},
    {"Phthalo Green", {1.55, .47, .63}, {.01, .05, .035}, .02, 1.0, .12, .10},
    {"French Ultramarine", {.86, .86, .06}, {.005, .005, .09}, .01, 3.1, .91, .03},
    {"Interference Lilac", {.08, .11, .07}, {1.25, .42, 1.43}, .06, 1.0, .08, .03},
};

enum { N_PIGMENTS = sizeof pigments / sizeof *pigments };

const FlPigment *fl_pigment_find(const char *name)
{
    for (int i = 0; i < N_PIGMENTS; i++)
        if (g_ascii_strcasecmp(name, pigments[i].name) == 0)
            return &pigments[i];
    return NULL;
}

const char *const *fl_pigment_names(void)
{
    static const char *const names[] = {"Quinacridone Rose",
                                        "Indian Red",
                                        "Cadmium Yellow",
                                        "Hooker's Green",
                                        "Cerulean Blue",
                                        "Burnt Umber",
                                        "Cadmium Red",
                                        "Brilliant Orange",
                                        "Hansa Yellow",
                                        "Phthalo Green",
                                        "French Ultramarine",
                                        "Interference Lilac",
                                        NULL};
    return names;
}
