/* The radar table as text: what is accepted keeps its contract and reads back to the bit. */
#include "fuzz.h"
#include "lm/radar_check.h"
#include "lm/radar_record.h"
#include "lm/status.h"
#include "radar/text.h"

const uint32_t fuzz_mutations = 20000;

static void check_again(const struct lm_radar *radar)
{
    uint8_t first[LM_RADAR_RECORD_BYTES], second[LM_RADAR_RECORD_BYTES];
    char *text = NULL;
    size_t size = 0;
    struct fuzz_file file;
    struct lm_radar again;
    FILE *out = open_memstream(&text, &size);
    FUZZ_ASSERT(out);
    radar_text_print(out, radar);
    FUZZ_ASSERT(fclose(out) == 0);
    fuzz_file_open(&file, (const uint8_t *)text, size);
    FUZZ_ASSERT(radar_text_read(&again, file.path) == 0);
    fuzz_file_close(&file);
    free(text);
    lm_radar_pack(radar, first);
    lm_radar_pack(&again, second);
    FUZZ_ASSERT(memcmp(first, second, sizeof first) == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_file file;
    struct lm_radar radar;
    fuzz_file_open(&file, data, size);
    if (radar_text_read(&radar, file.path) == 0) {
        FUZZ_ASSERT(lm_radar_check(&radar, NULL) == LM_OK);
        check_again(&radar);
    }
    fuzz_file_close(&file);
    return 0;
}
