#include "wire/message.h"

#include "fx/crc32c.h"

#include <errno.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* What is passed over in search of a message: more than the rest of a payload that was cut off. */
enum { LOST_BLOCKS_MAX = 4 * WIRE_PIECE_BYTES / WIRE_BLOCK_BYTES };

static const char magic[8] = {'L', 'M', 'D', 'B', 'W', 'I', 'R', 'E'};

static uint32_t whole_blocks(uint32_t bytes)
{
    return (bytes + WIRE_BLOCK_BYTES - 1) / WIRE_BLOCK_BYTES * WIRE_BLOCK_BYTES;
}

static uint32_t crc_of(const struct wire_message *m)
{
    return fx_crc32c(0, m, offsetof(struct wire_message, crc));
}

int wire_send(const struct wire_link *link, struct wire_message *m, void *payload,
              uint32_t timeout_ms)
{
    const uint32_t length = whole_blocks(m->payload_bytes);
    memcpy(m->magic, magic, sizeof magic);
    m->version = WIRE_VERSION;
    m->payload_crc = m->payload_bytes == 0 ? 0 : fx_crc32c(0, payload, m->payload_bytes);
    m->crc = crc_of(m);
    const int cause = link->send(link->ctx, m, sizeof *m, timeout_ms);
    if (cause != 0 || length == 0) {
        return cause;
    }
    memset((uint8_t *)payload + m->payload_bytes, 0, length - m->payload_bytes);
    return link->send(link->ctx, payload, length, timeout_ms);
}

static void make_printable(struct wire_message *m)
{
    m->text[WIRE_TEXT_BYTES - 1] = '\0';
    for (char *at = m->text; *at != '\0'; at++) {
        if (*at < ' ' || *at > '~') {
            *at = '?';
        }
    }
}

static int find_message(const struct wire_link *link, struct wire_message *m, uint32_t timeout_ms)
{
    for (uint32_t i = 0; i < LOST_BLOCKS_MAX; i++) {
        const int cause = link->receive(link->ctx, m, sizeof *m, timeout_ms);
        if (cause != 0) {
            return cause;
        }
        if (memcmp(m->magic, magic, sizeof magic) == 0 && m->crc == crc_of(m)) {
            return 0;
        }
    }
    return EBADMSG;
}

int wire_receive(const struct wire_link *link, struct wire_message *m, void *payload,
                 uint32_t timeout_ms)
{
    int cause = find_message(link, m, timeout_ms);
    if (cause != 0) {
        return cause;
    }
    make_printable(m);
    if (m->version != WIRE_VERSION) {
        return EPROTONOSUPPORT;
    }
    if (m->payload_bytes > WIRE_PAYLOAD_BYTES) {
        return EMSGSIZE;
    }
    if (m->payload_bytes == 0) {
        return 0;
    }
    cause = link->receive(link->ctx, payload, whole_blocks(m->payload_bytes), timeout_ms);
    if (cause != 0) {
        return cause;
    }
    return fx_crc32c(0, payload, m->payload_bytes) == m->payload_crc ? 0 : EBADMSG;
}

const char *wire_cause(int cause)
{
    switch (cause) {
    case ENODEV:
        return "the cable was pulled, or the program at its other end is gone";
    case ETIMEDOUT:
        return "the other end does not answer";
    case EBADMSG:
        return "what arrived is damaged";
    case EPROTONOSUPPORT:
        return "the other end has another version";
    case EPROTO:
    case EMSGSIZE:
        return "the other end does not keep to the protocol";
    case EINTR:
        return "interrupted";
    default:
        return strerror(cause);
    }
}
