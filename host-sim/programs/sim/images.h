/* Images of a flight: what landmass-sim tells of each. */
#ifndef SIM_IMAGES_H
#define SIM_IMAGES_H

#include "lm/unit_map.h"

/* Their paths by place, the database first; NULL: none there. All borrowed. */
struct images {
    const char *path[LM_IMAGES_MAX];
};

/* Warn of the image at a place if the map is without it, by what part_status says. */
void images_warn(const struct images *images, const struct lm_unit_map *map, uint32_t place);

/* The key `images` of the report. `parts` are the board's. */
void images_report(const struct images *images, const struct lm_unit_map *map,
                   const struct lm_flash_part *parts);

#endif
