/* What every host program leans on: files that appear whole, and numbers that repeat. */
#include "check.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

TEST(an_aborted_file_leaves_nothing_and_keeps_the_old_one)
{
    char path[] = "/tmp/landmass-test-XXXXXX";
    const int fd = mkstemp(path);
    assert_true(write(fd, "old", 3) == 3);
    close(fd);
    struct hs_atomic_file f;
    assert_int_equal(hs_atomic_open(&f, path), 0);
    fputs("half of the ne", f.stream);
    char *temporary = hs_atomic_temporary_name(path);
    hs_atomic_abort(&f);
    assert_int_equal(access(temporary, F_OK), -1);
    FILE *old = fopen(path, "r");
    char text[8] = "";
    assert_non_null(fgets(text, sizeof text, old));
    assert_string_equal(text, "old");
    fclose(old);
    assert_int_equal(hs_atomic_open(&f, path), 0);
    fputs("new", f.stream);
    assert_int_equal(hs_atomic_commit(&f), 0);
    assert_int_equal(access(temporary, F_OK), -1);
    old = fopen(path, "r");
    assert_non_null(fgets(text, sizeof text, old));
    assert_string_equal(text, "new");
    fclose(old);
    free(temporary);
    unlink(path);
}

TEST(a_full_disk_is_an_error_and_leaves_no_file)
{
    if (access("/dev/full", W_OK) != 0) {
        print_message("# skipped: no /dev/full here\n");
        skip();
    }
    struct hs_atomic_file f = {fopen("/dev/full", "wb"), strdup("/tmp/landmass-never"),
                               strdup("/tmp/landmass-never.tmp")};
    fputs("anything", f.stream);
    assert_int_equal(hs_atomic_commit(&f), -1);
    assert_int_equal(access("/tmp/landmass-never", F_OK), -1);
}

TEST(a_device_is_refused_not_replaced)
{
    struct hs_atomic_file f;
    assert_int_equal(hs_atomic_open(&f, "/dev/null"), -1);
    char temporary[] = "/tmp/landmass-test-XXXXXX";
    close(mkstemp(temporary));
    assert_int_equal(hs_atomic_rename(temporary, "/tmp"), -1);
    assert_int_equal(access(temporary, F_OK), -1);
    hs_atomic_abort(&f);
}

TEST(normal_numbers_have_mean_zero_and_variance_one)
{
    struct hs_rng r;
    hs_rng_seed(&r, 7);
    double sum = 0, squares = 0;
    const int n = 200000;
    for (int i = 0; i < n; i++) {
        const double x = hs_rng_normal(&r);
        sum += x;
        squares += x * x;
    }
    assert_true(fabs(sum / n) < 0.01);
    assert_true(fabs(squares / n - 1) < 0.02);
}

TEST(numbers_below_a_bound_are_even)
{
    struct hs_rng r;
    hs_rng_seed(&r, 9);
    int count[3] = {0};
    for (int i = 0; i < 30000; i++) {
        count[hs_rng_below(&r, 3)]++;
    }
    for (int i = 0; i < 3; i++) {
        assert_in_range(count[i], 9700, 10300);
    }
}

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

/* A folder with "input" and "link" to it; the current folder is it until `leave`. */
static void enter(char *folder)
{
    hs_input_guard();
    assert_non_null(mkdtemp(folder));
    assert_int_equal(chdir(folder), 0);
    write_file("input", "input");
    assert_int_equal(symlink("input", "link"), 0);
    assert_int_equal(link("input", "hard"), 0);
}

static void leave(const char *folder)
{
    const char *const names[] = {"input", "link", "hard", "output"};
    for (int i = 0; i < 4; i++) {
        unlink(names[i]);
    }
    assert_int_equal(chdir("/"), 0);
    assert_int_equal(rmdir(folder), 0); /* nothing else was left in it */
}

