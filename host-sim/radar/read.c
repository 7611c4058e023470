#include "number.h"
#include "radar/text.h"

#include "hs/error.h"
#include "hs/number.h"
#include "hs/sensor.h"
#include "hs/text_file.h"
#include "lm/sensor.h"
#include "lm/status.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

enum { WORDS_MAX = LM_RANGES_MAX + 1 };

struct reading {
    struct db_text_file file;
    struct lm_radar *radar;
    struct radar_key keys[RADAR_KEYS_MAX];
    int lines[RADAR_KEYS_MAX]; /* where each key stood; 0: not yet */
    uint32_t key_count;
};

static const char see_print[] = "`landmass-radar print` shows how";

/* ---- one line ---- */

static char *trim(char *text)
{
    text += strspn(text, " \t");
    size_t length = strlen(text);
    while (length > 0 && isspace((unsigned char)text[length - 1])) {
        text[--length] = '\0';
    }
    return text;
}

/* Split at commas, in place. Returns the number of parts, WORDS_MAX at most. */
static uint32_t split(char *text, char *parts[WORDS_MAX])
{
    uint32_t count = 0;
    for (char *next = text; next && count < WORDS_MAX; count++) {
        char *comma = strchr(next, ',');
        if (comma) {
            *comma = '\0';
        }
        parts[count] = trim(next);
        next = comma ? comma + 1 : NULL;
    }
    return count;
}

/* Scales are counted by the first line that has a number for each. */
static int check_count(struct reading *r, const struct radar_key *key, uint32_t count)
{
    const bool is_of_scales = key->field && key->field->is_of_scales;
    if (is_of_scales && count > LM_RANGES_MAX) {
        return db_text_error(&r->file, "leave some out", "%s: a radar has up to %d scales",
                             key->text, LM_RANGES_MAX);
    }
    if (is_of_scales && r->radar->ranges == 0) {
        r->radar->ranges = (uint8_t)count;
    }
    const uint32_t needed = is_of_scales ? r->radar->ranges : key->count;
    return count == needed
               ? 0
               : db_text_error(&r->file, "give one for each, with commas between",
                               "%s: has %u values and needs %u", key->text, count, needed);
}

static int take_names(struct reading *r, const struct radar_key *key, char *value)
{
    char *parts[WORDS_MAX];
    const uint32_t count = split(value, parts);
    if (check_count(r, key, count) != 0) {
        return -1;
    }
    for (uint32_t i = 0; i < count; i++) {
        const size_t length = strlen(parts[i]);
        if (length == 0 || length >= key->name_size) {
            return db_text_error(&r->file, "shorten it", "%s: '%s' has not 1 to %zu characters",
                                 key->text, parts[i], key->name_size - 1);
        }
        memcpy(radar_key_name(r->radar, key, i), parts[i], length);
    }
    return 0;
}

static int take_sensor(struct reading *r, const struct radar_key *key, const char *value)
{
    const int sensor = hs_sensor_find(value);
    if (sensor < key->field->min || sensor > key->field->max) {
        return db_text_error(&r->file, "name one of x, ku, ka, mmw",
                             "%s: '%s' is no band of a radar", key->text, value);
    }
    r->radar->sensor = (uint8_t)sensor;
    return 0;
}

static int take_number(struct reading *r, const struct radar_key *key, const char *word,
                       uint32_t index)
{
    const struct lm_radar_field *field = key->field;
    const struct radar_unit *unit = radar_unit_of(field);
    char low[RADAR_NUMBER_SIZE], high[RADAR_NUMBER_SIZE];
    double number;
    if (!hs_number_within(word, -1e9, 1e9, &number)) {
        return db_text_error(&r->file, see_print, "%s: '%s' is no number", key->text, word);
    }
    if (unit->is_whole && number != floor(number)) {
        return db_text_error(&r->file, "round it", "%s: %s is not a whole number", key->text, word);
    }
    const int64_t value = radar_number_value(unit, number);
    if (value < field->min || value > field->max) {
        radar_number_write(low, unit, field->min);
        radar_number_write(high, unit, field->max);
        return db_text_error(&r->file, "choose a number within", "%s: %s is not %s to %s%s%s",
                             key->text, word, low, high, *unit->word ? " " : "", unit->word);
    }
    lm_radar_field_set(r->radar, field, index, value);
    return 0;
}

/* Cut the unit off the last number. */
static int take_unit(struct reading *r, const struct radar_key *key, char *value)
{
    const char *unit = radar_unit_of(key->field)->word;
    char *blank = value + strcspn(value, " \t");
    char *last = strrchr(value, ',');
    if (last) {
        last = trim(last + 1);
        blank = last + strcspn(last, " \t");
    }
    const char *word = *blank ? trim(blank) : "";
    if (strcmp(word, unit) != 0) {
        return *unit ? db_text_error(&r->file, see_print,
                                     "%s: wants the unit %s behind its numbers", key->text, unit)
                     : db_text_error(&r->file, see_print, "%s: has no unit", key->text);
    }
    *blank = '\0';
    return 0;
}

