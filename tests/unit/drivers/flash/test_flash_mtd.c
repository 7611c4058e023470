/* An MTD device with bad blocks, unreadable pages, and a read() that hides what could not be
 * corrected, as Linux's does. */
#include "check.h"
#include "drv/flash_mtd.h"
#include "drv/flash_reader.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/types.h>
#include <time.h>

#include <mtd/mtd-user.h>

enum { FD = 1000, BLOCK = 4096, BLOCKS = 16, NOTHING = BLOCKS };

static struct {
    uint8_t bytes[BLOCKS * BLOCK];
    uint8_t type;
    uint32_t bad;        /* bit n: block n */
    uint32_t unreadable; /* block whose reads fail with EIO */
    uint32_t rotten;     /* block whose bits cannot be corrected */
    uint32_t failures;   /* reads that fail before one succeeds */
    uint32_t chunk;      /* most bytes that one read gives */
    uint32_t slow_us;
    bool has_device;
    struct mtd_ecc_stats ecc;
} chip;

int __wrap_open(const char *path, int flags, ...);
int __wrap_close(int fd);
int __wrap_ioctl(int fd, unsigned long request, ...);
ssize_t __wrap_pread(int fd, void *bytes, size_t size, off_t at);

int __wrap_open(const char *path, int flags, ...)
{
    (void)path;
    (void)flags;
    return FD;
}

int __wrap_close(int fd)
{
    (void)fd;
    return 0;
}

static int is_bad(const loff_t *at)
{
    return (int)(chip.bad >> (*at / BLOCK) & 1);
}

int __wrap_ioctl(int fd, unsigned long request, ...)
{
    va_list arguments;
    va_start(arguments, request);
    void *p = va_arg(arguments, void *);
    va_end(arguments);
    assert_int_equal(fd, FD);
    if (request == MEMGETINFO && chip.has_device) {
        *(struct mtd_info_user *)p = (struct mtd_info_user){
            .type = chip.type, .size = sizeof chip.bytes, .erasesize = BLOCK};
        return 0;
    }
    if (request == MEMGETBADBLOCK && chip.type == MTD_NANDFLASH) {
        return is_bad(p);
    }
    if (request == ECCGETSTATS) {
        *(struct mtd_ecc_stats *)p = chip.ecc;
        return 0;
    }
    errno = ENOTTY;
    return -1;
}

ssize_t __wrap_pread(int fd, void *bytes, size_t size, off_t at)
{
    assert_int_equal(fd, FD);
    const uint32_t block = (uint32_t)(at / BLOCK);
    assert_true((chip.bad >> block & 1) == 0); /* nobody may look into a bad block */
    assert_true((uint32_t)((at + (off_t)size - 1) / BLOCK) == block);
    if (chip.slow_us > 0) {
        const struct timespec rest = {.tv_nsec = (long)chip.slow_us * 1000};
        nanosleep(&rest, NULL);
    }
    if (block == chip.unreadable || chip.failures > 0) {
        chip.failures -= chip.failures > 0;
        memset(bytes, 0xee, size / 2); /* half of it was there already */
        errno = EIO;
        return -1;
    }
    chip.ecc.failed += block == chip.rotten;
    const size_t given = size < chip.chunk ? size : chip.chunk;
    memcpy(bytes, chip.bytes + at, given);
    return (ssize_t)given;
}

static int set_up(void **state)
{
    (void)state;
    memset(&chip, 0, sizeof chip);
    for (size_t i = 0; i < sizeof chip.bytes; i++) {
        chip.bytes[i] = (uint8_t)(i * 7 + i / BLOCK * 31);
    }
    chip.type = MTD_NANDFLASH;
    chip.unreadable = chip.rotten = NOTHING;
    chip.chunk = 1000;
    chip.has_device = true;
    return 0;
}

