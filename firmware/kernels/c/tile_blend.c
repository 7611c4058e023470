#include "fx/lerp.h"
#include "fx/mem.h"
#include "fx/sat.h"
#include "lm/kernels_clutter.h"
#include "lm/kernels_map.h"
#include "lm/lanes.h"

#define ALWAYS_INLINE __attribute__((always_inline))

/* 2^13 over a weight of 4 i + 2, at most 255: i is the weight of a class, of 255, in steps of 4.
 * The vectors of arm64/ look up the same. */
static const int32_t share_of_weight[64] = {
    255, 255, 255, 255, 255, 255, 255, 255, 241, 216, 195, 178, 164, 152, 141, 132,
    124, 117, 111, 105, 100, 95,  91,  87,  84,  80,  77,  74,  72,  69,  67,  65,
    63,  61,  59,  58,  56,  55,  53,  52,  51,  49,  48,  47,  46,  45,  44,  43,
    42,  41,  41,  40,  39,  38,  38,  37,  36,  36,  35,  34,  34,  33,  33,  32,
};

/* Of the four cells whose middles are around a place: class, and weight. Weights add up to 256. */
struct corner {
    int32_t cell, kind, weight;
};

static inline struct corner corner_of(uint32_t point, int32_t weight)
{
    return (struct corner){(int32_t)(point & 0xFFFF), (int32_t)(point >> 4 & 15), weight};
}

/* Weight of all cells of the class of the first; 255 stands for 256, too. */
static inline int32_t weight_of_class(struct corner of, struct corner b, struct corner c,
                                      struct corner d)
{
    return fx_min_i32(of.weight + (of.kind == b.kind ? b.weight : 0) +
                          (of.kind == c.kind ? c.weight : 0) + (of.kind == d.kind ? d.weight : 0),
                      255);
}

/* The class that has won so far: its number and weight. */
struct winner {
    int32_t kind, weight;
};

/* Let a class challenge the winner. Where both are natural, the ground leans to the one or to the
 * other. With S the weights and n twice the lean, S_k - S_m + n (S_k + S_m) > 0 is
 * S_k (1 + n) > S_m (1 - n). */
static inline struct winner challenge(struct winner w, int32_t kind, int32_t weight,
                                      int32_t lean_q7, uint32_t natural)
{
    const bool are_natural = (natural >> kind & natural >> w.kind & 1u) != 0;
    const int32_t leaning = kind > w.kind ? lean_q7 : -lean_q7;
    const int32_t lean = are_natural ? leaning : 0;
    return weight * (128 + lean) > w.weight * (128 - lean) ? (struct winner){kind, weight} : w;
}

static inline int32_t height_dm_of(const int32_t *height_dm, int32_t cell)
{
    return height_dm[cell & 15];
}

/* The lower 16 bits with their sign: sums wrap as the vectors of arm64/ do. */
static inline int32_t wrapped(int32_t x)
{
    return (int32_t)((uint32_t)x << 16) >> 16;
}

/* Difference of two heights: right up to 3.2 km. */
static inline int32_t apart_dm(int32_t height_dm, int32_t from_dm)
{
    return wrapped(height_dm - from_dm);
}

struct heights {
    int32_t dm[LM_K_CODES];
};

/* What has grown at a place: bytes times 256. */
struct grown {
    int32_t bend_q8, crown_q16;
};

/* The number of the nearest texel, along one axis. */
static inline int32_t nearest_texel(const struct lm_k_blend *map, uint32_t place)
{
    return (int32_t)(((place >> (map->grown_shift - 1)) + 1) >> 1 & (LM_K_GROWN_SIDE - 1));
}

static inline struct grown grown_nearest(const struct lm_k_blend *map, uint32_t north,
                                         uint32_t east)
{
    const int32_t at = nearest_texel(map, north) * LM_K_GROWN_STRIDE + nearest_texel(map, east);
    const uint32_t texel = fx_load_u32(map->grown + at); /* and its neighbour: words gather */
    return (struct grown){((int32_t)(texel << 24) >> 24) * 256,
                          (int32_t)(texel & 0xFF00) - 128 * 256};
}

