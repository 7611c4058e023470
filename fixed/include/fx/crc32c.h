/* CRC-32C (Castagnoli), the check on every record in flash. */
#ifndef FX_CRC32C_H
#define FX_CRC32C_H

#include <stddef.h>
#include <stdint.h>

/* The CRC of `len` bytes following those whose CRC is `crc`; start with 0. Polynomial 0x1EDC6F41,
 * reflected, inverted before and after (RFC 3720, 12.1 and B.4): "123456789" gives 0xE3069283.
 * Cost about 5 instructions a byte, in steps of four bytes. */
uint32_t fx_crc32c(uint32_t crc, const void *data, size_t len);

#endif
