/* Two watchdogs and the rule by which they are fed: the board's (/dev/watchdog), which resets the
 * machine, and systemd's, which starts the program anew. */
#ifndef DRV_WATCHDOG_H
#define DRV_WATCHDOG_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/liveness.h"

struct drv_watchdog {
    int fd;             /* of /dev/watchdog; -1: not used */
    int notify_fd;      /* of systemd's socket; -1: not used */
    uint64_t period_us; /* how often feeding is due: half of the shorter time-out */
    uint64_t due_us;
    uint32_t timeout_s; /* as the board's watchdog took it */
    bool has_bitten;    /* the board's watchdog says that it caused the last restart */
    bool is_hungry;     /* feeding was due, and life has not been proved since */
    struct lm_liveness last;
    char error[160]; /* why the last call failed */
    struct {
        uint32_t fed;
        uint32_t refused; /* times that it became hungry */
    } count;
};

/* Open `device` (NULL: none) and ask for a time-out of `timeout_s`; and the socket that
 * $NOTIFY_SOCKET names, if any, with the time-out of $WATCHDOG_USEC if it is meant for this process
 * ($WATCHDOG_PID). LM_OK; LM_ERR_IO with w->error when something was asked for and is not to be
 * had: what could be opened is. From now on the dog bites unless drv_watchdog_service is called. */
int drv_watchdog_open(struct drv_watchdog *w, const char *device, uint32_t timeout_s,
                      uint64_t now_us);

/* Feed when it is due and `now` proves life since the last meal. True when it was fed. Never
 * waits. */
bool drv_watchdog_service(struct drv_watchdog *w, struct lm_liveness now, uint64_t now_us);

/* Tell systemd something, such as "READY=1" or "STATUS=...": at most 512 bytes. Never waits. */
void drv_watchdog_notify(struct drv_watchdog *w, const char *text);

/* A commanded stop: the board's watchdog is told not to bite. A program that ends in any other way
 * leaves it running. */
void drv_watchdog_close(struct drv_watchdog *w);

#endif
