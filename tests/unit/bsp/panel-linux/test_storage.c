/* Which database a panel flies: the newest slot that is whole, then the other one, then the file of
 * the option `database`. Slots are real files, written as landmass-load writes them. */
#include "check.h"
#include "slots/load.h"
#include "storage.h"
#include "support.h"
#include "tiny_country.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { IMAGES = 3 };

static struct tiny_image images[IMAGES];
static struct config config;

static int make_images(void **state)
{
    (void)state;
    for (uint8_t i = 0; i < IMAGES; i++) {
        struct tiny_spec spec = tiny_country(1);
        spec.latitude_deg += i;
        if (tiny_image_build(&images[i], &spec) != 0) {
            return -1;
        }
    }
    return 0;
}

static int free_images(void **state)
{
    (void)state;
    for (int i = 0; i < IMAGES; i++) {
        tiny_image_free(&images[i]);
    }
    return 0;
}

TEST_GROUP(make_images, free_images);

static int set_up(void **state)
{
    (void)state;
    config_defaults(&config);
    config.database_trust = 1; /* any */
    config.database_serial[0] = '\0';
    support_run("rm -rf %s/tmp/database && mkdir -p %s/tmp/database", support_build_dir(),
                support_build_dir());
    snprintf(config.slot_a, sizeof config.slot_a, "%s/tmp/database/a", support_build_dir());
    snprintf(config.slot_b, sizeof config.slot_b, "%s/tmp/database/b", support_build_dir());
    snprintf(config.database, sizeof config.database, "%s/tmp/database/plain", support_build_dir());
    return 0;
}

static void fill(const char *path, const char *other_path, int image)
{
    struct slot slot, other;
    struct slot_load load;
    struct drv_flash_file source;
    char name[200];
    snprintf(name, sizeof name, "%s/tmp/database/image", support_build_dir());
    assert_int_equal(tiny_image_write(&images[image], name), 0);
    assert_int_equal(drv_flash_file_open(&source, name), 0);
    (void)slot_open(&other, other_path, SLOT_TO_READ);
    slot_judge(&other, SLOT_TABLES, NULL, NULL);
    assert_int_equal(slot_open(&slot, path, SLOT_TO_WRITE), 0);
    slot_judge(&slot, SLOT_TABLES, NULL, NULL);
    assert_int_equal(slot_fill(&slot, &source.port, NULL, NULL, NULL, &load), 0);
    assert_int_equal(slot_switch(&slot, &other, &load), 0);
    slot_close(&slot);
    slot_close(&other);
    drv_flash_file_close(&source);
}

/* Which image the flash has; -1: none of them. */
static int image_of(const struct lm_flash *flash)
{
    static uint8_t bytes[1 << 20];
    for (int i = 0; flash && i < IMAGES; i++) {
        if (flash->size_bytes == images[i].size &&
            flash->read_start(flash->ctx, 0, bytes, (uint32_t)images[i].size) == LM_OK &&
            flash->read_poll(flash->ctx) == LM_OK &&
            memcmp(bytes, images[i].bytes, images[i].size) == 0) {
            return i;
        }
    }
    return -1;
}

static int flown(const char **trouble)
{
    struct storage d = {.path = NULL};
    struct database verdict;
    const int image = image_of(storage_open(&d, &config, false, &verdict));
    *trouble = d.trouble;
    storage_close(&d);
    return image;
}

static void spoil(const char *path, off_t at)
{
    const int fd = open(path, O_RDWR);
    uint8_t byte;
    assert_int_equal(pread(fd, &byte, 1, at), 1);
    byte ^= 1;
    assert_int_equal(pwrite(fd, &byte, 1, at), 1);
    close(fd);
}

TEST_WITH(the_later_load_is_flown_and_the_other_when_it_is_damaged, set_up, NULL)
{
    const char *trouble;
    fill(config.slot_a, config.slot_b, 0);
    assert_int_equal(flown(&trouble), 0);
    fill(config.slot_b, config.slot_a, 1);
    assert_int_equal(flown(&trouble), 1);
    assert_null(trouble);
    fill(config.slot_a, config.slot_b, 2);
    assert_int_equal(flown(&trouble), 2);
    spoil(config.slot_a, 100); /* its header */
    assert_int_equal(flown(&trouble), 1);
    assert_string_equal(trouble, "slot A is damaged");
    spoil(config.slot_b, (off_t)images[1].directory_offset);
    assert_int_equal(flown(&trouble), -1);
    assert_string_equal(trouble, "both slots are damaged");
}

TEST_WITH(the_file_is_flown_where_no_slot_is_whole, set_up, NULL)
{
    const char *trouble;
    assert_int_equal(flown(&trouble), -1);
    assert_int_equal(tiny_image_write(&images[2], config.database), 0);
    assert_int_equal(flown(&trouble), 2);
    assert_null(trouble);
    fill(config.slot_b, config.slot_a, 0);
    assert_int_equal(flown(&trouble), 0);
    config.slot_a[0] = config.slot_b[0] = '\0';
    assert_int_equal(flown(&trouble), 2);
}

TEST_WITH(a_slot_whose_load_was_cut_off_is_not_flown, set_up, NULL)
{
    const char *trouble;
    struct slot s;
    fill(config.slot_a, config.slot_b, 0);
    fill(config.slot_b, config.slot_a, 1);
    assert_int_equal(slot_open(&s, config.slot_b, SLOT_TO_WRITE), 0);
    slot_judge(&s, SLOT_TABLES, NULL, NULL);
    struct lm_slot_record record = s.record;
    record.state = LM_SLOT_LOADING;
    assert_int_equal(slot_write_record(&s, record), 0);
    slot_close(&s);
    assert_int_equal(flown(&trouble), 0);
    assert_null(trouble);
}

TEST_WITH(what_is_flown_cannot_be_written_and_what_is_written_is_not_flown, set_up, NULL)
{
    const char *trouble;
    struct storage d = {.path = NULL};
    struct database verdict;
    struct slot s;
    fill(config.slot_a, config.slot_b, 0);
    fill(config.slot_b, config.slot_a, 1);
    assert_int_equal(image_of(storage_open(&d, &config, false, &verdict)), 1);
    assert_int_equal(slot_open(&s, config.slot_b, SLOT_TO_WRITE), 0);
    assert_true(slot_is_in_use(&s));
    assert_int_not_equal(slot_lock_to_write(&s), 0);
    storage_close(&d);
    assert_int_equal(slot_lock_to_write(&s), 0);
    assert_int_equal(flown(&trouble), 0);
    slot_close(&s);
    assert_int_equal(flown(&trouble), 1);
}
