/* The bench: an ordinary PC as a board. Flash is a file, glass is memory that a program may show or
 * save, the bus is a log or SocketCAN, the controls are whatever the program offers. */
#ifndef BENCH_H
#define BENCH_H

#include "drv/flash_file.h"
#include "lm/unit.h"

enum { BENCH_TILE_SLOTS = 384 };

struct bench {
    struct drv_flash_file flash;
    struct lm_display display;
    uint32_t *glass;   /* the last picture presented: width_px * height_px, 0x00RRGGBB */
    uint32_t pictures; /* presented so far */
    struct lm_board board;
    struct lm_unit *unit;
    char error[160]; /* why bench_open failed */
};

/* What the unit is connected to. */
struct bench_bus {
    const struct lm_can *can;             /* borrowed */
    const struct lm_bus_profile *profile; /* NULL: canas17 */
    uint8_t node;                         /* the unit's own; 0: it only listens */
};

/* Open the database and lend the unit its memory; the unit is ready for lm_unit_step afterwards.
 * What `bus` points to and `controls` stay the caller's. 0, or -1 with b->error saying why and
 * nothing left open. A database that the firmware cannot use is no error here: the unit runs, shows
 * it on the glass, and unit->map.is_usable is false. */
int bench_open(struct bench *b, const char *database, uint16_t width_px, uint16_t height_px,
               uint32_t noise_seed, const struct bench_bus *bus,
               const struct lm_controls *controls);
void bench_close(struct bench *b);

#endif
