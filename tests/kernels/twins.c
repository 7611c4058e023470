/* Compares each kernel of this build with its twin in plain C, in one process, on lines drawn at
 * random and at the edges of what their headers allow. Prints TAP, and of a kernel that differs the
 * seed, the first cell, and both values. That the plain ones are right is for the unit tests.
 *
 *   twins [SEEDS]     so many lines for each kernel (300) */
#include "fx/sat.h"
#include "hs/rng.h"
#include "lm/grain.h"
#include "lm/grown.h"
#include "lm/illumination.h"
#include "lm/noise.h"
#include "lm/tile_cache.h"
#include "lm/tone.h"
#include "plain.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GUARD = 32, ROOM = LM_CELLS_ROOM + GUARD, TILES = 3, UNTOUCHED = 0x5a5a5a5a };

/* What a kernel may read. Each array is drawn anew for each seed, its whole length. */
struct input {
    struct hs_rng rng;
    uint32_t cells, first;
    int32_t number[5]; /* floor, rise, ...: what the kernel has of that kind */
    uint32_t cell[ROOM], power_q24[LM_K_TAPS][ROOM], weight_q16[LM_K_TAPS], entry[ROOM];
    int32_t noise_db_q8[ROOM], loss_db_q8[ROOM], fall_db_q8[ROOM], rain_db_q8[ROOM];
    int16_t level_db_q8[ROOM], other_db_q8[ROOM];
    int32_t cell_of[ROOM];
    int16_t gain_db_q8[LM_K_CODES];
    uint8_t looks_log2;
    int8_t grain_q5[2][ROOM];
    int32_t base_db_q8[2][LM_K_CURVE_LINES], rise_db_q8[2][LM_K_CURVE_LINES];
    struct lm_tile pool[TILES];
    struct lm_tile_coords places;
    struct lm_scan_line ground;
    struct lm_range_grid grid;
    struct lm_class_lut class_lut;
    struct lm_tone tone;
    struct lm_k_colours colours;
};

/* What a kernel may write: two lines, of which entries first..end - 1 are compared. From entry
 * `room` on, a kernel may write nothing that its twin does not. */
struct output {
    uint32_t line[2][ROOM];
    uint32_t first, end[2], room;
    int32_t work[LM_K_LIGHT_WORK];
};

/* A row of the table below. `run` calls the kernel, or its twin in plain C. */
struct kernel {
    const char *name;
    void (*draw)(struct input *in);
    void (*run)(const struct input *in, struct output *out, bool is_plain);
};

#define TWIN(kernel) (is_plain ? kernel##_c : (kernel))

/* A number of any size up to 32 bits; each size is as likely. */
static uint32_t any_size(struct input *in)
{
    const uint32_t any = (uint32_t)hs_rng_u64(&in->rng);
    return any >> hs_rng_below(&in->rng, 32);
}

/* -limit..limit - 1, and now and then an end of that. */
static int32_t within(struct input *in, uint32_t limit)
{
    const uint32_t any = hs_rng_below(&in->rng, 2 * limit), rare = hs_rng_below(&in->rng, 40);
    return (int32_t)((rare == 0 ? 0 : rare == 1 ? 2 * limit - 1 : any) - limit);
}

/* Sizes, small ones apart, up to `limit`. */
static int32_t within_size(struct input *in, uint32_t limit)
{
    return within(in, fx_max_u32(limit >> hs_rng_below(&in->rng, 24), 1));
}

/* Levels, mostly of a few decibels; now and then a shadow. */
static void draw_level_line(int16_t *line, struct input *in)
{
    for (uint32_t k = 0; k < ROOM; k++) {
        line[k] =
            hs_rng_below(&in->rng, 8) == 0 ? LM_LEVEL_SHADOW : (int16_t)within_size(in, 1 << 15);
    }
}

static void draw_line(int32_t *line, struct input *in, uint32_t limit)
{
    for (uint32_t k = 0; k < ROOM; k++) {
        line[k] = hs_rng_below(&in->rng, 8) == 0 ? LM_LEVEL_SHADOW : within_size(in, limit);
    }
}

static void draw_noise(struct input *in)
{
    in->looks_log2 = (uint8_t)hs_rng_below(&in->rng, LM_NOISE_LOOKS_LOG2_MAX + 1);
    for (uint32_t k = 0; k < ROOM; k++) {
        in->entry[k] = hs_rng_below(&in->rng, LM_NOISE_SLICES);
    }
}

static void draw_levels(struct input *in)
{
    draw_noise(in);
    draw_level_line(in->level_db_q8, in);
    draw_level_line(in->other_db_q8, in);
    draw_line(in->loss_db_q8, in, 1 << 30);
    in->number[0] = within_size(in, 1 << 30);
    in->number[1] = within_size(in, 1 << 15);
}

/* Numbers and curves of any kind that lm/kernels_clutter.h allows. */
static void draw_grain(struct input *in)
{
    for (uint32_t n = 0; n < 2; n++) {
        for (uint32_t k = 0; k < ROOM; k++) {
            in->grain_q5[n][k] = (int8_t)((int32_t)hs_rng_below(&in->rng, 256) - 128);
        }
        for (uint32_t k = 0; k < LM_K_CURVE_LINES; k++) {
            in->base_db_q8[n][k] = within_size(in, 1 << 14);
            in->rise_db_q8[n][k] = (int32_t)hs_rng_below(&in->rng, 4370);
        }
    }
}

