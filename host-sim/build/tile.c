#include "build/tile.h"

#include "build/canopy.h"
#include "build/footprints.h"
#include "hs/error.h"
#include "image/codes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = LM_TILE_CELLS, HALF = LM_TILE_CELLS / 2 };

static double cell_area_m2(const struct image_frame *f, int row)
{
    const double latitude = ((double)f->south + (row + 0.5) * (double)f->latitude_step) *
                            (3.14159265358979323846 / 2147483648.0);
    const double north = (double)f->latitude_step * IMAGE_METRES_PER_BAM;
    const double east = (double)f->longitude_step * IMAGE_METRES_PER_BAM * cos(latitude);
    return north * east;
}

static bool has_terrain(const struct terrain_posts *p, int r, int c)
{
    return p->has[r][c] && p->has[r][c + 1] && p->has[r + 1][c] && p->has[r + 1][c + 1];
}

/* Elevation at the centre of a cell, metres. */
static double centre_metres(const struct terrain_posts *p, int r, int c)
{
    return ((double)p->q6[r][c] + p->q6[r][c + 1] + p->q6[r + 1][c] + p->q6[r + 1][c + 1]) / 256.0;
}

/* Tangent of the slope of the plane nearest to the four corners of a cell. */
static double slope_tangent(const struct terrain_posts *p, const struct image_frame *f, int r,
                            int c)
{
    const double sw = p->q6[r][c], se = p->q6[r][c + 1];
    const double nw = p->q6[r + 1][c], ne = p->q6[r + 1][c + 1];
    const double north_m = (double)f->latitude_step * IMAGE_METRES_PER_BAM;
    const double east_m = cell_area_m2(f, r) / north_m;
    return hypot((ne + nw - se - sw) / (128.0 * north_m), (ne + se - nw - sw) / (128.0 * east_m));
}

static int rule_class(const struct build_context *b, const struct terrain_posts *p,
                      const struct image_frame *f, int r, int c)
{
    if (centre_metres(p, r, c) <= b->rule.sea_level_m) {
        return b->rule.water;
    }
    if (b->rule.steep >= 0 && slope_tangent(p, f, r, c) > b->rule.steep_tangent) {
        return b->rule.steep;
    }
    return b->rule.land;
}

static uint16_t encode(struct build_context *b, int class_number, double gamma_db, double height_m)
{
    const uint8_t kind = b->classes.entry[class_number].kind;
    const bool stands = kind == LM_KIND_STRUCTURE || kind == LM_KIND_TREES;
    b->counts.heights_cut += stands && height_m * 10.0 > BUILD_HEIGHT_MAX_DM;
    const uint8_t height = stands ? image_height_code(b->classes.height_dm, height_m * 10.0) : 0;
    return image_cell(image_gamma_code(gamma_db), (uint8_t)class_number, height);
}

/* Middle of a cell, or of one of the `parts` x `parts` of one, in BAM. */
static void cell_middle(const struct image_frame *f, int parts, int r, int c, double *latitude,
                        double *longitude)
{
    *latitude = (double)f->south + (r + 0.5) / parts * (double)f->latitude_step;
    *longitude = (double)f->west + (c + 0.5) / parts * (double)f->longitude_step;
}

/* The random reflectivity of a cell, or of one of the `parts` x `parts` of one: by where it lies
 * alone, whatever the level. */
static double assigned_gamma_db(const struct build_context *b, int class_number,
                                const struct image_frame *f, int parts, int r, int c)
{
    const double radians = 3.14159265358979323846 / 2147483648.0;
    double latitude, longitude;
    cell_middle(f, parts, r, c, &latitude, &longitude);
    return db_reflect_assign_cell(&b->laws[class_number], b->seed, radians * latitude,
                                  radians * longitude,
                                  (double)f->latitude_step * IMAGE_METRES_PER_BAM / parts);
}

