/* Detail: what stands in a tile of the finest LOD, as rectangles and lines instead of cells.
 * A cell of the map says that there is a roof within some metres; detail says where its walls are.
 * docs/FORMATS.md, "DETAIL", describes every byte.
 *
 *                  length
 *        +------------------------+  ---
 *        |           . middle     |   | width         turn: of the length, from north by east
 *        +------------------------+  ---
 *
 * The directory entry of a tile names its record of detail (lm/db.h). A tile without one is shown
 * by its cells alone. Where a tile has detail, its cells of structures give way to the tile's
 * `under` before the detail is drawn (lm/detail_patch.h). */
#ifndef LM_DETAIL_H
#define LM_DETAIL_H

#include <stdint.h>

#include "lm/db.h"

enum {
    LM_DETAIL_HEAD_BYTES = 32,
    LM_DETAIL_ITEM_BYTES = 16,
    LM_DETAIL_UNIT_BYTES = LM_DB_PLACE_BYTES, /* records are whole units long */
    LM_DETAIL_UNITS_MAX = 128,
    LM_DETAIL_BYTES_MAX = LM_DETAIL_UNITS_MAX * LM_DETAIL_UNIT_BYTES,
    LM_DETAIL_ITEMS_MAX = (LM_DETAIL_BYTES_MAX - LM_DETAIL_HEAD_BYTES) / LM_DETAIL_ITEM_BYTES
};

/* Kind of an item; other values are refused. */
enum lm_detail_kind {
    LM_DETAIL_BLOCK = 1, /* building with a flat roof, wall, mast: a box */
    LM_DETAIL_GABLE =
        2,              /* building whose ridge runs along its length; eaves at 3/5 of its height */
    LM_DETAIL_LINE = 3, /* rail, fence, wire: it has no height, and glints when seen broadside */
    LM_DETAIL_SURFACE = 4, /* runway, road, or their verge: paint on the ground, which keeps its
                              elevation. Surfaces lie under all that stands */
    LM_DETAIL_KINDS
};

struct lm_detail_item {
    uint8_t kind;         /* enum lm_detail_kind */
    uint8_t class_number; /* class of its cells; of a line 0, for the ground keeps its own */
    uint8_t gamma_code;   /* reflectivity code of its top, or of a line that is not broadside */
    uint8_t glint_code;   /* of a line seen broadside, not below gamma_code; of a surface its layer,
                             0 or 1, from below; of others 0 */
    uint16_t north,
        east; /* of its middle, 1/65536 of the tile's sides from the south-west corner */
    uint16_t length_dm, width_dm; /* 1.. */
    uint16_t turn;                /* 1/65536 of a full turn */
    uint16_t height_dm; /* of its top above the terrain; of a line 0; of a surface the classes that
                           it covers: bit n for class n, 0..14 */
};
_Static_assert(sizeof(struct lm_detail_item) == LM_DETAIL_ITEM_BYTES,
               "the record must be what FORMATS.md says");

/* Record, in flash and in memory alike. Items are in the order in which they are drawn: a later one
 * covers an earlier one. */
struct lm_detail {
    uint32_t crc; /* CRC-32C of all bytes after this field, to the end of the record */
    uint8_t lod, zone;
    uint16_t count;       /* items */
    uint32_t row, column; /* the tile's: a record of another tile is refused */
    uint8_t reserved[16];
    struct lm_detail_item items[LM_DETAIL_ITEMS_MAX];
};

/* Check a record of `bytes` bytes that was read for a tile. Returns LM_OK, or LM_ERR_CORRUPT if
 * - `bytes` is not a whole number of units, or not enough for `count` items,
 * - the checksum is wrong, or the record is that of another tile,
 * - an item has an unknown kind, a class beyond 14, a side of nothing, or a glint below its gamma,
 * - a surface covers class 15, or lies in a layer above 1.
 * Cost: that of the checksum, and some 10 instructions an item. */
int lm_detail_check(const struct lm_detail *detail, uint32_t bytes, uint8_t lod, uint32_t row,
                    uint32_t column);

#endif
