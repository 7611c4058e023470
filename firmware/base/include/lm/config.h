/* Configuration: sizes that are fixed at compile time, each with meaning, range and default.
 *
 * A board overrides one with -DLM_...=value in its board.mk. A value out of its range does not
 * compile. Nothing else in the firmware is conditional. */
#ifndef LM_CONFIG_H
#define LM_CONFIG_H

/* Range cells of the longest range line, guard cells included. 64..1024, a multiple of 16, because
 * kernels work on groups of 16 cells. Arrays of a line have LM_CELLS_ROOM entries (lm/lanes.h). */
#ifndef LM_CELLS_MAX
#define LM_CELLS_MAX 528
#endif
_Static_assert(LM_CELLS_MAX >= 64 && LM_CELLS_MAX <= 1024 && LM_CELLS_MAX % 16 == 0,
               "LM_CELLS_MAX out of range");

/* Tile requests that can wait for the flash at one time (lm/tile_cache.h). More are dropped and
 * counted. 16..1024, a power of two; 16 bytes each. */
#ifndef LM_TILE_REQUESTS
#define LM_TILE_REQUESTS 256
#endif
_Static_assert(LM_TILE_REQUESTS >= 16 && LM_TILE_REQUESTS <= 1024 &&
                   (LM_TILE_REQUESTS & (LM_TILE_REQUESTS - 1)) == 0,
               "LM_TILE_REQUESTS out of range");

/* Tiles that the cache can index (lm/tile_cache.h). The board lends the memory for the tiles; this
 * bounds how much of it is used. 16..4096. */
#ifndef LM_TILE_SLOTS_MAX
#define LM_TILE_SLOTS_MAX 512
#endif
_Static_assert(LM_TILE_SLOTS_MAX >= 16 && LM_TILE_SLOTS_MAX <= 4096,
               "LM_TILE_SLOTS_MAX out of range");

/* Images that a unit shows as one map (lm/images.h). 1..4; 7 kB each. With 1 the code for several
 * falls away. */
#ifndef LM_IMAGES_MAX
#define LM_IMAGES_MAX 4
#endif
_Static_assert(LM_IMAGES_MAX >= 1 && LM_IMAGES_MAX <= 4, "LM_IMAGES_MAX out of range");

/* Targets of the image that are held in memory (lm/target.h). 1..1024; 640 bytes each. */
#ifndef LM_TARGETS_MAX
#define LM_TARGETS_MAX 64
#endif
_Static_assert(LM_TARGETS_MAX >= 1 && LM_TARGETS_MAX <= 1024, "LM_TARGETS_MAX out of range");

/* Signatures of the image that are held in memory (lm/signature.h). 1..16; 1152 bytes each. */
#ifndef LM_SIGNATURES_MAX
#define LM_SIGNATURES_MAX 16
#endif

/* Chips that one sweep or patch can show (lm/chips.h). 1..64; 35 kB each. */
#ifndef LM_CHIPS_MAX
#define LM_CHIPS_MAX 16
#endif
_Static_assert(LM_SIGNATURES_MAX >= 1 && LM_SIGNATURES_MAX <= 16, "LM_SIGNATURES_MAX out of range");
_Static_assert(LM_CHIPS_MAX >= 1 && LM_CHIPS_MAX <= 64, "LM_CHIPS_MAX out of range");

/* Redundancy channels of the bus that are read: channels 0..LM_BUS_CHANNELS - 1. 1..8. */
#ifndef LM_BUS_CHANNELS
#define LM_BUS_CHANNELS 4
#endif
_Static_assert(LM_BUS_CHANNELS >= 1 && LM_BUS_CHANNELS <= 8, "LM_BUS_CHANNELS out of range");

/* Tables of the bus that a unit hears besides its first one (lm/unit.h). 1..3; 2 kB each. */
#ifndef LM_BUS_TABLES_MORE
#define LM_BUS_TABLES_MORE 3
#endif
_Static_assert(LM_BUS_TABLES_MORE >= 1 && LM_BUS_TABLES_MORE <= 3,
               "LM_BUS_TABLES_MORE out of range");

/* Rows of the longest bus profile (lm/bus_profile.h). 32..255. */
#ifndef LM_BUS_ROWS_MAX
#define LM_BUS_ROWS_MAX 96
#endif
_Static_assert(LM_BUS_ROWS_MAX >= 32 && LM_BUS_ROWS_MAX <= 255, "LM_BUS_ROWS_MAX out of range");

/* Senders of one quantity that navigation follows at a time (lm/nav.h). It uses the best of them.
 * 2..8. */
#ifndef LM_NAV_SOURCES
#define LM_NAV_SOURCES 4
#endif
_Static_assert(LM_NAV_SOURCES >= 2 && LM_NAV_SOURCES <= 8, "LM_NAV_SOURCES out of range");

/* Bus frames that one step of the unit takes at most. From 1 up. */
#ifndef LM_STEP_FRAMES
#define LM_STEP_FRAMES 64
#endif

/* Lines that one step of the unit draws at most. An azimuth that is only traced counts as a line,
 * too. From 1 up. */
#ifndef LM_STEP_LINES
#define LM_STEP_LINES 8
#endif
_Static_assert(LM_STEP_FRAMES >= 1 && LM_STEP_LINES >= 1, "a step must do something");

#endif