static void draw_speckle(struct input *in)
{
    draw_levels(in);
    draw_grain(in);
}

static void draw_small_levels(struct input *in)
{
    draw_level_line(in->level_db_q8, in);
    in->number[0] = within_size(in, 1 << 15);
    for (uint32_t k = 0; k < ROOM; k++) {
        in->cell_of[k] = (int32_t)hs_rng_below(&in->rng, LM_CELLS_ROOM);
    }
}

static void draw_powers(struct input *in)
{
    uint32_t left = 65536;
    draw_noise(in);
    for (uint32_t j = 0; j < LM_K_TAPS; j++) {
        in->weight_q16[j] = j + 1 < LM_K_TAPS ? hs_rng_below(&in->rng, left + 1) : left;
        left -= in->weight_q16[j];
        for (uint32_t k = 0; k < ROOM; k++) {
            in->power_q24[j][k] = hs_rng_below(&in->rng, 8) ? any_size(in) : 0u - (k & 1);
        }
    }
    draw_line(in->noise_db_q8, in, 1 << 20);
    draw_line(in->loss_db_q8, in, 1 << 20);
    draw_line(in->fall_db_q8, in, 1 << 20);
    draw_line(in->rain_db_q8, in, 1 << 20);
    in->number[0] = within_size(in, 1 << 16);
}

static void draw_classes(struct input *in)
{
    draw_levels(in);
    for (uint32_t k = 0; k < LM_K_CODES; k++) {
        in->gain_db_q8[k] = (int16_t)within_size(in, 1 << 15);
    }
    for (uint32_t k = 0; k < ROOM; k++) {
        in->cell[k] = (uint32_t)hs_rng_u64(&in->rng) & 0xffff;
    }
}

/* A tile of whatever numbers lm_tile_check lets pass. */
static void draw_tile(struct input *in, struct lm_tile *tile)
{
    for (int i = 0; i < LM_TILE_POINTS * LM_TILE_POINTS; i++) {
        const uint16_t any = (uint16_t)hs_rng_u64(&in->rng);
        struct lm_tile_point *point = &tile->points[i / LM_TILE_POINTS][i % LM_TILE_POINTS];
        point->post = any % 16 == 0 ? 0 : any % 16 == 1 ? UINT16_MAX : any;
        point->cell = (uint16_t)hs_rng_u64(&in->rng);
    }
    tile->base_m_q6 = within(in, 1 << 20);
    tile->post_shift = (uint8_t)hs_rng_below(&in->rng, LM_TILE_POST_SHIFT_MAX + 1);
}

static struct lm_quadratic any_track(struct input *in)
{
    const uint32_t at = (uint32_t)hs_rng_u64(&in->rng), step = any_size(in);
    return (struct lm_quadratic){at, step, any_size(in)};
}

/* Runs of a line in tiles of a pool. */
static void draw_tiles(struct input *in)
{
    in->places.north = any_track(in);
    in->places.east = any_track(in);
    in->first = hs_rng_below(&in->rng, in->cells);
    draw_tile(in, &in->pool[hs_rng_below(&in->rng, TILES)]);
    struct lm_tile_base tile = {0, 0};
    for (uint32_t k = 0; k < LM_CELLS_ROOM; k++) {
        if (k == 0 || hs_rng_below(&in->rng, 50) == 0) {
            tile = lm_tile_base_of(in->pool, &in->pool[hs_rng_below(&in->rng, TILES)]);
        }
        in->ground.cell[k] = tile.record;
        in->ground.elevation_m_q14[k] = tile.scale;
    }
}

/* Ground as rough as a cell is long, and now and then any; classes in runs. */
static void draw_ground(struct input *in, uint32_t cell_q8)
{
    const bool is_wild = hs_rng_below(&in->rng, 4) == 0;
    uint32_t low_bits = (uint32_t)hs_rng_u64(&in->rng);
    int32_t elevation_q14 = 0;
    for (uint32_t i = 0; i < LM_CELLS_ROOM; i++) {
        const uint32_t any = (uint32_t)hs_rng_u64(&in->rng);
        low_bits = any % 5 == 0 ? any >> 8 : low_bits;
        elevation_q14 = is_wild ? (int32_t)hs_rng_below(&in->rng, 48000u << 14) - (16000 << 14)
                                : elevation_q14 % (1 << 26) + within(in, 16 * cell_q8);
        const int32_t code = (int32_t)(any >> 24), blended = (int32_t)hs_rng_below(&in->rng, 256);
        const int32_t more_db_q8 = any % 3 == 0 ? (blended - code) * LM_GAMMA_CODE_STEP_DB_Q8 : 0;
        in->ground.cell[i] = (uint32_t)more_db_q8 << 16 | (any >> 16 & 0xFF00) | (low_bits & 0xFF);
        in->ground.elevation_m_q14[i] = elevation_q14;
    }
}

static void draw_class_lut(struct input *in, struct lm_illumination_config *config)
{
    static struct lm_classes classes;
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        classes.entry[i].kind = (uint8_t)hs_rng_below(&in->rng, LM_KINDS);
        classes.height_dm[i] = (uint16_t)(any_size(in) >> 16);
    }
    config->edge_structure_db_q8 = (int16_t)hs_rng_below(&in->rng, 4096);
    config->edge_trees_db_q8 = (int16_t)hs_rng_below(&in->rng, 32768);
    config->shore_db_q8 = (int16_t)hs_rng_below(&in->rng, 4096);
    config->shore_width_m = (uint16_t)hs_rng_below(&in->rng, 2000);
    lm_class_lut_set(&in->class_lut, config, &classes);
}

