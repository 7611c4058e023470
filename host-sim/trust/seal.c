#include "trust/seal.h"

#include <string.h>

uint32_t trust_seal_signed_bytes(uint32_t count)
{
    return (uint32_t)(sizeof(struct trust_seal_head) + count * sizeof(struct trust_seal_digest));
}

uint32_t trust_seal_bytes(uint32_t count)
{
    return trust_seal_signed_bytes(count) + TRUST_SIGNATURE_BYTES;
}

uint32_t trust_seal_message(const struct lm_image_header *header, uint32_t seal_index,
                            const struct trust_seal *seal, uint8_t message[TRUST_MESSAGE_MAX_BYTES])
{
    struct lm_image_header h = *header;
    const uint32_t bytes = trust_seal_signed_bytes(seal->head.count);
    h.sections[seal_index].crc = 0;
    h.crc = 0;
    memcpy(message, &h, sizeof h);
    memcpy(message + sizeof h, seal, bytes); /* head and digests stand one behind the other */
    return (uint32_t)sizeof h + bytes;
}
