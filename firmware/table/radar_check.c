#include "lm/radar_check.h"

#include <stddef.h>

#include "fx/mem.h"
#include "fx/sat.h"
#include "lm/status.h"
#include "lm/units.h"

/* A number, an array of numbers, and the same member of all rows of an array. */
#define SIZE_OF(member) sizeof(((const struct lm_radar *)0)->member)
#define WHERE(member, n, apart)                                                                    \
    .offset = offsetof(struct lm_radar, member), .size = SIZE_OF(member), .count = (n),            \
    .stride = (apart)
#define ONE(member)    WHERE(member, 1, 0)
#define EACH(first, n) WHERE(first, n, SIZE_OF(first))
#define OF_SCALES(member)                                                                          \
    WHERE(range[0].member, LM_RANGES_MAX, SIZE_OF(range[0])), .is_of_scales = true
#define OF_MODES(member)          WHERE(mode[0].member, LM_SECTOR_MODES, SIZE_OF(mode[0]))
#define OF_FIELDS(member)         WHERE(fov[0].member, LM_FOVS, SIZE_OF(fov[0]))
#define OF_WINDOWS(member)        WHERE(fov[1].member, LM_FOVS - 1, SIZE_OF(fov[0]))
#define BETWEEN(low, high)        .min = (low), .max = (high)
#define SIGNED_BETWEEN(low, high) .is_signed = true, .min = (low), .max = (high)
#define IN(name)                  .unit = LM_RADAR_##name

#define CODE_GAIN BETWEEN(0, LM_DB_Q8(40))
#define OF_WIND   SIGNED_BETWEEN(LM_DB_Q8(-10), LM_DB_Q8(10))

