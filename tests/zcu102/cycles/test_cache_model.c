/* The model of the caches on accesses whose misses follow from its size alone. */
#include "cache_model.h"
#include "check.h"

static struct cache cache;
static struct cache_levels levels;

static uint32_t misses_of(uint32_t lines, uint32_t stride, uint32_t rounds)
{
    uint32_t misses = 0;
    for (uint32_t i = 0; i < lines * rounds; i++) {
        misses += !cache_model_has(&cache, (uint64_t)(i % lines) * stride);
    }
    return misses;
}

TEST(what_fits_misses_once)
{
    assert_true(cache_model_init(&cache, 32 << 10, 4));
    assert_int_equal(misses_of(512, 1, 10), 512);
}

TEST(one_line_more_than_the_ways_misses_always_in_its_set)
{
    assert_true(cache_model_init(&cache, 32 << 10, 4)); /* 128 sets */
    assert_int_equal(misses_of(4, 128, 10), 4);
    assert_true(cache_model_init(&cache, 32 << 10, 4));
    assert_int_equal(misses_of(5, 128, 10), 50);
    assert_true(cache_model_init(&cache, 32 << 10, 4));
    assert_int_equal(misses_of(5, 127, 10), 5); /* of other sets */
}

TEST(the_line_used_longest_ago_goes)
{
    assert_true(cache_model_init(&cache, 128, 2)); /* one set */
    assert_false(cache_model_has(&cache, 1));
    assert_false(cache_model_has(&cache, 2));
    assert_true(cache_model_has(&cache, 1));
    assert_false(cache_model_has(&cache, 3)); /* instead of 2 */
    assert_true(cache_model_has(&cache, 1));
    assert_false(cache_model_has(&cache, 2));
}

TEST(line_zero_is_not_there_from_the_start)
{
    assert_true(cache_model_init(&cache, 32 << 10, 4));
    assert_false(cache_model_has(&cache, 0));
    assert_true(cache_model_has(&cache, 0));
}

TEST(a_cache_whose_sets_are_no_power_of_two_is_refused)
{
    assert_false(cache_model_init(&cache, 48 << 10, 4));
    assert_false(cache_model_init(&cache, 32 << 10, 0));
    assert_false(cache_model_init(&cache, 32 << 10, 17));
    assert_false(cache_model_init(&cache, 4 << 20, 4)); /* more sets than there is room for */
}

TEST(an_access_across_two_lines_counts_for_both)
{
    struct cache_counts counts = {0};
    cache_model_levels(&levels);
    cache_model_data(&levels, 60, 8, &counts);
    assert_int_equal(counts.accesses, 2);
    assert_int_equal(counts.misses, 2);
    cache_model_data(&levels, 56, 8, &counts);
    assert_int_equal(counts.accesses, 3);
    assert_int_equal(counts.misses, 2);
}

TEST(the_second_level_keeps_what_the_first_has_lost)
{
    struct cache_counts first = {0}, again = {0};
    cache_model_levels(&levels);
    for (uint64_t address = 0; address < 512 << 10; address += 64) {
        cache_model_data(&levels, address, 4, &first);
    }
    for (uint64_t address = 0; address < 512 << 10; address += 64) {
        cache_model_data(&levels, address, 4, &again);
    }
    assert_int_equal(first.misses, 8192);
    assert_int_equal(first.far_misses, 8192);
    assert_int_equal(again.misses, 8192);
    assert_int_equal(again.far_misses, 0);
}

TEST(misses_beside_those_before_them_are_told_apart)
{
    struct cache_counts row = {0}, column = {0};
    cache_model_levels(&levels);
    for (uint64_t i = 0; i < 100; i++) {
        cache_model_data(&levels, i * 64, 4, &row);
        cache_model_data(&levels, (1 << 24) + i * 264, 4, &column);
    }
    assert_int_equal(row.next, 99);
    assert_int_equal(column.next, 0);
}

TEST(code_and_data_share_the_second_level_alone)
{
    struct cache_counts code = {0}, data = {0};
    cache_model_levels(&levels);
    cache_model_code(&levels, 0, 64, &code);
    cache_model_data(&levels, 0, 4, &data);
    assert_int_equal(code.far_misses, 1);
    assert_int_equal(data.misses, 1);
    assert_int_equal(data.far_misses, 0);
}
