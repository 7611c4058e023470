/* Display unit: bus frames and controls in, pictures out.
 *
 * A board fills struct lm_board, calls lm_unit_init once, and then lm_unit_step for ever, from one
 * thread; drivers are called back from inside these two. The unit allocates nothing and keeps all
 * of its state in struct lm_unit, so that two units do not disturb each other.
 *
 * Its parts call one way: unit.c -> follow.c -> commands.c -> picture.c, unit.c -> pacing.c ->
 * picture.c, unit.c -> flags.c, unit.c -> present.c. When a board may feed its watchdog:
 * lm/liveness.h. What counts as a fault: lm/fault_log.h. */
#ifndef LM_UNIT_H
#define LM_UNIT_H

#include <stddef.h>

#include "lm/bus.h"
#include "lm/canas_service.h"
#include "lm/controls.h"
#include "lm/cursor.h"
#include "lm/fault_log.h"
#include "lm/keys.h"
#include "lm/nav.h"
#include "lm/page.h"
#include "lm/picture.h"
#include "lm/unit_map.h"
#include "lm/unit_weather.h"

/* Ports and memory that a board lends. All pointers stay valid as long as the unit lives; none may
 * be NULL unless that is said. */
struct lm_board {
    const struct lm_radar *radar;
    const struct lm_flash *flash;
    const struct lm_can *can;
    const struct lm_bus_profile *bus_profile; /* NULL: lm_bus_canas17 */
    uint8_t bus_node;          /* of CANaerospace, its own; 0: it takes no part in node services */
    uint8_t hardware_revision; /* told to whoever asks on the bus */
    const struct lm_controls *controls;
    const struct lm_display *display;
    void *tile_pool; /* 8-byte aligned */
    size_t tile_pool_bytes;
    uint8_t *plane;            /* display width * height bytes */
    uint32_t noise_seed;       /* another one gives other speckle, everything else the same */
    uint32_t flash_poll_limit; /* polls after which a read at start-up is given up */
    const char *restart; /* why the board restarted, in 20 capitals; NULL: it was switched on */
};

enum { LM_FRAME_US = 33333, LM_BUS_SILENT_US = 1000000 };

#define LM_NO_ELEVATION INT32_MIN

/* The unit's state. Every part is written by its own functions alone; boards and tests may read. */
struct lm_unit {
    const struct lm_board *board; /* borrowed */

    struct lm_bus bus;
    struct lm_nav nav;
    struct lm_canas_service service;
    uint64_t last_bus_us; /* when a frame last came */
    struct {
        uint32_t jumps; /* of the nav */
        uint16_t rank;  /* of the sender of the position */
    } position_seen;
    struct lm_ownship ownship; /* extrapolated to the last step */
    struct lm_unit_weather weather;

    struct lm_unit_map map;
    struct {
        uint32_t seen; /* reads that failed and records that did not check */
        uint64_t grew_us;
    } tile_faults;

    struct lm_keys keys;
    struct lm_page page;
    struct lm_palette palette;
    struct lm_cursor cursor;
    int32_t cursor_elevation_m_q10; /* metres * 1024, or LM_NO_ELEVATION */
    struct {
        bool is_commanded; /* before the bus's steerpoint */
        struct lm_position position;
    } steerpoint;
    uint64_t unable_until_us; /* the glass says LM_FLAG_UNABLE until then */

    struct lm_picture picture;
    uint64_t next_frame_us;

    uint32_t flags; /* enum lm_flag, of the last step */
    struct lm_fault_log faults;

    struct {
        uint32_t frames, lines, bus_frames;
        uint32_t lines_dropped; /* due, but the step had its fill */
        uint32_t bus_errors;    /* the driver reported the bus down */
        uint32_t display_errors, display_busy;
        uint32_t commands_refused;
        uint32_t swaps; /* SWAP presses: a board with two displays exchanges their pages */
    } count;            /* only ever grow */
};

/* Put the unit in its first state: ground map, A6, 40 nm. Reads the database's tables and coarsest
 * level. LM_OK also when the database cannot be used: the unit then runs and says so on the glass.
 *
 * Fails, and the unit must not be stepped, with
 *  - LM_ERR_TABLE iff the board's radar table breaks its contract; lm_radar_check
 * (lm/radar_check.h) then names the field, which the board tells whoever installs it;
 *  - LM_ERR_RANGE iff the display has less than 256 or more than 1024 pixels either way;
 *  - LM_ERR_NO_MEMORY iff the tile pool is too small for the database's coarsest level. */
int lm_unit_init(struct lm_unit *u, const struct lm_board *board);

/* Do what is due at `now_us`, microseconds since the start, which never goes back. In this order:
 *  - take at most LM_STEP_FRAMES frames from the bus, and extrapolate the ownship to now;
 *  - take at most 8 controls;
 *  - judge the flags, and remove the picture when navigation is lost;
 *  - move view, cursor and range on;
 *  - start and finish reads of tiles, without waiting;
 *  - draw at most LM_STEP_LINES lines;
 *  - draw and show the glass, every LM_FRAME_US.
 * Call at least every 4 ms for a smooth sweep. Never waits and never fails: what goes wrong is in
 * u->flags and u->count. Cost: docs/benchmarks.md. */
void lm_unit_step(struct lm_unit *u, uint64_t now_us);

#endif