/* Tiles of a few classes, so that cells side by side are often of one; masks of any. */
static void draw_blend(struct input *in)
{
    struct lm_illumination_config config;
    draw_tiles(in);
    draw_class_lut(in, &config);
    const uint32_t kinds = (uint32_t)hs_rng_u64(&in->rng) & 0xF0;
    for (int t = 0; t < TILES; t++) {
        for (int i = 0; i < LM_TILE_POINTS * LM_TILE_POINTS; i++) {
            in->pool[t].points[i / LM_TILE_POINTS][i % LM_TILE_POINTS].cell &=
                (uint16_t)(0xFF0F | kinds);
        }
    }
    in->number[0] = 20 + (int32_t)hs_rng_below(&in->rng, 7);
    in->number[1] = (int32_t)hs_rng_below(&in->rng, 65536);
    in->number[3] = (int32_t)(hs_rng_u64(&in->rng) & hs_rng_u64(&in->rng) & 0xFFFF);
    in->number[2] = hs_rng_below(&in->rng, 2) ? (int32_t)hs_rng_below(&in->rng, 65536) : 0;
    in->number[4] = (int32_t)hs_rng_below(&in->rng, 2);
}

static void draw_light(struct input *in)
{
    struct lm_illumination_config config;
    const uint32_t cell_q8 = 128u << hs_rng_below(&in->rng, 10);
    const uint32_t first_q8 = cell_q8 + hs_rng_below(&in->rng, 60000 * 256);
    draw_class_lut(in, &config);
    draw_ground(in, cell_q8);
    memset(&in->grid, 0, sizeof in->grid);
    lm_range_grid_set(&in->grid, &config, first_q8, cell_q8, in->cells, within(in, 30000 * 1024),
                      0);
    for (uint32_t k = 0; k < LM_K_CODES; k++) {
        in->gain_db_q8[k] = (int16_t)within_size(in, 1 << 15);
    }
    in->number[0] = within_size(in, 1 << 30);
}

/* Windows of any width, with every gamma; levels in them, beside them, and beyond 16 bits. */
static void draw_tone(struct input *in)
{
    const uint32_t widest_q8 = 255u * 256u >> hs_rng_below(&in->rng, 8);
    const int32_t span_q8 = fx_max_i32((int32_t)hs_rng_below(&in->rng, widest_q8 + 1), 256);
    const int32_t black_q8 = (int32_t)hs_rng_below(&in->rng, 65536u - (uint32_t)span_q8) - 32768;
    const struct lm_tone_config config = {(int16_t)black_q8, (int16_t)(black_q8 + span_q8),
                                          (uint16_t)(26 + hs_rng_below(&in->rng, 999))};
    if (lm_tone_set(&in->tone, &config) != 0) {
        abort();
    }
    for (uint32_t k = 0; k < ROOM; k++) {
        const int32_t any = (int32_t)hs_rng_u64(&in->rng), place_q15 = any & 0x7fff;
        const int32_t near_q8 = black_q8 - 500 + (place_q15 * (span_q8 + 1000) >> 15);
        in->level_db_q8[k] = fx_sat_i16(k % 8 == 0 ? any >> k % 24 : near_q8);
    }
}

static int32_t *signed_line(uint32_t *line)
{
    return (int32_t *)line;
}

static const int16_t *row_of(const struct input *in)
{
    return lm_noise_db_q8[in->looks_log2];
}

static void copy_cells(uint32_t *to, const void *from)
{
    memcpy(to, from, LM_CELLS_ROOM * sizeof *to);
}

/* A line of levels that a kernel writes, or changes: entry by entry it then goes to an output, and
 * tells there whether it was touched. */
struct levels {
    int16_t db_q8[ROOM];
};

static struct levels untouched(void)
{
    struct levels l;
    memset(&l, UNTOUCHED & 0xff, sizeof l);
    return l;
}

static void tell_levels(uint32_t *line, const struct levels *l)
{
    for (uint32_t k = 0; k < ROOM; k++) {
        line[k] = (uint32_t)l->db_q8[k];
    }
}

static struct levels levels_of(const int16_t *from)
{
    struct levels l = untouched();
    memcpy(l.db_q8, from, LM_CELLS_ROOM * sizeof *from);
    return l;
}

static void run_tile_read(const struct input *in, struct output *out, bool is_plain)
{
    const uint32_t groups = (in->cells - in->first + LM_LANES - 1) / LM_LANES;
    copy_cells(out->line[0], in->ground.cell);
    copy_cells(out->line[1], in->ground.elevation_m_q14);
    TWIN(lm_k_tile_read)
    (lm_tile_origin(&in->pool[0]), &in->places, in->first, groups, out->line[0],
     signed_line(out->line[1]));
    out->first = in->first;
    out->end[0] = out->end[1] = in->first + groups * LM_LANES;
    out->room = out->end[0];
}

