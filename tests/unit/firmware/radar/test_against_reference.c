/* The fixed-point picture against the double-precision reference, stage by stage and whole. Each
 * stage is judged on what the firmware's stage before it handed on, so that no error hides behind
 * another; then the pictures as they are. */
#include "hs/angle.h"
#include "lm/sar.h"

#include "check.h"
#include "reference_support.h"
#include "tiny_map.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 256, POOL_TILES = 400 };

struct world {
    struct tiny_map map;
    struct ref_db ref;
    struct lm_tone tone;
    struct lm_line line;
    int16_t level_q8[LM_CELLS_ROOM]; /* of its cells, with noise and speckle */
    struct lm_radar radar;
    struct ref_params params;
    double table_db[REF_GRAIN_VALUES];
    struct ref_view view;         /* of the patch */
    struct ref_overscan overscan; /* likewise */
    struct ref_patch_line cells;
    struct lm_environment environment;
    bool is_rainy, is_plan;
};

/* How far apart two pictures are. */
struct score {
    uint32_t pixels, beyond_half_db, beyond_1_grey;
    uint32_t ends, ends_beyond_half_db, ends_beyond_1_grey; /* of them, within an overscan */
    double worst_db, squares;
    struct ref_leak leak; /* of the lines so far */
};

static void set_params(struct world *w)
{
    const struct lm_sar_table *sar = &w->radar.sar;
    w->params = params_of(&w->radar, decibels(sar->noise_floor_db_q8), &sar->tone, &sar->speckle);
    ref_grain_table(w->params.looks, w->table_db);
    assert_int_equal(lm_tone_set(&w->tone, &sar->tone), LM_OK);
}

typedef double elevation_of(void *ctx, const struct tiny_place *p);

static struct world *make_world_of(struct tiny_spec spec, double scale)
{
    struct world *w = calloc(1, sizeof *w);
    w->radar = lm_radar_default;
    spec.cell = scene_cell;
    spec.ctx = &scale;
    spec.rows = spec.columns = 9;
    tiny_map_open(&w->map, &spec, POOL_TILES);
    assert_int_equal(ref_db_open_memory(&w->ref, w->map.image.bytes, w->map.image.size, "scene"),
                     0);
    return w;
}

static struct world *make_world_over(elevation_of *elevation_m, uint8_t shift0, double scale,
                                     double latitude, double longitude)
{
    struct tiny_spec spec = tiny_spec_at(latitude, longitude);
    spec.elevation_m = elevation_m;
    spec.shift0 = shift0;
    return make_world_of(spec, scale);
}

static struct world *make_world(uint8_t shift0, double scale, double latitude, double longitude)
{
    return make_world_over(scene_elevation_m, shift0, scale, latitude, longitude);
}

static void free_world(struct world *w)
{
    ref_db_close(&w->ref);
    tiny_map_close(&w->map);
    free(w);
}

/* What the shown cells of a patch's line draw. */
static void take_draws(const struct lm_sar *sar, uint32_t line, struct ref_bin *shown)
{
    for (uint32_t i = 0; i < CELLS; i++) {
        shown[i].grain = ref_grain(sar->grain.row + line, sar->grain.column + i);
    }
}

/* Compare what came out of a line with bins whose aspect is done and whose draws are known. The
 * cells within an overscan of an end are ends, into which layover brings what lies outside. */
static void compare_line(const struct world *w, struct ref_bin *bins, uint32_t line,
                         struct score *score)
{
    const struct ref_patch_line *cells = &w->cells;
    ref_class_gain(bins, cells->count, &w->params, 0);
    ref_sea(bins, cells->count, &w->view, &w->params, 0);
    ref_patch_echo(bins, cells, w->table_db, &w->params, &score->leak, line);
    ref_tone(bins, cells->count, &w->params);
    for (uint32_t i = 0; i < CELLS; i++) {
        const struct ref_bin *bin = &bins[cells->first + i];
        const double error_db = fabs(decibels(w->level_q8[i]) - bin->echo_db);
        const bool is_off = abs(w->line.grey[i] - bin->grey) > 1;
        const bool is_end = i < w->overscan.before || i + w->overscan.behind >= CELLS;
        score->pixels++;
        score->squares += error_db * error_db;
        score->worst_db = fmax(score->worst_db, error_db);
        score->beyond_half_db += error_db > 0.5;
        score->beyond_1_grey += is_off;
        score->ends += is_end;
        score->ends_beyond_half_db += is_end && error_db > 0.5;
        score->ends_beyond_1_grey += is_end && is_off;
    }
}

