/* Several flashes as one: each at its place, and nothing between them. */
#include "drv/flash_joined.h"

#include "check.h"
#include "memory_flash.h"

#include <string.h>

enum { FIRST = 1000, SECOND = 300 };

TEST(each_flash_lies_at_its_place_and_nothing_between_them)
{
    uint8_t first[FIRST], second[SECOND], got[16];
    for (int i = 0; i < FIRST; i++) {
        first[i] = (uint8_t)(i * 7);
    }
    for (int i = 0; i < SECOND; i++) {
        second[i] = (uint8_t)(i * 11 + 3);
    }
    struct memory_flash a, b;
    struct drv_flash_joined j;
    struct lm_flash_part parts[LM_IMAGES_MAX];
    memory_flash_open(&a, first, FIRST);
    memory_flash_open(&b, second, SECOND);
    const struct lm_flash *const flash[] = {&a.port, &b.port};
    drv_flash_joined_open(&j, flash, 2, parts);
    assert_int_equal(parts[0].bytes, FIRST);
    assert_int_equal(parts[1].bytes, SECOND);
    assert_int_equal(parts[2].bytes, 0);
    b.busy_polls = 2;
    for (uint32_t i = 0; i < 50; i++) {
        const uint32_t n = i % 2, at = i * 5;
        assert_int_equal(j.port.read_start(&j, parts[n].offset + at, got, sizeof got), LM_OK);
        int status;
        while ((status = j.port.read_poll(&j)) == LM_BUSY) {
        }
        assert_int_equal(status, LM_OK);
        assert_memory_equal(got, (n == 0 ? first : second) + at, sizeof got);
    }
    assert_int_equal(j.port.read_start(&j, FIRST - 15, got, 16), LM_ERR_RANGE);
    assert_int_equal(j.port.read_start(&j, parts[1].offset - 16, got, 16), LM_ERR_RANGE);
    assert_int_equal(j.port.read_start(&j, parts[1].offset + SECOND - 15, got, 16), LM_ERR_RANGE);
    assert_int_equal(j.port.read_start(&j, parts[2].offset, got, 16), LM_ERR_RANGE);
    assert_int_equal(j.port.read_start(&j, UINT64_MAX, got, 16), LM_ERR_RANGE);
}

static int read_at(struct drv_flash_joined *j, uint64_t offset, uint8_t *got)
{
    const int status = j->port.read_start(j, offset, got, 1);
    return status == LM_OK ? j->port.read_poll(j) : status;
}

TEST(a_flash_comes_to_its_place_and_leaves_it)
{
    const uint8_t first[FIRST] = {1}, second[SECOND] = {2}, third[SECOND] = {3};
    struct memory_flash a, b, c;
    struct drv_flash_joined j;
    struct lm_flash_part parts[LM_IMAGES_MAX];
    uint8_t got;
    memory_flash_open(&a, first, FIRST);
    memory_flash_open(&b, second, SECOND);
    memory_flash_open(&c, third, SECOND);
    const struct lm_flash *const flash[] = {&a.port, NULL, &c.port};
    drv_flash_joined_open(&j, flash, 3, parts);
    assert_int_equal(parts[1].bytes, 0);
    assert_int_equal(read_at(&j, parts[1].offset, &got), LM_ERR_RANGE);
    assert_int_equal(read_at(&j, parts[2].offset, &got), LM_OK);
    assert_int_equal(got, 3);
    const struct lm_flash_part came = drv_flash_joined_put(&j, 1, &b.port);
    assert_int_equal(came.offset, parts[1].offset);
    assert_int_equal(came.bytes, SECOND);
    assert_int_equal(read_at(&j, came.offset, &got), LM_OK);
    assert_int_equal(got, 2);
    assert_int_equal(drv_flash_joined_put(&j, 1, NULL).bytes, 0);
    assert_int_equal(read_at(&j, came.offset, &got), LM_ERR_RANGE);
    assert_int_equal(b.reads, 1);
    assert_int_equal(read_at(&j, 0, &got), LM_OK);
    assert_int_equal(got, 1);
}
