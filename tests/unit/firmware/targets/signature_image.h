/* A flash image with a section SIGNATURES, byte by byte as docs/FORMATS.md has it: one target of a
 * few bright points and a block that throws a shadow. */
#ifndef SIGNATURE_IMAGE_H
#define SIGNATURE_IMAGE_H

#include "target_image.h"

#include "lm/chips.h"
#include "memory_flash.h"

enum {
    ASPECTS = 24,
    DEPRESSIONS = 2,
    CHIPS = ASPECTS * DEPRESSIONS,
    ORIGIN_ROW = 24,
    PIXEL_MM = 500
};

/* Corners of the target: forward and right of its origin, metres, and dBsm. No two alike, so that a
 * mirrored or turned picture is another one. */
static const struct corner {
    double forward_m, right_m, dbsm;
} corners[] = {{6, 0, 20}, {-5, 3, 17}, {-5, -3, 14}};
enum { CORNERS = sizeof corners / sizeof corners[0] };

/* Where a corner is for a radar at this bearing from the target's nose: to the right as the radar
 * looks, and beyond the origin. Plane geometry, with nothing of the firmware's. */
static inline void corner_place(const struct corner *c, double bearing_rad, double *right_m,
                                double *beyond_m)
{
    *right_m = c->forward_m * sin(bearing_rad) - c->right_m * cos(bearing_rad);
    *beyond_m = -c->forward_m * cos(bearing_rad) - c->right_m * sin(bearing_rad);
}

static inline void seal_chip(struct lm_chip *c)
{
    c->crc = fx_crc32c(0, (const uint8_t *)c + 4, LM_CHIP_BYTES - 4);
}

static inline void seal_signature(struct lm_signature *s)
{
    s->crc = fx_crc32c(0, (const uint8_t *)s + 4, LM_SIGNATURE_BYTES - 4);
}

static inline uint8_t code_of(double dbsm)
{
    return (uint8_t)lround((dbsm + 80) * 2);
}

/* The corners at the nearest pixel, and a shadow 6 m wide from 1 m to 12 m beyond the origin. */
static inline struct lm_chip make_chip(uint32_t aspect, uint32_t depression)
{
    const double bearing = 2 * acos(-1) * aspect / ASPECTS, pixel_m = PIXEL_MM / 1000.0;
    struct lm_chip c = {.aspect = (uint16_t)aspect, .depression = (uint8_t)depression};
    for (int i = 0; i < CORNERS; i++) {
        double right_m, beyond_m;
        corner_place(&corners[i], bearing, &right_m, &beyond_m);
        const int column = LM_CHIP_SIDE / 2 + (int)floor(right_m / pixel_m);
        const int row = ORIGIN_ROW + (int)floor(beyond_m / pixel_m);
        c.level[row][column] = code_of(corners[i].dbsm);
    }
    for (int row = ORIGIN_ROW + 2; row < ORIGIN_ROW + 24; row++) {
        for (int column = LM_CHIP_SIDE / 2 - 6; column < LM_CHIP_SIDE / 2 + 6; column++) {
            c.shadow[row][column / 8] |= (uint8_t)(1 << column % 8);
        }
    }
    seal_chip(&c);
    return c;
}

static inline struct lm_signature make_signature(void)
{
    struct lm_signature s = {.name = "three corners",
                             .aspects = ASPECTS,
                             .depressions = DEPRESSIONS,
                             .origin_row = ORIGIN_ROW,
                             .pixel_mm = PIXEL_MM,
                             .height_mm = 3000,
                             .depression = {hs_bam(10), hs_bam(30)}};
    for (int k = 0; k < CHIPS; k++) {
        s.rcs[k / ASPECTS][k % ASPECTS] = code_of(22.5);
    }
    seal_signature(&s);
    return s;
}

struct with_signatures {
    uint8_t *bytes; /* freed by the caller */
    size_t size, head_at, chips_at;
};

static inline void seal_image(struct with_signatures *w)
{
    put(w->bytes + w->head_at + 60, fx_crc32c(0, w->bytes + w->head_at, 60), 4);
    put(w->bytes + HEADER_CRC_AT, fx_crc32c(0, w->bytes, HEADER_CRC_AT), 4);
}

