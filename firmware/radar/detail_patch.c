#include "lm/detail_patch.h"

#include "fx/mem.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/kernels_map.h"
#include "lm/units.h"

enum {
    ONE_Q16 = 1 << 16,
    EAVES_PERCENT = 60, /* height of a gable's eaves over that of its ridge */
    GAMMA_STEPS_A_DB = 256 / LM_GAMMA_CODE_STEP_DB_Q8
};

void lm_detail_patch_clear(struct lm_detail_patch *p, const struct lm_db *db)
{
    p->tile_count = p->shape_count = 0;
    p->structures = 0;
    for (uint32_t n = 0; n < LM_DB_CLASSES; n++) {
        const bool is_structure = db->classes.entry[n].kind == LM_KIND_STRUCTURE;
        p->structures |= (uint16_t)(is_structure << n);
    }
    memset(p->first, 0, sizeof p->first);
}

/* ---- items to shapes ---- */

/* Place in a patch: metres to the right of its middle, and beyond it. */
struct place {
    int32_t right_m_q8, beyond_m_q8;
};

static bool find_place(const struct lm_patch_geometry *g, struct lm_position position,
                       struct place *place)
{
    uint32_t distance_m_q8;
    fx_bam_t azimuth;
    if (!lm_target_view_locate(g->centre, position, &distance_m_q8, &azimuth)) {
        return false;
    }
    const fx_bam_t off = azimuth - g->look;
    place->right_m_q8 = (int32_t)((int64_t)distance_m_q8 * fx_sin_q30(off) >> 30);
    place->beyond_m_q8 = (int32_t)((int64_t)distance_m_q8 * fx_cos_q30(off) >> 30);
    return true;
}

/* Tile in a patch: its south-west corner, and the ways to the corners north and east of it. Within
 * a tile of a kilometre, places by these are right within centimetres. */
struct tile_frame {
    struct place corner, north, east;
};

static bool set_frame(struct tile_frame *f, const struct lm_detail_reader *r,
                      const struct lm_db *db, const struct lm_patch_geometry *g)
{
    const struct lm_detail_ground ground = lm_detail_ground_of(db, r->row, r->column);
    struct lm_position south_west = ground.corner, north_west = south_west, south_east = south_west;
    north_west.latitude += 1u << ground.north_log2;
    south_east.longitude += 1u << ground.east_log2;
    if (!find_place(g, south_west, &f->corner) || !find_place(g, north_west, &f->north) ||
        !find_place(g, south_east, &f->east)) {
        return false;
    }
    f->north.right_m_q8 -= f->corner.right_m_q8;
    f->north.beyond_m_q8 -= f->corner.beyond_m_q8;
    f->east.right_m_q8 -= f->corner.right_m_q8;
    f->east.beyond_m_q8 -= f->corner.beyond_m_q8;
    return true;
}

/* Sides of a tile are below 2^25, shares are 16 bits: products need 64. */
static int32_t coordinate(int32_t corner, int32_t north, int32_t east,
                          const struct lm_detail_item *item)
{
    return corner + (int32_t)(((int64_t)north * item->north + (int64_t)east * item->east) >> 16);
}

static struct place place_of(const struct tile_frame *f, const struct lm_detail_item *item)
{
    return (struct place){
        coordinate(f->corner.right_m_q8, f->north.right_m_q8, f->east.right_m_q8, item),
        coordinate(f->corner.beyond_m_q8, f->north.beyond_m_q8, f->east.beyond_m_q8, item)};
}

/* Half a side of so many decimetres, at least half a cell: no line of the patch misses a fence. */
static uint32_t half_side_m_q8(uint16_t side_dm, uint32_t cell_m_q8)
{
    return fx_max_u32((uint32_t)side_dm * 64 / 5, cell_m_q8 / 2);
}

/* Height code nearest to a height. */
static uint32_t height_code(const struct lm_classes *classes, uint32_t height_dm)
{
    uint32_t nearest = 0;
    for (uint32_t n = 1; n < LM_DB_CLASSES; n++) {
        const int32_t off = (int32_t)classes->height_dm[n] - (int32_t)height_dm;
        const int32_t best = (int32_t)classes->height_dm[nearest] - (int32_t)height_dm;
        nearest = fx_abs_u32(off) < fx_abs_u32(best) ? n : nearest;
    }
    return nearest;
}

