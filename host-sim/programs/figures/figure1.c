/* Nine corner reflectors at known places, put into the cells of a patch by the firmware: once by
 * cells that hold one of them each, once by one that holds all. */
#include "figures.h"

#include "hs/angle.h"
#include "hs/chart.h"
#include "lm/illumination.h"
#include "lm/target_line.h"
#include "lm/target_patch.h"

#include <math.h>
#include <stdio.h>

static const double pi = 3.14159265358979323846;

enum { VIEWS = 7, MAP_PX = 190, MAP_STEP_PX = 200, MAP_LEFT = 40, FINE_CELLS = 24, CELLS_MAX = 24 };
static const double first_deg = -15, step_deg = 5, map_m = 46, fine_m = 2, coarse_m = 36;
static const double range_m = 20000, height_m = 7280; /* 20 degrees above the horizon */
static const double latitude_deg = 46;

/* Corners of one metre about the origin, a few metres apart and off a grid, all opening to the
 * south. */
static struct lm_target nine_corners(void)
{
    struct lm_target t = {
        .id = 1, .latitude = hs_bam(latitude_deg), .heading = FX_BAM_180, .scatterer_count = 9};
    for (int i = 0; i < 9; i++) {
        const int row = i / 3, column = i % 3;
        t.scatterers[i] = (struct lm_scatterer){
            .kind = LM_SHAPE_TRIHEDRAL,
            .size_mm = {1000, 0},
            .offset_mm = {7000 * (row - 1) + 400 * column, 6000 * (column - 1) - 300 * row, 0},
            .elevation = hs_bam(35.264)};
    }
    return t;
}

/* A patch of cells x cells around the target, looked at along `look_deg` from north. */
struct patch {
    int cells;
    double cell_m;
    double dbsm[CELLS_MAX][CELLS_MAX]; /* line from left to right, cell away from the radar */
};

/* The level says how bright flat ground would have to be; the cross section is that times the cell
 * as such ground shows it. */
static double cell_area_db(double cell_m, double cell_range_m)
{
    const double drop = cell_range_m / (2 * 4.0 / 3.0 * 6371000.0);
    return 10 * log10(cell_m * cell_m * (height_m / cell_range_m - drop));
}

static struct lm_target_candidates near_of(const struct lm_target_set *set,
                                           struct lm_position place)
{
    struct lm_target_candidates near;
    const struct lm_target_query scene = {.position = place, .reach_m = (uint32_t)range_m + 1000};
    lm_target_candidates_select(&near, set, &scene);
    return near;
}

/* By synthetic aperture: every corner is a point of its own. */
static void look_finely(struct patch *p, const struct lm_target *t, double look_deg)
{
    const struct lm_patch_geometry g = {.centre = {t->latitude, t->longitude},
                                        .look = hs_bam(look_deg),
                                        .centre_m_q8 = (uint32_t)(range_m * 256),
                                        .cell_m_q8 = (uint32_t)(p->cell_m * 256),
                                        .lines = (uint32_t)p->cells,
                                        .cells = (uint32_t)p->cells,
                                        .heights = {(int32_t)(height_m * 1024), 0},
                                        .wavelength_um =
                                            (uint32_t)lround(FIGURE_WAVELENGTH_M * 1e6)};
    const struct lm_target_set set = {.items = t, .count = 1};
    const struct lm_target_candidates near = near_of(&set, g.centre);
    struct lm_target_patch points;
    lm_target_patch_set(&points, &near, &g);
    for (int k = 0; k < p->cells; k++) {
        int16_t level_q8[CELLS_MAX];
        for (int i = 0; i < p->cells; i++) {
            level_q8[i] = LM_LEVEL_SHADOW;
        }
        lm_target_patch_add_scatterers(&points, (uint32_t)k, LM_LEVEL_SHADOW, &g, level_q8);
        for (int i = 0; i < p->cells; i++) {
            const double at_m = range_m + (i + 0.5 - p->cells / 2.0) * p->cell_m;
            p->dbsm[k][i] = level_q8[i] / 256.0 + cell_area_db(p->cell_m, at_m);
        }
    }
}

/* By a beam of many cells' width, in whose middle all corners stand, from a place due south of the
 * target, which is turned instead of the radar. */
static void look_coarsely(struct patch *p, const struct lm_target *t, double look_deg)
{
    struct lm_target turned = *t;
    struct lm_geo_origin origin;
    struct lm_position place;
    int16_t level_q8 = LM_LEVEL_SHADOW;
    const double beam_m = 64 * p->cell_m;
    lm_geo_set_origin(&origin, (struct lm_position){t->latitude, t->longitude});
    place = lm_geo_direct(&origin, FX_BAM_180, (uint32_t)(range_m * 256));
    turned.heading -= hs_bam(look_deg);
    const struct lm_target_line line = {.position = place,
                                        .width = hs_bam(beam_m / range_m * 180 / pi),
                                        .first_m_q8 = (uint32_t)(range_m * 256),
                                        .cell_m_q8 = (uint32_t)(p->cell_m * 256),
                                        .cells = 1,
                                        .height_m_q10 = (int32_t)(height_m * 1024),
                                        .wavelength_um =
                                            (uint32_t)lround(FIGURE_WAVELENGTH_M * 1e6)};
    const struct lm_target_set set = {.items = &turned, .count = 1};
    const struct lm_target_candidates near = near_of(&set, place);
    lm_target_line_add(&near, &line, NULL, &level_q8);
    p->dbsm[0][0] =
        level_q8 / 256.0 + cell_area_db(p->cell_m, range_m) + 10 * log10(beam_m / p->cell_m);
}

