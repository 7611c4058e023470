/* What a flight showed, and whether its recording shows it again. */
#ifndef SHOWN_H
#define SHOWN_H

#include "lm/unit.h"
#include "replay.h"

enum { SHOWN_MAX = 4096 };

/* Checksums of the pictures of a flight, in their order. */
struct shown {
    uint32_t count, sum[SHOWN_MAX];
};

void shown_note(struct shown *s, const uint32_t *pixels, uint32_t count);

/* What a replay proved. */
struct shown_again {
    uint32_t pictures, wrong; /* shown, and those of them that are not the flight's */
    bool has_ended;
    uint32_t ceased, departures, checks, checks_failed, torn;
    char error[256];
};

/* Fly a recording over this flash, with this radar (NULL: the image's), and compare every picture
 * with the flight's. */
struct shown_again show_again(const char *path, const struct lm_flash *flash,
                              const struct lm_radar *radar, const struct shown *shown);

#endif
