#include "bus/table_text.h"

#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/number.h"
#include "lm/canas.h"
#include "lm/fast_packet.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_BYTES = 1024 };

/* A line being read, and what an item of it says before it is turned into a row. */
struct reader {
    struct bus_table *table;
    const char *path;
    unsigned line;
    bool has_framing;
};

struct item {
    struct lm_bus_row row;
    double scale, offset;  /* from the integer or float of the frame to `unit` */
    double unit;           /* of what scale and offset are given in, as a part of the bus's unit */
    const char *unit_name; /* NULL: not given */
    bool has_id, has_range, has_period, has_bits, has_stale, has_dead;
};

static int wrong(const struct reader *r, const char *remedy, const char *cause, const char *what)
{
    char place[512];
    snprintf(place, sizeof place, "%s line %u", r->path, r->line);
    return hs_error(place, remedy, "%s: %s", what, cause);
}

/* ---- numbers ---- */

static int read_integer(const struct reader *r, const char *key, const char *text, long low,
                        long high, long *value)
{
    char *end, cause[80];
    errno = 0;
    *value = strtol(text, &end, 0);
    if (errno != 0 || end == text || *end != '\0' || *value < low || *value > high) {
        snprintf(cause, sizeof cause, "is not a whole number from %ld to %ld", low, high);
        return wrong(r, NULL, cause, key);
    }
    return 0;
}

static int read_real(const struct reader *r, const char *key, const char *text, double *value)
{
    if (!hs_number_within(text, -1e12, 1e12, value)) {
        return wrong(r, NULL, "is not a number", key);
    }
    return 0;
}

/* "FIRST+COUNT". */
static int read_bits(const struct reader *r, const char *key, const char *text,
                     struct lm_bus_bits *bits)
{
    unsigned first, count;
    char rest;
    if (sscanf(text, "%u+%u%c", &first, &count, &rest) != 2 || count < 1 || count > 64 ||
        first > 8 * LM_FAST_PACKET_BYTES) {
        return wrong(r, "write the number of the first bit and how many, as 16+32",
                     "is not a run of bits", key);
    }
    *bits = (struct lm_bus_bits){(uint16_t)first, (uint8_t)count};
    return 0;
}

/* ---- the words of an item ---- */

static int take_id(const struct reader *r, struct item *item, const char *text)
{
    long id;
    item->has_id = true;
    if (read_integer(r, "id", text, 0, 0x1fffffff, &id) != 0) {
        return -1;
    }
    item->row.id = (uint32_t)id;
    return 0;
}

static int take_mask(const struct reader *r, struct item *item, const char *text)
{
    long mask;
    if (read_integer(r, "mask", text, 1, 0x1fffffff, &mask) != 0) {
        return -1;
    }
    item->row.packing.mask = (uint32_t)mask;
    return 0;
}

static int take_field(const struct reader *r, struct item *item, const char *text)
{
    for (int i = 0; i < LM_BUS_FIELDS; i++) {
        if (strcmp(lm_bus_fields[i].name, text) == 0) {
            item->row.field = (uint8_t)i;
            return 0;
        }
    }
    return wrong(r, "landmass-bus fields lists them", "there is no such field", text);
}

static int take_priority(const struct reader *r, struct item *item, const char *text)
{
    long priority;
    if (read_integer(r, "priority", text, 0, 255, &priority) != 0) {
        return -1;
    }
    item->row.priority = (uint8_t)priority;
    return 0;
}

static int take_period(const struct reader *r, struct item *item, const char *text)
{
    double ms;
    item->has_period = true;
    if (read_real(r, "period", text, &ms) != 0) {
        return -1;
    }
    if (ms < 1 || ms > 60000) {
        return wrong(r, NULL, "is not from 1 to 60000 ms", "period");
    }
    item->row.period_us = (uint32_t)lround(ms * 1000);
    return 0;
}

static int take_age(const struct reader *r, const char *key, const char *text, uint16_t *age_ms)
{
    long ms;
    if (read_integer(r, key, text, 1, 60000, &ms) != 0) {
        return -1;
    }
    *age_ms = (uint16_t)ms;
    return 0;
}

static int take_stale(const struct reader *r, struct item *item, const char *text)
{
    item->has_stale = true;
    return take_age(r, "stale", text, &item->row.stale_ms);
}

