#include "build/facing.h"

#include "hs/error.h"
#include "hs/progress.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = LM_TILE_CELLS, REACH = 3, BLOCKS_AROUND = 4 /* that a sum takes from, and one */ };

/* UNSOURCED, chosen over Orihuela: a block's least size, and how much of the border must agree for
 * a direction. */
static const double block_m = 60, agreement_least = 0.08;

static const double pi = 3.14159265358979323846;

static bool is_structure(const struct lm_classes *classes, int number)
{
    return number != LM_DB_CLASS_NONE && classes->entry[number].kind == LM_KIND_STRUCTURE &&
           classes->entry[number].name[0] != '\0';
}

int build_facing_classes(struct build_facing *f, struct lm_classes *classes, int count)
{
    int structures = 0, used = count;
    *f = (struct build_facing){.facings = 0};
    for (int i = 0; i < count; i++) {
        structures += is_structure(classes, i);
    }
    for (int n = LM_FACINGS; structures > 0 && n >= 2 && f->facings == 0; n /= 2) {
        f->facings = structures * n <= LM_DB_CLASS_NONE - count ? n : 0;
    }
    for (int i = 0; i < count && f->facings > 0; i++) {
        if (!is_structure(classes, i)) {
            continue;
        }
        f->first[i] = (uint8_t)used;
        for (int n = 0; n < f->facings; n++) {
            classes->entry[used] = classes->entry[i];
            classes->entry[used++].facing = (uint8_t)(1 + n * LM_FACINGS / f->facings);
        }
    }
    return used;
}

/* ---- survey ---- */

/* Keep those of blocks 0..*count - 1 that lie around `from`, for `length`. */
static void keep_around(int64_t from, int64_t length, int shift, int *first, int *count)
{
    const int64_t low = (from >> shift) - BLOCKS_AROUND;
    const int64_t high = ((from + length) >> shift) + BLOCKS_AROUND + 1;
    const int64_t all = *count, begin = low < 0 ? 0 : low > all ? all : low;
    *first = (int)begin;
    *count = (int)((high < begin ? begin : high > all ? all : high) - begin);
}

static void narrow(struct build_facing *f, const struct image_area *within)
{
    const int64_t round = IMAGE_BAM_ROUND;
    int64_t east = (uint32_t)(within->west - f->west);
    east -= east >= round / 4 * 3 ? round : 0; /* as block_of counts */
    keep_around(within->south - f->south, within->north - within->south, f->latitude_shift,
                &f->row0, &f->rows);
    if (east + within->width <= round / 4 * 3) {
        keep_around(east, within->width, f->longitude_shift, &f->column0, &f->columns);
    }
}

/* The ground of the blocks that are kept. */
static struct image_area area_of(const struct build_facing *f)
{
    const int64_t south = f->south + ((int64_t)f->row0 << f->latitude_shift);
    const int64_t width = (int64_t)f->columns << f->longitude_shift;
    return (struct image_area){.south = south,
                               .north = south + ((int64_t)f->rows << f->latitude_shift),
                               .west =
                                   f->west + (uint32_t)((int64_t)f->column0 << f->longitude_shift),
                               .width = width < IMAGE_BAM_ROUND ? width : IMAGE_BAM_ROUND};
}

static int allocate(struct build_facing *f, const struct image_area *area, uint8_t shift0,
                    const struct image_area *within)
{
    int shift = shift0;
    while (ldexp(IMAGE_METRES_PER_BAM, shift) < block_m) {
        shift++;
    }
    int64_t latitude;
    uint32_t longitude;
    image_area_centre(area, &latitude, &longitude);
    f->latitude_shift = shift;
    f->longitude_shift = shift + (int)lm_db_zone((fx_bam_t)latitude);
    f->south = area->south;
    f->west = area->west;
    f->rows = (int)((area->north - area->south) >> f->latitude_shift) + 1;
    f->columns = (int)(area->width >> f->longitude_shift) + 1;
    if (within) {
        narrow(f, within);
    }
    f->blocks = calloc((size_t)f->rows * (size_t)f->columns + 1, sizeof *f->blocks);
    return f->blocks ? 0 : hs_error("facings", "choose larger cells", "out of memory");
}

/* Block of a place, in blocks from the corner of the survey. */
static void block_of(const struct build_facing *f, double latitude_bam, double longitude_bam,
                     double *row, double *column)
{
    const double round = 4294967296.0;
    double east = fmod(longitude_bam - (double)f->west, round);
    east += east < -0.25 * round ? round : 0;
    *row = ldexp(latitude_bam - (double)f->south, -f->latitude_shift) - f->row0;
    *column = ldexp(east, -f->longitude_shift) - f->column0;
}

