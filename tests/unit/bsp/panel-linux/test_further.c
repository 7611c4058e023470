/* Further images of a panel: which are flown beside the database at the start, and how they come
 * and go with their files in flight. The files are real, and so is the thread that looks. */
#include "check.h"
#include "panel.h"
#include "support.h"
#include "tiny_country.h"
#include "unit_rig.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { LOOK_MS = 20, PATIENCE_S = 60 };

struct flight {
    struct rig *rig;
    struct config config;
    struct panel panel;
    struct tiny_image range, foreign;
    struct lm_can no_answer;
};

static struct tiny_cell trees(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    (void)p;
    return (struct tiny_cell){-12, TINY_TREES, 2};
}

/* A finer image, and one of other classes. */
static void build_images(struct flight *f)
{
    struct tiny_spec spec = tiny_country(4);
    struct lm_classes other = *tiny_classes();
    spec.shift0--;
    spec.cell = trees;
    assert_int_equal(tiny_image_build(&f->range, &spec), 0);
    other.height_dm[15]++;
    spec.classes = &other;
    assert_int_equal(tiny_image_build(&f->foreign, &spec), 0);
}

static struct flight *prepare(void)
{
    struct flight *f = calloc(1, sizeof *f);
    struct config *c = &f->config;
    const char *const build = support_build_dir();
    f->rig = make_rig();
    build_images(f);
    config_defaults(c);
    c->can[0] = c->record[0] = c->faults[0] = c->settings[0] = '\0';
    c->slot_a[0] = c->slot_b[0] = c->slot_progress[0] = c->database_serial[0] = '\0';
    c->glass = CONFIG_GLASS_NONE;
    c->stick.choice = CONFIG_STICK_NONE;
    c->priority = c->locks_memory = 0;
    c->glass_picture = (struct config_size){WIDTH, HEIGHT};
    c->database_trust = 1; /* any */
    support_run("rm -rf %s/tmp/further && mkdir -p %s/tmp/further", build, build);
    snprintf(c->database, sizeof c->database, "%s/tmp/further/1", build);
    snprintf(c->further[0], sizeof c->further[0], "%s/tmp/further/2", build);
    snprintf(c->further[1], sizeof c->further[1], "%s/tmp/further/3", build);
    assert_int_equal(tiny_image_write(&f->rig->image, c->database), 0);
    return f;
}

static void take_off(struct flight *f)
{
    assert_int_equal(panel_open(&f->panel, &f->config), 0);
    atomic_store(&f->panel.further.look_ms, LOOK_MS);
    f->panel.bus.port = f->rig->board.can;
}

static void land(struct flight *f)
{
    panel_close(&f->panel);
    tiny_image_free(&f->range);
    tiny_image_free(&f->foreign);
    free_rig(f->rig);
    free(f);
}

static void step(struct flight *f)
{
    const struct timespec rest = {.tv_nsec = 20000};
    f->rig->bus.now_us = f->rig->now_us;
    panel_step(&f->panel, f->rig->now_us);
    f->rig->now_us += PANEL_TICK_US;
    nanosleep(&rest, NULL);
}

static void fly(struct flight *f, int steps)
{
    for (int i = 0; i < steps; i++) {
        step(f);
    }
}

/* Fly until a place is in a state. */
static void await(struct flight *f, uint32_t place, enum further_state state)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    const time_t end = now.tv_sec + PATIENCE_S;
    while ((int)state != atomic_load(&f->panel.further.place[place - 2].state) &&
           now.tv_sec < end) {
        step(f);
        clock_gettime(CLOCK_MONOTONIC, &now);
    }
    assert_int_equal(atomic_load(&f->panel.further.place[place - 2].state), state);
}

/* As an installer does: written beside it, then renamed. */
static void install(const struct tiny_image *image, const char *path)
{
    char beside[CONFIG_PATH + 8];
    snprintf(beside, sizeof beside, "%s.new", path);
    assert_int_equal(tiny_image_write(image, beside), 0);
    assert_int_equal(rename(beside, path), 0);
}

static uint32_t images(const struct flight *f)
{
    return f->panel.unit->map.image_count;
}

/* The flag alone may also come of a machine on which the flash's thread has to wait. */
static bool is_refused(const struct flight *f)
{
    return lm_unit_map_refused(&f->panel.unit->map) != 0;
}

