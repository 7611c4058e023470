#include "images.h"

#include "hs/error.h"
#include "hs/report.h"
#include "lm/sensor.h"

#include <math.h>

/* The unit runs without an image, too. */
static void warn_of_database(const char *path, const struct lm_unit_map *map, int status)
{
    if (status == LM_ERR_SENSOR) {
        hs_warn(path, "build it for this radar, or name its own with --radar",
                "its reflectivity is of band %s, the radar's is %s", lm_sensor_word(map->db.sensor),
                lm_sensor_word(map->radar->sensor));
    } else {
        hs_warn(path, "landmass-db verify tells what is wrong", "is no usable flash image");
    }
}

static void warn_of_further(const char *path, int status)
{
    if (status == LM_ERR_SENSOR) {
        hs_warn(path, "build both for one radar",
                "is not shown: its reflectivity is of another band than that of the others");
    } else if (status == LM_ERR_TABLE) {
        hs_warn(path, "build all with one class table, and give the radar table to --db alone",
                "is not shown: its classes or its radar table are not those of the others");
    } else {
        hs_warn(path, "landmass-db verify tells what is wrong", "is no usable flash image");
    }
}

void images_warn(const struct images *images, const struct lm_unit_map *map, uint32_t place)
{
    const char *const path = images->path[place];
    const int status = map->part_status[place];
    if (!path || status == LM_OK) {
        return;
    }
    if (status == LM_ERR_VERSION) {
        hs_warn(path, "`landmass-db convert OLD NEW` makes a new image of an old one",
                "is a flash image of another version");
    } else if (place == 0 && !map->is_usable) {
        warn_of_database(path, map, status);
    } else {
        warn_of_further(path, status);
    }
}

/* One that a recording does not have is at hand and not flown. */
static const char *state_of(int status, bool is_flown)
{
    return status == LM_OK            ? (is_flown ? "flown" : "not flown")
           : status == LM_ERR_VERSION ? "other version"
           : status == LM_ERR_SENSOR  ? "other band"
           : status == LM_ERR_TABLE   ? "other tables"
                                      : "not usable";
}

void images_report(const struct images *images, const struct lm_unit_map *map,
                   const struct lm_flash_part *parts)
{
    hs_report_array("images");
    for (uint32_t i = 0; i < LM_IMAGES_MAX; i++) {
        if (!images->path[i]) {
            continue;
        }
        const uint32_t number = lm_unit_map_image_from(map, parts[i].offset);
        const struct lm_db *const image = number < map->image_count ? &map->images[number] : NULL;
        hs_report_object(NULL);
        hs_report_integer("place", i + 1);
        hs_report_text("path", images->path[i]);
        hs_report_text("state", state_of(map->part_status[i], image != NULL));
        hs_report_text("title", image ? image->title : NULL);
        hs_report_real("cell_m", image ? lm_db_cell_mm(image, 0) / 1000.0 : NAN);
        hs_report_close();
    }
    hs_report_close();
}
