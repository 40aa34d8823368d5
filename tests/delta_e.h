/* CIEDE2000 between two sRGB colours, for tests of colour [Sharma, Wu, Dalal 2005]. */
#ifndef TESTS_DELTA_E_H
#define TESTS_DELTA_E_H

#include <math.h>
#include <stdint.h>

static inline double delta_e_light(uint8_t level)
{
    const double s = level / 255.0;
    return s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
}

static inline double delta_e_f(double t)
{
    return t > 216.0 / 24389 ? cbrt(t) : (24389.0 / 27 * t + 16) / 116;
}

static inline void delta_e_lab(const uint8_t rgb[3], double lab[3])
{
    const double r = delta_e_light(rgb[0]), g = delta_e_light(rgb[1]), b = delta_e_light(rgb[2]);
    const double x = delta_e_f((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047);
    const double y = delta_e_f(0.2126729 * r + 0.7151522 * g + 0.0721750 * b);
    const double z = delta_e_f((0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / 1.08883);
    lab[0] = 116 * y - 16, lab[1] = 500 * (x - y), lab[2] = 200 * (y - z);
}

static inline double delta_e_hue(double b, double a)
{
    const double h = atan2(b, a);
    return h < 0 ? h + 2 * M_PI : h;
}

static inline double delta_e(const uint8_t one[3], const uint8_t two[3])
{
    double p[3], q[3];
    delta_e_lab(one, p), delta_e_lab(two, q);
    const double c_mean = (hypot(p[1], p[2]) + hypot(q[1], q[2])) / 2;
    const double g = 0.5 * (1 - sqrt(pow(c_mean, 7) / (pow(c_mean, 7) + pow(25, 7))));
    const double ap = (1 + g) * p[1], aq = (1 + g) * q[1];
    const double cp = hypot(ap, p[2]), cq = hypot(aq, q[2]);
    const double hp = delta_e_hue(p[2], ap), hq = delta_e_hue(q[2], aq);
    double dh = cp * cq == 0 ? 0 : hq - hp;
    dh = dh > M_PI ? dh - 2 * M_PI : dh < -M_PI ? dh + 2 * M_PI : dh;
    double h = hp + hq;
    if (cp * cq != 0)
        h = fabs(hp - hq) <= M_PI ? h / 2 : h < 2 * M_PI ? h / 2 + M_PI : h / 2 - M_PI;
    const double l = (p[0] + q[0]) / 2, c = (cp + cq) / 2, degree = M_PI / 180;
    const double t = 1 - 0.17 * cos(h - 30 * degree) + 0.24 * cos(2 * h) +
                     0.32 * cos(3 * h + 6 * degree) - 0.20 * cos(4 * h - 63 * degree);
    const double sl = 1 + 0.015 * (l - 50) * (l - 50) / sqrt(20 + (l - 50) * (l - 50));
    const double sc = 1 + 0.045 * c, sh = 1 + 0.015 * c * t;
    const double turn = 60 * degree * exp(-pow((h / degree - 275) / 25, 2));
    const double rt = -sin(turn) * 2 * sqrt(pow(c, 7) / (pow(c, 7) + pow(25, 7)));
    const double dl = (q[0] - p[0]) / sl, dc = (cq - cp) / sc;
    const double dH = 2 * sqrt(cp * cq) * sin(dh / 2) / sh;
    return sqrt(dl * dl + dc * dc + dH * dH + rt * dc * dH);
}

#endif