TEST(at_the_start_the_files_that_are_there_are_joined_each_at_its_place)
{
    struct flight *f = prepare();
    struct further g = {0};
    struct database verdict = {.is_flown = true};
    struct lm_flash_part parts[LM_IMAGES_MAX] = {{0}};
    struct drv_flash_file first;
    uint8_t got[64];
    assert_int_equal(drv_flash_file_open(&first, f->config.database), 0);
    install(&f->range, f->config.further[1]);
    const struct lm_flash *const joined =
        further_join(&g, &f->config, &first.port, parts, &verdict);
    assert_true(joined != &first.port && verdict.is_unsigned);
    assert_int_equal(parts[0].bytes, f->rig->image.size);
    assert_int_equal(parts[1].bytes, 0);
    assert_int_equal(parts[2].bytes, f->range.size);
    assert_int_equal(joined->read_start(joined->ctx, parts[2].offset, got, sizeof got), LM_OK);
    assert_int_equal(joined->read_poll(joined->ctx), LM_OK);
    assert_memory_equal(got, f->range.bytes, sizeof got);
    assert_int_equal(joined->read_start(joined->ctx, parts[1].offset, got, 1), LM_ERR_RANGE);
    further_close(&g);
    f->config.database_trust = 0; /* signed alone */
    verdict.is_unsigned = false;
    g = (struct further){0};
    (void)further_join(&g, &f->config, &first.port, parts, &verdict);
    assert_true(parts[2].bytes == 0 && !verdict.is_unsigned);
    further_close(&g);
    f->config.further[0][0] = f->config.further[1][0] = '\0';
    g = (struct further){0};
    assert_ptr_equal(further_join(&g, &f->config, &first.port, parts, &verdict), &first.port);
    drv_flash_file_close(&first);
    f->config.database_trust = 1;
    take_off(f);
    land(f);
}

TEST(an_image_comes_and_goes_with_its_file)
{
    struct flight *f = prepare();
    take_off(f);
    fly(f, 200);
    assert_int_equal(images(f), 1);
    for (int i = 0; i < 3; i++) {
        install(&f->range, f->config.further[0]);
        await(f, 2, FURTHER_FLOWN);
        assert_int_equal(images(f), 2);
        assert_int_equal(f->panel.unit->map.images[0].shift0 + 1,
                         f->panel.unit->map.images[1].shift0);
        assert_int_equal(f->panel.unit->unsigned_places, 2);
        fly(f, 200);
        assert_true(f->panel.unit->map.tiles.slots[0].state != LM_SLOT_FREE);
        assert_false(is_refused(f));
        const uint32_t frames = f->panel.unit->count.frames;
        assert_int_equal(unlink(f->config.further[0]), 0);
        await(f, 2, FURTHER_EMPTY);
        assert_int_equal(images(f), 1);
        assert_int_equal(f->panel.unit->unsigned_places, 0);
        fly(f, 200);
        assert_true(f->panel.unit->count.frames > frames);
        assert_int_equal(atomic_load(&f->panel.flash.count.failed), 0);
    }
    assert_int_equal(f->panel.unit->count.commands_refused, 0);
    assert_false(is_refused(f));
    land(f);
}

TEST(a_file_that_is_replaced_is_another_image_and_a_bad_one_is_told_and_outlived)
{
    struct flight *f = prepare();
    install(&f->range, f->config.further[0]);
    take_off(f);
    fly(f, 100);
    assert_int_equal(images(f), 2);
    install(&f->foreign, f->config.further[0]);
    await(f, 2, FURTHER_EMPTY);
    await(f, 2, FURTHER_FLOWN);
    assert_int_equal(images(f), 1);
    assert_int_equal(f->panel.unit->map.part_status[1], LM_ERR_TABLE);
    fly(f, 10);
    assert_true(is_refused(f) && (f->panel.unit->flags & LM_FLAG_TILE) != 0);
    uint8_t noise[5000];
    memset(noise, 0xa5, sizeof noise);
    install(&(struct tiny_image){.bytes = noise, .size = sizeof noise}, f->config.further[1]);
    const struct further_place *third = &f->panel.further.place[1];
    await(f, 3, FURTHER_FLOWN);
    assert_int_equal(f->panel.unit->map.part_status[2], LM_ERR_CORRUPT);
    install(&f->range, f->config.further[0]);
    await(f, 2, FURTHER_EMPTY);
    await(f, 2, FURTHER_FLOWN);
    assert_int_equal(images(f), 2);
    assert_int_equal(unlink(f->config.further[1]), 0);
    await(f, 3, FURTHER_EMPTY);
    fly(f, 10);
    assert_false(is_refused(f));
    assert_int_equal(atomic_load(&third->state), FURTHER_EMPTY);
    land(f);
}
