/* How far a load is, from a loader to a panel: what a panel believes of a loader that lives, that
 * has ended, and that was killed; and of a file that is none of theirs. */
#include "check.h"
#include "slots/progress.h"
#include "support.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static char path[200];

static int set_up(void **state)
{
    (void)state;
    support_run("mkdir -p %s/tmp", support_build_dir());
    snprintf(path, sizeof path, "%s/tmp/load-progress", support_build_dir());
    unlink(path);
    return 0;
}

static uint64_t now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000u + (uint64_t)t.tv_nsec / 1000000u;
}

static struct lm_slots_state seen_since(uint64_t since_ms)
{
    struct lm_slots_state s = {.flown = 2, .load = LM_LOAD_FAILED, .percent = 99};
    assert_true(slot_progress_read(path, since_ms, &s));
    assert_int_equal(s.flown, 2);
    return s;
}

static void assert_seen(enum lm_load load, int32_t percent)
{
    const struct lm_slots_state s = seen_since(0);
    assert_int_equal(s.load, load);
    assert_int_equal(s.percent, percent);
}

TEST_WITH(a_panel_sees_how_far_a_load_is_and_how_it_ended, set_up, NULL)
{
    struct slot_teller t;
    assert_seen(LM_LOAD_NONE, 0);
    slot_teller_open(&t, path);
    assert_seen(LM_LOAD_RUNS, 0);
    for (int32_t percent = 1; percent <= 100; percent++) {
        slot_teller_run(&t, percent);
        assert_seen(LM_LOAD_RUNS, percent);
    }
    slot_teller_run(&t, 101);
    assert_seen(LM_LOAD_RUNS, 100);
    slot_teller_end(&t, LM_LOAD_DONE);
    assert_seen(LM_LOAD_DONE, 100);
    slot_teller_open(&t, path);
    slot_teller_run(&t, 7);
    slot_teller_end(&t, LM_LOAD_FAILED);
    assert_seen(LM_LOAD_FAILED, 7);
}

/* A panel that has started since flies what was loaded, or knows from the slot that it was cut. */
TEST_WITH(what_ended_before_the_panel_started_is_not_shown, set_up, NULL)
{
    struct slot_teller t;
    slot_teller_open(&t, path);
    assert_int_equal(seen_since(now_ms() + 1000).load, LM_LOAD_RUNS); /* it lives */
    slot_teller_end(&t, LM_LOAD_DONE);
    assert_int_equal(seen_since(now_ms() + 1000).load, LM_LOAD_NONE);
    assert_int_equal(seen_since(now_ms() - 1000).load, LM_LOAD_DONE);
}

TEST_WITH(a_loader_that_was_killed_does_not_run_for_ever, set_up, NULL)
{
    int ready[2];
    assert_int_equal(pipe(ready), 0);
    const pid_t child = fork();
    if (child == 0) {
        struct slot_teller t;
        slot_teller_open(&t, path);
        slot_teller_run(&t, 42);
        (void)!write(ready[1], "x", 1);
        pause();
        _exit(0);
    }
    char byte;
    assert_int_equal(read(ready[0], &byte, 1), 1);
    assert_seen(LM_LOAD_RUNS, 42);
    struct slot_teller second;
    slot_teller_open(&second, path); /* tells nobody */
    slot_teller_run(&second, 3);
    slot_teller_end(&second, LM_LOAD_DONE);
    assert_seen(LM_LOAD_RUNS, 42);
    kill(child, SIGKILL);
    assert_int_equal(waitpid(child, NULL, 0), child);
    assert_seen(LM_LOAD_FAILED, 42);
    assert_int_equal(seen_since(now_ms() + 1000).load, LM_LOAD_NONE);
    close(ready[0]);
    close(ready[1]);
}

TEST_WITH(without_its_folder_nobody_is_told, set_up, NULL)
{
    struct slot_teller t;
    char nowhere[220];
    snprintf(nowhere, sizeof nowhere, "%s.folder/load", path);
    slot_teller_open(&t, nowhere);
    slot_teller_run(&t, 50);
    slot_teller_end(&t, LM_LOAD_DONE);
    slot_teller_open(&t, "");
    slot_teller_end(&t, LM_LOAD_DONE);
    assert_int_not_equal(access(nowhere, F_OK), 0);
}

static bool is_understood(const char *text, size_t length)
{
    struct lm_slots_state s = {.flown = 1, .load = LM_LOAD_RUNS, .percent = 5};
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    assert_int_equal(fwrite(text, 1, length, f), length);
    fclose(f);
    const bool is_told = slot_progress_read(path, 0, &s);
    assert_true(is_told || (s.load == LM_LOAD_RUNS && s.percent == 5 && s.flown == 1));
    return is_told;
}

TEST_WITH(every_other_line_changes_nothing, set_up, NULL)
{
    static const char line[] = "LMLOAD done 099 0000000000123456\n";
    char changed[sizeof line];
    const size_t length = strlen(line);
    for (size_t n = 0; n < length; n++) {
        assert_false(is_understood(line, n));
    }
    for (size_t at = 0; at < length; at++) {
        memcpy(changed, line, sizeof line);
        changed[at] = '#';
        assert_false(is_understood(changed, length));
    }
    assert_false(is_understood("LMLOAD done 101 0000000000123456\n", length));
    assert_false(is_understood("LMLOAD none 001 0000000000123456\n", length));
    assert_true(is_understood(line, length));
}

/* A link could lead anywhere, and a pipe would wait for ever. */
TEST_WITH(links_pipes_and_folders_are_neither_read_nor_written, set_up, NULL)
{
    struct slot_teller t;
    struct lm_slots_state s = {.load = LM_LOAD_RUNS};
    char other[220];
    snprintf(other, sizeof other, "%s.other", path);
    unlink(other);
    assert_int_equal(symlink(other, path), 0);
    slot_teller_open(&t, path);
    slot_teller_end(&t, LM_LOAD_DONE);
    assert_int_not_equal(access(other, F_OK), 0);
    assert_false(slot_progress_read(path, 0, &s));
    unlink(path);
    assert_int_equal(mkfifo(path, 0600), 0);
    slot_teller_open(&t, path);
    slot_teller_end(&t, LM_LOAD_DONE);
    assert_false(slot_progress_read(path, 0, &s));
    unlink(path);
    assert_int_equal(mkdir(path, 0700), 0);
    slot_teller_open(&t, path);
    slot_teller_end(&t, LM_LOAD_DONE);
    assert_false(slot_progress_read(path, 0, &s));
    rmdir(path);
}
