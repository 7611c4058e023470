/* Watchdogs and the rule by which they are fed: the board's (/dev/watchdog), which resets the
 * machine, and systemd's, which restarts the program. */
#ifndef DRV_WATCHDOG_H
#define DRV_WATCHDOG_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/liveness.h"

struct drv_watchdog {
    int fd;             /* /dev/watchdog; -1: not used */
    int notify_fd;      /* systemd's socket; -1: not used */
    uint64_t period_us; /* time between two feedings: half of the shorter time-out */
    uint64_t due_us;    /* time of the next feeding */
    uint32_t timeout_s; /* that the board's watchdog accepted */
    bool has_bitten;    /* the board's watchdog reports that it caused the last restart */
    bool is_hungry;     /* feeding is due, and lm/liveness.h has no proof of life since the last */
    struct lm_liveness last; /* as of the last feeding */
    char error[160];         /* why the last call failed */
    struct {
        uint32_t fed;
        uint32_t refused; /* times that it became hungry */
    } count;
};

/* Open both watchdogs:
 * - `device` (NULL: none), with a time-out of `timeout_s`;
 * - the socket that $NOTIFY_SOCKET names, if any, with the time-out of $WATCHDOG_USEC, if
 *   $WATCHDOG_PID is this process.
 * Returns LM_OK; or LM_ERR_IO, with the cause in w->error, if one of them could not be opened; the
 * other is then open. From now on drv_watchdog_service must be called to prevent a reset. */
int drv_watchdog_open(struct drv_watchdog *w, const char *device, uint32_t timeout_s,
                      uint64_t now_us);

/* Feed both if that is due and `now` proves life since the last feeding (lm/liveness.h). True if
 * they were fed. Never waits. */
bool drv_watchdog_service(struct drv_watchdog *w, struct lm_liveness now, uint64_t now_us);

/* Send a message to systemd, such as "READY=1" or "STATUS=...": at most 512 bytes. Never waits. */
void drv_watchdog_notify(struct drv_watchdog *w, const char *text);

/* Stop the board's watchdog and close both. A program that ends in any other way leaves it
 * running. */
void drv_watchdog_close(struct drv_watchdog *w);

#endif
