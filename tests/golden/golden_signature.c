#include "golden_signature.h"

#include "fx/crc32c.h"
#include "fx/trig.h"
#include "lm/image.h"
#include "lm/signature.h"

#include <stdlib.h>
#include <string.h>

enum { ASPECTS = 8, ORIGIN_ROW = 20, SHADOW_PIXELS = 14 };

/* A place of the target, half metres forward and right of its origin. */
struct place {
    int32_t forward, right;
};

/* Of the middle of a pixel: the inverse of docs/EQUATIONS.md, "Signatures". */
static struct place place_of(uint32_t aspect, int32_t row, int32_t column)
{
    const fx_bam_t bearing = aspect * (FX_BAM_90 / 2);
    const int64_t cosine = fx_cos_q30(bearing), sine = fx_sin_q30(bearing);
    const int32_t x2 = 2 * (column - LM_CHIP_SIDE / 2) + 1, y2 = 2 * (row - ORIGIN_ROW) + 1;
    return (struct place){(int32_t)((x2 * sine - y2 * cosine) >> 31),
                          (int32_t)((-x2 * cosine - y2 * sine) >> 31)};
}

static bool is_within(int32_t value, int32_t low, int32_t high)
{
    return value >= low && value <= high;
}

static bool is_body(uint32_t aspect, int32_t row, int32_t column)
{
    const struct place p = place_of(aspect, row, column);
    return (is_within(p.forward, -24, 20) && is_within(p.right, -4, 4)) ||
           (is_within(p.forward, -22, -16) && is_within(p.right, -12, 12));
}

/* Bright where the body begins, as the radar sees it, and dim behind. */
static void draw(struct lm_chip *c, int32_t row, int32_t column)
{
    bool is_dark = false;
    for (int32_t k = 1; k <= SHADOW_PIXELS && !is_dark; k++) {
        is_dark = is_body(c->aspect, row - k, column);
    }
    if (is_body(c->aspect, row, column)) {
        c->level[row][column] = is_body(c->aspect, row - 1, column) ? 140 : 176;
        is_dark = true;
    }
    if (is_dark) {
        c->shadow[row][column / 8] |= (uint8_t)(1 << column % 8);
    }
}

static void make_chip(struct lm_chip *c, uint32_t aspect)
{
    c->aspect = (uint16_t)aspect;
    for (int32_t row = 0; row < LM_CHIP_SIDE; row++) {
        for (int32_t column = 0; column < LM_CHIP_SIDE; column++) {
            draw(c, row, column);
        }
    }
    c->crc = fx_crc32c(0, (const uint8_t *)c + 4, sizeof *c - 4);
}

static void make_record(struct lm_signature *s)
{
    *s = (struct lm_signature){.name = "golden",
                               .aspects = ASPECTS,
                               .depressions = 1,
                               .origin_row = ORIGIN_ROW,
                               .pixel_mm = 500,
                               .height_mm = 3000,
                               .depression = {FX_BAM_DEG(15)}};
    memset(s->rcs[0], 200, ASPECTS);
    s->crc = fx_crc32c(0, (const uint8_t *)s + 4, sizeof *s - 4);
}

struct section {
    struct lm_signatures_head head;
    struct lm_signature record;
    struct lm_chip chip[ASPECTS];
};

static void make_section(struct section *s)
{
    s->head = (struct lm_signatures_head){1, LM_SIGNATURE_BYTES, ASPECTS, LM_CHIP_BYTES, {0}, 0};
    s->head.crc = fx_crc32c(0, &s->head, sizeof s->head - 4);
    make_record(&s->record);
    for (uint32_t a = 0; a < ASPECTS; a++) {
        make_chip(&s->chip[a], a);
    }
}

int golden_add_signature(struct tiny_image *image)
{
    const size_t at = (image->size + 63) / 64 * 64, size = at + sizeof(struct section);
    uint8_t *bytes = calloc(1, size);
    struct section *section = calloc(1, sizeof *section);
    if (!bytes || !section) {
        free(bytes);
        free(section);
        return -1;
    }
    make_section(section);
    memcpy(bytes, image->bytes, image->size);
    memcpy(bytes + at, section, sizeof *section);
    struct lm_image_header *h = (struct lm_image_header *)bytes;
    h->sections[h->section_count++] = (struct lm_image_section){
        LM_IMAGE_SIGNATURES, fx_crc32c(0, section, sizeof *section), at, sizeof *section};
    h->image_bytes = size;
    h->crc = fx_crc32c(0, h, sizeof *h - sizeof h->crc);
    free(section);
    free(image->bytes);
    image->bytes = bytes;
    image->size = size;
    return 0;
}
