#include "lm/geoid.h"

#include <stddef.h>

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
