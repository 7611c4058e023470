#include "noise.h"

#include <math.h>

uint64_t noise_hash(uint64_t seed, int64_t a, int64_t b)
{
    uint64_t z = seed + (uint64_t)a * 0x9e3779b97f4a7c15u + (uint64_t)b * 0xd1342543de82ef95u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

double noise_at(uint64_t seed, int64_t a, int64_t b)
{
    return (double)(noise_hash(seed, a, b) >> 11) * 0x1p-53;
}

double noise_value(uint64_t seed, double x, double y)
{
    const double fx = floor(x), fy = floor(y);
    const int64_t ix = (int64_t)fx, iy = (int64_t)fy;
    const double tx = x - fx, ty = y - fy;
    const double sx = tx * tx * (3 - 2 * tx), sy = ty * ty * (3 - 2 * ty);
    const double a = noise_at(seed, ix, iy), b = noise_at(seed, ix + 1, iy);
    const double c = noise_at(seed, ix, iy + 1), d = noise_at(seed, ix + 1, iy + 1);
    const double top = a + (b - a) * sx, bottom = c + (d - c) * sx;
    return 2 * (top + (bottom - top) * sy) - 1;
}

double noise_fractal(uint64_t seed, double x, double y, int octaves)
{
    double sum = 0, strength = 0.5, total = 0;
    for (int i = 0; i < octaves; i++) {
        sum += strength * noise_value(seed + (uint64_t)i, x, y);
        total += strength;
        /* Turned a little each time, so that the lattice does not show. */
        const double turned = 1.6 * x + 1.2 * y;
        y = 1.6 * y - 1.2 * x;
        x = turned;
        strength *= 0.5;
    }
    return sum / total;
}

double noise_step(double low, double high, double x)
{
    const double t = (x - low) / (high - low);
    return t <= 0 ? 0 : t >= 1 ? 1 : t * t * (3 - 2 * t);
}
