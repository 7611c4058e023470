/* Settings in a file: those of the last second, or those of before; never half of them. */
#include "check.h"
#include "settings_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static char folder[] = "/tmp/settings-XXXXXX", path[64];

static void make_folder(void)
{
    strcpy(folder + sizeof folder - 7, "XXXXXX");
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/settings", folder);
}

static void remove_folder(void)
{
    (void)remove(path);
    assert_int_equal(rmdir(folder), 0); /* nothing else was left */
}

static void rest(void)
{
    const struct timespec fifth = {.tv_nsec = 200000000};
    (void)nanosleep(&fifth, NULL);
}

/* Keep a unit's settings for some seconds of its clock. */
static void keep(struct settings_file *f, const struct lm_unit *u, uint32_t seconds)
{
    settings_file_start(f);
    for (uint32_t i = 0; i < seconds; i++) {
        settings_file_keep(f, u, (uint64_t)i * SETTINGS_KEPT_US);
        rest();
    }
    settings_file_close(f);
}

TEST(what_was_kept_is_read_again)
{
    static struct settings_file f;
    struct lm_unit *u = calloc(1, sizeof *u);
    assert_non_null(u);
    make_folder();
    assert_null(settings_file_read(&f, path));
    u->page.mode = 2;
    u->page.gain_db = -9;
    keep(&f, u, 3);
    assert_int_equal(f.written, 1); /* only what differs */
    const struct lm_settings *s = settings_file_read(&f, path);
    assert_non_null(s);
    assert_int_equal(s->page[2], 2);
    assert_int_equal((int8_t)s->page[14], -9);
    keep(&f, u, 2);
    assert_int_equal(f.written, 0);
    remove_folder();
    free(u);
}

TEST(a_file_that_is_damaged_cut_or_longer_is_not_read)
{
    static struct settings_file f;
    struct lm_unit *u = calloc(1, sizeof *u);
    uint8_t bytes[SETTINGS_FILE_BYTES + 1] = {0};
    assert_non_null(u);
    make_folder();
    (void)settings_file_read(&f, path);
    u->page.mode = 1;
    keep(&f, u, 1);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fread(bytes, 1, sizeof bytes, file), SETTINGS_FILE_BYTES);
    fclose(file);
    for (size_t i = 0; i < SETTINGS_FILE_BYTES + 2; i++) {
        const size_t length = i < SETTINGS_FILE_BYTES    ? SETTINGS_FILE_BYTES
                              : i == SETTINGS_FILE_BYTES ? i - 1
                                                         : i;
        bytes[i % SETTINGS_FILE_BYTES] ^= i < SETTINGS_FILE_BYTES ? 1 : 0;
        file = fopen(path, "wb");
        assert_non_null(file);
        assert_int_equal(fwrite(bytes, 1, length, file), length);
        fclose(file);
        assert_null(settings_file_read(&f, path));
        bytes[i % SETTINGS_FILE_BYTES] ^= i < SETTINGS_FILE_BYTES ? 1 : 0;
    }
    remove_folder();
    free(u);
}

TEST(a_folder_that_is_not_there_does_not_stop_the_panel)
{
    static struct settings_file f;
    struct lm_unit *u = calloc(1, sizeof *u);
    assert_non_null(u);
    assert_null(settings_file_read(&f, "/nowhere/settings"));
    keep(&f, u, 2);
    assert_int_equal(f.written, 0);
    assert_null(settings_file_read(&f, ""));
    settings_file_start(&f);
    assert_false(f.writer.has_thread);
    free(u);
}
