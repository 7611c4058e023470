/* Keys of the page by themselves, on each page and over each picture: what a press does to the
 * page, whatever the unit makes of it. */
#include "check.h"
#include "lm/page.h"
#include "page_table.h"

#include <string.h>

static struct lm_page page_in(uint8_t format, uint8_t picture, uint8_t fov)
{
    struct lm_page p;
    lm_page_init(&p, &lm_radar_default);
    p.format = format;
    p.picture = picture;
    p.fov = fov;
    return p;
}

static uint32_t press_key(struct lm_page *p, int button, bool is_long)
{
    return lm_page_press(p, (struct lm_press){.button = (uint8_t)button, .is_long = is_long});
}

/* Every page over every picture in every field of view. */
enum { CASES = LM_FORMATS * 2 * LM_FOVS };
static struct lm_page page_of_case(int i)
{
    static const uint8_t pictures[] = {LM_PICTURE_SECTOR, LM_PICTURE_PATCH};
    return page_in((uint8_t)(i / 2 / LM_FOVS), pictures[i / LM_FOVS % 2], (uint8_t)(i % LM_FOVS));
}

TEST(a_long_press_of_a_key_without_a_second_meaning_is_a_press)
{
    int with_two = 0;
    for (int i = 0; i < CASES; i++) {
        const struct lm_page before = page_of_case(i);
        for (int osb = 1; osb <= LM_OSBS; osb++) {
            struct lm_page pressed = before, held = before;
            const bool has_two = lm_page_key_style(&before, (uint8_t)osb) == LM_KEY_HAS_LONG;
            const uint32_t effects = press_key(&pressed, osb, false);
            const bool is_same =
                press_key(&held, osb, true) == effects && memcmp(&pressed, &held, sizeof held) == 0;
            assert_true(is_same != has_two);
            with_two += has_two;
        }
    }
    assert_true(with_two > 0);
}

TEST(a_key_that_does_not_exist_does_nothing)
{
    for (int i = 0; i < CASES; i++) {
        const struct lm_page before = page_of_case(i);
        static const int none[] = {0, LM_BUTTONS + 1, LM_BUTTONS + 2, 255};
        for (int k = 0; k < 4; k++) {
            struct lm_page p = before;
            assert_int_equal(press_key(&p, none[k], false), 0);
            assert_memory_equal(&p, &before, sizeof p);
        }
    }
}

/* The scale is the sector's: over a patch its keys are without words and without effect. */
TEST(the_scale_and_the_sector_stay_as_they_are_over_a_patch)
{
    for (int osb = 18; osb <= 20; osb++) { /* azimuth, smaller, larger */
        struct lm_page p = page_in(LM_FORMAT_RADAR, LM_PICTURE_PATCH, LM_FOV_NORM);
        p.is_auto_range = true;
        const struct lm_page before = p;
        assert_int_equal(press_key(&p, osb, false), 0);
        assert_memory_equal(&p, &before, sizeof p);
        p.picture = LM_PICTURE_SECTOR;
        assert_int_not_equal(press_key(&p, osb, false), 0);
    }
}

/* Back in the sector it is the mode that was chosen there. */
TEST(the_mode_key_of_a_patch_leads_back_and_chooses_nothing)
{
    struct lm_page p = page_in(LM_FORMAT_RADAR, LM_PICTURE_PATCH, LM_FOV_NORM);
    const struct lm_page before = p;
    assert_int_equal(press_key(&p, 1, false), LM_EFFECT_SECTOR | LM_EFFECT_TONE);
    assert_memory_equal(&p, &before, sizeof p);
    p.picture = LM_PICTURE_SECTOR;
    press_key(&p, 1, false);
    assert_int_not_equal(p.mode, before.mode);
}

/* A window has no scan of its own; with the field NORM there are as many as the table has. */
TEST(the_azimuth_is_chosen_in_norm_alone)
{
    for (uint8_t fov = 0; fov < LM_FOVS; fov++) {
        uint32_t seen = 0;
        struct lm_page p = page_in(LM_FORMAT_RADAR, LM_PICTURE_SECTOR, fov);
        for (int n = 0; n < LM_AZIMUTHS; n++) {
            seen |= 1u << p.azimuth_index;
            press_key(&p, 18, false);
        }
        assert_int_equal(seen, fov == LM_FOV_NORM ? (1u << LM_AZIMUTHS) - 1 : 1u);
        assert_int_equal(p.azimuth_index, 0);
    }
}

/* What another display or a file says of the page: each field of view belongs to its mode, each
 * scale to both. */
TEST(a_page_of_bytes_has_no_field_of_view_and_no_scale_that_its_mode_has_not)
{
    enum { MODE = 2, FOV, RANGE };
    struct lm_page p;
    uint8_t byte[LM_PAGE_BYTES];
    uint32_t refused_fovs = 0, refused_ranges = 0;
    lm_page_init(&p, &lm_radar_default);
    lm_page_bytes(&p, byte);
    assert_true(lm_page_bytes_are_sound(&p, byte));
    for (uint8_t mode = 0; mode < LM_SECTOR_CHOICES; mode++) {
        for (uint8_t fov = 0; fov < LM_FOVS; fov++) {
            for (uint8_t range = 0; range < p.radar->ranges; range++) {
                byte[MODE] = mode, byte[FOV] = fov, byte[RANGE] = range;
                const bool has_fov = fov <= lm_radar_fov_last(p.radar, mode);
                const bool has_range = range <= lm_radar_range_last(p.radar, mode, fov);
                assert_int_equal(lm_page_bytes_are_sound(&p, byte), has_fov && has_range);
                refused_fovs += !has_fov && has_range;
                refused_ranges += has_fov && !has_range;
            }
        }
    }
    assert_true(refused_fovs > 0 && refused_ranges > 0);
}

TEST(reset_has_tone_palette_and_beam_taken_anew)
{
    struct lm_page p = page_in(LM_FORMAT_CNTL, LM_PICTURE_SECTOR, LM_FOV_NORM);
    p.is_pencil = p.palette.is_night = true;
    p.black_db = 3;
    assert_int_equal(press_key(&p, 10, false), LM_EFFECT_TONE | LM_EFFECT_PALETTE | LM_EFFECT_BEAM);
    assert_false(p.is_pencil || p.palette.is_night || p.black_db != 0);
}

TEST(tilt_is_told_in_tenths_of_a_degree_and_nought_is_no_less_than_nothing)
{
    static const struct {
        int16_t tenths;
        const char *words;
    } cases[] = {{-125, "-12.5"}, {-1, "-0.1"}, {0, "+0.0"}, {1, "+0.1"}, {120, "+12.0"}};
    struct lm_page p = page_in(LM_FORMAT_CNTL, LM_PICTURE_SECTOR, LM_FOV_NORM);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct lm_label label;
        p.tilt_tenths = cases[i].tenths;
        lm_page_label(&p, 1, &label);
        assert_string_equal(label.line[1], cases[i].words);
    }
}

TEST(a_word_too_long_for_a_label_is_cut_at_its_fifth_letter)
{
    struct lm_label label;
    memset(&label, 'x', sizeof label);
    lm_label_set(&label, "LANDMASS", "FIVES");
    assert_string_equal(label.line[0], "LANDM");
    assert_string_equal(label.line[1], "FIVES");
}
