#include "gis/code_map.h"

#include "gis/band_walk.h"
#include "hs/error.h"
#include "hs/number.h"
#include "hs/text_file.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the file ---- */

/* "7" or "7-9", and nothing else. */
static bool read_codes(const char *text, int *low, int *high)
{
    double number[2];
    char first[16];
    const size_t length = strcspn(text, "-");
    if (length >= sizeof first) {
        return false;
    }
    memcpy(first, text, length);
    first[length] = '\0';
    const char *last = text[length] == '-' ? text + length + 1 : first;
    if (!hs_number_within(first, 0, DB_CODES - 1, &number[0]) ||
        !hs_number_within(last, number[0], DB_CODES - 1, &number[1])) {
        return false;
    }
    *low = (int)number[0];
    *high = (int)number[1];
    return number[0] == *low && number[1] == *high;
}

static int take_codes(const struct db_text_file *f, struct db_code_map *map)
{
    const struct db_code_line *line = &map->lines[map->count];
    for (int code = line->low; code <= line->high; code++) {
        if (map->line_of[code] >= 0) {
            return db_text_error(f, "remove one of the two", "code %d is mapped twice", code);
        }
        map->line_of[code] = (int16_t)map->count;
    }
    map->count++;
    return 0;
}

static int read_line(const struct db_text_file *f, struct db_code_map *map,
                     const struct db_class_table *table)
{
    char *codes, *name;
    if (db_text_split(f->line, &codes, &name) != 0) {
        return db_text_error(f, "write CODE = CLASS", "this line maps nothing");
    }
    if (map->count == DB_CODE_LINES_MAX) {
        return db_text_error(f, "join codes to LOW-HIGH", "there are more than %d lines",
                             DB_CODE_LINES_MAX);
    }
    struct db_code_line *line = &map->lines[map->count];
    if (!read_codes(codes, &line->low, &line->high)) {
        return db_text_error(f, "write a whole number 0..65535, or LOW-HIGH", "`%s` is no code",
                             codes);
    }
    const bool is_none = strcmp(name, "none") == 0;
    line->class_index = is_none ? DB_CLASS_NODATA : db_class_find(table, name);
    if (line->class_index < 0) {
        char names[DB_CLASS_MAX * DB_NAME_SIZE];
        db_class_names(table, names, sizeof names);
        return db_text_error(f, "name one of them, or none, or take classes/landcover.classes",
                             "there is no class `%s` in the class table; it has %s", name, names);
    }
    snprintf(line->legend, sizeof line->legend, "%s", f->remark);
    return take_codes(f, map);
}

int db_code_map_read(struct db_code_map *map, const char *path, const struct db_class_table *table)
{
    struct db_text_file f;
    map->count = 0;
    map->unknown_class = DB_CODE_UNKNOWN;
    memset(map->line_of, 0xFF, sizeof map->line_of); /* DB_CODE_UNKNOWN, -1 */
    int more = db_text_open(&f, path) == 0 ? 1 : -1;
    while (more > 0) {
        more = db_text_next(&f);
        if (more > 0 && read_line(&f, map, table) != 0) {
            more = -1;
        }
    }
    db_text_close(&f);
    if (more == 0 && map->count == 0) {
        return hs_error(path, "write lines of CODE = CLASS", "maps no code");
    }
    return more;
}

int db_code_map_class(const struct db_code_map *map, long code)
{
    const int line = code >= 0 && code < DB_CODES ? map->line_of[code] : DB_CODE_UNKNOWN;
    return line >= 0 ? map->lines[line].class_index : map->unknown_class;
}

/* ---- the survey ---- */

enum { NAMED_MAX = 12 };

struct census {
    uint64_t counts[DB_CODES];
    uint64_t pixels, nodata, beyond; /* beyond: no code, below 0 or above 65535 */
    double nodata_value;
    int has_nodata;
};

static bool count_pixels(void *context, const void *block, size_t count)
{
    struct census *c = context;
    const int32_t *pixels = block;
    for (size_t i = 0; i < count; i++) {
        if (c->has_nodata && pixels[i] == c->nodata_value) {
            c->nodata++;
        } else if (pixels[i] < 0 || pixels[i] >= DB_CODES) {
            c->beyond++;
        } else {
            c->counts[pixels[i]]++;
        }
    }
    c->pixels += count;
    return true;
}