static uint16_t encode_sample(struct build_context *b, const struct resample_sample *s,
                              const struct image_frame *f, int r, int c)
{
    const int k = s->class_number;
    if (k == LM_DB_CLASS_NONE) {
        return IMAGE_CELL_NONE;
    }
    const double gamma_db =
        s->has_gamma ? (double)s->gamma_db : assigned_gamma_db(b, k, f, b->parts, r, c);
    return encode(b, k, gamma_db, s->has_height ? (double)s->height_m : b->table.items[k].height_m);
}

/* Give cells of structures the class of their facing. */
static void face(const struct build_context *b, const struct image_frame *f, uint16_t *cells)
{
    for (int i = 0; i < CELLS * CELLS; i++) {
        const uint8_t k = image_cell_class(cells[i]);
        if (k != LM_DB_CLASS_NONE && b->facing.first[k] != 0) {
            double latitude, longitude;
            cell_middle(f, 1, i / CELLS, i % CELLS, &latitude, &longitude);
            cells[i] = image_cell(image_cell_gamma(cells[i]),
                                  build_facing_class(&b->facing, k, latitude, longitude),
                                  image_cell_height(cells[i]));
        }
    }
}

/* Cells of the finest level that the class raster gives. Returns how many samples it had, or -1. */
static int cover_cells(struct build_context *b, const struct image_frame *f,
                       uint16_t cells[CELLS][CELLS])
{
    const size_t side = (size_t)(CELLS * b->parts);
    struct resample_sample *samples = malloc(side * side * sizeof *samples);
    uint16_t *fine = malloc(side * side * sizeof *fine);
    int found = -1;
    if (!samples || !fine) {
        hs_error(b->cover.classes.path, "choose smaller cells", "out of memory");
    } else {
        found = resample_cover_tile(&b->cover, f, b->parts, samples);
    }
    if (found > 0) {
        for (size_t i = 0; i < side * side; i++) {
            fine[i] = encode_sample(b, &samples[i], f, (int)(i / side), (int)(i % side));
        }
        const struct image_reduction parted = {&b->classes, b->parts, CELLS, IMAGE_VOTE_COUNT};
        image_reduce(&parted, fine, side, &cells[0][0], CELLS);
        face(b, f, &cells[0][0]);
    }
    free(samples);
    free(fine);
    return found;
}

static bool terrain_begins(const struct build_context *b, int level, const struct image_area *area)
{
    for (int i = 0; i < b->terrain.layer_count; i++) {
        if (b->terrain_level[i] <= level && image_areas_meet(&b->terrain.layers[i].area, area)) {
            return true;
        }
    }
    return false;
}

static void fill_by_rule(struct build_context *b, const struct image_frame *f, struct build_tile *t,
                         const bool is_below[4])
{
    for (int r = 0; r < CELLS; r++) {
        for (int c = 0; c < CELLS; c++) {
            uint16_t *cell = &t->ground.cells[r][c];
            const bool is_given = is_below[2 * (r / HALF) + c / HALF] || *cell != IMAGE_CELL_NONE;
            if (!is_given && has_terrain(&t->posts, r, c)) {
                const int k = rule_class(b, &t->posts, f, r, c);
                *cell =
                    encode(b, k, assigned_gamma_db(b, k, f, 1, r, c), b->table.items[k].height_m);
                b->counts.cells_by_rule++;
            }
        }
    }
}

/* Add the cells that were made here, not taken from below, to the counts. */
static void count_cells(struct build_context *b, const struct image_frame *f,
                        const struct build_tile *t, const bool is_below[4])
{
    struct build_counts *n = &b->counts;
    double area_m2[LM_DB_CLASSES] = {0}, land_area_m2 = 0, land_metres_m2 = 0;
    for (int r = 0; r < CELLS; r++) {
        const double area = cell_area_m2(f, r);
        for (int c = 0; c < CELLS; c++) {
            const uint8_t k = image_cell_class(t->ground.cells[r][c]);
            if (is_below[2 * (r / HALF) + c / HALF] || k == LM_DB_CLASS_NONE) {
                continue;
            }
            n->cells[k]++;
            area_m2[k] += area;
            n->cells_beyond_terrain += !has_terrain(&t->posts, r, c);
            if (b->classes.entry[k].kind != LM_KIND_WATER) {
                land_area_m2 += area;
                land_metres_m2 += area * centre_metres(&t->posts, r, c);
            }
        }
    }
    for (int k = 0; k < LM_DB_CLASSES; k++) {
        build_sum_add(&n->area_m2[k], area_m2[k]);
    }
    build_sum_add(&n->land_area_m2, land_area_m2);
    build_sum_add(&n->land_metres_m2, land_metres_m2);
}

