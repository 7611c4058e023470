#include "image/picture.h"

#include "hs/error.h"
#include "hs/progress.h"
#include "image/codes.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

const char *const image_plane_names[IMAGE_PLANES] = {"reflectivity", "class", "elevation", "height",
                                                     "shade"};

static struct image_area level_area(const struct image *image, int level)
{
    struct image_area all = {0};
    for (uint32_t i = 0; i < image->header.band_count; i++) {
        const struct lm_band *b = &image->db.bands[i];
        if (b->lod != level) {
            continue;
        }
        const uint8_t shift = (uint8_t)(image->header.shift0 + level);
        const struct image_frame first = image_frame_of(shift, b->zone, b->row0, b->column0);
        const struct image_area area = {
            first.south, first.south + ((int64_t)b->rows << (shift + LM_TILE_CELLS_LOG2)),
            first.west, (int64_t)b->columns << (shift + b->zone + LM_TILE_CELLS_LOG2)};
        image_area_add(&all, &area);
    }
    return all;
}

static double narrowing(const struct image_area *area)
{
    int64_t latitude;
    uint32_t longitude;
    image_area_centre(area, &latitude, &longitude);
    return fmax(0.01, cos(image_degrees(latitude) * (3.14159265358979323846 / 180.0)));
}

/* Size in pixels of `bam` of latitude a side. */
static void set_size(struct image_view *v, double pixel_bam)
{
    v->height = (int)fmax(1.0, ceil((double)(v->area.north - v->area.south) / pixel_bam - 1e-9));
    v->width = (int)fmax(1.0, ceil((double)v->area.width * narrowing(&v->area) / pixel_bam - 1e-9));
    v->pixel_m = pixel_bam * IMAGE_METRES_PER_BAM;
}

int image_view_fit(const struct image *image, struct image_view *v, int level, int max_size)
{
    const bool is_whole = v->area.width == 0;
    const int first = level >= 0 ? level : 0;
    const int last = level >= 0 ? level : image->header.lod_count - 1;
    for (v->level = first; v->level <= last; v->level++) {
        const double cell = ldexp(1.0, image->header.shift0 + v->level);
        if (is_whole) {
            v->area = level_area(image, v->level);
        }
        if (v->area.width == 0) {
            continue;
        }
        set_size(v, cell);
        if (v->width <= max_size && v->height <= max_size) {
            return 0;
        }
    }
    v->level = last;
    if (v->area.width == 0) {
        return hs_error("--level", "choose another one", "there is no tile on it");
    }
    const double north = (double)(v->area.north - v->area.south);
    const double east = (double)v->area.width * narrowing(&v->area);
    set_size(v, fmax(north, east) / max_size);
    return 0;
}

int image_view_cells(const struct image *image, struct image_view *v, int level)
{
    const int shift = image->header.shift0 + level;
    int zone = -1;
    for (uint32_t i = 0; i < image->header.band_count; i++) {
        const struct lm_band *b = &image->db.bands[i];
        zone = b->lod == level && (zone < 0 || b->zone < zone) ? b->zone : zone;
    }
    if (zone < 0) {
        return hs_error("--level", "choose another one", "there is no tile on it");
    }
    v->level = level;
    if (v->area.width == 0) {
        v->area = level_area(image, level);
    }
    const int64_t high = (int64_t)1 << shift, wide = (int64_t)1 << (shift + zone);
    const int64_t west = (int64_t)v->area.west & ~(wide - 1);
    const int64_t east = ((int64_t)v->area.west + v->area.width + wide - 1) & ~(wide - 1);
    v->area.west = (uint32_t)west;
    v->area.width = east - west;
    v->area.south &= ~(high - 1);
    v->area.north = (v->area.north + high - 1) & ~(high - 1);
    v->width = (int)(v->area.width / wide);
    v->height = (int)((v->area.north - v->area.south) / high);
    v->pixel_m = ldexp(IMAGE_METRES_PER_BAM, shift);
    return 0;
}

static const struct lm_tile *sound_tile(struct image_look *l, uint32_t entry, uint8_t level,
                                        uint32_t row, uint32_t column)
{
    const struct lm_tile *t = image_entry_tile(l->image, entry);
    if (l->checked[entry] == 0 && !t) {
        l->checked[entry] = 3;
    } else if (l->checked[entry] == 0) {
        const bool is_sound = lm_tile_check(t, level, row, column) == LM_OK;
        l->checked[entry] = is_sound ? 1 : 2;
        l->damaged += !is_sound;
    }
    return l->checked[entry] == 1 ? t : NULL;
}

