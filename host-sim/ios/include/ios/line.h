/* Bus frames as lines of `candump -L`, and those that an instructor's page may send. What a page
 * sends is hostile until it passed here. */
#ifndef IOS_LINE_H
#define IOS_LINE_H

#include "lm/port.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    IOS_LINE_MAX = 80,       /* bytes of a line, with its line feed */
    IOS_IFACE_MAX = 15,      /* characters of an interface's name */
    IOS_SERVICE_CODES = 256, /* byte 2 of a CANaerospace frame */
    IOS_INSTRUCTOR_IDS = 50  /* how many identifiers ios_instructor_slot knows */
};

/* Which of the identifiers an instructor uses this is, 0..IOS_INSTRUCTOR_IDS - 1: controls
 * (1530..1549), then weather, live targets, clock and malfunctions (1800..1829), as docs/bus.md has
 * them. -1: none. */
int ios_instructor_slot(const struct lm_can_frame *frame);

/* Read one line of a page, `length` bytes without the line feed. Returns NULL and *frame, or the
 * cause, in static memory: what is no frame, or is no data frame with the four bytes that begin
 * each of CANaerospace. The line's time is left out: time_us is 0. */
const char *ios_line_read(const char *line, size_t length, struct lm_can_frame *frame);

/* Write a frame as a line, with its line feed and a zero byte behind it. `iface` has at most
 * IOS_IFACE_MAX characters. Returns the bytes without that zero. */
size_t ios_line_write(char line[IOS_LINE_MAX], const char *iface, uint64_t time_us,
                      const struct lm_can_frame *frame);

#endif