/* The image as nandwrite would have laid it: the good blocks in their order. */
static size_t image(uint8_t *bytes)
{
    size_t size = 0;
    for (uint32_t block = 0; block < BLOCKS; block++) {
        if ((chip.bad >> block & 1) == 0) {
            memcpy(bytes + size, chip.bytes + block * BLOCK, BLOCK);
            size += BLOCK;
        }
    }
    return size;
}

TEST_WITH(reads_step_over_bad_blocks, set_up, NULL)
{
    static const uint32_t cases[] = {0, 1, 1u << 15, 0x0ff0, 0x5555, 0xfffe};
    static uint8_t expected[sizeof chip.bytes], got[sizeof chip.bytes];
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct drv_flash_mtd f;
        chip.bad = cases[i];
        assert_int_equal(drv_flash_mtd_open(&f, "/dev/mtd0"), 0);
        const size_t size = image(expected);
        assert_int_equal(f.port.size_bytes, size);
        assert_int_equal(f.count.bad_blocks, BLOCKS - size / BLOCK);
        for (uint32_t at = 0; at < size; at += 1777) {
            const uint32_t length = (uint32_t)(size - at < 9000 ? size - at : 9000);
            assert_int_equal(f.port.read_start(f.port.ctx, at, got, length), LM_OK);
            assert_int_equal(f.port.read_poll(f.port.ctx), LM_OK);
            assert_memory_equal(got, expected + at, length);
        }
        assert_int_equal(f.port.read_start(f.port.ctx, size - 1, got, 2), LM_ERR_RANGE);
        assert_int_equal(f.port.read_start(f.port.ctx, UINT64_MAX, got, 2), LM_ERR_RANGE);
        drv_flash_mtd_close(&f);
    }
}

TEST_WITH(what_could_not_be_corrected_is_an_error_though_read_says_nothing, set_up, NULL)
{
    struct drv_flash_mtd f;
    uint8_t got[2 * BLOCK];
    chip.rotten = 3;
    assert_int_equal(drv_flash_mtd_open(&f, "/dev/mtd0"), 0);
    assert_int_equal(f.port.read_start(f.port.ctx, 2 * BLOCK, got, BLOCK), LM_OK);
    assert_int_equal(f.port.read_poll(f.port.ctx), LM_OK);
    assert_int_equal(f.port.read_start(f.port.ctx, 2 * BLOCK, got, 2 * BLOCK), LM_OK);
    assert_int_equal(f.port.read_poll(f.port.ctx), LM_ERR_IO);
    assert_int_equal(f.count.uncorrectable, 1);
    assert_int_equal(f.port.read_start(f.port.ctx, 5 * BLOCK, got, BLOCK), LM_OK);
    assert_int_equal(f.port.read_poll(f.port.ctx), LM_OK);
    drv_flash_mtd_close(&f);
}

TEST_WITH(a_block_that_cannot_be_read_fails_its_reads_and_no_others, set_up, NULL)
{
    struct drv_flash_mtd f;
    uint8_t got[BLOCK];
    chip.unreadable = 5;
    assert_int_equal(drv_flash_mtd_open(&f, "/dev/mtd0"), 0);
    for (uint32_t block = 0; block < BLOCKS; block++) {
        assert_int_equal(f.port.read_start(f.port.ctx, block * BLOCK, got, BLOCK), LM_OK);
        assert_int_equal(f.port.read_poll(f.port.ctx), block == 5 ? LM_ERR_IO : LM_OK);
    }
    assert_int_equal(f.count.errors, 1);
    drv_flash_mtd_close(&f);
}

TEST_WITH(nor_flash_has_no_bad_blocks, set_up, NULL)
{
    struct drv_flash_mtd f;
    chip.type = MTD_NORFLASH;
    assert_int_equal(drv_flash_mtd_open(&f, "/dev/mtd0"), 0);
    assert_int_equal(f.port.size_bytes, sizeof chip.bytes);
    assert_false(f.has_ecc);
    drv_flash_mtd_close(&f);
}