static void run_tile_blend(const struct input *in, struct output *out, bool is_plain)
{
    const uint32_t groups = (in->cells - in->first + LM_LANES - 1) / LM_LANES;
    const struct lm_k_blend map = {.points = lm_tile_origin(in->pool),
                                   .grown = lm_grown,
                                   .height_dm_of_code = in->class_lut.height_dm,
                                   .grown_shift = (uint32_t)in->number[0],
                                   .is_stepped = in->number[4] != 0,
                                   .natural = (uint32_t)in->number[1],
                                   .crowned = (uint32_t)in->number[2],
                                   .flat = (uint32_t)in->number[3]};
    copy_cells(out->line[0], in->ground.cell);
    copy_cells(out->line[1], in->ground.elevation_m_q14);
    TWIN(lm_k_tile_blend)
    (&map, &in->places, in->first, groups, out->line[0], signed_line(out->line[1]));
    out->first = in->first;
    out->end[0] = out->end[1] = in->first + groups * LM_LANES;
    out->room = out->end[0];
}

static void run_replace(const struct input *in, struct output *out, bool is_plain)
{
    copy_cells(out->line[0], in->cell);
    TWIN(lm_k_replace)
    ((uint32_t)in->number[0] & 0xFFFF, (uint32_t)in->number[1], out->line[0], in->cells);
    out->room = in->cells;
}

static struct lm_k_tops tops_of(const struct input *in)
{
    return (struct lm_k_tops){in->grid.first,         in->cells,
                              in->ground.cell,        in->ground.elevation_m_q14,
                              in->grid.fall_m_q14,    in->grid.inverse_range,
                              in->class_lut.height_dm};
}

static void run_light(const struct input *in, struct output *out, bool is_plain)
{
    const struct lm_k_tops tops = tops_of(in);
    const uint16_t height_dm = tops.height_dm_of_code[tops.cell[tops.first] % LM_K_CODES];
    const int64_t tangent = lm_k_tangent(&tops, tops.first, lm_k_height_m_q14(height_dm));
    struct levels levels = untouched();
    const struct lm_k_lit_line line = {
        .tops = tops,
        .gain_db_q8 = in->grid.gain_db_q8,
        .mark_of_class = in->class_lut.mark,
        .edge_structure_db_q3 = in->class_lut.edge_structure_db_q3,
        .edge_trees_db_q3 = in->class_lut.edge_trees_db_q3,
        .shore_db_q8 = in->class_lut.shore_db_q8,
        .shore_fall_db_q8 = in->grid.shore_fall_db_q8,
        .class_gain_db_q8 = in->gain_db_q8,
        .start = fx_sat_i32(tangent + in->number[0]),
        .horizon = signed_line(out->line[0]),
        .level_db_q8 = levels.db_q8,
        .work = out->work,
    };
    TWIN(lm_k_light)(&line);
    tell_levels(out->line[1], &levels);
    out->end[0] = in->cells + 1;
    out->room = LM_CELLS_ROOM;
}

static void run_highest_tangent(const struct input *in, struct output *out, bool is_plain)
{
    const struct lm_k_tops tops = tops_of(in);
    const bool has_cells = tops.first < tops.cells;
    out->line[0][0] = has_cells ? (uint32_t)TWIN(lm_k_highest_tangent)(&tops) : 0;
    out->end[0] = 1;
    out->room = 16;
}

static void run_water_gain(const struct input *in, struct output *out, bool is_plain)
{
    struct levels levels = levels_of(in->level_db_q8);
    TWIN(lm_k_water_gain)
    ((uint32_t)in->number[0], in->number[1], in->loss_db_q8, in->cell, levels.db_q8, in->cells);
    tell_levels(out->line[0], &levels);
}

static struct lm_k_curve curve_of(const struct input *in, uint32_t n)
{
    return (struct lm_k_curve){in->base_db_q8[n], in->rise_db_q8[n]};
}

/* Ground as it comes, as rough as it comes, and far from the reference; any heights of codes. */
static void draw_layover(struct input *in)
{
    draw_ground(in, 128u << hs_rng_below(&in->rng, 10));
    draw_level_line(in->level_db_q8, in);
    for (uint32_t k = in->cells; k < ROOM; k++) {
        in->level_db_q8[k] = LM_LEVEL_SHADOW;
    }
    for (uint32_t k = 0; k < LM_K_CODES; k++) {
        in->gain_db_q8[k] = hs_rng_below(&in->rng, 3) ? (int16_t)(any_size(in) >> 17) : 0;
    }
    in->number[0] = within_size(in, 1 << 29);
    in->number[1] = (int32_t)(any_size(in) >> (1 + hs_rng_below(&in->rng, 20)));
}

static void run_layover(const struct input *in, struct output *out, bool is_plain)
{
    int16_t laid_db_q8[LM_K_LAYOVER_ROOM];
    struct levels levels = untouched();
    uint8_t height_sixteenths[2][LM_K_CODES];
    const struct lm_k_layover line = {.cell = in->ground.cell,
                                      .elevation_m_q14 = in->ground.elevation_m_q14,
                                      .level_db_q8 = in->level_db_q8,
                                      .cells = in->cells,
                                      .reference_m_q14 = in->number[0],
                                      .sixteenths_q31 = in->number[1],
                                      .height_sixteenths = height_sixteenths};
    for (uint32_t k = 0; k < LM_K_CODES; k++) {
        height_sixteenths[0][k] = (uint8_t)in->gain_db_q8[k];
        height_sixteenths[1][k] = (uint8_t)(in->gain_db_q8[k] >> 8);
    }
    memset(laid_db_q8, UNTOUCHED & 0xff, sizeof laid_db_q8);
    TWIN(lm_k_layover)(&line, laid_db_q8);
    memcpy(levels.db_q8, laid_db_q8 + LM_K_LAYOVER_MARGIN, in->cells * sizeof *levels.db_q8);
    tell_levels(out->line[0], &levels);
    out->end[1] = 0;
}