static int take_dead(const struct reader *r, struct item *item, const char *text)
{
    item->has_dead = true;
    return take_age(r, "dead", text, &item->row.dead_ms);
}

static int take_range(const struct reader *r, struct item *item, const char *text)
{
    char rest;
    item->has_range = true;
    if (sscanf(text, "%d..%d%c", &item->row.low, &item->row.high, &rest) != 2 ||
        item->row.low >= item->row.high || item->row.low < -100000 || item->row.high > 100000) {
        return wrong(r, "write -90..90, in the unit of the field", "is not a range", "range");
    }
    return 0;
}

static int take_types(const struct reader *r, struct item *item, const char *text)
{
    char list[LINE_BYTES];
    snprintf(list, sizeof list, "%s", text);
    char *rest = NULL;
    for (char *name = strtok_r(list, ",", &rest); name; name = strtok_r(NULL, ",", &rest)) {
        uint8_t type = 0;
        while (type < LM_CANAS_TYPES && strcmp(lm_canas_types[type].name, name) != 0) {
            type++;
        }
        if (type == LM_CANAS_TYPES) {
            return wrong(r, "write FLOAT,SHORT2 and so on", "is no data type of CANaerospace",
                         name);
        }
        item->row.types |= 1u << type;
    }
    return 0;
}

static int take_per_unit(const struct reader *r, struct item *item, const char *text)
{
    long per_unit;
    if (read_integer(r, "per-unit", text, 1, 1000000000, &per_unit) != 0) {
        return -1;
    }
    item->row.per_unit = (int32_t)per_unit;
    return 0;
}

static int take_bits(const struct reader *r, struct item *item, const char *text)
{
    item->has_bits = true;
    return read_bits(r, "bits", text, &item->row.packing.bits);
}

/* "FIRST+COUNT=VALUE". */
static int take_when(const struct reader *r, struct item *item, const char *text)
{
    char bits[LINE_BYTES];
    snprintf(bits, sizeof bits, "%s", text);
    char *value = strchr(bits, '=');
    long number;
    if (value == NULL) {
        return wrong(r, "write when=56+2=0", "has no value", "when");
    }
    *value++ = '\0';
    struct lm_bus_packing *p = &item->row.packing;
    if (read_bits(r, "when", bits, &p->match) != 0 ||
        read_integer(r, "when", value, 0, 255, &number) != 0) {
        return -1;
    }
    if (p->match.count > 8 || number >> p->match.count != 0) {
        return wrong(r, NULL, "is more than 8 bits, or the value does not fit", "when");
    }
    p->match_value = (uint8_t)number;
    return 0;
}

static int take_type(const struct reader *r, struct item *item, const char *text)
{
    static const char *const names[] = {"unsigned", "signed", "float"};
    for (uint8_t i = 0; i < 3; i++) {
        if (strcmp(names[i], text) == 0) {
            item->row.packing.type = i;
            return 0;
        }
    }
    return wrong(r, "write unsigned, signed or float", "is no type", text);
}

static int take_endian(const struct reader *r, struct item *item, const char *text)
{
    item->row.packing.is_little_endian = strcmp(text, "little") == 0;
    return item->row.packing.is_little_endian || strcmp(text, "big") == 0
               ? 0
               : wrong(r, "write big or little", "is no order of bytes", text);
}

static int take_packet(const struct reader *r, struct item *item, const char *text)
{
    item->row.packing.is_fast = strcmp(text, "fast") == 0;
    return item->row.packing.is_fast || strcmp(text, "single") == 0
               ? 0
               : wrong(r, "write single or fast", "is no kind of packet", text);
}

static int take_none(const struct reader *r, struct item *item, const char *text)
{
    long none;
    if (read_integer(r, "none", text, 0, 0xffffffffL, &none) != 0) {
        return -1;
    }
    item->row.packing.has_none = true;
    item->row.packing.none = (uint32_t)none;
    return 0;
}

static int take_scale(const struct reader *r, struct item *item, const char *text)
{
    return read_real(r, "scale", text, &item->scale) != 0 ? -1
           : item->scale > 0                              ? 0
                             : wrong(r, NULL, "is not above 0", "scale");
}

