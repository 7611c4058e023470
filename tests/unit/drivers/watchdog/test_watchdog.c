/* The rule of feeding, the board's watchdog as a file, and systemd's socket as a real one. */
#include "drv/watchdog.h"

#include "check.h"
#include "lm/status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

static char path[] = "/tmp/landmass-watchdog-XXXXXX"; /* of the device or the socket */

static int no_environment(void **state)
{
    (void)state;
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
    unsetenv("WATCHDOG_PID");
    strcpy(path, "/tmp/landmass-watchdog-XXXXXX");
    close(mkstemp(path));
    return 0;
}

static int remove_path(void **state)
{
    (void)state;
    unlink(path);
    return 0;
}

static int bind_socket(const char *name, size_t length)
{
    struct sockaddr_un at = {.sun_family = AF_UNIX};
    memcpy(at.sun_path, name, length);
    const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
    assert_int_equal(bind(fd, (const struct sockaddr *)&at,
                          (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length)),
                     0);
    return fd;
}

static void expect_message(int fd, const char *text)
{
    char got[600] = "";
    assert_true(recv(fd, got, sizeof got - 1, 0) > 0);
    assert_string_equal(got, text);
}

static void expect_silence(int fd)
{
    char got[8];
    assert_int_equal(recv(fd, got, sizeof got, 0), -1);
}

/* All combinations of what has progressed. The first that stands still is named. */
TEST(life_is_proved_only_when_everything_has_progressed)
{
    const struct lm_liveness last = {5, 10, 20, UINT32_MAX};
    for (uint32_t moved = 0; moved < 16; moved++) {
        const struct lm_liveness now = {5 + (moved & 1), 10 + (moved >> 1 & 1),
                                        20 + (moved >> 2 & 1), UINT32_MAX + (moved >> 3)};
        const enum lm_life life = !(moved & 1)   ? LM_LIFE_NO_STEP
                                  : !(moved & 2) ? LM_LIFE_NO_FRAME
                                  : !(moved & 4) ? LM_LIFE_NO_BUS
                                  : !(moved & 8) ? LM_LIFE_NOT_SHOWN
                                                 : LM_ALIVE;
        assert_int_equal(lm_liveness_judge(&last, &now), life);
    }
}

/* Parts that progress one after the other count together: what counts is since the last meal. */
TEST_WITH(slow_parts_have_until_the_next_meal, no_environment, remove_path)
{
    struct drv_watchdog w;
    struct lm_liveness now = {0};
    assert_int_equal(drv_watchdog_open(&w, path, 4, 0), LM_OK);
    now.frames = 5;
    assert_false(drv_watchdog_service(&w, now, 0));
    now.bus = 3;
    now.steps = 9;
    assert_false(drv_watchdog_service(&w, now, 1000));
    now.shown = 1;
    assert_true(drv_watchdog_service(&w, now, 2000));
    assert_false(drv_watchdog_service(&w, now, 10000000));
    drv_watchdog_close(&w);
}

TEST_WITH(systemd_is_fed_at_half_its_time_out, no_environment, remove_path)
{
    unlink(path);
    const int fd = bind_socket(path, strlen(path));
    setenv("NOTIFY_SOCKET", path, 1);
    setenv("WATCHDOG_USEC", "2000000", 1);
    struct drv_watchdog w;
    assert_int_equal(drv_watchdog_open(&w, NULL, 5, 0), LM_OK);
    uint32_t fed = 0;
    for (uint64_t now = 0; now <= 10000000; now += 2000) {
        const uint32_t n = (uint32_t)(now / 2000) + 1;
        if (drv_watchdog_service(&w, (struct lm_liveness){n, n, n, n}, now)) {
            expect_message(fd, "WATCHDOG=1");
            fed++;
        }
        expect_silence(fd);
    }
    assert_int_equal(fed, 11);
    drv_watchdog_close(&w);
    close(fd);
}

