/* Speckle statistics of even ground: the distance from the exponential law of one look. */
#ifndef REALRADAR_SPECKLE_STATISTICS_H
#define REALRADAR_SPECKLE_STATISTICS_H

#include "realradar/backproject.h"

struct rr_statistics {
    double mean;
    double cv_intensity; /* standard deviation over mean of the power; theory 1 */
    double cv_amplitude; /* of its root; theory sqrt(4/pi - 1) = 0.523 */
    double db_std;       /* of its decibels; theory 10 log10(e) pi/sqrt(6) = 5.57 dB */
    double ks;           /* largest distance to the exponential distribution of the same mean */
    double enl;          /* 1 / cv_intensity^2; theory 1 */
};

/* `power` is sorted by the call. All values must be positive; count > 1. */
void rr_statistics_of(struct rr_statistics *statistics, double *power, size_t count);

/* A square of even ground in a picture. */
struct rr_window {
    int column, row; /* of its upper left pixel */
    double mean;
    double texture; /* standard deviation over mean of the means of its 16 blocks */
};

enum { RR_WINDOW_PX = 64, RR_BLOCK_PX = 16, RR_GROUND_MOST = 64 };

/* Cut the picture into squares of RR_WINDOW_PX, overlapping by half, and keep, least textured
 * first, those of a texture up to `most_texture` that do not overlap. Texture is judged by the
 * means of blocks that hold many resolution cells each, so that the choice says little about the
 * speckle within them. Returns how many of `most` were kept. */
int rr_choose_windows(const struct rr_image *image, double most_texture, struct rr_window *chosen,
                      int most);

/* Even ground in a picture, in two kinds: within 3 dB of the brightest (grass), and darker (roads).
 */
struct rr_ground {
    struct rr_window windows[RR_GROUND_MOST]; /* brightest first */
    struct rr_statistics each[RR_GROUND_MOST];
    int count, bright;           /* the first `bright` are of the bright kind */
    double cells;                /* resolution cells in a window: independent values */
    struct rr_statistics pooled; /* of the bright ones, each over its own mean */
};

/* Windows of texture up to 0.3: pure speckle of 23 cells a block has 0.21. Returns 0, or -1 with
 * the error reported, also when there is no even window. */
int rr_ground_measure(struct rr_ground *ground, const struct rr_image *image,
                      const struct rr_resolution *resolution);

/* The window's pixels, divided by `divisor`, into RR_WINDOW_PX^2 values. */
void rr_window_take(const struct rr_image *image, const struct rr_window *window, double divisor,
                    double *power);

/* The power of `side` x `side` cells of the firmware's speckle, as the display unit draws it: its
 * table, indexed by its hash of cell and epoch. `looks_log2` is 0..4. */
void rr_firmware_speckle(double *power, unsigned side, unsigned looks_log2, unsigned epoch);

#endif
