/* A unit with tables at the ends of what the contract allows and of random numbers inside them,
 * under the address and undefined-behaviour sanitizers: every field of view and a patch are drawn,
 * with targets and weather, and nothing overflows. A table may come from an image: its numbers are
 * as hostile as those of any file.
 *
 * SEED=n tries other tables, TABLES=n more of them. */
#include "check.h"
#include "lm/image.h"
#include "lm/radar_check.h"
#include "support.h"
#include "target_support.h"
#include "unit_rig.h"

#include "hs/rng.h"

#include <string.h>

enum { RANDOM_TABLES = 24 };
static const double FLIGHT_S = 0.06;

/* The default table with all the rows that there is room for. */
static struct lm_radar full_table(void)
{
    struct lm_radar table = lm_radar_default;
    for (uint32_t i = table.ranges; i < LM_RANGES_MAX; i++) {
        table.range[i] = table.range[i - 1];
    }
    return table;
}

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static uint32_t most(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* Scales rise; every mode and field of view has the first, and the start is the first. */
static void repair_scales(struct lm_radar *r)
{
    const uint32_t rows = r->ranges;
    for (uint32_t i = 1; i < rows; i++) {
        struct lm_range_row *row = &r->range[i], *before = &r->range[i - 1];
        row->range_m = most(row->range_m, before->range_m + 1);
        row->range_nm = (uint16_t)most(row->range_nm, before->range_nm + 1u);
    }
    for (uint32_t i = rows; i-- > 0;) {
        struct lm_range_row *row = &r->range[i];
        row->range_m = least(row->range_m, LM_RADAR_RANGE_MAX_M - (rows - i));
        row->range_nm = (uint16_t)least(row->range_nm, 999 - (rows - i));
    }
    memset(r->range + rows, 0, (LM_RANGES_MAX - rows) * sizeof *r->range);
    r->range_start_nm = r->range[0].range_nm;
    for (uint32_t i = 0; i < LM_SECTOR_MODES; i++) {
        r->mode[i].range_max_nm = (uint16_t)most(r->mode[i].range_max_nm, r->range_start_nm);
    }
    for (uint32_t i = 0; i < LM_FOVS; i++) {
        r->fov[i].range_max_nm = (uint16_t)most(r->fov[i].range_max_nm, r->range_start_nm);
    }
}

static void repair_angles(struct lm_radar *r)
{
    const uint32_t beam = r->antenna.azimuth_beam;
    r->sample = r->sample > beam / 4 ? beam / 7 * 2 : beam / 4 + 1;
    for (uint32_t i = 0; i < LM_AZIMUTHS; i++) {
        r->azimuth_half[i] = least(most(r->azimuth_half[i], r->line), r->antenna.azimuth_limit);
        r->line = least(r->line, r->antenna.azimuth_limit);
    }
}

static void repair_field(const struct lm_radar *r, uint32_t number, struct lm_fov_row *f)
{
    f->bam_per_s = f->bam_per_s ? most(f->bam_per_s, LM_RADAR_RATE_MIN) : 0;
    f->beam_step = least(f->beam_step, r->antenna.azimuth_beam);
    if (number != LM_FOV_NORM) {
        f->azimuth_half_max = most(f->azimuth_half_max, r->line);
        while (r->range[0].range_m * f->window_permille / 1000 * 8 < r->cells) {
            f->window_permille++;
        }
    }
}

static void repair_tone(struct lm_tone_config *tone)
{
    if (tone->white_db_q8 < tone->black_db_q8 + 256) {
        tone->black_db_q8 = (int16_t)(tone->black_db_q8 > 63 * 256 ? 63 * 256 : tone->black_db_q8);
        tone->white_db_q8 = (int16_t)(tone->black_db_q8 + 256);
    }
}

/* Move what a rule forbids to the nearest that it allows. */
static void repair(struct lm_radar *r)
{
    repair_scales(r);
    repair_angles(r);
    for (uint32_t i = 0; i < LM_FOVS; i++) {
        repair_field(r, i, &r->fov[i]);
    }
    for (uint32_t i = 0; i < LM_SECTOR_MODES; i++) {
        struct lm_sector_mode_row *m = &r->mode[i];
        m->gate_mm_s[0] =
            m->gate_mm_s[1] ? least(m->gate_mm_s[0], m->gate_mm_s[1]) : m->gate_mm_s[0];
        repair_tone(&m->tone);
    }
    repair_tone(&r->sar.tone);
    r->sar.cell_max_mm = most(r->sar.cell_max_mm, r->sar.cell_min_mm);
}

/* Every field of view that the mode has on its smallest scale and on its largest. */
static void draw_mode(struct rig *r, uint32_t mode)
{
    const struct lm_radar *radar = r->board.lent.radar;
    for (uint32_t n = 0; n < 2 * LM_FOVS; n++) {
        const uint32_t field = n / 2;
        const uint32_t scale = n % 2 ? lm_radar_range_last(radar, mode, field) : 0;
        if (field <= lm_radar_fov_last(radar, mode)) {
            const uint32_t lines = r->unit.count.lines;
            const int32_t smallest = radar->range[0].range_nm, nm = radar->range[scale].range_nm;
            command(r, (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = smallest});
            command(r, (struct lm_control){.kind = LM_CONTROL_SECTOR,
                                           .sector = {(int32_t)mode, (int32_t)field}});
            command(r, (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = nm});
            run(r, FLIGHT_S);
            assert_int_equal(r->unit.picture.sector.command.fov, field);
            assert_int_equal(r->unit.picture.sector.command.range_index, scale);
            assert_true(r->unit.count.lines > lines);
        }
    }
}

static void draw_patch(struct rig *r, uint32_t cell_mm)
{
    struct lm_control control = patch_here;
    control.sar = (struct lm_sar_command){.centre = patch_here.sar.centre,
                                          .cell_mm = cell_mm,
                                          .range_m = 60000,
                                          .height_m_q6 = 8000 * 64};
    const uint32_t refused = r->unit.count.commands_refused;
    command(r, control);
    run(r, 0.55); /* tiles are read for half a second at most */
    run(r, FLIGHT_S);
    assert_int_equal(r->unit.count.commands_refused, refused);
}

/* A section of targets round the middle of the image: still, moving, and of bodies. */
static void add_targets(struct rig *r, struct hs_rng *rng)
{
    enum { TARGETS = 4 };
    struct {
        struct lm_targets_head head;
        struct lm_target records[TARGETS];
    } section = {.head = {.count = TARGETS, .record_bytes = LM_TARGET_BYTES}};
    section.head.crc = fx_crc32c(0, &section.head, offsetof(struct lm_targets_head, crc));
    for (uint32_t i = 0; i < TARGETS; i++) {
        struct lm_target *t = &section.records[i];
        const double north = hs_rng_uniform(rng) * 0.02, east = hs_rng_uniform(rng) * 0.02;
        *t = i % 2 ? random_target(rng, 200000) : point_at(46, 11, 300, 60 - 20.0 * i);
        t->id = i;
        t->latitude = hs_bam(45.99 + north), t->longitude = hs_bam(10.99 + east);
        t->speed_mm_s = hs_rng_below(rng, 2) * hs_rng_below(rng, LM_TARGET_SPEED_MAX_MM_S);
        t->leg_m = t->speed_mm_s ? 1 + hs_rng_below(rng, 10000) : 0;
        seal_target(t);
    }
    assert_int_equal(tiny_image_add_section(&r->image, LM_IMAGE_TARGETS, &section, sizeof section),
                     0);
    memory_flash_open(&r->board.flash, r->image.bytes, r->image.size);
}

/* The worst that an environment may be, near the aircraft. */
static struct lm_environment random_weather(struct hs_rng *rng)
{
    struct lm_environment e = {.rain_count = LM_RAINS_MAX,
                               .jammer_count = LM_JAMMERS_MAX,
                               .sea_state = (uint8_t)hs_rng_below(rng, LM_SEA_STATE_MAX + 1),
                               .is_sea_commanded = true,
                               .has_wind = hs_rng_below(rng, 2) != 0,
                               .wind_from = (fx_bam_t)hs_rng_u64(rng)};
    for (uint32_t i = 0; i < LM_RAINS_MAX; i++) {
        const struct lm_position place = {hs_bam(45.9 + 0.2 * hs_rng_uniform(rng)),
                                          hs_bam(10.9 + 0.2 * hs_rng_uniform(rng))};
        e.rain[i] = (struct lm_rain){place, 100 + hs_rng_below(rng, 99901),
                                     (uint16_t)(1 + hs_rng_below(rng, 150))};
        e.jammer[i] =
            (struct lm_jammer){place, (int16_t)((int32_t)hs_rng_below(rng, 101 * 256) - 20 * 256)};
    }
    return e;
}

/* Fly with a table, low and high; with targets and weather where there is a source of them. */
static void fly(const struct lm_radar *table, double height_m, struct hs_rng *rng)
{
    struct lm_radar_fault fault = {"", 0, NULL};
    if (lm_radar_check(table, &fault) != LM_OK) {
        fail_msg("%s, element %u", fault.field, (unsigned)fault.index);
    }
    struct rig *r = make_rig();
    r->image.bytes[offsetof(struct lm_image_header, sensor)] = table->sensor;
    tiny_image_seal(&r->image);
    r->board.lent.radar = table;
    if (rng) {
        add_targets(r, rng);
        r->bus.speed_m_s = 1 + hs_rng_below(rng, 1400);
        r->bus.turn_deg_s = hs_rng_below(rng, 60) - 30.0;
    }
    r->bus.height_m = height_m;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    run(r, 0.1);
    if (rng) {
        command(r, (struct lm_control){.kind = LM_CONTROL_ENVIRONMENT,
                                       .environment = random_weather(rng)});
        command(r, (struct lm_control){.kind = LM_CONTROL_GAIN,
                                       .gain_db = (int32_t)hs_rng_below(rng, 61) - 30});
    }
    for (uint32_t mode = 0; mode < LM_SECTOR_CHOICES; mode++) {
        draw_mode(r, mode);
    }
    draw_patch(r, table->sar.cell_min_mm);
    draw_patch(r, table->sar.cell_max_mm);
    assert_true(r->unit.count.frames > 0);
    free_rig(r);
}

TEST(a_table_with_one_field_at_its_end_is_drawn)
{
    for (uint32_t n = 0; lm_radar_field(n); n++) {
        const struct lm_radar_field *f = lm_radar_field(n);
        for (uint32_t end = 0; end < 2; end++) {
            struct lm_radar table = full_table();
            for (uint32_t i = 0; i < f->count; i++) {
                lm_radar_field_set(&table, f, i, end == 0 ? f->min : f->max);
            }
            repair(&table);
            fly(&table, n % 2 ? 2000 : 12000, NULL);
        }
    }
}

TEST(tables_with_many_fields_at_their_ends_are_drawn)
{
    const uint32_t count = (uint32_t)support_number("TABLES", RANDOM_TABLES);
    struct hs_rng rng;
    hs_rng_seed(&rng, support_number("SEED", 1));
    for (uint32_t turn = 0; turn < count; turn++) {
        struct lm_radar table = full_table();
        for (uint32_t n = 0; lm_radar_field(n); n++) {
            const struct lm_radar_field *f = lm_radar_field(n);
            for (uint32_t i = 0; i < f->count; i++) {
                const uint32_t pick = hs_rng_below(&rng, turn < 2 ? 1 : 4);
                if (pick < 2) {
                    lm_radar_field_set(&table, f, i, (turn < 2 ? turn : pick) ? f->max : f->min);
                }
            }
        }
        repair(&table);
        fly(&table, 500 + 600.0 * (turn % RANDOM_TABLES), NULL);
    }
}

/* A number of the field's range: an end, any, or one near the lower end, where ranges over several
 * powers of ten have their small numbers. */
static int64_t random_number(struct hs_rng *rng, const struct lm_radar_field *f)
{
    const uint64_t span = (uint64_t)(f->max - f->min);
    switch (hs_rng_below(rng, 4)) {
    case 0:
        return hs_rng_below(rng, 2) ? f->max : f->min;
    case 1:
        return f->min + (int64_t)((hs_rng_u64(rng) >> hs_rng_below(rng, 63)) % (span + 1));
    default:
        return f->min + (int64_t)(hs_rng_u64(rng) % (span + 1));
    }
}

TEST(any_table_is_drawn_with_targets_in_any_weather)
{
    const uint32_t count = (uint32_t)support_number("TABLES", RANDOM_TABLES);
    struct hs_rng rng;
    hs_rng_seed(&rng, support_number("SEED", 2));
    for (uint32_t turn = 0; turn < count; turn++) {
        struct lm_radar table = full_table();
        for (uint32_t n = 0; lm_radar_field(n); n++) {
            const struct lm_radar_field *f = lm_radar_field(n);
            for (uint32_t i = 0; i < f->count; i++) {
                if (hs_rng_below(&rng, 4) != 0) {
                    lm_radar_field_set(&table, f, i, random_number(&rng, f));
                }
            }
        }
        repair(&table);
        fly(&table, 100 + hs_rng_below(&rng, 15000), &rng);
    }
}
