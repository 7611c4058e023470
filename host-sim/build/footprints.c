#include "build/footprints.h"

#include "image/codes.h"

#include <math.h>
#include <string.h>

static const double radians_per_bam = 3.14159265358979323846 / 2147483648.0;

enum { CELLS = LM_TILE_CELLS };

/* A tile on the ground: metres of a cell northwards and eastwards. */
struct ground_grid {
    const struct image_frame *frame;
    double north_m, east_m;
};

/* Footprint in metres north and east of the tile's corner; half sides; height of the roof's mean.
 */
struct footprint {
    double north_m, east_m, half_length_m, half_width_m, cosine, sine, height_dm;
};

static struct ground_grid grid_of(const struct image_frame *f)
{
    const double middle = (double)f->south + CELLS / 2 * (double)f->latitude_step;
    return (struct ground_grid){f, (double)f->latitude_step * IMAGE_METRES_PER_BAM,
                                (double)f->longitude_step * IMAGE_METRES_PER_BAM *
                                    cos(middle * radians_per_bam)};
}

static struct footprint footprint_of(const struct ground_grid *g,
                                     const struct build_detail_item *item)
{
    const double rows = (double)item->row - g->frame->row + item->item.north / 65536.0;
    const double columns = (double)item->column - g->frame->column + item->item.east / 65536.0;
    const double turn = item->item.turn * (3.14159265358979323846 / 32768);
    const double roof =
        item->item.kind == LM_DETAIL_GABLE ? 0.8 : 1; /* the mean of ridge and eaves */
    return (struct footprint){.north_m = rows * CELLS * g->north_m,
                              .east_m = columns * CELLS * g->east_m,
                              .half_length_m = item->item.length_dm / 20.0,
                              .half_width_m = item->item.width_dm / 20.0,
                              .cosine = cos(turn),
                              .sine = sin(turn),
                              .height_dm = roof * item->item.height_dm};
}

/* Metres from the middle of a cell to the footprint; 0 inside. */
static double distance_m(const struct ground_grid *g, const struct footprint *p, int r, int c)
{
    const double y = (r + 0.5) * g->north_m - p->north_m, x = (c + 0.5) * g->east_m - p->east_m;
    const double beyond = fabs(x * p->sine + y * p->cosine) - p->half_length_m;
    const double aside = fabs(x * p->cosine - y * p->sine) - p->half_width_m;
    return hypot(fmax(beyond, 0), fmax(aside, 0));
}

/* Cells first..end - 1 of one axis that lie within `reach_m` of a place. */
static void cells_within(double place_m, double reach_m, double cell_m, int *first, int *end)
{
    *first = (int)fmin(fmax(floor((place_m - reach_m) / cell_m), 0), CELLS);
    *end = (int)fmin(fmax(ceil((place_m + reach_m) / cell_m), 0), CELLS);
}

struct burning {
    const struct build_context *context;
    struct ground_grid grid;
    struct image_ground *ground;
    double height_dm[CELLS][CELLS]; /* of the footprints so far: the highest counts */
};

static void burn_cell(struct burning *w, const struct footprint *p,
                      const struct lm_detail_item *item, int r, int c)
{
    const struct lm_classes *classes = &w->context->classes;
    uint16_t *cell = &w->ground->cells[r][c];
    const double distance = distance_m(&w->grid, p, r, c);
    const uint8_t k = image_cell_class(*cell);
    if (k == LM_DB_CLASS_NONE) {
        return;
    }
    if (distance == 0 && p->height_dm > w->height_dm[r][c]) {
        w->height_dm[r][c] = p->height_dm;
        *cell = image_cell(item->gamma_code, item->class_number,
                           image_height_code(classes->height_dm, p->height_dm));
    } else if (distance < 0.75 * w->grid.north_m && classes->entry[k].kind == LM_KIND_TREES) {
        *cell = image_cell(image_cell_gamma(*cell), k, 0);
    }
}

static void burn(struct burning *w, const struct build_detail_item *item)
{
    const struct footprint p = footprint_of(&w->grid, item);
    const double reach_m = hypot(p.half_length_m, p.half_width_m) + w->grid.north_m;
    int row, row_end, column, column_end;
    if (item->item.kind == LM_DETAIL_LINE || item->item.kind == LM_DETAIL_SURFACE ||
        fmin(p.half_length_m, p.half_width_m) < 0.25 * w->grid.north_m) {
        return;
    }
    cells_within(p.north_m, reach_m, w->grid.north_m, &row, &row_end);
    cells_within(p.east_m, reach_m, w->grid.east_m, &column, &column_end);
    for (int r = row; r < row_end; r++) {
        for (int c = column; c < column_end; c++) {
            burn_cell(w, &p, &item->item, r, c);
        }
    }
}

/* First item that lies in a row and at or behind a column. */
static uint32_t first_item(const struct build_detail *d, uint32_t row, uint32_t column)
{
    uint32_t low = 0, high = d->count;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        const struct build_detail_item *i = &d->items[middle];
        const bool is_before = i->row < row || (i->row == row && i->column < column);
        low = is_before ? middle + 1 : low;
        high = is_before ? high : middle;
    }
    return low;
}

void build_footprints(const struct build_context *b, const struct image_frame *f,
                      struct image_ground *ground)
{
    const struct build_detail *d = &b->detail;
    if (f->shift != b->plan.shift0 || d->count == 0) {
        return;
    }
    struct burning w = {.context = b, .grid = grid_of(f), .ground = ground};
    const double reach_m = d->reach_m + w.grid.north_m;
    const uint32_t rows = (uint32_t)ceil(reach_m / (CELLS * w.grid.north_m));
    const uint32_t columns = (uint32_t)ceil(reach_m / (CELLS * w.grid.east_m));
    const uint32_t west = f->column > columns ? f->column - columns : 0;
    for (uint32_t row = f->row > rows ? f->row - rows : 0; row <= f->row + rows; row++) {
        if (image_row_zone(f->shift, row) != f->zone) {
            continue;
        }
        for (uint32_t i = first_item(d, row, west);
             i < d->count && d->items[i].row == row && d->items[i].column <= f->column + columns;
             i++) {
            burn(&w, &d->items[i]);
        }
    }
}