static inline void add_signatures(struct with_signatures *w, const struct tiny_image *image)
{
    const size_t section_bytes = 64 + LM_SIGNATURE_BYTES + CHIPS * LM_CHIP_BYTES;
    const struct lm_signature s = make_signature();
    w->head_at = (image->size + 63) / 64 * 64;
    w->chips_at = w->head_at + 64 + LM_SIGNATURE_BYTES;
    w->size = w->head_at + section_bytes;
    w->bytes = calloc(1, w->size);
    memcpy(w->bytes, image->bytes, image->size);
    const uint32_t head[4] = {1, LM_SIGNATURE_BYTES, CHIPS, LM_CHIP_BYTES};
    memcpy(w->bytes + w->head_at, head, sizeof head);
    memcpy(w->bytes + w->head_at + 64, &s, sizeof s);
    for (uint32_t k = 0; k < CHIPS; k++) {
        const struct lm_chip c = make_chip(k % ASPECTS, k / ASPECTS);
        memcpy(w->bytes + w->chips_at + k * LM_CHIP_BYTES, &c, sizeof c);
    }
    uint32_t sections;
    memcpy(&sections, w->bytes + SECTION_COUNT_AT, sizeof sections);
    uint8_t *entry = w->bytes + SECTION_TABLE + sections * SECTION_ENTRY;
    put(entry, 7, 4);
    put(entry + 8, w->head_at, 8);
    put(entry + 16, section_bytes, 8);
    put(w->bytes + 16, w->size, 8);
    put(w->bytes + SECTION_COUNT_AT, sections + 1, 4);
    seal_image(w);
}

/* The image in a flash, opened as the unit opens it. */
struct signature_world {
    struct tiny_image image;
    struct with_signatures with;
    struct memory_flash flash;
    struct lm_db db;
    struct lm_signature signature;
    struct lm_chip_source chip_source;
    struct lm_tile_cache tiles;
    struct lm_chips chips;
    uint8_t pool[32 * sizeof(struct lm_tile)] __attribute__((aligned(8)));
};

/* 0, or -1: then nothing of it holds. */
static inline int open_signature_world(struct signature_world *w, const struct tiny_spec *spec)
{
    enum { POLLS = 16 };
    if (tiny_image_build(&w->image, spec) != 0) {
        return -1;
    }
    add_signatures(&w->with, &w->image);
    memory_flash_open(&w->flash, w->with.bytes, w->with.size);
    const bool is_open =
        lm_db_open(&w->db, &w->flash.port, POLLS) == LM_OK &&
        lm_signature_read(&w->db, 0, &w->signature, POLLS) == LM_OK &&
        lm_tile_cache_init(&w->tiles, &w->db, w->pool, sizeof w->pool, POLLS) == LM_OK;
    w->chip_source = (struct lm_chip_source){w->db.chips_offset, 0};
    lm_chips_init(&w->chips, &w->chip_source, &w->signature);
    return is_open ? 0 : -1;
}

static inline void close_signature_world(struct signature_world *w)
{
    tiny_image_free(&w->image);
    free(w->with.bytes);
}

/* Set-up and tear-down for a fixture of `bytes` that begins with such a world, over open country.
 */
static inline int set_up_signature_world(void **state, size_t bytes)
{
    const struct tiny_spec spec = tiny_spec_at(46, 11);
    *state = calloc(1, bytes);
    return *state ? open_signature_world(*state, &spec) : -1;
}

static inline int tear_down_signature_world(void **state)
{
    close_signature_world(*state);
    free(*state);
    return 0;
}

/* Steps until every chip is there or will not come; false when they do not end. */
static inline bool serve_chips(struct signature_world *w)
{
    for (int k = 0; k < 1000 && !lm_chips_are_settled(&w->chips); k++) {
        lm_chips_service(&w->chips, &w->tiles);
        lm_tile_cache_service(&w->tiles, 0, 2);
    }
    return lm_chips_are_settled(&w->chips);
}

static inline struct lm_target_set set_with_signature(const struct signature_world *w,
                                                      const struct lm_target *t, uint32_t count)
{
    return (struct lm_target_set){.items = t,
                                  .count = count,
                                  .signatures = &w->signature,
                                  .signature_count = 1,
                                  .live_signatures = 1};
}

/* A target that is shown by the signature. */
static inline struct lm_target target_with_signature(double latitude, double longitude,
                                                     double heading_deg)
{
    struct lm_target t = point_at(latitude, longitude, 0, 0);
    t.flags = LM_TARGET_HAS_SIGNATURE;
    t.heading = hs_bam(heading_deg);
    seal_target(&t);
    return t;
}

#endif
