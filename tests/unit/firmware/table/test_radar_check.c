/* The radar table's contract: a value past either end of any field is refused by its name, and so
 * is a table that breaks a rule between fields. */
#include "check.h"
#include "lm/radar_check.h"
#include "lm/status.h"

#include <string.h>

static void expect_refused(const struct lm_radar *radar, const char *field, uint32_t index,
                           bool is_rule)
{
    struct lm_radar_fault fault = {NULL, UINT32_MAX, NULL};
    assert_int_equal(lm_radar_check(radar, &fault), LM_ERR_TABLE);
    assert_string_equal(fault.field, field);
    assert_int_equal(fault.index, index);
    assert_int_equal(fault.needs != NULL, is_rule);
    assert_int_equal(lm_radar_check(radar, NULL), LM_ERR_TABLE);
}

TEST(the_default_table_keeps_its_contract)
{
    struct lm_radar_fault fault = {"untouched", 7, NULL};
    assert_int_equal(lm_radar_check(&lm_radar_default, &fault), LM_OK);
    assert_string_equal(fault.field, "untouched");
}

/* What the field's type cannot hold cannot be past its end. */
static bool can_hold(const struct lm_radar_field *f, int64_t value)
{
    const int64_t values = (int64_t)1 << 8 * f->size;
    return f->is_signed ? value >= -values / 2 && value < values / 2 : value >= 0 && value < values;
}

TEST(a_value_past_either_end_is_refused_by_its_field_s_name)
{
    uint32_t tried = 0;
    for (uint32_t n = 0; lm_radar_field(n); n++) {
        const struct lm_radar_field *f = lm_radar_field(n);
        assert_true(f->min <= f->max && can_hold(f, f->min) && can_hold(f, f->max));
        for (uint32_t i = 0; i < lm_radar_field_count(&lm_radar_default, f); i++) {
            for (uint32_t end = 0; end < 2; end++) {
                const int64_t past = end == 0 ? f->min - 1 : f->max + 1;
                struct lm_radar radar = lm_radar_default;
                if (can_hold(f, past)) {
                    lm_radar_field_set(&radar, f, i, past);
                    assert_int_equal(lm_radar_field_value(&radar, f, i), past);
                    expect_refused(&radar, f->name, i, false);
                    tried++;
                }
            }
        }
    }
    assert_true(tried > 150);
}

/* A field that the check does not know would leave a hole: what is left is the compiler's padding.
 */
TEST(every_byte_of_the_table_belongs_to_a_field)
{
    bool is_known[sizeof(struct lm_radar)] = {false};
    memset(is_known + offsetof(struct lm_radar, name), true, LM_RADAR_NAME_SIZE);
    for (size_t i = 0; i < LM_SECTOR_MODES; i++) {
        memset(is_known + offsetof(struct lm_radar, mode) + i * sizeof(struct lm_sector_mode_row) +
                   offsetof(struct lm_sector_mode_row, name),
               true, LM_NAME_SIZE);
    }
    for (size_t i = 0; i < LM_FOVS; i++) {
        memset(is_known + offsetof(struct lm_radar, fov) + i * sizeof(struct lm_fov_row) +
                   offsetof(struct lm_fov_row, name),
               true, LM_NAME_SIZE);
    }
    for (uint32_t n = 0; lm_radar_field(n); n++) {
        const struct lm_radar_field *f = lm_radar_field(n);
        for (uint32_t i = 0; i < f->count; i++) {
            const size_t at = f->offset + (size_t)i * f->stride;
            assert_true(at % f->size == 0 && at + f->size <= sizeof is_known);
            for (size_t k = at; k < at + f->size; k++) {
                assert_false(is_known[k]); /* nor to two */
                is_known[k] = true;
            }
        }
    }
    /* Padding ends where a number of 16 or 32 bits begins, and is shorter than that. */
    for (size_t k = 0, hole = 0; k < sizeof is_known; k++) {
        hole = is_known[k] ? 0 : hole + 1;
        assert_true(hole < 4);
    }
}

static void scales_fall(struct lm_radar *r)
{
    r->range[2].range_m = r->range[1].range_m;
}