int image_look_begin(struct image_look *l, const struct image *image)
{
    *l = (struct image_look){.image = image, .checked = calloc(image->header.entry_count + 1u, 1)};
    return l->checked ? 0 : hs_error("image", NULL, "out of memory");
}

void image_look_end(struct image_look *l)
{
    free(l->checked);
    *l = (struct image_look){0};
}

bool image_look_at(struct image_look *l, int level, int64_t latitude, uint32_t longitude,
                   struct image_spot *s)
{
    const struct image *image = l->image;
    for (int k = level; k < image->header.lod_count; k++) {
        s->shift = (uint8_t)(image->header.shift0 + k);
        const uint32_t row = image_row_of(s->shift, latitude);
        s->zone = image_row_zone(s->shift, row);
        const int east_shift = s->shift + s->zone;
        const uint32_t column = longitude >> (east_shift + LM_TILE_CELLS_LOG2);
        const int64_t entry = lm_db_entry(&image->db, (uint8_t)k, row, column);
        s->tile = entry < 0 ? NULL : sound_tile(l, (uint32_t)entry, (uint8_t)k, row, column);
        if (s->tile) {
            const uint32_t up = (uint32_t)(latitude + IMAGE_BAM_QUARTER);
            s->row = (int)(up >> s->shift & (LM_TILE_CELLS - 1));
            s->column = (int)(longitude >> east_shift & (LM_TILE_CELLS - 1));
            s->north = (double)(up & ((1u << s->shift) - 1)) / ldexp(1.0, s->shift);
            s->east = (double)(longitude & ((1u << east_shift) - 1)) / ldexp(1.0, east_shift);
            return true;
        }
    }
    return false;
}

static double spot_elevation(const struct image_spot *s)
{
    const int r = s->row, c = s->column;
    const double sw = (double)image_post_q6(s->tile, r, c),
                 se = (double)image_post_q6(s->tile, r, c + 1);
    const double nw = (double)image_post_q6(s->tile, r + 1, c);
    const double ne = (double)image_post_q6(s->tile, r + 1, c + 1);
    const double south = sw + (se - sw) * s->east, north = nw + (ne - nw) * s->east;
    return (south + (north - south) * s->north) / 64.0;
}

/* Lambert's law, sun 45 degrees high in the north-west, flat ground at IMAGE_SHADE_FLAT / 255. */
static double spot_shade(const struct image_spot *s, int64_t latitude)
{
    const int r = s->row, c = s->column;
    const double sw = (double)image_post_q6(s->tile, r, c),
                 se = (double)image_post_q6(s->tile, r, c + 1);
    const double nw = (double)image_post_q6(s->tile, r + 1, c);
    const double ne = (double)image_post_q6(s->tile, r + 1, c + 1);
    const double cell_m = ldexp(IMAGE_METRES_PER_BAM, s->shift);
    const double east_m =
        ldexp(cell_m, s->zone) *
        fmax(0.01, cos(image_degrees(latitude) * (3.14159265358979323846 / 180.0)));
    const double north = (nw + ne - sw - se) / (128.0 * cell_m),
                 east = (se + ne - sw - nw) / (128.0 * east_m);
    /* Sun (-1/2, 1/2, 1/sqrt 2) against the normal (-east, -north, 1). */
    const double sun =
        (0.5 * east - 0.5 * north + sqrt(0.5)) / sqrt(1.0 + east * east + north * north);
    return fmax(0.0, sun) / sqrt(0.5) * IMAGE_SHADE_FLAT;
}

double image_spot_value(const struct image *image, enum image_plane plane,
                        const struct image_spot *s, int64_t latitude)
{
    const uint16_t cell = image_tile_cell(s->tile, s->row, s->column);
    if (image_cell_class(cell) == LM_DB_CLASS_NONE) {
        return (double)NAN;
    }
    switch (plane) {
    case IMAGE_PLANE_REFLECTIVITY:
        return image_gamma_db(image_cell_gamma(cell));
    case IMAGE_PLANE_CLASS:
        return image_cell_class(cell);
    case IMAGE_PLANE_HEIGHT:
        return image->db.classes.height_dm[image_cell_height(cell)] / 10.0;
    case IMAGE_PLANE_ELEVATION:
        return spot_elevation(s);
    default:
        return spot_shade(s, latitude);
    }
}

