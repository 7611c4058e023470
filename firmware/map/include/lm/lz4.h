/* Decoder of LZ4 blocks, for tile records. Written from the document "LZ4 Block Format
 * Description" of the LZ4 project.
 *
 * A block is a list of sequences. Each is some literal bytes and a match, which repeats bytes of
 * the output; the last one has literals alone:
 *
 *     token | more of the length | literals | offset | more of the length
 *     1 byte       0..             0..        2 bytes      0..
 *
 * One buffer holds the output and the block. The output begins at the start of the buffer. The
 * block lies behind it or in its end, so that a record can be read into the end of the memory that
 * it is decoded to:
 *
 *     0               out             in                  in_end
 *     +----------------+---------------+-------------------+
 *     | decoded        | free          | not yet read      |
 *     +----------------+---------------+-------------------+
 *
 * Every byte of the block is hostile. Whatever they are, the decoder
 * - reads nothing outside the block and the output before `out`,
 * - writes nothing outside the output, and nothing over what is not yet read,
 * - ends after out_end / 4 + 1 sequences at most, because a match has at least four bytes.
 *
 * It accepts what the reference decoder LZ4_decompress_safe accepts with exactly `out_bytes` of
 * output, 1 or more, and is stricter in three places. It refuses
 * - offset 0, which the description calls invalid and the reference takes for zeros,
 * - fewer than five literals in the end, wherever the reference overlooks that,
 * - a block in the end of its output that would overtake itself.
 *
 * Example: decode a block of 100 bytes that lies in the last of 4,096.
 *
 *     struct lm_lz4 d;
 *     lm_lz4_begin(&d, buffer, 4096, 3996, 100);
 *     int status = LM_BUSY;
 *     while (status == LM_BUSY) {
 *         status = lm_lz4_run(&d, 64);                      some work, then something else
 *     } */
#ifndef LM_LZ4_H
#define LM_LZ4_H

#include <stdint.h>

#include "lm/status.h"

/* Block being decoded. All members are places in the buffer, below 2^31. out <= in always. */
struct lm_lz4 {
    uint8_t *buffer;       /* borrowed from begin to end */
    uint32_t in, in_end;   /* of the next byte to be read, and of the block's end */
    uint32_t out, out_end; /* of the next byte to be written, and of the output's end */
};

/* Start to decode `block_bytes` bytes from `block_at` on in `buffer` to exactly `out_bytes` bytes
 * at its start. The buffer reaches to the end of the block, and of the output if that is further.
 * Both ends are below 2^31. */
void lm_lz4_begin(struct lm_lz4 *d, uint8_t *buffer, uint32_t out_bytes, uint32_t block_at,
                  uint32_t block_bytes);

/* Decode at most `sequences` sequences. Returns
 * - LM_BUSY: the block goes on; call again.
 * - LM_OK: the output is complete.
 * - LM_ERR_CORRUPT: this is no block of `out_bytes`. The buffer is unspecified; do not call again.
 *
 * Cost: some 90 instructions a sequence on the A53, of tiles. */
int lm_lz4_run(struct lm_lz4 *d, uint32_t sequences);

#endif
