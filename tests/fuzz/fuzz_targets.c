/* The section TARGETS of a flash image: any bytes as its head and its records, read as the unit
 * reads them; what passes the check is drawn into lines of a sector and of a patch. The first byte
 * of the input says which checksums are put right, the next 24 from where and how the targets are
 * looked at; the rest is the section. */
#include "fuzz.h"
#include "lm/target_line.h"
#include "lm/target_patch.h"
#include "memory_flash.h"
#include "tiny_image.h"

#include "fx/crc32c.h"

const uint32_t fuzz_mutations = 5000;

enum {
    POLLS = 64,
    TARGETS_MAX = 40,
    LINES = 128,
    CELLS = 132,
    SECTION_MAX = 1 << 16,
    SEAL_HEAD = 1,
    SEAL_RECORDS = 2
};

/* Where FORMATS.md puts them. */
enum {
    IMAGE_BYTES_AT = 16,
    SECTION_COUNT_AT = 56,
    SECTIONS_AT = 64,
    SECTION_BYTES = 24,
    CRC_AT = 1020
};

/* How they are looked at. */
struct look {
    struct lm_position place; /* against the first target's */
    fx_bam_t azimuth, track;
    uint32_t speed_mm_s;
    uint32_t time_s;
};

static void put(uint8_t *at, uint64_t value, size_t bytes)
{
    memcpy(at, &value, bytes);
}

static void seal_section(uint8_t *section, size_t size, uint8_t parts)
{
    if ((parts & SEAL_HEAD) && size >= 64) {
        put(section + 60, fx_crc32c(0, section, 60), 4);
    }
    for (size_t at = 64; (parts & SEAL_RECORDS) && at + LM_TARGET_BYTES <= size;
         at += LM_TARGET_BYTES) {
        put(section + at, fx_crc32c(0, section + at + 4, LM_TARGET_BYTES - 4), 4);
    }
}

/* A sound image, of which the first input makes a copy with room for a section behind it. */
static size_t make_image(uint8_t **bytes)
{
    struct tiny_image image;
    const struct tiny_spec spec = tiny_spec_at(46, 11);
    FUZZ_ASSERT(tiny_image_build(&image, &spec) == 0);
    const size_t at = (image.size + 63) / 64 * 64;
    *bytes = calloc(1, at + SECTION_MAX);
    FUZZ_ASSERT(*bytes);
    memcpy(*bytes, image.bytes, image.size);
    tiny_image_free(&image);
    return at;
}

/* That image with the section behind it, until the next call. */
static const uint8_t *image_with(const uint8_t *section, size_t size, size_t *image_size)
{
    static uint8_t *bytes;
    static size_t at;
    at = bytes ? at : make_image(&bytes);
    memcpy(bytes + at, section, size);
    uint8_t *entry = bytes + SECTIONS_AT + 5 * SECTION_BYTES;
    put(entry, 6, 4);
    put(entry + 8, at, 8);
    put(entry + 16, size, 8);
    put(bytes + IMAGE_BYTES_AT, at + size, 8);
    put(bytes + SECTION_COUNT_AT, 6, 4);
    put(bytes + CRC_AT, fx_crc32c(0, bytes, CRC_AT), 4);
    *image_size = at + size;
    return bytes;
}

static void draw_sector(const struct lm_target *t, uint32_t count, const struct look *look)
{
    struct lm_target_candidates near;
    const struct lm_target_set set = {.items = t, .count = count};
    const struct lm_target_query scene = {
        .position = look->place, .reach_m = 40000, .time_us = (uint64_t)look->time_s * 1000000};
    int16_t level_q8[LM_CELLS_ROOM] = {0};
    lm_target_candidates_select(&near, &set, &scene);
    FUZZ_ASSERT(near.count <= LM_TARGET_CANDIDATES_MAX);
    for (fx_bam_t i = 0; i < 8; i++) {
        const struct lm_target_line line = {.position = look->place,
                                            .azimuth = look->azimuth + i * (FX_BAM_180 / 4),
                                            .width = FX_BAM_180 / 4,
                                            .first_m_q8 = 37040,
                                            .cell_m_q8 = 37040,
                                            .cells = 256,
                                            .height_m_q10 = 3000 * 1024,
                                            .wavelength_um = 31228,
                                            .is_doppler = i % 2,
                                            .beam = FX_BAM_180 / 3,
                                            .speed_mm_s = look->speed_mm_s & 0x1fffff,
                                            .track = look->track,
                                            .gate_mm_s = {1500, i % 3 ? 50000 : 0}};
        (void)lm_target_line_add(&near, &line, NULL, level_q8);
    }
}

