#include "base/colour_difference.h"

#include <math.h>
#include <stddef.h>

static float linear(float level)
{
    const float s = level / 255;
    return s <= 0.04045f ? s / 12.92f : powf((s + 0.055f) / 1.055f, 2.4f);
}

static float lab_curve(float t)
{
    return t > 216.0f / 24389 ? cbrtf(t) : (24389.0f / 27 * t + 16) / 116;
}

void fl_lab(const float level[3], float lab[3])
{
    const float r = linear(level[0]), g = linear(level[1]), b = linear(level[2]);
    const float x = lab_curve((0.4124f * r + 0.3576f * g + 0.1805f * b) / 0.9505f);
    const float y = lab_curve(0.2126f * r + 0.7152f * g + 0.0722f * b);
    const float z = lab_curve((0.0193f * r + 0.1192f * g + 0.9505f * b) / 1.089f);
    lab[0] = 116 * y - 16;
    lab[1] = 500 * (x - y);
    lab[2] = 200 * (y - z);
}

float fl_colour_difference(const uint8_t a[3], const uint8_t b[3])
{
    const float from[3] = {a[0], a[1], a[2]}, to[3] = {b[0], b[1], b[2]};
    float x[3], y[3];
    fl_lab(from, x);
    fl_lab(to, y);
    const float l = x[0] - y[0], u = x[1] - y[1], v = x[2] - y[2];
    return sqrtf(l * l + u * u + v * v);
}

const char *fl_colour_word(const uint8_t rgb[3])
{
    static const struct {
        const char *word;
        uint8_t rgb[3];
    } words[] = {
        {"black", {16, 16, 16}},         {"dark-grey", {74, 74, 74}},
        {"grey", {128, 128, 128}},       {"light-grey", {200, 200, 200}},
        {"white", {252, 252, 252}},      {"red", {214, 40, 40}},
        {"dark-red", {130, 20, 30}},     {"pink", {245, 160, 180}},
        {"crimson", {200, 30, 90}},      {"orange", {245, 140, 30}},
        {"peach", {252, 205, 170}},      {"brown", {130, 85, 50}},
        {"dark-brown", {70, 45, 30}},    {"tan", {195, 155, 110}},
        {"beige", {245, 235, 205}},      {"yellow", {250, 215, 50}},
        {"olive", {130, 130, 40}},       {"green", {70, 165, 70}},
        {"dark-green", {25, 90, 45}},    {"light-green", {165, 220, 140}},
        {"teal", {20, 130, 130}},        {"cyan", {60, 210, 220}},
        {"light-blue", {160, 205, 240}}, {"blue", {45, 105, 215}},
        {"navy", {25, 35, 95}},          {"violet", {120, 70, 190}},
        {"purple", {110, 40, 110}},      {"lilac", {200, 175, 230}},
        {"magenta", {225, 50, 200}},     {"blue", {0, 0, 255}},
        {"green", {0, 255, 0}},          {"pink", {250, 215, 220}},
    };
    size_t best = 0;
    for (size_t i = 1; i < sizeof words / sizeof words[0]; i++)
        if (fl_colour_difference(rgb, words[i].rgb) < fl_colour_difference(rgb, words[best].rgb))
            best = i;
    return words[best].word;
}
