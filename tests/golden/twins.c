/* Checksums of what loops give that have a form of their own for the vectors of 64-bit Arm, on
 * input drawn at random. A PC, which runs their twins in plain C, and an Arm must print the same
 * (test_golden_arm64.sh); that the plain ones are right is for the unit tests. */
#include "fx/crc32c.h"
#include "fx/sat.h"
#include "hs/rng.h"
#include "lm/aspect.h"
#include "lm/beam.h"
#include "lm/footprint.h"
#include "lm/horizon.h"
#include "lm/receiver.h"
#include "lm/slant.h"
#include "lm/speckle.h"
#include "lm/tile_read.h"
#include "lm/tone.h"

#include <stdio.h>

enum { ROUNDS = 300 };

/* A tile of whatever numbers lm_tile_check lets pass. */
static void draw_tile(struct hs_rng *rng, struct lm_tile *tile)
{
    for (int i = 0; i < LM_TILE_POSTS * LM_TILE_POSTS; i++) {
        const uint16_t any = (uint16_t)hs_rng_u64(rng);
        struct lm_tile_point *point = &tile->points[i / LM_TILE_POSTS][i % LM_TILE_POSTS];
        point->post = any % 16 == 0 ? 0 : any % 16 == 1 ? UINT16_MAX : any;
        point->cell = (uint16_t)hs_rng_u64(rng);
    }
    tile->base_q6 = (int32_t)hs_rng_below(rng, 1 << 21) - (1 << 20);
    tile->post_shift = (uint8_t)hs_rng_below(rng, LM_TILE_POST_SHIFT_MAX + 1);
}

/* A number of any size; one call after the other, for the two compilers must draw the same. */
static uint32_t draw_number(struct hs_rng *rng, uint32_t sizes)
{
    const uint32_t any = (uint32_t)hs_rng_u64(rng);
    return any >> hs_rng_below(rng, sizes);
}

static struct lm_track draw_track(struct hs_rng *rng)
{
    struct lm_track t;
    t.at = draw_number(rng, 1);
    t.step = draw_number(rng, 16);
    t.half_bend = draw_number(rng, 32);
    return t;
}

/* Runs of a line in tiles of a pool, then the line. */
static uint32_t of_tile_read(void)
{
    enum { TILES = 3 };
    static struct lm_tile pool[TILES];
    static struct lm_scan_line line;
    struct hs_rng rng;
    uint32_t crc = 0;
    hs_rng_seed(&rng, 1);
    for (int i = 0; i < ROUNDS; i++) {
        struct lm_places places;
        places.north = draw_track(&rng);
        places.east = draw_track(&rng);
        const uint32_t first = hs_rng_below(&rng, 20);
        uint32_t end = first;
        draw_tile(&rng, &pool[hs_rng_below(&rng, TILES)]);
        while (end < LM_CELLS_MAX && hs_rng_below(&rng, 8) != 0) {
            const uint32_t from = end;
            end = fx_min_u32(end + 1 + hs_rng_below(&rng, 200), LM_CELLS_MAX);
            const struct lm_tile_base tile =
                lm_tile_base_of(pool, &pool[hs_rng_below(&rng, TILES)]);
            for (uint32_t k = from; k < end; k++) {
                line.cell[k] = tile.record;
                line.elevation_q14[k] = tile.scale;
            }
        }
        lm_tile_read(pool, &places, first, end, &line);
        const uint32_t count = end - first;
        crc = fx_crc32c(crc, line.cell + first, count * sizeof *line.cell);
        crc = fx_crc32c(crc, line.elevation_q14 + first, count * sizeof *line.elevation_q14);
    }
    return crc;
}

