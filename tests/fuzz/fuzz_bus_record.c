/* The record of a bus table: any bytes, the checksum put right where the first byte says so. What
 * is accepted keeps its contract, and the decoder takes any frame of it. */
#include "fuzz.h"
#include "fx/crc32c.h"
#include "lm/bus.h"
#include "lm/bus_record.h"
#include "lm/status.h"

const uint32_t fuzz_mutations = 60000;

/* Frames of each row's identifier, and the same data for all. */
static void try_frames(const struct lm_bus_profile *profile, struct fuzz_supply *data)
{
    static struct lm_bus bus;
    struct lm_bus_event events[LM_BUS_EVENTS];
    lm_bus_init(&bus, profile);
    for (uint32_t i = 0; i < 4u * profile->row_count; i++) {
        const uint32_t row = i % profile->row_count;
        struct lm_can_frame f = {.id = profile->rows[row].id,
                                 .is_extended = profile->framing == LM_BUS_PACKED,
                                 .length = (uint8_t)(i % 2 ? 8 : fuzz_u8(data) % 9),
                                 .time_us = 1000u * i};
        for (uint32_t k = 0; k < sizeof f.data; k++) {
            f.data[k] = fuzz_u8(data);
        }
        if (profile->framing == LM_BUS_CANAEROSPACE && i % 4 != 0) {
            f.data[1] = (uint8_t)__builtin_ctz(profile->rows[row].types);
        }
        const uint32_t count = lm_bus_take(&bus, &f, events);
        for (uint32_t k = 0; k < count; k++) {
            FUZZ_ASSERT(events[k].field < LM_BUS_FIELDS && events[k].row < profile->row_count);
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_supply supply = {data, size};
    const uint8_t is_sealed = fuzz_u8(&supply);
    const uint32_t bytes = (uint32_t)supply.left;
    uint8_t *record = malloc(supply.left + 1), packed[LM_BUS_RECORD_BYTES_MAX];
    struct lm_bus_table *table = calloc(1, sizeof *table);
    FUZZ_ASSERT(record && table);
    memcpy(record, supply.at, supply.left);
    if (is_sealed && bytes > 8) {
        const uint16_t length = (uint16_t)bytes;
        memcpy(record + 6, &length, sizeof length);
        const uint32_t crc = fx_crc32c(0, record + 4, bytes - 4);
        memcpy(record, &crc, sizeof crc);
    }
    const int status = lm_bus_unpack(table, record, bytes);
    if (status == LM_OK) {
        FUZZ_ASSERT(lm_bus_profile_check(&table->profile, NULL) == LM_OK);
        FUZZ_ASSERT(lm_bus_pack(&table->profile, packed) == bytes);
        FUZZ_ASSERT(memcmp(packed + LM_BUS_RECORD_HEAD_BYTES, record + LM_BUS_RECORD_HEAD_BYTES,
                           bytes - LM_BUS_RECORD_HEAD_BYTES) == 0);
        try_frames(&table->profile, &supply);
    }
    free(table);
    free(record);
    return 0;
}
