/* Letters and words of the glass, whatever character or number asks for one. */
#include "check.h"
#include "lm/font.h"
#include "lm/sensor.h"

#include <string.h>

TEST(letters_are_the_same_in_either_case)
{
    for (char c = 'A'; c <= 'Z'; c++) {
        assert_ptr_equal(lm_font_glyph((char)(c + 'a' - 'A')), lm_font_glyph(c));
        assert_ptr_not_equal(lm_font_glyph(c), lm_font_glyph(' '));
    }
}

TEST(a_character_without_a_glyph_is_a_blank)
{
    static const char none[] = {'\0', 31, '`', '{', '~', 127, (char)128, (char)255};
    for (size_t i = 0; i < sizeof none; i++) {
        assert_ptr_equal(lm_font_glyph(none[i]), lm_font_glyph(' '));
    }
}

TEST(every_band_has_a_word_of_its_own_and_no_other_number_has_one)
{
    for (uint32_t i = 0; i < LM_SENSORS; i++) {
        assert_true(strlen(lm_sensor_word(i)) > 0);
        for (uint32_t k = 0; k < i; k++) {
            assert_string_not_equal(lm_sensor_word(i), lm_sensor_word(k));
        }
    }
    assert_string_equal(lm_sensor_word(LM_SENSORS), "");
    assert_string_equal(lm_sensor_word(UINT32_MAX), "");
}
