/* Kubelka-Munk in the hyperbolic form, arranged so that K = 0 and S = 0 need no division by 0. */
#include "compose/kubelka_munk.h"

#include <math.h>

/*
 * With q = sqrt(K (K + 2 S)), D = (S + K) sinh(q x) + q cosh(q x):  R = S sinh(q x) / D, T = q / D.
 * That is the paper's R = sinh(b S x) / c, T = b / c for a = 1 + K / S, b = sqrt(a a - 1).
 */
FlKmLayer fl_km_layer(double absorption, double scattering, double thickness)
{
    const double q = sqrt(absorption * (absorption + 2 * scattering));
    const double qx = q * thickness;
    if (qx < 1e-9) {
        const double sx = scattering * thickness;
        return (FlKmLayer){sx / (1 + sx), 1 / (1 + sx)};
    }
    if (qx > 300) // sinh and cosh would overflow; the layer is opaque
        return (FlKmLayer){scattering / (scattering + absorption + q), 0};
    const double sh = sinh(qx), d = (scattering + absorption) * sh + q * cosh(qx);
    return (FlKmLayer){scattering * sh / d, q / d};
}

FlKmLayer fl_km_over(FlKmLayer upper, FlKmLayer lower)
{
    const double between = 1 - upper.reflectance * lower.reflectance;
    return (FlKmLayer){upper.reflectance +
                           upper.transmittance * upper.transmittance * lower.reflectance / between,
                       upper.transmittance * lower.transmittance / between};
}
