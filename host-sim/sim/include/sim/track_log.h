/* Log of tracks: what became of each track of a flight, for the bench's summary and report. */
#ifndef SIM_TRACK_LOG_H
#define SIM_TRACK_LOG_H

#include "lm/track.h"

enum { TRACK_LOG_MAX = 200, TRACK_LOG_GAPS = 16 };

/* A track. Times are seconds of the flight; NAN: it never came to that. */
struct track_log_item {
    enum lm_track_kind kind;
    enum lm_track_state state; /* at its end, or the flight's */
    enum lm_track_loss loss;   /* why it was not held, did not return at last, or was dropped */
    double begun_s, held_s, ended_s;
    struct track_log_gap {
        double at_s;
        enum lm_track_loss loss;
    } gap[TRACK_LOG_GAPS]; /* it did not return any more from then on */
    unsigned gaps;         /* there were; more than TRACK_LOG_GAPS are counted alone */
    double slant_range_m, range_rate_m_s, speed_m_s; /* measured last; NAN: never held */
};

struct track_log {
    struct track_log_item item[TRACK_LOG_MAX];
    unsigned count, left_out; /* tracks that were taken down, and that had no room */
    unsigned begun;           /* numbers of tracks seen, modulo 256 */
};

/* Take a track as it stands after a step. Call behind each step of the unit; begin with all zero.
 */
void track_log_step(struct track_log *log, const struct lm_track *track, uint64_t now_us);

/* To standard output, a line a track, and to the JSON report as `tracks`. */
void track_log_print(const struct track_log *log);
void track_log_report(const struct track_log *log);

#endif
