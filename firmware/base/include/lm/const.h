/* Constants of the Earth, of waves and of units in fixed point, each defined once.
 *
 * Beside each is its formula with more digits. All but one are rounded to nearest.
 * tests/unit/firmware/base/test_const.c computes each one again in double precision. Constants of
 * mathematics are in fx/const.h. */
#ifndef LM_CONST_H
#define LM_CONST_H

/* WGS-84 (NIMA TR8350.2, table 3.1): the semi-major axis in metres, and the first eccentricity
 * squared, cut instead of rounded. */
#define LM_SEMI_MAJOR_M      6378137
#define LM_ECCENTRICITY2_Q30 7188035 /* 0.00669437999014 2^30 = 7188035.78: 1.1e-7 too little */

/* Length of one BAM of latitude: a meridian of 40,007,862.917 m over 2^32 is 9.31506 mm. */
#define LM_MM_PER_BAM_Q16 610472 /* 610471.54: 7.5e-7 too much */

/* Curvature of the Earth under standard refraction, which makes its mean radius of 6,371,000 m 4/3
 * as large. The ground at ground range s is s^2 / (2 * 4/3 radius) below the horizontal plane. */
#define LM_TWO_RADII_M   16989333   /* 8/3 6371000 m = 16989333.33: 2.0e-8 too little */
#define LM_CURVATURE_Q48 16567747LL /* 2^48 / (8/3 6371000 m) = 16567747.02: 1.2e-9 too little */

/* Half the speed of light, metres a nanosecond: the range of an echo over its delay. */
#define LM_HALF_LIGHT_M_PER_NS_Q24 2514841u /* 0.149896229 2^24 = 2514841.41: 1.6e-7 too little */

/* Loss of a Gaussian beam at one beam width off its axis. At half a beam width half the power is
 * left. Hence the gain at x beam widths is 2^(-4 x^2) one way and 2^(-8 x^2) both ways. */
#define LM_BEAM_ONE_WAY_DB_Q8 3083 /* 40 log10(2) 2^8 = 3082.55: 1.5e-4 too much */
#define LM_BEAM_TWO_WAY_DB_Q8 6165 /* 80 log10(2) 2^8 = 6165.09: 1.5e-5 too little */

/* log2 of the two-way beam's width as a rectangle of the same top and area, sqrt(pi / (8 ln 2)) of
 * the one-way half-power width. */
#define LM_LOG2_TWO_WAY_Q16 (-26861) /* log2(0.752694) 2^16 = -26861.16 */

/* Units of length: the nautical mile, the binary logarithm of ten of them in metres * 256, and the
 * foot of 0.3048 m. */
#define LM_NM_M                 1852
#define LM_LOG2_TEN_NM_M_Q8_Q16 1453379 /* log2(18520 * 256) 2^16 = 1453378.53 */
#define LM_FOOT_UM              304800
#define LM_FEET_PER_M_Q12       13438 /* 2^12 / 0.3048 = 13438.32: 2.4e-5 too little */

/* log2 of a square millimetre in square metres. */
#define LM_LOG2_MM2_Q16 (-1306235) /* -6 log2(10) 2^16 = -1306235.28 */

#endif
