/* What every host program leans on: files that appear whole, and numbers that repeat. */
#include "check.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
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