/* Derivative of a Gaussian of 1.2 cells across, Gaussian along; i and k are -REACH..REACH. */
static double slope_weight(int i, int k)
{
    return i * exp(-(i * i + k * k) / (2 * 1.2 * 1.2));
}

/* Slope of the smoothed share of structures, per metre: at right angles to their borders. */
static void border_slope(const uint8_t stands[CELLS][CELLS], int r, int c, double north_m,
                         double east_m, double *north, double *east)
{
    static double weight[2 * REACH + 1][2 * REACH + 1]; /* [across][along] */
    if (weight[0][REACH] == 0) {
        for (int i = -REACH; i <= REACH; i++) {
            for (int k = -REACH; k <= REACH; k++) {
                weight[i + REACH][k + REACH] = slope_weight(i, k);
            }
        }
    }
    *north = *east = 0;
    for (int i = -REACH; i <= REACH; i++) {
        for (int k = -REACH; k <= REACH; k++) {
            *north += weight[i + REACH][k + REACH] * stands[r + i][c + k];
            *east += weight[k + REACH][i + REACH] * stands[r + i][c + k];
        }
    }
    *north /= north_m;
    *east /= east_m;
}

static void add_border(struct build_facing *f, double row, double column, double north, double east)
{
    const double length = hypot(north, east), direction = atan2(east, north);
    if (row < 0 || column < 0 || row >= f->rows || column >= f->columns || length <= 0) {
        return;
    }
    struct build_facing_sum *b = &f->blocks[(size_t)row * (size_t)f->columns + (size_t)column];
    b->cos4 += (float)(length * cos(4 * direction));
    b->sin4 += (float)(length * sin(4 * direction));
    b->length += (float)length;
}

static void survey_cells(struct build_facing *f, const uint8_t stands[CELLS][CELLS],
                         const struct image_frame *frame)
{
    const double middle = (double)frame->south + CELLS / 2 * (double)frame->latitude_step;
    const double north_m = (double)frame->latitude_step * IMAGE_METRES_PER_BAM;
    const double east_m =
        (double)frame->longitude_step * IMAGE_METRES_PER_BAM * cos(middle * pi / 2147483648.0);
    for (int r = REACH; r < CELLS - REACH; r++) {
        for (int c = REACH; c < CELLS - REACH; c++) {
            double north, east, row, column;
            border_slope(stands, r, c, north_m, east_m, &north, &east);
            block_of(f, (double)frame->south + (r + 0.5) * (double)frame->latitude_step,
                     (double)frame->west + (c + 0.5) * (double)frame->longitude_step, &row,
                     &column);
            add_border(f, row, column, north, east);
        }
    }
}

static int survey_tile(struct build_facing *f, const struct lm_classes *classes,
                       const struct resample_cover *cover, const struct image_frame *frame)
{
    static struct resample_sample samples[CELLS * CELLS];
    static uint8_t stands[CELLS][CELLS];
    const int found = resample_cover_tile(cover, frame, 1, samples);
    int structures = 0;
    for (int i = 0; found > 0 && i < CELLS * CELLS; i++) {
        const uint8_t is_one = is_structure(classes, samples[i].class_number);
        stands[i / CELLS][i % CELLS] = is_one;
        structures += is_one;
    }
    if (structures > 0) {
        survey_cells(f, (const uint8_t(*)[CELLS])stands, frame);
    }
    return found < 0 ? -1 : 0;
}

/* Sum each block with those around it, weights 1 4 6 4 1 both ways. */
static int spread_blocks(struct build_facing *f)
{
    static const float weight[5] = {1, 4, 6, 4, 1};
    const size_t count = (size_t)f->rows * (size_t)f->columns;
    struct build_facing_sum *wide = calloc(count + 1, sizeof *wide);
    if (!wide) {
        return hs_error("facings", "choose larger cells", "out of memory");
    }
    for (int pass = 0; pass < 2; pass++) {
        const struct build_facing_sum *from = pass == 0 ? f->blocks : wide;
        struct build_facing_sum *to = pass == 0 ? wide : f->blocks;
        memset(to, 0, count * sizeof *to);
        for (size_t i = 0; i < count; i++) {
            const int at =
                pass == 0 ? (int)(i % (size_t)f->columns) : (int)(i / (size_t)f->columns);
            const int end = pass == 0 ? f->columns : f->rows;
            const size_t step = pass == 0 ? 1 : (size_t)f->columns;
            for (int k = -2; k <= 2; k++) {
                if (at + k >= 0 && at + k < end) {
                    const struct build_facing_sum *s =
                        k < 0 ? &from[i - step * (size_t)-k] : &from[i + step * (size_t)k];
                    to[i].cos4 += weight[k + 2] * s->cos4;
                    to[i].sin4 += weight[k + 2] * s->sin4;
                    to[i].length += weight[k + 2] * s->length;
                }
            }
        }
    }
    free(wide);
    return 0;
}