static void draw_patch(const struct lm_target *t, uint32_t count, const struct look *look)
{
    struct lm_target_patch *points = malloc(sizeof *points);
    struct lm_target_candidates near;
    const struct lm_target_set set = {.items = t, .count = count};
    const struct lm_target_query scene = {
        .position = look->place, .reach_m = 2000, .time_us = (uint64_t)look->time_s * 1000000};
    const struct lm_patch_geometry g = {.centre = look->place,
                                        .look = look->azimuth,
                                        .centre_m_q8 = 20000 * 256,
                                        .cell_m_q8 = 128u << (look->track & 6),
                                        .lines = LINES,
                                        .cells = CELLS,
                                        .heights = {3000 * 1024, 100 * 1024},
                                        .wavelength_um = 31228,
                                        .across_mm_s = (int32_t)look->speed_mm_s,
                                        .dwell_ms = look->time_s & 0x1ffff,
                                        .lean_q16 = (int32_t)(look->track & 0x1ffff)};
    int32_t horizon[LM_CELLS_ROOM] = {0};
    int16_t level_q8[LM_CELLS_ROOM] = {0};
    FUZZ_ASSERT(points);
    lm_target_candidates_select(&near, &set, &scene);
    lm_target_patch_set(points, &near, &g);
    FUZZ_ASSERT(points->scatterer_count <= LM_PATCH_SCATTERERS_MAX);
    for (uint32_t k = 0; k < LINES; k++) {
        lm_target_patch_mark_hidden(points, k, horizon, 26, CELLS);
        lm_target_patch_add_scatterers(points, k, -56 * 256, &g, level_q8);
    }
    for (uint32_t i = 0; i < LM_CELLS_ROOM; i++) {
        FUZZ_ASSERT(points->re_q24[i] == 0 && points->im_q24[i] == 0);
        FUZZ_ASSERT(i < CELLS || level_q8[i] == 0);
    }
    free(points);
}

static void use(const struct lm_db *db, struct look *look)
{
    struct lm_target *t = malloc(TARGETS_MAX * sizeof *t);
    uint32_t count = 0;
    FUZZ_ASSERT(t);
    for (uint32_t i = 0; i < db->target_count && count < TARGETS_MAX; i++) {
        count += lm_target_read(db, i, &t[count], POLLS) == LM_OK;
    }
    if (count > 0) {
        look->place.latitude = look->place.latitude % 30000 + t[0].latitude;
        look->place.longitude = look->place.longitude % 30000 + t[0].longitude;
        draw_sector(t, count, look);
        draw_patch(t, count, look);
    }
    free(t);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_supply supply = {data, size};
    const uint8_t parts = fuzz_u8(&supply);
    struct look look = {.place = {fuzz_u32(&supply), fuzz_u32(&supply)},
                        .azimuth = fuzz_u32(&supply),
                        .track = fuzz_u32(&supply),
                        .speed_mm_s = fuzz_u32(&supply),
                        .time_s = fuzz_u32(&supply)};
    supply.left = supply.left < SECTION_MAX ? supply.left : SECTION_MAX;
    uint8_t *section = malloc(supply.left + 1);
    struct lm_db *db = malloc(sizeof *db);
    FUZZ_ASSERT(section && db);
    memcpy(section, supply.at, supply.left);
    seal_section(section, supply.left, parts);
    size_t image_size;
    const uint8_t *image = image_with(section, supply.left, &image_size);
    struct memory_flash flash;
    memory_flash_open(&flash, image, image_size);
    flash.fail_every = parts >> 4;
    if (lm_db_open(db, &flash.port, POLLS) == LM_OK) {
        use(db, &look);
    }
    free(db);
    free(section);
    return 0;
}