static double strongest(const struct patch *p)
{
    double highest = -1000;
    for (int i = 0; i < p->cells * p->cells; i++) {
        highest = fmax(highest, p->dbsm[i / p->cells][i % p->cells]);
    }
    return highest;
}

/* The patch on a map with north on top: 30 dB of grey below `white_db`. */
static void draw_map(struct sheet *s, int left, int top, const struct patch *p, double look_deg,
                     double white_db)
{
    const double sine = sin(look_deg * pi / 180), cosine = cos(look_deg * pi / 180);
    for (int i = 0; i < MAP_PX * MAP_PX; i++) {
        const double east_m = ((i % MAP_PX + 0.5) / MAP_PX - 0.5) * map_m;
        const double north_m = (0.5 - (i / MAP_PX + 0.5) / MAP_PX) * map_m;
        const double line = (east_m * cosine - north_m * sine) / p->cell_m + p->cells / 2.0;
        const double cell = (east_m * sine + north_m * cosine) / p->cell_m + p->cells / 2.0;
        uint32_t grey = 24; /* outside the patch */
        if (line >= 0 && line < p->cells && cell >= 0 && cell < p->cells) {
            const double db = p->dbsm[(int)line][(int)cell] - white_db;
            grey = (uint32_t)lround(255 * fmin(fmax(1 + db / 30, 0), 1));
        }
        sheet_dot(s, left + i % MAP_PX, top + i / MAP_PX, grey << 16 | grey << 8 | grey);
    }
}

static void draw_maps(struct sheet *s, const struct lm_target *t)
{
    struct patch fine = {.cells = FINE_CELLS, .cell_m = fine_m};
    struct patch coarse = {.cells = 1, .cell_m = coarse_m};
    sheet_text(s, MAP_LEFT, 12, "CELLS OF 2 M - NORTH UP - DBSM OF THE BRIGHTEST", INK_BLACK);
    sheet_text(s, MAP_LEFT, 272, "ONE CELL OF 36 M - ITS DBSM", INK_BLACK);
    for (int i = 0; i < VIEWS; i++) {
        const double look_deg = first_deg + i * step_deg;
        const int left = MAP_LEFT + i * MAP_STEP_PX;
        char text[32];
        look_finely(&fine, t, look_deg);
        look_coarsely(&coarse, t, look_deg);
        draw_map(s, left, 32, &fine, look_deg, 36);
        draw_map(s, left, 292, &coarse, look_deg, 54);
        snprintf(text, sizeof text, "%.0f DEG  %.1f", look_deg, strongest(&fine));
        sheet_text(s, left, 228, text, INK_BLACK);
        snprintf(text, sizeof text, "%.0f DEG  %.1f", look_deg, strongest(&coarse));
        sheet_text(s, left, 488, text, INK_BLACK);
    }
}

/* ---- charts ---- */

static double brightest_fine_db(void *ctx, double look_deg)
{
    struct patch fine = {.cells = FINE_CELLS, .cell_m = fine_m};
    look_finely(&fine, ctx, look_deg);
    return strongest(&fine);
}

static double coarse_db(void *ctx, double look_deg)
{
    struct patch coarse = {.cells = 1, .cell_m = coarse_m};
    look_coarsely(&coarse, ctx, look_deg);
    return strongest(&coarse);
}

static void draw_charts(struct sheet *s, struct lm_target *t)
{
    struct chart c = {.sheet = s,
                      .left = 90,
                      .top = 560,
                      .width = 620,
                      .height = 260,
                      .x_low = -15,
                      .x_high = 15,
                      .x_step = 5,
                      .y_low = 0,
                      .y_high = 60,
                      .y_step = 10,
                      .title = "DBSM - BLUE 2 M CELL - RED 36 M CELL",
                      .x_name = "DEGREES OF LOOK"};
    chart_axes(&c);
    chart_curve(&c, coarse_db, t, 3001, INK_RED);
    chart_curve(&c, brightest_fine_db, t, 301, INK_BLUE);
    c.left = 800;
    c.x_low = 2;
    c.x_high = 3;
    c.x_step = 0.2;
    c.title = "THE SAME OVER ONE DEGREE";
    chart_axes(&c);
    chart_curve(&c, coarse_db, t, 2001, INK_RED);
    chart_curve(&c, brightest_fine_db, t, 101, INK_BLUE);
}

int figure1_draw(const char *path)
{
    struct lm_target target = nine_corners();
    struct sheet sheet;
    if (sheet_open(&sheet, 1460, 880) != 0) {
        return -1;
    }
    draw_maps(&sheet, &target);
    draw_charts(&sheet, &target);
    return sheet_close(&sheet, path);
}
