/* Radiation of black bodies. */
#ifndef INFRARED_PLANCK_H
#define INFRARED_PLANCK_H

/* Of all wavelengths, into the half space, W/m2 (Stefan and Boltzmann). */
double ir_radiation_w_m2(double kelvin);

/* The share of it below a wavelength times the temperature, um K above 0: Planck's law integrated
 * by the series of Chang and Rhee (1984). Error below 1e-9 up to 10,000 um K. */
double ir_fraction_below(double um_kelvin);

/* Radiance between two wavelengths, W/(m2 sr). */
double ir_band_radiance(double low_um, double high_um, double kelvin);

#endif
