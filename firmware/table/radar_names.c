#include <stdbool.h>

#include "fx/sat.h"
#include "lm/radar.h"
#include "lm/units.h"

static char small(char letter)
{
    return letter >= 'A' && letter <= 'Z' ? (char)(letter - 'A' + 'a') : letter;
}

static bool is_same(const char name[LM_NAME_SIZE], const char *word)
{
    uint32_t i = 0;
    while (i < LM_NAME_SIZE - 1 && name[i] && small(name[i]) == small(word[i])) {
        i++;
    }
    return name[i] == word[i];
}

int32_t lm_radar_find_range(const struct lm_radar *radar, int32_t range_nm)
{
    for (int32_t i = 0; i < radar->ranges; i++) {
        if (radar->range[i].range_nm == range_nm) {
            return i;
        }
    }
    return -1;
}

int32_t lm_radar_find_mode(const struct lm_radar *radar, const char *name)
{
    for (int32_t i = 0; i < LM_SECTOR_MODES; i++) {
        if (is_same(radar->mode[i].name, name)) {
            return i;
        }
    }
    return -1;
}

int32_t lm_radar_find_fov(const struct lm_radar *radar, const char *name)
{
    for (int32_t i = 0; i < LM_FOVS; i++) {
        if (is_same(radar->fov[i].name, name)) {
            return i;
        }
    }
    return -1;
}

int32_t lm_radar_find_azimuth(const struct lm_radar *radar, int32_t degrees)
{
    for (int32_t i = 0; i < LM_AZIMUTHS; i++) {
        if (lm_deg_of_bam(radar->azimuth_half[i]) == (uint32_t)degrees) {
            return i;
        }
    }
    return -1;
}

uint32_t lm_radar_range_last(const struct lm_radar *radar, uint32_t mode, uint32_t fov)
{
    const uint32_t most_nm =
        fx_min_u32(radar->mode[mode].range_max_nm, radar->fov[fov].range_max_nm);
    uint32_t last = 0;
    while (last + 1 < radar->ranges && radar->range[last + 1].range_nm <= most_nm) {
        last++;
    }
    return last;
}
