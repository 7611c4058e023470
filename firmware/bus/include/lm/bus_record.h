/* Bus record: a bus table as bytes, in an image's section BUS. docs/FORMATS.md, 1.13, describes
 * every byte; nothing of it depends on a compiler. A field is named by its word, so that a record
 * outlives the numbers of enum lm_bus_field.
 *
 *     0      4         6       8      28        29     32             36             40
 *     +------+---------+-------+------+---------+------+--------------+--------------+-----+-----+
 *     | crc  | version | bytes | name | framing | rows | channel mask | invalid mask | row | ... |
 *     +------+---------+-------+------+---------+------+--------------+--------------+-----+-----+
 */
#ifndef LM_BUS_RECORD_H
#define LM_BUS_RECORD_H

#include "lm/bus_profile.h"

enum {
    LM_BUS_RECORD_VERSION = 1,
    LM_BUS_RECORD_HEAD_BYTES = 40,
    LM_BUS_RECORD_ROW_BYTES = 88,
    LM_BUS_RECORD_BYTES_MAX = LM_BUS_RECORD_HEAD_BYTES + LM_BUS_ROWS_MAX * LM_BUS_RECORD_ROW_BYTES
};

/* Table of a bus with its own memory. It points into itself: it must not be copied. The name of
 * each row is that of its field. */
struct lm_bus_table {
    struct lm_bus_profile profile;
    struct lm_bus_row rows[LM_BUS_ROWS_MAX];
    char name[LM_BUS_PROFILE_NAME_SIZE];
};

/* Write a sound profile as a record. `record` has room for LM_BUS_RECORD_BYTES_MAX; a name longer
 * than LM_BUS_PROFILE_NAME_SIZE - 1 bytes is cut. Returns the bytes of the record. */
uint32_t lm_bus_pack(const struct lm_bus_profile *profile, uint8_t *record);

/* Read and check a record of `bytes` bytes, which may hold anything. t->profile is then as
 * lm_bus_profile_check wants it. `record` is borrowed for the call.
 *
 * Returns LM_OK. It fails, with *t unspecified but for LM_ERR_TABLE:
 * - LM_ERR_VERSION: of another version, whatever its length and checksum;
 * - LM_ERR_CORRUPT: a length or a checksum that does not match, unused bytes that are not zero;
 * - LM_ERR_TABLE: a field, a framing or a number of rows that this firmware does not know, or
 *   lm_bus_profile_check fails. */
int lm_bus_unpack(struct lm_bus_table *t, const uint8_t *record, uint32_t bytes);

#endif