static void run_grain_add(const struct input *in, struct output *out, bool is_plain)
{
    const struct lm_k_curve curve = curve_of(in, 0);
    struct levels levels = levels_of(in->level_db_q8);
    TWIN(lm_k_grain_add)(&curve, in->grain_q5[0], levels.db_q8, in->cells);
    tell_levels(out->line[0], &levels);
}

static void run_grain_floor(const struct input *in, struct output *out, bool is_plain)
{
    const struct lm_k_curve curve = curve_of(in, 0);
    struct levels levels = untouched();
    TWIN(lm_k_grain_floor)
    (&curve, in->grain_q5[0], in->number[0], in->level_db_q8, levels.db_q8, in->cells);
    tell_levels(out->line[0], &levels);
}

static void run_grain_stretch(const struct input *in, struct output *out, bool is_plain)
{
    const uint32_t step_q16 = (uint32_t)in->number[0] & 0xFFFF;
    TWIN(lm_k_grain_stretch)
    (lm_grain_weight_q7, step_q16, in->grain_q5[0], (int8_t *)out->line[0], in->cells);
    /* Four cells an entry; those behind the last, of its group, mean nothing. */
    out->end[0] = in->cells / 4;
    out->room = (in->cells + 15) / 16 * 4;
}

static void run_gather(const struct input *in, struct output *out, bool is_plain)
{
    struct levels bins = untouched();
    TWIN(lm_k_gather)(in->level_db_q8, in->cell_of, bins.db_q8, in->cells);
    tell_levels(out->line[0], &bins);
    out->room = in->cells;
}

static void run_powers_of_levels(const struct input *in, struct output *out, bool is_plain)
{
    TWIN(lm_k_powers_of_levels)(in->level_db_q8, out->line[0], in->cells);
    out->room = in->cells;
}

/* As many levels as a line has, from each of its first cells on. */
static void run_sum_powers(const struct input *in, struct output *out, bool is_plain)
{
    for (uint32_t first = 0; first < LM_K_STRIDE; first++) {
        const uint32_t count = in->cells <= first ? 0 : (in->cells - first + 3) / LM_K_STRIDE;
        out->line[0][first] =
            TWIN(lm_k_sum_powers)(in->level_db_q8 + first, (int16_t)in->number[0], count);
    }
    out->end[0] = out->room = LM_K_STRIDE;
}

static void run_levels_add(const struct input *in, struct output *out, bool is_plain)
{
    struct levels sum = levels_of(in->other_db_q8);
    TWIN(lm_k_levels_add)(sum.db_q8, in->level_db_q8, in->cells);
    tell_levels(out->line[0], &sum);
    out->room = in->cells;
}

static void run_levels_mean(const struct input *in, struct output *out, bool is_plain)
{
    struct levels mean = levels_of(in->level_db_q8);
    TWIN(lm_k_levels_mean)(in->other_db_q8, (int16_t)in->number[1], mean.db_q8, in->cells);
    tell_levels(out->line[0], &mean);
    out->room = in->cells;
}

static void run_highest(const struct input *in, struct output *out, bool is_plain)
{
    struct levels highest = untouched();
    TWIN(lm_k_highest)(in->level_db_q8, highest.db_q8, in->cells);
    tell_levels(out->line[0], &highest);
    out->end[0] = (in->cells + LM_K_HIGHEST_CELLS - 1) / LM_K_HIGHEST_CELLS;
    out->room = out->end[0];
}

/* Peaks that stand about as high as is asked. */
static void draw_peaks(struct input *in)
{
    draw_levels(in);
    in->number[0] = within_size(in, 1 << 15);
    in->number[1] = within_size(in, hs_rng_below(&in->rng, 2) ? 1 << 15 : 1 << 8);
    for (uint32_t k = 0; k < ROOM; k += 1 + hs_rng_below(&in->rng, 6)) {
        in->level_db_q8[k] = fx_sat_i16(in->number[0] + within_size(in, 1 << 12));
    }
}

static void run_stand_out(const struct input *in, struct output *out, bool is_plain)
{
    for (uint32_t k = 0; k < in->cells; k++) {
        out->line[0][k] = TWIN(lm_k_stand_out)(in->level_db_q8 + LM_K_BESIDE + k,
                                               (int16_t)in->number[0], (int16_t)in->number[1]);
    }
}

enum { LOBES = 2 * LM_K_LOBES_REACH + 1 };

/* Side lobes of 0 to -64 dB. */
static void draw_response(const struct input *in, uint32_t from, int16_t side_db_q8[LOBES])
{
    for (uint32_t k = 0; k < LOBES; k++) {
        side_db_q8[k] = (int16_t) - (in->other_db_q8[from + k] & 0x3FFF);
    }
}

/* Lines lie one behind the other, in another order than they are named. Near an end of its line a
 * point has no lobes along it. */
