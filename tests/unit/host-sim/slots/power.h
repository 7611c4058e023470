/* Media that lose power. What was written since the last sync is a list of sectors. When power
 * fails, each of them is lost, on the medium, or torn, in any order; a torn one has its first bytes
 * and noise behind them. All media of a supply fail together. */
#ifndef POWER_H
#define POWER_H

#include "slots/medium.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { POWER_SECTOR = 512, POWER_ROOM = 1 << 20, POWER_PENDING = 8192 };

struct power {
    uint64_t random;
    uint64_t operations, cut_at; /* power fails in operation number cut_at; 0: never */
    bool is_out;
    bool ignores_sync; /* a medium that lies, to see whether it is found out */
};

struct power_write {
    uint32_t at, length;
    uint8_t bytes[POWER_SECTOR];
};

struct power_medium {
    struct power *power; /* borrowed */
    /* Two sectors of records, then the image: as programs see it, and as the medium has it. */
    uint8_t seen[POWER_ROOM], kept[POWER_ROOM];
    uint64_t seen_bytes, kept_bytes; /* length of the image's place */
    struct power_write pending[POWER_PENDING];
    uint32_t pending_count;
    bool is_resized;
};

uint32_t power_draw(struct power *p, uint32_t below);

struct slot_medium power_medium(struct power_medium *m, struct power *power);

/* Power fails, and comes back. */
void power_restore(struct power_medium *m);

#endif
