#include "hs/rng.h"

#include <math.h>

static uint64_t rotate_left(uint64_t x, int k)
{
    return (x << k) | (x >> (64 - k));
}

void hs_rng_seed(struct hs_rng *r, uint64_t seed)
{
    for (int i = 0; i < 4; i++) {
        seed += 0x9e3779b97f4a7c15u;
        uint64_t z = seed;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        r->s[i] = z ^ (z >> 31);
    }
}

uint64_t hs_rng_u64(struct hs_rng *r)
{
    uint64_t *s = r->s;
    const uint64_t result = rotate_left(s[1] * 5, 7) * 9;
    const uint64_t t = s[1] << 17;
    s[2] ^= s[0];
    s[3] ^= s[1];
    s[1] ^= s[2];
    s[0] ^= s[3];
    s[2] ^= t;
    s[3] = rotate_left(s[3], 45);
    return result;
}

double hs_rng_uniform(struct hs_rng *r)
{
    return (double)(hs_rng_u64(r) >> 11) * 0x1p-53;
}

double hs_rng_normal(struct hs_rng *r)
{
    /* Box-Muller; 1 - u keeps the logarithm away from zero. */
    const double radius = sqrt(-2.0 * log(1.0 - hs_rng_uniform(r)));
    return radius * cos(2.0 * 3.14159265358979323846 * hs_rng_uniform(r));
}

uint32_t hs_rng_below(struct hs_rng *r, uint32_t bound)
{
    const uint32_t reject_below = (0u - bound) % bound;
    uint32_t x;
    do {
        x = (uint32_t)(hs_rng_u64(r) >> 32);
    } while (x < reject_below);
    return x % bound;
}