/* Straight between four texels, in sixteenths. */
static inline struct grown grown_between(const struct lm_k_blend *map, uint32_t north,
                                         uint32_t east)
{
    const uint32_t north_q4 = north >> (map->grown_shift - 4);
    const uint32_t east_q4 = east >> (map->grown_shift - 4);
    const int32_t row = (int32_t)(north_q4 >> 4 & (LM_K_GROWN_SIDE - 1));
    const int32_t column = (int32_t)(east_q4 >> 4 & (LM_K_GROWN_SIDE - 1));
    const int32_t at = row * LM_K_GROWN_STRIDE + column;
    const uint32_t south = fx_load_u32(map->grown + at);
    const uint32_t next = fx_load_u32(map->grown + at + LM_K_GROWN_STRIDE);
    const uint32_t u = east_q4 % 16, v = north_q4 % 16;
    const uint32_t at_south = (south >> 8 & 255) * (16 - u) + (south >> 24) * u;
    const uint32_t at_north = (next >> 8 & 255) * (16 - u) + (next >> 24) * u;
    const int32_t west = 16 - (int32_t)u, east_ward = (int32_t)u;
    const int32_t bend_south =
        ((int32_t)(south << 24) >> 24) * west + ((int32_t)(south << 8) >> 24) * east_ward;
    const int32_t bend_north =
        ((int32_t)(next << 24) >> 24) * west + ((int32_t)(next << 8) >> 24) * east_ward;
    return (struct grown){bend_south * (16 - (int32_t)v) + bend_north * (int32_t)v,
                          (int32_t)(at_south * (16 - v) + at_north * v) - 128 * 256};
}

static inline struct grown grown_at(const struct lm_k_blend *map, bool is_stepped, uint32_t north,
                                    uint32_t east)
{
    return is_stepped ? grown_nearest(map, north, east) : grown_between(map, north, east);
}

