/* Reflectivity of each pixel: Heaton's two ways from classes to radar (section "Database
 * preparation overview"), and what lies between them.
 *
 * Values are constant-gamma reflectivities in dB. Speckle is no part of them: the display unit
 * multiplies it in. */
#ifndef REFLECTIVITY_REFLECT_H
#define REFLECTIVITY_REFLECT_H

#include "hs/class_table.h"
#include "reflectivity/place.h"

#include <stdint.h>

enum { DB_REFLECT_STEPS = 1024 };

/* Law of one class: how its values are distributed in dB, and over the ground. Prepared once.
 *
 * Each texture is a shape in dB, shifted and scaled so that its mean is gamma_db and its standard
 * deviation spread_db, and cut at the limits. Limits nearer than about two spreads narrow the
 * distribution and may move its mean. The shapes:
 * - gaussian: normal in dB, log-normal in power,
 * - rayleigh: power of two Gaussian components, whose amplitude is Rayleigh: many scatterers in a
 *   cell. Its deviation before scaling is 5.57 dB,
 * - k: power Gamma distributed with order texture_shape. With the display's single-look speckle its
 *   amplitude is K distributed: a compound of few scatterers. Its deviation before scaling is
 *   4.34 sqrt(trigamma(order)) dB.
 *
 * Values next to each other are alike, as they are in real pictures. A normal variable of variance
 * 1 stands for the rank of a value in its distribution. It is the sum of three patterns, each of
 * the place alone (reflectivity/place.h):
 * - object: what differs between fields, buildings or districts. Parcels for ground and structures,
 *   smooth for trees and water,
 * - tens of metres: smooth,
 * - cell: smooth over a few metres, 1 dB or less.
 *
 * Structures of a map that shows no single buildings are a mixture: on 4 % of their ground lie
 * bright spots, exponential in dB up to 7.5 spreads above the rest, which they may lift above the
 * limits. Mean and deviation in dB are those of the table with them. Where the map shows buildings,
 * the display unit makes fronts and edges of them, and spots would count these twice. */
struct db_reflect_law {
    const struct db_class *c; /* borrowed */
    uint64_t seed;            /* of the class: hash of its name */
    double weight[3];         /* of the patterns; their squares sum to 1 */
    double spot_share, spot_db, spot_shift_db;
    double mean_db;                       /* of the power of all ground of the class */
    float value_db[DB_REFLECT_STEPS + 1]; /* over the rank, -DB_REFLECT_RANK_MAX to .. MAX */
};

#define DB_REFLECT_RANK_MAX 4.5

/* `pixel_m` is that of the class map, by which structures have spots (8 m or more) or not. */
void db_reflect_law_init(struct db_reflect_law *law, const struct db_class *c, double pixel_m);

/* The rank of a place in its class: normal with mean 0 and variance 1, for whatever else than
 * reflectivity differs within a class. */
double db_reflect_rank(const struct db_reflect_law *law, uint64_t seed, struct reflect_place p);

/* The value at a place: the same for the same seed and place. */
double db_reflect_assign(const struct db_reflect_law *law, uint64_t seed, struct reflect_place p);

/* The value of a pixel that stands among others in a class map: `around` has the indices of 3 x 3
 * pixels in `laws`, row by row, DB_CLASS_NODATA where there is none; the pixel itself is around[4].
 *
 * A map's pixel has one class, and its ground more: where grown classes of ground or trees meet,
 * the value is the mean power of theirs at the place, weighted 1 2 1 both ways. What people laid
 * out, water and structures keep their edge: such a pixel around counts as the pixel's own class.
 *
 * `object` takes the place of the pattern of objects for the pixel's own class: what its field or
 * roof has, in deviations from the class's mean (db_brightness_deviations). NAN: the pattern. */
double db_reflect_assign_among(const struct db_reflect_law *laws, const uint8_t around[9],
                               double object, uint64_t seed, struct reflect_place p);

/* The value of a cell of `width_m` a side around a place, as the mean power of its ground has it:
 * up to 5 m the value at its middle; beyond, the mean power at up to 4 x 4 places of it. */
double db_reflect_assign_cell(const struct db_reflect_law *law, uint64_t seed, double latitude,
                              double longitude, double width_m);

/* Brightness of the pixels of each class, gathered in a first pass over the image. */
struct db_brightness {
    double sum[DB_CLASS_MAX], square[DB_CLASS_MAX], count[DB_CLASS_MAX];
};

void db_brightness_add(struct db_brightness *b, int class_index, double brightness);

/* How far a brightness is from its class's mean, in deviations. NAN for NAN, and for a class of
 * one brightness. */
double db_brightness_deviations(const struct db_brightness *b, int class_index, double brightness);

/* The value of a pixel of the class from its brightness: mean and spread of the class's brightness
 * become its gamma_db and spread_db, held within the limits. Water is set to gamma_db throughout, a
 * large forward scattering surface (Heaton); so is a class of one brightness. */
double db_reflect_adjust(const struct db_class *c, const struct db_brightness *b, int class_index,
                         double brightness);

#endif
