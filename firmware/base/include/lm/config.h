/* Sizes and choices of the firmware, each with meaning, allowed range and default. A board may
 * override one with -DLM_...; nothing else in the firmware is conditional. */
#ifndef LM_CONFIG_H
#define LM_CONFIG_H

/* Range cells a scan line may have, guard cells included. 64..1024, a multiple of 16, for
 * stages that take sixteen at a time fill whole arrays (LM_CELLS_ROOM has the rest). */
#ifndef LM_CELLS_MAX
#define LM_CELLS_MAX 528
#endif
_Static_assert(LM_CELLS_MAX >= 64 && LM_CELLS_MAX <= 1024 && LM_CELLS_MAX % 16 == 0,
               "LM_CELLS_MAX out of range");

/* Tile requests that may wait for the flash at one time. 16..1024, a power of two. */
#ifndef LM_TILE_REQUESTS
#define LM_TILE_REQUESTS 256
#endif
_Static_assert(LM_TILE_REQUESTS >= 16 && LM_TILE_REQUESTS <= 1024 &&
                   (LM_TILE_REQUESTS & (LM_TILE_REQUESTS - 1)) == 0,
               "LM_TILE_REQUESTS out of range");

/* Tiles the cache may hold; the board lends the memory, this bounds the index. 16..4096. */
#ifndef LM_TILE_SLOTS_MAX
#define LM_TILE_SLOTS_MAX 512
#endif
_Static_assert(LM_TILE_SLOTS_MAX >= 16 && LM_TILE_SLOTS_MAX <= 4096,
               "LM_TILE_SLOTS_MAX out of range");

/* Specific targets of the image that are held in memory, 640 bytes each. 1..1024. */
#ifndef LM_TARGETS_MAX
#define LM_TARGETS_MAX 64
#endif
_Static_assert(LM_TARGETS_MAX >= 1 && LM_TARGETS_MAX <= 1024, "LM_TARGETS_MAX out of range");

/* Signatures of the image that are held in memory, 1152 bytes each, and chips of them, 35 kB each,
 * that one sweep or patch may show. 1..16 and 1..64. */
#ifndef LM_SIGNATURES_MAX
#define LM_SIGNATURES_MAX 16
#endif
#ifndef LM_CHIPS_MAX
#define LM_CHIPS_MAX 16
#endif
_Static_assert(LM_SIGNATURES_MAX >= 1 && LM_SIGNATURES_MAX <= 16, "LM_SIGNATURES_MAX out of range");
_Static_assert(LM_CHIPS_MAX >= 1 && LM_CHIPS_MAX <= 64, "LM_CHIPS_MAX out of range");

/* Redundancy channels of the bus that are used: 0 and those above it. 1..8. */
#ifndef LM_BUS_CHANNELS
#define LM_BUS_CHANNELS 4
#endif
_Static_assert(LM_BUS_CHANNELS >= 1 && LM_BUS_CHANNELS <= 8, "LM_BUS_CHANNELS out of range");

/* Rows that a profile of the bus may have. 32..255. */
#ifndef LM_BUS_ROWS_MAX
#define LM_BUS_ROWS_MAX 64
#endif
_Static_assert(LM_BUS_ROWS_MAX >= 32 && LM_BUS_ROWS_MAX <= 255, "LM_BUS_ROWS_MAX out of range");

/* Senders of one field that are followed at a time; the best of them is used. 2..8. */
#ifndef LM_NAV_SOURCES
#define LM_NAV_SOURCES 4
#endif
_Static_assert(LM_NAV_SOURCES >= 2 && LM_NAV_SOURCES <= 8, "LM_NAV_SOURCES out of range");

/* Frames taken from the bus in one step, and scan lines drawn in one step, where an azimuth that is
 * traced for one counts as a line, too. */
#ifndef LM_STEP_FRAMES
#define LM_STEP_FRAMES 64
#endif
#ifndef LM_STEP_LINES
#define LM_STEP_LINES 8
#endif
_Static_assert(LM_STEP_FRAMES >= 1 && LM_STEP_LINES >= 1, "a step must do something");

#endif