/* Texture of classes of any kind, and speckle over a floor. */
static uint32_t of_speckle(void)
{
    static uint32_t cell[LM_CELLS_ROOM];
    static int32_t level_q8[LM_CELLS_ROOM], speckled_q8[LM_CELLS_ROOM];
    static struct lm_classes classes;
    struct hs_rng rng;
    uint32_t crc = 0;
    hs_rng_seed(&rng, 3);
    for (int i = 0; i < ROUNDS; i++) {
        struct lm_texture texture;
        const struct lm_texture_config shapes = {{LM_TEXTURE_NONE, 0, 1, 4}};
        const struct lm_speckle_config looks = {(uint8_t)hs_rng_below(&rng, 5)};
        const uint32_t cells = 1 + hs_rng_below(&rng, LM_CELLS_MAX);
        for (int k = 0; k < LM_DB_CLASSES; k++) {
            classes.entry[k].kind = (uint8_t)hs_rng_below(&rng, LM_KINDS);
        }
        for (uint32_t k = 0; k < cells; k++) {
            cell[k] = (uint32_t)hs_rng_u64(&rng) & 0xffff;
            level_q8[k] = (int32_t)hs_rng_below(&rng, 1 << 16) - (1 << 15);
        }
        lm_texture_set(&texture, &shapes, &classes, (uint8_t)hs_rng_below(&rng, 9),
                       (uint16_t)(i % 2 * 35 * 256));
        struct lm_raster ground = {.epoch = (uint32_t)i};
        ground.column_q32 = hs_rng_u64(&rng);
        ground.growth_q32 = draw_number(&rng, 32);
        const struct lm_raster samples = lm_raster_of(LM_NOISE_SPECKLE, (uint32_t)i, 1);
        lm_texture_run(&texture, &ground, cell, level_q8, cells);
        lm_speckle_floor_run(&looks, (int32_t)hs_rng_below(&rng, 1 << 15) - (1 << 14), &samples,
                             level_q8, speckled_q8, cells);
        lm_speckle_run(&looks, &ground, speckled_q8, cells);
        crc = fx_crc32c(crc, level_q8, cells * sizeof *level_q8);
        crc = fx_crc32c(crc, speckled_q8, cells * sizeof *speckled_q8);
    }
    return crc;
}

static void draw_legend(struct hs_rng *rng, struct lm_legend *legend,
                        struct lm_aspect_config *config)
{
    static struct lm_classes classes;
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        classes.entry[i].kind = (uint8_t)hs_rng_below(rng, LM_KINDS);
        classes.height_dm[i] = (uint16_t)(draw_number(rng, 16) >> 16);
    }
    config->edge_structure_q8 = (int16_t)hs_rng_below(rng, 4096);
    config->edge_trees_q8 = (int16_t)hs_rng_below(rng, 32768);
    config->shore_q8 = (int16_t)hs_rng_below(rng, 4096);
    config->shore_width_m = (uint16_t)hs_rng_below(rng, 2000);
    lm_legend_set(legend, config, &classes);
}

/* Ground as rough as a cell is long, and now and then any; classes in runs. */
static void draw_ground(struct hs_rng *rng, struct lm_scan_line *line, uint32_t cell_q8)
{
    const bool is_wild = hs_rng_below(rng, 4) == 0;
    uint32_t low_bits = (uint32_t)hs_rng_u64(rng);
    int32_t elevation_q14 = 0;
    for (uint32_t i = 0; i < LM_CELLS_ROOM; i++) {
        const uint32_t any = (uint32_t)hs_rng_u64(rng);
        low_bits = any % 5 == 0 ? any >> 8 : low_bits;
        elevation_q14 = is_wild
                            ? (int32_t)hs_rng_below(rng, 48000u << 14) - (16000 << 14)
                            : elevation_q14 % (1 << 26) + (int32_t)hs_rng_below(rng, 32 * cell_q8) -
                                  (int32_t)(16 * cell_q8);
        line->cell[i] = (any >> 16 & 0xFF00) | (low_bits & 0xFF);
        line->elevation_q14[i] = elevation_q14;
    }
}

