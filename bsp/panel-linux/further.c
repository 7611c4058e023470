#include "further.h"

#include "record.h"
#include "report.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

/* A panel locks its memory, and stacks with it. */
enum { STACK_BYTES = 512 << 10 };

static const char *path_of(const struct further *f, uint32_t i)
{
    return f->config->further[i];
}

static bool is_named(const struct further *f, uint32_t i)
{
    return path_of(f, i)[0] != '\0';
}

static struct further_mark mark_of(const char *path)
{
    struct stat s;
    struct further_mark mark = {0};
    if (stat(path, &s) == 0) {
        mark.device = s.st_dev;
        mark.inode = s.st_ino;
        mark.bytes = s.st_size;
        mark.changed_ns = (int64_t)s.st_mtim.tv_sec * 1000000000 + s.st_mtim.tv_nsec;
    }
    return mark;
}

static bool is_same(const struct further_mark *a, const struct further_mark *b)
{
    return a->device == b->device && a->inode == b->inode && a->bytes == b->bytes &&
           a->changed_ns == b->changed_ns;
}

/* Open and judge a file. Serial numbers are counted for the database alone: one file remembers
 * one. */
static bool open_file(struct further *f, uint32_t i)
{
    struct further_place *p = &f->place[i];
    struct config c = *f->config;
    p->opened = mark_of(path_of(f, i));
    const int cause = drv_flash_file_open(&p->file, path_of(f, i));
    if (cause != 0) {
        report(cause == ENOENT ? REPORT_NOTICE : REPORT_ERROR, "%s: %s; %s", path_of(f, i),
               strerror(cause),
               cause == ENOENT ? "it is flown when it is there"
                               : "the others are flown without it");
        return false;
    }
    snprintf(c.database, sizeof c.database, "%s", path_of(f, i));
    c.database_serial[0] = '\0';
    const struct database judged = database_judge(&c, &p->file.port, false, &f->is_over);
    if (!judged.is_flown || p->file.port.size_bytes == 0) {
        drv_flash_file_close(&p->file);
        return false;
    }
    const struct lm_flash_part whole = {0, p->file.port.size_bytes};
    p->crc = record_image_crc(&p->file.port, &whole, 1);
    p->is_unsigned = judged.is_unsigned;
    return true;
}

const struct lm_flash *further_join(struct further *f, const struct config *config,
                                    const struct lm_flash *first, struct lm_flash_part *parts,
                                    struct database *verdict)
{
    const struct lm_flash *flash[LM_IMAGES_MAX] = {first};
    f->config = config;
    f->look_ms = FURTHER_LOOK_MS;
    for (uint32_t i = 0; i < FURTHER_PLACES; i++) {
        struct further_place *p = &f->place[i];
        if (!is_named(f, i)) {
            continue;
        }
        f->is_joined = true;
        if (open_file(f, i)) {
            verdict->is_unsigned |= p->is_unsigned;
            flash[i + 1] = &p->file.port;
            p->state = FURTHER_FLOWN;
        } else {
            p->refused = p->opened;
        }
    }
    if (!f->is_joined) {
        return first;
    }
    drv_flash_joined_open(&f->joined, flash, LM_IMAGES_MAX, parts);
    return &f->joined.port;
}

static void report_place(const struct further *f, const struct lm_unit *unit, uint32_t i)
{
    const int status = unit->map.part_status[i + 1];
    if (status == LM_OK) {
        report(REPORT_INFO, "%s: flown beside the database", path_of(f, i));
        return;
    }
    report(REPORT_ERROR, "%s: not shown: %s", path_of(f, i),
           status == LM_ERR_SENSOR  ? "its reflectivity is of another band than the "
                                      "database's; build both for one radar"
           : status == LM_ERR_TABLE ? "its classes or its radar table are not the "
                                      "database's; build both with one class table"
           : status == LM_ERR_VERSION
               ? "an image of another version; `landmass-db convert` renews old ones"
               : "not a database for this firmware; landmass-db verify tells why");
}

void further_report(const struct further *f, const struct lm_unit *unit)
{
    for (uint32_t i = 0; i < FURTHER_PLACES; i++) {
        if (f->place[i].state == FURTHER_FLOWN) {
            report_place(f, unit, i);
        }
    }
}

/* ---- the thread ---- */

/* A file that is being copied changes from look to look. */
static void look(struct further *f, uint32_t i)
{
    struct further_place *p = &f->place[i];
    const struct further_mark now = mark_of(path_of(f, i));
    const bool stands_still = now.inode != 0 && is_same(&now, &p->seen);
    const int state = atomic_load(&p->state);
    p->seen = now;
    if (state == FURTHER_GONE) {
        drv_flash_file_close(&p->file);
        atomic_store(&p->state, FURTHER_EMPTY);
    } else if (state == FURTHER_FLOWN && !is_same(&now, &p->opened)) {
        atomic_store(&p->state, FURTHER_GOES);
    } else if (state == FURTHER_EMPTY && stands_still && !is_same(&now, &p->refused)) {
        if (open_file(f, i)) {
            atomic_store(&p->state, FURTHER_COMES);
        } else {
            p->refused = p->opened;
        }
    }
}

