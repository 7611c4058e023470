/* Feed of the bus to its pages: the latest lines in a ring that all pages read, each at its own
 * pace, and the last frame of each of the instructors' identifiers for a page that comes late.
 *
 * A page costs a number. One that does not read loses its place when the ring has gone round, and
 * is told so: it never holds anyone up. */
#ifndef IOS_FEED_H
#define IOS_FEED_H

#include "ios/line.h"

enum { IOS_FEED_BYTES = 4 << 20 }; /* 14 s of a full bus of 1 Mbit/s */

struct ios_feed {
    char *ring;            /* owned */
    size_t room;           /* bytes of it */
    uint64_t end;          /* bytes put so far; those from end - room on are there */
    uint64_t frames;       /* put so far */
    struct ios_past *past; /* owned */
};

/* Begin with an empty ring of `room` bytes, at least IOS_LINE_MAX; and free it. Returns 0, or -1
 * with the error reported (no memory). Closing twice does no harm. */
int ios_feed_open(struct ios_feed *feed, size_t room);
void ios_feed_close(struct ios_feed *feed);

/* Add a frame that `iface` carried at `time_us`. */
void ios_feed_put(struct ios_feed *feed, const char *iface, uint64_t time_us,
                  const struct lm_can_frame *frame);

/* Copy whole lines from *at on, at most `room` bytes, at least IOS_LINE_MAX, and move *at behind
 * them. Returns the bytes; 0: there is nothing new; -1: the reader was too slow, and lines are
 * lost.
 */
long ios_feed_take(const struct ios_feed *feed, uint64_t *at, char *to, size_t room);

/* The last frame of each instructor's identifier and service code, the oldest first, as lines of
 * the interface "past". The text is the caller's to free; NULL with *bytes 0: there is none, or no
 * memory. */
char *ios_feed_past(const struct ios_feed *feed, size_t *bytes);

#endif
