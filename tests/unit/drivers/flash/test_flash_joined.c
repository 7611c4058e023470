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
