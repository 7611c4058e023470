#include "netem/dataset.h"

#include "hs/error.h"
#include "hs/progress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double nm_frame_mean(const struct nm_picture *p)
{
    const int left = p->width / 8, top = p->height / 8;
    double sum = 0;
    int count = 0;
    for (int y = 0; y < p->height; y++) {
        for (int x = 0; x < p->width; x++) {
            if (x < left || x >= p->width - left || y < top || y >= p->height - top) {
                sum += p->pixels[y * p->width + x];
                count++;
            }
        }
    }
    return count > 0 ? sum / count : 0;
}

static void turn_upside_down(struct nm_picture *p)
{
    for (int y = 0; y < p->height / 2; y++) {
        for (int x = 0; x < p->width; x++) {
            double *upper = &p->pixels[y * p->width + x];
            double *lower = &p->pixels[(p->height - 1 - y) * p->width + x];
            const double kept = *upper;
            *upper = *lower;
            *lower = kept;
        }
    }
}

static int calibrate(struct nm_chip *chip, struct nm_chip_entry *entry,
                     const struct nm_calibration *c, const char *path)
{
    const int count = chip->picture.width * chip->picture.height;
    if (isnan(entry->gain)) {
        entry->gain = isnan(c->gain) ? c->clutter / nm_frame_mean(&chip->picture) : c->gain;
    }
    if (!isfinite(entry->gain)) {
        return hs_error(path, "give its gain", "has no clutter to be calibrated by");
    }
    for (int i = 0; i < count; i++) {
        double *p = &chip->picture.pixels[i];
        *p = c->is_normalised ? fmin(*p, 1) : tanh(entry->gain * *p);
    }
    return 0;
}

int nm_dataset_chip(struct nm_chip *chip, struct nm_chip_entry *entry,
                    const struct nm_calibration *c)
{
    if (nm_chip_read(chip, entry->path) != 0) {
        return -1;
    }
    if (calibrate(chip, entry, c, entry->path) != 0) {
        nm_picture_close(&chip->picture);
        return -1;
    }
    if (!c->is_near_on_top) {
        turn_upside_down(&chip->picture);
    }
    if (!isnan(entry->azimuth_deg)) {
        chip->azimuth_deg = entry->azimuth_deg;
    }
    if (!isnan(entry->depression_deg)) {
        chip->depression_deg = entry->depression_deg;
    }
    return 0;
}

/* The shift of the list is right and down on the file's picture. */
static struct nm_origin origin_of(const struct nm_chip *chip, const struct nm_chip_entry *e,
                                  const struct nm_calibration *c, int side)
{
    struct nm_origin o = nm_picture_middle(&chip->picture, side);
    o.x += e->shift_x;
    o.y += c->is_near_on_top ? e->shift_y : -e->shift_y;
    return o;
}

int nm_sample_draw(struct nm_sample *sample, const struct setup *setup,
                   const struct reflect_law *law)
{
    const size_t cells = (size_t)setup->cells * (size_t)setup->cells;
    sample->own = malloc(cells * sizeof *sample->own);
    sample->own_amplitudes =
        malloc(cells / (NM_CELLS_PER_PIXEL * NM_CELLS_PER_PIXEL) * sizeof *sample->own_amplitudes);
    if (!sample->own || !sample->own_amplitudes) {
        return hs_error("chips", "take fewer of them", "out of memory");
    }
    return nm_draw_by_law(&sample->paths, law, sample->own) == 0
               ? nm_law_amplitudes(setup, sample->own, sample->own_amplitudes)
               : -1;
}

static int trace_sample(struct nm_sample *sample, const struct nm_target_view *view,
                        double azimuth_deg, double depression_deg, struct reflect_law *law)
{
    return nm_target_view_paths(view, azimuth_deg, depression_deg, &sample->paths, law) == 0
               ? nm_sample_draw(sample, &view->setup, law)
               : -1;
}

