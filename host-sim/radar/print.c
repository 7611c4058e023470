#include "number.h"
#include "radar/text.h"

#include "hs/sensor.h"
#include "lm/sensor.h"

enum { REMARK_COLUMN = 64 };

/* Returns the characters written. */
static int print_names(FILE *out, const struct lm_radar *radar, const struct radar_key *key)
{
    struct lm_radar table = *radar;
    int length = 0;
    for (uint32_t i = 0; i < key->count; i++) {
        length += fprintf(out, "%s%s", i ? ", " : "", radar_key_name(&table, key, i));
    }
    return length;
}

static int print_numbers(FILE *out, const struct lm_radar *radar,
                         const struct lm_radar_field *field)
{
    const struct radar_unit *unit = radar_unit_of(field);
    int length = 0;
    for (uint32_t i = 0; i < lm_radar_field_count(radar, field); i++) {
        char number[RADAR_NUMBER_SIZE];
        radar_number_write(number, unit, lm_radar_field_value(radar, field, i));
        length += fprintf(out, "%s%s", i ? ", " : "", number);
    }
    return length + fprintf(out, "%s%s", *unit->word ? " " : "", unit->word);
}

static void print_ends(FILE *out, const struct lm_radar_field *field, int column)
{
    char low[RADAR_NUMBER_SIZE], high[RADAR_NUMBER_SIZE];
    const struct radar_unit *unit = radar_unit_of(field);
    radar_number_write(low, unit, field->min);
    radar_number_write(high, unit, field->max);
    fprintf(out, "%*s# %s to %s", column < REMARK_COLUMN ? REMARK_COLUMN - column : 1, "", low,
            high);
}

static void print_key(FILE *out, const struct lm_radar *radar, const struct radar_key *key)
{
    const int column = fprintf(out, "%-34s = ", key->text);
    if (key->field == NULL) {
        (void)print_names(out, radar, key);
    } else if (key->field->unit == LM_RADAR_WORD) {
        const int length = fprintf(out, "%s", hs_sensor_name((enum hs_sensor)radar->sensor));
        fprintf(out, "%*s# x, ku, ka, mmw", REMARK_COLUMN - column - length, "");
    } else {
        print_ends(out, key->field, column + print_numbers(out, radar, key->field));
    }
    fputc('\n', out);
}

void radar_text_print(FILE *out, const struct lm_radar *radar)
{
    struct radar_key keys[RADAR_KEYS_MAX];
    const uint32_t count = radar_keys(keys);
    fprintf(out,
            "# Radar table of landmass. `landmass-radar check FILE` checks it. Behind each line "
            "stands what it may hold.\n"
            "# range: one number for each scale. mode: GM, GMT, SEA. fov: NORM, EXP, DBS1, "
            "DBS2.\n\n");
    for (uint32_t i = 0; i < count; i++) {
        print_key(out, radar, &keys[i]);
    }
}
