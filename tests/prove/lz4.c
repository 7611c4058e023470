/* LZ4 decoder (lm/lz4.h).
 *
 * Invariant of a decoder: out <= in <= in_end, out <= out_end, and the buffer reaches to in_end and
 * to out_end.
 *
 * Proved, of a sequence of any bytes, by its parts: prove_length reads a length and nothing behind
 * the block; prove_literals copies inside the output and from what is there, and moves `in` and
 * `out` alike; prove_match copies from output that is made, to output before what is still to be
 * read, and no copy overlaps itself; prove_sequence: the copies get what they need, the invariant
 * is kept, and a sequence that does not end the block makes four bytes at least, so that a block
 * ends. prove_begin makes the invariant.
 *
 * Assumed: the buffer has 64 bytes, which has room for what is short (32) and what is not; a length
 * goes on for two bytes at most in it. Of literals that overlap their copy three pieces are
 * followed; each further one begins where the one before it ended. That a match repeats the right
 * bytes is not followed either: the fuzz target `lz4` holds it against liblz4's. */
#include <stddef.h>

#define memcpy           proved_memcpy
#define memset           proved_memset
#define __builtin_memcpy proved_memcpy
void *proved_memcpy(void *to, const void *from, size_t length);
void *proved_memset(void *to, int byte, size_t length);
struct lm_lz4;
static void proved_literals(struct lm_lz4 *d, unsigned length);
static void proved_match(struct lm_lz4 *d, unsigned offset, unsigned length);
#include "firmware/map/lz4.c"

#include "prove.h"

enum { BYTES = 64 };

static uint8_t buffer[BYTES];
static uint32_t write_from, write_end, read_end; /* where a copy may write, and read */

struct lm_lz4 nondet_lz4(void);

/* The bytes are not followed: whatever is read from the buffer is anything. A number that is loaded
 * goes to a variable, anything else to the output. */
void *proved_memcpy(void *to, const void *from, size_t length)
{
    PROVE(__CPROVER_same_object(from, buffer));
    const size_t of = (size_t)((const uint8_t *)from - buffer);
    PROVE(length <= BYTES && of <= read_end && length <= read_end - of);
    if (!__CPROVER_same_object(to, buffer)) {
        PROVE(length == OFFSET_BYTES && __CPROVER_w_ok(to, length));
        *(uint16_t *)to = nondet_u16();
        return to;
    }
    const size_t at = (size_t)((uint8_t *)to - buffer);
    PROVE(at >= write_from && at <= write_end && length <= write_end - at);
    PROVE(at + length <= of || of + length <= at || at == of);
    read_end = at + length > read_end ? (uint32_t)(at + length) : read_end;
    return to;
}

void *proved_memset(void *to, int byte, size_t length)
{
    const size_t at = (size_t)((uint8_t *)to - buffer);
    PROVE(at >= write_from && at + length <= write_end && length <= BYTES);
    return to;
}

static bool is_kept(const struct lm_lz4 *d)
{
    return d->buffer == buffer && d->out <= d->in && d->in <= d->in_end && d->out <= d->out_end &&
           d->in_end <= BYTES && d->out_end <= BYTES;
}

static struct lm_lz4 a_decoder(void)
{
    struct lm_lz4 d = nondet_lz4();
    d.buffer = buffer;
    ASSUME(is_kept(&d));
    __CPROVER_havoc_object(buffer);
    return d;
}

void prove_begin(void)
{
    const uint32_t out_bytes = nondet_u32(), at = nondet_u32(), bytes = nondet_u32();
    ASSUME(out_bytes <= BYTES && at <= BYTES && bytes <= BYTES - at);
    struct lm_lz4 d;
    lm_lz4_begin(&d, buffer, out_bytes, at, bytes);
    PROVE(is_kept(&d) && d.in_end == at + bytes && d.out_end == out_bytes);
}

void prove_length(void)
{
    struct lm_lz4 d = a_decoder();
    const struct lm_lz4 before = d;
    uint32_t length = nondet_u32();
    const uint32_t most = nondet_u32();
    ASSUME(length <= LENGTH_MASK && most <= BYTES);
    const bool is_good = read_length(&d, &length, most);
    PROVE(is_kept(&d) && d.in >= before.in && d.out == before.out && d.in_end == before.in_end);
    PROVE(!is_good || length <= most);
}

static bool are_literals(const struct lm_lz4 *d, uint32_t length)
{
    return is_kept(d) && length <= d->in_end - d->in && length <= d->out_end - d->out;
}

static bool is_match(const struct lm_lz4 *d, uint32_t offset, uint32_t length)
{
    return is_kept(d) && offset >= 1 && offset <= d->out && length >= MATCH_LEAST &&
           length <= d->in - d->out && length <= d->out_end - d->out;
}

static void proved_literals(struct lm_lz4 *d, unsigned length)
{
    PROVE(are_literals(d, length));
    d->in += length;
    d->out += length;
}

static void proved_match(struct lm_lz4 *d, unsigned offset, unsigned length)
{
    PROVE(is_match(d, offset, length));
    d->out += length;
}

void prove_literals(void)
{
    struct lm_lz4 d = a_decoder();
    const struct lm_lz4 before = d;
    const uint32_t length = nondet_u32(), way = d.in - d.out;
    ASSUME(are_literals(&d, length) && (way == 0 || length <= 3 * way));
    write_from = d.out, write_end = d.out_end, read_end = d.in_end;
    copy_literals(&d, length);
    PROVE(is_kept(&d) && d.in == before.in + length && d.out == before.out + length);
}

void prove_match(void)
{
    struct lm_lz4 d = a_decoder();
    const struct lm_lz4 before = d;
    const uint32_t offset = nondet_u32(), length = nondet_u32();
    ASSUME(is_match(&d, offset, length));
    write_from = d.out, write_end = d.in < d.out_end ? d.in : d.out_end, read_end = d.out;
    copy_match(&d, offset, length);
    PROVE(is_kept(&d) && d.in == before.in && d.out == before.out + length);
}

void prove_sequence(void)
{
    struct lm_lz4 d = a_decoder();
    const struct lm_lz4 before = d;
    read_end = d.in_end;
    const int status = run_sequence(&d);
    PROVE(status == LM_BUSY || status == LM_OK || status == LM_ERR_CORRUPT);
    PROVE(d.in_end == before.in_end && d.out_end == before.out_end && d.in >= before.in);
    PROVE(status == LM_ERR_CORRUPT || is_kept(&d));
    PROVE(status != LM_BUSY || d.out >= before.out + MATCH_LEAST);
    PROVE(status != LM_OK || (d.out == d.out_end && d.in == d.in_end));
}
