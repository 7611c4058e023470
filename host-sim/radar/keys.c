#include "keys.h"

#include <stdio.h>
#include <string.h>

#define BAM_PER_DEGREE (4294967296.0 / 360)

/* The firmware's name without what says how it is stored: "noise_db_q8" is "noise_db". */
static void write_key(char text[RADAR_KEY_SIZE], const char *name)
{
    static const char *const stored[][2] = {{"_q16", ""}, {"_q8", ""}, {"bam_per_s", "deg_per_s"}};
    snprintf(text, RADAR_KEY_SIZE, "%s", name);
    for (size_t i = 0; i < sizeof stored / sizeof stored[0]; i++) {
        char rest[RADAR_KEY_SIZE];
        char *at = strstr(text, stored[i][0]);
        if (at) {
            snprintf(rest, sizeof rest, "%s", at + strlen(stored[i][0]));
            snprintf(at, RADAR_KEY_SIZE - (size_t)(at - text), "%s%s", stored[i][1], rest);
        }
    }
}

uint32_t radar_keys(struct radar_key keys[RADAR_KEYS_MAX])
{
    static const struct radar_key names[] = {
        {"name", NULL, offsetof(struct lm_radar, name), 0, LM_RADAR_NAME_SIZE, 1},
        {"mode.name", NULL, offsetof(struct lm_radar, mode[0].name),
         sizeof(struct lm_sector_mode_row), LM_NAME_SIZE, LM_SECTOR_MODES},
        {"fov.name", NULL, offsetof(struct lm_radar, fov[0].name), sizeof(struct lm_fov_row),
         LM_NAME_SIZE, LM_FOVS},
    };
    uint32_t count = sizeof names / sizeof names[0];
    memcpy(keys, names, sizeof names);
    for (uint32_t n = 0; lm_radar_field(n) && count < RADAR_KEYS_MAX; n++) {
        const struct lm_radar_field *field = lm_radar_field(n);
        if (field->min < field->max && strcmp(field->name, "ranges") != 0) {
            keys[count] = (struct radar_key){.field = field, .count = field->count};
            write_key(keys[count++].text, field->name);
        }
    }
    return count;
}

char *radar_key_name(struct lm_radar *radar, const struct radar_key *key, uint32_t index)
{
    return (char *)radar + key->name_offset + index * key->name_stride;
}

const struct radar_unit *radar_unit_of(const struct lm_radar_field *field)
{
    static const struct radar_unit units[LM_RADAR_UNITS] = {
        [LM_RADAR_NUMBER] = {"", 1, true},
        [LM_RADAR_WORD] = {"", 1, true},
        [LM_RADAR_Q8] = {"", 256, false},
        [LM_RADAR_DB_Q8] = {"dB", 256, false},
        [LM_RADAR_DB_PER_KM_Q16] = {"dB/km", 65536, false},
        [LM_RADAR_BAM] = {"deg", BAM_PER_DEGREE, false},
        [LM_RADAR_BAM_PER_S] = {"deg/s", BAM_PER_DEGREE, false},
        [LM_RADAR_M] = {"m", 1, true},
        [LM_RADAR_NMI] = {"nmi", 1, true},
        [LM_RADAR_MM] = {"mm", 1, true},
        [LM_RADAR_UM] = {"um", 1, true},
        [LM_RADAR_MM_S] = {"mm/s", 1, true},
        [LM_RADAR_NS] = {"ns", 1, true},
        [LM_RADAR_MS] = {"ms", 1, true},
        [LM_RADAR_PERMILLE] = {"permille", 1, true},
        [LM_RADAR_PERCENT] = {"percent", 1, true},
    };
    return &units[field->unit];
}