/* `is_stepped` is the map's, as a constant. */
static inline ALWAYS_INLINE struct lm_ground blend(const struct lm_k_blend *map,
                                                   const struct heights *heights, bool is_stepped,
                                                   uint32_t record, int32_t scale, uint32_t north,
                                                   uint32_t east)
{
    /* Half a cell to the south-west lies the cell whose middle is next. Weights are 1/128. */
    const uint32_t north_q25 = (north >> 1) + (1u << 24), east_q25 = (east >> 1) + (1u << 24);
    const int32_t row = (int32_t)(north_q25 >> 25) - 1, column = (int32_t)(east_q25 >> 25) - 1;
    const int32_t at = lm_k_point_of(record) + row * LM_TILE_POINTS + column;
    const int32_t v = north_q25 >> 18 & 127, u = east_q25 >> 18 & 127;
    /* Cut off, the three add up to 255 at most: together they are 256 - (128 - u) (128 - v) / 64.
     */
    const int32_t of_d = u * v >> 6, of_b = (128 * u - u * v) >> 6, of_c = (128 * v - u * v) >> 6;
    const struct lm_tile_point *p = map->points;
    const struct corner a = corner_of(fx_load_u32(p + at), 256 - of_b - of_c - of_d);
    const struct corner b = corner_of(fx_load_u32(p + at + 1), of_b);
    const struct corner c = corner_of(fx_load_u32(p + at + LM_TILE_POINTS), of_c);
    const struct corner d = corner_of(fx_load_u32(p + at + LM_TILE_POINTS + 1), of_d);

    const struct grown grown = grown_at(map, is_stepped, north, east);
    const int32_t lean_q7 = (grown.bend_q8 * LM_K_LEAN_OF_BEND_Q7 + (1 << 14)) >> 15;
    struct winner w = {a.kind, weight_of_class(a, b, c, d)};
    w = challenge(w, b.kind, weight_of_class(b, a, c, d), lean_q7, map->natural);
    w = challenge(w, c.kind, weight_of_class(c, a, b, d), lean_q7, map->natural);
    w = challenge(w, d.kind, weight_of_class(d, a, b, c), lean_q7, map->natural);

    /* Of 255, so that a byte holds all weights together: the first cell has one less. */
    const int32_t in_a = a.kind == w.kind ? a.weight - 1 : 0;
    const int32_t in_b = b.kind == w.kind ? b.weight : 0;
    const int32_t in_c = c.kind == w.kind ? c.weight : 0;
    const int32_t in_d = d.kind == w.kind ? d.weight : 0;
    int32_t most = in_a, cell = a.cell;
    cell = in_b > most ? b.cell : cell;
    most = fx_max_i32(in_b, most);
    cell = in_c > most ? c.cell : cell;
    most = fx_max_i32(in_c, most);
    cell = in_d > most ? d.cell : cell;

    const int32_t share = share_of_weight[(in_a + in_b + in_c + in_d) >> 2];
    const int32_t gamma = cell >> 8;
    const int32_t gamma_sum = in_a * ((a.cell >> 8) - gamma) + in_b * ((b.cell >> 8) - gamma) +
                              in_c * ((c.cell >> 8) - gamma) + in_d * ((d.cell >> 8) - gamma);
    const int32_t more_db_q8 = ((wrapped(gamma_sum) * share + 128) >> 8) * 4;

    const int32_t height_dm = height_dm_of(heights->dm, cell);
    const int32_t height_sum = in_a * apart_dm(height_dm_of(heights->dm, a.cell), height_dm) +
                               in_b * apart_dm(height_dm_of(heights->dm, b.cell), height_dm) +
                               in_c * apart_dm(height_dm_of(heights->dm, c.cell), height_dm) +
                               in_d * apart_dm(height_dm_of(heights->dm, d.cell), height_dm);
    const bool is_flat = (map->flat >> w.kind & 1u) != 0;
    /* The sum is below 2^23. */
    const int32_t higher_dm_q10 = is_flat ? 0 : (height_sum >> 1) * share >> 2;
    const int32_t higher_m_q14 =
        higher_dm_q10 + (higher_dm_q10 >> 1) + (higher_dm_q10 >> 4) + (higher_dm_q10 >> 5);
    const int32_t height_m_q14 = lm_k_height_m_q14((uint16_t)height_dm) + higher_m_q14;
    const int32_t crown_q16 = (map->crowned >> w.kind & 1u) != 0 ? grown.crown_q16 : 0;
    const int32_t crown_m_q14 = (int32_t)((int64_t)height_m_q14 * crown_q16 >> 16);

    const struct lm_ground g = lm_k_tile_sample(p, record, scale, north, east);
    return (struct lm_ground){(uint32_t)cell | (uint32_t)more_db_q8 << 16,
                              g.elevation_m_q14 + higher_m_q14 + crown_m_q14};
}

/* Cells k to end - 1. A loop that asked whether it is stepped would make no vectors. No store
 * touches the points: it may gather. */
static inline ALWAYS_INLINE void blend_cells(const struct lm_k_blend *map,
                                             const struct heights *heights, bool is_stepped,
                                             const struct lm_tile_coords *p, uint32_t k,
                                             uint32_t end, uint32_t *cell, int32_t *elevation_m_q14)
{
    for (; k < end; k++) {
        const uint32_t north = lm_quadratic_at(&p->north, k), east = lm_quadratic_at(&p->east, k);
        const struct lm_ground g =
            blend(map, heights, is_stepped, cell[k], elevation_m_q14[k], north, east);
        cell[k] = g.cell;
        elevation_m_q14[k] = g.elevation_m_q14;
    }
}

/* Whole groups: a vector of cells has no rest. */
void lm_k_tile_blend(const struct lm_k_blend *map, const struct lm_tile_coords *places,
                     uint32_t first, uint32_t groups, uint32_t *restrict cell,
                     int32_t *restrict elevation_m_q14)
{
    const struct lm_tile_coords p = *places;
    const struct lm_k_blend m = *map;
    const uint32_t end = first + groups * LM_LANES;
    struct heights heights;
    for (int i = 0; i < LM_K_CODES; i++) {
        heights.dm[i] = m.height_dm_of_code[i];
    }
    if (m.is_stepped) {
        blend_cells(&m, &heights, true, &p, first, end, cell, elevation_m_q14);
    } else {
        blend_cells(&m, &heights, false, &p, first, end, cell, elevation_m_q14);
    }
}