static const struct lm_radar_field fields[] = {
    {"sensor", ONE(sensor), BETWEEN(LM_SENSOR_X, LM_SENSOR_MMW), IN(WORD)},
    {"ranges", ONE(ranges), BETWEEN(1, LM_RANGES_MAX)},
    {"range.range_m", OF_SCALES(range_m), BETWEEN(1852, LM_RADAR_RANGE_MAX_M), IN(M)},
    {"range.range_nm", OF_SCALES(range_nm), BETWEEN(1, 999), IN(NMI)},
    {"range.stc_end_m", OF_SCALES(stc_end_m), BETWEEN(100, 400000), IN(M)},
    {"range.pulse_ns[NORM]", OF_SCALES(pulse_ns[LM_FOV_NORM]), BETWEEN(10, 100000), IN(NS)},
    {"range.pulse_ns[EXP]", OF_SCALES(pulse_ns[LM_FOV_EXP]), BETWEEN(10, 100000), IN(NS)},
    {"range.pulse_ns[DBS1]", OF_SCALES(pulse_ns[LM_FOV_DBS1]), BETWEEN(10, 100000), IN(NS)},
    {"range.pulse_ns[DBS2]", OF_SCALES(pulse_ns[LM_FOV_DBS2]), BETWEEN(10, 100000), IN(NS)},
    {"range.code_gain_db_q8[NORM]", OF_SCALES(code_gain_db_q8[LM_FOV_NORM]), CODE_GAIN, IN(DB_Q8)},
    {"range.code_gain_db_q8[EXP]", OF_SCALES(code_gain_db_q8[LM_FOV_EXP]), CODE_GAIN, IN(DB_Q8)},
    {"range.code_gain_db_q8[DBS1]", OF_SCALES(code_gain_db_q8[LM_FOV_DBS1]), CODE_GAIN, IN(DB_Q8)},
    {"range.code_gain_db_q8[DBS2]", OF_SCALES(code_gain_db_q8[LM_FOV_DBS2]), CODE_GAIN, IN(DB_Q8)},
    {"range_start_nm", ONE(range_start_nm), BETWEEN(1, 999), IN(NMI)},
    {"azimuth_half", EACH(azimuth_half[0], LM_AZIMUTHS), BETWEEN(1 << 20, LM_RADAR_AZIMUTH_MAX),
     IN(BAM)},
    {"wavelength_um", ONE(wavelength_um), BETWEEN(LM_WAVELENGTH_MIN_UM, LM_WAVELENGTH_MAX_UM),
     IN(UM)},
    {"cells", ONE(cells), BETWEEN(64, LM_RADAR_CELLS_MAX)},
    {"line", ONE(line), BETWEEN(1 << 20, FX_BAM_DEG(10)), IN(BAM)},
    {"sample", ONE(sample), BETWEEN(1 << 21, FX_BAM_DEG(6)), IN(BAM)},
    {"antenna.azimuth_beam", ONE(antenna.azimuth_beam), BETWEEN(LM_RADAR_BEAM_MIN, FX_BAM_DEG(20)),
     IN(BAM)},
    {"antenna.elevation_beam", ONE(antenna.elevation_beam),
     BETWEEN(LM_RADAR_BEAM_MIN, FX_BAM_DEG(60)), IN(BAM)},
    {"antenna.fan", ONE(antenna.fan), BETWEEN(0, FX_BAM_DEG(60)), IN(BAM)},
    {"antenna.bar_spacing", ONE(antenna.bar_spacing), BETWEEN(0, FX_BAM_DEG(10)), IN(BAM)},
    {"antenna.azimuth_limit", ONE(antenna.azimuth_limit), BETWEEN(1 << 20, LM_RADAR_AZIMUTH_MAX),
     IN(BAM)},
    {"antenna.tilt_max", ONE(antenna.tilt_max), BETWEEN(0, FX_BAM_DEG(60)), IN(BAM)},
    {"receiver.noise_looks_log2", ONE(receiver.noise_looks_log2), BETWEEN(0, LM_LOOKS_LOG2_MAX)},
    {"receiver.noise_db_q8", ONE(receiver.noise_db_q8),
     SIGNED_BETWEEN(LM_DB_Q8(-100), LM_DB_Q8(20)), IN(DB_Q8)},
    {"receiver.noise_range_m", ONE(receiver.noise_range_m), BETWEEN(1852, LM_RADAR_RANGE_MAX_M),
     IN(M)},
    {"receiver.noise_height_m", ONE(receiver.noise_height_m), BETWEEN(0, 30000), IN(M)},
    {"receiver.noise_pulse_ns", ONE(receiver.noise_pulse_ns), BETWEEN(10, 100000), IN(NS)},
    {"receiver.air_loss_db_per_km_q16", ONE(receiver.air_loss_db_per_km_q16), BETWEEN(0, 1 << 14),
     IN(DB_PER_KM_Q16)},
    {"mode.bam_per_s", OF_MODES(bam_per_s), BETWEEN(LM_RADAR_RATE_MIN, LM_RADAR_RATE_MAX),
     IN(BAM_PER_S)},
    {"mode.range_max_nm", OF_MODES(range_max_nm), BETWEEN(1, 999), IN(NMI)},
    {"mode.fov_last", OF_MODES(fov_last), BETWEEN(0, LM_FOVS - 1)},
    {"mode.bars", OF_MODES(bars), BETWEEN(1, 8)},
    {"mode.stretch_cells", OF_MODES(stretch_cells), BETWEEN(0, 4)},
    {"mode.clutter_db_q8", OF_MODES(clutter_db_q8), BETWEEN(0, LM_DB_Q8(64)), IN(DB_Q8)},
    {"mode.gate_mm_s[0]", OF_MODES(gate_mm_s[0]), BETWEEN(0, LM_RADAR_SPEED_MAX_MM_S), IN(MM_S)},
    {"mode.gate_mm_s[1]", OF_MODES(gate_mm_s[1]), BETWEEN(0, LM_RADAR_SPEED_MAX_MM_S), IN(MM_S)},
    {"mode.tone.black_db_q8", OF_MODES(tone.black_db_q8),
     SIGNED_BETWEEN(LM_DB_Q8(-64), LM_DB_Q8(64)), IN(DB_Q8)},
    {"mode.tone.white_db_q8", OF_MODES(tone.white_db_q8),
     SIGNED_BETWEEN(LM_DB_Q8(-64), LM_DB_Q8(64)), IN(DB_Q8)},
    {"mode.tone.gamma_q8", OF_MODES(tone.gamma_q8), BETWEEN(64, LM_TONE_GAMMA_MAX_Q8), IN(Q8)},
    {"fov.bam_per_s", OF_FIELDS(bam_per_s), BETWEEN(0, LM_RADAR_RATE_MAX), IN(BAM_PER_S)},
    {"fov.range_max_nm", OF_FIELDS(range_max_nm), BETWEEN(1, 999), IN(NMI)},
    {"fov.slew_percent", OF_FIELDS(slew_percent), BETWEEN(1, 200), IN(PERCENT)},
    {"fov[NORM].window_permille", ONE(fov[LM_FOV_NORM].window_permille), BETWEEN(0, 0),
     IN(PERMILLE)},
    {"fov[EXP..].window_permille", OF_WINDOWS(window_permille), BETWEEN(5, 250), IN(PERMILLE)},
    {"fov.azimuth_half_max", OF_FIELDS(azimuth_half_max), BETWEEN(0, LM_RADAR_AZIMUTH_MAX),
     IN(BAM)},
    {"fov.sharpening", OF_FIELDS(sharpening), BETWEEN(1, LM_RADAR_SHARPENING_MAX)},
    {"fov.beam_step", OF_FIELDS(beam_step), BETWEEN(0, FX_BAM_DEG(20)), IN(BAM)},
    {"fov.azimuths_log2", OF_FIELDS(azimuths_log2), BETWEEN(0, LM_RADAR_AZIMUTHS_LOG2_MAX)},
    {"fov.ground_leak_db_q8", OF_FIELDS(ground_leak_db_q8), SIGNED_BETWEEN(LM_DB_Q8(-100), 0),
     IN(DB_Q8)},
    {"sar.cells", ONE(sar.cells), BETWEEN(32, LM_RADAR_PATCH_CELLS_MAX)},
    {"sar.cell_min_mm", ONE(sar.cell_min_mm), BETWEEN(100, 100000), IN(MM)},
    {"sar.cell_max_mm", ONE(sar.cell_max_mm), BETWEEN(100, 100000), IN(MM)},
    {"sar.squint_min", ONE(sar.squint_min), BETWEEN(0, FX_BAM_DEG(80)), IN(BAM)},
    {"sar.dwell_max_ms", ONE(sar.dwell_max_ms), BETWEEN(1, (1 << 17) - 1), IN(MS)},
    {"sar.reference_speed_mm_s", ONE(sar.reference_speed_mm_s),
     BETWEEN(1000, LM_RADAR_SPEED_MAX_MM_S), IN(MM_S)},
    {"sar.mocomp_residual_permille", ONE(sar.mocomp_residual_permille), BETWEEN(0, 1000),
     IN(PERMILLE)},
    {"sar.noise_floor_db_q8", ONE(sar.noise_floor_db_q8),
     SIGNED_BETWEEN(LM_DB_Q8(-100), LM_DB_Q8(20)), IN(DB_Q8)},
    {"sar.line_lobe", ONE(sar.line_lobe), BETWEEN(1 << 20, FX_BAM_90), IN(BAM)},
    {"sar.ground_leak_db_q8", ONE(sar.ground_leak_db_q8), SIGNED_BETWEEN(LM_DB_Q8(-100), 0),
     IN(DB_Q8)},
    {"sar.ground_leak_most_db_q8", ONE(sar.ground_leak_most_db_q8),
     SIGNED_BETWEEN(LM_DB_Q8(-60), LM_DB_Q8(20)), IN(DB_Q8)},
    {"sar.side_lobes.over_shadow_db_q8", ONE(sar.side_lobes.over_shadow_db_q8),
     SIGNED_BETWEEN(0, LM_DB_Q8(100)), IN(DB_Q8)},
    {"sar.side_lobes.above_db_q8", ONE(sar.side_lobes.above_db_q8),
     SIGNED_BETWEEN(0, LM_DB_Q8(100)), IN(DB_Q8)},
    {"sar.side_lobes.a_line", ONE(sar.side_lobes.a_line), BETWEEN(0, LM_RADAR_SIDE_LOBES_MAX)},
    {"sar.speckle.looks_log2", ONE(sar.speckle.looks_log2), BETWEEN(0, LM_LOOKS_LOG2_MAX)},
    {"sar.tone.black_db_q8", ONE(sar.tone.black_db_q8), SIGNED_BETWEEN(LM_DB_Q8(-64), LM_DB_Q8(64)),
     IN(DB_Q8)},
    {"sar.tone.white_db_q8", ONE(sar.tone.white_db_q8), SIGNED_BETWEEN(LM_DB_Q8(-64), LM_DB_Q8(64)),
     IN(DB_Q8)},
    {"sar.tone.gamma_q8", ONE(sar.tone.gamma_q8), BETWEEN(64, LM_TONE_GAMMA_MAX_Q8), IN(Q8)},
    {"illumination.edge_structure_db_q8", ONE(illumination.edge_structure_db_q8),
     SIGNED_BETWEEN(0, LM_EDGE_MAX_DB_Q8), IN(DB_Q8)},
    {"illumination.edge_trees_db_q8", ONE(illumination.edge_trees_db_q8),
     SIGNED_BETWEEN(0, LM_EDGE_MAX_DB_Q8), IN(DB_Q8)},
    {"illumination.shore_db_q8", ONE(illumination.shore_db_q8),
     SIGNED_BETWEEN(0, LM_EDGE_MAX_DB_Q8), IN(DB_Q8)},
    {"illumination.shore_width_m", ONE(illumination.shore_width_m), BETWEEN(0, 10000), IN(M)},
    {"sea.upwind_db_q8", ONE(sea.upwind_db_q8), OF_WIND, IN(DB_Q8)},
    {"sea.crosswind_db_q8", ONE(sea.crosswind_db_q8), OF_WIND, IN(DB_Q8)},
    {"sea.downwind_db_q8", ONE(sea.downwind_db_q8), OF_WIND, IN(DB_Q8)},
    {"facing.lobe_half", ONE(facing.lobe_half), BETWEEN(FX_BAM_DEG(4), FX_BAM_DEG(45)), IN(BAM)},
    {"facing.floor_permille", ONE(facing.floor_permille), BETWEEN(10, 1000), IN(PERMILLE)},
};
enum { FIELDS = sizeof fields / sizeof *fields };

