#include "build/detail.h"

#include "fx/crc32c.h"
#include "hs/angle.h"
#include "hs/error.h"
#include "hs/number.h"
#include "hs/text_file.h"
#include "image/codes.h"
#include "image/grid.h"
#include "lm/db.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { WORDS_MAX = 10 };

static const char building_form[] =
    "building LATITUDE LONGITUDE LENGTH WIDTH TURN HEIGHT flat|gabled";
static const char wall_form[] = "wall LATITUDE LONGITUDE LATITUDE LONGITUDE HEIGHT";
static const char line_form[] =
    "line LATITUDE LONGITUDE LATITUDE LONGITUDE fence|rail|railing|wire";
static const char mast_form[] = "mast LATITUDE LONGITUDE HEIGHT";
static const char strip_form[] = "surface|verge LATITUDE LONGITUDE LATITUDE LONGITUDE WIDTH CLASS";

/* Reflectivity of what a line is, seen along and broadside, dB of gamma. UNSOURCED: a wire shows
 * broadside alone, a bridge's railing most. */
static const struct {
    const char *name;
    double along_db, broadside_db, width_m;
} line_kinds[] = {
    {"fence", -18, 0, 0.1}, {"rail", -15, 5, 1.5}, {"railing", -10, 8, 0.1}, {"wire", -40, 6, 0.1}};

enum { LINE_KINDS = sizeof line_kinds / sizeof *line_kinds };

static const double piece_m = 60; /* longest piece of a line: each belongs to one tile */
static const double wall_width_m = 0.3, mast_width_m = 2;
static const double joint_m = 0.2; /* pieces of a surface overlap by so much */

struct reading {
    struct db_text_file file;
    struct build_detail *detail;
    const struct build_detail_settings *settings;
    uint32_t capacity;
    int structure; /* class number of buildings, or -1 */
};

/* A box that goes into the detail, in degrees and metres. */
struct box {
    double latitude, longitude, length_m, width_m, turn_deg, height_m;
    enum lm_detail_kind kind;
    int line_kind; /* of LM_DETAIL_LINE */
    int ground;    /* class of LM_DETAIL_SURFACE */
    bool is_verge;
};

static bool read_place(char *const *words, double place[2])
{
    return hs_number_within(words[0], -89.9, 89.9, &place[0]) &&
           hs_number_within(words[1], -180, 360, &place[1]);
}

/* ---- boxes to items ---- */

static struct build_detail_item *room_for_item(struct reading *r)
{
    struct build_detail *d = r->detail;
    if (d->count == r->capacity) {
        const uint32_t more = r->capacity ? 2 * r->capacity : 256;
        struct build_detail_item *larger = realloc(d->items, more * sizeof *larger);
        if (!larger) {
            hs_error(r->file.path, NULL, "out of memory");
            return NULL;
        }
        d->items = larger;
        r->capacity = more;
    }
    return &d->items[d->count];
}

static uint16_t decimetres(double metres)
{
    return (uint16_t)fmax(1, fmin(65535, round(10 * metres)));
}

/* A roof or a piece of a surface has the mean reflectivity that its class has at its place. */
static uint8_t class_code(const struct reading *r, const struct box *box, int class_number)
{
    const double roof_m = 20;
    const double radian = 3.14159265358979323846 / 180;
    return image_gamma_code(db_reflect_assign_cell(&r->settings->laws[class_number],
                                                   r->settings->seed, radian * box->latitude,
                                                   radian * box->longitude, roof_m));
}

/* The classes that a surface covers: what is there already keeps its spread. A verge covers what
 * people paved, as bits. */
static uint16_t covered_classes(const struct reading *r, const struct box *box)
{
    const struct db_class_table *table = r->settings->table;
    uint16_t paved = 0;
    for (int i = 0; i < table->count; i++) {
        const bool is_paved = table->items[i].kind == DB_KIND_GROUND && !table->items[i].is_natural;
        paved |= (uint16_t)((unsigned)is_paved << i);
    }
    const unsigned own = 1u << box->ground;
    return (uint16_t)((box->is_verge ? paved : (1u << LM_DB_CLASS_NONE) - 1) & ~own);
}

static void set_surface(struct reading *r, const struct box *box, struct lm_detail_item *item)
{
    item->class_number = (uint8_t)box->ground;
    item->gamma_code = class_code(r, box, box->ground);
    item->glint_code = !box->is_verge;
    item->height_dm = covered_classes(r, box);
}

