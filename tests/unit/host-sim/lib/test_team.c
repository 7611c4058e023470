/* Parts of work done by several threads, and the checksum with the processor's instruction. */
#include "check.h"
#include "fx/crc32c.h"
#include "hs/crc32c.h"
#include "hs/rng.h"
#include "hs/team.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = 500 };

struct sums {
    atomic_int workers, done[PARTS];
    uint32_t finished; /* in order so far */
    int workers_max;   /* that get memory */
};

static void *begin(void *ctx)
{
    struct sums *s = ctx;
    return atomic_fetch_add(&s->workers, 1) < s->workers_max ? malloc(1) : NULL;
}

static void work(void *ctx, void *own, uint32_t part)
{
    struct sums *s = ctx;
    assert_non_null(own);
    for (volatile uint32_t i = 0; i < part * 7919 % 5000; i++) { /* parts take different times */
    }
    atomic_fetch_add(&s->done[part], 1);
}

static void end(void *ctx, void *own)
{
    (void)ctx;
    free(own);
}

static void finish(void *ctx, uint32_t part)
{
    struct sums *s = ctx;
    assert_int_equal(part, s->finished);
    assert_int_equal(atomic_load(&s->done[part]), 1);
    s->finished++;
}

TEST(each_part_is_done_once_and_finished_in_its_order)
{
    for (uint32_t threads = 1; threads <= HS_TEAM_MAX + 4; threads += 3) {
        struct sums s = {.workers_max = 100};
        const struct hs_team team = {&s, begin, work, end, finish};
        assert_int_equal(hs_team_run(&team, PARTS, threads), 0);
        assert_int_equal(s.finished, PARTS);
        assert_true(atomic_load(&s.workers) <= HS_TEAM_MAX);
    }
}

TEST(threads_without_memory_are_done_without)
{
    struct sums s = {.workers_max = 1};
    const struct hs_team team = {&s, begin, work, end, finish};
    assert_int_equal(hs_team_run(&team, PARTS, 4), 0);
    assert_int_equal(s.finished, PARTS);

    struct sums none = {.workers_max = 0};
    const struct hs_team idle = {&none, begin, work, end, finish};
    assert_int_equal(hs_team_run(&idle, PARTS, 4), -1);
    assert_int_equal(none.finished, 0);
    assert_int_equal(hs_team_run(&idle, 0, 4), 0);
}

TEST(there_is_at_least_one_thread_and_no_more_than_a_team_has)
{
    assert_true(hs_team_threads() >= 1 && hs_team_threads() <= HS_TEAM_UNASKED_MAX);
}

TEST(the_checksum_is_that_of_the_firmware_at_every_length_and_alignment)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 2);
    uint8_t bytes[160];
    for (size_t i = 0; i < sizeof bytes; i++) {
        bytes[i] = (uint8_t)hs_rng_u64(&rng);
    }
    assert_int_equal(hs_crc32c(0, "123456789", 9), 0xe3069283u);
    for (size_t start = 0; start < 8; start++) {
        for (size_t len = 0; len <= sizeof bytes - start; len++) {
            const uint32_t before = (uint32_t)(start * 0x12345 + len);
            assert_int_equal(hs_crc32c(before, bytes + start, len),
                             fx_crc32c(before, bytes + start, len));
        }
    }
}
