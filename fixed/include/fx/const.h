/* Constants of mathematics in fixed point, each defined once.
 *
 * Beside each is its formula with more digits. All are rounded to nearest: the error is at most
 * half a unit of the last place. tests/unit/fixed/test_const.c computes each one again in double
 * precision. Constants of the Earth and of units are in lm/const.h. */
#ifndef FX_CONST_H
#define FX_CONST_H

/* Angles: BAM in a radian, and radians in a full turn. */
#define FX_BAM_PER_RADIAN    683565276   /* 2^32 / (2 pi) = 683565275.58: 6.2e-10 too much */
#define FX_BAM_PER_RADIAN_Q2 2734261102u /* 2^34 / (2 pi) = 2734261102.31: 1.1e-10 too little */
#define FX_TWO_PI_Q20        6588397     /* 2 pi 2^20 = 6588397.32: 4.8e-8 too little */
#define FX_TWO_PI_Q26        421657428   /* 2 pi 2^26 = 421657428.27: 6.3e-10 too little */
#define FX_TWO_PI_Q28        1686629713  /* 2 pi 2^28 = 1686629713.07: 3.9e-11 too little */

/* Logarithms. */
#define FX_LOG2_PI_Q16      108232      /* log2(pi) 2^16 = 108232.45 */
#define FX_LOG2_TWO_PI_Q16  173768      /* log2(2 pi) 2^16 = 173768.45 */
#define FX_LOG2_FOUR_PI_Q16 239304      /* log2(4 pi) 2^16 = 239304.45 */
#define FX_LOG2_E_Q16       94548       /* log2(e) 2^16 = 94548.46 */
#define FX_LN2_Q32          2977044472u /* ln(2) 2^32 = 2977044471.82: 6.1e-11 too much */

/* Decibels of a factor of two, and octaves in a decibel. */
#define FX_DB_PER_OCTAVE_Q13  24660    /* 10 log10(2) 2^13 = 24660.38: 1.5e-5 too little */
#define FX_DB_PER_OCTAVE_Q14  49321    /* 10 log10(2) 2^14 = 49320.75: 5.0e-6 too much */
#define FX_DB_PER_OCTAVE_Q24  50504453 /* 10 log10(2) 2^24 = 50504452.60: 8.0e-9 too much */
#define FX_OCTAVES_PER_DB_Q15 10885    /* log2(10) / 10 2^15 = 10885.29: 2.7e-5 too little */
#define FX_OCTAVES_PER_DB_Q16 21771    /* log2(10) / 10 2^16 = 21770.59: 1.9e-5 too much */

/* Roots, to 2.0e-10 of their value. */
#define FX_ROOT_1_2_Q30 759250125 /* sqrt(1/2) 2^30 = 759250124.99 */
#define FX_ROOT_1_3_Q30 619925131 /* sqrt(1/3) 2^30 = 619925131.13 */
#define FX_ROOT_2_3_Q30 876706528 /* sqrt(2/3) 2^30 = 876706528.10 */
#define FX_ROOT_1_6_Q30 438353264 /* sqrt(1/6) 2^30 = 438353264.05 */

#endif
