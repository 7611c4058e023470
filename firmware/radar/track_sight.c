#include "track_sight.h"

#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/const.h"
#include "lm/target_view.h"

enum {
    CELL_MM = 30000,          /* of the LOD that single places are read from */
    NEAR_M_Q8 = LM_M_Q8(2000) /* nothing hides what is nearer */
};

uint8_t lm_track_lod(const struct lm_db *db)
{
    return lm_scan_lod(db, CELL_MM);
}

bool lm_track_ground_at(struct lm_tile_cache *tiles, struct lm_position position,
                        int32_t *elevation_m_q10)
{
    *elevation_m_q10 = lm_scan_elevation(tiles, lm_track_lod(tiles->db), position, INT32_MIN);
    return *elevation_m_q10 != INT32_MIN;
}

int32_t lm_track_ground_db_q8(struct lm_tile_cache *tiles, struct lm_position position)
{
    const uint16_t cell = lm_scan_cell(tiles, lm_track_lod(tiles->db), position);
    return cell == LM_CELL_NONE ? LM_LEVEL_SHADOW
                                : (cell >> 8) * LM_GAMMA_CODE_STEP_DB_Q8 + LM_GAMMA_CODE_ZERO_DB_Q8;
}

/* Path of `cells` cells along an azimuth, between two ranges. */
static struct lm_ground_path path_of(struct lm_position from, fx_bam_t azimuth, uint32_t begin_m_q8,
                                     uint32_t end_m_q8, uint32_t cells)
{
    struct lm_geo_origin origin;
    struct lm_geo_ray ray;
    struct lm_ground_path path;
    lm_geo_set_origin(&origin, from);
    lm_geo_set_ray(&ray, &origin, azimuth);
    const struct lm_position points[3] = {
        lm_geo_along(&ray, begin_m_q8),
        lm_geo_along(&ray, begin_m_q8 + (end_m_q8 - begin_m_q8) / 2),
        lm_geo_along(&ray, end_m_q8),
    };
    lm_ground_path_fit(&path, points, cells);
    return path;
}

/* The way ends a cell of the foreground before the target, so that it does not hide itself. */
bool lm_track_sees(struct lm_track *t, const struct lm_track_scene *s,
                   const struct lm_track_seen *seen)
{
    struct lm_foreground *f = &t->foreground;
    const uint32_t end_m_q8 = seen->ground_m_q8 - seen->ground_m_q8 / LM_FOREGROUND_CELLS;
    if (seen->ground_m_q8 < NEAR_M_Q8) {
        return true;
    }
    f->grid.height_m_q10 = s->platform.height_m_q10;
    f->grid.reference_m_q10 = 0;
    lm_foreground_set(f, s->tiles->db, &s->radar->illumination, end_m_q8, &f->grid);
    lm_class_lut_set(&t->class_lut, &s->radar->illumination, &s->tiles->db->classes);
    const struct lm_ground_path path =
        path_of(s->platform.position, seen->bearing, f->start_m_q8, end_m_q8, LM_FOREGROUND_CELLS);
    const lm_horizon_q40_t horizon =
        lm_foreground_horizon(f, &t->class_lut, s->tiles, &path, s->line);
    const struct lm_target_heights h = {s->platform.height_m_q10, 0};
    return lm_target_view_tangent_q38(seen->elevation_m_q10, seen->ground_m_q8, &h) * 4 > horizon;
}

/* A stretch of the line of the nose over the map. */
struct stretch {
    uint32_t begin_m_q8, cell_m_q8, cells;
};

/* Height of the terrain over the line of sight at a cell: z - h - r^2 / 2a - r tan. Ranges are
 * below 2^26.2 and tangents below 2^18 in Q16. */
static int64_t above_m_q10(const struct lm_track_scene *s, const struct stretch *way, uint32_t cell,
                           int32_t tangent_q16)
{
    const int64_t range_m_q8 =
        way->begin_m_q8 + (int64_t)cell * way->cell_m_q8 + way->cell_m_q8 / 2;
    const int64_t drop_m_q10 = ((range_m_q8 * range_m_q8 >> 20) * LM_CURVATURE_Q48) >> 34;
    return (s->line->elevation_m_q14[cell] >> 4) - s->platform.height_m_q10 - drop_m_q10 -
           (range_m_q8 * tangent_q16 >> 14);
}

/* Ground range where the line first goes below the terrain, or below sea level where the map has
 * none; 0 if it does not. Between two cells the terrain is straight. */
static uint32_t first_ground_m_q8(const struct lm_track_scene *s, const struct stretch *way,
                                  int32_t tangent_q16)
{
    const struct lm_db *db = s->tiles->db;
    const struct lm_ground_path path =
        path_of(s->platform.position, s->platform.heading, way->begin_m_q8,
                way->begin_m_q8 + way->cells * way->cell_m_q8, way->cells);
    lm_scan_line_run(s->line, s->tiles, lm_scan_lod(db, lm_mm_of_m_q8(way->cell_m_q8)), NULL, &path,
                     way->cells);
    int64_t before_m_q10 = -1;
    for (uint32_t i = 0; i < way->cells; i++) {
        const int64_t here_m_q10 = above_m_q10(s, way, i, tangent_q16);
        if (here_m_q10 >= 0) {
            const int64_t back_m_q8 =
                i == 0 ? 0 : (int64_t)way->cell_m_q8 * here_m_q10 / (here_m_q10 - before_m_q10);
            return (uint32_t)(way->begin_m_q8 + (int64_t)i * way->cell_m_q8 + way->cell_m_q8 / 2 -
                              back_m_q8);
        }
        before_m_q10 = here_m_q10;
    }
    return 0;
}

bool lm_track_ahead(const struct lm_track_scene *s, struct lm_position *position,
                    int32_t *elevation_m_q10)
{
    enum { CELLS = 128 };
    const int32_t steepest = (int32_t)FX_BAM_DEG(75);
    const int32_t tangent_q16 = fx_tan_q16((fx_bam_t)fx_clamp_i32(s->pitch, -steepest, steepest));
    const uint32_t far_m_q8 = lm_m_q8_of_m(s->radar->range[s->range_index].range_m);
    struct stretch way = {0, far_m_q8 / CELLS, CELLS};
    uint32_t range_m_q8 = first_ground_m_q8(s, &way, tangent_q16);
    if (range_m_q8 == 0) {
        return false;
    }
    way.begin_m_q8 = range_m_q8 - fx_min_u32(range_m_q8, 2 * way.cell_m_q8);
    way.cell_m_q8 = way.cell_m_q8 * 4 / CELLS;
    const uint32_t finer_m_q8 = first_ground_m_q8(s, &way, tangent_q16);
    range_m_q8 = finer_m_q8 != 0 ? finer_m_q8 : range_m_q8;
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, s->platform.position);
    *position = lm_geo_direct(&origin, s->platform.heading, range_m_q8);
    return lm_track_ground_at(s->tiles, *position, elevation_m_q10);
}