static uint32_t height_codes(const struct lm_classes *classes, const struct lm_detail_item *item)
{
    uint32_t codes = 0;
    if (item->kind == LM_DETAIL_SURFACE) {
        return item->height_dm; /* the classes that it covers */
    }
    if (item->kind != LM_DETAIL_GABLE) {
        return height_code(classes, item->height_dm) * 0x11111111u;
    }
    for (uint32_t eighth = 0; eighth < 8; eighth++) {
        /* The middle of the eighth is (2 n + 1) / 16 of the way from the ridge to the eaves. */
        const uint32_t fall = (100 - EAVES_PERCENT) * (2 * eighth + 1) / 16;
        codes |= height_code(classes, item->height_dm * (100 - fall) / 100) << (4 * eighth);
    }
    return codes;
}

/* Reflectivity of a line seen `off` its broadside: glint - 12 dB (off / lobe)^2, and not below that
 * of a line seen along. */
static uint8_t line_gamma_code(const struct lm_detail_item *item, fx_bam_t off, fx_bam_t lobe)
{
    const uint32_t turned = fx_abs_u32((int32_t)(off << 1)) >> 1; /* modulo a half turn */
    const uint64_t ratio_q8 = ((uint64_t)turned << 8) / fx_max_u32(lobe, 1);
    const uint64_t fall = (12 * GAMMA_STEPS_A_DB * ratio_q8 * ratio_q8) >> 16;
    const uint32_t depth = (uint32_t)(item->glint_code - item->gamma_code);
    return (uint8_t)(item->glint_code - (fall < depth ? (uint32_t)fall : depth));
}

/* Coordinates of a shape: u and v of a place dx to the right of its middle and dy beyond it are
 *
 *     u = (dx sin t + dy cos t) / a      v = (dx cos t - dy sin t) / b      t the turn from the ray
 *
 * A line is a ray: with s the range of the place, S that of the patch's centre and x how far the
 * place is to the right, a step of one line is dx = ds s / S, and a step of one cell is dy = ds and
 * dx = ds x / s. */
static void set_axes(struct lm_detail_shape *shape, const struct lm_detail_item *item,
                     const struct place *place, const struct lm_patch_geometry *g)
{
    const uint32_t cell_m_q8 = g->cell_m_q8;
    const int64_t range_m_q8 = (int64_t)g->centre_m_q8 + place->beyond_m_q8;
    const int64_t wide_q14 = ((range_m_q8 << 14) / g->centre_m_q8);
    const int64_t lean_q14 = ((int64_t)place->right_m_q8 << 14) / range_m_q8;
    const fx_bam_t turn = ((fx_bam_t)item->turn << 16) - g->look;
    const int64_t sine_q14 = fx_sin_q30(turn) >> 16, cosine_q14 = fx_cos_q30(turn) >> 16;
    const uint32_t a_m_q8 = half_side_m_q8(item->length_dm, cell_m_q8),
                   b_m_q8 = half_side_m_q8(item->width_dm, cell_m_q8);
    /* A cell is at most two half sides, 2^17; sines and the rest are near 1 in Q14. */
    const int64_t u_q16 = ((int64_t)cell_m_q8 << 16) / a_m_q8,
                  v_q16 = ((int64_t)cell_m_q8 << 16) / b_m_q8;
    shape->u_line_q16 = (int32_t)(u_q16 * (wide_q14 * sine_q14 >> 14) >> 14);
    shape->v_line_q16 = (int32_t)(v_q16 * (wide_q14 * cosine_q14 >> 14) >> 14);
    shape->u_cell_q16 = (int32_t)(u_q16 * ((lean_q14 * sine_q14 >> 14) + cosine_q14) >> 14);
    shape->v_cell_q16 = (int32_t)(v_q16 * ((lean_q14 * cosine_q14 >> 14) - sine_q14) >> 14);

    /* The corners reach a |sin t| + b |cos t| to the side. What the ray leans adds to that. */
    const int64_t aside_m_q8 =
        (a_m_q8 * (int64_t)fx_abs_u32((int32_t)sine_q14) +
         b_m_q8 * (int64_t)fx_abs_u32((int32_t)cosine_q14) +
         ((int64_t)(a_m_q8 + b_m_q8) * (int64_t)fx_abs_u32((int32_t)lean_q14))) >>
        14;
    const int64_t reach_q8 = lm_cells_q8_of_m_q8((aside_m_q8 << 14) / wide_q14, cell_m_q8);
    const int64_t first = (shape->line_q8 - reach_q8 + 255) >> 8,
                  end = ((shape->line_q8 + reach_q8) >> 8) + 1;
    /* They reach a |cos t| + b |sin t| beyond. Rounding adds less than a 16th and two cells. */
    const int64_t beyond_m_q8 = (a_m_q8 * (int64_t)fx_abs_u32((int32_t)cosine_q14) +
                                 b_m_q8 * (int64_t)fx_abs_u32((int32_t)sine_q14)) >>
                                14;
    const int64_t along_q8 = lm_cells_q8_of_m_q8(beyond_m_q8 * 17 / 16, cell_m_q8) + 512;
    const bool is_traced = shape->cell_q8 + along_q8 >= 0 &&
                           shape->cell_q8 - along_q8 <= lm_cells_q8_of_cells((int32_t)g->traced);
    shape->first_line = (uint16_t)fx_clamp_i64(first, 0, g->lines);
    shape->end_line = (uint16_t)fx_clamp_i64(is_traced ? end : 0, 0, g->lines);
}