static void run_side_lobes(const struct input *in, struct output *out, bool is_plain)
{
    enum { LINE_CELLS = ROOM / LOBES };
    int16_t along_db_q8[LOBES], across_db_q8[LOBES], *around[LOBES];
    draw_response(in, 0, along_db_q8);
    draw_response(in, LOBES, across_db_q8);
    struct levels levels = levels_of(in->level_db_q8);
    for (uint32_t k = 0; k < LOBES; k++) {
        around[k] = levels.db_q8 + (k + in->entry[0]) % LOBES * LINE_CELLS;
    }
    const uint32_t cell = in->entry[1] % LINE_CELLS;
    const bool has_all = cell >= LM_K_LOBES_REACH && cell + LM_K_LOBES_REACH < LINE_CELLS;
    TWIN(lm_k_side_lobes)
    (has_all ? along_db_q8 + LM_K_LOBES_REACH : NULL, across_db_q8 + LM_K_LOBES_REACH,
     (int16_t)in->number[1], around, cell);
    tell_levels(out->line[0], &levels);
    out->end[0] = out->room = ROOM;
}

static void run_beam_sum(const struct input *in, struct output *out, bool is_plain)
{
    const uint32_t *power_q24[LM_K_TAPS];
    for (uint32_t j = 0; j < LM_K_TAPS; j++) {
        power_q24[j] = in->power_q24[j];
    }
    TWIN(lm_k_beam_sum)(power_q24, in->weight_q16, out->line[0], in->cells);
    out->room = in->cells;
}

/* A floor between two means below 2^27. */
static void draw_slope(struct input *in)
{
    draw_powers(in);
    const uint32_t from = any_size(in) >> 5, to = any_size(in) >> 5;
    in->number[0] = (int32_t)from;
    in->number[1] = (int32_t)(to - from) / (int32_t)(in->cells / 32 + 1);
}

static void run_add_slope(const struct input *in, struct output *out, bool is_plain)
{
    memcpy(out->line[0], in->power_q24[0], sizeof out->line[0]);
    TWIN(lm_k_add_slope)
    (out->line[0], in->cells, (uint32_t)in->number[0], (uint32_t)in->number[1]);
    out->end[0] = out->room = ROOM;
}

static void run_fade(const struct input *in, struct output *out, bool is_plain)
{
    memcpy(out->line[0], in->power_q24[0], sizeof out->line[0]);
    TWIN(lm_k_fade)(in->power_q24[1], out->line[0], in->cells);
}

static struct lm_k_receiver receiver_of(const struct input *in)
{
    return (struct lm_k_receiver){in->noise_db_q8, in->fall_db_q8, in->number[0], row_of(in),
                                  in->entry};
}

static void run_detect(const struct input *in, struct output *out, bool is_plain)
{
    const struct lm_k_receiver r = receiver_of(in);
    struct levels levels = untouched();
    TWIN(lm_k_detect)(&r, in->power_q24[0], levels.db_q8, in->cells);
    tell_levels(out->line[0], &levels);
}

static void run_detect_in_rain(const struct input *in, struct output *out, bool is_plain)
{
    const struct lm_k_receiver r = receiver_of(in);
    const struct lm_k_rain rain = {in->loss_db_q8, in->rain_db_q8};
    struct levels levels = untouched();
    TWIN(lm_k_detect_in_rain)(&r, &rain, in->power_q24[0], levels.db_q8, in->cells);
    tell_levels(out->line[0], &levels);
}

static void run_tone(const struct input *in, struct output *out, bool is_plain)
{
    const struct lm_k_tone_curve curve = {in->tone.black_db_q8, in->tone.white_db_q8,
                                          in->tone.step_log2, in->tone.grey,
                                          in->tone.has_pieces ? in->tone.pieces : NULL};
    uint8_t grey[ROOM];
    memset(grey, UNTOUCHED & 0xff, sizeof grey);
    TWIN(lm_k_tone)(&curve, in->level_db_q8, grey, in->cells);
    for (uint32_t k = 0; k < ROOM; k++) {
        out->line[0][k] = k < in->cells || grey[k] != (UNTOUCHED & 0xff) ? grey[k] : UNTOUCHED;
    }
    out->room = in->cells;
}

/* Any rectangle of a small picture, in grey or in a tint; some are blank, but perhaps for a pixel.
 */
static void draw_colours(struct input *in)
{
    const bool is_neutral = hs_rng_below(&in->rng, 2) != 0;
    draw_grain(in);
    in->colours.shift = (uint8_t)(8 * hs_rng_below(&in->rng, 2));
    for (uint32_t grey = 0; grey < LM_K_GREYS; grey++) {
        const uint32_t any = (uint32_t)hs_rng_u64(&in->rng);
        const uint32_t parts = is_neutral ? (any & 255) * 0x10101u : any & 0xFFFFFF;
        in->colours.of_grey[grey] = parts << in->colours.shift;
        for (uint32_t k = 0; k < LM_K_COLOUR_BYTES; k++) {
            in->colours.byte[k][grey] = (uint8_t)(parts << in->colours.shift >> 8 * k);
        }
    }
    in->colours.is_neutral = is_neutral;
    for (uint32_t n = 0; n < 5; n++) {
        in->number[n] = (int32_t)hs_rng_below(&in->rng, 24);
    }
    if (in->number[3] < 8) {
        memset(in->grain_q5[0], 0, sizeof in->grain_q5[0]);
        in->grain_q5[0][hs_rng_below(&in->rng, ROOM)] = (int8_t)(in->number[3] / 4);
    }
}