static int take_offset(const struct reader *r, struct item *item, const char *text)
{
    return read_real(r, "offset", text, &item->offset);
}

static int take_unit(const struct reader *r, struct item *item, const char *text)
{
    static const struct {
        const char *name, *bus_unit;
        double factor;
    } units[] = {
        {"deg", "deg", 1},
        {"rad", "deg", 57.295779513082321},
        {"deg/s", "deg/s", 1},
        {"rad/s", "deg/s", 57.295779513082321},
        {"m", "m", 1},
        {"ft", "m", 0.3048},
        {"m/s", "m/s", 1},
        {"kt", "m/s", 1852.0 / 3600},
        {"ft/min", "m/s", 0.3048 / 60},
        {"s", "s", 1},
    };
    const char *needed = lm_bus_scale_of((enum lm_bus_field)item->row.field)->bus_unit;
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        if (strcmp(units[i].name, text) == 0) {
            item->unit = units[i].factor;
            item->unit_name = units[i].name;
            return strcmp(units[i].bus_unit, needed) == 0
                       ? 0
                       : wrong(r, needed, "is not a unit of this field, whose own is the last word",
                               text);
        }
    }
    return wrong(r, "deg, rad, deg/s, rad/s, m, ft, m/s, kt, ft/min or s", "is no unit", text);
}

static const struct word {
    const char *name;
    int (*take)(const struct reader *r, struct item *item, const char *text);
} words[] = {
    {"field", take_field},       {"id", take_id},         {"mask", take_mask},
    {"priority", take_priority}, {"period", take_period}, {"stale", take_stale},
    {"dead", take_dead},         {"range", take_range},   {"types", take_types},
    {"per-unit", take_per_unit}, {"bits", take_bits},     {"when", take_when},
    {"type", take_type},         {"endian", take_endian}, {"none", take_none},
    {"scale", take_scale},       {"offset", take_offset}, {"packet", take_packet},
    {"unit", take_unit},
};

/* ---- the arithmetic of a packed number ---- */

/* Fill multiplier, shift, frac_bits and bias so that an integer or float of the frame becomes
 * counts of the field: number * scale + offset in the item's unit. The multiplier keeps 30 bits, so
 * that the value is within two counts in 2^31. */
static int fit_arithmetic(const struct reader *r, struct item *item)
{
    struct lm_bus_packing *p = &item->row.packing;
    const struct lm_bus_scale *s = lm_bus_scale_of((enum lm_bus_field)item->row.field);
    const double counts_per_unit =
        ldexp((double)s->multiplier, s->frac_bits) / s->divisor * item->unit;
    double factor = item->scale * counts_per_unit;
    if (p->type == LM_BUS_FLOAT) {
        const double span = fmax(fabs((double)item->row.low), fabs((double)item->row.high));
        const double largest = (span / item->unit + fabs(item->offset)) / item->scale;
        const int places = 30 - ilogb(largest);
        if (places < 0) {
            return wrong(r, NULL, "takes more than 31 bits before the point", "scale");
        }
        p->frac_bits = (uint8_t)(places > 60 ? 60 : places);
        factor = ldexp(factor, -p->frac_bits);
    }
    const int shift = 29 - ilogb(factor);
    if (shift < 1 || shift > 60) {
        return wrong(r, NULL, "is too large or too small for the field", "scale");
    }
    p->shift = (uint8_t)shift;
    const double multiplier = round(ldexp(factor, shift));
    p->multiplier = (int32_t)fmin(multiplier, 0x1p30 - 1);
    const double bias = ldexp(item->offset * counts_per_unit + 0.5, shift);
    if (fabs(bias) >= 0x1p61) {
        return wrong(r, NULL, "is too large beside the scale", "offset");
    }
    p->bias = (int64_t)bias;
    return 0;
}

/* ---- checks ---- */

static int check_run(const struct reader *r, const char *key, const struct lm_bus_packing *p,
                     struct lm_bus_bits bits)
{
    const unsigned room = p->is_fast ? 8 * LM_FAST_PACKET_BYTES : 64;
    if (bits.first + (unsigned)bits.count > room) {
        return wrong(r, p->is_fast ? NULL : "packet=fast joins messages of several frames",
                     "end behind the frame or message", key);
    }
    return bits.first % 8 + bits.count <= 64
               ? 0
               : wrong(r, NULL, "begin and end more than eight bytes apart", key);
}