static int add_box(struct reading *r, const struct box *box)
{
    struct build_detail_item *at = room_for_item(r);
    if (!at) {
        return -1;
    }
    const unsigned shift = r->settings->shift0 + (unsigned)LM_TILE_CELLS_LOG2;
    const uint32_t north = hs_bam(box->latitude) + FX_BAM_90, east = hs_bam(box->longitude);
    const unsigned across = shift + lm_db_zone(hs_bam(box->latitude));
    *at = (struct build_detail_item){
        .row = north >> shift, .column = east >> across, .order = r->detail->count};
    at->item = (struct lm_detail_item){
        .kind = (uint8_t)box->kind,
        .north = (uint16_t)(((uint64_t)north << 16 >> shift) & 0xFFFF),
        .east = (uint16_t)(((uint64_t)east << 16 >> across) & 0xFFFF),
        .length_dm = decimetres(box->length_m),
        .width_dm = decimetres(box->width_m),
        .turn = (uint16_t)(hs_bam(box->turn_deg) >> 16),
        .height_dm = box->kind == LM_DETAIL_LINE ? 0 : decimetres(box->height_m)};
    if (box->kind == LM_DETAIL_LINE) {
        at->item.gamma_code = image_gamma_code(line_kinds[box->line_kind].along_db);
        at->item.glint_code = image_gamma_code(line_kinds[box->line_kind].broadside_db);
    } else if (box->kind == LM_DETAIL_SURFACE) {
        set_surface(r, box, &at->item);
    } else {
        at->item.class_number =
            build_facing_number(r->settings->facing, (uint8_t)r->structure, box->turn_deg);
        at->item.gamma_code = class_code(r, box, r->structure);
    }
    r->detail->reach_m = fmax(r->detail->reach_m, hypot(box->length_m, box->width_m) / 2);
    r->detail->count++;
    return 0;
}

/* Add what runs from one place to another, in pieces. `box` has all but places, length and turn. */
static int add_run(struct reading *r, const double from[2], const double to[2], struct box *box)
{
    const double degree_m = IMAGE_METRES_PER_BAM * 4294967296.0 / 360;
    const double cosine = cos((from[0] + to[0]) / 2 * (3.14159265358979323846 / 180));
    const double north_m = (to[0] - from[0]) * degree_m,
                 east_m = remainder(to[1] - from[1], 360) * degree_m * cosine;
    const double length_m = hypot(north_m, east_m);
    const int pieces = (int)fmax(1, ceil(length_m / piece_m));
    box->length_m = length_m / pieces + (box->kind == LM_DETAIL_SURFACE ? joint_m : 0);
    box->turn_deg = fmod(atan2(east_m, north_m) * (180 / 3.14159265358979323846) + 360, 360);
    for (int i = 0; i < pieces; i++) {
        const double share = (i + 0.5) / pieces;
        box->latitude = from[0] + share * (to[0] - from[0]);
        box->longitude = from[1] + share * remainder(to[1] - from[1], 360);
        if (add_box(r, box) != 0) {
            return -1;
        }
    }
    return 0;
}

/* ---- lines of the file ---- */

static int needs_structure(const struct reading *r)
{
    return r->structure >= 0
               ? 0
               : db_text_error(&r->file, "give a class of the table `kind = structure`",
                               "the class table has no class for what is built");
}

static int read_building(struct reading *r, char *const *words, int count)
{
    double place[2];
    struct box box = {.kind = LM_DETAIL_BLOCK};
    const bool is_gabled = count == 8 && strcmp(words[7], "gabled") == 0;
    if (count != 8 || !read_place(words + 1, place) ||
        !hs_number_within(words[3], 0.1, 2000, &box.length_m) ||
        !hs_number_within(words[4], 0.1, 2000, &box.width_m) ||
        !hs_number_within(words[5], -360, 360, &box.turn_deg) ||
        !hs_number_within(words[6], 0.1, 1000, &box.height_m) ||
        (!is_gabled && strcmp(words[7], "flat") != 0)) {
        return db_text_error(&r->file, building_form,
                             "a number is missing or out of its range, or the roof is none");
    }
    box.latitude = place[0];
    box.longitude = place[1];
    box.kind = is_gabled ? LM_DETAIL_GABLE : LM_DETAIL_BLOCK;
    return needs_structure(r) == 0 ? add_box(r, &box) : -1;
}

