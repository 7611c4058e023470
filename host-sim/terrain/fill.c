#include "fill.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { RELAXATIONS = 20 };

struct picture {
    int width, height;
    float *metres;
    const uint8_t *is_known;
};

static size_t index_of(const struct picture *p, int x, int y)
{
    return (size_t)y * (size_t)p->width + (size_t)x;
}

static int clamp(int value, int high)
{
    return value < 0 ? 0 : value > high ? high : value;
}

/* The mean of the known pixels of each 2 x 2. */
static void halve(const struct picture *fine, struct picture *coarse, uint8_t *is_known)
{
    for (int v = 0; v < coarse->height; v++) {
        for (int u = 0; u < coarse->width; u++) {
            float sum = 0.0f;
            int count = 0;
            for (int k = 0; k < 4; k++) {
                const int x = 2 * u + k % 2, y = 2 * v + k / 2;
                if (x < fine->width && y < fine->height && fine->is_known[index_of(fine, x, y)]) {
                    sum += fine->metres[index_of(fine, x, y)];
                    count++;
                }
            }
            const size_t to = index_of(coarse, u, v);
            coarse->metres[to] = count > 0 ? sum / (float)count : 0.0f;
            is_known[to] = count > 0;
        }
    }
}

/* Bilinear: the centre of a fine pixel lies a quarter of a coarse one from the nearest centre. */
static float sample_half(const struct picture *coarse, int x, int y)
{
    const int u = clamp(x / 2, coarse->width - 1), v = clamp(y / 2, coarse->height - 1);
    const int u2 = clamp(u + (x % 2 ? 1 : -1), coarse->width - 1);
    const int v2 = clamp(v + (y % 2 ? 1 : -1), coarse->height - 1);
    const float *z = coarse->metres;
    /* The coarse picture was filled whole.
     * NOLINTBEGIN(clang-analyzer-core.UndefinedBinaryOperatorResult) */
    const float near = 0.75f * z[index_of(coarse, u, v)] + 0.25f * z[index_of(coarse, u2, v)];
    const float far = 0.75f * z[index_of(coarse, u, v2)] + 0.25f * z[index_of(coarse, u2, v2)];
    /* NOLINTEND(clang-analyzer-core.UndefinedBinaryOperatorResult) */
    return 0.75f * near + 0.25f * far;
}

static void take_from(const struct picture *coarse, struct picture *fine)
{
    for (int y = 0; y < fine->height; y++) {
        for (int x = 0; x < fine->width; x++) {
            if (!fine->is_known[index_of(fine, x, y)]) {
                fine->metres[index_of(fine, x, y)] = sample_half(coarse, x, y);
            }
        }
    }
}

/* Each unknown pixel becomes the mean of its neighbours; beyond the picture it is its own
 * neighbour. */
static void relax(struct picture *p)
{
    float *z = p->metres;
    for (int y = 0; y < p->height; y++) {
        for (int x = 0; x < p->width; x++) {
            if (!p->is_known[index_of(p, x, y)]) {
                z[index_of(p, x, y)] = 0.25f * (z[index_of(p, clamp(x - 1, p->width - 1), y)] +
                                                z[index_of(p, clamp(x + 1, p->width - 1), y)] +
                                                z[index_of(p, x, clamp(y - 1, p->height - 1))] +
                                                z[index_of(p, x, clamp(y + 1, p->height - 1))]);
            }
        }
    }
}

static int fill(struct picture *p)
{
    const size_t count = (size_t)p->width * (size_t)p->height;
    if (count == 1 || !memchr(p->is_known, 0, count)) {
        return 0;
    }
    struct picture half = {.width = (p->width + 1) / 2, .height = (p->height + 1) / 2};
    const size_t half_count = (size_t)half.width * (size_t)half.height;
    uint8_t *half_known = malloc(half_count);
    half.metres = malloc(half_count * sizeof *half.metres);
    half.is_known = half_known;
    int result = -1;
    if (half.metres && half_known) {
        halve(p, &half, half_known);
        result = fill(&half);
    }
    if (result == 0) {
        take_from(&half, p);
        for (int i = 0; i < RELAXATIONS; i++) {
            relax(p);
        }
    }
    free(half.metres);
    free(half_known);
    return result;
}

int terrain_fill(int width, int height, float *metres, const uint8_t *is_known)
{
    struct picture p = {width, height, metres, is_known};
    return fill(&p);
}
