/* Smooth pseudo-random fields over the plane: the same for the same seed on every machine, at any
 * point, in any order. */
#ifndef SCENE_NOISE_H
#define SCENE_NOISE_H

#include <stdint.h>

/* Scatter the bits of up to three numbers (the finalizer of splitmix64). */
uint64_t noise_hash(uint64_t seed, int64_t a, int64_t b);

/* A number in [0, 1) that belongs to the pair (a, b). */
double noise_at(uint64_t seed, int64_t a, int64_t b);

/* Value noise of wavelength 1: continuous with its first derivative, within -1..1. */
double noise_value(uint64_t seed, double x, double y);

/* `octaves` of it, each half the wavelength and half the strength; within -1..1, wavelength 1. */
double noise_fractal(uint64_t seed, double x, double y, int octaves);

/* 0 below `low`, 1 above `high`, smooth between. low < high. */
double noise_step(double low, double high, double x);

#endif
