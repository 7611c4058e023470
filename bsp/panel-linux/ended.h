/* How the panel ended last, where systemd restarted it: the service's ExecStopPost leaves systemd's
 * word for it in the service's runtime folder, which outlives a restart and nothing else. */
#ifndef PANEL_ENDED_H
#define PANEL_ENDED_H

/* In that folder: one word of SERVICE_RESULT (systemd.exec(5)), such as "watchdog". */
#define ENDED_FILE "ended"

/* The cause for lm_board.restart: "WATCHDOG", "CRASH", "FAILED", "TIME-OUT" or "OUT OF MEMORY", and
 * a report. NULL where the panel was started by hand or with the machine, was stopped as it should
 * be, or runs without systemd; and for a word that is none of systemd's. */
const char *ended_cause(void);

#endif
