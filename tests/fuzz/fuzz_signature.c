/* A signature file of any bytes. The first byte of the input says which checksums are put right;
 * the rest is the file. */
#include "fuzz.h"
#include "hs/signature_file.h"

#include "fx/crc32c.h"

const uint32_t fuzz_mutations = 8000;

enum { SEAL_HEAD = 1, SEAL_RECORD = 2, SEAL_CHIPS = 4, HEAD = 64 };

static void put_u32(uint8_t *at, uint32_t value)
{
    memcpy(at, &value, sizeof value);
}

/* docs/FORMATS.md, 1.9. */
static void seal(uint8_t *file, size_t size, uint8_t parts)
{
    if ((parts & SEAL_HEAD) && size >= HEAD) {
        put_u32(file + HEAD - 4, fx_crc32c(0, file, HEAD - 4));
    }
    if ((parts & SEAL_RECORD) && size >= HEAD + LM_SIGNATURE_BYTES) {
        put_u32(file + HEAD, fx_crc32c(0, file + HEAD + 4, LM_SIGNATURE_BYTES - 4));
    }
    for (size_t at = HEAD + LM_SIGNATURE_BYTES; (parts & SEAL_CHIPS) && at + LM_CHIP_BYTES <= size;
         at += LM_CHIP_BYTES) {
        put_u32(file + at, fx_crc32c(0, file + at + 4, LM_CHIP_BYTES - 4));
    }
}

static void use(struct db_signature *s)
{
    const uint32_t chips = db_signature_chips(&s->head);
    for (uint32_t i = 0; i < 64; i++) {
        const struct lm_chip_choice choice =
            lm_signature_choose(&s->head, i * 0x07654321u, i * 0x01234567u);
        FUZZ_ASSERT(choice.aspect < s->head.aspects && choice.depression < s->head.depressions);
    }
    db_signature_seal(s, 15, 100);
    FUZZ_ASSERT(lm_signature_check(&s->head, 100 + chips) == LM_OK);
    FUZZ_ASSERT(lm_chip_check(&s->chips[chips - 1], 15, s->head.aspects - 1u,
                              s->head.depressions - 1u) == LM_OK);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_file file;
    struct db_signature s;
    struct fuzz_supply supply = {data, size};
    const uint8_t parts = fuzz_u8(&supply);
    uint8_t *sealed = malloc(supply.left + 1);
    FUZZ_ASSERT(sealed);
    memcpy(sealed, supply.at, supply.left);
    seal(sealed, supply.left, parts);
    fuzz_file_open(&file, sealed, supply.left);
    if (db_signature_read(&s, file.path) == 0) {
        use(&s);
        db_signature_free(&s);
    }
    fuzz_file_close(&file);
    free(sealed);
    return 0;
}
