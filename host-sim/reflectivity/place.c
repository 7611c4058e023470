#include "reflectivity/place.h"

#include <math.h>

/* WGS-84 (EQUATIONS.md, [NIMA]). */
static const double semi_major_m = 6378137.0, eccentricity2 = 0.00669437999014;

struct reflect_tangent reflect_tangent_at(double latitude, double longitude)
{
    struct reflect_tangent t = {.sin_latitude = sin(latitude),
                                .cos_latitude = cos(latitude),
                                .sin_longitude = sin(longitude),
                                .cos_longitude = cos(longitude)};
    const double normal = semi_major_m / sqrt(1 - eccentricity2 * t.sin_latitude * t.sin_latitude);
    t.at = (struct reflect_place){normal * t.cos_latitude * t.cos_longitude,
                                  normal * t.cos_latitude * t.sin_longitude,
                                  normal * (1 - eccentricity2) * t.sin_latitude};
    return t;
}

struct reflect_place reflect_place_at(double latitude, double longitude)
{
    return reflect_tangent_at(latitude, longitude).at;
}

struct reflect_place reflect_place_beside(const struct reflect_tangent *t, double east_m,
                                          double north_m)
{
    const double inward = -t->sin_latitude * north_m;
    return (struct reflect_place){t->at.x - t->sin_longitude * east_m + t->cos_longitude * inward,
                                  t->at.y + t->cos_longitude * east_m + t->sin_longitude * inward,
                                  t->at.z + t->cos_latitude * north_m};
}

/* Corner of the lattice, and the place in its cube, 0..1. */
struct cube {
    int64_t x, y, z;
    double in_x, in_y, in_z;
};

/* Without a call of the library, as which compilers make floor(). */
static int64_t floor_of(double x)
{
    const int64_t whole = (int64_t)x;
    return whole - (x < (double)whole);
}

static struct cube cube_of(struct reflect_place p, double step_m)
{
    const double x = p.x / step_m, y = p.y / step_m, z = p.z / step_m;
    const int64_t cx = floor_of(x), cy = floor_of(y), cz = floor_of(z);
    return (struct cube){cx, cy, cz, x - (double)cx, y - (double)cy, z - (double)cz};
}

/* Multiples of odd numbers. */
static uint64_t of_seed(uint64_t seed)
{
    return seed * 0xaef17502108ef2d9u;
}

static uint64_t of_x(int64_t x)
{
    return (uint64_t)x * 0xd1342543de82ef95u;
}

static uint64_t of_y(int64_t y)
{
    return (uint64_t)y * 0x9e3779b97f4a7c15u;
}

static uint64_t of_z(int64_t z)
{
    return (uint64_t)z * 0xc2b2ae3d27d4eb4fu;
}

/* The finishing steps of splitmix64 over their sum. */
static uint64_t finish(uint64_t h)
{
    h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9u;
    h = (h ^ h >> 27) * 0x94d049bb133111ebu;
    return h ^ h >> 31;
}

static uint64_t hash(uint64_t seed, int64_t x, int64_t y, int64_t z)
{
    return finish(of_seed(seed) + of_x(x) + of_y(y) + of_z(z));
}

/* Nearly normal, mean 0 and variance 1: how many of 64 bits are set, which is binomial, and a step
 * of the width of one. */
static double normal_of(uint64_t bits)
{
    const uint64_t pairs = bits - (bits >> 1 & 0x5555555555555555u);
    const uint64_t fours = (pairs & 0x3333333333333333u) + (pairs >> 2 & 0x3333333333333333u);
    const uint64_t bytes = (fours + (fours >> 4)) & 0x0f0f0f0f0f0f0f0fu;
    const int set = (int)(bytes * 0x0101010101010101u >> 56);
    const double step = (double)(int32_t)(bits * 0xd6e8feb86659fd93u >> 33) * (1.0 / 2147483648.0);
    return (set + step - 32.5) * 0.24935;
}

static double smooth_step(double t)
{
    return t * t * (3 - 2 * t);
}

double reflect_pattern_smooth(uint64_t seed, struct reflect_place p, double step_m)
{
    const struct cube c = cube_of(p, step_m);
    const double u = smooth_step(c.in_x), v = smooth_step(c.in_y), w = smooth_step(c.in_z);
    const double east[2] = {1 - u, u}, north[2] = {1 - v, v}, up[2] = {1 - w, w};
    const uint64_t first = of_seed(seed) + of_x(c.x) + of_y(c.y) + of_z(c.z);
    double sum = 0, square = 0;
    for (int i = 0; i < 8; i++) {
        const int x = i & 1, y = i >> 1 & 1, z = i >> 2;
        const double weight = east[x] * north[y] * up[z];
        sum += weight * normal_of(finish(first + of_x(x) + of_y(y) + of_z(z)));
        square += weight * weight;
    }
    return sum / sqrt(square);
}

/* A point within a quarter of a step of each corner; the nearest of the eight around counts. One
 * farther off may be nearer still: then the parcel ends at the face of the cube, as good a border
 * as any. */
double reflect_pattern_parcels(uint64_t seed, struct reflect_place p, double step_m)
{
    const struct cube c = cube_of(p, step_m);
    double nearest = HUGE_VAL;
    uint64_t parcel = 0;
    for (int i = 0; i < 8; i++) {
        const int x = i & 1, y = i >> 1 & 1, z = i >> 2;
        const uint64_t h = hash(seed, c.x + x, c.y + y, c.z + z);
        const double quarter = 1.0 / (1 << 21) / 2;
        const double dx = x + (double)(h & 0xfffff) * quarter - 0.25 - c.in_x;
        const double dy = y + (double)(h >> 20 & 0xfffff) * quarter - 0.25 - c.in_y;
        const double dz = z + (double)(h >> 40 & 0xfffff) * quarter - 0.25 - c.in_z;
        const double distance = dx * dx + dy * dy + dz * dz;
        parcel = distance < nearest ? h : parcel;
        nearest = distance < nearest ? distance : nearest;
    }
    return normal_of(hash(parcel, 1, 2, 3));
}

double reflect_pattern_spots(uint64_t seed, struct reflect_place p, double share)
{
    /* A ball that lies inside its cube and is met by the ground in a disc. It has
     * 4/3 pi 0.3^3 = 0.1131 of the cube. */
    const double step_m = 8, radius = 0.3, whole = 0.113097;
    const struct cube c = cube_of(p, step_m);
    const uint64_t h = hash(seed, c.x, c.y, c.z);
    const double part = (1 - 2 * radius) / 65535;
    const double dx = radius + part * (double)(h & 0xffff) - c.in_x;
    const double dy = radius + part * (double)(h >> 16 & 0xffff) - c.in_y;
    const double dz = radius + part * (double)(h >> 32 & 0xffff) - c.in_z;
    if (dx * dx + dy * dy + dz * dz > radius * radius) {
        return -1;
    }
    const uint64_t drawn = hash(h, 4, 5, 6);
    const double unit = 1.0 / 4294967296.0;
    return (double)(drawn >> 32) * unit < share / whole ? (double)(drawn & 0xffffffff) * unit : -1;
}