static void names_of_scales_fall(struct lm_radar *r)
{
    r->range[3].range_nm = r->range[2].range_nm;
}

static void a_row_is_not_counted(struct lm_radar *r)
{
    r->ranges--;
}

static void an_unused_row_holds_a_pulse(struct lm_radar *r)
{
    r->range[LM_RANGES_MAX - 1].pulse_ns[LM_FOV_DBS2] = 100;
}

static void the_radar_has_no_name(struct lm_radar *r)
{
    r->name[0] = 0;
}

static void the_radar_s_name_does_not_end(struct lm_radar *r)
{
    memset(r->name, 'X', LM_RADAR_NAME_SIZE);
}

static void the_radar_s_name_ends_in_a_blank(struct lm_radar *r)
{
    memcpy(r->name, "KU ", 4);
}

static void something_stands_behind_the_name(struct lm_radar *r)
{
    r->name[LM_RADAR_NAME_SIZE - 1] = 'X';
}

static void a_mode_s_name_begins_a_remark(struct lm_radar *r)
{
    memcpy(r->mode[LM_SECTOR_GM].name, "#GM", 4);
}

static void a_mode_lacks_the_smallest_scale(struct lm_radar *r)
{
    r->mode[LM_SECTOR_SEA].range_max_nm = (uint16_t)(r->range[0].range_nm - 1);
}

static void a_field_lacks_the_smallest_scale(struct lm_radar *r)
{
    r->fov[LM_FOV_DBS2].range_max_nm = (uint16_t)(r->range[0].range_nm - 1);
}

static void the_start_is_no_scale(struct lm_radar *r)
{
    r->range_start_nm = 39;
}

static void the_start_is_beyond_the_mode(struct lm_radar *r)
{
    r->mode[LM_SECTOR_GM].range_max_nm = 20;
}

static void a_mode_has_no_name(struct lm_radar *r)
{
    r->mode[LM_SECTOR_GM].name[0] = 0;
}

static void a_mode_s_name_does_not_end(struct lm_radar *r)
{
    memset(r->mode[LM_SECTOR_GMT].name, 'X', LM_NAME_SIZE);
}

static void two_modes_share_a_name(struct lm_radar *r)
{
    memcpy(r->mode[LM_SECTOR_SEA].name, "gmt", 4);
}

static void a_mode_has_the_beacons_name(struct lm_radar *r)
{
    memcpy(r->mode[LM_SECTOR_SEA].name, "bcn", 4);
}

static void two_fields_share_a_name(struct lm_radar *r)
{
    memcpy(r->fov[LM_FOV_DBS2].name, "exp", 4);
}

static void a_field_s_name_has_a_blank(struct lm_radar *r)
{
    memcpy(r->fov[LM_FOV_EXP].name, "E P", 4);
}

static void a_sector_is_wider_than_the_antenna_turns(struct lm_radar *r)
{
    r->azimuth_half[0] = r->antenna.azimuth_limit + 1;
}

static void a_sector_is_narrower_than_a_line(struct lm_radar *r)
{
    r->azimuth_half[2] = r->line - 1;
}

static void samples_are_too_far_apart(struct lm_radar *r)
{
    r->sample = r->antenna.azimuth_beam / 7 * 2 + 7;
}

static void samples_are_too_close(struct lm_radar *r)
{
    r->sample = r->antenna.azimuth_beam / 4 - 1;
}

static void a_gate_is_upside_down(struct lm_radar *r)
{
    r->mode[LM_SECTOR_GMT].gate_mm_s[1] = 1542;
}

static void white_is_hardly_above_black(struct lm_radar *r)
{
    r->mode[LM_SECTOR_SEA].tone.white_db_q8 =
        (int16_t)(r->mode[LM_SECTOR_SEA].tone.black_db_q8 + 255);
}

static void a_patch_s_white_is_below_black(struct lm_radar *r)
{
    r->sar.tone.white_db_q8 = (int16_t)(r->sar.tone.black_db_q8 - 1);
}

static void a_field_s_rate_is_too_slow(struct lm_radar *r)
{
    r->fov[LM_FOV_DBS1].bam_per_s = LM_RADAR_RATE_MIN - 1;
}

