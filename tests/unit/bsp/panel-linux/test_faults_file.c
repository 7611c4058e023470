/* The last faults in a file: kept in order, read again, and never half a file. */
#include "check.h"
#include "faults_file.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static char folder[] = "/tmp/faults-XXXXXX", path[64], text[FAULTS_BYTES + 1];
static struct faults_file f;
static struct lm_fault_log faults;

static int make_folder(void **state)
{
    (void)state;
    strcpy(folder + sizeof folder - 7, "XXXXXX");
    memset(&faults, 0, sizeof faults);
    return mkdtemp(folder) == NULL || snprintf(path, sizeof path, "%s/faults", folder) < 0;
}

static int remove_folder(void **state)
{
    (void)state;
    (void)remove(path);
    return rmdir(folder); /* nothing else was left */
}

/* The file's text. */
static const char *kept(void)
{
    FILE *file = fopen(path, "rb");
    const size_t size = file != NULL ? fread(text, 1, sizeof text - 1, file) : 0;
    if (file != NULL) {
        fclose(file);
    }
    text[size] = '\0';
    return text;
}

static void leave(const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

static int lines(void)
{
    int count = 0;
    for (const char *at = kept(); (at = strchr(at, '\n')) != NULL; at++) {
        count++;
    }
    return count;
}

static void rise(uint32_t flags, uint64_t now_us)
{
    lm_fault_log_add(&faults, flags, now_us);
    faults_file_keep(&f, &faults, now_us);
}

TEST_WITH(faults_are_kept_in_their_order_and_found_again, make_folder, remove_folder)
{
    faults_file_start(&f, path);
    rise(LM_FLAG_BUS, 2000000);
    faults_file_close(&f);
    assert_int_equal(lines(), 1);
    assert_non_null(strstr(kept(), " +2 s BUS\n"));
    memset(&faults, 0, sizeof faults); /* the power was cut: another run */
    faults_file_start(&f, path);
    rise(LM_FLAG_DB, 5000000);
    faults_file_close(&f);
    const char *first = strstr(kept(), " +2 s BUS\n"), *second = strstr(text, " +5 s DB FAIL\n");
    assert_true(first != NULL && second != NULL && first < second);
    assert_int_equal(lines(), 2);
}

TEST_WITH(the_oldest_goes_where_there_is_no_room, make_folder, remove_folder)
{
    const struct timespec rest = {.tv_nsec = 250000000};
    faults_file_start(&f, path);
    for (uint64_t i = 0; i < 10; i++) {
        rise(LM_FLAG_BUS | LM_FLAG_DB | LM_FLAG_NAV_STALE | LM_FLAG_TILE, i * 1000000);
        (void)nanosleep(&rest, NULL);
    }
    faults_file_close(&f);
    assert_int_equal(lines(), FAULTS_LINES);
    assert_null(strstr(text, " +1 s "));
    assert_non_null(strstr(text, " +2 s "));
    assert_non_null(strstr(text, " +9 s "));
}

TEST_WITH(what_is_no_list_of_faults_is_begun_anew, make_folder, remove_folder)
{
    static const char *const none[] = {"no end of a line", "\x01\x02\n", "\xff\n"};
    static char large[FAULTS_BYTES + 64];
    for (uint32_t i = 0; i < 3; i++) {
        leave(none[i], strlen(none[i]));
        faults_file_start(&f, path);
        assert_int_equal(f.size, 0);
        faults_file_close(&f);
    }
    memset(large, '\n', sizeof large); /* too many lines, and too large */
    for (size_t size = FAULTS_LINES + 1; size <= sizeof large;
         size += sizeof large - FAULTS_LINES - 1) {
        leave(large, size);
        faults_file_start(&f, path);
        assert_int_equal(f.size, 0);
        faults_file_close(&f);
    }
    memset(large, 'x', 100);
    leave(large, 101); /* a line that is too long */
    faults_file_start(&f, path);
    rise(LM_FLAG_BUS, 0);
    faults_file_close(&f);
    assert_int_equal(lines(), 1);
}

TEST(a_folder_that_is_not_there_does_not_stop_the_panel)
{
    faults_file_start(&f, "/nowhere/faults");
    rise(LM_FLAG_BUS, 0);
    faults_file_close(&f);
    assert_true(f.is_failing);
    faults_file_start(&f, "");
    assert_false(f.writer.has_thread);
}