const struct lm_radar_field *lm_radar_field(uint32_t number)
{
    return number < FIELDS ? &fields[number] : NULL;
}

int64_t lm_radar_field_value(const struct lm_radar *radar, const struct lm_radar_field *field,
                             uint32_t index)
{
    const uint8_t *at = (const uint8_t *)radar + field->offset + (size_t)index * field->stride;
    uint8_t one;
    uint16_t two;
    uint32_t four;
    if (field->size == sizeof one) {
        memcpy(&one, at, sizeof one);
        return one;
    }
    if (field->size == sizeof two) {
        memcpy(&two, at, sizeof two);
        return field->is_signed ? (int16_t)two : two;
    }
    memcpy(&four, at, sizeof four);
    return four;
}

void lm_radar_field_set(struct lm_radar *radar, const struct lm_radar_field *field, uint32_t index,
                        int64_t value)
{
    uint8_t *at = (uint8_t *)radar + field->offset + (size_t)index * field->stride;
    const uint8_t one = (uint8_t)value;
    const uint16_t two = (uint16_t)value;
    const uint32_t four = (uint32_t)value;
    if (field->size == sizeof one) {
        memcpy(at, &one, sizeof one);
    } else if (field->size == sizeof two) {
        memcpy(at, &two, sizeof two);
    } else {
        memcpy(at, &four, sizeof four);
    }
}

