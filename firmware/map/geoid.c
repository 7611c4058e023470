#include "lm/geoid.h"

#include <stddef.h>

#include "fx/crc32c.h"

enum { QUARTER = 1 << 30 };

/* Length of a side in BAM. At most 32 steps of 2^27. */
static uint64_t side_bam(uint8_t nodes, uint8_t shift)
{
    return (uint64_t)(nodes - 1u) << shift;
}

static bool is_sound_side(uint8_t nodes, uint8_t shift)
{
    return nodes >= 2 && nodes <= LM_GEOID_NODES_MAX && shift >= LM_GEOID_SHIFT_MIN &&
           shift <= LM_GEOID_SHIFT_MAX;
}

bool lm_geoid_is_sound(const struct lm_geoid *g)
{
    const int32_t south = (int32_t)g->south;
    return is_sound_side(g->rows, g->latitude_shift) &&
           is_sound_side(g->columns, g->longitude_shift) && south >= -QUARTER && south <= QUARTER &&
           side_bam(g->rows, g->latitude_shift) <= UINT32_MAX &&
           side_bam(g->columns, g->longitude_shift) <= UINT32_MAX;
}

/* A node and the 2^-15 parts of the way to the next one. */
struct place {
    uint32_t node, parts;
};

/* `along` is within the side, ends included: the last node has no next one, so the way ends there.
 */
static struct place place_of(uint32_t along, uint8_t nodes, uint8_t shift)
{
    const uint32_t node = along >> shift;
    const uint32_t rest = along & ((1u << shift) - 1u);
    return node >= nodes - 1u ? (struct place){nodes - 2u, 1u << 15}
                              : (struct place){node, rest >> (shift - 15)};
}

/* Latitudes lie within a quarter turn of the equator, so differences need 33 bits. */
static uint32_t along_meridian(const struct lm_geoid *g, fx_bam_t latitude)
{
    const int64_t north = (int64_t)(int32_t)latitude - (int32_t)g->south;
    const int64_t side = (int64_t)side_bam(g->rows, g->latitude_shift);
    return (uint32_t)(north < 0 ? 0 : north > side ? side : north);
}

/* Beyond the east edge, the nearer of the two edges, round the Earth. */
static uint32_t along_parallel(const struct lm_geoid *g, fx_bam_t longitude)
{
    const uint32_t east = longitude - g->west;
    const uint32_t side = (uint32_t)side_bam(g->columns, g->longitude_shift);
    return east <= side ? east : east - side < 0u - east ? side : 0;
}

/* Heights are below 2^15 and parts at most 2^15: each product is at most 2^30, the sum of the two
 * too, because the parts add up to 2^15. */
static int32_t between(int32_t a, int32_t b, uint32_t parts)
{
    return (a * (int32_t)(0x8000 - parts) + b * (int32_t)parts) >> 15;
}

int32_t lm_geoid_height_m_q6(const struct lm_geoid *g, struct lm_position place)
{
    const struct place r = place_of(along_meridian(g, place.latitude), g->rows, g->latitude_shift);
    const struct place c =
        place_of(along_parallel(g, place.longitude), g->columns, g->longitude_shift);
    const int16_t *south = &g->height_m_q6[r.node][c.node];
    const int16_t *north = &g->height_m_q6[r.node + 1][c.node];
    return between(between(south[0], south[1], c.parts), between(north[0], north[1], c.parts),
                   r.parts);
}

bool lm_geoid_pages_are_sound(const struct lm_geoid_pages_head *h, uint64_t bytes)
{
    if (h->shift < LM_GEOID_SHIFT_MIN || h->shift >= LM_GEOID_SHIFT_MAX) {
        return false;
    }
    const uint32_t side_log2 = h->shift + LM_GEOID_PAGE_LOG2;
    const uint32_t rows_all = 1u << (31 - side_log2), columns_all = 2 * rows_all;
    return h->rows > 0 && h->row0 < rows_all && h->rows <= rows_all - h->row0 && h->columns > 0 &&
           h->column0 < columns_all && h->columns <= columns_all &&
           bytes == sizeof *h + (uint64_t)h->rows * h->columns * sizeof(struct lm_geoid);
}

uint32_t lm_geoid_page_of(const struct lm_geoid_pages *p, struct lm_position place)
{
    const uint32_t side_log2 = p->shift + LM_GEOID_PAGE_LOG2;
    if (p->rows == 0) {
        return 0;
    }
    const uint32_t row = ((place.latitude + QUARTER) >> side_log2) - p->row0;
    const uint32_t column = ((place.longitude >> side_log2) - p->column0) & UINT32_MAX >> side_log2;
    return row < p->rows && column < p->columns ? row * p->columns + column + 1 : 0;
}

bool lm_geoid_page_is_sound(const struct lm_geoid_pages *p, uint32_t number,
                            const struct lm_geoid *page)
{
    const uint32_t side_log2 = p->shift + LM_GEOID_PAGE_LOG2;
    const uint32_t row = p->row0 + (number - 1) / p->columns;
    const uint32_t column = p->column0 + (number - 1) % p->columns;
    return fx_crc32c(0, page, offsetof(struct lm_geoid, crc)) == page->crc &&
           lm_geoid_is_sound(page) && page->rows == LM_GEOID_NODES_MAX &&
           page->columns == LM_GEOID_NODES_MAX && page->latitude_shift == p->shift &&
           page->longitude_shift == p->shift && page->south == (row << side_log2) - QUARTER &&
           page->west == column << side_log2;
}
