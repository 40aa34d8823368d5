#include "compose/pigments.h"

#include <glib.h>

/* Those of [C97 fig. 5], checked against two public programs; then three that they lack, and ten of
 * today, whose K is that of their full tone on white paper. */
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
    {"Lamp Black", {2.6f, 2.7f, 2.8f}, {.02f, .02f, .02f}, .04f, 2.0f, .5f, .04f},
    {"Burnt Sienna", {.28f, 1.05f, 2.2f}, {.25f, .12f, .03f}, .06f, 3.0f, .7f, .03f},
    {"Dioxazine Violet", {.95f, 1.75f, .35f}, {.01f, .005f, .06f}, .02f, 3.0f, .2f, .08f},
    {"Lemon Yellow", {.012f, .04f, .896f}, {.004f, .004f, .004f}, .02f, 1.0f, .2f, .08f},
    {"Permanent Yellow", {.012f, .093f, 1.589f}, {.004f, .004f, .004f}, .02f, 1.0f, .2f, .08f},
    {"Permanent Orange", {.012f, .284f, 1.242f}, {.004f, .004f, .004f}, .02f, 1.0f, .2f, .08f},
    {"Pyrrol Scarlet", {.046f, .691f, .922f}, {.004f, .004f, .004f}, .02f, 1.0f, .2f, .08f},
    {"Permanent Rose", {.059f, .799f, .381f}, {.004f, .004f, .004f}, .02f, 1.0f, .2f, .08f},
    {"Permanent Magenta", {.175f, .819f, .269f}, {.004f, .004f, .004f}, .02f, 1.0f, .2f, .08f},
    {"Phthalo Blue", {1.441f, .404f, .144f}, {.004f, .004f, .004f}, .02f, 1.0f, .2f, .08f},
    {"Turquoise", {.869f, .164f, .091f}, {.004f, .004f, .004f}, .02f, 1.0f, .2f, .08f},
    {"Permanent Green", {.636f, .164f, .549f}, {.004f, .004f, .004f}, .02f, 1.0f, .2f, .08f},
    {"Sap Green", {.367f, .202f, .837f}, {.004f, .004f, .004f}, .02f, 1.0f, .2f, .08f},
};

int fl_pigments(const FlPigment **all)
{
    *all = pigments;
    return (int)G_N_ELEMENTS(pigments);
}

const FlPigment *fl_pigment_find(const char *name)
{
    for (size_t i = 0; i < G_N_ELEMENTS(pigments); i++)
        if (g_ascii_strcasecmp(name, pigments[i].name) == 0)
            return &pigments[i];
    return NULL;
}
