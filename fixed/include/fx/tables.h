/* Tables of fixed/: constants behind the functions of the other headers.
 *
 * Use those functions. The tables are public only because inline functions and kernels read them.
 * The build makes their source by the formulas of host-sim/tables, and a test holds its checksum.
 * All are read-only and live as long as the program. 1.0 in Q31 is 2^31.
 *
 * Three functions have two tables each. The first is a chain of 16 or 64 straight pieces: a row of
 * the lower bytes of their starts, a row of the upper bytes and a row of the slopes. It fits the
 * registers of a vector machine (firmware/kernels/arm64). The second lists the values of the same
 * pieces for machines that load one number. Both give the same bits. */
#ifndef FX_TABLES_H
#define FX_TABLES_H

#include <stdint.h>

/* sin(i / 256 * 90 degrees). The last entry lies past 90 degrees, for interpolation at 90. */
extern const uint32_t fx_table_sin_q31[258];

/* atan(i / 256) in BAM * 4, and the slope 1 / (1 + (i / 256)^2). */
extern const uint32_t fx_table_atan_bam_q2[257];
extern const uint32_t fx_table_atan_slope_q31[257];

/* 1 / (1 + (i + 0.5) / 256): the start of fx_recip_q. */
extern const uint16_t fx_table_recip_q16[256];

/* 1 / sqrt((i + 64.5) / 256): 1..2 for arguments 1/4..1. The start of fx_sqrt_u64. */
extern const uint16_t fx_table_rsqrt_q15[192];

/* log2(1 + i / 256), with the end of the octave as entry 256. */
extern const uint32_t fx_table_log2_q31[257];

/* 2^(i / 256), 1..2. */
extern const uint32_t fx_table_exp2_q31[256];

/* 10 * log10(1 + (i + 0.5) / 256) + 1/512 dB, which is the half for rounding: see fx_db_q8. */
extern const uint16_t fx_table_db_q14[256];

/* Decibels in straight pieces: see fx_db_q8_vec. Entry i of the steps is 10 * log10(i + 0.5), by
 * the 8 bits behind the leading one of i. Entry 0 is far below all others. */
extern const uint8_t fx_table_db_lines[3][16];
extern const int32_t fx_table_db_steps_q13[4096];

/* 2^(i / 256) in straight pieces of Q15, the values then in Q31: see fx_power_q24_vec. */
extern const uint8_t fx_table_power_lines[3][16];
extern const uint32_t fx_table_power_q31[256];

/* Decibels that a power adds to a larger one, d = (i + 0.5) / 16 dB above it:
 * 10 * log10(1 + 10^(-d / 10)) dB. Pieces in Q13, values in Q8: see fx_db_q8_sum_vec. */
extern const uint8_t fx_table_db_sum_lines[3][64];
extern const int32_t fx_table_db_sum_q8[512];

/* CRC-32C register of one byte followed by k zero bytes, for k = 0..3: see fx_crc32c. */
extern const uint32_t fx_table_crc32c[4][256];

#endif