static void read_values(struct image_look *l, const struct image_view *v, int first, int rows,
                        float *values)
{
    const double north_step = (double)(v->area.north - v->area.south) / v->height;
    const double east_step = (double)v->area.width / v->width;
    for (int y = 0; y < rows; y++) {
        const int64_t latitude = v->area.north - (int64_t)((first + y + 0.5) * north_step);
        for (int x = 0; x < v->width; x++) {
            const uint32_t longitude = v->area.west + (uint32_t)((x + 0.5) * east_step);
            struct image_spot s;
            const bool is_there = image_look_at(l, v->level, latitude, longitude, &s);
            values[(size_t)y * (size_t)v->width + (size_t)x] =
                is_there ? (float)image_spot_value(l->image, v->plane, &s, latitude) : NAN;
        }
    }
}

static void read_all(struct image_look *l, const struct image_view *v, float *values)
{
    struct hs_progress progress;
    hs_progress_begin(&progress, image_plane_names[v->plane], (uint64_t)v->height);
    for (int y = 0; y < v->height; y++) {
        read_values(l, v, y, 1, values + (size_t)y * (size_t)v->width);
        hs_progress_update(&progress, (uint64_t)y + 1);
    }
    hs_progress_end(&progress);
}

int image_view_read(const struct image *image, struct image_view *v, int y, int rows, float *values)
{
    struct image_look l;
    if (image_look_begin(&l, image) != 0) {
        return -1;
    }
    read_values(&l, v, y, rows, values);
    v->damaged_tiles += l.damaged;
    image_look_end(&l);
    return 0;
}

static int by_value(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static bool has_data(const struct image_view *v, const float *values)
{
    for (size_t i = 0; i < (size_t)v->width * (size_t)v->height; i++) {
        /* Every pixel was filled, row by row. NOLINTNEXTLINE(clang-analyzer-core.CallAndMessage) */
        if (!isnan(values[i])) {
            return true;
        }
    }
    return false;
}

/* Black and white at the first and last hundredth of what is seen. */
static int choose_scale(struct image_view *v, const float *values)
{
    const size_t count = (size_t)v->width * (size_t)v->height;
    float *sorted = malloc(count * sizeof *sorted);
    if (!sorted) {
        return hs_error("picture", "choose a smaller --max-size", "out of memory");
    }
    size_t n = 0;
    for (size_t i = 0; i < count; i++) {
        if (!isnan(values[i])) {
            sorted[n++] = values[i];
        }
    }
    if (n > 0) {
        qsort(sorted, n, sizeof *sorted, by_value);
        v->black = (double)sorted[n / 100];
        v->white = (double)sorted[n - 1 - n / 100];
    }
    free(sorted);
    if (!(v->white > v->black)) {
        v->white = v->black + 1.0;
    }
    return 0;
}

static uint8_t grey_of(const struct image_view *v, double value)
{
    const double grey =
        v->plane == IMAGE_PLANE_SHADE ? value : 255.0 * (value - v->black) / (v->white - v->black);
    return (uint8_t)(grey < 0.0 ? 0.0 : grey > 255.0 ? 255.0 : grey + 0.5);
}

static void paint(const struct image *image, const struct image_view *v, const float *values,
                  uint8_t *pixels)
{
    const size_t count = (size_t)v->width * (size_t)v->height;
    for (size_t i = 0; i < count; i++) {
        uint8_t *rgb = pixels + 3 * i;
        if (isnan(values[i])) {
            memset(rgb, 0, 3);
        } else if (v->plane == IMAGE_PLANE_CLASS) {
            memcpy(rgb, image->db.classes.entry[(int)values[i]].colour, 3);
        } else {
            memset(rgb, grey_of(v, (double)values[i]), 3);
        }
    }
}

int image_view_draw(const struct image *image, struct image_view *v, uint8_t *pixels)
{
    struct image_look l;
    if (image_look_begin(&l, image) != 0) {
        return -1;
    }
    float *values = malloc((size_t)v->width * (size_t)v->height * sizeof *values);
    int result = values ? 0 : hs_error("picture", "choose a smaller --max-size", "out of memory");
    if (result == 0) {
        read_all(&l, v, values);
        v->damaged_tiles = l.damaged;
        v->has_data = has_data(v, values);
        if (!(v->white > v->black)) {
            result = choose_scale(v, values);
        }
    }
    if (result == 0) {
        paint(image, v, values, pixels);
    }
    image_look_end(&l);
    free(values);
    return result;
}