static void run_colour_area(const struct input *in, struct output *out, bool is_plain)
{
    const uint32_t height = 1 + in->first % 6, most = ROOM / height - 24;
    const uint32_t width =
        in->number[4] < 12 ? 64 * (1 + in->cells % (most / 64)) : 1 + in->cells % most;
    const struct lm_k_area area = {.grey = (const uint8_t *)in->grain_q5[0] + in->number[0],
                                   .pixel = out->line[0] + in->number[1],
                                   .grey_stride = width,
                                   .pixel_stride = width + (uint32_t)in->number[2] % 8,
                                   .width = width,
                                   .height = height};
    TWIN(lm_k_colour_area)(&in->colours, &area);
    out->end[0] = ROOM;
    out->room = ROOM;
}

static void draw_strips(struct input *in)
{
    for (uint32_t k = 0; k < ROOM; k++) {
        in->cell[k] = (uint32_t)hs_rng_u64(&in->rng);
        in->entry[k] = (uint32_t)hs_rng_u64(&in->rng);
    }
}

static void draw_patch(struct input *in)
{
    draw_strips(in);
    in->first = hs_rng_below(&in->rng, 1 << 16);
    in->number[0] = (int32_t)hs_rng_below(&in->rng, 4);
}

/* The cells of a patch's rows: close together, or anywhere in a line. */
static struct lm_k_patch_cells patch_cells(const struct input *in, uint32_t rows)
{
    struct lm_k_patch_cells c = {.are_close = in->number[0] > 0};
    for (uint32_t row = 0; row < rows + LM_K_PATCH_GROUP; row++) {
        const uint32_t any = (uint32_t)in->cell[row % ROOM], most = c.are_close ? 32 : 256;
        if (row % LM_K_PATCH_GROUP == 0) {
            c.first[row / LM_K_PATCH_GROUP] = (uint16_t)(any >> 8 & 255);
        }
        c.above[row] = (uint8_t)(any % most);
        c.part_q7[row] = (uint8_t)(c.above[row] == 31 ? 0 : any >> 16 & 127);
    }
    return c;
}

/* Sixteen greys of each row, in four entries of a line. */
static void run_patch_hold(const struct input *in, struct output *out, bool is_plain)
{
    const uint32_t rows = 1 + in->cells % 128;
    const struct lm_k_patch_cells c = patch_cells(in, rows);
    TWIN(lm_k_patch_hold)
    (&c, (const uint8_t *)in->entry, rows, (uint8_t(*)[LM_K_HELD])out->line[0],
     in->first % LM_K_HELD);
    out->end[0] = 4 * rows;
    out->room = (rows + LM_K_PATCH_GROUP - 1) / LM_K_PATCH_GROUP * LM_K_PATCH_GROUP * 4;
}

/* Strips of any number of lines. Some rows begin behind the strip, and steps are of any size that
 * leaves a row no more pixels than a strip may have. */
static void run_patch_paint(const struct input *in, struct output *out, bool is_plain)
{
    enum { ROWS = 32, STRIDE = 64 };
    const uint32_t lines = 1 + in->first % LM_K_STRIP_LINES;
    int32_t step_q20[ROWS], on_q20[ROWS];
    uint16_t column_px[ROWS];
    uint8_t held[ROWS][LM_K_HELD];
    memcpy(held, in->entry, sizeof held);
    for (uint32_t i = 0; i < ROWS; i++) {
        step_q20[i] =
            (int32_t)((lines << 20) / LM_K_STRIP_PX + (in->cell[i] >> in->cells % 28 >> 6));
        on_q20[i] = (int32_t)(in->cell[ROWS + i] % ((lines + 2) << 20));
        column_px[i] = (uint16_t)(in->cell[2 * ROWS + i] % (STRIDE - LM_K_STRIP_PX));
    }
    const struct lm_k_patch_strip strip = {.held = held,
                                           .lines = lines,
                                           .step_q20 = step_q20,
                                           .on_q20 = on_q20,
                                           .column_px = column_px,
                                           .pixels = (uint8_t *)out->line[0] + (ROWS - 1) * STRIDE,
                                           .up = -STRIDE,
                                           .rows = ROWS};
    TWIN(lm_k_patch_paint)(&strip);
    for (uint32_t i = 0; i < ROWS; i++) {
        out->line[1][i] = (uint32_t)on_q20[i];
        out->line[1][ROWS + i] = column_px[i];
        out->line[1][2 * ROWS + i] = held[i][0];
    }
    out->end[0] = ROWS * STRIDE / 4;
    out->end[1] = 3 * ROWS;
    out->room = ROOM;
}

static void run_tile_row(const struct input *in, struct output *out, bool is_plain)
{
    struct lm_k_strips strips;
    memcpy(&strips, in->cell, sizeof strips);
    TWIN(lm_k_tile_row)
    ((struct lm_tile_point *)out->line[0], (const struct lm_tile_point *)in->entry, &strips);
    out->end[0] = out->room = LM_TILE_POINTS;
}

