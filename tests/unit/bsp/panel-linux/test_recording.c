/* The panel's recording: what it keeps, what it removes, and that it never stops the flight. */
#include "check.h"
#include "fx/crc32c.h"
#include "recording.h"
#include "shown.h"
#include "support.h"
#include "unit_rig.h"

#include <dirent.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* Small, so that parts end within seconds. */
static const struct recording_limits small = {.bytes = 4 << 20,
                                              .free_bytes = 1 << 20,
                                              .part_bytes = 16 << 10,
                                              .ring_bytes = 1 << 19,
                                              .check_every = 10};

/* The rig's unit, recorded as the panel does it. */
struct flight {
    struct rig *rig;
    struct lm_board board; /* the unit's */
    struct recording recording;
    struct shown shown;
    char folder[100];
};

static void path_of(const struct flight *f, char *path, size_t size, const char *name)
{
    snprintf(path, size, "%s/%s", f->folder, name);
}

static struct flight *prepare(const char *name)
{
    struct flight *f = calloc(1, sizeof *f);
    f->rig = make_rig();
    f->board = f->rig->board.lent;
    snprintf(f->folder, sizeof f->folder, "%s/tmp/recording-%s", support_build_dir(), name);
    support_run("rm -rf %s && mkdir -p %s/tmp", f->folder, support_build_dir());
    return f;
}

static void take_off(struct flight *f, const struct recording_limits *limits)
{
    recording_open(&f->recording, f->folder, limits);
    recording_begin(&f->recording, &f->board, 0);
    assert_int_equal(lm_unit_init(&f->rig->unit, &f->board), LM_OK);
    recording_start(&f->recording, NULL);
}

/* Fly as fast as it goes, with a rest for the thread now and then. */
static void fly(struct flight *f, double seconds)
{
    struct rig *r = f->rig;
    const struct timespec rest = {.tv_nsec = 5000000};
    const uint64_t until = r->now_us + (uint64_t)(seconds * 1e6);
    for (; r->now_us < until; r->now_us += STEP_US) {
        const uint32_t before = r->board.presented;
        r->bus.now_us = r->now_us;
        recording_step(&f->recording, r->now_us);
        lm_unit_step(&r->unit, r->now_us);
        if (r->board.presented != before) {
            shown_note(&f->shown, r->glass, WIDTH * HEIGHT);
        }
        if (r->now_us % 100000 == 0) {
            nanosleep(&rest, NULL);
        }
    }
}

/* Modes, keys and a patch. */
static void fly_about(struct flight *f)
{
    command(f->rig, range_10);
    fly(f, 2);
    command(f->rig, lm_control_button(true, 3));
    command(f->rig, lm_control_button(false, 3));
    command(f->rig, lm_control_slew(LM_FULL_DEFLECTION / 2, 0));
    fly(f, 2);
    command(f->rig, patch_here);
    fly(f, 3);
}

static void land(struct flight *f)
{
    recording_close(&f->recording);
    support_run("rm -rf %s", f->folder);
    free_rig(f->rig);
    free(f);
}

static struct shown_again again(const struct flight *f, const char *name)
{
    char path[200];
    path_of(f, path, sizeof path, name);
    return show_again(path, &f->rig->board.flash.port, &lm_radar_default, &f->shown);
}

static uint32_t files(const struct flight *f, const char *begins)
{
    uint32_t count = 0;
    DIR *folder = opendir(f->folder);
    assert_non_null(folder);
    for (const struct dirent *e; (e = readdir(folder)) != NULL;) {
        count += strncmp(e->d_name, begins, strlen(begins)) == 0;
    }
    closedir(folder);
    return count;
}