static struct lm_detail_shape shape_of(const struct lm_detail_item *item, const struct place *place,
                                       const struct lm_db *db, const struct lm_patch_geometry *g,
                                       fx_bam_t lobe)
{
    const int64_t range_m_q8 = (int64_t)g->centre_m_q8 + place->beyond_m_q8;
    const int64_t aside_m_q8 = (int64_t)place->right_m_q8 * g->centre_m_q8 / range_m_q8;
    const int32_t middle_q8 = (int32_t)(g->lines - 1) * 128;
    const fx_bam_t ray = g->look + fx_atan2(place->right_m_q8, (int32_t)range_m_q8);
    struct lm_detail_shape shape = {
        .line_q8 = middle_q8 + (int32_t)lm_cells_q8_of_m_q8(aside_m_q8, g->cell_m_q8),
        .cell_q8 = (int32_t)(g->cells - 1) * 128 + (int32_t)(g->overscan * 256) +
                   (int32_t)lm_cells_q8_of_m_q8(place->beyond_m_q8, g->cell_m_q8),
        .class_number = item->class_number,
        .kind = item->kind,
        .layer = item->kind == LM_DETAIL_SURFACE ? item->glint_code != 0 : LM_DETAIL_LAYERS - 1,
        .gamma_code = item->gamma_code,
        .height_codes = height_codes(&db->classes, item),
    };
    if (shape.kind == LM_DETAIL_LINE) {
        const fx_bam_t broadside = ((fx_bam_t)item->turn << 16) + FX_BAM_90;
        shape.gamma_code = line_gamma_code(item, broadside - ray, lobe);
    }
    set_axes(&shape, item, place, g);
    return shape;
}

/* Position of an item on the Earth. */
static struct lm_position position_of(const struct lm_detail_reader *r, const struct lm_db *db,
                                      const struct lm_detail_item *item)
{
    const struct lm_detail_ground ground = lm_detail_ground_of(db, r->row, r->column);
    return (struct lm_position){
        ground.corner.latitude + (fx_bam_t)((uint64_t)item->north << ground.north_log2 >> 16),
        ground.corner.longitude + (fx_bam_t)((uint64_t)item->east << ground.east_log2 >> 16)};
}

void lm_detail_patch_add(struct lm_detail_patch *p, const struct lm_detail_reader *r,
                         struct lm_tile_cache *tiles, const struct lm_patch_geometry *g,
                         fx_bam_t lobe)
{
    const struct lm_db *db = tiles->db;
    const int64_t reach_m_q8 = (int64_t)g->cells * g->cell_m_q8;
    struct tile_frame frame;
    if (!set_frame(&frame, r, db, g)) {
        return;
    }
    if (p->tile_count == LM_DETAIL_TILES_MAX) {
        p->left_out += r->record.count;
        return;
    }
    p->tile[p->tile_count++] = (struct lm_detail_tile){r->row, r->column, r->under};
    for (uint32_t i = 0; i < r->record.count; i++) {
        const struct lm_detail_item *item = &r->record.items[i];
        const struct place place = place_of(&frame, item);
        /* Beyond twice the patch nothing touches it, and ranges stay positive. */
        if (fx_abs_u32(place.right_m_q8) > reach_m_q8 ||
            fx_abs_u32(place.beyond_m_q8) > reach_m_q8 ||
            (int64_t)g->centre_m_q8 + place.beyond_m_q8 <= 0) {
            continue;
        }
        if (p->shape_count == LM_DETAIL_SHAPES_MAX) {
            p->left_out += r->record.count - i;
            return;
        }
        struct lm_detail_shape shape = shape_of(item, &place, db, g, lobe);
        if (shape.first_line < shape.end_line) {
            shape.elevation_m_q14 = (int32_t)lm_m_q14_of_m_q10(
                lm_scan_elevation(tiles, db->finest, position_of(r, db, item), 0));
            p->shape[p->shape_count++] = shape;
        }
    }
}