static int load_sample(struct nm_sample *sample, struct nm_chip_entry *entry,
                       const struct nm_target_view *view, const struct nm_calibration *c,
                       struct reflect_law *law)
{
    struct nm_chip chip;
    struct nm_chip_entry e = *entry;
    if (nm_dataset_chip(&chip, &e, c) != 0) {
        return -1;
    }
    sample->real = chip.picture;
    sample->origin = origin_of(&chip, &e, c, (int)view->setup.cells / NM_CELLS_PER_PIXEL);
    sample->azimuth_deg = chip.azimuth_deg;
    memcpy(sample->name, chip.name, sizeof sample->name - 1);
    if (isnan(chip.azimuth_deg) || isnan(chip.depression_deg)) {
        return hs_error(entry->path, "find it with `register`, or write it into a list",
                        "does not say from where it was taken");
    }
    const double azimuth_deg = c->is_counted_left ? -chip.azimuth_deg : chip.azimuth_deg;
    return trace_sample(sample, view, azimuth_deg + c->turn_deg, chip.depression_deg, law);
}

/* Where each entry goes: those that the list decides, and of the others a share drawn by lot. */
static void divide(const struct nm_chip_list *list, double share, uint64_t seed, int *is_training)
{
    struct hs_rng rng;
    int open = 0;
    hs_rng_seed(&rng, seed);
    for (int i = 0; i < list->count; i++) {
        is_training[i] = list->entries[i].set == NM_SET_TRAINING;
        open += list->entries[i].set == NM_SET_OPEN;
    }
    for (int wanted = (int)lround(share * open), i = 0; i < list->count; i++) {
        if (list->entries[i].set == NM_SET_OPEN) {
            is_training[i] = (int)hs_rng_below(&rng, (uint32_t)open--) < wanted;
            wanted -= is_training[i];
        }
    }
}

/* Training first, then validation, each in the order of the list. */
static int load_all(struct nm_dataset *d, const struct nm_chip_list *list, const int *is_training,
                    const struct nm_target_view *view, const struct nm_calibration *c)
{
    struct hs_progress progress;
    int result = 0;
    hs_progress_begin(&progress, "tracing", (uint64_t)list->count);
    for (int turn = 1; turn >= 0 && result == 0; turn--) {
        for (int i = 0; i < list->count && result == 0; i++) {
            if (is_training[i] == turn) {
                d->training += turn;
                result = load_sample(&d->samples[d->count++], &list->entries[i], view, c, &d->law);
                hs_progress_update(&progress, (uint64_t)d->count);
            }
        }
    }
    hs_progress_end(&progress);
    return result;
}

int nm_dataset_load(struct nm_dataset *d, const struct nm_chip_list *list,
                    const struct nm_target_view *view, const struct nm_calibration *calibration,
                    double share, uint64_t seed)
{
    *d = (struct nm_dataset){.samples = calloc((size_t)list->count, sizeof *d->samples)};
    int *is_training = malloc((size_t)list->count * sizeof *is_training);
    int result = d->samples && is_training ? 0 : hs_error("chips", NULL, "out of memory");
    if (result == 0) {
        divide(list, share, seed, is_training);
        result = load_all(d, list, is_training, view, calibration);
    }
    free(is_training);
    if (result != 0) {
        nm_dataset_free(d);
    }
    return result;
}

void nm_dataset_free(struct nm_dataset *d)
{
    for (int i = 0; d->samples && i < d->count; i++) {
        nm_sample_free(&d->samples[i]);
    }
    free(d->samples);
    *d = (struct nm_dataset){0};
}

struct nm_samples nm_dataset_training(const struct nm_dataset *d)
{
    return (struct nm_samples){d->samples, d->training};
}

struct nm_samples nm_dataset_validation(const struct nm_dataset *d)
{
    return (struct nm_samples){d->samples + d->training, d->count - d->training};
}