static int check_packed(const struct reader *r, struct item *item)
{
    struct lm_bus_packing *p = &item->row.packing;
    const bool is_float = p->type == LM_BUS_FLOAT;
    if (lm_bus_is_of_set((enum lm_bus_field)item->row.field)) {
        return wrong(r, "it needs framing canaerospace",
                     "comes in sets, which only message and service codes tell apart",
                     lm_bus_fields[item->row.field].name);
    }
    if (!item->has_bits) {
        return wrong(r, "add bits=FIRST+COUNT", "is missing", "bits");
    }
    if (check_run(r, "bits", p, p->bits) != 0 || check_run(r, "when", p, p->match) != 0) {
        return -1;
    }
    if (is_float ? p->bits.count != 32 && p->bits.count != 64 : p->bits.count > 32) {
        return wrong(r, "an integer has 1 to 32, a float 32 or 64", "do not fit the type", "bits");
    }
    if (p->has_none && (is_float || (p->bits.count < 32 && p->none >> p->bits.count != 0))) {
        return wrong(r, NULL, "is for an integer, and must fit its bits", "none");
    }
    if ((item->row.id & ~p->mask) != 0) {
        return wrong(r, "clear them, or set them in the mask", "has bits outside its mask", "id");
    }
    if (item->row.types != 0) {
        return wrong(r, "write type=", "belongs to framing canaerospace", "types");
    }
    if (item->unit_name == NULL) {
        return wrong(r, "add unit=", "is missing", "unit");
    }
    return fit_arithmetic(r, item);
}

static int check_canas(const struct reader *r, const struct item *item)
{
    if (item->row.id < LM_CANAS_ROW_FIRST || item->row.id > LM_CANAS_ROW_LAST) {
        return wrong(r, NULL, "is not from 200 to 1999", "id");
    }
    if (item->row.types == 0) {
        return wrong(r, "add types=", "is missing", "types");
    }
    if (item->has_bits || item->unit_name != NULL) {
        return wrong(r, NULL, "belong to framing packed", "bits and unit");
    }
    for (int type = 0; type < LM_CANAS_TYPES; type++) {
        if ((item->row.types >> type & 1) != 0 &&
            !lm_canas_fits((enum lm_bus_field)item->row.field, (uint8_t)type)) {
            return wrong(r, "see docs/bus.md for what fits", "cannot carry this field",
                         lm_canas_types[type].name);
        }
    }
    const bool is_assumed = r->table->profile.are_types_assumed;
    return is_assumed && (item->row.types & (item->row.types - 1)) != 0
               ? wrong(r, "name one", "must be one where types are assumed", "types")
               : 0;
}

static int check_ages(const struct reader *r, const struct item *item)
{
    const struct lm_bus_row *row = &item->row;
    const bool is_coordinate = row->field <= LM_BUS_LONGITUDE;
    if (!item->has_id || !item->has_range || !item->has_period || !item->has_stale ||
        !item->has_dead) {
        return wrong(r, "id, range, period, stale and dead are needed", "is incomplete", "item");
    }
    if (row->period_us > row->stale_ms * 1000u || row->stale_ms >= row->dead_ms) {
        return wrong(r, NULL, "must rise in this order", "period, stale and dead");
    }
    return is_coordinate && row->dead_ms > 4000
               ? wrong(r, NULL, "is at most 4000 for latitude and longitude", "dead")
               : 0;
}

static bool have_halves(const struct lm_bus_row *row)
{
    return (row->types >> LM_CANAS_DOUBLEH & 3) != 0;
}

