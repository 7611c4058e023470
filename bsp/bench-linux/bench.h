/* Bench: a PC as a board. Its flash is a file, and its display is memory that a program may show or
 * save. The bus is a log or SocketCAN; the program provides the controls. */
#ifndef BENCH_H
#define BENCH_H

#include "drv/flash_file.h"
#include "drv/flash_joined.h"
#include "lm/unit.h"
#include "record.h"
#include "replay.h"

/* As many buffers as the ZCU102 has, so that the same frames are shown. */
enum { BENCH_TILE_SLOTS = 384, BENCH_BUFFERS = 2 };

struct bench {
    struct drv_flash_file flash[LM_IMAGES_MAX]; /* without a file: all zero */
    struct drv_flash_joined joined;
    bool is_leaving[LM_IMAGES_MAX]; /* closed when nothing is read from it any more */
    struct lm_display display;
    uint32_t *buffer[BENCH_BUFFERS]; /* owned: width_px * height_px each, 0x00RRGGBB */
    uint32_t *glass;                 /* the one of the last frame presented */
    uint32_t pictures;               /* frames presented so far */
    struct lm_board board;
    struct lm_unit *unit; /* owned */
    char error[160];      /* why bench_open failed */
};

/* Bus that the unit is connected to. */
struct bench_bus {
    const struct lm_can *can;                         /* borrowed */
    const struct lm_bus_profile *profile;             /* NULL: the database's, or canas17 */
    const struct lm_can *can_2;                       /* borrowed; NULL: there is one interface */
    struct lm_board_table tables[LM_BUS_TABLES_MORE]; /* heard besides */
    const uint8_t *nodes;                             /* borrowed: lm_bus_hear_only; NULL: all */
    uint8_t node;             /* the unit's own CANaerospace node; 0: it only listens */
    uint8_t partner;          /* the node that SWAP exchanges the page with; 0: there is none */
    bool is_heading_magnetic; /* LM_BUS_HEADING is from magnetic north */
    bool tells_reports;       /* it tells lm/canas_report.h as that node */
    bool obeys_controls;      /* of the bus: lm/canas_control.h */
};

/* What the unit looks at, and with. All but the database may be NULL. */
struct bench_scene {
    const char *database;                   /* a file */
    const char *further[LM_IMAGES_MAX - 1]; /* images beside it; NULL: none at this place */
    const struct lm_radar *radar;           /* borrowed; NULL: the image's, or the built-in one */
    struct recorder *recorder;              /* borrowed: it records the flight into `sink` */
    const struct record_sink *sink;         /* borrowed for the call */
    struct replay *replay; /* borrowed, open: the ports and settings are the recording's */
    bool is_any_replayed;  /* what differs from the recording is no error */
};

enum { BENCH_CHECK_EVERY = 10 }; /* pictures for each checksum in a recording */

/* Display of the unit. */
struct bench_glass {
    uint16_t width_px, height_px;
    struct lm_glass_options options;
};

/* Open the database and initialise the unit, which is then ready for lm_unit_step. Radar, the ports
 * in `bus`, and `controls`, stay borrowed until bench_close. Returns 0; or -1, with the cause
 * in b->error and nothing open. A database that the firmware cannot use is no error: the unit runs,
 * the glass shows it, and unit->map.is_usable is false. */
int bench_open(struct bench *b, const struct bench_scene *scene, const struct bench_glass *glass,
               uint32_t noise_seed, const struct bench_bus *bus,
               const struct lm_controls *controls);

/* Open the image `path` at a place, 1..LM_IMAGES_MAX, where none is, or take out the one that is
 * there (NULL), and fill the control that tells the unit. The only image cannot be taken out.
 * Returns 0; or -1, with the cause in b->error and nothing changed. */
int bench_mount(struct bench *b, int32_t place, const char *path, struct lm_control *control);

/* Close the files of images that have gone. Call behind each step. */
void bench_settle(struct bench *b);

/* Free the unit and close the database. */
void bench_close(struct bench *b);

#endif