uint32_t lm_radar_field_count(const struct lm_radar *radar, const struct lm_radar_field *field)
{
    return field->is_of_scales ? fx_min_u32(radar->ranges, field->count) : field->count;
}

static bool is_in_range(const struct lm_radar *radar, const struct lm_radar_field *field,
                        uint32_t index)
{
    const int64_t value = lm_radar_field_value(radar, field, index);
    return value >= field->min && value <= field->max;
}

/* ---- rules between fields: each returns the index of the first element that breaks it, or HOLDS.
 * Called when every field is in its own range. ---- */

enum { HOLDS = UINT8_MAX };

static uint32_t check_scales(const struct lm_radar *r)
{
    for (uint32_t i = 1; i < r->ranges; i++) {
        const struct lm_range_row *before = &r->range[i - 1], *row = &r->range[i];
        if (row->range_m <= before->range_m || row->range_nm <= before->range_nm) {
            return i;
        }
    }
    return HOLDS;
}

static bool is_empty(const struct lm_radar *r, uint32_t row)
{
    for (uint32_t n = 0; n < FIELDS; n++) {
        if (fields[n].is_of_scales && lm_radar_field_value(r, &fields[n], row) != 0) {
            return false;
        }
    }
    return true;
}

/* A row behind the last in use is one that was not counted. */
static uint32_t check_count(const struct lm_radar *r)
{
    for (uint32_t i = r->ranges; i < LM_RANGES_MAX; i++) {
        if (!is_empty(r, i)) {
            return 0;
        }
    }
    return HOLDS;
}