/* ---- sorting by lines ---- */

static uint32_t first_block(const struct lm_detail_shape *shape)
{
    return shape->first_line / LM_DETAIL_BLOCK_LINES;
}

static uint32_t last_block(const struct lm_detail_shape *shape)
{
    return (shape->end_line - 1u) / LM_DETAIL_BLOCK_LINES;
}

/* Enter the shapes of a layer into the blocks that they may touch, in their order. */
static void enter_layer(struct lm_detail_patch *p, uint32_t layer, uint16_t next[LM_DETAIL_BLOCKS])
{
    for (uint32_t i = 0; i < p->shape_count; i++) {
        if (p->shape[i].layer != layer) {
            continue;
        }
        const uint32_t last = last_block(&p->shape[i]);
        for (uint32_t b = first_block(&p->shape[i]); b <= last; b++) {
            if (next[b] == p->first[b + 1]) {
                p->left_out++;
            } else {
                p->entry[next[b]++] = (uint16_t)i;
            }
        }
    }
}

/* A counting sort: how many shapes each block has, where its entries begin, and then the entries,
 * layer by layer. */
void lm_detail_patch_close(struct lm_detail_patch *p)
{
    uint32_t count[LM_DETAIL_BLOCKS] = {0}, total = 0;
    uint16_t next[LM_DETAIL_BLOCKS];
    for (uint32_t i = 0; i < p->shape_count; i++) {
        const uint32_t last = last_block(&p->shape[i]);
        for (uint32_t b = first_block(&p->shape[i]); b <= last; b++) {
            count[b]++;
        }
    }
    for (uint32_t b = 0; b < LM_DETAIL_BLOCKS; b++) {
        p->first[b] = next[b] = (uint16_t)total;
        total = fx_min_u32(total + count[b], LM_DETAIL_ENTRIES_MAX);
    }
    p->first[LM_DETAIL_BLOCKS] = (uint16_t)total;
    for (uint32_t layer = 0; layer < LM_DETAIL_LAYERS; layer++) {
        enter_layer(p, layer, next);
    }
}

/* ---- one line ---- */

/* Cells from the shape's middle, between which the line is within a half side of it. */
struct interval {
    int64_t from_q8, to_q8;
};