static void report(const char *what, const struct score *s)
{
    print_message(
        "# %s: %u pixels, rms %.3f dB, worst %.2f dB; beyond 0.5 dB %.4f %%, beyond one "
        "grey level %.4f %%\n",
        what, s->pixels, sqrt(s->squares / s->pixels), s->worst_db,
        100.0 * s->beyond_half_db / s->pixels, 100.0 * s->beyond_1_grey / s->pixels);
    print_message(
        "#   at the ends: %u pixels, beyond 0.5 dB %.4f %%, beyond one grey level %.4f %%\n",
        s->ends, 100.0 * s->ends_beyond_half_db / fmax(s->ends, 1),
        100.0 * s->ends_beyond_1_grey / fmax(s->ends, 1));
}

/* At most one pixel in ten thousand beyond half a decibel: cells of which a sliver shows over the
 * horizon. At most one in a thousand more than one grey level off. */
static void judge_stages(const struct score *s)
{
    assert_true(s->pixels > 200000);
    assert_true(s->beyond_half_db * 10000 <= s->pixels);
    assert_true(s->beyond_1_grey * 1000 <= s->pixels);
}

/* ---- SAR ---- */

static struct lm_sar start_patch(struct world *w, int look_deg, uint32_t cell_mm, uint32_t range_m,
                                 int32_t height_m, double reference_m)
{
    struct lm_sar sar;
    const struct lm_sar_command command = {
        .centre = {w->map.db.centre_latitude, w->map.db.centre_longitude},
        .cell_mm = cell_mm,
        .look_azimuth = FX_BAM_DEG(look_deg),
        .range_m = range_m,
        .height_m_q6 = height_m * 64,
        .is_plan = w->is_plan};
    /* The first reading asks for the tiles. */
    (void)lm_sar_relief_of(&w->map.tiles, &w->radar, &command);
    tiny_map_read_tiles(&w->map);
    struct lm_sar_relief relief = lm_sar_relief_of(&w->map.tiles, &w->radar, &command);
    relief.reference_m_q10 = (int32_t)lround(reference_m * 1024);
    const struct lm_sar_setup scene = {.relief = relief,
                                       .sea_state = LM_SEA_STATE_OF_IMAGE,
                                       .environment = w->is_rainy ? &w->environment : NULL};
    assert_int_equal(lm_sar_start(&sar, &w->radar, &w->map.db, &command, &scene), LM_OK);
    for (uint32_t line = 0; line < sar.lines; line += 4) {
        lm_sar_prefetch(&sar, &w->map.tiles, line);
        tiny_map_read_tiles(&w->map);
    }
    return sar;
}

/* Rain of 30 mm/h over the right half of the world's patches, and some before them. */
static void make_rain(struct world *w, struct ref_sar *wanted)
{
    const struct lm_antenna_table *antenna = &w->radar.antenna;
    const struct lm_position centre = {w->map.db.centre_latitude, w->map.db.centre_longitude};
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, centre);
    const fx_bam_t look = hs_bam(wanted->azimuth_deg);
    w->environment = (struct lm_environment){
        .rain = {{lm_geo_direct(&origin, look + FX_BAM_90, 2200 * 256), 2000, 30},
                 {lm_geo_direct(&origin, look + FX_BAM_180, 6000 * 256), 1500, 12}},
        .rain_count = 2,
        .sea_state = LM_SEA_STATE_OF_IMAGE};
    wanted->rain =
        (struct ref_patch_rain){.environment = {.rain = {{.radius_m = 2000, .mm_per_h = 30},
                                                         {.radius_m = 1500, .mm_per_h = 12}},
                                                .rain_count = 2},
                                .wavelength_m = w->radar.wavelength_um * 1e-6,
                                .azimuth_beam_deg = hs_degrees(antenna->azimuth_beam),
                                .elevation_beam_deg = hs_degrees(antenna->elevation_beam)};
    for (int n = 0; n < 2; n++) {
        const struct lm_position at = w->environment.rain[n].centre;
        wanted->rain_centre[n] =
            (struct ref_place){hs_degrees(at.latitude), hs_degrees(at.longitude)};
    }
}

