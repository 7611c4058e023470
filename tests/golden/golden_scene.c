#include "golden_scene.h"
#include "golden_signature.h"

#include "fx/root.h"

#include <math.h>

struct country {
    const char *name;
    double latitude_deg, longitude_deg; /* exact in binary */
    int32_t parallel_q8;                /* cosine of the latitude, for metres east */
    uint8_t rows, columns, shift0, levels;
};

static const struct country countries[GOLDEN_PLACES] = {
    [GOLDEN_MIDDLE] = {"middle", 46, 11, 178, 12, 12, 10, 9},
    [GOLDEN_BORDER] = {"border", 61.875, -20.5, 121, 8, 6, 11, 6},
    [GOLDEN_ANTIMERIDIAN] = {"antimeridian", -17, 180, 245, 8, 8, 11, 6},
    [GOLDEN_NORTH] = {"north", 79, 30, 49, 8, 4, 11, 6},
};

const char *golden_place_name(enum golden_place place)
{
    return countries[place].name;
}

/* Degrees to the binary angle they were made from: exact, because 360 / 2^32 has 6 significant
 * bits. */
static uint32_t bam_of(double degrees)
{
    return (uint32_t)llround(degrees * 4294967296.0 / 360);
}

struct lm_position golden_centre(enum golden_place place)
{
    return (struct lm_position){bam_of(countries[place].latitude_deg),
                                bam_of(countries[place].longitude_deg)};
}

/* Metres from the middle of the country, whole, as its own round Earth has them. */
struct spot {
    int32_t east, north;
};

static struct spot spot_of(const struct country *c, const struct tiny_place *p)
{
    const int64_t north = (int32_t)(bam_of(p->latitude_deg) - bam_of(c->latitude_deg));
    const int64_t east = (int32_t)(bam_of(p->longitude_deg) - bam_of(c->longitude_deg));
    return (struct spot){(int32_t)((east * 611 * c->parallel_q8) >> 24),
                         (int32_t)((north * 611) >> 16)};
}

/* 0..65535, the same all over a square of `size` metres. The hash is the scenes' own: another noise
 * of the radar must not move the hills. */
static int32_t dice(int32_t column, int32_t row, uint32_t salt)
{
    uint32_t line = (uint32_t)row * 0xed5ad4bbu + salt * 0xac4c1b51u;
    line = (line ^ line >> 16) * 0x31848babu;
    uint32_t x = (line ^ line >> 15) + (uint32_t)column;
    x = (x ^ x >> 16) * 0x7feb352du;
    x = ((x ^ x >> 15) + line) * 0x846ca68bu;
    return (int32_t)(x >> 16);
}

static int32_t floor_div(int32_t a, int32_t b)
{
    return (a >= 0 ? a : a - b + 1) / b;
}

/* A smooth field of hills `size` metres apart, 0..height. */
static int32_t field(struct spot s, int32_t size, int32_t height, uint32_t salt)
{
    const int32_t column = floor_div(s.east, size), row = floor_div(s.north, size);
    const int64_t x = s.east - column * size, y = s.north - row * size;
    const int64_t south = dice(column, row, salt) * (size - x) + dice(column + 1, row, salt) * x;
    const int64_t north =
        dice(column, row + 1, salt) * (size - x) + dice(column + 1, row + 1, salt) * x;
    return (int32_t)((south * (size - y) + north * y) / size / size * height >> 16);
}

static int32_t distance(struct spot s, int32_t east, int32_t north)
{
    const int64_t x = s.east - east, y = s.north - north;
    return (int32_t)fx_sqrt_u64((uint64_t)(x * x + y * y));
}

enum { SEA_DM = 0, LAKE_DM = 1100 };

static bool is_sea(struct spot s)
{
    return s.east < -2500 + field(s, 900, 1500, 1) - field(s, 200, 300, 2);
}

/* Ground in decimetres: a coastal plain, hills behind it, one mountain, level lakes. */
static int32_t ground_dm(struct spot s)
{
    if (is_sea(s)) {
        return SEA_DM;
    }
    int32_t dm = field(s, 3100, 2500, 3) + field(s, 800, 700, 4) + field(s, 190, 90, 5);
    const int32_t from_peak = distance(s, 2200, 6500);
    dm += from_peak < 4000 ? (4000 - from_peak) * 4 : 0;
    return dm > LAKE_DM ? dm : LAKE_DM;
}

static bool is_town(struct spot s)
{
    return distance(s, 150, 100) < 420 || distance(s, 600, 1700) < 700 ||
           distance(s, 2500, -1800) < 400;
}

/* Houses of 40 x 30 m on a street plan, each as high as its number says. */
static struct tiny_cell town_cell(struct spot s)
{
    const int32_t column = floor_div(s.east, 70), row = floor_div(s.north, 60);
    if (s.east - column * 70 < 40 && s.north - row * 60 < 30) {
        return (struct tiny_cell){-2 + dice(column, row, 6) % 8, TINY_STRUCTURE,
                                  (uint8_t)(2 + dice(column, row, 7) % 9)};
    }
    return (struct tiny_cell){-30, TINY_ASPHALT, 0};
}

static struct tiny_cell land_cell(struct spot s)
{
    const bool is_runway = s.north > -900 && s.north < -840 && s.east > -700 && s.east < 1300;
    if (is_runway) {
        return (struct tiny_cell){-32, TINY_CONCRETE, 0};
    }
    if (is_town(s)) {
        return town_cell(s);
    }
    if (field(s, 700, 100, 8) > 58) {
        return (struct tiny_cell){-14, TINY_TREES, (uint8_t)(6 + field(s, 300, 3, 9))};
    }
    return (struct tiny_cell){-22 + field(s, 400, 8, 10), TINY_SOIL, 0};
}

static struct tiny_cell cell_at(void *ctx, const struct tiny_place *p)
{
    const struct spot s = spot_of(ctx, p);
    if (s.east > 2800 && s.north < -2600) {
        return (struct tiny_cell){-80, TINY_NONE, 0};
    }
    return is_sea(s) || ground_dm(s) == LAKE_DM ? (struct tiny_cell){-40, TINY_WATER, 0}
                                                : land_cell(s);
}

/* A multiple of 1/64 m, which the image holds exactly. */
static double elevation_at(void *ctx, const struct tiny_place *p)
{
    return floor_div(ground_dm(spot_of(ctx, p)) * 32, 5) / 64.0;
}

int golden_image(enum golden_place place, struct tiny_image *image)
{
    struct country country = countries[place];
    struct tiny_spec spec = tiny_spec_at(country.latitude_deg, country.longitude_deg);
    spec.shift0 = country.shift0;
    spec.rows = country.rows;
    spec.columns = country.columns;
    spec.level_count = country.levels;
    spec.margin = 2;
    spec.geoid_m = 48;
    spec.cell = cell_at;
    spec.elevation_m = elevation_at;
    spec.ctx = &country;
    return tiny_image_build(image, &spec) == 0 ? golden_add_signature(image) : -1;
}