static int read_wall(struct reading *r, char *const *words, int count)
{
    double from[2], to[2];
    struct box box = {.kind = LM_DETAIL_BLOCK, .width_m = wall_width_m};
    if (count != 6 || !read_place(words + 1, from) || !read_place(words + 3, to) ||
        !hs_number_within(words[5], 0.1, 1000, &box.height_m)) {
        return db_text_error(&r->file, wall_form, "a number is missing or out of its range");
    }
    return needs_structure(r) == 0 ? add_run(r, from, to, &box) : -1;
}

static int read_line_of_kind(struct reading *r, char *const *words, int count)
{
    double from[2], to[2];
    struct box box = {.kind = LM_DETAIL_LINE, .line_kind = 0};
    while (count == 6 && box.line_kind < LINE_KINDS &&
           strcmp(words[5], line_kinds[box.line_kind].name) != 0) {
        box.line_kind++;
    }
    if (count != 6 || box.line_kind == LINE_KINDS || !read_place(words + 1, from) ||
        !read_place(words + 3, to)) {
        return db_text_error(&r->file, line_form,
                             "a place is missing or out of its range, or the kind is none");
    }
    box.width_m = line_kinds[box.line_kind].width_m;
    return add_run(r, from, to, &box);
}

static int read_mast(struct reading *r, char *const *words, int count)
{
    double place[2];
    struct box box = {.kind = LM_DETAIL_BLOCK, .length_m = mast_width_m, .width_m = mast_width_m};
    if (count != 4 || !read_place(words + 1, place) ||
        !hs_number_within(words[3], 0.1, 1000, &box.height_m)) {
        return db_text_error(&r->file, mast_form, "a number is missing or out of its range");
    }
    box.latitude = place[0];
    box.longitude = place[1];
    return needs_structure(r) == 0 ? add_box(r, &box) : -1;
}

static int read_strip(struct reading *r, char *const *words, int count)
{
    double from[2], to[2];
    struct box box = {.kind = LM_DETAIL_SURFACE, .is_verge = strcmp(words[0], "verge") == 0};
    if (count != 7 || !read_place(words + 1, from) || !read_place(words + 3, to) ||
        !hs_number_within(words[5], 0.1, 1000, &box.width_m)) {
        return db_text_error(&r->file, strip_form, "a number is missing or out of its range");
    }
    box.ground = db_class_find(r->settings->table, words[6]);
    if (box.ground < 0 || r->settings->table->items[box.ground].kind == DB_KIND_STRUCTURE) {
        return db_text_error(&r->file, "name a class of the ground, vegetation or water",
                             "`%s` is no class of the table, or one of structures", words[6]);
    }
    return add_run(r, from, to, &box);
}

static int read_line(struct reading *r)
{
    static const struct {
        const char *name;
        int (*read)(struct reading *r, char *const *words, int count);
    } forms[] = {{"building", read_building}, {"wall", read_wall},     {"line", read_line_of_kind},
                 {"mast", read_mast},         {"surface", read_strip}, {"verge", read_strip}};
    char *words[WORDS_MAX];
    const int count = db_text_words(r->file.line, words, WORDS_MAX);
    if (count > WORDS_MAX) {
        return db_text_error(&r->file, NULL, "more than %d words", WORDS_MAX);
    }
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        if (strcmp(words[0], forms[i].name) == 0) {
            return forms[i].read(r, words, count);
        }
    }
    return db_text_error(&r->file, "begin with building, wall, line, mast, surface or verge",
                         "\"%s\" is none of these", words[0]);
}

/* ---- the section ---- */

static int compare_u32(uint32_t a, uint32_t b)
{
    return (a > b) - (a < b);
}

/* Surfaces lie under all else, in their order. */
static uint32_t height_of(const struct lm_detail_item *item)
{
    return item->kind == LM_DETAIL_SURFACE ? 0 : item->height_dm;
}

/* By tile; in a tile from low to high, so that a tower on a hall covers it. */
static int compare_items(const void *first, const void *second)
{
    const struct build_detail_item *a = first, *b = second;
    const uint32_t keys[4][2] = {{a->row, b->row},
                                 {a->column, b->column},
                                 {height_of(&a->item), height_of(&b->item)},
                                 {a->order, b->order}};
    for (int i = 0; i < 4; i++) {
        const int order = compare_u32(keys[i][0], keys[i][1]);
        if (order != 0) {
            return order;
        }
    }
    return 0;
}

static uint32_t end_of_tile(const struct build_detail *d, uint32_t first)
{
    uint32_t end = first;
    while (end < d->count && d->items[end].row == d->items[first].row &&
           d->items[end].column == d->items[first].column) {
        end++;
    }
    return end;
}

