/* The constant tables of fixed/. The build makes src/tables.c by the formulas of host-sim/tables; a
 * test knows its sum. Use the functions of the other headers; these names are public only because
 * inline functions reach them. 1.0 in Q31 is 2^31. */
#ifndef FX_TABLES_H
#define FX_TABLES_H

#include <stdint.h>

/* sin(i / 256 * 90 degrees); the last one lies past 90 degrees, for interpolation at 90. */
extern const uint32_t fx_table_sin_q31[258];

/* atan(i / 256) as an angle of fx_bam_t with 2 more bits, and its slope 1 / (1 + (i / 256)^2). */
extern const uint32_t fx_table_atan_bam_q2[257];
extern const uint32_t fx_table_atan_slope_q31[257];

/* 1 / (1 + (i + 0.5) / 256) in Q16. */
extern const uint16_t fx_table_recip_q16[256];

/* 1 / sqrt((i + 64.5) / 256) in Q15: 1..2 for arguments 1/4..1. */
extern const uint16_t fx_table_rsqrt_q15[192];

/* log2(1 + i / 256) and 2^(i / 256); both run to the end of the octave. */
extern const uint32_t fx_table_log2_q31[257];
extern const uint32_t fx_table_exp2_q31[256];

/* 10 * log10(1 + (i + 0.5) / 256) + 1/512 dB: see fx_db_q8. */
extern const uint16_t fx_table_db_q14[256];

/* The same in Q13 by straight lines, and for i from those of 8 bits behind its first one; little
 * for i = 0: see fx_db_q8_vec. */
extern const uint8_t fx_table_db_lines[3][16];
extern const int32_t fx_table_db_steps_q13[4096];

/* 2^(i / 256) in Q15 by straight lines, and so in Q31: see fx_power_q24_vec. */
extern const uint8_t fx_table_power_lines[3][16];
extern const uint32_t fx_table_power_q31[256];

/* 10 * log10(1 + 10^(-d / 10)) for d = (i + 0.5) / 16 dB, in Q13 by straight lines, and so in Q8:
 * see fx_db_q8_sum_vec. */
extern const uint8_t fx_table_db_sum_lines[3][64];
extern const int32_t fx_table_db_sum_q8[512];

/* CRC-32C of one byte followed by k zero bytes, for k = 0..3. */
extern const uint32_t fx_table_crc32c[4][256];

#endif