static uint32_t of_aspect(void)
{
    static struct lm_range_grid grid;
    static struct lm_scan_line line;
    static struct lm_sight sight;
    struct hs_rng rng;
    uint32_t crc = 0;
    hs_rng_seed(&rng, 3);
    for (int i = 0; i < ROUNDS; i++) {
        struct lm_legend legend;
        struct lm_aspect_config config;
        const uint32_t cells = 1 + hs_rng_below(&rng, LM_CELLS_MAX);
        const uint32_t cell_q8 = 128u << hs_rng_below(&rng, 10);
        const uint32_t first_q8 = cell_q8 + hs_rng_below(&rng, 60000 * 256);
        const int32_t height_q10 = (int32_t)hs_rng_below(&rng, 60000 * 1024) - 30000 * 1024;
        draw_legend(&rng, &legend, &config);
        draw_ground(&rng, &line, cell_q8);
        lm_range_grid_set(&grid, &config, first_q8, cell_q8, cells, height_q10, 0);
        const lm_horizon_q40_t start =
            hs_rng_below(&rng, 2) ? LM_HORIZON_OPEN : (int64_t)hs_rng_u64(&rng) >> 23;
        const lm_horizon_q40_t end = lm_aspect_run(&grid, &legend, &line, start, &sight);
        crc = fx_crc32c(crc, sight.horizon, (cells + 1) * sizeof *sight.horizon);
        crc = fx_crc32c(crc, sight.level_q8, cells * sizeof *sight.level_q8);
        crc = fx_crc32c(crc, &end, sizeof end);
        const lm_horizon_q40_t behind = lm_horizon_behind(&grid, &legend, &line);
        crc = fx_crc32c(crc, &behind, sizeof behind);
    }
    return crc;
}

/* Bins of a short pulse, some without any power. */
static uint32_t of_receiver(void)
{
    static struct lm_receiver receiver;
    static struct lm_weather weather;
    static uint32_t power_q24[LM_CELLS_ROOM];
    static int32_t level_q8[LM_CELLS_ROOM];
    struct hs_rng rng;
    uint32_t crc = 0;
    hs_rng_seed(&rng, 5);
    for (int i = 0; i < ROUNDS; i++) {
        receiver.cells = 1 + hs_rng_below(&rng, LM_CELLS_MAX);
        receiver.looks_log2 = (uint8_t)hs_rng_below(&rng, LM_NOISE_LOOKS_LOG2_MAX + 1);
        weather.noise_rise_q8 = (int32_t)hs_rng_below(&rng, 40 * 256);
        for (uint32_t k = 0; k < receiver.cells; k++) {
            receiver.noise_q8[k] = (int32_t)hs_rng_below(&rng, 1 << 15) - (1 << 14);
            receiver.fall_q8[k] = (int32_t)hs_rng_below(&rng, 1 << 12);
            power_q24[k] = hs_rng_below(&rng, 8) ? draw_number(&rng, 32) : 0;
        }
        lm_receiver_run(&receiver, &weather, (uint32_t)i, 7, power_q24, level_q8);
        crc = fx_crc32c(crc, level_q8, receiver.cells * sizeof *level_q8);
    }
    return crc;
}

/* Windows of any width, with every gamma; levels in them, beside them, and beyond 16 bits. */
static uint32_t of_tone(void)
{
    static struct lm_tone tone;
    static int32_t level_q8[LM_CELLS_ROOM];
    static uint8_t grey[LM_CELLS_ROOM];
    struct hs_rng rng;
    uint32_t crc = 0;
    hs_rng_seed(&rng, 6);
    for (int i = 0; i < ROUNDS; i++) {
        const uint32_t cells = 1 + hs_rng_below(&rng, LM_CELLS_MAX);
        const uint32_t widest_q8 = 255u * 256u >> hs_rng_below(&rng, 8);
        const int32_t span_q8 = fx_max_i32((int32_t)hs_rng_below(&rng, widest_q8 + 1), 256);
        const int32_t black_q8 = (int32_t)hs_rng_below(&rng, 65536u - (uint32_t)span_q8) - 32768;
        const struct lm_tone_config config = {(int16_t)black_q8, (int16_t)(black_q8 + span_q8),
                                              (uint16_t)(26 + hs_rng_below(&rng, 999))};
        if (lm_tone_set(&tone, &config) != 0) {
            return 0;
        }
        for (uint32_t k = 0; k < cells; k++) {
            const int32_t any = (int32_t)hs_rng_u64(&rng), place_q15 = any & 0x7fff;
            level_q8[k] =
                k % 8 == 0 ? any >> k % 24 : black_q8 - 500 + (place_q15 * (span_q8 + 1000) >> 15);
        }
        lm_tone_run(&tone, level_q8, grey, cells);
        crc = fx_crc32c(crc, grey, cells);
    }
    return crc;
}

