/* Signature with its chips, as a program bakes it and the database builder takes it: in memory,
 * and in a file .sig, which is a section SIGNATURES by itself (docs/FORMATS.md, 1.9 and 4). */
#ifndef HS_SIGNATURE_FILE_H
#define HS_SIGNATURE_FILE_H

#include "lm/signature.h"

#include <stdbool.h>

enum {
    DB_CHIPS_MAX = LM_SIGNATURE_ASPECTS_MAX * LM_SIGNATURE_DEPRESSIONS_MAX /* of one signature */
};

struct db_signature {
    struct lm_signature head;
    struct lm_chip *chips; /* owned: db_signature_chips(&head) of them, by depression and aspect */
};

static inline uint32_t db_signature_chips(const struct lm_signature *head)
{
    return (uint32_t)head->aspects * head->depressions;
}

/* Make it number `number` of a section, its chips beginning at `chip0`: numbers and checksums of
 * record and chips. */
void db_signature_seal(struct db_signature *s, uint32_t number, uint32_t chip0);

/* The head of a section of so many signatures and chips, sealed. */
struct lm_signatures_head db_signatures_head(uint32_t count, uint32_t chip_count);

/* Does a head fit its checksum and the `bytes` of its section? */
bool db_signatures_head_fits(const struct lm_signatures_head *head, uint64_t bytes);

/* What the firmware does not look at: are all unused bytes zero? */
bool db_signatures_head_rest_is_zero(const struct lm_signatures_head *head);
bool db_signature_rest_is_zero(const struct lm_signature *s);
bool db_chip_rest_is_zero(const struct lm_chip *c);

/* Write it, sealed as number 0 with chip0 0; the file appears whole or not at all. Returns 0, or -1
 * with the error reported. */
int db_signature_write(struct db_signature *s, const char *path);

/* Read a file and believe nothing in it: its size is compared before memory is taken. Returns 0, or
 * -1 with the error reported and nothing to free:
 * - the file cannot be read, or is no section of one signature,
 * - a checksum does not fit, a number is out of its range, or an unused byte is not 0,
 * - no memory. */
int db_signature_read(struct db_signature *s, const char *path);

/* Harmless on a zeroed struct. */
void db_signature_free(struct db_signature *s);

#endif
