/* Bridge: the datagrams of a flight simulator as frames of the bus, in real time. */
#ifndef NAV_BRIDGE_H
#define NAV_BRIDGE_H

#include "nav/send.h"
#include "nav/simulator.h"

#include <stdbool.h>

enum {
    NAV_BRIDGE_SILENT_MS = 250, /* without a datagram: the bus falls silent */
    NAV_BRIDGE_CHANGE_MS = 3000 /* then another sender may follow */
};

enum nav_bridge_mood {
    NAV_BRIDGE_WAITING, /* nothing usable came yet */
    NAV_BRIDGE_FLYING,
    NAV_BRIDGE_PAUSED, /* frames go out: the aircraft stands */
    NAV_BRIDGE_SILENT, /* none go out */
    NAV_BRIDGE_MOODS
};

struct nav_bridge_settings {
    bool is_xplane; /* otherwise FlightGear */
    struct nav_send_options send;
    enum nav_datum datum; /* what the heights told are measured from */
    double height_offset_m;
};

struct nav_bridge_counts {
    uint64_t datagrams, used, frames;
    uint64_t fault[NAV_TOLD_FAULTS];
    uint64_t other_sender; /* while one is heard, another one's are not */
    uint64_t disordered;   /* a frame of the simulator that came before, or is repeated */
    uint64_t silences, pauses, senders;
    uint64_t skipped_ticks;       /* minor frames that this program was too late for */
    uint64_t frames_without_room; /* more than the bus can carry were due */
    double longest_wait_s;        /* between two datagrams that were used */
};

struct nav_bridge;

/* `sink` gets each frame when it is due, within the step. NULL when memory is short (reported). */
struct nav_bridge *nav_bridge_new(const struct nav_bridge_settings *settings,
                                  int (*put)(void *context, const struct canas_frame *frame,
                                             int64_t time_us),
                                  void *context);
void nav_bridge_free(struct nav_bridge *b);

/* Take a datagram that came from `sender`, a number that is another one for each address and port.
 * `now_us` is UTC, and never goes back. */
void nav_bridge_take(struct nav_bridge *b, const uint8_t *bytes, size_t length, uint64_t sender,
                     int64_t now_us);

/* Send what is due up to `now_us`; to be called every few milliseconds. Between datagrams the
 * aircraft moves on with the velocity and the rates told last, for NAV_BRIDGE_SILENT_MS at most.
 * After that nothing is sent, so that the display says NAV, and then NAV FAIL. While the simulator
 * is paused - it says so, or its numbers stand although the aircraft flies - the aircraft stands on
 * the bus, too: velocity and rates are 0, and a told exercise clock has rate 0.
 *
 * Returns 0, or -1 when the sink gave up. */
int nav_bridge_step(struct nav_bridge *b, int64_t now_us);

enum nav_bridge_mood nav_bridge_mood(const struct nav_bridge *b);
const struct nav_bridge_counts *nav_bridge_counts(const struct nav_bridge *b);

#endif