/* A file of a session that was flown before. */
static void put_file(const struct flight *f, const char *name, size_t bytes)
{
    char path[200];
    path_of(f, path, sizeof path, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(truncate(path, (off_t)bytes), 0);
}

/* Beyond what the test waits for: the thread is done with what was put in. */
static void wait_for_thread(struct flight *f)
{
    const struct timespec rest = {.tv_nsec = 10000000};
    for (int i = 0; i < 500 && byte_ring_room(&f->recording.ring) < f->recording.ring.size &&
                    !atomic_load(&f->recording.files.is_broken);
         i++) {
        nanosleep(&rest, NULL);
    }
}

TEST(a_flight_of_many_parts_is_shown_again_bit_for_bit)
{
    struct flight *f = prepare("parts");
    take_off(f, &small);
    fly_about(f);
    recording_close(&f->recording);
    assert_null(f->recording.trouble);
    assert_true(files(f, "flight-00001-") >= 3);
    const struct shown_again a = again(f, "flight-00001-000.log");
    assert_string_equal(a.error, "");
    assert_true(f->shown.count > 200);
    assert_int_equal(a.pictures, f->shown.count);
    assert_int_equal(a.wrong, 0);
    assert_true(a.has_ended);
    assert_int_equal(a.departures + a.checks_failed, 0);
    assert_true(a.checks > 15);
    land(f);
}

TEST(the_link_names_the_part_that_grows)
{
    struct flight *f = prepare("link");
    char path[200], name[100] = {0}, part[64];
    const mode_t before = umask(0077); /* as the service has it */
    take_off(f, &small);
    fly_about(f);
    wait_for_thread(f);
    path_of(f, path, sizeof path, "current.log");
    assert_true(readlink(path, name, sizeof name - 1) > 0);
    snprintf(part, sizeof part, "flight-00001-%03u.log", f->recording.part);
    assert_string_equal(name, part);
    assert_true(f->recording.part >= 2);
    struct stat about;
    assert_int_equal(stat(path, &about), 0);
    assert_int_equal(about.st_mode & 07777, 0640); /* the panel's group may read it */
    assert_int_equal(stat(f->folder, &about), 0);
    assert_int_equal(about.st_mode & 07777, 0750);
    umask(before);
    land(f);
}

/* As after a power cut: what is in the files now, less some bytes of the last line. */
TEST(what_was_written_before_a_power_cut_is_shown)
{
    struct flight *f = prepare("cut");
    take_off(f, &small);
    fly_about(f);
    wait_for_thread(f);
    const uint32_t flown = f->shown.count;
    support_run(
        "cd %s && for p in flight-00001-*; do cp $p flight-00009-${p##*-}; done && "
        "truncate -s -5 $(ls flight-00009-* | tail -1)",
        f->folder);
    struct shown_again a = again(f, "flight-00009-000.log");
    assert_string_equal(a.error, "");
    assert_in_range(a.pictures, flown - 2, flown);
    assert_int_equal(a.wrong + a.checks_failed + a.departures, 0);
    assert_false(a.has_ended);
    assert_int_equal(a.torn, 1);
    /* A file system may have made the file longer than what it had written. */
    support_run("cd %s && truncate -s +4096 $(ls flight-00009-* | tail -1)", f->folder);
    a = again(f, "flight-00009-000.log");
    assert_in_range(a.pictures, flown - 2, flown);
    assert_int_equal(a.wrong + a.departures, 0);
    land(f);
}

TEST(the_oldest_sessions_go_as_a_whole_when_the_limit_is_reached)
{
    struct flight *f = prepare("oldest");
    struct recording_limits limits = small;
    limits.bytes = 160 << 10;
    support_run("mkdir %s", f->folder);
    put_file(f, "flight-00007-000.log", 25 << 10);
    put_file(f, "flight-00007-001.log", 25 << 10);
    put_file(f, "flight-00008-000.log", 25 << 10);
    put_file(f, "flight-00012-000.log", 25 << 10);
    put_file(f, "flight-00012-0000.log", 1 << 20); /* none of ours */
    put_file(f, "notes.txt", 1 << 20);
    take_off(f, &limits);
    assert_int_equal(f->recording.files.session, 13);
    assert_int_equal(files(f, "flight-00007-"), 2);
    fly_about(f);
    wait_for_thread(f);
    assert_true(f->recording.part >= 3);
    assert_int_equal(files(f, "flight-00007-"), 0);
    assert_int_equal(files(f, "flight-00008-"), 0);
    assert_int_equal(files(f, "flight-00012-"), 2); /* one of them is none of ours */
    assert_int_equal(files(f, "flight-00013-"), f->recording.part + 1);
    assert_int_equal(files(f, "notes.txt"), 1);
    recording_close(&f->recording);
    assert_int_equal(again(f, "flight-00013-000.log").wrong, 0);
    land(f);
}

/* A panel that restarts for ever would fill the folder with small files, and be slow to start. */
TEST(sessions_that_are_many_and_short_are_removed_too)
{
    struct flight *f = prepare("many");
    support_run("mkdir %s && cd %s && seq -f flight-%%05g-000.log 1 %d | xargs touch", f->folder,
                f->folder, RECORDING_FILES_MAX + 20);
    take_off(f, &small);
    assert_null(f->recording.trouble);
    assert_int_equal(f->recording.files.session, RECORDING_FILES_MAX + 21);
    assert_in_range(files(f, "flight-"), RECORDING_FILES_MAX - 2, RECORDING_FILES_MAX);
    land(f);
}

/* Whichever of the two limits it is. */
TEST(a_session_that_alone_fills_the_room_ends_with_a_word)
{
    for (int is_disk = 0; is_disk < 2; is_disk++) {
        struct flight *f = prepare("full");
        struct recording_limits limits = small;
        take_off(f, &limits);
        if (is_disk) {
            f->recording.files.limits.free_bytes = UINT64_MAX / 2;
        } else {
            f->recording.files.limits.bytes = 50 << 10;
        }
        fly_about(f);
        fly(f, 2);
        assert_non_null(f->recording.trouble);
        assert_string_equal(f->recording.trouble, "recording ended: full");
        const uint32_t flown = f->shown.count;
        recording_close(&f->recording);
        const struct shown_again a = again(f, "flight-00001-000.log");
        assert_true(a.has_ended);
        assert_int_equal(a.ceased, RECORD_FULL);
        assert_in_range(a.pictures, 30, flown - 30);
        assert_int_equal(a.wrong + a.departures + a.checks_failed, 0);
        land(f);
    }
}

/* The thread never runs: the ring must overflow. */
TEST(a_ring_that_overflows_is_said_and_counted_and_the_unit_flies_on)
{
    struct flight *f = prepare("behind");
    struct recording_limits limits = small;
    limits.ring_bytes = 1 << 13;
    recording_open(&f->recording, f->folder, &limits);
    recording_begin(&f->recording, &f->board, 0);
    assert_int_equal(lm_unit_init(&f->rig->unit, &f->board), LM_OK);
    fly(f, 2);
    assert_true(f->recording.is_behind);
    const uint32_t lost = f->recording.count.lines_lost;
    assert_true(lost > 100);
    recording_start(&f->recording, NULL); /* now it does */
    fly(f, 2);
    assert_string_equal(f->recording.trouble, "recording ended: storage too slow");
    assert_true(f->recording.count.lines_lost >= lost);
    assert_in_range(f->shown.count, 118, 121);
    recording_close(&f->recording);
    const struct shown_again a = again(f, "flight-00001-000.log");
    assert_int_equal(a.ceased, RECORD_BEHIND);
    assert_false(a.has_ended);
    assert_string_equal(a.error, "");
    assert_in_range(a.pictures, 10, 59);
    assert_int_equal(a.wrong + a.departures, 0);
    land(f);
}

TEST(after_a_line_that_was_lost_none_is_taken_though_there_is_room)
{
    struct flight *f = prepare("gap");
    struct recording_limits limits = small;
    const uint8_t *bytes;
    limits.ring_bytes = 1 << 13;
    recording_open(&f->recording, f->folder, &limits);
    recording_begin(&f->recording, &f->board, 0);
    assert_int_equal(lm_unit_init(&f->rig->unit, &f->board), LM_OK);
    fly(f, 2);
    assert_true(byte_ring_peek(&f->recording.ring, &bytes) > 200);
    byte_ring_drop(&f->recording.ring, 200); /* too little for the word that ends it */
    const size_t head = f->recording.ring.head;
    const uint32_t lost = f->recording.count.lines_lost;
    fly(f, 0.5);
    assert_int_equal(f->recording.ring.head, head);
    assert_true(f->recording.count.lines_lost > lost + 20);
    land(f);
}

TEST(a_medium_that_takes_no_more_is_said_and_the_unit_flies_on)
{
    struct rlimit before, less;
    struct flight *f = prepare("broken");
    take_off(f, &small);
    fly(f, 1);
    wait_for_thread(f);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    less = before;
    less.rlim_cur = 14 << 10;
    void (*const old)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &less), 0);
    fly(f, 3);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    signal(SIGXFSZ, old);
    wait_for_thread(f);
    fly(f, 0.1);
    assert_string_equal(f->recording.trouble, "recording ended: storage failed");
    assert_in_range(f->shown.count, 122, 125);
    recording_close(&f->recording);
    const struct shown_again a = again(f, "flight-00001-000.log");
    assert_int_equal(a.wrong + a.departures, 0);
    assert_true(a.pictures > 20);
    land(f);
}