/* How far apart aspect to tone are on the same ground; whole pictures; and pictures of which one
 * traces the foreground for every line, as the reference does. */
struct patch_scores {
    struct score stage, whole, foregrounds;
    uint32_t lines, horizons_apart; /* lines whose start the two see differently */
};

/* One foreground in forty, in which an edge lies so. */
static void judge_horizons(const struct patch_scores *s)
{
    print_message("#   %u of %u lines start at another horizon\n", s->horizons_apart, s->lines);
    assert_true(s->horizons_apart * 40 <= s->lines);
}

/* The horizon that a line starts with by EQUATIONS.md: the foreground is traced for one line in
 * LM_SAR_FOREGROUND_LINES, and between them the horizon changes evenly. */
static double start_horizon(const struct world *w, const struct ref_sar *sar, uint32_t line)
{
    const uint32_t past = line % LM_SAR_FOREGROUND_LINES, left = line - past;
    const unsigned before = w->overscan.before;
    const double at_left = ref_sar_horizon(&w->ref, sar, &w->params, before, left);
    const double at_right =
        ref_sar_horizon(&w->ref, sar, &w->params, before, left + LM_SAR_FOREGROUND_LINES);
    return at_left + (at_right - at_left) * past / LM_SAR_FOREGROUND_LINES;
}

/* Compare a sampled line with one of the reference, of which copy has room for the bins. */
static void score_patch_line(struct world *w, const struct ref_sar *wanted,
                             const struct ref_picture *picture, uint32_t line,
                             const struct lm_sar *sar, struct ref_bin *copy,
                             struct patch_scores *scores)
{
    const double horizon = ldexp((double)sar->horizon, -40);
    const uint32_t cells = (uint32_t)w->cells.count;
    struct ref_bin *bins = ref_picture_bin(picture, line, 0) - w->cells.first;
    const double wanted_horizon = start_horizon(w, wanted, line);
    /* 9 cm at 9 km; and the firmware's 128 coarse cells are whole 1/256 m long, so that the last of
     * them lies up to half a metre nearer, where the ray falls by H / s of it. The edge of a house
     * may lie between the two places: that changes the lines up to the next foreground. */
    const double near_m = bins[0].range_m;
    scores->lines++;
    scores->horizons_apart +=
        fabs(horizon - wanted_horizon) >= 1e-5 + 0.5 * wanted->antenna_m / (near_m * near_m);
    take_draws(sar, line, bins + w->cells.first);
    memcpy(copy, bins, cells * sizeof *copy);
    ref_illuminate(copy, cells, &picture->view, &w->params,
                   ref_behind_foreground(copy, cells, &picture->view, wanted_horizon));
    compare_line(w, copy, line, &scores->whole);
    take_ground(&w->line.ground, &w->map.db.classes, copy, cells);
    ref_illuminate(copy, cells, &picture->view, &w->params,
                   ref_behind_foreground(copy, cells, &picture->view, horizon));
    compare_line(w, copy, line, &scores->stage);
    compare_line(w, bins, line, &scores->foregrounds);
}

