/* Chips of signatures: any pixels under any sound record, read as the unit reads them and laid into
 * a patch and a line from anywhere, over rough ground. The first numbers of the input are the
 * record and the look, the rest is the chip, over and over. */
#include "fuzz.h"
#include "lm/chip_sector.h"
#include "lm/target_patch.h"
#include "memory_flash.h"

#include "fx/crc32c.h"

const uint32_t fuzz_mutations = 2000;

enum { POLLS = 64, LINES = 24, CELLS = 132, STEPS_MOST = 200 };

struct world {
    struct lm_signature signature;
    struct lm_chip_source chip_source;
    struct lm_chip chip;
    struct memory_flash flash;
    struct lm_db db;
    struct lm_tile_cache tiles;
    struct lm_chips chips;
    struct lm_target target;
    struct lm_target_candidates near;
    struct lm_target_patch points;
    uint32_t cell_mm;
    fx_bam_t look;
    uint32_t range_q8;
};

static void take_signature(struct world *w, struct fuzz_supply *s)
{
    struct lm_signature *g = &w->signature;
    g->aspects = (uint16_t)(1 + fuzz_u8(s) % LM_SIGNATURE_ASPECTS_MAX);
    g->depressions = 1;
    g->depression[0] = 1 + fuzz_u32(s) % (FX_BAM_90 - 1);
    g->origin_row = fuzz_u8(s) % (LM_CHIP_SIDE + 1);
    g->pixel_mm = LM_SIGNATURE_PIXEL_MIN_MM +
                  fuzz_u16(s) % (LM_SIGNATURE_PIXEL_MAX_MM - LM_SIGNATURE_PIXEL_MIN_MM + 1);
    g->height_mm = fuzz_u32(s) % (LM_SIGNATURE_HEIGHT_MAX_MM + 1);
    g->crc = fx_crc32c(0, (const uint8_t *)g + 4, sizeof *g - 4);
    FUZZ_ASSERT(lm_signature_check(g, g->aspects) == LM_OK);
}

static void take_look(struct world *w, struct fuzz_supply *s)
{
    w->target = (struct lm_target){.latitude = fuzz_u32(s) % (FX_BAM_90 / 2),
                                   .longitude = fuzz_u32(s),
                                   .heading = fuzz_u32(s),
                                   .flags = LM_TARGET_HAS_SIGNATURE,
                                   .speed_mm_s = fuzz_u8(s) * 64u,
                                   .leg_m = 1};
    w->cell_mm = 500 + fuzz_u16(s) % 39500;
    w->look = fuzz_u32(s);
    w->range_q8 = (1000 + fuzz_u32(s) % 249000) * 256;
}

/* The one chip that is chosen stands for all of the signature's. */
static void take_chip(struct world *w, const struct fuzz_supply *s)
{
    uint8_t *pixels = (uint8_t *)w->chip.level;
    for (size_t i = 0; i < sizeof w->chip.level + sizeof w->chip.shadow && s->left != 0; i++) {
        pixels[i] = s->at[i % s->left];
    }
}

static void choose(struct world *w, bool is_window)
{
    const struct lm_target_set set = {
        .items = &w->target, .count = 1, .signatures = &w->signature, .signature_count = 1};
    const struct lm_target_query scene = {.position = {w->target.latitude, w->target.longitude},
                                          .reach_m = 2000};
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, scene.position);
    const struct lm_chip_query chips = {
        .centre = scene.position,
        .reach_m = 2000,
        .radar = lm_geo_direct(&origin, w->look + FX_BAM_180, w->range_q8),
        .heights = {3000 * 1024, 0},
        .cell_mm = w->cell_mm,
        .side_most = is_window ? 32 : LM_CHIP_SIDE};
    lm_target_candidates_select(&w->near, &set, &scene);
    lm_chips_choose(&w->chips, &w->near, &chips);
}

static void serve(struct world *w)
{
    const struct lm_chip_slot *slot = w->near.candidate[0].chip;
    if (slot) {
        w->chip.aspect = slot->key.aspect;
        w->chip.crc = fx_crc32c(0, (const uint8_t *)&w->chip + 4, sizeof w->chip - 4);
        w->signature.chip0 = 0u - slot->key.aspect; /* so that it is the first in the flash */
    }
    for (uint32_t k = 0; k < STEPS_MOST && !lm_chips_are_settled(&w->chips); k++) {
        lm_chips_service(&w->chips, &w->tiles);
        lm_tile_cache_service(&w->tiles, k, 2);
    }
    FUZZ_ASSERT(lm_chips_are_settled(&w->chips));
    FUZZ_ASSERT(!slot || slot->state == LM_CHIP_RESIDENT);
}

