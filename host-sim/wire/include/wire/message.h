/* Messages of a load over a wire. docs/slots.md describes them.
 *
 *     PC      OFFER ──────> DATA, SAME ──> DATA, SAME ──>
 *     panel          WELCOME, ASK ──> ASK ──>          STATUS ──> DONE, or REFUSED at any time
 *
 * The panel leads: it asks for pieces of the image, in any order and as often as it likes, and says
 * which bytes it has there, by their digest. So a load that was cut off goes on by itself. */
#ifndef WIRE_MESSAGE_H
#define WIRE_MESSAGE_H

#include "wire/link.h"

#include <stdint.h>

enum {
    WIRE_VERSION = 1,
    WIRE_PIECE_BYTES = 64 << 10, /* that are asked for at once, at most */
    WIRE_DIGEST_BYTES = 32,
    WIRE_TEXT_BYTES = 512
};

enum wire_kind {
    /* of the PC */
    WIRE_OFFER = 1, /* bytes: length of the image */
    WIRE_DATA,      /* offset and bytes as asked for; the payload is that piece */
    WIRE_SAME,      /* offset and bytes as asked for: the digest is that of the piece */
    WIRE_FAILED,    /* text: why the image cannot be read any more */
    /* of the panel */
    WIRE_WELCOME = 16, /* text: what its slots hold */
    WIRE_ASK,          /* offset and bytes of a piece; digest of what is there, or zeros */
    WIRE_STATUS,       /* offset bytes of `bytes` are checked in the slot */
    WIRE_DONE,         /* figures and text: the load is in its slot and will be flown */
    WIRE_REFUSED       /* text: why not */
};

/* How a load ended, in WIRE_DONE. */
struct wire_figures {
    uint64_t load, image_bytes, written_bytes, kept_bytes;
    uint32_t bad_blocks;
    uint32_t is_there_already; /* 0 or 1 */
};

/* A message as it is on the wire, little-endian. A payload follows, filled up with zeros to whole
 * blocks. */
struct wire_message {
    char magic[8];    /* "LMDBWIRE" */
    uint32_t version; /* WIRE_VERSION. Magic, version and text stay where they are in any version */
    uint32_t kind;    /* enum wire_kind */
    uint64_t session; /* drawn by the PC: what belongs to an earlier one is passed over */
    uint64_t offset, bytes;
    uint32_t payload_bytes, payload_crc; /* CRC-32C; 0 and 0 without */
    struct wire_figures figures;
    uint8_t digest[WIRE_DIGEST_BYTES]; /* SHA-256 */
    char text[WIRE_TEXT_BYTES];        /* what is not printable ASCII is printed as '?' */
    uint8_t reserved[388];             /* 0 */
    uint32_t crc;                      /* CRC-32C of the bytes before it */
};
_Static_assert(sizeof(struct wire_message) == WIRE_BLOCK_BYTES, "a message is one block");

/* Blocks of a payload, at most. */
enum { WIRE_PAYLOAD_BYTES = WIRE_PIECE_BYTES };

/* Send *m, which gets magic, version and checksums, and its payload: at most WIRE_PIECE_BYTES at
 * `payload`, which has room up to the next whole block and is filled up there. Returns 0 or an
 * errno. */
int wire_send(const struct wire_link *link, struct wire_message *m, void *payload,
              uint32_t timeout_ms);

/* Receive the next message; its payload goes to `payload` (WIRE_PAYLOAD_BYTES). Blocks that are no
 * message are passed over, up to a few hundred. Text is made printable and ends with a 0. Returns 0
 * or an errno of the link, or
 * - EBADMSG: no message among so many blocks, or the payload does not fit its checksum,
 * - EPROTONOSUPPORT: a sound message of another version, which stands in m->version,
 * - EMSGSIZE: the payload is longer than any. */
int wire_receive(const struct wire_link *link, struct wire_message *m, void *payload,
                 uint32_t timeout_ms);

/* What an errno of these functions means, in words: "the cable was pulled". */
const char *wire_cause(int cause);

#endif
