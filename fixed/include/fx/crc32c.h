/* CRC-32C (Castagnoli): the checksum of every record in flash.
 *
 * Polynomial 0x1EDC6F41, reflected, inverted before and after (RFC 3720, 12.1 and B.4). The CRC of
 * "123456789" is 0xE3069283. */
#ifndef FX_CRC32C_H
#define FX_CRC32C_H

#include <stddef.h>
#include <stdint.h>

/* Continue a CRC over `len` more bytes. `crc` is the CRC of the bytes before them, 0 at the start:
 *
 *     crc = fx_crc32c(fx_crc32c(0, head, sizeof head), body, body_bytes);
 *
 * `data` is borrowed for the call and needs no alignment; it is not read when len is 0.
 * Cost: about 5 instructions a byte, in steps of four bytes. */
uint32_t fx_crc32c(uint32_t crc, const void *data, size_t len);

#endif
