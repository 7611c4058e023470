/* Radar record: a radar table as bytes, in an image's section RADAR or in a file of the board.
 * docs/FORMATS.md, 1.12, describes every byte; nothing of it depends on a compiler.
 *
 *     0      4         6       8          16         34         58        LM_RADAR_RECORD_BYTES
 *     +------+---------+-------+----------+----------+----------+---------+
 *     | crc  | version | bytes | its name | names of | names of | numbers |   fields in the order
 *     +------+---------+-------+----------+ modes    | fields   |         |   of lm_radar_field,
 *                                         +----------+----------+---------+   unused rows zero */
#ifndef LM_RADAR_RECORD_H
#define LM_RADAR_RECORD_H

#include <stdint.h>

#include "lm/radar.h"

enum {
    LM_RADAR_RECORD_VERSION = 1,
    LM_RADAR_RECORD_BYTES = 628 /* of this version */
};

/* Write the table as a record. `record` has room for LM_RADAR_RECORD_BYTES. */
void lm_radar_pack(const struct lm_radar *radar, uint8_t *record);

/* Read and check a record of `bytes` bytes, which may hold anything. The table is then as
 * lm_radar_check wants it. `record` is borrowed for the call.
 *
 * Returns LM_OK. It fails, with *radar unspecified but for LM_ERR_TABLE:
 * - LM_ERR_VERSION: of another version, whatever its length and checksum;
 * - LM_ERR_CORRUPT: another length, or a checksum that does not match;
 * - LM_ERR_TABLE: the table breaks its contract; lm_radar_check(radar) names the field. */
int lm_radar_unpack(struct lm_radar *radar, const uint8_t *record, uint32_t bytes);

#endif