TEST_WITH(a_glass_that_stands_still_starves_the_dog_until_it_moves, no_environment, remove_path)
{
    unlink(path);
    const int fd = bind_socket(path, strlen(path));
    setenv("NOTIFY_SOCKET", path, 1);
    setenv("WATCHDOG_USEC", "2000000", 1);
    struct drv_watchdog w;
    assert_int_equal(drv_watchdog_open(&w, NULL, 5, 0), LM_OK);
    assert_true(drv_watchdog_service(&w, (struct lm_liveness){1, 1, 1, 1}, 0));
    expect_message(fd, "WATCHDOG=1");
    for (uint32_t ms = 2; ms < 5000; ms += 2) {
        assert_false(drv_watchdog_service(&w, (struct lm_liveness){ms, ms, ms, 1}, ms * 1000));
    }
    expect_silence(fd);
    assert_int_equal(w.count.refused, 1);
    assert_true(drv_watchdog_service(&w, (struct lm_liveness){6000, 6000, 6000, 2}, 5000000));
    drv_watchdog_close(&w);
    close(fd);
}

TEST_WITH(a_time_out_meant_for_another_process_is_not_ours, no_environment, remove_path)
{
    unlink(path);
    const int fd = bind_socket(path, strlen(path));
    setenv("NOTIFY_SOCKET", path, 1);
    setenv("WATCHDOG_USEC", "2000000", 1);
    setenv("WATCHDOG_PID", "1", 1);
    struct drv_watchdog w;
    assert_int_equal(drv_watchdog_open(&w, NULL, 5, 0), LM_OK);
    assert_int_equal(w.period_us, 0);
    assert_false(drv_watchdog_service(&w, (struct lm_liveness){1, 1, 1, 1}, 0));
    drv_watchdog_notify(&w, "READY=1");
    expect_message(fd, "READY=1");
    drv_watchdog_close(&w);
    close(fd);
}

TEST_WITH(an_abstract_socket_is_understood, no_environment, remove_path)
{
    char name[64];
    const int length = snprintf(name, sizeof name, "@landmass-test-%d", (int)getpid());
    setenv("NOTIFY_SOCKET", name, 1);
    name[0] = '\0';
    const int fd = bind_socket(name, (size_t)length);
    struct drv_watchdog w;
    assert_int_equal(drv_watchdog_open(&w, NULL, 5, 0), LM_OK);
    drv_watchdog_notify(&w, "STATUS=no fault");
    expect_message(fd, "STATUS=no fault");
    drv_watchdog_close(&w);
    close(fd);
}

TEST_WITH(a_socket_that_nobody_reads_does_not_stop_the_loop, no_environment, remove_path)
{
    unlink(path);
    const int fd = bind_socket(path, strlen(path));
    setenv("NOTIFY_SOCKET", path, 1);
    struct drv_watchdog w;
    assert_int_equal(drv_watchdog_open(&w, NULL, 5, 0), LM_OK);
    for (int i = 0; i < 10000; i++) {
        drv_watchdog_notify(&w, "STATUS=full");
    }
    close(fd);
    drv_watchdog_notify(&w, "STATUS=gone");
    drv_watchdog_close(&w);
}

TEST_WITH(only_a_commanded_stop_calls_the_boards_dog_off, no_environment, remove_path)
{
    struct drv_watchdog w;
    char bytes[8] = "";
    assert_int_equal(drv_watchdog_open(&w, path, 4, 0), LM_OK);
    assert_int_equal(w.period_us, 2000000); /* a file changes no time-out; ours holds */
    assert_true(drv_watchdog_service(&w, (struct lm_liveness){1, 1, 1, 1}, 0));
    FILE *device = fopen(path, "r");
    assert_int_equal(fread(bytes, 1, sizeof bytes, device), 0);
    drv_watchdog_close(&w);
    rewind(device);
    assert_int_equal(fread(bytes, 1, sizeof bytes, device), 1);
    assert_int_equal(bytes[0], 'V');
    fclose(device);
}

TEST_WITH(what_is_not_to_be_had_is_told_and_the_rest_works, no_environment, remove_path)
{
    struct drv_watchdog w;
    assert_int_equal(drv_watchdog_open(&w, "/nowhere/watchdog", 4, 0), LM_ERR_IO);
    assert_non_null(strstr(w.error, "/nowhere/watchdog"));
    drv_watchdog_close(&w);
    setenv("NOTIFY_SOCKET", "not a path", 1);
    assert_int_equal(drv_watchdog_open(&w, path, 4, 0), LM_ERR_IO);
    assert_non_null(strstr(w.error, "not a path"));
    assert_true(w.fd >= 0);
    drv_watchdog_close(&w);
}
