#include "drv/watchdog.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/watchdog.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "lm/status.h"

static int fail(struct drv_watchdog *w, const char *place, const char *cause)
{
    snprintf(w->error, sizeof w->error, "%s: %s", place, cause);
    return LM_ERR_IO;
}

/* Half of the shorter of the two. */
static void shorten_period(struct drv_watchdog *w, uint64_t timeout_us)
{
    if (w->period_us == 0 || timeout_us / 2 < w->period_us) {
        w->period_us = timeout_us / 2;
    }
}

static int open_device(struct drv_watchdog *w, const char *device, uint32_t timeout_s)
{
    w->fd = open(device, O_WRONLY | O_CLOEXEC);
    if (w->fd < 0) {
        return fail(w, device, strerror(errno));
    }
    int seconds = (int)timeout_s;
    /* A driver that cannot change its time-out tells the one it has. */
    if (ioctl(w->fd, WDIOC_SETTIMEOUT, &seconds) != 0 &&
        ioctl(w->fd, WDIOC_GETTIMEOUT, &seconds) != 0) {
        seconds = (int)timeout_s;
    }
    int status = 0;
    w->has_bitten =
        ioctl(w->fd, WDIOC_GETBOOTSTATUS, &status) == 0 && (status & WDIOF_CARDRESET) != 0;
    w->timeout_s = seconds > 0 ? (uint32_t)seconds : 1;
    shorten_period(w, (uint64_t)w->timeout_s * 1000000u);
    return LM_OK;
}

/* The address is a path, or a name of the abstract namespace that begins with '@'
 * (sd_notify(3)). */
static int open_socket(struct drv_watchdog *w, const char *path)
{
    struct sockaddr_un to = {.sun_family = AF_UNIX};
    const size_t length = strlen(path);
    if ((path[0] != '/' && path[0] != '@') || length >= sizeof to.sun_path) {
        return fail(w, path, "not an address of a socket");
    }
    memcpy(to.sun_path, path, length);
    if (path[0] == '@') {
        to.sun_path[0] = '\0';
    }
    w->notify_fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const socklen_t size = (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length);
    if (w->notify_fd < 0 || connect(w->notify_fd, (const struct sockaddr *)&to, size) != 0) {
        const int status = fail(w, path, strerror(errno));
        if (w->notify_fd >= 0) {
            close(w->notify_fd);
            w->notify_fd = -1;
        }
        return status;
    }
    return LM_OK;
}

/* Numbers of the environment; 0 for none. */
static uint64_t number_of(const char *variable)
{
    const char *text = getenv(variable);
    return text != NULL ? strtoull(text, NULL, 10) : 0;
}

int drv_watchdog_open(struct drv_watchdog *w, const char *device, uint32_t timeout_s,
                      uint64_t now_us)
{
    *w = (struct drv_watchdog){.fd = -1, .notify_fd = -1, .due_us = now_us};
    int status = LM_OK;
    if (device != NULL) {
        status = open_device(w, device, timeout_s);
    }
    const char *socket_path = getenv("NOTIFY_SOCKET");
    if (socket_path != NULL && open_socket(w, socket_path) != LM_OK) {
        status = LM_ERR_IO;
    }
    const uint64_t us = number_of("WATCHDOG_USEC"), pid = number_of("WATCHDOG_PID");
    if (w->notify_fd >= 0 && us > 0 && (pid == 0 || pid == (uint64_t)getpid())) {
        shorten_period(w, us);
    }
    return status;
}

bool drv_watchdog_service(struct drv_watchdog *w, struct lm_liveness now, uint64_t now_us)
{
    if (w->period_us == 0 || now_us < w->due_us) {
        return false;
    }
    if (lm_liveness_judge(&w->last, &now) != LM_ALIVE) {
        w->count.refused += !w->is_hungry;
        w->is_hungry = true;
        return false;
    }
    w->last = now;
    w->is_hungry = false;
    w->due_us = now_us + w->period_us;
    if (w->fd >= 0) {
        int unused = 0;
        (void)ioctl(w->fd, WDIOC_KEEPALIVE, &unused);
    }
    drv_watchdog_notify(w, "WATCHDOG=1");
    w->count.fed++;
    return true;
}

void drv_watchdog_notify(struct drv_watchdog *w, const char *text)
{
    if (w->notify_fd >= 0) {
        (void)send(w->notify_fd, text, strnlen(text, 512), MSG_DONTWAIT | MSG_NOSIGNAL);
    }
}

void drv_watchdog_close(struct drv_watchdog *w)
{
    if (w->fd >= 0) {
        /* The kernel stops the watchdog only after this character (watchdog-api.rst). */
        if (write(w->fd, "V", 1) != 1) {
            fail(w, "watchdog", strerror(errno));
        }
        close(w->fd);
        w->fd = -1;
    }
    if (w->notify_fd >= 0) {
        close(w->notify_fd);
        w->notify_fd = -1;
    }
}
