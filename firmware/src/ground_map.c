#include "lm/ground_map.h"

#include "fx/sat.h"

/* Tiles are asked for this many lines ahead of the beam, a tenth of a second, and for every fourth
 * line only: between two of those lie nine cells at the most, where a tile has 64. */
enum { LINES_AHEAD = 24, LINES_APART = 4 };

void lm_ground_map_start(struct lm_ground_map *g, const struct lm_radar *radar, uint8_t range,
                         uint8_t azimuth, uint32_t epoch)
{
    g->radar = radar;
    g->range = range;
    g->azimuth = azimuth;
    g->line = 0;
    g->is_leftward = false;
    g->sweep = epoch;
    g->grid.cells = 0; /* none yet: the first line makes it */
    g->targets = NULL;
    g->near.is_chosen = false;
}

uint32_t lm_ground_map_lines(const struct lm_ground_map *g)
{
    return 2 * (g->radar->azimuth_half[g->azimuth] / g->radar->gm_line);
}

uint32_t lm_ground_map_line_us(const struct lm_ground_map *g)
{
    return (uint32_t)((uint64_t)g->radar->gm_line * 1000 / g->radar->sweep_bam_per_ms);
}

int32_t lm_ground_map_edge_bam(const struct lm_ground_map *g, uint32_t line)
{
    const int32_t from_middle = (int32_t)line - (int32_t)(lm_ground_map_lines(g) / 2);
    return from_middle * (int32_t)g->radar->gm_line;
}

/* Elevation of the flat ground that the time gain assumes: what lies below the aircraft, but not
 * above the mean of the map's land, so that a mountain below does not turn up the plains around it.
 */
static int32_t reference_q10_of(struct lm_tile_cache *tiles, uint8_t level, struct lm_place place)
{
    return fx_min_i32(lm_scan_elevation(tiles, level, place, 0), tiles->db->mean_elevation_q6 * 16);
}

/* The grid depends on the height: it is made again when that has changed by a hundredth and a
 * metre, and when a sweep begins over other ground. Until then the whole geometry stays that of the
 * old height, gain and horizon alike. */
static void refresh_grid(struct lm_ground_map *g, struct lm_tile_cache *tiles, uint8_t level,
                         const struct lm_antenna *antenna)
{
    const uint32_t begin = g->is_leftward ? lm_ground_map_lines(g) - 1 : 0;
    const bool is_new = g->grid.cells == 0 || g->line == begin;
    const int32_t reference_q10 =
        is_new ? reference_q10_of(tiles, level, antenna->place) : g->grid.reference_q10;
    const int32_t height_q10 = antenna->height_q10;
    const uint32_t limit = fx_abs_u32(height_q10) / 128 + 1024;
    if (g->grid.cells != 0 && fx_abs_u32(height_q10 - g->grid.height_q10) <= limit &&
        fx_abs_u32(reference_q10 - g->grid.reference_q10) <= limit) {
        return;
    }
    const uint32_t cell_q8 = g->radar->range_m[g->range] * 256u / g->radar->gm_cells;
    lm_range_grid_set(&g->grid, &g->radar->aspect, cell_q8 / 2, cell_q8, g->radar->gm_cells,
                      height_q10, reference_q10);
}

static struct lm_ground_path path_of(const struct lm_ground_map *g,
                                     const struct lm_geo_origin *origin, fx_bam_t heading,
                                     uint32_t line)
{
    struct lm_ground_path path;
    const fx_bam_t middle = (fx_bam_t)lm_ground_map_edge_bam(g, line) + g->radar->gm_line / 2;
    const uint32_t range_q8 = g->radar->range_m[g->range] * 256u;
    const struct lm_place points[3] = {
        origin->place,
        lm_geo_direct(origin, heading + middle, range_q8 / 2),
        lm_geo_direct(origin, heading + middle, range_q8),
    };
    lm_ground_path_fit(&path, points, g->radar->gm_cells);
    return path;
}