static void a_window_s_cells_are_too_short(struct lm_radar *r)
{
    r->range[0].range_m = 1852;
    r->fov[LM_FOV_DBS2].window_permille = 5;
}

static void a_window_is_narrower_than_a_line(struct lm_radar *r)
{
    r->fov[LM_FOV_EXP].azimuth_half_max = r->line - 1;
}

static void beam_positions_are_farther_apart_than_the_beam(struct lm_radar *r)
{
    r->fov[LM_FOV_DBS1].beam_step = r->antenna.azimuth_beam + 1;
}

static void the_largest_cell_is_smaller_than_the_smallest(struct lm_radar *r)
{
    r->sar.cell_max_mm = r->sar.cell_min_mm - 1;
}

TEST(a_broken_rule_between_fields_is_refused_by_name)
{
    static const struct {
        void (*breaks)(struct lm_radar *radar);
        const char *field;
        uint32_t index;
    } rules[] = {
        {scales_fall, "range.range_m", 2},
        {names_of_scales_fall, "range.range_m", 3},
        {a_row_is_not_counted, "ranges", 0},
        {an_unused_row_holds_a_pulse, "ranges", 0},
        {the_radar_has_no_name, "name", 0},
        {the_radar_s_name_does_not_end, "name", 0},
        {the_radar_s_name_ends_in_a_blank, "name", 0},
        {something_stands_behind_the_name, "name", 0},
        {a_mode_s_name_begins_a_remark, "mode.name", LM_SECTOR_GM},
        {a_mode_lacks_the_smallest_scale, "mode.range_max_nm", LM_SECTOR_SEA},
        {a_field_lacks_the_smallest_scale, "fov.range_max_nm", LM_FOV_DBS2},
        {the_start_is_no_scale, "range_start_nm", 0},
        {the_start_is_beyond_the_mode, "range_start_nm", 0},
        {a_mode_has_no_name, "mode.name", LM_SECTOR_GM},
        {a_mode_s_name_does_not_end, "mode.name", LM_SECTOR_GMT},
        {two_modes_share_a_name, "mode.name", LM_SECTOR_SEA},
        {a_mode_has_the_beacons_name, "mode.name", LM_SECTOR_SEA},
        {two_fields_share_a_name, "fov.name", LM_FOV_DBS2},
        {a_field_s_name_has_a_blank, "fov.name", LM_FOV_EXP},
        {a_sector_is_wider_than_the_antenna_turns, "azimuth_half", 0},
        {a_sector_is_narrower_than_a_line, "azimuth_half", 2},
        {samples_are_too_far_apart, "sample", 0},
        {samples_are_too_close, "sample", 0},
        {a_gate_is_upside_down, "mode.gate_mm_s[1]", LM_SECTOR_GMT},
        {white_is_hardly_above_black, "mode.tone.white_db_q8", LM_SECTOR_SEA},
        {a_patch_s_white_is_below_black, "sar.tone.white_db_q8", 0},
        {a_field_s_rate_is_too_slow, "fov.bam_per_s", LM_FOV_DBS1},
        {a_window_s_cells_are_too_short, "fov.window_permille", LM_FOV_DBS2},
        {a_window_is_narrower_than_a_line, "fov.azimuth_half_max", LM_FOV_EXP},
        {beam_positions_are_farther_apart_than_the_beam, "fov.beam_step", LM_FOV_DBS1},
        {the_largest_cell_is_smaller_than_the_smallest, "sar.cell_max_mm", 0},
    };
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
        struct lm_radar radar = lm_radar_default;
        rules[i].breaks(&radar);
        expect_refused(&radar, rules[i].field, rules[i].index, true);
    }
}

/* Decibels as a table has them. */
#define DB(decibels) ((decibels)*256)

