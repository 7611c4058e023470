/* The wind over the sea in whole pictures: sectors and patches of nothing but water, measured
 * before the tone. The law is that of the reference: docs/EQUATIONS.md, "Sea". */
#include "check.h"
#include "hs/angle.h"
#include "lm/sar.h"
#include "reference_support.h"
#include "scales.h"
#include "sector_world.h"

#include <math.h>
#include <stdlib.h>

static struct tiny_cell sea(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    (void)p;
    return (struct tiny_cell){-40, TINY_WATER, 0};
}

static struct tiny_spec open_sea(uint8_t shift0)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.cell = sea;
    spec.shift0 = shift0;
    spec.rows = spec.columns = 9;
    return spec;
}

static double wind_db(const struct lm_radar *radar, double off_deg)
{
    const struct ref_sea wind = {.upwind_db = decibels(radar->sea.upwind_db_q8),
                                 .crosswind_db = decibels(radar->sea.crosswind_db_q8),
                                 .downwind_db = decibels(radar->sea.downwind_db_q8)};
    return ref_sea_wind_db(off_deg, &wind);
}

enum { SECTORS = 8, SECTOR_DEG = 15 };

/* Mean levels of eight parts of a sweep over a rough sea, from the left. */
static void take_sweep(struct sector_world *w, const struct lm_environment *e,
                       double level_db[SECTORS])
{
    const struct lm_sector_command command = {.mode = LM_SECTOR_SEA, .range_index = scale_of(10)};
    double sum[SECTORS] = {0}, count[SECTORS] = {0};
    start_sector(w, &command, e, NULL);
    do {
        const uint32_t line = draw_line(w);
        const int part = (int)((line_azimuth_deg(&w->sector, line) + 60) / SECTOR_DEG);
        for (uint32_t i = 80; i < 120; i++) {
            sum[part] += pow(10, w->sector.level_db_q8[i] / 2560.0);
            count[part]++;
        }
    } while (!lm_sector_is_at_edge(&w->sector));
    for (int part = 0; part < SECTORS; part++) {
        level_db[part] = 10 * log10(sum[part] / count[part]);
    }
}

TEST(a_sector_of_sea_is_as_bright_as_the_wind_makes_each_look)
{
    const struct tiny_spec spec = open_sea(13);
    struct sector_world *w = make_sector_world(&spec);
    w->platform =
        (struct lm_platform){.position = {w->map.db.centre_latitude, w->map.db.centre_longitude},
                             .height_m_q10 = 2000 * 1024};
    for (int wind_deg = 0; wind_deg < 360; wind_deg += 45) {
        const struct lm_environment calm = {.sea_state = 6};
        const struct lm_environment windy = {
            .sea_state = 6, .has_wind = true, .wind_from = hs_bam(wind_deg)};
        double without_db[SECTORS], with_db[SECTORS];
        take_sweep(w, &calm, without_db);
        take_sweep(w, &windy, with_db);
        for (int part = 0; part < SECTORS; part++) {
            const double look_deg = (part + 0.5) * SECTOR_DEG - 60;
            const double wanted_db = wind_db(&w->radar, look_deg - wind_deg);
            assert_true(fabs(with_db[part] - without_db[part] - wanted_db) < 0.4);
        }
    }
    free_sector_world(w);
}

/* Mean level of a patch of water, looked at from the south. */
static double patch_db(struct tiny_map *map, const struct lm_environment *e)
{
    static struct lm_sar sar;
    static struct lm_line line;
    static struct lm_tone tone;
    double sum = 0, count = 0;
    const struct lm_sar_command command = {
        .centre = {map->db.centre_latitude, map->db.centre_longitude},
        .cell_mm = 5000,
        .range_m = 15000,
        .height_m_q6 = 3000 * 64};
    const struct lm_sar_setup scene = {.sea_state = e->sea_state, .environment = e};
    assert_int_equal(lm_sar_start(&sar, &lm_radar_default, &map->db, &command, &scene), LM_OK);
    assert_int_equal(lm_tone_set(&tone, &lm_radar_default.sar.tone), LM_OK);
    for (uint32_t k = 0; k < sar.lines; k += 4) {
        lm_sar_prefetch(&sar, &map->tiles, k);
        tiny_map_read_tiles(map);
    }
    while (sar.line < sar.lines) {
        const int16_t *level_q8 = lm_sar_draw_line(&sar, &map->tiles, &tone, &line);
        for (uint32_t i = 40; i < 200; i++) {
            sum += pow(10, level_q8[i] / 2560.0);
            count++;
        }
    }
    return 10 * log10(sum / count);
}

TEST(a_patch_of_sea_is_as_bright_as_the_wind_makes_its_look)
{
    const struct tiny_spec spec = open_sea(10);
    static struct tiny_map map;
    tiny_map_open(&map, &spec, 128);
    const struct lm_environment calm = {.sea_state = 6};
    const double calm_db = patch_db(&map, &calm);
    for (int wind_deg = 0; wind_deg < 360; wind_deg += 30) {
        const struct lm_environment windy = {
            .sea_state = 6, .has_wind = true, .wind_from = hs_bam(wind_deg)};
        const double gain_db = patch_db(&map, &windy) - calm_db;
        print_message("# wind from %d degrees: %.2f dB\n", wind_deg, gain_db);
        assert_true(fabs(gain_db - wind_db(&lm_radar_default, -wind_deg)) < 0.3);
    }
    tiny_map_close(&map);
}
