#include "realradar/speckle_statistics.h"

#include "hs/error.h"
#include "lm/grain.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static const double even_texture = 0.3, bright_db = 3;

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Mean and standard deviation in two passes. */
static double deviation_of(const double *power, size_t count, double (*map)(double), double *mean)
{
    double sum = 0, square = 0;
    for (size_t i = 0; i < count; i++) {
        sum += map(power[i]);
    }
    *mean = sum / (double)count;
    for (size_t i = 0; i < count; i++) {
        square += (map(power[i]) - *mean) * (map(power[i]) - *mean);
    }
    return sqrt(square / (double)(count - 1));
}

static double as_is(double power)
{
    return power;
}

static double decibels(double power)
{
    return 10 * log10(power);
}

static double distance_to_exponential(const double *sorted, size_t count, double mean)
{
    double distance = 0;
    for (size_t i = 0; i < count; i++) {
        const double law = 1 - exp(-sorted[i] / mean);
        const double below = law - (double)i / (double)count;
        const double above = (double)(i + 1) / (double)count - law;
        distance = fmax(distance, fmax(below, above));
    }
    return distance;
}

void rr_statistics_of(struct rr_statistics *s, double *power, size_t count)
{
    double mean_amplitude, mean_db;
    s->cv_intensity = deviation_of(power, count, as_is, &s->mean) / s->mean;
    s->cv_amplitude = deviation_of(power, count, sqrt, &mean_amplitude) / mean_amplitude;
    s->db_std = deviation_of(power, count, decibels, &mean_db);
    s->enl = 1 / (s->cv_intensity * s->cv_intensity);
    qsort(power, count, sizeof *power, compare);
    s->ks = distance_to_exponential(power, count, s->mean);
}

static double block_mean(const struct rr_image *image, int column, int row)
{
    double sum = 0;
    for (int y = row; y < row + RR_BLOCK_PX; y++) {
        for (int x = column; x < column + RR_BLOCK_PX; x++) {
            sum += image->power[(size_t)y * (size_t)image->side_px + (size_t)x];
        }
    }
    return sum / (RR_BLOCK_PX * RR_BLOCK_PX);
}

static struct rr_window judge(const struct rr_image *image, int column, int row)
{
    enum { ACROSS = RR_WINDOW_PX / RR_BLOCK_PX, BLOCKS = ACROSS * ACROSS };
    double means[BLOCKS], mean;
    for (int b = 0; b < BLOCKS; b++) {
        means[b] =
            block_mean(image, column + b % ACROSS * RR_BLOCK_PX, row + b / ACROSS * RR_BLOCK_PX);
    }
    const double deviation = deviation_of(means, BLOCKS, as_is, &mean);
    return (struct rr_window){column, row, mean, deviation / mean};
}

static int by_texture(const void *a, const void *b)
{
    return compare(&((const struct rr_window *)a)->texture,
                   &((const struct rr_window *)b)->texture);
}

static bool overlaps(const struct rr_window *a, const struct rr_window *b)
{
    return abs(a->column - b->column) < RR_WINDOW_PX && abs(a->row - b->row) < RR_WINDOW_PX;
}

int rr_choose_windows(const struct rr_image *image, double most_texture, struct rr_window *chosen,
                      int most)
{
    const int step = RR_WINDOW_PX / 2, across = (image->side_px - RR_WINDOW_PX) / step + 1;
    if (image->side_px < RR_WINDOW_PX) {
        return 0;
    }
    const size_t count = (size_t)across * (size_t)across;
    struct rr_window *all = malloc(count * sizeof *all);
    int kept = 0;
    for (size_t i = 0; all && i < count; i++) {
        all[i] = judge(image, (int)(i % (size_t)across) * step, (int)(i / (size_t)across) * step);
    }
    if (all) {
        qsort(all, count, sizeof *all, by_texture);
    }
    for (size_t i = 0; all && i < count && kept < most && all[i].texture <= most_texture; i++) {
        bool is_free = true;
        for (int k = 0; k < kept; k++) {
            is_free = is_free && !overlaps(&all[i], &chosen[k]);
        }
        if (is_free) {
            chosen[kept++] = all[i];
        }
    }
    free(all);
    return kept;
}

static int by_brightness(const void *a, const void *b)
{
    return compare(&((const struct rr_window *)b)->mean, &((const struct rr_window *)a)->mean);
}

int rr_ground_measure(struct rr_ground *ground, const struct rr_image *image,
                      const struct rr_resolution *resolution)
{
    enum { PIXELS = RR_WINDOW_PX * RR_WINDOW_PX };
    const double side_m = RR_WINDOW_PX * image->pixel_m;
    *ground = (struct rr_ground){
        .cells = side_m * side_m / (resolution->range_m * resolution->cross_m),
    };
    ground->count = rr_choose_windows(image, even_texture, ground->windows, RR_GROUND_MOST);
    double *power = calloc((size_t)(ground->count + 1) * PIXELS, sizeof *power);
    if (!power || ground->count == 0) {
        free(power);
        return hs_error("even ground", "make the picture larger",
                        ground->count ? "out of memory" : "the picture has none");
    }
    qsort(ground->windows, (size_t)ground->count, sizeof ground->windows[0], by_brightness);
    for (int i = 0; i < ground->count; i++) {
        const struct rr_window *w = &ground->windows[i];
        ground->bright += w->mean >= ground->windows[0].mean * pow(10, -bright_db / 10);
        rr_window_take(image, w, 1, power);
        rr_statistics_of(&ground->each[i], power, PIXELS);
    }
    for (int i = 0; i < ground->bright; i++) {
        rr_window_take(image, &ground->windows[i], ground->windows[i].mean, power + i * PIXELS);
    }
    rr_statistics_of(&ground->pooled, power, (size_t)ground->bright * PIXELS);
    free(power);
    return 0;
}

void rr_window_take(const struct rr_image *image, const struct rr_window *window, double divisor,
                    double *power)
{
    for (int y = 0; y < RR_WINDOW_PX; y++) {
        const double *row =
            image->power + (size_t)(window->row + y) * (size_t)image->side_px + window->column;
        for (int x = 0; x < RR_WINDOW_PX; x++) {
            power[y * RR_WINDOW_PX + x] = row[x] / divisor;
        }
    }
}

void rr_firmware_speckle(double *power, unsigned side, unsigned looks_log2, unsigned epoch)
{
    const struct lm_grain_place start = lm_grain_start(LM_GRAIN_SPECKLE, epoch);
    struct lm_grain_curve curve;
    lm_grain_curve_set(&curve, 256u << looks_log2);
    for (uint32_t row = 0; row < side; row++) {
        for (uint32_t column = 0; column < side; column++) {
            const struct lm_grain_place place = {start.row + row, start.column + column};
            const double level_db = lm_grain_db_q8(&curve, lm_grain_at(place)) / 256.0;
            power[row * side + column] = pow(10, level_db / 10);
        }
    }
}