static const struct kernel kernels[] = {
    {"lm_k_tile_read", draw_tiles, run_tile_read},
    {"lm_k_tile_blend", draw_blend, run_tile_blend},
    {"lm_k_tile_row", draw_strips, run_tile_row},
    {"lm_k_replace", draw_classes, run_replace},
    {"lm_k_light", draw_light, run_light},
    {"lm_k_highest_tangent", draw_light, run_highest_tangent},
    {"lm_k_water_gain", draw_classes, run_water_gain},
    {"lm_k_layover", draw_layover, run_layover},
    {"lm_k_grain_add", draw_speckle, run_grain_add},
    {"lm_k_grain_floor", draw_speckle, run_grain_floor},
    {"lm_k_grain_stretch", draw_speckle, run_grain_stretch},
    {"lm_k_gather", draw_small_levels, run_gather},
    {"lm_k_powers_of_levels", draw_small_levels, run_powers_of_levels},
    {"lm_k_sum_powers", draw_small_levels, run_sum_powers},
    {"lm_k_levels_add", draw_levels, run_levels_add},
    {"lm_k_levels_mean", draw_levels, run_levels_mean},
    {"lm_k_highest", draw_levels, run_highest},
    {"lm_k_stand_out", draw_peaks, run_stand_out},
    {"lm_k_side_lobes", draw_levels, run_side_lobes},
    {"lm_k_beam_sum", draw_powers, run_beam_sum},
    {"lm_k_add_slope", draw_slope, run_add_slope},
    {"lm_k_fade", draw_powers, run_fade},
    {"lm_k_detect", draw_powers, run_detect},
    {"lm_k_detect_in_rain", draw_powers, run_detect_in_rain},
    {"lm_k_tone", draw_tone, run_tone},
    {"lm_k_patch_hold", draw_patch, run_patch_hold},
    {"lm_k_patch_paint", draw_patch, run_patch_paint},
    {"lm_k_colour_area", draw_colours, run_colour_area},
};

enum { KERNELS = sizeof kernels / sizeof *kernels };

/* Lengths on either side of a group first, then any. */
static void draw_cells(struct input *in, uint32_t seed)
{
    static const uint16_t edge[] = {1, 7, 8, 9, 15, 16, 17, 31, 32, 33, 63, 64, 65, 255, 256, 257};
    const uint32_t edges = sizeof edge / sizeof *edge;
    in->cells = seed < edges              ? edge[seed]
                : seed < edges + LM_LANES ? LM_CELLS_MAX - (seed - edges)
                                          : 1 + hs_rng_below(&in->rng, LM_CELLS_MAX);
}

/* The entry of a line where an output is not as in the other, or the length where none is. */
static uint32_t first_different(const struct output *a, const struct output *b, int line)
{
    uint32_t k = a->first;
    while (k < a->end[line] && a->line[line][k] == b->line[line][k]) {
        k++;
    }
    return k;
}

/* The entry from `room` on that was written to by one of them alone, or ROOM. */
static uint32_t first_touched(const struct output *plain, const struct output *ours, int line)
{
    uint32_t k = ours->room;
    while (k < ROOM && ours->line[line][k] == plain->line[line][k]) {
        k++;
    }
    return k;
}

/* Whether one line comes out alike and nothing else is written; says what is not so. */
static bool is_same(const struct kernel *kernel, const struct input *in, uint32_t seed,
                    const struct output *ours, const struct output *plain)
{
    for (int line = 0; line < 2; line++) {
        const uint32_t k = first_different(ours, plain, line);
        if (k < ours->end[line]) {
            printf("# %s, seed %u: cell %u of %u of line %d is %d, and %d in plain C\n",
                   kernel->name, (unsigned)seed, (unsigned)k, (unsigned)in->cells, line,
                   (int)ours->line[line][k], (int)plain->line[line][k]);
            return false;
        }
        const uint32_t touched = first_touched(plain, ours, line);
        if (touched < ROOM) {
            printf("# %s, seed %u: entry %u of line %d is written, behind %u cells\n", kernel->name,
                   (unsigned)seed, (unsigned)touched, line, (unsigned)in->cells);
            return false;
        }
    }
    return true;
}

static void run(const struct kernel *kernel, const struct input *in, struct output *out,
                bool is_plain)
{
    for (uint32_t k = 0; k < ROOM; k++) {
        out->line[0][k] = out->line[1][k] = UNTOUCHED;
    }
    out->first = 0;
    out->end[0] = out->end[1] = in->cells;
    out->room = (in->cells + 15) / 16 * 16;
    kernel->run(in, out, is_plain);
}

static bool is_same_of_all_seeds(const struct kernel *kernel, uint32_t seeds)
{
    static struct input in;
    static struct output ours, plain;
    for (uint32_t seed = 0; seed < seeds; seed++) {
        hs_rng_seed(&in.rng, seed);
        draw_cells(&in, seed);
        kernel->draw(&in);
        run(kernel, &in, &ours, false);
        run(kernel, &in, &plain, true);
        if (!is_same(kernel, &in, seed, &ours, &plain)) {
            return false;
        }
    }
    return true;
}

int main(int argc, char **argv)
{
    const uint32_t seeds = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 300;
    int failed = 0;
    for (int i = 0; i < KERNELS; i++) {
        const bool is_good = is_same_of_all_seeds(&kernels[i], seeds);
        failed += !is_good;
        printf("%sok %d - %s gives what its twin in plain C does, bit for bit\n",
               is_good ? "" : "not ", i + 1, kernels[i].name);
    }
    printf("1..%d\n", KERNELS);
    return failed != 0;
}