static void *run(void *argument)
{
    struct further *f = argument;
    while (!atomic_load(&f->is_over)) {
        struct timespec due;
        clock_gettime(CLOCK_MONOTONIC, &due);
        const uint64_t ns = (uint64_t)due.tv_nsec + atomic_load(&f->look_ms) * UINT64_C(1000000);
        due.tv_sec += (time_t)(ns / 1000000000);
        due.tv_nsec = (long)(ns % 1000000000);
        (void)sem_clockwait(&f->stop, CLOCK_MONOTONIC, &due);
        for (uint32_t i = 0; i < FURTHER_PLACES && !atomic_load(&f->is_over); i++) {
            if (is_named(f, i)) {
                look(f, i);
            }
        }
    }
    return NULL;
}

void further_start(struct further *f)
{
    if (!f->is_joined) {
        return;
    }
    pthread_attr_t attributes;
    int cause = sem_init(&f->stop, 0, 0) == 0 ? pthread_attr_init(&attributes) : errno;
    if (cause == 0) {
        pthread_attr_setstacksize(&attributes, STACK_BYTES);
        cause = pthread_create(&f->thread, &attributes, run, f);
        pthread_attr_destroy(&attributes);
    }
    f->has_thread = cause == 0;
    if (cause != 0) {
        report(REPORT_ERROR, "database.2 and on: no thread to look for their files: %s",
               strerror(cause));
    }
}

void further_stop(struct further *f)
{
    if (f->has_thread) {
        atomic_store(&f->is_over, true);
        sem_post(&f->stop);
        pthread_join(f->thread, NULL);
        sem_destroy(&f->stop);
        f->has_thread = false;
    }
}

void further_close(struct further *f)
{
    for (uint32_t i = 0; i < FURTHER_PLACES; i++) {
        if (f->place[i].state != FURTHER_EMPTY) {
            drv_flash_file_close(&f->place[i].file);
            f->place[i].state = FURTHER_EMPTY;
        }
    }
}

/* ---- the loop ---- */

bool further_next(struct further *f, struct lm_control *control)
{
    for (uint32_t i = 0; i < FURTHER_PLACES && f->has_thread; i++) {
        struct further_place *p = &f->place[i];
        const int state = atomic_load(&p->state);
        if ((state != FURTHER_COMES && state != FURTHER_GOES) || p->is_told) {
            continue;
        }
        p->is_told = true;
        *control = (struct lm_control){.kind = LM_CONTROL_IMAGE, .image.place = (int32_t)i + 2};
        if (state == FURTHER_COMES) {
            control->image.bytes = drv_flash_joined_put(&f->joined, i + 1, &p->file.port).bytes;
            control->image.crc = p->crc;
            control->image.is_unsigned = p->is_unsigned;
        }
        return true;
    }
    return false;
}

/* Whether the unit still has the image of a place. */
static bool is_held(const struct lm_unit *unit, uint32_t i)
{
    const uint64_t offset = (uint64_t)(i + 1) << DRV_FLASH_JOINED_LOG2;
    return lm_unit_map_image_from(&unit->map, offset) < unit->map.image_count;
}

static void let_go(struct further *f, const struct lm_unit *unit, uint32_t i)
{
    struct further_place *p = &f->place[i];
    if (is_held(unit, i)) {
        report(REPORT_ERROR,
               "%s: gone or changed, and flown on: it is the only one; restart the panel",
               path_of(f, i));
        atomic_store(&p->state, FURTHER_STAYS);
    } else if (lm_tile_cache_is_drained(&unit->map.tiles)) {
        (void)drv_flash_joined_put(&f->joined, i + 1, NULL);
        p->is_told = false;
        report(REPORT_NOTICE, "%s: gone or changed; no longer flown", path_of(f, i));
        atomic_store(&p->state, FURTHER_GONE);
    }
}

void further_settle(struct further *f, const struct lm_unit *unit)
{
    for (uint32_t i = 0; i < FURTHER_PLACES && f->has_thread; i++) {
        struct further_place *p = &f->place[i];
        const int state = atomic_load(&p->state);
        if (!p->is_told) {
            continue;
        }
        if (state == FURTHER_COMES) {
            p->is_told = false;
            report_place(f, unit, i);
            atomic_store(&p->state, FURTHER_FLOWN);
        } else if (state == FURTHER_GOES) {
            let_go(f, unit, i);
        }
    }
}