static int count_codes(struct census *c, GDALRasterBandH band, const char *path)
{
    const GDALDataType type = GDALGetRasterDataType(band);
    if (GDALDataTypeIsFloating(type) || GDALDataTypeIsComplex(type)) {
        return hs_error(path, "give the land cover itself; --map is for codes",
                        "holds %s values, and codes are whole numbers", GDALGetDataTypeName(type));
    }
    c->nodata_value = GDALGetRasterNoDataValue(band, &c->has_nodata);
    const struct db_band_walk walk = {GDT_Int32, "codes", "the file may be cut short; get it again",
                                      count_pixels, c};
    return db_band_walk(band, path, &walk);
}

static double share(const struct census *c, uint64_t pixels)
{
    return 100.0 * (double)pixels / (double)c->pixels;
}

static const char *class_name(const struct db_class_table *table, int class_index)
{
    return class_index == DB_CLASS_NODATA   ? "none"
           : class_index == DB_CODE_UNKNOWN ? "?"
                                            : table->items[class_index].name;
}

static void print_census(const struct census *c, const struct db_code_map *map,
                         const struct db_class_table *table)
{
    for (int code = 0; code < DB_CODES; code++) {
        if (c->counts[code] > 0) {
            const int line = map->line_of[code];
            printf("code %-5d %12" PRIu64 " pixels  %5.1f %%  %-12s %s\n", code, c->counts[code],
                   share(c, c->counts[code]), class_name(table, db_code_map_class(map, code)),
                   line >= 0 ? map->lines[line].legend : "(not in the map)");
        }
    }
    if (c->nodata > 0) {
        printf("no data    %12" PRIu64 " pixels  %5.1f %%\n", c->nodata, share(c, c->nodata));
    }
}

/* Name the unknown codes with their shares; how many pixels have one. */
static uint64_t name_unknown(const struct census *c, const struct db_code_map *map, char *text,
                             size_t size)
{
    uint64_t pixels = 0;
    int named = 0;
    size_t used = 0;
    text[0] = '\0';
    for (int code = 0; code < DB_CODES; code++) {
        if (c->counts[code] == 0 || map->line_of[code] >= 0) {
            continue;
        }
        pixels += c->counts[code];
        if (named++ < NAMED_MAX && used < size) {
            used += (size_t)snprintf(text + used, size - used, "%s%d (%" PRIu64 ")",
                                     named > 1 ? ", " : "", code, c->counts[code]);
        }
    }
    if (named > NAMED_MAX && used < size) {
        snprintf(text + used, size - used, " and %d more", named - NAMED_MAX);
    }
    return pixels;
}

static int judge_unknown(const struct census *c, const struct db_code_map *map,
                         const struct db_class_table *table, const char *path)
{
    char names[NAMED_MAX * 32 + 32];
    const uint64_t unknown = name_unknown(c, map, names, sizeof names);
    if (c->beyond > 0) {
        return hs_error(path, "check that it is a land cover",
                        "has %" PRIu64 " pixels below 0 or above 65535: no codes", c->beyond);
    }
    if (unknown == 0) {
        return 0;
    }
    if (map->unknown_class == DB_CODE_UNKNOWN) {
        return hs_error(path,
                        "add them to the map, or say --unknown-codes CLASS or --unknown-codes none",
                        "%" PRIu64 " pixels (%.2f %%) have codes that the map does not name: %s",
                        unknown, share(c, unknown), names);
    }
    return hs_warn(path, NULL, "%" PRIu64 " pixels (%.2f %%) have unknown codes, taken for %s: %s",
                   unknown, share(c, unknown), class_name(table, map->unknown_class), names);
}

int db_code_map_survey(const struct db_code_map *map, const struct db_class_table *table,
                       GDALRasterBandH band, const char *path)
{
    struct census *c = calloc(1, sizeof *c);
    if (!c) {
        return hs_error(path, NULL, "out of memory");
    }
    int result = count_codes(c, band, path);
    if (result == 0) {
        print_census(c, map, table);
        result = judge_unknown(c, map, table, path);
    }
    free(c);
    return result;
}