static void score_patch(struct world *w, int look_deg, double cell_m, double range_m,
                        double height_m, struct patch_scores *scores)
{
    struct ref_sar wanted = {.centre = w->ref.centre,
                             .azimuth_deg = look_deg,
                             .range_m = range_m,
                             .antenna_m = height_m,
                             .cell_m = cell_m,
                             .cell_count = CELLS,
                             .is_plan = w->is_plan};
    if (w->is_rainy) {
        make_rain(w, &wanted);
    }
    struct ref_picture picture;
    scores->stage.leak = scores->whole.leak = scores->foregrounds.leak = (struct ref_leak){0};
    set_params(w);
    assert_int_equal(ref_sar_patch(&picture, &w->ref, &wanted, &w->params), 0);
    w->view = picture.view;
    w->params.lean = ref_sar_lean(&wanted, picture.view.reference_m);
    struct lm_sar sar = start_patch(w, look_deg, (uint32_t)lround(cell_m * 1000), (uint32_t)range_m,
                                    (int32_t)height_m, picture.view.reference_m);
    assert_int_equal(sar.lines, picture.line_count);
    assert_int_equal(sar.overscan, picture.overscan.before);
    assert_int_equal(sar.traced - sar.overscan - CELLS, picture.overscan.behind);
    w->overscan = picture.overscan;
    w->cells = (struct ref_patch_line){sar.traced, sar.overscan, CELLS};
    struct ref_bin *copy = calloc(w->cells.count, sizeof *copy);
    for (uint32_t k = 0; k < sar.lines; k++) {
        lm_sar_sample_line(&sar, &w->map.tiles, k, &w->line, w->level_q8);
        lm_tone_run(&w->tone, w->level_q8, w->line.grey, CELLS);
        score_patch_line(w, &wanted, &picture, k, &sar, copy, scores);
    }
    free(copy);
    ref_picture_free(&picture);
}

TEST(patches_agree_with_the_reference)
{
    struct patch_scores scores = {0};
    const struct score *whole = &scores.whole, *foregrounds = &scores.foregrounds;
    struct world *w = make_world(9, 1, 46, 11);
    score_patch(w, 0, 5, 20000, 3000, &scores);
    score_patch(w, 37, 5, 20000, 3000, &scores);
    score_patch(w, 200, 7, 40000, 6000, &scores);
    score_patch(w, 291, 3, 9000, 1500, &scores);
    free_world(w);
    w = make_world(9, 1, 61.87, 179.999); /* zone border and antimeridian in the patch */
    score_patch(w, 120, 6, 30000, 5000, &scores);
    free_world(w);
    report("patches, aspect to tone on the same ground", &scores.stage);
    report("patches, whole", whole);
    report("patches, whole, with a foreground for every line", foregrounds);
    judge_horizons(&scores);
    judge_stages(&scores.stage);
    /* The firmware's sample points lie up to 3 cm beside the reference's (test_geo.c): one in two
     * hundred so falls into the neighbouring cell of the map, and where that is of another class
     * the pixel differs. Layover shares a cell between two pixels. */
    assert_true(whole->beyond_half_db * 200 <= whole->pixels);
    assert_true(whole->beyond_1_grey * 150 <= whole->pixels);
    /* Six in a thousand more where a shadow that begins before the patch ends elsewhere: the
     * houses of this country stand in the coarse cells of the foreground, and are narrower than
     * LM_SAR_FOREGROUND_LINES. */
    assert_true(foregrounds->beyond_half_db * 80 <= foregrounds->pixels);
    assert_true(foregrounds->beyond_1_grey * 80 <= foregrounds->pixels);
}

/* Ridges some 200 m apart that lie across most lines: their tops fall between cells. */
static double ridges_elevation_m(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return 600 + 14 * sin(p->north_m / 35 + p->east_m / 80) + 80 * sin(p->east_m / 900);
}

/* Of whole pictures at most one pixel in 200 is beyond half a decibel, and one in 150 more than one
 * grey level off. */
static void judge_patches(const char *what, const struct patch_scores *scores)
{
    char title[80];
    snprintf(title, sizeof title, "%s, aspect to tone on the same ground", what);
    report(title, &scores->stage);
    snprintf(title, sizeof title, "%s, whole", what);
    report(title, &scores->whole);
    judge_stages(&scores->stage);
    assert_true(scores->whole.beyond_half_db * 200 <= scores->whole.pixels);
    assert_true(scores->whole.beyond_1_grey * 150 <= scores->whole.pixels);
}

/* Cells of 30 and 40 m over a map of 38 m: the crests between them count. */
TEST(patches_of_long_cells_agree_with_the_reference)
{
    struct patch_scores scores = {0};
    struct world *w = make_world_over(ridges_elevation_m, 12, 8, 46, 11);
    score_patch(w, 0, 40, 24000, 3000, &scores);
    score_patch(w, 160, 30, 20000, 2000, &scores);
    score_patch(w, 250, 40, 20000, 1500, &scores);
    free_world(w);
    judge_patches("patches of long cells", &scores);
}

