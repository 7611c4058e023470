#include "classify/judge.h"

#include "hs/error.h"
#include "hs/report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void mark_outside(struct db_judge *j, int band, const float *plane, const uint8_t *valid,
                         size_t count, uint8_t *reject)
{
    const float low = j->net->low[band], high = j->net->high[band];
    for (size_t i = 0; i < count; i++) {
        const uint8_t out = (plane[i] < low || plane[i] > high) && valid[i];
        j->by_band[band] += out;
        reject[i] |= out;
    }
}

void db_judge_add(struct db_judge *j, const float *planes, const float *margins,
                  const uint8_t *valid, size_t count, uint8_t *reject)
{
    memset(reject, 0, count);
    for (int b = 0; j->net->has_range && b < j->net->band_count; b++) {
        mark_outside(j, b, planes + (size_t)b * count, valid, count, reject);
    }
    const float least = margins ? (float)log(j->sure / (1 - j->sure)) : 0;
    for (size_t i = 0; i < count; i++) {
        j->pixels += valid[i];
        j->outside += reject[i];
        if (margins && margins[i] < least && valid[i]) {
            j->unsure++;
            reject[i] = 1;
        }
    }
}

static int worst_band(const struct db_judge *j)
{
    int worst = 0;
    for (int b = 1; b < j->net->band_count; b++) {
        worst = j->by_band[b] > j->by_band[worst] ? b : worst;
    }
    return worst;
}

static void report_outside(const struct db_judge *j, const char *image)
{
    const double share = (double)j->outside / (double)j->pixels;
    const int band = worst_band(j);
    if (j->net->has_range) {
        hs_report_put("outside_share", share);
        hs_report_put("outside_worst_band", band + 1);
        hs_report_put("outside_worst_band_share", (double)j->by_band[band] / (double)j->pixels);
    }
    if (!j->net->has_range) {
        printf(
            "range of the training: not in a network file of version 1; train again to have it\n");
        return;
    }
    printf("outside the range of the training: %.1f %% of the pixels", 100 * share);
    if (j->outside > 0) {
        printf("; most in band %d, %.1f %% outside %g..%g", band + 1,
               100 * (double)j->by_band[band] / (double)j->pixels, (double)j->net->low[band],
               (double)j->net->high[band]);
    }
    putchar('\n');
    if (share >= DB_OUTSIDE_WARN) {
        hs_warn(image, "check units, scaling, sensor and season; add exemplars of it; or --reject",
                "%.1f %% of its pixels lie outside the range that the network was trained on",
                100 * share);
    }
}

void db_judge_report(const struct db_judge *j, const char *image,
                     const struct db_class_table *table, const uint64_t counts[256])
{
    int largest = 0;
    for (int c = 1; c < table->count; c++) {
        largest = counts[c] > counts[largest] ? c : largest;
    }
    if (j->pixels == 0) {
        return;
    }
    report_outside(j, image);
    const double share = (double)counts[largest] / (double)j->pixels;
    hs_report_put("largest_class", table->items[largest].name);
    hs_report_put("largest_class_share", share);
    printf("largest class: %s, %.1f %%\n", table->items[largest].name, 100 * share);
    if (share >= DB_LARGEST_WARN) {
        hs_warn(image, "look at the picture (--picture) and check that the image fits the network",
                "%.1f %% of its pixels became %s", 100 * share, table->items[largest].name);
    }
}
