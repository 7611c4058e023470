/* A slot of any bytes: its two records, and the image in it. The first byte of the input says which
 * checksums are put right. What is whole at the greater depth is whole at the lesser, and is flown
 * by a board that has the same bytes in half of its flash. */
#include "fuzz.h"
#include "lm/image.h"
#include "lm/slot_flash.h"
#include "memory_flash.h"
#include "seal.h"
#include "slots/slot.h"

#include <errno.h>

const uint32_t fuzz_mutations = 20000;

struct slot_bytes {
    struct lm_slot_record copies[LM_SLOT_COPIES];
    uint8_t *image;
    size_t size;
};

static int read_image(void *ctx, uint64_t offset, void *to, uint32_t length)
{
    const struct slot_bytes *b = ctx;
    if (offset > b->size || length > b->size - offset) {
        return EIO;
    }
    memcpy(to, b->image + offset, length);
    return 0;
}

static int read_record(void *ctx, uint32_t copy, struct lm_slot_record *record)
{
    const struct slot_bytes *b = ctx;
    *record = b->copies[copy];
    return 0;
}

/* Beside those of enum seal_part: both records are sealed; the first is made for the image. */
enum { SEAL_RECORD = 16, MAKE_RECORD = 32 };

static void fill(struct slot_bytes *b, struct fuzz_supply *s, uint8_t parts)
{
    for (int i = 0; i < LM_SLOT_COPIES; i++) {
        const size_t bytes = s->left < sizeof b->copies[i] ? s->left : sizeof b->copies[i];
        memcpy(&b->copies[i], s->at, bytes);
        s->at += bytes;
        s->left -= bytes;
        if (parts & SEAL_RECORD) {
            lm_slot_seal(&b->copies[i]);
        }
    }
    memcpy(b->image, s->at, s->left);
    b->size = s->left;
    seal_image(b->image, b->size, parts);
    struct lm_image_header header;
    if ((parts & MAKE_RECORD) && b->size >= sizeof header) {
        memcpy(&header, b->image, sizeof header);
        b->copies[0].state = LM_SLOT_WHOLE;
        b->copies[0].image_bytes = header.image_bytes;
        b->copies[0].image_crc = header.crc;
        lm_slot_seal(&b->copies[0]);
    }
}

/* The same bytes in slot A of a flash; slot B is erased. What the PC calls whole is flown, unless
 * its record tells of more bytes than this slot has. */
static void fly(const struct slot_bytes *b, const struct slot *judged)
{
    enum { HALF = 256 << 10, ROOM = HALF - LM_SLOT_COPIES * LM_SLOT_RECORD_STEP };
    static uint8_t bytes[LM_SLOTS * HALF];
    static uint64_t scratch[LM_SLOT_SCRATCH_BYTES / 8];
    static struct lm_db db;
    struct memory_flash flash;
    struct lm_slot_flash slots;
    const size_t size = b->size < ROOM ? b->size : ROOM;
    memset(bytes, 0xff, HALF);
    memcpy(bytes, b->image, size);
    for (size_t i = 0; i < LM_SLOT_COPIES; i++) {
        memcpy(bytes + ROOM + i * LM_SLOT_RECORD_STEP, &b->copies[i], sizeof b->copies[i]);
    }
    memory_flash_open(&flash, bytes, sizeof bytes);
    lm_slot_flash_open(&slots, &flash.port, &db, scratch, sizeof scratch, 10);
    const bool is_whole = judged->verdict == SLOT_WHOLE && judged->record.sequence != 0;
    FUZZ_ASSERT(!is_whole || b->size > ROOM || judged->record.image_bytes > ROOM ||
                slots.slot[0].verdict == LM_SLOT_FLOWN);
    FUZZ_ASSERT(slots.slot[1].verdict == LM_SLOT_EMPTY);
    FUZZ_ASSERT(slots.port.size_bytes <= sizeof bytes);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_supply supply = {data, size};
    const uint8_t parts = fuzz_u8(&supply);
    struct slot_bytes bytes = {.image = malloc(supply.left + 1)};
    struct slot slots[LM_SLOTS];
    FUZZ_ASSERT(bytes.image);
    fill(&bytes, &supply, parts);
    const struct slot_medium medium = {
        .ctx = &bytes, .unit_bytes = 4096, .read = read_image, .read_record = read_record};
    for (int i = 0; i < LM_SLOTS; i++) {
        slot_lend(&slots[i], "slot", &medium);
        slot_judge(&slots[i], i == 0 ? SLOT_RECORDS : SLOT_TABLES, NULL, NULL);
        FUZZ_ASSERT(slots[i].verdict != SLOT_DAMAGED || slots[i].fault.cause[0] != '\0');
    }
    FUZZ_ASSERT(slots[0].verdict != SLOT_WHOLE || slots[1].verdict == SLOT_WHOLE);
    (void)slot_choose(slots);
    fly(&bytes, &slots[0]);
    free(bytes.image);
    return 0;
}
