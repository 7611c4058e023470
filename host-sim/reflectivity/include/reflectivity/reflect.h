/* Reflectivity of each pixel: Heaton's two ways from classes to radar (section "Database
 * preparation overview").
 *
 * Values are constant-gamma reflectivities in dB. Speckle is no part of them: the display unit
 * multiplies it in. */
#ifndef REFLECTIVITY_REFLECT_H
#define REFLECTIVITY_REFLECT_H

#include "hs/class_table.h"

#include <stdint.h>

/* Law of one class: how its values are distributed in dB, prepared once.
 *
 * Each texture is a shape in dB, shifted and scaled so that its mean is gamma_db and its standard
 * deviation spread_db, and drawn again while it falls outside the limits. Limits nearer than about
 * two spreads narrow the distribution and may move its mean. The shapes:
 * - gaussian: normal in dB, log-normal in power,
 * - rayleigh: power of two Gaussian components, whose amplitude is Rayleigh: many scatterers in a
 *   cell. Its deviation before scaling is 5.57 dB,
 * - k: power Gamma distributed with order texture_shape. With the display's single-look speckle its
 *   amplitude is K distributed: a compound of few scatterers. Its deviation before scaling is
 *   4.34 sqrt(trigamma(order)) dB. */
struct db_reflect_law {
    const struct db_class *c;     /* borrowed */
    double shape_mean, shape_dev; /* of the unscaled texture, dB */
    double mean_db;               /* of the power of many pixels */
};

void db_reflect_law_init(struct db_reflect_law *law, const struct db_class *c);

/* The value of the pixel at column x, row y: the same for the same seed and place in whatever order
 * pixels come. */
double db_reflect_assign(const struct db_reflect_law *law, uint64_t seed, int x, int y);

/* The value of a cell as wide and high as 2^halvings pixels, about as the mean power of so many has
 * it: with the mean of their powers, and a 2^halvings-th of their spread. */
double db_reflect_assign_coarse(const struct db_reflect_law *law, uint64_t seed, int x, int y,
                                int halvings);

/* Brightness of the pixels of each class, gathered in a first pass over the image. */
struct db_brightness {
    double sum[DB_CLASS_MAX], square[DB_CLASS_MAX], count[DB_CLASS_MAX];
};

void db_brightness_add(struct db_brightness *b, int class_index, double brightness);

/* The value of a pixel of the class from its brightness: mean and spread of the class's brightness
 * become its gamma_db and spread_db, held within the limits. Water is set to gamma_db throughout, a
 * large forward scattering surface (Heaton); so is a class of one brightness. */
double db_reflect_adjust(const struct db_class *c, const struct db_brightness *b, int class_index,
                         double brightness);

#endif