/* Bins of cells of any level, some of which cover more than one. */
static uint32_t of_slant(void)
{
    static struct lm_slant slant;
    static struct lm_range_grid grid;
    static int32_t level_q8[LM_CELLS_ROOM];
    static uint32_t power_q24[LM_CELLS_ROOM];
    struct hs_rng rng;
    uint32_t crc = 0;
    hs_rng_seed(&rng, 7);
    for (int i = 0; i < ROUNDS; i++) {
        const uint32_t cells = 1 + hs_rng_below(&rng, LM_CELLS_MAX);
        const uint32_t cell_q8 = 256 + hs_rng_below(&rng, 100 * 256);
        const int32_t height_q10 = (int32_t)hs_rng_below(&rng, 12000 * 1024);
        grid = (struct lm_range_grid){.cells = cells, .cell_q8 = cell_q8, .height_q10 = height_q10};
        lm_slant_set(&slant, cell_q8 / 2, cell_q8, cells, &grid, cell_q8 / 2);
        for (uint32_t k = 0; k < cells; k++) {
            const int32_t any = (int32_t)hs_rng_u64(&rng);
            level_q8[k] = any >> (k % 8 == 0 ? 14 : 18);
        }
        lm_slant_run(&slant, &grid, level_q8, power_q24);
        crc = fx_crc32c(crc, power_q24, cells * sizeof *power_q24);
    }
    return crc;
}

/* Azimuths of any level, shadows among them. */
static uint32_t of_footprint(void)
{
    static struct lm_footprint footprint;
    static int32_t level_q8[LM_CELLS_ROOM];
    struct hs_rng rng;
    uint32_t crc = 0;
    hs_rng_seed(&rng, 8);
    for (int i = 0; i < ROUNDS; i++) {
        const uint32_t cells = 1 + hs_rng_below(&rng, LM_CELLS_MAX);
        for (int turn = 0; turn < 4; turn++) {
            for (uint32_t k = 0; k < cells; k++) {
                const int32_t any = (int32_t)hs_rng_u64(&rng);
                level_q8[k] = any % 8 == 0 ? LM_LEVEL_SHADOW : any >> (14 + k % 8);
            }
            if (turn == 0) {
                lm_footprint_begin(&footprint, level_q8, cells);
            } else if (turn < 3) {
                lm_footprint_add(&footprint, level_q8, cells);
            }
        }
        lm_footprint_mean(&footprint, 2, level_q8, cells);
        crc = fx_crc32c(crc, level_q8, cells * sizeof *level_q8);
    }
    return crc;
}

/* Looks wherever they may fall in the ring, at powers of any size. */
static uint32_t of_beam(void)
{
    static struct lm_beam beam;
    static uint32_t power_q24[LM_CELLS_ROOM];
    struct hs_rng rng;
    uint32_t crc = 0;
    hs_rng_seed(&rng, 9);
    for (int i = 0; i < ROUNDS; i++) {
        struct lm_beam_look look;
        const uint32_t cells = 1 + hs_rng_below(&rng, LM_CELLS_MAX);
        const int32_t azimuth = (int32_t)hs_rng_u64(&rng) >> 2;
        lm_beam_aim(&beam, &lm_radar_default, azimuth, 256u << hs_rng_below(&rng, 9), &look);
        for (uint32_t k = 0; k < LM_BEAM_TAPS * cells; k++) {
            beam.power_q24[k / cells][k % cells] = draw_number(&rng, 32);
        }
        lm_beam_sum(&beam, &look, power_q24, cells);
        crc = fx_crc32c(crc, power_q24, cells * sizeof *power_q24);
    }
    return crc;
}

int main(void)
{
    printf("tile_read %08x\n", (unsigned)of_tile_read());
    printf("speckle %08x\n", (unsigned)of_speckle());
    printf("aspect %08x\n", (unsigned)of_aspect());
    printf("receiver %08x\n", (unsigned)of_receiver());
    printf("tone %08x\n", (unsigned)of_tone());
    printf("slant %08x\n", (unsigned)of_slant());
    printf("footprint %08x\n", (unsigned)of_footprint());
    printf("beam %08x\n", (unsigned)of_beam());
    return 0;
}
