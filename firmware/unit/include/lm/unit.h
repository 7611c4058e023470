/* Display unit: bus frames and controls in, pictures out.
 *
 * A board fills struct lm_board, calls lm_unit_init once, and then lm_unit_step for ever, from one
 * thread. Drivers are called back from inside these two. The unit allocates nothing and keeps all
 * of its state in struct lm_unit; two units in one program do not disturb each other. A board's
 * main loop:
 *
 *     static struct lm_unit unit;
 *     static _Alignas(8) uint8_t tiles[384 * sizeof(struct lm_tile)];
 *     static uint8_t plane[768 * 768];
 *     const struct lm_board board = {
 *         .flash = &flash, .can = &can, .controls = &controls, .display = &display,
 *         .tile_pool = tiles, .tile_pool_bytes = sizeof tiles, .plane = plane,
 *         .flash_poll_limit = 1000000};
 *     if (lm_unit_init(&unit, &board) != LM_OK) { stop(); }
 *     for (;;) { lm_unit_step(&unit, clock_us()); sleep_ms(2); }
 *
 * Its parts call each other in one direction:
 *
 *     unit.c -+-> follow.c ---> commands.c -+
 *             +-> pacing.c -----------------+-> picture.c -> picture_sector.c, picture_patch.c
 *             +-> tracking.c
 *             +-> swap.c -----> settings.c
 *             +-> flags.c
 *             +-> report.c
 *             +-> present.c
 *
 * lm/liveness.h says when a board may feed its watchdog, lm/fault_log.h which flags are faults. */
#ifndef LM_UNIT_H
#define LM_UNIT_H

#include <stddef.h>

#include "lm/bus.h"
#include "lm/canas_control.h"
#include "lm/canas_report.h"
#include "lm/canas_service.h"
#include "lm/composer.h"
#include "lm/controls.h"
#include "lm/cursor.h"
#include "lm/exercise.h"
#include "lm/fault_log.h"
#include "lm/keys.h"
#include "lm/live_bus.h"
#include "lm/malfunction_bus.h"
#include "lm/nav.h"
#include "lm/page.h"
#include "lm/picture.h"
#include "lm/swap.h"
#include "lm/track.h"
#include "lm/unit_map.h"
#include "lm/unit_weather.h"

/* Table of a bus that is heard besides the first one. Two that lm_bus_profiles_clash must not be on
 * one interface. Of a field that several tables have, that of the earlier table is preferred: the
 * priorities of later ones, of which those above 63 count as 63, follow behind. */
struct lm_board_table {
    const struct lm_bus_profile *profile;
    uint8_t interface; /* 0: can, 1: can_2 */
};

/* Board: the ports and memory that it lends. All pointers stay borrowed as long as the unit lives.
 * None may be NULL unless its remark says so. */
struct lm_board {
    const struct lm_radar
        *radar; /* NULL: the image's table, or the built-in one where it has none */
    const struct lm_flash *flash;
    struct lm_flash_part images[LM_IMAGES_MAX]; /* where images lie in the flash, the one with the
                               tables, targets and signatures first; of no bytes: no image there.
                               Without the first the flash has one image, at its start */
    const struct lm_can *can;
    const struct lm_bus_profile
        *bus_profile;           /* NULL: the image's table, or lm_bus_canas17 where it has none */
    const struct lm_can *can_2; /* a second interface; NULL: there is none */
    /* Tables that are heard besides: see struct lm_board_table. The first without a profile ends
     * them. */
    struct lm_board_table tables[LM_BUS_TABLES_MORE];
    const uint8_t *bus_nodes;  /* the nodes that are heard: lm_bus_hear_only; NULL: all */
    uint8_t bus_node;          /* the unit's CANaerospace node, 1..255; 0: no node services */
    uint8_t bus_partner;       /* the node that SWAP exchanges the page with (lm/swap.h);
                                  0: there is none */
    bool is_heading_magnetic;  /* the bus's LM_BUS_HEADING is from magnetic north */
    bool tells_reports;        /* it also tells lm/canas_report.h and lm/canas_control.h; without
                                  a node it does not */
    bool obeys_controls;       /* of the bus: lm/canas_control.h */
    bool is_database_unsigned; /* the board does not know who made it: LM_FLAG_UNSIGNED */
    uint8_t hardware_revision; /* told on the bus on request */
    const struct lm_controls *controls;
    const struct lm_display *display;
    void *tile_pool; /* 8-byte aligned */
    size_t tile_pool_bytes;
    uint8_t *plane;         /* one byte for each pixel of the display */
    uint32_t glass_step_px; /* pixels that a step without lines composes, 4,096 .. 2^20, of the
                               first picture 8 times as many; 0: no limit */
    uint32_t noise_seed;    /* chooses the draws of speckle and noise, and nothing else; the seed
                               of the exercise replaces it */
    struct lm_glass_options options;
    uint32_t flash_poll_limit;          /* polls after which a read at the start is given up */
    const struct lm_settings *settings; /* of before the restart: lm_settings_give; only read by
                                           lm_unit_init. NULL: those of power-up */
    const char *restart; /* cause of the board's restart, at most 20 capitals; NULL: power was
                            switched on */
};