static bool leave_out_every_other(void *ctx, uint8_t level, uint32_t row, uint32_t column)
{
    (void)ctx;
    return level == 0 && (row + column) % 2 == 1;
}

/* Where the finest level has no tile, the next one's cells are blended: those of 9.5 m in the first
 * two patches, of 19 and 38 m in the third. */
TEST(patches_over_a_map_whose_finest_level_has_gaps_agree_with_the_reference)
{
    struct patch_scores scores = {0};
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.elevation_m = scene_elevation_m;
    spec.leave_out = leave_out_every_other;
    struct world *w = make_world_of(spec, 1);
    score_patch(w, 0, 5, 20000, 3000, &scores);
    score_patch(w, 291, 3, 9000, 1500, &scores);
    free_world(w);
    spec.shift0 = 11;
    w = make_world_of(spec, 4);
    score_patch(w, 37, 15, 20000, 3000, &scores);
    free_world(w);
    judge_patches("patches over gaps", &scores);
}

/* The same through rain, whose edge runs through each picture. */
TEST(patches_in_rain_agree_with_the_reference)
{
    struct patch_scores scores = {0};
    struct world *w = make_world(9, 1, 46, 11);
    w->is_rainy = true;
    score_patch(w, 0, 5, 20000, 3000, &scores);
    score_patch(w, 200, 7, 40000, 6000, &scores);
    score_patch(w, 291, 3, 12000, 1500, &scores);
    score_patch(w, 100, 10, 60000, 9000, &scores);
    free_world(w);
    report("patches in rain, aspect to tone on the same ground", &scores.stage);
    report("patches in rain, whole", &scores.whole);
    judge_horizons(&scores);
    judge_stages(&scores.stage);
    assert_true(scores.whole.beyond_half_db * 200 <= scores.whole.pixels);
    assert_true(scores.whole.beyond_1_grey * 200 <= scores.whole.pixels);
}

/* The hills on a slope of 4 in 10 that rises to the north-east. */
static double slope_elevation_m(void *ctx, const struct tiny_place *p)
{
    return 900 + scene_elevation_m(ctx, p) + 0.32 * p->north_m + 0.25 * p->east_m;
}

/* Layover fills both ends with what lies outside, to the limit of overscan in the last patch, whose
 * edge then has a strip of noise; in the third the far end lies low, and the near one high. */
TEST(ends_of_patches_on_a_slope_agree_with_the_reference)
{
    struct patch_scores scores = {0};
    const struct score *stage = &scores.stage, *whole = &scores.whole;
    struct world *w = make_world_over(slope_elevation_m, 9, 1, 46, 11);
    score_patch(w, 30, 5, 20000, 4000, &scores);
    score_patch(w, 0, 3, 9000, 3000, &scores);
    score_patch(w, 215, 5, 20000, 9000, &scores);
    score_patch(w, 38, 3, 12000, 9000, &scores);
    assert_int_equal(w->overscan.before, REF_OVERSCAN_MAX);
    assert_int_equal(w->overscan.behind, REF_OVERSCAN_MAX);
    free_world(w);
    report("patches on a slope, aspect to tone on the same ground", stage);
    report("patches on a slope, whole", whole);
    judge_horizons(&scores);
    /* Two in ten thousand are slivers of cells that look along the slope: more than elsewhere. */
    assert_true(stage->pixels > 200000 && stage->ends > 20000);
    assert_true(stage->beyond_half_db * 4000 <= stage->pixels);
    assert_true(stage->beyond_1_grey * 1000 <= stage->pixels);
    assert_true(stage->ends_beyond_half_db * 1000 <= stage->ends);
    assert_true(stage->ends_beyond_1_grey * 400 <= stage->ends);
    /* Three centimetres beside the reference's place are a centimetre of height here, and a
     * sixteenth of a cell more or less of layover for one pixel in sixteen, at the ends. */
    assert_true(whole->beyond_half_db * 50 <= whole->pixels);
    assert_true(whole->beyond_1_grey * 25 <= whole->pixels);
    assert_true(whole->ends_beyond_half_db * 40 <= whole->ends);
    assert_true(whole->ends_beyond_1_grey * 12 <= whole->ends);
}
