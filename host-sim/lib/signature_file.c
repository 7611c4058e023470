#include "hs/signature_file.h"

#include "fx/crc32c.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/zero_bytes.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char again[] = "bake the signature again";

/* ---- checksums and unused bytes ---- */

/* Of all that follows a record's first field. */
static uint32_t crc_behind(const void *record, size_t bytes)
{
    return fx_crc32c(0, (const uint8_t *)record + sizeof(uint32_t), bytes - sizeof(uint32_t));
}

void db_signature_seal(struct db_signature *s, uint32_t number, uint32_t chip0)
{
    s->head.chip0 = chip0;
    s->head.crc = crc_behind(&s->head, sizeof s->head);
    for (uint32_t i = 0; i < db_signature_chips(&s->head); i++) {
        struct lm_chip *c = &s->chips[i];
        c->signature = (uint16_t)number;
        c->aspect = (uint16_t)(i % s->head.aspects);
        c->depression = (uint8_t)(i / s->head.aspects);
        c->crc = crc_behind(c, sizeof *c);
    }
}

struct lm_signatures_head db_signatures_head(uint32_t count, uint32_t chip_count)
{
    struct lm_signatures_head head = {.count = count,
                                      .record_bytes = LM_SIGNATURE_BYTES,
                                      .chip_count = chip_count,
                                      .chip_bytes = LM_CHIP_BYTES};
    head.crc = fx_crc32c(0, &head, offsetof(struct lm_signatures_head, crc));
    return head;
}

bool db_signatures_head_fits(const struct lm_signatures_head *head, uint64_t bytes)
{
    return fx_crc32c(0, head, offsetof(struct lm_signatures_head, crc)) == head->crc &&
           head->record_bytes == LM_SIGNATURE_BYTES && head->chip_bytes == LM_CHIP_BYTES &&
           head->count <= LM_DB_SIGNATURES_MAX && head->chip_count <= LM_DB_CHIPS_MAX &&
           bytes == sizeof *head + (uint64_t)head->count * LM_SIGNATURE_BYTES +
                        (uint64_t)head->chip_count * LM_CHIP_BYTES;
}

bool db_signatures_head_rest_is_zero(const struct lm_signatures_head *head)
{
    return db_is_zero(head->reserved, sizeof head->reserved);
}

bool db_signature_rest_is_zero(const struct lm_signature *s)
{
    const size_t used = strnlen(s->name, sizeof s->name);
    bool rest = db_is_zero(s->name + used, sizeof s->name - used) &&
                db_is_zero(s->reserved, sizeof s->reserved);
    for (int d = 0; d < LM_SIGNATURE_DEPRESSIONS_MAX; d++) {
        const size_t aspects = d < s->depressions ? s->aspects : 0;
        rest = rest && (d < s->depressions || s->depression[d] == 0) &&
               db_is_zero(s->rcs[d] + aspects, LM_SIGNATURE_ASPECTS_MAX - aspects);
    }
    return rest;
}

bool db_chip_rest_is_zero(const struct lm_chip *c)
{
    return db_is_zero(c->reserved, sizeof c->reserved);
}

/* ---- the file ---- */

int db_signature_write(struct db_signature *s, const char *path)
{
    struct hs_atomic_file file;
    const uint32_t chips = db_signature_chips(&s->head);
    const struct lm_signatures_head head = db_signatures_head(1, chips);
    db_signature_seal(s, 0, 0);
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    if (fwrite(&head, sizeof head, 1, file.stream) != 1 ||
        fwrite(&s->head, sizeof s->head, 1, file.stream) != 1 ||
        fwrite(s->chips, sizeof *s->chips, chips, file.stream) != chips) {
        hs_error(path, "free some space and run again", "cannot be written: %s", strerror(errno));
        hs_atomic_abort(&file);
        return -1;
    }
    return hs_atomic_commit(&file);
}

static int read_head(struct db_signature *s, FILE *in, const char *path)
{
    struct lm_signatures_head head;
    struct stat status;
    if (fstat(fileno(in), &status) != 0 || !S_ISREG(status.st_mode)) {
        return hs_error(path, "give a file that `landmass-target bake` wrote", "is no file");
    }
    if (fread(&head, sizeof head, 1, in) != 1 ||
        !db_signatures_head_fits(&head, (uint64_t)status.st_size) || head.count != 1 ||
        !db_signatures_head_rest_is_zero(&head)) {
        return hs_error(path, "give a file that `landmass-target bake` wrote",
                        "is no signature, or was cut short");
    }
    if (fread(&s->head, sizeof s->head, 1, in) != 1 ||
        lm_signature_check(&s->head, head.chip_count) != LM_OK ||
        db_signature_chips(&s->head) != head.chip_count || !db_signature_rest_is_zero(&s->head)) {
        return hs_error(path, again,
                        "its record does not fit its checksum, or a number is out of its range");
    }
    return 0;
}

static int read_chips(struct db_signature *s, FILE *in, const char *path)
{
    const uint32_t chips = db_signature_chips(&s->head);
    s->chips = malloc(chips * sizeof *s->chips);
    if (!s->chips) {
        return hs_error(path, NULL, "out of memory");
    }
    if (fread(s->chips, sizeof *s->chips, chips, in) != chips) {
        return hs_error(path, again, "cannot be read to its end");
    }
    for (uint32_t i = 0; i < chips; i++) {
        const uint32_t aspect = i % s->head.aspects, depression = i / s->head.aspects;
        if (lm_chip_check(&s->chips[i], 0, aspect, depression) != LM_OK ||
            !db_chip_rest_is_zero(&s->chips[i])) {
            return hs_error(path, again,
                            "chip %" PRIu32
                            " does not fit its checksum, or is not the one of "
                            "aspect %" PRIu32 ", depression %" PRIu32,
                            i, aspect, depression);
        }
    }
    return 0;
}

int db_signature_read(struct db_signature *s, const char *path)
{
    *s = (struct db_signature){.chips = NULL};
    FILE *in = hs_input_open(path, "rb");
    if (!in) {
        return hs_error(path, "check the name", "cannot be read: %s", strerror(errno));
    }
    const int result = read_head(s, in, path) == 0 ? read_chips(s, in, path) : -1;
    fclose(in);
    if (result != 0) {
        db_signature_free(s);
    }
    return result;
}

void db_signature_free(struct db_signature *s)
{
    free(s->chips);
    *s = (struct db_signature){.chips = NULL};
}
