/* The display unit: bus and controls in, pictures out. This alone knows the order of things. */
#ifndef LM_UNIT_H
#define LM_UNIT_H

#include <stddef.h>

#include "lm/bus.h"
#include "lm/canas_service.h"
#include "lm/controls.h"
#include "lm/cursor.h"
#include "lm/environment.h"
#include "lm/keys.h"
#include "lm/nav.h"
#include "lm/overlay.h"
#include "lm/page.h"
#include "lm/sar.h"
#include "lm/sector.h"
#include "lm/unit_map.h"
#include "lm/weather_bus.h"

/* What a board lends, for as long as the unit lives. */
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

enum { LM_FRAME_US = 33333, LM_SAR_ACQUIRE_US = 500000, LM_BUS_SILENT_US = 1000000 };

/* When a flag rose. The last few are kept for the BIT page. */
enum { LM_FAULTS_KEPT = 4 };
struct lm_fault {
    uint32_t flag; /* its number */
    uint64_t time_us;
};

#define LM_NO_ELEVATION INT32_MIN

struct lm_unit {
    const struct lm_board *board; /* borrowed */
    struct lm_unit_map map;
    struct lm_environment commanded; /* by a script or an instructor: before the bus's */
    struct lm_weather_bus weather_bus;
    struct lm_environment environment; /* of both, as sweeps and patches meet it */
    bool is_weather_stale;
    struct lm_place own_steerpoint; /* commanded: before the bus's steerpoint */
    bool has_own_steerpoint;
    struct lm_bus bus;
    struct lm_nav nav;
    struct lm_canas_service service;
    struct lm_ownship ownship; /* extrapolated to the last step */

    struct lm_keys keys;
    struct lm_page page;
    struct lm_cursor cursor;
    bool is_cursor_awaited; /* by a window: the whole sector is swept until it has a place */
    struct lm_palette palette;
    struct lm_view view;          /* of the picture on the glass */
    bool is_view_held;            /* the picture stands, and the aircraft moves over it */
    int32_t cursor_elevation_q10; /* metres * 1024, or LM_NO_ELEVATION */
    uint64_t unable_until_us;     /* the glass says LM_FLAG_UNABLE until then */

    struct lm_sector sector;
    struct lm_sar sar;
    bool is_acquiring;        /* the patch's tiles are being read */
    uint32_t lines_asked_for; /* lines of it whose tiles were asked for */
    uint64_t acquire_until_us;
    uint64_t next_line_us, next_frame_us;
    struct lm_tone sector_tone, sar_tone;
    struct lm_line line;
    struct lm_plane plane;
    struct lm_frame frame;
    uint32_t flags;                         /* enum lm_flag, of the last step */
    struct lm_fault faults[LM_FAULTS_KEPT]; /* fault n of `count` is at n % LM_FAULTS_KEPT */
    uint64_t last_bus_us;                   /* when a frame last came */
    uint32_t jumps_seen;                    /* of the nav */
    uint16_t position_rank_seen;            /* of the sender of the position */
    uint32_t tile_faults_seen;              /* of the cache, and when they last grew */
    uint64_t tile_fault_us;
    uint32_t cells_none, cells_seen; /* sampled, of the running sweep or patch */
    bool is_off_map;

    struct {
        uint32_t frames, lines, bus_frames;
        uint32_t lines_dropped; /* due, but the step had its fill */
        uint32_t bus_errors;    /* the driver reported the bus down */
        uint32_t display_errors, display_busy;
        uint32_t commands_refused;
        uint32_t faults; /* flags that rose; what the operator switches is none */
        uint32_t swaps;  /* SWAP presses: a board with two displays exchanges their pages */
    } count;             /* only ever grow */
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

/* Do what is due at `now_us` (which never goes back): take at most LM_STEP_FRAMES frames from the
 * bus and 8 controls, move the reading of tiles on, draw at most LM_STEP_LINES lines, and show a
 * picture when one is due. Call at least every 4 ms for a smooth sweep. */
void lm_unit_step(struct lm_unit *u, uint64_t now_us);

#endif
