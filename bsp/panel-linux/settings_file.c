#include "settings_file.h"

#include "fx/crc32c.h"
#include "hs/durable_file.h"
#include "report.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char magic[8] = "LMSETTG1";

static void seal(const struct lm_settings *s, uint8_t bytes[SETTINGS_FILE_BYTES])
{
    memcpy(bytes, magic, sizeof magic);
    memcpy(bytes + sizeof magic, s, sizeof *s);
    const uint32_t crc = fx_crc32c(0, bytes, SETTINGS_FILE_BYTES - 4);
    for (uint32_t i = 0; i < 4; i++) {
        bytes[SETTINGS_FILE_BYTES - 4 + i] = (uint8_t)(crc >> 8 * i);
    }
}

const struct lm_settings *settings_file_read(struct settings_file *f, const char *path)
{
    uint8_t bytes[SETTINGS_FILE_BYTES + 1], sealed[SETTINGS_FILE_BYTES];
    memset(f, 0, sizeof *f);
    f->path = path;
    const int fd = path[0] != '\0' ? open(path, O_RDONLY | O_CLOEXEC) : -1;
    if (fd < 0) {
        if (path[0] != '\0' && errno != ENOENT) {
            report(REPORT_ERROR, "settings: %s: %s", path, strerror(errno));
        }
        return NULL;
    }
    const ssize_t length = read(fd, bytes, sizeof bytes);
    close(fd);
    memcpy(&f->settings, bytes + sizeof magic, sizeof f->settings);
    seal(&f->settings, sealed);
    if (length != SETTINGS_FILE_BYTES || memcmp(bytes, sealed, sizeof sealed) != 0) {
        report(REPORT_ERROR, "settings: %s: damaged; the panel begins as after power-up", path);
        return NULL;
    }
    return &f->settings;
}

static void write_file(struct settings_file *f, const struct lm_settings *s)
{
    uint8_t bytes[SETTINGS_FILE_BYTES];
    seal(s, bytes);
    const int cause = hs_replace_file(f->path, bytes, sizeof bytes, 0640);
    if (cause != 0) {
        report(REPORT_ERROR, "settings: %s: %s; a restart will have those of before", f->path,
               strerror(cause));
    }
    f->written += cause == 0;
}

static void take(void *ctx)
{
    struct settings_file *f = ctx;
    f->taken = f->handed;
}

static void write_news(void *ctx)
{
    struct settings_file *f = ctx;
    if (memcmp(&f->taken, &f->last, sizeof f->last) != 0) {
        write_file(f, &f->taken);
        f->last = f->taken;
    }
}

void settings_file_start(struct settings_file *f)
{
    if (f->path != NULL && f->path[0] != '\0') {
        f->last = f->settings;
        hand_over_start(&f->writer, "settings", &(struct hand_over_work){f, take, write_news});
    }
}

void settings_file_keep(struct settings_file *f, const struct lm_unit *unit, uint64_t now_us)
{
    if (now_us >= f->next_us && hand_over_begin(&f->writer)) {
        lm_settings_give(unit, &f->handed);
        f->next_us = now_us + SETTINGS_KEPT_US;
        hand_over_end(&f->writer);
    }
}

void settings_file_close(struct settings_file *f)
{
    hand_over_close(&f->writer);
}
