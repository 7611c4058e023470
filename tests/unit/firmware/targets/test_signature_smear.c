/* Movers that are shown by their chip in a patch, against what the aperture makes of its corners.
 */
#include "check.h"
#include "extent.h"
#include "reference/reference.h"
#include "signature_image.h"

#include "lm/target_patch.h"

#include <stdlib.h>

/* A patch of 128 cells of a metre around 46 N 11 E, seen from the west for two seconds. */
enum { LINES = 128, CELLS = LINES, NOTHING_Q8 = -120 * 256 };
static const double range_m = 20000, height_m = 6000, flies_m_s = 200, dwell_s = 2;
static const double middle = (LINES - 1) / 2.0, degree = 3.14159265358979323846 / 180;

struct fixture {
    struct signature_world world; /* first: see tear_down_signature_world */
    struct lm_target_patch points;
    double found[LINES][CELLS], wanted[LINES][CELLS];
};

static int set_up(void **state)
{
    return set_up_signature_world(state, sizeof(struct fixture));
}

/* Metres a second to the right, as the radar looks, and nearer. */
struct motion {
    double right_m_s, closing_m_s;
};

/* East is away from the radar, south to the right. */
static double heading_of(const struct motion *m)
{
    return atan2(-m->closing_m_s, -m->right_m_s) / degree;
}

/* From where Doppler puts it into the middle. */
static struct lm_target mover(const struct motion *m)
{
    struct lm_geo_origin o;
    lm_geo_set_origin(&o, (struct lm_position){hs_bam(46), hs_bam(11)});
    const double shift_m = range_m * m->closing_m_s / flies_m_s;
    const struct lm_position p =
        lm_geo_direct(&o, hs_bam(shift_m > 0 ? 0 : 180), (uint32_t)lround(fabs(shift_m) * 256));
    struct lm_target t = target_with_signature(0, 0, heading_of(m));
    t.latitude = p.latitude;
    t.longitude = p.longitude;
    t.speed_mm_s = (uint32_t)lround(hypot(m->right_m_s, m->closing_m_s) * 1000);
    t.leg_m = 100;
    seal_target(&t);
    return t;
}

static const struct lm_target_heights heights = {6000 * 1024, 0};

static void choose_chip(struct fixture *f, const struct lm_target *t,
                        struct lm_target_candidates *candidates)
{
    const struct lm_target_set set = set_with_signature(&f->world, t, 1);
    const struct lm_target_query scene = {.position = {hs_bam(46), hs_bam(11)}, .reach_m = 20000};
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, scene.position);
    const struct lm_chip_query chips = {
        .centre = scene.position,
        .reach_m = scene.reach_m,
        .radar = lm_geo_direct(&origin, FX_BAM_DEG(270), (uint32_t)range_m * 256),
        .heights = heights,
        .cell_mm = 1000,
        .side_most = LM_CHIP_SIDE};
    lm_target_candidates_select(candidates, &set, &scene);
    lm_chips_choose(&f->world.chips, candidates, &chips);
    assert_true(serve_chips(&f->world));
    assert_non_null(lm_chip_of(&candidates->candidate[0]));
}

static void draw(struct fixture *f, const struct lm_target *t)
{
    const struct lm_patch_geometry g = {.centre = {hs_bam(46), hs_bam(11)},
                                        .look = FX_BAM_90,
                                        .centre_m_q8 = (uint32_t)range_m * 256,
                                        .cell_m_q8 = 256,
                                        .lines = LINES,
                                        .cells = CELLS,
                                        .traced = CELLS,
                                        .heights = heights,
                                        .wavelength_um = X_BAND_UM,
                                        .across_mm_s = (int32_t)flies_m_s * 1000,
                                        .dwell_ms = (uint32_t)(dwell_s * 1000)};
    static const int32_t elevation_m_q14[LM_CELLS_ROOM];
    struct lm_target_candidates candidates;
    choose_chip(f, t, &candidates);
    lm_target_patch_set(&f->points, &candidates, &g);
    for (uint32_t k = 0; k < LINES; k++) {
        int16_t level_q8[LM_CELLS_ROOM];
        for (uint32_t i = 0; i < CELLS; i++) {
            level_q8[i] = NOTHING_Q8;
        }
        assert_int_equal(lm_target_patch_add_chips(&f->points, k, &g, elevation_m_q14, level_q8),
                         0);
        for (uint32_t i = 0; i < CELLS; i++) {
            f->found[k][i] = level_q8[i] > NOTHING_Q8 ? pow(10, level_q8[i] / 2560.0) : 0;
        }
    }
}

/* The corners as points that move, in levels of clutter. */
static void focus(struct fixture *f, const struct motion *m)
{
    const struct ref_view view = {height_m, 0, 1};
    const double area_m2 = ref_grazing(&view, range_m, range_m - 1);
    memset(f->wanted, 0, sizeof f->wanted);
    for (int i = 0; i < CORNERS; i++) {
        double right_m, beyond_m;
        corner_place(&corners[i], (270 - heading_of(m)) * degree, &right_m, &beyond_m);
        const double drift_m_s = 2 * m->right_m_s - m->right_m_s * m->right_m_s / flies_m_s;
        const struct ref_mover point = {middle + right_m, middle + beyond_m, drift_m_s * dwell_s,
                                        -m->closing_m_s * dwell_s,
                                        pow(10, corners[i].dbsm / 10) / area_m2};
        assert_int_equal(ref_add_mover(&point, LINES, CELLS, f->wanted[0]), 0);
    }
}

TEST_WITH(a_movers_chip_is_smeared_to_what_the_aperture_makes_of_its_corners, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    static const struct motion cases[] = {{0.05, 0}, {1.5, 0}, {6, 0},  {-9, 0},
                                          {0, 6},    {4, -4},  {-5, 8}, {6, 12}};
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        const struct lm_target t = mover(&cases[n]);
        draw(f, &t);
        focus(f, &cases[n]);
        const struct extent is = extent_of(f->found[0], LINES, CELLS);
        const struct extent should = extent_of(f->wanted[0], LINES, CELLS);
        const double lost_db = 10 * log10(is.sum / should.sum);
        print_message(
            "# %.2f m/s right, %.0f nearer: %.1f x %.1f, %.2f; wanted %.1f x %.1f, %.2f; "
            "power %.2f dB\n",
            cases[n].right_m_s, cases[n].closing_m_s, is.across, is.along, is.correlation,
            should.across, should.along, should.correlation, lost_db);
        assert_true(fabs(is.across - should.across) < 0.5 + 0.15 * should.across);
        assert_true(fabs(is.along - should.along) < 0.5 + 0.15 * should.along);
        assert_true(fabs(is.correlation - should.correlation) < 0.25);
        assert_true(fabs(lost_db) < 0.3);
    }
}