/* Ground that rises and falls by up to 45 degrees, as the chip has it. */
static void make_ground(const struct world *w, int32_t elevation_m_q14[CELLS])
{
    elevation_m_q14[0] = 0;
    for (uint32_t i = 1; i < CELLS; i++) {
        elevation_m_q14[i] =
            elevation_m_q14[i - 1] +
            (int32_t)(w->cell_mm * 256 / 1000) * (w->chip.level[0][i % LM_CHIP_SIDE] - 128) / 2;
    }
}

static void draw_patch(struct world *w)
{
    const struct lm_patch_geometry g = {.centre = {w->target.latitude, w->target.longitude},
                                        .look = w->look,
                                        .centre_m_q8 = w->range_q8,
                                        .cell_m_q8 = w->cell_mm * 256 / 1000,
                                        .lines = LINES,
                                        .cells = CELLS,
                                        .traced = CELLS,
                                        .lean_q16 = 1 << 15,
                                        .heights = {3000 * 1024, 0},
                                        .wavelength_um = 31228,
                                        .across_mm_s = 200000,
                                        .dwell_ms = 4000};
    int32_t elevation_m_q14[CELLS];
    int16_t level_q8[LM_CELLS_ROOM] = {0};
    make_ground(w, elevation_m_q14);
    lm_target_patch_set(&w->points, &w->near, &g);
    for (uint32_t k = 0; k < LINES; k++) {
        lm_target_patch_lean(&w->points, k, elevation_m_q14, &g);
    }
    for (uint32_t i = 0; i < w->points.scatterer_count; i++) {
        lm_target_patch_mark_shaded(&w->points, i, &g);
    }
    for (uint32_t k = 0; k < LINES; k++) {
        lm_target_patch_shade(&w->points, k, &g, elevation_m_q14, level_q8);
        lm_target_patch_add_chips(&w->points, k, &g, elevation_m_q14, level_q8);
    }
    for (uint32_t i = CELLS; i < LM_CELLS_ROOM; i++) {
        FUZZ_ASSERT(level_q8[i] == 0);
    }
}

static void draw_line(struct world *w)
{
    const struct lm_target_candidate *item = &w->near.candidate[0];
    const uint32_t cell_q8 = w->cell_mm * 256 / 1000;
    int32_t elevation_m_q14[CELLS];
    make_ground(w, elevation_m_q14);
    const struct lm_target_line line = {.width = 1 + w->look % (FX_BAM_180 / 8),
                                        .first_m_q8 = w->range_q8,
                                        .cell_m_q8 = cell_q8,
                                        .cells = CELLS,
                                        .height_m_q10 = 3000 * 1024,
                                        .elevation_m_q14 = elevation_m_q14};
    const struct lm_chip_sector_origin spot = {
        .range_m_q8 = w->range_q8 + cell_q8 * (w->look % CELLS),
        .off_bam = (int32_t)(w->target.heading >> 8),
        .shadow_off_bam = (int32_t)w->target.heading,
    };
    int16_t level_q8[LM_CELLS_ROOM] = {0};
    if (lm_chip_of(item)) {
        FUZZ_ASSERT(lm_chip_sector_add(item, &spot, &line, 30 * 256, level_q8) <= CELLS);
    }
    for (uint32_t i = CELLS; i < LM_CELLS_ROOM; i++) {
        FUZZ_ASSERT(level_q8[i] == 0);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_supply supply = {data, size};
    static struct world world; /* half a megabyte, most of it the cache, which is cleared below */
    struct world *w = &world;
    const size_t behind = offsetof(struct world, chips) + sizeof w->chips;
    memset(w, 0, offsetof(struct world, chips));
    memset((uint8_t *)w + behind, 0, sizeof *w - behind);
    take_signature(w, &supply);
    take_look(w, &supply);
    take_chip(w, &supply);
    memory_flash_open(&w->flash, (const uint8_t *)&w->chip, sizeof w->chip);
    w->db.flash = &w->flash.port;
    w->tiles.db = &w->db;
    w->tiles.reading_slot = LM_SLOT_NONE;
    w->chip_source = (struct lm_chip_source){w->db.chips_offset, 0};
    lm_chips_init(&w->chips, &w->chip_source, &w->signature);
    choose(w, w->look & 1);
    serve(w);
    draw_patch(w);
    draw_line(w);
    return 0;
}
