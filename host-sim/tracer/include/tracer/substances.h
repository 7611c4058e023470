/* Relative permittivity of substances by frequency, e' - i e''. A loss is positive here and the
 * imaginary part negative: waves are exp(+i w t).
 *
 * Sources: [P.2040] Recommendation ITU-R P.2040-3, table 3, building materials. [P.527]
 * Recommendation ITU-R P.527-6, equations by their numbers: water, ice, snow, soil, vegetation.
 *
 * Frequencies are GHz, 0.1 to 1000; temperatures degrees Celsius; densities g/cm^3. Nothing fails.
 * Cost: some 100 operations each. */
#ifndef TRACER_SUBSTANCES_H
#define TRACER_SUBSTANCES_H

#include <complex.h>

/* [P.2040], (28) and (29): e' = a f^b, conductivity c f^d S/m, loss 17.98 conductivity / f. */
struct substance_building {
    const char *name;
    double a, b, c, d;
    double low_ghz, high_ghz; /* where the recommendation has measurements for it */
};

/* "concrete", "brick", "wood", "glass", "marble", "plywood" or "metal"; else NULL. */
const struct substance_building *substance_building_find(const char *name);
double complex substance_building(const struct substance_building *s, double ghz);
double substance_conductivity(const struct substance_building *s, double ghz); /* S/m */

/* [P.527], (5) to (13): liquid water without salt, and (28) to (34): ice. */
double complex substance_water(double celsius, double ghz);
double complex substance_ice(double celsius, double ghz);

/* [P.527], (51) to (53), up to 0 degrees. */
double complex substance_dry_snow(double density, double celsius, double ghz);

/* At 0 degrees, with a share of water by volume up to 0.12, 3 to 37 GHz: the fit to measured snow
 * of Hallikainen, Ulaby, Abdelrazik, IEEE Trans. AP-34, 1986, as Ulaby and Long (2014, 4-6) give
 * it. [P.527], (54), has drops in it that are spheres, and a tenth of the measured loss. */
double complex substance_wet_snow(double density, double water_share, double ghz);

/* [P.527], (58) to (70), above freezing. */
struct substance_soil {
    double sand_percent, clay_percent;
    double grain_density, bulk_density;
    double water_share; /* by volume, above 0 */
    double celsius;
};
double complex substance_soil(const struct substance_soil *s, double ghz);

/* [P.527], (72) to (77): what leaves are made of, above freezing. moisture: weight of the water in
 * a leaf over that of the leaf, 0..0.7. */
double complex substance_leaf(double moisture, double celsius, double ghz);

/* Leaves in air, of which they fill a share: the mean of the refractive indices (Ulaby, Long,
 * Microwave Radar and Radiometric Remote Sensing, 2014, 4-8). */
double complex substance_canopy(double leaf_share, double moisture, double celsius, double ghz);

#endif