TEST(an_input_is_no_place_for_an_output_whatever_its_name)
{
    char folder[] = "/tmp/landmass-test-XXXXXX", absolute[64];
    enter(folder);
    snprintf(absolute, sizeof absolute, "%s/input", folder);
    fclose(hs_input_open("link", "r"));
    const char *const names[] = {"input", "link", "hard", "./input", absolute};
    for (int i = 0; i < 5; i++) {
        struct hs_atomic_file f;
        assert_int_equal(hs_output_claim(names[i]), -1);
        assert_int_equal(hs_atomic_open(&f, names[i]), -1);
        assert_null(hs_atomic_temporary_name(names[i]));
    }
    hs_input_forget("hard");
    struct hs_atomic_file f;
    assert_int_equal(hs_atomic_open(&f, "input"), 0);
    hs_atomic_abort(&f);
    leave(folder);
}

TEST(a_file_that_becomes_an_input_during_the_work_is_kept)
{
    char folder[] = "/tmp/landmass-test-XXXXXX";
    enter(folder);
    struct hs_atomic_file f;
    assert_int_equal(hs_atomic_open(&f, "input"), 0);
    hs_input_note("link");
    assert_int_equal(hs_atomic_commit(&f), -1);
    char text[8] = "";
    FILE *file = fopen("input", "r");
    assert_non_null(fgets(text, sizeof text, file));
    fclose(file);
    assert_string_equal(text, "input");
    hs_input_forget("input");
    leave(folder);
}

TEST(two_claims_of_one_file_are_refused_and_a_file_takes_its_claim_over)
{
    char folder[] = "/tmp/landmass-test-XXXXXX";
    enter(folder);
    struct hs_atomic_file f;
    assert_int_equal(hs_output_claim("output"), 0);
    assert_int_equal(hs_output_claim("./output"), -1);
    assert_int_equal(hs_atomic_open(&f, "output"), 0);
    assert_int_equal(hs_atomic_commit(&f), 0);
    assert_int_equal(access("output", F_OK), 0);
    leave(folder);
}

TEST(nothing_goes_into_a_folder_that_is_an_input)
{
    char folder[] = "/tmp/landmass-test-XXXXXX", output[64];
    enter(folder);
    snprintf(output, sizeof output, "%s/output", folder);
    hs_input_note_folder(folder);
    assert_int_equal(hs_output_claim(output), -1);
    assert_int_equal(hs_output_claim("output"), -1);
    hs_input_forget(folder);
    leave(folder);
}

static void write_output(const char *path, const char *text)
{
    struct hs_atomic_file f;
    assert_int_equal(hs_atomic_open(&f, path), 0);
    fputs(text, f.stream);
    assert_int_equal(hs_atomic_commit(&f), 0);
}

static void expect_text(const char *path, const char *wanted)
{
    char text[16] = "";
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_non_null(fgets(text, sizeof text, file));
    fclose(file);
    assert_string_equal(text, wanted);
}

TEST(files_that_belong_together_come_at_the_end_or_not_at_all)
{
    char folder[] = "/tmp/landmass-test-XXXXXX";
    enter(folder);
    for (int is_good = 0; is_good < 2; is_good++) {
        hs_outputs_together();
        write_output("output", "first");
        write_output("output", "output");
        write_output("hard", "new");
        hs_atomic_remove("link");
        assert_int_equal(access("output", F_OK), -1);
        assert_int_equal(access("link", F_OK), 0);
        assert_int_equal(hs_outputs_end(is_good), 0);
        assert_int_equal(access("output", F_OK), is_good - 1);
        assert_int_equal(access("link", F_OK), -is_good);
        expect_text("hard", is_good ? "new" : "input");
    }
    expect_text("output", "output");
    write_output("output", "alone"); /* the next one does not wait */
    expect_text("output", "alone");
    leave(folder);
}

TEST(a_file_that_became_an_input_keeps_all_of_them_away)
{
    char folder[] = "/tmp/landmass-test-XXXXXX";
    enter(folder);
    hs_outputs_together();
    write_output("output", "new");
    write_output("input", "new");
    hs_input_note("hard");
    assert_int_equal(hs_outputs_end(true), -1);
    assert_int_equal(access("output", F_OK), -1);
    expect_text("input", "input");
    hs_input_forget("input");
    leave(folder);
}