/* Entries of the finest level: only they are surveyed. */
static uint64_t finest_entries(const struct build_plan *plan)
{
    uint64_t entries = 0;
    for (int i = 0; i < plan->band_count; i++) {
        const struct lm_band *band = &plan->bands[i];
        entries += band->lod == 0 ? (uint64_t)band->rows * band->columns : 0;
    }
    return entries;
}

static int survey_bands(struct build_facing *f, const struct lm_classes *classes,
                        const struct resample_cover *cover, const struct build_plan *plan)
{
    struct hs_progress progress;
    hs_progress_begin(&progress, "facings", finest_entries(plan));
    const struct image_area kept = area_of(f);
    uint64_t done = 0;
    int result = 0;
    for (int i = 0; i < plan->band_count; i++) {
        const struct lm_band *band = &plan->bands[i];
        for (uint32_t k = 0; band->lod == 0 && result == 0 && k < band->rows * band->columns; k++) {
            const uint32_t round = image_columns_round(plan->shift0, band->zone) - 1;
            const struct image_frame frame =
                image_frame_of(plan->shift0, band->zone, band->row0 + k / band->columns,
                               (band->column0 + k % band->columns) & round);
            const struct image_area area = image_frame_area(&frame);
            if (image_areas_meet(&area, &kept)) {
                result = survey_tile(f, classes, cover, &frame);
            }
            hs_progress_update(&progress, ++done);
        }
    }
    hs_progress_end(&progress);
    return result;
}

int build_facing_survey(struct build_facing *f, const struct lm_classes *classes,
                        const struct resample_cover *cover, const struct build_plan *plan,
                        const struct image_area *within)
{
    if (f->facings == 0 || !cover->classes.dataset) {
        return 0;
    }
    struct resample_cover alone = *cover;
    alone.reflectivity.dataset = alone.heights.dataset = NULL;
    if (allocate(f, &cover->area, plan->shift0, within) != 0) {
        return -1;
    }
    return survey_bands(f, classes, &alone, plan) != 0 ? -1 : spread_blocks(f);
}

void build_facing_free(struct build_facing *f)
{
    free(f->blocks);
    *f = (struct build_facing){0};
}

/* ---- use ---- */

/* The sums at a place, bilinear between the middles of blocks. */
static struct build_facing_sum sum_at(const struct build_facing *f, double row, double column)
{
    const double y = row - 0.5, x = column - 0.5;
    const int r = (int)floor(y), c = (int)floor(x);
    struct build_facing_sum s = {0};
    for (int i = 0; i < 4; i++) {
        const int br = r + i / 2, bc = c + i % 2;
        if (br < 0 || bc < 0 || br >= f->rows || bc >= f->columns) {
            continue;
        }
        const float weight = (float)((1 - fabs(y - br)) * (1 - fabs(x - bc)));
        const struct build_facing_sum *b = &f->blocks[(size_t)br * (size_t)f->columns + (size_t)bc];
        s.cos4 += weight * b->cos4;
        s.sin4 += weight * b->sin4;
        s.length += weight * b->length;
    }
    return s;
}

double build_facing_at(const struct build_facing *f, double latitude_bam, double longitude_bam)
{
    double row, column;
    if (!f->blocks) {
        return -1;
    }
    block_of(f, latitude_bam, longitude_bam, &row, &column);
    const struct build_facing_sum s = sum_at(f, row, column);
    const double cos4 = (double)s.cos4, sin4 = (double)s.sin4;
    if (s.length <= 0 || hypot(cos4, sin4) < agreement_least * (double)s.length) {
        return -1;
    }
    const double degrees = atan2(sin4, cos4) * (45 / pi);
    return degrees < 0 ? degrees + 90 : degrees;
}

uint8_t build_facing_number(const struct build_facing *f, uint8_t class_number, double degrees)
{
    const uint8_t first = f->first[class_number];
    const double turn = fmod(fmod(degrees, 90) + 90, 90);
    return first == 0 ? class_number
                      : (uint8_t)(first + (int)lround(turn * f->facings / 90) % f->facings);
}

uint8_t build_facing_class(const struct build_facing *f, uint8_t class_number, double latitude_bam,
                           double longitude_bam)
{
    const bool has_facings = f->first[class_number] != 0;
    const double degrees = has_facings ? build_facing_at(f, latitude_bam, longitude_bam) : -1;
    return degrees < 0 ? class_number : build_facing_number(f, class_number, degrees);
}