/* Time between two frames, and the silence on the bus after which LM_FLAG_BUS rises. */
enum { LM_FRAME_US = 33333, LM_BUS_SILENT_US = 1000000 };

/* A glass_step_px that keeps each step of docs/zcu102.md below a line's 390,000 instructions. */
enum { LM_GLASS_STEP_PX = 28672 };

/* Steps that a frame takes at most, from its surface lent to the surface shown. */
enum { LM_FRAME_STEPS = 64 };

/* How long LM_FLAG_RESTART is shown. */
enum { LM_RESTART_SHOWN_US = 10000000 };

/* Elevation of a position outside the map. */
#define LM_NO_ELEVATION INT32_MIN

/* State of the unit. Each part is written by its own functions alone; boards and tests may read
 * it. */
struct lm_unit {
    const struct lm_board *board; /* borrowed */

    struct lm_bus bus;
    struct lm_bus more[LM_BUS_TABLES_MORE]; /* of board->tables */
    struct lm_nav nav;
    struct lm_canas_service service;
    struct lm_canas_report report;
    struct lm_canas_control control_bus;
    struct lm_swap swap;
    uint64_t last_bus_us;        /* arrival of the last frame that was no error report */
    uint64_t last_bus_2_us;      /* the same of can_2 */
    bool is_restored;            /* it began with the board's settings */
    struct lm_slots_state slots; /* as the board said last */
    uint32_t unsigned_places; /* bit n: the image that came to place n + 1 in flight is unsigned */
    struct {
        bool is_known;  /* there was a position */
        uint32_t jumps; /* nav.position_jumps as of the last step */
        uint16_t rank;  /* rank of the position's sender (struct lm_nav_origin) as of then */
    } position_seen;
    struct lm_ownship ownship; /* extrapolated to the last step */
    bool is_polar;             /* lm_geo_is_polar: its position is LM_NAV_DEAD to the unit */
    struct lm_unit_weather weather;
    struct lm_exercise exercise;
    struct lm_live_bus live;
    bool is_clock_stepped; /* the exercise's, in this step of the unit */
    struct lm_malfunction_bus malfunctions;

    struct {
        uint32_t stuck, rivals, disagreements; /* as of the last step: lm/bit.h */
        uint64_t grew_us;                      /* when one of them last grew */
        uint8_t kind;                          /* which did: 1, 2, 3 in this order */
    } senders;

    struct lm_unit_map map;
    struct {
        uint32_t seen;        /* reads that failed and records with a wrong CRC */
        uint64_t grew_us;     /* when `seen` last grew */
        uint64_t bytes_asked; /* of the flash, when it last did something */
        uint64_t asked_us;    /* when that was */
    } tile_faults;

