/* The radar record: any bytes, the checksum put right where the first byte says so. What is
 * accepted keeps its contract and packs to the same bytes. */
#include "fuzz.h"
#include "fx/crc32c.h"
#include "lm/radar_check.h"
#include "lm/radar_record.h"
#include "lm/status.h"

const uint32_t fuzz_mutations = 60000;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_supply supply = {data, size};
    const uint8_t is_sealed = fuzz_u8(&supply);
    const uint32_t bytes = (uint32_t)supply.left;
    uint8_t *record = malloc(supply.left + 1), packed[LM_RADAR_RECORD_BYTES];
    struct lm_radar *radar = malloc(sizeof *radar);
    FUZZ_ASSERT(record && radar);
    memcpy(record, supply.at, supply.left);
    if (is_sealed && bytes > 4) {
        const uint32_t crc = fx_crc32c(0, record + 4, bytes - 4);
        memcpy(record, &crc, sizeof crc);
    }
    const int status = lm_radar_unpack(radar, record, bytes);
    if (status == LM_OK || status == LM_ERR_TABLE) {
        FUZZ_ASSERT(lm_radar_check(radar, NULL) == status);
    }
    if (status == LM_OK) {
        lm_radar_pack(radar, packed);
        FUZZ_ASSERT(bytes == sizeof packed && memcmp(packed, record, sizeof packed) == 0);
    }
    free(radar);
    free(record);
    return 0;
}
