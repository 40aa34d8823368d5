/* The pigments of [C97 fig. 5], checked against two public programs. */
#include "watercolour/recipe.h"

#include <glib.h>

static const FlPigment pigments[] = {
    // name, K, S, rho, omega, gamma, diffusion (ours: the finer, the faster)
    {"Quinacridone Rose", {.22f, 1.47f, .57f}, {.05f, .003f, .03f}, .02f, 5.5f, .81f, .08f},
    {"Indian Red", {.46f, 1.07f, 1.50f}, {1.28f, .38f, .21f}, .05f, 7.0f, .40f, .02f},
    {"Cadmium Yellow", {.10f, .36f, 3.45f}, {.97f, .65f, .007f}, .05f, 3.4f, .81f, .03f},
    {"Hooker's Green", {1.62f, .61f, 1.64f}, {.01f, .012f, .003f}, .09f, 1.0f, .41f, .06f},
    {"Cerulean Blue", {1.52f, .32f, .25f}, {.06f, .26f, .40f}, .01f, 1.0f, .31f, .03f},
    {"Burnt Umber", {.74f, 1.54f, 2.10f}, {.09f, .09f, .004f}, .09f, 9.3f, .90f, .03f},
    {"Cadmium Red", {.14f, 1.08f, 1.68f}, {.77f, .015f, .018f}, .02f, 1.0f, .63f, .03f},
    {"Brilliant Orange", {.13f, .81f, 3.45f}, {.005f, .009f, .007f}, .01f, 1.0f, .14f, .08f},
    {"Hansa Yellow", {.06f, .21f, 1.78f}, {.50f, .88f, .009f}, .06f, 1.0f, .08f, .06f},
    {"Phthalo Green", {1.55f, .47f, .63f}, {.01f, .05f, .035f}, .02f, 1.0f, .12f, .10f},
    {"French Ultramarine", {.86f, .86f, .06f}, {.005f, .005f, .09f}, .01f, 3.1f, .91f, .03f},
    {"Interference Lilac", {.08f, .11f, .07f}, {1.25f, .42f, 1.43f}, .06f, 1.0f, .08f, .03f},
};

enum { N_PIGMENTS = sizeof pigments / sizeof *pigments };

const FlPigment *fl_pigment_find(const char *name)
{
    for (int i = 0; i < N_PIGMENTS; i++)
        if (g_ascii_strcasecmp(name, pigments[i].name) == 0)
            return &pigments[i];
    return NULL;
}
