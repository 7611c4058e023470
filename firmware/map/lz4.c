#include "lm/lz4.h"

#include <stdbool.h>

#include "fx/mem.h"
#include "fx/sat.h"

enum {
    LENGTH_MASK = 15,  /* a length of the token; this one goes on in the bytes behind it */
    LENGTH_MORE = 255, /* of those bytes: another one follows */
    MATCH_LEAST = 4,   /* bytes of a match of length 0 */
    OFFSET_BYTES = 2,
    SHORT = 32,           /* bytes of most literals and matches */
    LITERALS_LAST = 5,    /* bytes that end a block and are always literals */
    MATCH_START_LAST = 12 /* a match begins so many bytes before the end, or earlier */
};

void lm_lz4_begin(struct lm_lz4 *d, uint8_t *buffer, uint32_t out_bytes, uint32_t block_at,
                  uint32_t block_bytes)
{
    *d = (struct lm_lz4){.buffer = buffer,
                         .in = block_at,
                         .in_end = block_at + block_bytes,
                         .out = 0,
                         .out_end = out_bytes};
}

/* Go on with a length whose first four bits are in *length. False if it passes `most`, which is
 * below 2^31, or the block ends. A length is given up as soon as it passes `most`: no more than
 * most / 255 + 2 bytes are read, and sums stay below 2^31 + 255. */
static bool read_length(struct lm_lz4 *d, uint32_t *length, uint32_t most)
{
    uint32_t more = *length == LENGTH_MASK ? LENGTH_MORE : 0;
    while (more == LENGTH_MORE && *length <= most) {
        if (d->in == d->in_end) {
            return false;
        }
        more = d->buffer[d->in++];
        *length += more;
    }
    return *length <= most;
}

/* Copy up to SHORT bytes as SHORT, which costs less than asking how many. What is written behind
 * them is output that is yet to be made. Sixteen at a time: the copy may begin 16 bytes behind
 * `from`. */
static void copy_short(uint8_t *to, const uint8_t *from)
{
    __builtin_memcpy(to, from, SHORT / 2);
    __builtin_memcpy(to + SHORT / 2, from + SHORT / 2, SHORT / 2);
}

/* Move literals down to the output. They may overlap their copy, which never lies behind them. A
 * piece is no longer than the way they go, which is never nothing: their token lies before them. */
static void copy_literals(struct lm_lz4 *d, uint32_t length)
{
    const uint8_t *from = d->buffer + d->in;
    uint8_t *to = d->buffer + d->out;
    const uint32_t way = d->in - d->out;
    if (length <= SHORT && way >= SHORT && d->in_end - d->in >= SHORT &&
        d->out_end - d->out >= SHORT) {
        copy_short(to, from);
    } else {
        for (uint32_t done = 0; way > 0 && done < length; done += way) {
            memcpy(to + done, from + done, fx_min_u32(way, length - done));
        }
    }
    d->in += length;
    d->out += length;
}

/* Repeat output. A match may be longer than its offset; then it repeats itself, in pieces of which
 * each doubles what there is to copy from. */
static void copy_match(struct lm_lz4 *d, uint32_t offset, uint32_t length)
{
    uint8_t *to = d->buffer + d->out;
    const bool is_short = length <= SHORT && d->out_end - d->out >= SHORT &&
                          d->in - d->out >= SHORT && offset >= SHORT / 2;
    if (is_short) {
        copy_short(to, to - offset);
    } else if (offset == 1) {
        memset(to, to[-1], length);
    } else {
        for (uint32_t done = 0; done < length;) {
            const uint32_t piece = fx_min_u32(offset + done, length - done);
            memcpy(to + done, to - offset, piece);
            done += piece;
        }
    }
    d->out += length;
}

/* Decode the match of a sequence; `length` is that of the token. */
static int run_match(struct lm_lz4 *d, uint32_t length)
{
    if (d->in_end - d->in < OFFSET_BYTES || d->out_end - d->out < MATCH_START_LAST) {
        return LM_ERR_CORRUPT;
    }
    const uint32_t offset = fx_load_u16(d->buffer + d->in);
    d->in += OFFSET_BYTES;
    if (!read_length(d, &length, d->out_end - d->out - LITERALS_LAST - MATCH_LEAST)) {
        return LM_ERR_CORRUPT;
    }
    length += MATCH_LEAST;
    if (offset == 0 || offset > d->out || length > d->in - d->out) {
        return LM_ERR_CORRUPT;
    }
    copy_match(d, offset, length);
    return LM_BUSY;
}

/* Decode a sequence. LM_OK behind the literals that end the block. */
static int run_sequence(struct lm_lz4 *d)
{
    if (d->in == d->in_end) {
        return LM_ERR_CORRUPT;
    }
    const uint32_t token = d->buffer[d->in++];
    uint32_t length = token >> 4;
    if (!read_length(d, &length, d->out_end - d->out) || length > d->in_end - d->in) {
        return LM_ERR_CORRUPT;
    }
    copy_literals(d, length);
    if (d->in == d->in_end) {
        return d->out == d->out_end ? LM_OK : LM_ERR_CORRUPT;
    }
    return run_match(d, token & LENGTH_MASK);
}

int lm_lz4_run(struct lm_lz4 *d, uint32_t sequences)
{
    /* A copy stays in registers: no byte that is written can be a member of it. */
    struct lm_lz4 at = *d;
    int status = LM_BUSY;
    for (uint32_t i = 0; i < sequences && status == LM_BUSY; i++) {
        status = run_sequence(&at);
    }
    *d = at;
    return status;
}
