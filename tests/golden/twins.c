/* Checksums of what loops give that have a form of their own for the vectors of 64-bit Arm, on
 * input drawn at random. A PC, which runs their twins in plain C, and an Arm must print the same
 * (test_golden_arm64.sh); that the plain ones are right is for the unit tests. */
#include "fx/crc32c.h"
#include "hs/rng.h"
#include "lm/scan_line.h"
#include "lm/speckle.h"

#include <stdio.h>

enum { ROUNDS = 300 };

/* A tile of whatever numbers lm_tile_check lets pass. */
static void draw_tile(struct hs_rng *rng, struct lm_tile *tile)
{
    uint16_t *cells = tile->cells[0], *posts = tile->posts[0];
    for (int i = 0; i < LM_TILE_CELLS * LM_TILE_CELLS; i++) {
        cells[i] = (uint16_t)hs_rng_u64(rng);
    }
    for (int i = 0; i < LM_TILE_POSTS * LM_TILE_POSTS; i++) {
        const uint16_t any = (uint16_t)hs_rng_u64(rng);
        posts[i] = any % 16 == 0 ? 0 : any % 16 == 1 ? UINT16_MAX : any;
    }
    tile->base_q6 = (int32_t)hs_rng_below(rng, 1 << 21) - (1 << 20);
    tile->post_shift = (uint8_t)hs_rng_below(rng, LM_TILE_POST_SHIFT_MAX + 1);
}

static struct lm_track draw_track(struct hs_rng *rng)
{
    const uint32_t step = (uint32_t)hs_rng_u64(rng), bend = (uint32_t)hs_rng_u64(rng);
    return (struct lm_track){(uint32_t)hs_rng_u64(rng), step >> hs_rng_below(rng, 16),
                             bend >> hs_rng_below(rng, 32)};
}

static uint32_t of_tile_read(void)
{
    static struct lm_tile tile;
    static uint32_t cell[LM_CELLS_ROOM];
    static int32_t elevation_q14[LM_CELLS_ROOM];
    struct hs_rng rng;
    uint32_t crc = 0;
    hs_rng_seed(&rng, 1);
    for (int i = 0; i < ROUNDS; i++) {
        draw_tile(&rng, &tile);
        const struct lm_track north = draw_track(&rng), east = draw_track(&rng);
        const uint32_t count = 1 + hs_rng_below(&rng, LM_CELLS_MAX);
        lm_tile_read(&tile, &north, &east, count, cell, elevation_q14);
        crc = fx_crc32c(crc, cell, count * sizeof *cell);
        crc = fx_crc32c(crc, elevation_q14, count * sizeof *elevation_q14);
    }
    return crc;
}

/* Noise alone: the map is empty. */
static uint32_t of_noise(void)
{
    static struct lm_db db = {.level_count = 1, .shift0 = 9};
    static struct lm_tile_cache tiles = {.db = &db, .reading_slot = LM_SLOT_NONE};
    static struct lm_scan_line line;
    struct hs_rng rng;
    uint32_t crc = 0;
    hs_rng_seed(&rng, 2);
    for (int i = 0; i < LM_TILE_HASH; i++) {
        tiles.heads[i] = LM_SLOT_NONE;
    }
    for (int i = 0; i < ROUNDS; i++) {
        const struct lm_sampling sampling = {.noise_shift = (uint8_t)hs_rng_below(&rng, 20),
                                             .epoch = (uint32_t)hs_rng_u64(&rng)};
        const struct lm_ground_path path = {hs_rng_u64(&rng) >> 3,  hs_rng_u64(&rng),
                                            hs_rng_u64(&rng) >> 24, hs_rng_u64(&rng) >> 24,
                                            hs_rng_u64(&rng) >> 36, hs_rng_u64(&rng) >> 36};
        const uint32_t cells = 1 + hs_rng_below(&rng, LM_CELLS_MAX);
        lm_scan_line_run(&line, &tiles, &sampling, &path, cells);
        crc = fx_crc32c(crc, line.noise, cells * sizeof *line.noise);
    }
    return crc;
}

/* Texture of classes of any kind, and speckle over a floor. */
static uint32_t of_speckle(void)
{
    static uint32_t cell[LM_CELLS_ROOM], noise[LM_CELLS_ROOM];
    static int32_t level_q8[LM_CELLS_ROOM], speckled_q8[LM_CELLS_ROOM];
    static struct lm_classes classes;
    struct hs_rng rng;
    uint32_t crc = 0;
    hs_rng_seed(&rng, 3);
    for (int i = 0; i < ROUNDS; i++) {
        struct lm_texture texture;
        const struct lm_texture_config shapes = {{LM_TEXTURE_NONE, LM_TEXTURE_NONE, 1, 4}};
        const struct lm_speckle_config looks = {(uint8_t)hs_rng_below(&rng, 5)};
        const uint32_t cells = 1 + hs_rng_below(&rng, LM_CELLS_MAX);
        for (int k = 0; k < LM_DB_CLASSES; k++) {
            classes.entry[k].kind = (uint8_t)hs_rng_below(&rng, LM_KINDS);
        }
        for (uint32_t k = 0; k < cells; k++) {
            cell[k] = (uint32_t)hs_rng_u64(&rng) & 0xffff;
            noise[k] = (uint32_t)hs_rng_u64(&rng);
            level_q8[k] = (int32_t)hs_rng_below(&rng, 1 << 16) - (1 << 15);
        }
        lm_texture_set(&texture, &shapes, &classes, (uint8_t)hs_rng_below(&rng, 9),
                       (uint16_t)(i % 2 * 35 * 256));
        lm_texture_run(&texture, cell, noise, level_q8, cells);
        lm_speckle_floor_run(&looks, (int32_t)hs_rng_below(&rng, 1 << 15) - (1 << 14), noise,
                             level_q8, speckled_q8, cells);
        crc = fx_crc32c(crc, level_q8, cells * sizeof *level_q8);
        crc = fx_crc32c(crc, speckled_q8, cells * sizeof *speckled_q8);
    }
    return crc;
}

int main(void)
{
    printf("tile_read %08x\n", (unsigned)of_tile_read());
    printf("noise %08x\n", (unsigned)of_noise());
    printf("speckle %08x\n", (unsigned)of_speckle());
    return 0;
}
