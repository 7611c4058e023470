/* The real-beam ground map: a sector swept line by line, out and back. */
#ifndef LM_GROUND_MAP_H
#define LM_GROUND_MAP_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/line.h"
#include "lm/radar.h"
#include "lm/tone.h"

struct lm_ground_map {
    const struct lm_radar *radar; /* borrowed */
    uint8_t range, azimuth;       /* indices into the radar table */
    uint32_t line;                /* next to be drawn, 0 at the left edge */
    bool is_leftward;
    uint32_t sweep; /* sweeps begun, from the epoch given: the epoch of the noise */
    struct lm_range_grid grid;
    const struct lm_target_set *targets; /* borrowed; NULL: none, as after lm_ground_map_start */
    struct lm_targets_near near;
};

/* From where a line is drawn. */
struct lm_antenna {
    struct lm_place place;
    int32_t height_q10; /* metres * 1024 above mean sea level */
    fx_bam_t heading;   /* of the sector's middle */
};

/* Begin at the left edge with these scales; both are valid indices. `epoch` is that of the first
 * sweep's noise. */
void lm_ground_map_start(struct lm_ground_map *g, const struct lm_radar *radar, uint8_t range,
                         uint8_t azimuth, uint32_t epoch);

/* Lines in the sector, and the time one takes. */
uint32_t lm_ground_map_lines(const struct lm_ground_map *g);
uint32_t lm_ground_map_line_us(const struct lm_ground_map *g);

/* Edges of line `line` from the sector's middle, right positive, as signed BAM; line may be
 * lm_ground_map_lines. */
int32_t lm_ground_map_edge_bam(const struct lm_ground_map *g, uint32_t line);

/* Draw the next line into line->grey[0 .. gm_cells - 1], ask for the tiles of one some way ahead,
 * and move on. Returns the number of the line that was drawn. */
uint32_t lm_ground_map_draw_line(struct lm_ground_map *g, struct lm_tile_cache *tiles,
                                 const struct lm_antenna *antenna, const struct lm_tone *tone,
                                 struct lm_line *line);

#endif
