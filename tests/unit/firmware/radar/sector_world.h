/* A radar over a small country, for tests of its sectors: the map, the sector and a platform that
 * stays where it is put, and nothing else of the unit. */
#ifndef SECTOR_WORLD_H
#define SECTOR_WORLD_H

#include "lm/sector.h"

#include "tiny_map.h"

struct sector_world {
    struct tiny_map map;
    struct lm_radar radar; /* the default table; a test may change it before it starts a sector */
    struct lm_tone tone;
    struct lm_line line;
    struct lm_platform platform;
    struct lm_sector sector;
};

struct sector_world *make_sector_world(const struct tiny_spec *spec);
void free_sector_world(struct sector_world *w);

/* Begin a sector with all the tiles that it needs in memory. What is lent may be NULL. */
void start_sector(struct sector_world *w, const struct lm_sector_command *command,
                  const struct lm_environment *environment, const struct lm_target_set *targets);

/* Draw a line, and wait for the tiles that it asked for. Returns its number. */
uint32_t draw_line(struct sector_world *w);

/* Draw to the end of the sweep. */
void draw_sweep(struct sector_world *w);

/* The place at a distance and azimuth from the platform. */
struct lm_position place_at(const struct sector_world *w, double azimuth_deg, double distance_m);

/* Azimuth of the middle of a line, degrees from the sector's middle. */
double line_azimuth_deg(const struct lm_sector *s, uint32_t line);

#endif