TEST(the_range_of_each_field_is_that_of_its_remark_in_radar_h)
{
    static const struct {
        const char *field;
        int64_t min, max;
    } ranges[] = {
        {"sensor", LM_SENSOR_X, LM_SENSOR_MMW},
        {"ranges", 1, LM_RANGES_MAX},
        {"range.range_m", 1852, LM_RADAR_RANGE_MAX_M},
        {"range.range_nm", 1, 999},
        {"range.stc_end_m", 100, 400000},
        {"range.pulse_ns[NORM]", 10, 100000},
        {"range.pulse_ns[EXP]", 10, 100000},
        {"range.pulse_ns[DBS1]", 10, 100000},
        {"range.pulse_ns[DBS2]", 10, 100000},
        {"range.code_gain_db_q8[NORM]", 0, DB(40)},
        {"range.code_gain_db_q8[EXP]", 0, DB(40)},
        {"range.code_gain_db_q8[DBS1]", 0, DB(40)},
        {"range.code_gain_db_q8[DBS2]", 0, DB(40)},
        {"range_start_nm", 1, 999},
        {"azimuth_half", 1 << 20, LM_RADAR_AZIMUTH_MAX},
        {"wavelength_um", LM_WAVELENGTH_MIN_UM, LM_WAVELENGTH_MAX_UM},
        {"cells", 64, LM_RADAR_CELLS_MAX},
        {"line", 1 << 20, FX_BAM_DEG(10)},
        {"sample", 1 << 21, FX_BAM_DEG(6)},
        {"antenna.azimuth_beam", LM_RADAR_BEAM_MIN, FX_BAM_DEG(20)},
        {"antenna.elevation_beam", LM_RADAR_BEAM_MIN, FX_BAM_DEG(60)},
        {"antenna.fan", 0, FX_BAM_DEG(60)},
        {"antenna.bar_spacing", 0, FX_BAM_DEG(10)},
        {"antenna.azimuth_limit", 1 << 20, LM_RADAR_AZIMUTH_MAX},
        {"antenna.tilt_max", 0, FX_BAM_DEG(60)},
        {"receiver.noise_looks_log2", 0, LM_LOOKS_LOG2_MAX},
        {"receiver.noise_db_q8", DB(-100), DB(20)},
        {"receiver.noise_range_m", 1852, LM_RADAR_RANGE_MAX_M},
        {"receiver.noise_height_m", 0, 30000},
        {"receiver.noise_pulse_ns", 10, 100000},
        {"receiver.air_loss_db_per_km_q16", 0, 1 << 14},
        {"mode.bam_per_s", LM_RADAR_RATE_MIN, LM_RADAR_RATE_MAX},
        {"mode.range_max_nm", 1, 999},
        {"mode.fov_last", 0, LM_FOVS - 1},
        {"mode.bars", 1, 8},
        {"mode.stretch_cells", 0, 4},
        {"mode.clutter_db_q8", 0, DB(64)},
        {"mode.gate_mm_s[0]", 0, LM_RADAR_SPEED_MAX_MM_S},
        {"mode.gate_mm_s[1]", 0, LM_RADAR_SPEED_MAX_MM_S},
        {"mode.tone.black_db_q8", DB(-64), DB(64)},
        {"mode.tone.white_db_q8", DB(-64), DB(64)},
        {"mode.tone.gamma_q8", 64, LM_TONE_GAMMA_MAX_Q8},
        {"fov.bam_per_s", 0, LM_RADAR_RATE_MAX},
        {"fov.range_max_nm", 1, 999},
        {"fov.slew_percent", 1, 200},
        {"fov[NORM].window_permille", 0, 0},
        {"fov[EXP..].window_permille", 5, 250},
        {"fov.azimuth_half_max", 0, LM_RADAR_AZIMUTH_MAX},
        {"fov.sharpening", 1, LM_RADAR_SHARPENING_MAX},
        {"fov.beam_step", 0, FX_BAM_DEG(20)},
        {"fov.azimuths_log2", 0, LM_RADAR_AZIMUTHS_LOG2_MAX},
        {"fov.ground_leak_db_q8", DB(-100), 0},
        {"sar.cells", 32, LM_RADAR_PATCH_CELLS_MAX},
        {"sar.cell_min_mm", 100, 100000},
        {"sar.cell_max_mm", 100, 100000},
        {"sar.squint_min", 0, FX_BAM_DEG(80)},
        {"sar.dwell_max_ms", 1, 131071},
        {"sar.reference_speed_mm_s", 1000, LM_RADAR_SPEED_MAX_MM_S},
        {"sar.mocomp_residual_permille", 0, 1000},
        {"sar.noise_floor_db_q8", DB(-100), DB(20)},
        {"sar.line_lobe", 1 << 20, FX_BAM_90},
        {"sar.ground_leak_db_q8", DB(-100), 0},
        {"sar.ground_leak_most_db_q8", DB(-60), DB(20)},
        {"sar.side_lobes.over_shadow_db_q8", 0, DB(100)},
        {"sar.side_lobes.above_db_q8", 0, DB(100)},
        {"sar.side_lobes.a_line", 0, LM_RADAR_SIDE_LOBES_MAX},
        {"sar.speckle.looks_log2", 0, LM_LOOKS_LOG2_MAX},
        {"sar.tone.black_db_q8", DB(-64), DB(64)},
        {"sar.tone.white_db_q8", DB(-64), DB(64)},
        {"sar.tone.gamma_q8", 64, LM_TONE_GAMMA_MAX_Q8},
        {"illumination.edge_structure_db_q8", 0, LM_EDGE_MAX_DB_Q8},
        {"illumination.edge_trees_db_q8", 0, LM_EDGE_MAX_DB_Q8},
        {"illumination.shore_db_q8", 0, LM_EDGE_MAX_DB_Q8},
        {"illumination.shore_width_m", 0, 10000},
        {"sea.upwind_db_q8", DB(-10), DB(10)},
        {"sea.crosswind_db_q8", DB(-10), DB(10)},
        {"sea.downwind_db_q8", DB(-10), DB(10)},
        {"facing.lobe_half", FX_BAM_DEG(4), FX_BAM_DEG(45)},
        {"facing.floor_permille", 10, 1000},
    };
    uint32_t n = 0;
    for (; n < sizeof ranges / sizeof *ranges; n++) {
        const struct lm_radar_field *f = lm_radar_field(n);
        assert_non_null(f);
        assert_string_equal(f->name, ranges[n].field);
        if (f->min != ranges[n].min || f->max != ranges[n].max) {
            fail_msg("%s has another range than radar.h says", f->name);
        }
    }
    assert_null(lm_radar_field(n));
}