static uint32_t units_for(uint32_t items)
{
    const uint32_t bytes = LM_DETAIL_HEAD_BYTES + items * LM_DETAIL_ITEM_BYTES;
    return (bytes + LM_DETAIL_UNIT_BYTES - 1) / LM_DETAIL_UNIT_BYTES;
}

static void write_record(const struct build_detail *d, uint32_t first, uint32_t end,
                         const struct build_detail_record *record)
{
    static struct lm_detail r; /* 8 KiB */
    const struct build_detail_item *items = d->items;
    memset(&r, 0, sizeof r);
    r.row = record->row;
    r.column = record->column;
    r.zone = (uint8_t)lm_db_zone((record->row << d->side_log2) - FX_BAM_90);
    r.count = (uint16_t)(end - first);
    for (uint32_t i = first; i < end; i++) {
        r.items[i - first] = items[i].item;
    }
    const size_t bytes = (size_t)record->units * LM_DETAIL_UNIT_BYTES;
    r.crc = fx_crc32c(0, (const uint8_t *)&r + 4, bytes - 4);
    memcpy(d->section + (size_t)record->place * LM_DETAIL_UNIT_BYTES, &r, bytes);
}

/* Lay out the records: how many units each tile takes, and where they begin. */
static int lay_out(struct build_detail *d, const char *path)
{
    uint32_t place = 0;
    d->records = calloc(d->count + 1u, sizeof *d->records);
    if (!d->records) {
        return hs_error(path, NULL, "out of memory");
    }
    for (uint32_t first = 0, end; first < d->count; first = end) {
        end = end_of_tile(d, first);
        if (end - first > LM_DETAIL_ITEMS_MAX) {
            return hs_error(path,
                            "give `build` a smaller --cell, down to half of this one, or leave "
                            "some out",
                            "has %u items in the tile of row %u, column %u; it holds %d",
                            end - first, d->items[first].row, d->items[first].column,
                            LM_DETAIL_ITEMS_MAX);
        }
        d->records[d->record_count++] =
            (struct build_detail_record){d->items[first].row, d->items[first].column, place,
                                         units_for(end - first), end - first};
        place += units_for(end - first);
    }
    d->section_bytes = (size_t)place * LM_DETAIL_UNIT_BYTES;
    d->section = calloc(d->section_bytes + 1, 1);
    return d->section ? 0 : hs_error(path, NULL, "out of memory");
}

static int make_section(struct build_detail *d, const char *path)
{
    if (d->count > 0) { /* an empty file has no array either */
        qsort(d->items, d->count, sizeof *d->items, compare_items);
    }
    if (lay_out(d, path) != 0) {
        return -1;
    }
    uint32_t first = 0;
    for (uint32_t i = 0; i < d->record_count; i++) {
        const uint32_t end = end_of_tile(d, first);
        write_record(d, first, end, &d->records[i]);
        first = end;
    }
    return 0;
}

static int first_structure(const struct db_class_table *table)
{
    for (int i = 0; i < table->count; i++) {
        if (table->items[i].kind == DB_KIND_STRUCTURE) {
            return i;
        }
    }
    return -1;
}

int build_detail_read(struct build_detail *d, const char *path,
                      const struct build_detail_settings *settings)
{
    struct reading r = {
        .detail = d, .settings = settings, .structure = first_structure(settings->table)};
    *d = (struct build_detail){.side_log2 =
                                   (uint8_t)(settings->shift0 + (unsigned)LM_TILE_CELLS_LOG2)};
    int step = db_text_open(&r.file, path) == 0 ? 1 : -1;
    while (step > 0) {
        step = db_text_next(&r.file);
        if (step > 0 && read_line(&r) != 0) {
            step = -1;
        }
    }
    db_text_close(&r.file);
    if (step < 0 || make_section(d, path) != 0) {
        build_detail_free(d);
        return -1;
    }
    return 0;
}

struct build_detail_record build_detail_of_tile(const struct build_detail *d, uint32_t row,
                                                uint32_t column)
{
    uint32_t low = 0, high = d->record_count;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        const struct build_detail_record *r = &d->records[middle];
        if (r->row == row && r->column == column) {
            return *r;
        }
        const bool is_before = r->row < row || (r->row == row && r->column < column);
        low = is_before ? middle + 1 : low;
        high = is_before ? high : middle;
    }
    return (struct build_detail_record){.row = row, .column = column};
}

void build_detail_free(struct build_detail *d)
{
    free(d->items);
    free(d->section);
    free(d->records);
    *d = (struct build_detail){0};
}