TEST_WITH(what_is_no_mtd_device_is_left_to_others, set_up, NULL)
{
    struct drv_flash_mtd f;
    chip.has_device = false;
    assert_int_equal(drv_flash_mtd_open(&f, "/dev/sda"), ENOTTY);
    assert_int_equal(f.fd, -1);
}

/* Asked until it is done, as lm_flash wants it: the loop never waits. */
static int finish(struct drv_flash_reader *r)
{
    int status;
    while ((status = r->port.read_poll(r->port.ctx)) == LM_BUSY) {
        const struct timespec rest = {.tv_nsec = 50000};
        nanosleep(&rest, NULL);
    }
    return status;
}

TEST_WITH(the_reader_answers_at_once_and_reads_behind_the_loops_back, set_up, NULL)
{
    struct drv_flash_mtd f;
    static struct drv_flash_reader r;
    static uint8_t got[3 * BLOCK];
    chip.slow_us = 2000;
    assert_int_equal(drv_flash_mtd_open(&f, "/dev/mtd0"), 0);
    assert_int_equal(drv_flash_reader_start(&r, &f.port), 0);
    assert_int_equal(r.port.size_bytes, sizeof chip.bytes);
    assert_int_equal(r.port.read_start(r.port.ctx, 100, got, sizeof got), LM_OK);
    assert_int_equal(r.port.read_poll(r.port.ctx), LM_BUSY); /* 20 ms of reading lie ahead */
    assert_int_equal(r.port.read_start(r.port.ctx, 0, got, 1), LM_ERR_IO); /* one at a time */
    assert_int_equal(finish(&r), LM_OK);
    assert_memory_equal(got, chip.bytes + 100, sizeof got);
    assert_int_equal(r.port.read_start(r.port.ctx, sizeof chip.bytes, got, 1), LM_ERR_RANGE);
    drv_flash_reader_stop(&r);
    drv_flash_mtd_close(&f);
}

TEST_WITH(the_reader_waits_when_it_is_told_to_be_patient, set_up, NULL)
{
    struct drv_flash_mtd f;
    static struct drv_flash_reader r;
    static uint8_t got[3 * BLOCK];
    chip.slow_us = 1000;
    assert_int_equal(drv_flash_mtd_open(&f, "/dev/mtd0"), 0);
    assert_int_equal(drv_flash_reader_start(&r, &f.port), 0);
    r.patience_us = 10000000;
    assert_int_equal(r.port.read_start(r.port.ctx, 0, got, sizeof got), LM_OK);
    assert_int_equal(r.port.read_poll(r.port.ctx), LM_OK);
    drv_flash_reader_stop(&r);
    drv_flash_mtd_close(&f);
}

TEST_WITH(a_read_that_fails_once_is_tried_again_and_one_that_fails_twice_is_told, set_up, NULL)
{
    struct drv_flash_mtd f;
    static struct drv_flash_reader r;
    uint8_t got[BLOCK];
    assert_int_equal(drv_flash_mtd_open(&f, "/dev/mtd0"), 0);
    assert_int_equal(drv_flash_reader_start(&r, &f.port), 0);
    chip.failures = 1;
    assert_int_equal(r.port.read_start(r.port.ctx, 0, got, BLOCK), LM_OK);
    assert_int_equal(finish(&r), LM_OK);
    assert_memory_equal(got, chip.bytes, BLOCK);
    chip.failures = 2;
    assert_int_equal(r.port.read_start(r.port.ctx, 0, got, BLOCK), LM_OK);
    assert_int_equal(finish(&r), LM_ERR_IO);
    assert_int_equal(atomic_load(&r.count.again), 2);
    assert_int_equal(atomic_load(&r.count.failed), 1);
    drv_flash_reader_stop(&r);
    drv_flash_reader_stop(&r); /* once more does no harm */
    drv_flash_mtd_close(&f);
}