/* Take every second post of the tile below. */
static void take_quarter(struct terrain_posts *posts, const struct terrain_posts *below,
                         int quarter)
{
    const int row = quarter / 2 * HALF, column = quarter % 2 * HALF;
    for (int r = 0; r <= HALF; r++) {
        for (int c = 0; c <= HALF; c++) {
            posts->q6[row + r][column + c] = below->q6[2 * r][2 * c];
            posts->has[row + r][column + c] = below->has[2 * r][2 * c];
        }
    }
}

void build_take_posts(struct terrain_posts *posts, const struct terrain_posts *const below[4])
{
    const int32_t(*fine[4])[LM_TILE_POSTS] = {NULL, NULL, NULL, NULL};
    for (int i = 0; i < 4; i++) {
        if (below[i]) {
            fine[i] = below[i]->q6;
            take_quarter(posts, below[i], i);
        }
    }
    image_posts_smooth(fine, posts->q6);
}

/* The share of structures in the tile below, for its quarter of this one. */
static void take_built(struct build_tile *t, const struct build_tile *child, int quarter)
{
    const int row = quarter / 2 * HALF, column = quarter % 2 * HALF;
    for (int i = 0; i < HALF * HALF; i++) {
        const int r = i / HALF, c = i % HALF;
        t->built[row + r][column + c] =
            (child->built[2 * r][2 * c] + child->built[2 * r][2 * c + 1] +
             child->built[2 * r + 1][2 * c] + child->built[2 * r + 1][2 * c + 1]) /
            4;
    }
}

static void take_children(struct build_tile *t, struct build_tile *const children[4])
{
    const struct terrain_posts *below[4] = {NULL, NULL, NULL, NULL};
    for (int i = 0; i < 4; i++) {
        if (children[i]) {
            below[i] = &children[i]->posts;
            take_built(t, children[i], i);
        }
    }
    build_take_posts(&t->posts, below);
}

/* The ground that stands for the structures of a tile where their detail is drawn: the cell that is
 * commonest among those that stand for nothing built, or else bare of height what there is. */
static uint16_t ground_under(const struct build_context *b, const struct build_tile *t)
{
    uint32_t count[LM_DB_CLASSES] = {0};
    double sum_db[LM_DB_CLASSES] = {0};
    for (int i = 0; i < CELLS * CELLS; i++) {
        const uint16_t cell = t->ground.cells[i / CELLS][i % CELLS];
        const uint8_t k = image_cell_class(cell);
        if (k != LM_DB_CLASS_NONE && b->classes.entry[k].kind == LM_KIND_GROUND) {
            count[k]++;
            sum_db[k] += image_gamma_db(image_cell_gamma(cell));
        }
    }
    int most = b->rule.land;
    for (int k = 0; k < LM_DB_CLASS_NONE; k++) {
        most = count[k] > count[most] ? k : most;
    }
    const double gamma_db =
        count[most] ? sum_db[most] / count[most] : b->table.items[most].gamma_db;
    return image_cell(image_gamma_code(gamma_db), (uint8_t)most, 0);
}

static bool is_empty(const struct build_tile *t)
{
    for (int r = 0; r < CELLS; r++) {
        for (int c = 0; c < CELLS; c++) {
            if (image_cell_class(t->ground.cells[r][c]) != LM_DB_CLASS_NONE) {
                return false;
            }
        }
    }
    return true;
}