static inline int64_t max_i64(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static inline int64_t min_i64(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* Narrow an interval to |at + step d / 256| <= 1. False if nothing is left. Both coordinates are
 * below 2^26 where the line meets the shape's block: times 2^8 they need 64 bits. */
static inline bool narrow(struct interval *d, int32_t at_q16, int32_t step_q16)
{
    if (step_q16 == 0) {
        return fx_abs_u32(at_q16) <= ONE_Q16;
    }
    const int32_t one_q16 = step_q16 > 0 ? ONE_Q16 : -ONE_Q16;
    d->from_q8 = max_i64(((int64_t)-one_q16 - at_q16) * 256 / step_q16, d->from_q8);
    d->to_q8 = min_i64(((int64_t)one_q16 - at_q16) * 256 / step_q16, d->to_q8);
    return d->from_q8 <= d->to_q8;
}

/* Draw a roof into cells first..end - 1, of which there is one at least. `v_q16` is v of the first
 * of them; inside it is at most 1, and a step at most 2, both in Q16. */
static void draw_roof(const struct lm_detail_shape *shape, int32_t first, int32_t end,
                      int32_t v_q16, struct lm_scan_line *ground)
{
    const uint32_t top = (uint32_t)shape->gamma_code << 8 | (uint32_t)shape->class_number << 4;
    const uint32_t codes = shape->height_codes;
    const int32_t elevation_m_q14 = shape->elevation_m_q14, v_cell_q16 = shape->v_cell_q16;
    int32_t *elevation = ground->elevation_m_q14 + first;
    uint32_t *cell = ground->cell + first;
    const uint32_t *const behind = ground->cell + end;
    if (codes == ((codes << 4) | (codes & 15))) {
        do {
            *elevation++ = elevation_m_q14;
            *cell++ = top | (codes & 15);
        } while (cell < behind);
        return;
    }
    for (; cell < behind; v_q16 += v_cell_q16) {
        const uint32_t eighth = fx_min_u32(fx_abs_u32(v_q16) >> 13, 7);
        *elevation++ = elevation_m_q14;
        *cell++ = top | (codes >> (4 * eighth) & 15);
    }
}

/* Light cells first..end - 1 by a fence or wire. The ground keeps its class and height. */
static void draw_glint(const struct lm_detail_shape *shape, int32_t first, int32_t end,
                       uint32_t *cell)
{
    for (int32_t i = first; i < end; i++) {
        if (shape->gamma_code > (cell[i] >> 8 & 0xFF)) {
            cell[i] = (uint32_t)shape->gamma_code << 8 | (cell[i] & 0xFF);
        }
    }
}

/* Draw a surface into cells first..end - 1: those of the classes that it covers. */
static void draw_surface(const struct lm_detail_shape *shape, int32_t first, int32_t end,
                         uint32_t *cell)
{
    const uint32_t by = (uint32_t)shape->gamma_code << 8 | (uint32_t)shape->class_number << 4;
    lm_k_replace(shape->height_codes, by, cell + first, (uint32_t)(end - first));
}

/* Draw a shape into the cells of a line. Returns what that costs, in cells of a roof. */
static uint32_t draw_shape(const struct lm_detail_shape *shape, uint32_t line, uint32_t cells,
                           struct lm_scan_line *ground)
{
    const int32_t off_q8 = (int32_t)(line * 256) - shape->line_q8;
    const int32_t u_q16 = (int32_t)((int64_t)shape->u_line_q16 * off_q8 >> 8);
    const int32_t v_q16 = (int32_t)((int64_t)shape->v_line_q16 * off_q8 >> 8);
    struct interval d = {-shape->cell_q8, (int64_t)((cells - 1) * 256) - shape->cell_q8};
    if (!narrow(&d, u_q16, shape->u_cell_q16) || !narrow(&d, v_q16, shape->v_cell_q16)) {
        return 0;
    }
    /* Both are cells of the line, where the interval began. */
    const int32_t first = (int32_t)((shape->cell_q8 + d.from_q8 + 255) >> 8);
    const int32_t end = (int32_t)((shape->cell_q8 + d.to_q8) >> 8) + 1;
    const int32_t along_q8 = first * 256 - shape->cell_q8;
    if (end <= first) {
        return 0;
    }
    if (shape->kind == LM_DETAIL_SURFACE) {
        draw_surface(shape, first, end, ground->cell);
        return (uint32_t)(end - first) / 4;
    }
    if (shape->kind == LM_DETAIL_LINE) {
        draw_glint(shape, first, end, ground->cell);
    } else {
        draw_roof(shape, first, end, v_q16 + (int32_t)((int64_t)shape->v_cell_q16 * along_q8 >> 8),
                  ground);
    }
    return (uint32_t)(end - first);
}

/* Replace the structures among some cells of one tile by the ground under them, if the tile has
 * detail. */
static void uncover_tile(const struct lm_detail_patch *p, const struct lm_scan_run *run,
                         uint32_t *cell, uint32_t cells)
{
    for (uint32_t i = 0; i < p->tile_count; i++) {
        if (p->tile[i].row == run->row && p->tile[i].column == run->column) {
            lm_k_replace(p->structures, p->tile[i].under, cell, cells);
            return;
        }
    }
}

/* Replace the structures of the map by the ground under them, where the tile has detail. */
static void uncover(const struct lm_detail_patch *p, struct lm_scan_line *ground)
{
    uint32_t first = 0;
    for (uint32_t n = 0; n < ground->run_count; n++) {
        const struct lm_scan_run *run = &ground->run[n];
        uncover_tile(p, run, ground->cell + first, run->end - first);
        first = run->end;
    }
}

void lm_detail_patch_draw(const struct lm_detail_patch *p, uint32_t line,
                          struct lm_scan_line *ground, uint32_t cells)
{
    if (p->tile_count == 0) {
        return;
    }
    const uint32_t block = line / LM_DETAIL_BLOCK_LINES;
    uint32_t drawn = 0;
    uncover(p, ground);
    const uint16_t *const end = p->entry + p->first[block + 1];
    for (const uint16_t *entry = p->entry + p->first[block]; entry < end; entry++) {
        const struct lm_detail_shape *shape = &p->shape[*entry];
        __asm__("" : "+r"(shape)); /* the compiler would work it out for each of its fields */
        if (line >= shape->first_line && line < shape->end_line && drawn < LM_DETAIL_CELLS_A_LINE) {
            drawn += draw_shape(shape, line, cells, ground);
        }
    }
}
