#include "sector_world.h"
#include "check.h"

#include "hs/angle.h"

#include <math.h>
#include <stdlib.h>

enum { POOL_TILES = 400 };

struct sector_world *make_sector_world(const struct tiny_spec *spec)
{
    struct sector_world *w = calloc(1, sizeof *w);
    w->radar = lm_radar_default;
    tiny_map_open(&w->map, spec, POOL_TILES);
    assert_int_equal(lm_tone_set(&w->tone, &w->radar.mode[LM_SECTOR_GM].tone), LM_OK);
    return w;
}

void free_sector_world(struct sector_world *w)
{
    tiny_map_close(&w->map);
    free(w);
}

void start_sector(struct sector_world *w, const struct lm_sector_command *command,
                  const struct lm_environment *environment, const struct lm_target_set *targets)
{
    lm_sector_start(&w->sector, &w->radar, command, 0);
    draw_sweep(w);
    lm_sector_start(&w->sector, &w->radar, command, 0);
    w->sector.environment = environment;
    w->sector.targets = targets;
}

uint32_t draw_line(struct sector_world *w)
{
    const uint32_t drawn =
        lm_sector_draw_line(&w->sector, &w->map.tiles, &w->platform, &w->tone, &w->line);
    tiny_map_read_tiles(&w->map);
    return drawn;
}

void draw_sweep(struct sector_world *w)
{
    do {
        draw_line(w);
    } while (!lm_sector_is_at_edge(&w->sector));
}

struct lm_position place_at(const struct sector_world *w, double azimuth_deg, double distance_m)
{
    struct lm_geo_origin origin;
    const fx_bam_t azimuth = hs_bam(azimuth_deg);
    lm_geo_set_origin(&origin, w->platform.position);
    return lm_geo_direct(&origin, azimuth, (uint32_t)lround(distance_m * 256));
}

double line_azimuth_deg(const struct lm_sector *s, uint32_t line)
{
    return hs_degrees((fx_bam_t)lm_sector_edge_bam(s, line)) + hs_degrees(s->width) / 2;
}