    struct lm_keys keys;
    struct lm_page page;
    struct lm_palette palette;
    struct lm_cursor cursor;
    int32_t cursor_elevation_m_q10; /* of the map under the cursor, or LM_NO_ELEVATION */
    int32_t ground_m_q10;           /* of the map under the aircraft, or LM_NO_ELEVATION */
    struct {
        bool is_commanded; /* a controller set one; it takes precedence over the bus's */
        struct lm_position position;
    } steerpoint;
    struct {
        uint64_t until_us;      /* LM_FLAG_UNABLE is shown until then */
        enum lm_refusal reason; /* with this reason */
    } unable;
    enum lm_refusal refusal; /* reason of the control refused last */

    struct lm_picture picture;
    struct lm_track track;
    uint8_t track_mode; /* of the page, when the track was begun: another one ends it */
    uint64_t now_us;    /* of the last step */
    struct lm_composer composer;
    uint32_t frame_steps; /* that the frame on the lent surface has taken so far */
    uint64_t next_frame_us;

    uint32_t flags; /* enum lm_flag, as of the last step */
    struct lm_fault_log faults;

    struct {
        uint32_t frames, lines, bus_frames;
        uint32_t lines_dropped;    /* times that overdue lines were dropped (unit/pacing.h) */
        uint32_t bus_errors;       /* the driver reported the bus down */
        uint32_t display_errors;   /* acquire or present failed */
        uint32_t display_busy;     /* no surface was free when a frame was due */
        uint32_t frames_hurried;   /* frames completed beyond glass_step_px, after LM_FRAME_STEPS */
        uint32_t commands_refused; /* controls with a value out of range, or not possible now */
        uint32_t swaps;            /* pages exchanged with the partner */
    } count;                       /* only ever grow */
};

/* Put the unit in its first state: ground map, +-60 degrees, 40 nm; or the board's settings, if
 * they are sound: their page and cursor, and no patch, which showed a moment that is gone. Reads
 * the image's tables and its coarsest LOD, and waits for the flash meanwhile. Returns LM_OK also if
 * the image cannot be used: the unit then runs and shows LM_FLAG_DB.
 *
 * Fails iff one of these holds; the unit must then not be stepped:
 * - LM_ERR_TABLE: the board's radar table breaks its contract; lm_radar_check (lm/radar_check.h)
 *   names the field, for the board to report;
 * - LM_ERR_RANGE: the display has less than 256 or more than 1024 pixels either way;
 * - LM_ERR_NO_MEMORY: the tile pool has room for fewer than 20 tiles. */
int lm_unit_init(struct lm_unit *u, const struct lm_board *board);

/* Say what is known of the database's slots, for the BIT page. A board that records its unit says
 * it by the control LM_CONTROL_SLOTS instead. Returns LM_OK; or LM_ERR_RANGE, with nothing changed,
 * if a number is outside its range. */
int lm_unit_tell_slots(struct lm_unit *u, const struct lm_slots_state *slots);

/* The present settings, for a board that keeps them for the next start, or for another display. */
void lm_settings_give(const struct lm_unit *u, struct lm_settings *s);

/* Do what is due at `now_us`: microseconds since the start, never less than in the call before. In
 * this order:
 * - take at most LM_STEP_FRAMES frames from the bus, of two interfaces together, and extrapolate
 *   ownship and exercise clock to now;
 * - take at most 8 controls of the bus, and 8 of the board;
 * - update the flags, and remove the picture if navigation or the image is lost;
 * - move view and cursor, and the range scale if it follows the cursor;
 * - start and finish reads of tiles, without waiting;
 * - draw at most LM_STEP_LINES lines, none before the first picture is shown unless
 *   board->glass_step_px is 0;
 * - tell the other avionics what is due, at most LM_CONTROL_FRAMES_A_STEP,
 *   LM_SWAP_FRAMES_A_STEP and LM_REPORT_FRAMES_A_STEP frames;
 * - compose the glass, at most board->glass_step_px pixels, and show it when it is complete, every
 *   LM_FRAME_US.
 * Call at least every 4 ms for a smooth sweep. Never waits and never fails: errors show in u->flags
 * and u->count. Cost: docs/benchmarks.md. */
void lm_unit_step(struct lm_unit *u, uint64_t now_us);

#endif