TEST(a_mode_is_found_by_its_name_in_either_case_and_a_field_is_no_mode)
{
    struct lm_radar radar = lm_radar_default;
    memcpy(radar.mode[LM_SECTOR_SEA].name, "AZ@", 4); /* ends of the alphabet, and one before it */
    assert_int_equal(lm_radar_find_mode(&radar, "az@"), LM_SECTOR_SEA);
    assert_int_equal(lm_radar_find_mode(&radar, "Az@"), LM_SECTOR_SEA);
    assert_int_equal(lm_radar_find_mode(&radar, "az`"), -1);
    assert_int_equal(lm_radar_find_mode(&radar, "bcn"), LM_SECTOR_BEACON);
    for (uint32_t i = 0; i < LM_FOVS; i++) {
        assert_int_equal(lm_radar_find_mode(&radar, radar.fov[i].name), -1);
        assert_int_equal(lm_radar_find_fov(&radar, radar.fov[i].name), i);
    }
    assert_int_equal(lm_radar_find_fov(&radar, "az@"), -1);
}

TEST(an_azimuth_is_found_by_its_degrees)
{
    for (int32_t i = 0; i < LM_AZIMUTHS; i++) {
        const double degrees = lm_radar_default.azimuth_half[i] * 360.0 / 4294967296.0;
        assert_int_equal(lm_radar_find_azimuth(&lm_radar_default, (int32_t)(degrees + 0.5)), i);
    }
    assert_int_equal(lm_radar_find_azimuth(&lm_radar_default, 1), -1);
}

TEST(a_table_may_start_with_its_smallest_scale)
{
    struct lm_radar radar = lm_radar_default;
    radar.range_start_nm = radar.range[0].range_nm;
    assert_int_equal(lm_radar_check(&radar, NULL), LM_OK);
}