/* Against the rows before. */
static int check_rivals(const struct reader *r, const struct lm_bus_row *row)
{
    const struct lm_bus_profile *p = &r->table->profile;
    int same_frame = 1;
    for (int i = 0; i < p->row_count; i++) {
        const struct lm_bus_row *other = &p->rows[i];
        if (other->field == row->field && other->priority == row->priority) {
            return wrong(r, "give each a priority of its own", "is there already", "field");
        }
        if (other->field == row->field && have_halves(other) && have_halves(row)) {
            return wrong(r, NULL, "can come as halves of a DOUBLE only once", "field");
        }
        if (p->framing == LM_BUS_CANAEROSPACE && other->id == row->id) {
            return wrong(r, NULL, "is there already", "id");
        }
        const uint32_t common = other->packing.mask & row->packing.mask;
        const bool is_same = (other->id & common) == (row->id & common);
        if (p->framing == LM_BUS_PACKED && is_same &&
            other->packing.is_fast != row->packing.is_fast) {
            return wrong(r, NULL,
                         "is of a frame that is a fast packet in another item, or not here",
                         "item");
        }
        same_frame += is_same;
    }
    return p->framing == LM_BUS_PACKED && same_frame > LM_BUS_EVENTS
               ? wrong(r, NULL, "has more than eight numbers in one frame", "item")
               : 0;
}

/* ---- lines ---- */

static int take_word(const struct reader *r, struct item *item, char *word)
{
    char *value = strchr(word, '=');
    if (value == NULL) {
        return wrong(r, "write word=value", "has no value", word);
    }
    *value++ = '\0';
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (strcmp(words[i].name, word) == 0) {
            return words[i].take(r, item, value);
        }
    }
    return wrong(r, "docs/bus.md lists the words", "is no word of an item", word);
}

/* `item "NAME" field=... word=value ...` behind the first word. */
static int take_item(struct reader *r, char *text)
{
    struct bus_table *t = r->table;
    struct item item = {
        .row = {.per_unit = 1, .packing = {.mask = 0x1fffffff}}, .scale = 1, .unit = 1};
    char *rest = NULL;
    char *name = strchr(text, '"'), *end = name ? strchr(name + 1, '"') : NULL;
    if (!r->has_framing) {
        return wrong(r, "write it above the items", "is missing", "framing");
    }
    if (end == NULL || end - name - 1 < 1 || end - name > BUS_NAME_BYTES) {
        return wrong(r, "write item \"GPS latitude\" field=latitude ...",
                     "needs a name of at most 63 bytes in quotes", "item");
    }
    if (t->profile.row_count == LM_BUS_ROWS_MAX) {
        return wrong(r, "raise LM_BUS_ROWS_MAX of lm/config.h", "is one too many", "item");
    }
    *end = '\0';
    for (const char *c = name + 1; *c != '\0'; c++) {
        if ((unsigned char)*c < ' ' || *c == '\\' || *c == '|') {
            return wrong(r, NULL, "has a control character, a backslash or a bar", "name");
        }
    }
    bool has_field = false;
    for (char *word = strtok_r(end + 1, " \t", &rest); word; word = strtok_r(NULL, " \t", &rest)) {
        if (!has_field && strncmp(word, "field=", 6) != 0) {
            return wrong(r, NULL, "must come first after the name", "field");
        }
        has_field = true;
        if (take_word(r, &item, word) != 0) {
            return -1;
        }
    }
    if (!has_field) {
        return wrong(r, "landmass-bus fields lists them", "is missing", "field");
    }
    const bool is_packed = t->profile.framing == LM_BUS_PACKED;
    if (check_ages(r, &item) != 0 ||
        (is_packed ? check_packed(r, &item) : check_canas(r, &item)) != 0 ||
        check_rivals(r, &item.row) != 0) {
        return -1;
    }
    if (!is_packed) {
        item.row.packing = (struct lm_bus_packing){0};
    }
    const uint8_t index = t->profile.row_count++;
    snprintf(t->row_names[index], BUS_NAME_BYTES, "%s", name + 1);
    item.row.name = t->row_names[index];
    t->rows[index] = item.row;
    return 0;
}

static int take_framing(struct reader *r, const char *text)
{
    struct lm_bus_profile *p = &r->table->profile;
    r->has_framing = true;
    p->framing = strcmp(text, "packed") == 0 ? LM_BUS_PACKED : LM_BUS_CANAEROSPACE;
    p->are_types_assumed = strcmp(text, "canaerospace-types-assumed") == 0;
    return p->framing == LM_BUS_PACKED || p->are_types_assumed || strcmp(text, "canaerospace") == 0
               ? 0
               : wrong(r, "write packed, canaerospace or canaerospace-types-assumed",
                       "is no framing", text);
}