static uint32_t check_mode_scales(const struct lm_radar *r)
{
    for (uint32_t i = 0; i < LM_SECTOR_MODES; i++) {
        if (r->mode[i].range_max_nm < r->range[0].range_nm) {
            return i;
        }
    }
    return HOLDS;
}

static uint32_t check_field_scales(const struct lm_radar *r)
{
    for (uint32_t i = 0; i < LM_FOVS; i++) {
        if (r->fov[i].range_max_nm < r->range[0].range_nm) {
            return i;
        }
    }
    return HOLDS;
}

static uint32_t check_start(const struct lm_radar *r)
{
    const int32_t start = lm_radar_find_range(r, r->range_start_nm);
    const uint32_t last = lm_radar_range_last(r, LM_SECTOR_GM, LM_FOV_NORM);
    return start >= 0 && (uint32_t)start <= last ? HOLDS : 0;
}

static bool is_letter(char c)
{
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '+' ||
           c == '-' || c == '.' || c == '/';
}

/* Nothing but zeros may follow the name: a table then has one form alone. */
static bool is_ended(const char *name, uint32_t length, uint32_t size)
{
    for (uint32_t i = length; i < size; i++) {
        if (name[i] != 0) {
            return false;
        }
    }
    return length > 0 && length < size;
}

static bool is_name(const char name[LM_NAME_SIZE])
{
    uint32_t length = 0;
    while (length < LM_NAME_SIZE && is_letter(name[length])) {
        length++;
    }
    return is_ended(name, length, LM_NAME_SIZE);
}

/* The radar's own name may have blanks between its words. */
static uint32_t check_name(const struct lm_radar *r)
{
    uint32_t length = 0;
    while (length < LM_RADAR_NAME_SIZE &&
           (is_letter(r->name[length]) || (length > 0 && r->name[length] == ' '))) {
        length++;
    }
    return is_ended(r->name, length, LM_RADAR_NAME_SIZE) && r->name[length - 1] != ' ' ? HOLDS : 0;
}

static uint32_t check_mode_names(const struct lm_radar *r)
{
    for (uint32_t i = 0; i < LM_SECTOR_MODES; i++) {
        if (!is_name(r->mode[i].name) || lm_radar_find_mode(r, r->mode[i].name) != (int32_t)i) {
            return i;
        }
    }
    return HOLDS;
}

static uint32_t check_field_names(const struct lm_radar *r)
{
    for (uint32_t i = 0; i < LM_FOVS; i++) {
        if (!is_name(r->fov[i].name) || lm_radar_find_fov(r, r->fov[i].name) != (int32_t)i) {
            return i;
        }
    }
    return HOLDS;
}

static uint32_t check_sectors(const struct lm_radar *r)
{
    for (uint32_t i = 0; i < LM_AZIMUTHS; i++) {
        if (r->azimuth_half[i] < r->line || r->azimuth_half[i] > r->antenna.azimuth_limit) {
            return i;
        }
    }
    return HOLDS;
}

/* Eight samples hold the beam: they lie 1/4 to 2/7 of it apart (lm/beam.h). */
static uint32_t check_sample(const struct lm_radar *r)
{
    const uint64_t beam = r->antenna.azimuth_beam, sample = r->sample;
    return 4 * sample >= beam && 7 * sample <= 2 * beam ? HOLDS : 0;
}

static uint32_t check_rates(const struct lm_radar *r)
{
    for (uint32_t i = 0; i < LM_FOVS; i++) {
        if (r->fov[i].bam_per_s != 0 && r->fov[i].bam_per_s < LM_RADAR_RATE_MIN) {
            return i;
        }
    }
    return HOLDS;
}

static uint32_t check_gates(const struct lm_radar *r)
{
    for (uint32_t i = 0; i < LM_SECTOR_MODES; i++) {
        const uint32_t *gate_mm_s = r->mode[i].gate_mm_s;
        if (gate_mm_s[1] != 0 && gate_mm_s[1] < gate_mm_s[0]) {
            return i;
        }
    }
    return HOLDS;
}

static bool is_window_of_tone(const struct lm_tone_config *tone)
{
    return tone->white_db_q8 - tone->black_db_q8 >= LM_DB_Q8(1);
}

static uint32_t check_tones(const struct lm_radar *r)
{
    for (uint32_t i = 0; i < LM_SECTOR_MODES; i++) {
        if (!is_window_of_tone(&r->mode[i].tone)) {
            return i;
        }
    }
    return HOLDS;
}

