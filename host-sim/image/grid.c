#include "image/grid.h"

#include "lm/db.h"

#include <math.h>

int64_t image_bam(double degrees)
{
    return llround(degrees * (4294967296.0 / 360.0));
}

double image_degrees(int64_t bam)
{
    return (double)bam * (360.0 / 4294967296.0);
}

double image_longitude_degrees(uint32_t bam)
{
    return image_degrees((int32_t)bam);
}

/* Eastward from `a` to `b`, 0..2^32-1. */
static int64_t eastward(uint32_t a, uint32_t b)
{
    return (int64_t)(uint32_t)(b - a);
}

/* Width of an arc from `west` that holds both areas. */
static int64_t width_from(uint32_t west, const struct image_area *a, const struct image_area *b)
{
    const int64_t to_a = eastward(west, a->west) + a->width;
    const int64_t to_b = eastward(west, b->west) + b->width;
    const int64_t width = to_a > to_b ? to_a : to_b;
    return width < IMAGE_BAM_ROUND ? width : IMAGE_BAM_ROUND;
}

void image_area_add(struct image_area *area, const struct image_area *other)
{
    if (other->width == 0) {
        return;
    }
    if (area->width == 0) {
        *area = *other;
        return;
    }
    const int64_t ours = width_from(area->west, area, other);
    const int64_t theirs = width_from(other->west, area, other);
    area->west = ours <= theirs ? area->west : other->west;
    area->width = ours <= theirs ? ours : theirs;
    area->south = area->south < other->south ? area->south : other->south;
    area->north = area->north > other->north ? area->north : other->north;
}

bool image_areas_meet(const struct image_area *a, const struct image_area *b)
{
    if (a->width == 0 || b->width == 0 || a->south > b->north || b->south > a->north) {
        return false;
    }
    return eastward(a->west, b->west) <= a->width || eastward(b->west, a->west) <= b->width;
}

void image_area_centre(const struct image_area *area, int64_t *latitude, uint32_t *longitude)
{
    *latitude = (area->south + area->north) / 2;
    *longitude = area->west + (uint32_t)(area->width / 2);
}

struct image_frame image_frame_of(uint8_t shift, uint8_t zone, uint32_t row, uint32_t column)
{
    const int tile_shift = shift + LM_TILE_CELLS_LOG2;
    return (struct image_frame){
        .shift = shift,
        .zone = zone,
        .row = row,
        .column = column,
        .south = ((int64_t)row << tile_shift) - IMAGE_BAM_QUARTER,
        .west = (uint32_t)((uint64_t)column << (tile_shift + zone)),
        .latitude_step = (int64_t)1 << shift,
        .longitude_step = (int64_t)1 << (shift + zone),
    };
}

struct image_area image_frame_area(const struct image_frame *frame)
{
    return (struct image_area){
        .south = frame->south,
        .north = frame->south + LM_TILE_CELLS * frame->latitude_step,
        .west = frame->west,
        .width = LM_TILE_CELLS * frame->longitude_step,
    };
}

uint32_t image_columns_round(uint8_t shift, uint8_t zone)
{
    return 1u << (32 - LM_TILE_CELLS_LOG2 - shift - zone);
}

uint32_t image_rows_all(uint8_t shift)
{
    return 1u << (31 - LM_TILE_CELLS_LOG2 - shift);
}

uint8_t image_row_zone(uint8_t shift, uint32_t row)
{
    const struct image_frame frame = image_frame_of(shift, 0, row, 0);
    return (uint8_t)lm_db_zone((fx_bam_t)frame.south);
}

uint32_t image_row_of(uint8_t shift, int64_t latitude)
{
    const int64_t row = (latitude + IMAGE_BAM_QUARTER) >> (shift + LM_TILE_CELLS_LOG2);
    const int64_t last = (int64_t)image_rows_all(shift) - 1;
    return (uint32_t)(row < 0 ? 0 : row > last ? last : row);
}
