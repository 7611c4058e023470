/* Words of the sensors: lm/sensor.h. */
#include "check.h"
#include "lm/sensor.h"

TEST(each_sensor_has_a_word_of_its_own_and_no_other_number_has_one)
{
    for (uint32_t a = 0; a < LM_SENSORS; a++) {
        assert_string_not_equal(lm_sensor_word(a), "");
        for (uint32_t b = 0; b < a; b++) {
            assert_string_not_equal(lm_sensor_word(a), lm_sensor_word(b));
        }
    }
    /* The first number beyond has the same nothing as any other, not what lies behind the words. */
    assert_string_equal(lm_sensor_word(UINT32_MAX), "");
    assert_ptr_equal(lm_sensor_word(LM_SENSORS), lm_sensor_word(UINT32_MAX));
}