static uint32_t check_patch_tone(const struct lm_radar *r)
{
    return is_window_of_tone(&r->sar.tone) ? HOLDS : 0;
}

static uint32_t check_beam_steps(const struct lm_radar *r)
{
    for (uint32_t i = 0; i < LM_FOVS; i++) {
        if (r->fov[i].beam_step > r->antenna.azimuth_beam) {
            return i;
        }
    }
    return HOLDS;
}

/* Cells of the smallest window are a quarter of a metre long or longer; the scales rise. */
static uint32_t check_windows(const struct lm_radar *r)
{
    for (uint32_t i = LM_FOV_NORM + 1; i < LM_FOVS; i++) {
        const uint32_t half_m = r->range[0].range_m * r->fov[i].window_permille / 1000;
        if (2 * half_m * 4 < r->cells) {
            return i;
        }
    }
    return HOLDS;
}

static uint32_t check_window_sectors(const struct lm_radar *r)
{
    for (uint32_t i = LM_FOV_NORM + 1; i < LM_FOVS; i++) {
        if (r->fov[i].azimuth_half_max < r->line) {
            return i;
        }
    }
    return HOLDS;
}

static uint32_t check_patch_cells(const struct lm_radar *r)
{
    return r->sar.cell_min_mm <= r->sar.cell_max_mm ? HOLDS : 0;
}

static const struct rule {
    const char *field; /* that is named when it breaks */
    uint32_t (*check)(const struct lm_radar *radar);
    const char *needs; /* what it asks for, in words */
} rules[] = {
    {"name", check_name, "1 to 7 letters, digits, + - . / and blanks, none of these at an end"},
    {"range.range_m", check_scales, "each scale longer than the one before, in nautical miles too"},
    {"ranges", check_count, "rows behind the last scale empty"},
    {"mode.name", check_mode_names,
     "1 to 5 letters, digits and + - . /, and a name of its own for each mode"},
    {"fov.name", check_field_names,
     "1 to 5 letters, digits and + - . /, and a name of its own for each field of view"},
    {"mode.range_max_nm", check_mode_scales, "the smallest scale in every mode"},
    {"fov.range_max_nm", check_field_scales, "the smallest scale in every field of view"},
    {"range_start_nm", check_start, "a scale of the table that the first mode has"},
    {"azimuth_half", check_sectors,
     "a sector at least a line wide to each side, within antenna.azimuth_limit"},
    {"sample", check_sample, "1/4 to 2/7 of antenna.azimuth_beam"},
    {"mode.gate_mm_s[1]", check_gates, "0, or not below the lower speed of the gate"},
    {"mode.tone.white_db_q8", check_tones, "1 dB or more above black"},
    {"fov.bam_per_s", check_rates, "0, or LM_RADAR_RATE_MIN (0.7 degree a second) and more"},
    {"fov.window_permille", check_windows,
     "cells of the window 1/4 m long or longer on the smallest scale"},
    {"fov.azimuth_half_max", check_window_sectors, "a line or more, save in the first field"},
    {"fov.beam_step", check_beam_steps, "no more than antenna.azimuth_beam"},
    {"sar.cell_max_mm", check_patch_cells, "no less than sar.cell_min_mm"},
    {"sar.tone.white_db_q8", check_patch_tone, "1 dB or more above black"},
};
enum { RULES = sizeof rules / sizeof *rules };

static int refuse(struct lm_radar_fault *fault, const char *field, uint32_t index,
                  const char *needs)
{
    if (fault) {
        *fault = (struct lm_radar_fault){field, index, needs};
    }
    return LM_ERR_TABLE;
}

int lm_radar_check(const struct lm_radar *radar, struct lm_radar_fault *fault)
{
    for (uint32_t n = 0; n < FIELDS; n++) {
        for (uint32_t i = 0; i < lm_radar_field_count(radar, &fields[n]); i++) {
            if (!is_in_range(radar, &fields[n], i)) {
                return refuse(fault, fields[n].name, i, NULL);
            }
        }
    }
    for (uint32_t n = 0; n < RULES; n++) {
        const uint32_t index = rules[n].check(radar);
        if (index != HOLDS) {
            return refuse(fault, rules[n].field, index, rules[n].needs);
        }
    }
    return LM_OK;
}