/* Make what the inputs give. Returns 1 when there is anything, 0 when not, -1 on an error. */
static int make_from_inputs(struct build_context *b, int level, const struct image_frame *f,
                            bool has_child, struct build_tile *t)
{
    const struct image_area area = image_frame_area(f);
    const int found = level == 0 ? cover_cells(b, f, t->ground.cells) : 0;
    if (found < 0) {
        return -1;
    }
    if (found == 0 && !has_child && !terrain_begins(b, level, &area)) {
        return 0;
    }
    const int reached = terrain_posts(&b->terrain, f, &t->posts);
    if (reached < 0) {
        return -1;
    }
    return found > 0 || reached > 0;
}

static void identify(struct lm_tile *tile, int level, const struct image_frame *f)
{
    tile->lod = (uint8_t)level;
    tile->zone = f->zone;
    tile->row = f->row;
    tile->column = f->column;
}

/* Add the tile as the display unit will see it to the budget of towns. */
static void budget(struct build_context *b, int level, const struct image_frame *f,
                   const struct build_tile *t)
{
    uint16_t cells[CELLS][CELLS];
    image_cells_decode(&t->record, cells);
    const double north_m = (double)f->latitude_step * IMAGE_METRES_PER_BAM;
    const struct build_towns_tile seen = {(const uint16_t(*)[CELLS])cells, t->posts.q6, t->built};
    build_towns_add(&b->towns, level, &seen, &b->classes, north_m,
                    cell_area_m2(f, CELLS / 2) / north_m);
}

/* What the inputs leave to the rule, and what is seen of the cells they gave. */
static void finish_inputs(struct build_context *b, const struct image_frame *f,
                          const bool is_below[4], struct build_tile *t)
{
    const double north_m = (double)f->latitude_step * IMAGE_METRES_PER_BAM;
    fill_by_rule(b, f, t, is_below);
    build_footprints(b, f, &t->ground);
    count_cells(b, f, t, is_below);
    build_towns_mark(t->ground.cells, &b->classes, north_m, t->built);
    build_canopy(b, f, &t->ground);
}

static int make_tile(struct build_context *b, int level, const struct image_frame *f,
                     struct build_tile *const children[4], struct build_tile *t)
{
    bool is_below[4];
    int below = 0;
    for (int i = 0; i < 4; i++) {
        is_below[i] = children[i] != NULL;
        below += is_below[i];
    }
    for (int i = 0; i < CELLS * CELLS; i++) {
        t->ground.cells[i / CELLS][i % CELLS] = IMAGE_CELL_NONE;
    }
    const int made = below < 4 ? make_from_inputs(b, level, f, below > 0, t) : 0;
    if (made < 0 || (made == 0 && below == 0)) {
        return made;
    }
    if (made > 0) {
        finish_inputs(b, f, is_below, t);
    }
    take_children(t, children);
    identify(&t->record, level, f);
    if (level == 0 && build_detail_of_tile(&b->detail, f->row, f->column).units != 0) {
        t->record.under = ground_under(b, t);
    }
    image_posts_encode(t->posts.q6, &t->record);
    image_ground_init(&t->ground, &t->record);
    for (int i = 0; i < 4; i++) {
        if (children[i]) {
            image_ground_take(&t->ground, &t->record, &children[i]->ground, i, &b->classes);
        }
    }
    image_ground_encode(&t->ground, &t->record, b->classes.height_dm);
    budget(b, level, f, t);
    return !is_empty(t);
}

int build_tile_make(struct build_context *b, int level, uint8_t zone, uint32_t row, uint32_t column,
                    struct build_tile *const children[4], struct build_tile **out)
{
    const uint8_t shift = (uint8_t)(b->plan.shift0 + level);
    const struct image_frame frame = image_frame_of(shift, zone, row, column);
    *out = NULL;
    struct build_tile *t = calloc(1, sizeof *t);
    if (!t) {
        return hs_error("tiles", "choose larger cells", "out of memory");
    }
    const int made = make_tile(b, level, &frame, children, t);
    if (made <= 0) {
        free(t);
        return made;
    }
    *out = t;
    return 0;
}