TEST(a_folder_that_cannot_be_used_is_said_and_the_unit_flies_on)
{
    struct flight *f = prepare("folder");
    char path[200];
    snprintf(path, sizeof path, "%s/no/parent", f->folder);
    recording_open(&f->recording, path, &small);
    assert_non_null(f->recording.trouble);
    recording_begin(&f->recording, &f->board, 0);
    assert_int_equal(lm_unit_init(&f->rig->unit, &f->board), LM_OK);
    recording_start(&f->recording, NULL);
    fly(f, 1);
    assert_in_range(f->shown.count, 29, 31);
    land(f);

    f = prepare("file");
    support_run("touch %s", f->folder); /* a file in its place */
    recording_open(&f->recording, f->folder, &small);
    assert_non_null(f->recording.trouble);
    assert_false(f->recording.is_on);
    land(f);
}

/* A database that needs more tiles makes the panel start its unit twice. */
TEST(a_unit_that_is_started_again_begins_the_recording_again)
{
    struct flight *f = prepare("again");
    recording_open(&f->recording, f->folder, &small);
    recording_begin(&f->recording, &f->board, 0);
    assert_int_equal(lm_unit_init(&f->rig->unit, &f->board), LM_OK);
    recording_begin(&f->recording, &f->board, 0);
    assert_int_equal(lm_unit_init(&f->rig->unit, &f->board), LM_OK);
    f->board.restart = "WATCHDOG";
    recording_start(&f->recording, f->board.restart);
    command(f->rig, lm_control_button(true, 12)); /* the BIT page names the restart */
    command(f->rig, lm_control_button(false, 12));
    fly(f, 1);
    assert_true(says(f->rig, "WATCHDOG"));
    recording_close(&f->recording);
    const struct shown_again a = again(f, "flight-00001-000.log");
    assert_string_equal(a.error, "");
    assert_int_equal(a.wrong, 0);
    assert_int_equal(a.departures + a.checks_failed, 0);
    assert_int_equal(a.pictures, f->shown.count);
    assert_true(a.has_ended);
    land(f);
}

TEST(the_ring_of_bytes_takes_all_or_nothing_around_its_end)
{
    uint8_t memory[16];
    struct byte_ring ring = {.bytes = memory, .size = sizeof memory};
    uint8_t put = 0, got = 0;
    for (uint32_t i = 0; i < 1000; i++) {
        const uint8_t count = (uint8_t)(i % 11);
        uint8_t bytes[11];
        for (uint8_t k = 0; k < count; k++) {
            bytes[k] = (uint8_t)(put + k);
        }
        const size_t room = byte_ring_room(&ring);
        const bool is_in = byte_ring_put(&ring, bytes, count);
        assert_int_equal(is_in, count <= room);
        put = (uint8_t)(put + (is_in ? count : 0));
        const uint8_t *side;
        size_t there = byte_ring_peek(&ring, &side);
        there = there > 5 ? 5 : there;
        for (size_t k = 0; k < there; k++) {
            assert_int_equal(side[k], got++);
        }
        byte_ring_drop(&ring, there);
    }
}