static int take_identifier_mask(struct reader *r, const char *key, const char *text)
{
    long mask;
    if (read_integer(r, key, text, 0, 0x1fffffff, &mask) != 0) {
        return -1;
    }
    if (strcmp(key, "invalid-mask") == 0) {
        r->table->profile.invalid_mask = (uint32_t)mask;
        return 0;
    }
    if (__builtin_popcountl((unsigned long)mask) > 8) {
        return wrong(r, NULL, "has more than 8 bits", key);
    }
    r->table->profile.channel_mask = (uint32_t)mask;
    return 0;
}

/* `key value`. */
static int take_setting(struct reader *r, const char *key, const char *value)
{
    struct bus_table *t = r->table;
    if (*value == '\0') {
        return wrong(r, NULL, "has no value", key);
    }
    if (strcmp(key, "profile") == 0) {
        if (strlen(value) >= BUS_NAME_BYTES || strpbrk(value, "\"\\ |") != NULL) {
            return wrong(r, NULL, "is too long, or has quotes, bars or spaces", "profile");
        }
        snprintf(t->name, sizeof t->name, "%s", value);
        return 0;
    }
    if (strcmp(key, "framing") == 0 && !r->has_framing) {
        return take_framing(r, value);
    }
    if (strcmp(key, "channel-mask") == 0 || strcmp(key, "invalid-mask") == 0) {
        return take_identifier_mask(r, key, value);
    }
    return wrong(r, "profile, framing (once), channel-mask, invalid-mask and item are known",
                 "is not known here", key);
}

/* Without its remark and the blanks around it. A '#' within quotes is no remark. */
static char *trim(char *line)
{
    bool is_quoted = false;
    for (char *c = line; *c != '\0'; c++) {
        is_quoted ^= *c == '"';
        if (*c == '#' && !is_quoted) {
            *c = '\0';
            break;
        }
    }
    line += strspn(line, " \t\r\n");
    size_t length = strlen(line);
    while (length > 0 && strchr(" \t\r\n", line[length - 1]) != NULL) {
        line[--length] = '\0';
    }
    return line;
}

static int take_line(struct reader *r, char *line)
{
    char *key = trim(line);
    if (*key == '\0') {
        return 0;
    }
    char *value = key + strcspn(key, " \t");
    if (*value != '\0') {
        *value++ = '\0';
        value += strspn(value, " \t");
    }
    return strcmp(key, "item") == 0 ? take_item(r, value) : take_setting(r, key, value);
}

/* A backslash at the end of a line joins the next one to it. False at the end of the file. */
static bool read_line(struct reader *r, FILE *in, char *line, int *status)
{
    size_t length = 0;
    line[0] = '\0';
    while (fgets(line + length, (int)(LINE_BYTES - length), in) != NULL) {
        r->line++;
        const size_t added = strlen(line + length);
        length += added;
        if (added == 0 || (line[length - 1] != '\n' && !feof(in))) {
            *status = wrong(r, NULL, "is longer than 1022 bytes, or not text", "line");
            return false;
        }
        while (length > 0 && (line[length - 1] == '\n' || line[length - 1] == '\r')) {
            line[--length] = '\0';
        }
        if (length == 0 || line[length - 1] != '\\') {
            return true;
        }
        line[--length] = '\0';
    }
    return length > 0;
}

int bus_table_read(struct bus_table *table, FILE *in, const char *path)
{
    char line[LINE_BYTES];
    struct reader r = {.table = table, .path = path};
    memset(table, 0, sizeof *table);
    table->profile.rows = table->rows;
    table->profile.name = table->name;
    int status = 0;
    while (status == 0 && read_line(&r, in, line, &status)) {
        status = take_line(&r, line);
    }
    if (status == 0 && ferror(in)) {
        status = hs_error(path, NULL, "cannot be read: %s", strerror(errno));
    }
    if (status == 0 && (table->profile.row_count == 0 || table->name[0] == '\0')) {
        status = wrong(&r, "a table has a profile's name and at least one item", "nothing there",
                       "table");
    }
    return status;
}

int bus_table_load(struct bus_table *table, const char *path)
{
    FILE *in = hs_input_open(path, "r");
    if (in == NULL) {
        return hs_error(path, "name a table as docs/bus.md explains it", "cannot be opened: %s",
                        strerror(errno));
    }
    const int status = bus_table_read(table, in, path);
    fclose(in);
    return status;
}