static int take_numbers(struct reading *r, const struct radar_key *key, char *value)
{
    char *parts[WORDS_MAX];
    if (take_unit(r, key, value) != 0) {
        return -1;
    }
    const uint32_t count = split(value, parts);
    if (check_count(r, key, count) != 0) {
        return -1;
    }
    for (uint32_t i = 0; i < count; i++) {
        if (take_number(r, key, parts[i], i) != 0) {
            return -1;
        }
    }
    return 0;
}

static int take_line(struct reading *r)
{
    char *name, *value;
    uint32_t n = 0;
    if (db_text_split(r->file.line, &name, &value) != 0) {
        return db_text_error(&r->file, see_print, "is no 'field = numbers unit'");
    }
    while (n < r->key_count && strcmp(r->keys[n].text, name) != 0) {
        n++;
    }
    if (n == r->key_count) {
        return db_text_error(&r->file, "`landmass-radar print` shows all", "%.60s is no field",
                             name);
    }
    const struct radar_key *key = &r->keys[n];
    if (r->lines[n] != 0) {
        return db_text_error(&r->file, "leave one out", "%s stands in line %d, too", name,
                             r->lines[n]);
    }
    r->lines[n] = r->file.line_number;
    return key->field == NULL                  ? take_names(r, key, value)
           : key->field->unit == LM_RADAR_WORD ? take_sensor(r, key, value)
                                               : take_numbers(r, key, value);
}

/* ---- the whole table ---- */

static int check_missing(const struct reading *r)
{
    for (uint32_t n = 0; n < r->key_count; n++) {
        if (r->lines[n] == 0) {
            return hs_error(r->file.path, see_print, "lacks the field %s", r->keys[n].text);
        }
    }
    return 0;
}

/* The key of what a check names as the firmware does. */
static uint32_t find_faulty(const struct reading *r, const char *field)
{
    uint32_t n = 0;
    while (n + 1 < r->key_count && strcmp(r->keys[n].text, field) != 0 &&
           !(r->keys[n].field && strcmp(r->keys[n].field->name, field) == 0)) {
        n++;
    }
    return n;
}

static int check_rules(struct reading *r)
{
    struct lm_radar_fault fault;
    if (lm_radar_check(r->radar, &fault) == LM_OK) {
        return 0;
    }
    /* Windows are a field of their own in each but the first. */
    const uint32_t n = find_faulty(r, strcmp(fault.field, "fov.window_permille") == 0
                                          ? "fov[EXP..].window_permille"
                                          : fault.field);
    r->file.line_number = r->lines[n];
    return db_text_error(&r->file, "correct it or what it stands beside",
                         "%s, value %u: must be %s", r->keys[n].text, fault.index + 1,
                         fault.needs ? fault.needs : "inside its range");
}

/* IEEE Std 521-2002; light travels 299,792 um in a nanosecond. */
static void judge_wavelength(const struct reading *r)
{
    static const double bands_ghz[LM_SENSOR_IR][2] = {[LM_SENSOR_X] = {8, 12},
                                                      [LM_SENSOR_KU] = {12, 18},
                                                      [LM_SENSOR_KA] = {27, 40},
                                                      [LM_SENSOR_MMW] = {40, 300}};
    const double *band = bands_ghz[r->radar->sensor];
    const double ghz = 299792.458 / r->radar->wavelength_um;
    if (ghz < band[0] || ghz > band[1]) {
        hs_warn(r->file.path, "correct wavelength_um or sensor",
                "%u um are %.1f GHz, and %s is %g to %g GHz", r->radar->wavelength_um, ghz,
                hs_sensor_title((enum hs_sensor)r->radar->sensor), band[0], band[1]);
    }
}

/* Fields that no line has: they can have one value alone. */
static void set_constants(struct lm_radar *radar)
{
    const struct lm_radar_field *field;
    for (uint32_t n = 0; (field = lm_radar_field(n)) != NULL; n++) {
        for (uint32_t i = 0; field->min == field->max && i < field->count; i++) {
            lm_radar_field_set(radar, field, i, field->min);
        }
    }
}

int radar_text_read(struct lm_radar *radar, const char *path)
{
    struct reading r = {.radar = radar};
    int status;
    memset(radar, 0, sizeof *radar);
    set_constants(radar);
    r.key_count = radar_keys(r.keys);
    if (db_text_open(&r.file, path) != 0) {
        return -1;
    }
    while ((status = db_text_next(&r.file)) == 1) {
        if (take_line(&r) != 0) {
            status = -1;
            break;
        }
    }
    if (status == 0) {
        status = check_missing(&r) == 0 ? check_rules(&r) : -1;
    }
    if (status == 0) {
        judge_wavelength(&r);
    }
    db_text_close(&r.file);
    return status;
}