/* The line that the beam will be on `ahead` lines from now; ahead is less than a sweep. */
static uint32_t line_ahead(const struct lm_ground_map *g, uint32_t ahead)
{
    const uint32_t last = lm_ground_map_lines(g) - 1;
    const uint32_t to_edge = g->is_leftward ? g->line : last - g->line;
    if (ahead <= to_edge) {
        return g->is_leftward ? g->line - ahead : g->line + ahead;
    }
    const uint32_t beyond = ahead - to_edge - 1;
    return g->is_leftward ? beyond : last - beyond;
}

static void move_on(struct lm_ground_map *g)
{
    const bool at_edge = g->is_leftward ? g->line == 0 : g->line == lm_ground_map_lines(g) - 1;
    if (at_edge) {
        g->is_leftward = !g->is_leftward;
        g->sweep++;
    } else {
        g->line += g->is_leftward ? UINT32_MAX : 1;
    }
}

/* The targets that the line at hand may meet. */
static void find_targets(struct lm_ground_map *g, struct lm_tile_cache *tiles, uint8_t level,
                         const struct lm_antenna *antenna, struct lm_line_targets *t)
{
    const struct lm_target_scene scene = {.place = antenna->place,
                                          .reach_m = g->radar->range_m[g->range],
                                          .tiles = tiles,
                                          .level = level};
    lm_targets_refresh(&g->near, g->targets, &scene);
    const fx_bam_t edge = (fx_bam_t)lm_ground_map_edge_bam(g, g->line);
    t->items = g->targets->items;
    t->near = &g->near;
    t->where = (struct lm_target_line){
        .place = antenna->place,
        .azimuth = antenna->heading + edge + g->radar->gm_line / 2,
        .width = g->radar->gm_line,
        .first_q8 = g->grid.cell_q8 / 2,
        .cell_q8 = g->grid.cell_q8,
        .cells = g->grid.cells,
        .first = g->grid.first,
        .height_q10 = g->grid.height_q10,
        .reference_q10 = g->grid.reference_q10,
        .wavelength_um = g->radar->wavelength_um,
        .scan = g->sweep,
        .pulse = g->line,
    };
}

uint32_t lm_ground_map_draw_line(struct lm_ground_map *g, struct lm_tile_cache *tiles,
                                 const struct lm_antenna *antenna, const struct lm_tone *tone,
                                 struct lm_line *line)
{
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, antenna->place);
    const uint32_t cell_mm = g->radar->range_m[g->range] * 1000u / g->radar->gm_cells;
    struct lm_texture texture;
    lm_texture_set(&texture, &g->radar->texture, &tiles->db->classes, LM_SEA_STATE_OF_IMAGE);
    struct lm_line_setup setup = {
        .grid = &g->grid,
        .aspect = &g->radar->aspect,
        .texture = &texture,
        .sampling = lm_sampling_for(tiles->db, cell_mm, g->sweep),
    };
    refresh_grid(g, tiles, setup.sampling.level, antenna);
    const uint32_t drawn = g->line;
    const struct lm_ground_path path = path_of(g, &origin, antenna->heading, drawn);
    lm_line_trace(line, tiles, &setup, &path, LM_HORIZON_OPEN);
    lm_floor_run(g->radar->sar.noise_floor_q8, line->sight.level_q8, g->grid.cells);
    lm_speckle_run(&g->radar->gm_speckle, line->ground.noise, line->sight.level_q8, g->grid.cells);
    if (g->targets && g->targets->count != 0) {
        struct lm_line_targets targets;
        find_targets(g, tiles, setup.sampling.level, antenna, &targets);
        lm_line_add_targets(line, &setup, &targets);
    }
    lm_tone_run(tone, line->sight.level_q8, line->grey, g->grid.cells);
    if (drawn % LINES_APART == 0) {
        const struct lm_ground_path ahead =
            path_of(g, &origin, antenna->heading, line_ahead(g, LINES_AHEAD));
        lm_scan_line_prefetch(tiles, &setup.sampling, &ahead, g->radar->gm_cells);
    }
    move_on(g);
    return drawn;
}
