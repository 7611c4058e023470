/* What ended the panel before: systemd's words in a file, and nothing else. */
#include "check.h"
#include "ended.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[] = "/tmp/ended-XXXXXX", path[64];

static void leave(const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

static const char *cause_of(const char *text)
{
    leave(text, strlen(text));
    return ended_cause();
}

static void make_folder(void)
{
    strcpy(folder + sizeof folder - 7, "XXXXXX");
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/" ENDED_FILE, folder);
    assert_int_equal(setenv("RUNTIME_DIRECTORY", folder, 1), 0);
}

static void remove_folder(void)
{
    (void)remove(path);
    assert_int_equal(rmdir(folder), 0);
    assert_int_equal(unsetenv("RUNTIME_DIRECTORY"), 0);
}

TEST(each_bad_end_has_its_word)
{
    make_folder();
    assert_string_equal(cause_of("watchdog\n"), "WATCHDOG");
    assert_string_equal(cause_of("core-dump\n"), "CRASH");
    assert_string_equal(cause_of("signal\n"), "CRASH");
    assert_string_equal(cause_of("exit-code\n"), "FAILED");
    assert_string_equal(cause_of("timeout\n"), "TIME-OUT");
    assert_string_equal(cause_of("oom-kill"), "OUT OF MEMORY");
    remove_folder();
}

TEST(an_end_that_was_meant_is_none)
{
    make_folder();
    assert_null(cause_of("success\n"));
    (void)remove(path);
    assert_null(ended_cause());
    remove_folder();
    assert_null(ended_cause());
}

TEST(what_systemd_never_wrote_is_no_cause)
{
    uint8_t noise[4096];
    memset(noise, 'w', sizeof noise);
    make_folder();
    assert_null(cause_of(""));
    assert_null(cause_of("\n"));
    assert_null(cause_of("watchdogs\n"));
    assert_null(cause_of("WATCHDOG\n"));
    leave(noise, sizeof noise);
    assert_null(ended_cause());
    memset(noise, 0, sizeof noise);
    leave(noise, sizeof noise);
    assert_null(ended_cause());
    remove_folder();
}

TEST(a_folder_whose_name_is_too_long_is_not_read)
{
    char name[300];
    memset(name, 'x', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    assert_int_equal(setenv("RUNTIME_DIRECTORY", name, 1), 0);
    assert_null(ended_cause());
    assert_int_equal(unsetenv("RUNTIME_DIRECTORY"), 0);
}
