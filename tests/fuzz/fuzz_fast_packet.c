/* Fast packets: any frames of a few identifiers. What is whole has its bytes, each from a frame. */
#include "fuzz.h"
#include "lm/fast_packet.h"

const uint32_t fuzz_mutations = 100000;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_supply supply = {data, size};
    struct lm_fast_packet *f = calloc(1, sizeof *f);
    uint64_t now_us = 0;
    uint32_t frames = 0;
    FUZZ_ASSERT(f);
    while (supply.left > 0) {
        const uint8_t head = fuzz_u8(&supply);
        struct lm_can_frame frame = {
            .id = head & 3, .is_extended = true, .length = (uint8_t)((head & 4) ? 8 : head >> 3)};
        now_us += head & 0x80 ? 300000 : 1000;
        frame.time_us = now_us;
        for (int i = 0; i < 8; i++) {
            frame.data[i] = i < 2 || !(head & 0x40) ? fuzz_u8(&supply) : (uint8_t)i;
        }
        const struct lm_fast_packet_slot *whole = lm_fast_packet_take(f, &frame);
        frames++;
        FUZZ_ASSERT(!whole || (whole->length >= 1 && whole->length <= LM_FAST_PACKET_BYTES &&
                               whole->id == frame.id && whole->missing == 0 &&
                               whole->last_us == now_us && whole->begun_us <= now_us));
        for (int i = 0; i < LM_FAST_PACKET_SLOTS; i++) {
            FUZZ_ASSERT(f->slot[i].length <= LM_FAST_PACKET_BYTES);
        }
    }
    FUZZ_ASSERT(f->count.whole + f->count.torn + f->count.stray <= 2 * frames);
    free(f);
    return 0;
}
