#include "classify/exemplars.h"

#include "components.h"

#include "hs/error.h"
#include "hs/progress.h"
#include "hs/report.h"
#include "hs/rng.h"

#include <stdlib.h>
#include <string.h>

/* A fair draw of at most `cap` pixels of each class from a stream of unknown length (reservoir
 * sampling, algorithm R: Vitter, ACM TOMS 11, 1985, p. 38). */
struct reservoir {
    struct db_exemplar *items; /* owned */
    size_t count, capacity;
};

struct sampler {
    struct reservoir classes[DB_CLASS_MAX];
    uint64_t seen[DB_CLASS_MAX];
    size_t cap;
    struct hs_rng rng;
    uint8_t *ignored; /* owned; NULL, or one bit a pixel of the image, row by row */
    uint16_t *claims; /* owned; of a pixel of the image a bit a class whose polygons claim it */
    size_t width;
};

_Static_assert(DB_CLASS_MAX <= 16, "a bit a class");

static bool is_ignored(const struct sampler *s, int x, int y)
{
    const size_t bit = (size_t)y * s->width + (size_t)x;
    return s->ignored && s->ignored[bit / 8] >> bit % 8 & 1;
}

static void sampler_free(struct sampler *s)
{
    for (int i = 0; i < DB_CLASS_MAX; i++) {
        free(s->classes[i].items);
    }
    free(s->ignored);
    free(s->claims);
}

/* Whether polygons of the class have had the pixel before: it counts once. */
static bool is_claimed(struct sampler *s, int x, int y, int class_index)
{
    uint16_t *claims = &s->claims[(size_t)y * s->width + (size_t)x];
    const bool result = *claims >> class_index & 1;
    *claims |= (uint16_t)(1 << class_index);
    return result;
}

static int sampler_add(struct sampler *s, struct db_exemplar item)
{
    struct reservoir *r = &s->classes[item.class_index];
    const uint64_t seen = ++s->seen[item.class_index];
    if (r->count == s->cap) {
        const double place = hs_rng_uniform(&s->rng) * (double)seen;
        if (place < (double)s->cap) {
            r->items[(size_t)place] = item;
        }
        return 0;
    }
    if (r->count == r->capacity) {
        const size_t capacity = 2 * r->capacity + 1024;
        struct db_exemplar *items = realloc(r->items, capacity * sizeof *items);
        if (!items) {
            return -1;
        }
        r->items = items;
        r->capacity = capacity;
    }
    r->items[r->count++] = item;
    return 0;
}

/* How often each label turned up that the map leaves out or ignores. */
struct left_out {
    struct {
        char label[DB_LABEL_SIZE];
        bool is_ignored; /* as told */
        uint64_t count;
    } items[DB_MAP_MAX];
    int count;
    uint64_t others; /* of labels beyond the first DB_MAP_MAX */
};

static void count_left_out(struct left_out *l, const struct db_label_map *map, const char *label,
                           uint64_t count)
{
    for (int i = 0; i < l->count; i++) {
        if (strcmp(l->items[i].label, label) == 0) {
            l->items[i].count += count;
            return;
        }
    }
    if (l->count == DB_MAP_MAX) {
        l->others += count;
        return;
    }
    strcpy(l->items[l->count].label, label);
    l->items[l->count].is_ignored = db_label_map_is_ignored(map, label);
    l->items[l->count++].count = count;
}

/* Numbers are near each other without being misspelt. */
static bool is_number(const char *label)
{
    return label[strspn(label, "0123456789")] == '\0';
}

/* A label that is nearly one of the map is likely to be meant for it. */
static void report_left_out(const struct left_out *l, const struct db_label_map *map)
{
    hs_report_array("labels_left_out");
    for (int i = 0; i < l->count; i++) {
        const char *label = l->items[i].label;
        const char *nearest = l->items[i].is_ignored ? NULL : db_label_map_nearest(map, label);
        printf("label `%s`: %s, %llu pixels ignored\n", label,
               l->items[i].is_ignored ? "to be ignored" : "not mapped",
               (unsigned long long)l->items[i].count);
        hs_report_object(NULL);
        hs_report_put("label", label);
        hs_report_flag("is_ignored", (bool)l->items[i].is_ignored);
        hs_report_put("pixels", (uint64_t)l->items[i].count);
        hs_report_close();
        if (nearest && !is_number(label)) {
            hs_warn(label, "correct its spelling, or say --ignore", "is not mapped, but `%s` is",
                    nearest);
        }
    }
    hs_report_close();
    if (l->others > 0) {
        hs_report_put("further_labels_pixels", (uint64_t)l->others);
        printf("further labels: not mapped, %llu pixels ignored\n", (unsigned long long)l->others);
    }
}

static int compare_pixels(const void *a, const void *b)
{
    const struct db_exemplar *p = a, *q = b;
    if (p->y != q->y) {
        return p->y < q->y ? -1 : 1;
    }
    if (p->x != q->x) {
        return p->x < q->x ? -1 : 1;
    }
    return (p->region > q->region) - (p->region < q->region);
}

/* Overlapping polygons claim a pixel more than once: keep it once when they agree, and not at all
 * when they do not. */
static void drop_doubles(struct db_exemplars *e)
{
    size_t kept = 0;
    for (size_t i = 0; i < e->count;) {
        size_t next = i + 1;
        bool agree = true;
        while (next < e->count && e->items[next].x == e->items[i].x &&
               e->items[next].y == e->items[i].y) {
            agree = agree && e->items[next].class_index == e->items[i].class_index;
            next++;
        }
        if (agree) {
            e->items[kept++] = e->items[i];
        } else {
            e->conflicting++;
        }
        i = next;
    }
    e->count = kept;
}

static int gather(struct db_exemplars *e, const struct sampler *s)
{
    for (int i = 0; i < DB_CLASS_MAX; i++) {
        e->count += s->classes[i].count;
        e->available[i] = s->seen[i];
    }
    e->items = malloc((e->count + 1) * sizeof *e->items);
    if (!e->items) {
        return -1;
    }
    size_t used = 0;
    for (int i = 0; i < DB_CLASS_MAX; i++) {
        if (s->classes[i].count > 0) {
            memcpy(e->items + used, s->classes[i].items, s->classes[i].count * sizeof *e->items);
            used += s->classes[i].count;
        }
    }
    qsort(e->items, e->count, sizeof *e->items, compare_pixels);
    drop_doubles(e);
    return 0;
}

/* A span of one polygon on its way into the sampler. */
struct span_sink {
    struct sampler *sampler;
    uint32_t region;
    uint8_t class_index;
    uint64_t pixels;
};

static int take_span(void *context, int y, int x_begin, int x_end)
{
    struct span_sink *sink = context;
    sink->pixels += (uint64_t)(x_end - x_begin);
    for (int x = x_begin; x < x_end; x++) {
        const struct db_exemplar item = {x, y, sink->region, sink->class_index, DB_PART_TRAIN};
        if (!is_ignored(sink->sampler, x, y) &&
            !is_claimed(sink->sampler, x, y, sink->class_index) &&
            sampler_add(sink->sampler, item) != 0) {
            return -1;
        }
    }
    return 0;
}

static int count_span(void *context, int y, int x_begin, int x_end)
{
    (void)y;
    *(uint64_t *)context += (uint64_t)(x_end - x_begin);
    return 0;
}

static int ignore_span(void *context, int y, int x_begin, int x_end)
{
    const struct sampler *s = context;
    for (int x = x_begin; x < x_end; x++) {
        const size_t bit = (size_t)y * s->width + (size_t)x;
        s->ignored[bit / 8] |= (uint8_t)(1 << bit % 8);
    }
    return 0;
}

/* Mark the pixels under ignored polygons before any other is looked at: a cloud hides what lies
 * under it, whoever else claims that. */
static int mark_ignored(struct sampler *s, const struct db_polygons *polygons,
                        const struct db_label_map *map, const struct db_grid *grid)
{
    s->width = (size_t)grid->width;
    /* Pages that no polygon touches cost no memory. */
    s->claims = calloc(s->width * (size_t)grid->height, sizeof *s->claims);
    if (!s->claims) {
        return -1;
    }
    for (size_t i = 0; i < polygons->count; i++) {
        const struct db_polygon *p = &polygons->items[i];
        if (!db_label_map_is_ignored(map, p->label)) {
            continue;
        }
        if (!s->ignored) {
            s->ignored = calloc(s->width * (size_t)grid->height / 8 + 1, 1);
        }
        if (!s->ignored || db_polygon_walk(p, 0, grid->height, grid->width, ignore_span, s) != 0) {
            return -1;
        }
    }
    return 0;
}

static int sample_polygon(struct sampler *s, const struct db_polygon *polygon, uint32_t region,
                          const struct db_label_map *map, const struct db_grid *grid,
                          struct left_out *left)
{
    const int class_index = db_label_map_find(map, polygon->label);
    uint64_t pixels = 0;
    if (class_index < 0) {
        const int result =
            db_polygon_walk(polygon, 0, grid->height, grid->width, count_span, &pixels);
        count_left_out(left, map, polygon->label, pixels);
        return result;
    }
    struct span_sink sink = {s, region, (uint8_t)class_index, 0};
    const int result = db_polygon_walk(polygon, 0, grid->height, grid->width, take_span, &sink);
    if (result == 0 && sink.pixels == 0) {
        char place[96];
        snprintf(place, sizeof place, "polygon %ld (%s)", polygon->id, polygon->label);
        hs_warn(place, "check its CRS, or draw it around some pixel centres",
                "covers no pixel of the image");
    }
    return result;
}

/* Without a map every label was meant to be a class. */
static int check_labels(const struct db_polygons *polygons, const struct db_exemplar_source *source)
{
    for (size_t i = 0; i < polygons->count && source->map->is_default; i++) {
        const struct db_polygon *p = &polygons->items[i];
        if (db_label_map_find(source->map, p->label) >= 0 ||
            db_label_map_is_ignored(source->map, p->label)) {
            continue;
        }
        char names[DB_CLASS_MAX * DB_NAME_SIZE];
        const char *nearest = db_label_map_nearest(source->map, p->label);
        db_class_names(source->table, names, sizeof names);
        return hs_error(source->polygons_path,
                        "correct the label, leave it out with --ignore, or give a --map",
                        "polygon %ld has the label `%s`, which is no class%s%s%s; there are %s",
                        p->id, p->label, nearest ? "; did you mean `" : "", nearest ? nearest : "",
                        nearest ? "`?" : "", names);
    }
    return 0;
}

static int name_regions_by_polygon(struct db_exemplars *e, const struct db_polygons *polygons,
                                   const struct db_label_map *map)
{
    e->regions = calloc(polygons->count, sizeof *e->regions);
    if (!e->regions) {
        return -1;
    }
    e->region_count = polygons->count;
    for (size_t i = 0; i < polygons->count; i++) {
        e->regions[i].id = polygons->items[i].id;
        memcpy(e->regions[i].label, polygons->items[i].label, DB_LABEL_SIZE);
        const int class_index = db_label_map_find(map, polygons->items[i].label);
        e->regions[i].class_index = class_index < 0 ? DB_CLASS_NODATA : (uint8_t)class_index;
    }
    return 0;
}

static int sample_polygons(struct db_exemplars *e, struct sampler *s,
                           const struct db_exemplar_source *source,
                           const struct db_polygons *polygons, const struct db_grid *grid)
{
    struct left_out left = {0};
    int result = mark_ignored(s, polygons, source->map, grid);
    for (size_t i = 0; result == 0 && i < polygons->count; i++) {
        result = sample_polygon(s, &polygons->items[i], (uint32_t)i, source->map, grid, &left);
    }
    if (result != 0 || gather(e, s) != 0 ||
        name_regions_by_polygon(e, polygons, source->map) != 0) {
        return hs_error(source->polygons_path, NULL, "out of memory");
    }
    report_left_out(&left, source->map);
    return 0;
}

static int find_in_polygons(struct db_exemplars *e, struct sampler *s,
                            const struct db_exemplar_source *source, const struct db_grid *grid)
{
    struct db_polygons polygons;
    if (db_polygons_read(&polygons, source->polygons_path, source->field, grid) != 0) {
        return -1;
    }
    int result = check_labels(&polygons, source);
    if (result == 0) {
        result = sample_polygons(e, s, source, &polygons, grid);
    }
    db_polygons_free(&polygons);
    return result;
}

/* What one pass over a label raster works with. */
struct label_pass {
    struct db_label_rows rows;
    struct db_components components;
    int32_t *labels;   /* owned */
    uint32_t *numbers; /* owned */
    uint64_t *pixels;  /* owned: of each label below LABELS_COUNTED */
    int16_t *class_of; /* owned: of each label below LABELS_COUNTED, or -1 */
};

enum { LABELS_COUNTED = 1 << 16 };

static void label_pass_close(struct label_pass *pass)
{
    db_label_rows_close(&pass->rows);
    db_components_free(&pass->components);
    free(pass->labels);
    free(pass->numbers);
    free(pass->pixels);
    free(pass->class_of);
}

static int label_pass_open(struct label_pass *pass, const struct db_exemplar_source *source,
                           const struct db_grid *grid)
{
    *pass = (struct label_pass){0};
    if (db_label_rows_open(&pass->rows, source->labels_path, grid) != 0) {
        return -1;
    }
    pass->labels = malloc((size_t)grid->width * sizeof *pass->labels);
    pass->numbers = malloc((size_t)grid->width * sizeof *pass->numbers);
    pass->pixels = calloc(LABELS_COUNTED, sizeof *pass->pixels);
    pass->class_of = malloc(LABELS_COUNTED * sizeof *pass->class_of);
    if (!pass->labels || !pass->numbers || !pass->pixels || !pass->class_of ||
        db_components_init(&pass->components, grid->width) != 0) {
        label_pass_close(pass);
        return hs_error(source->labels_path, NULL, "out of memory");
    }
    for (int i = 0; i < LABELS_COUNTED; i++) {
        char label[16];
        snprintf(label, sizeof label, "%d", i);
        pass->class_of[i] = (int16_t)db_label_map_find(source->map, label);
    }
    return 0;
}

/* Read a row, count its labels, and blank those the map leaves out. */
static int read_mapped_row(struct label_pass *pass, int y, bool count)
{
    if (db_label_rows_read(&pass->rows, y, pass->labels) != 0) {
        return -1;
    }
    for (int x = 0; x < pass->rows.width; x++) {
        const int32_t label = pass->labels[x];
        if (label < 0 || label >= LABELS_COUNTED) {
            pass->labels[x] = -1;
            continue;
        }
        pass->pixels[label] += count;
        if (pass->class_of[label] < 0) {
            pass->labels[x] = -1;
        }
    }
    return 0;
}

static int number_row(struct label_pass *pass, int learn)
{
    if (db_components_row(&pass->components, pass->labels, pass->numbers, learn) != 0) {
        return hs_error(pass->rows.raster.name, "sieve the labels, or give polygons",
                        "holds too many separate patches");
    }
    return 0;
}

static int sample_row(struct label_pass *pass, struct sampler *s, int y)
{
    for (int x = 0; x < pass->rows.width; x++) {
        if (pass->labels[x] < 0) {
            continue;
        }
        const struct db_exemplar item = {x, y, pass->numbers[x],
                                         (uint8_t)pass->class_of[pass->labels[x]], DB_PART_TRAIN};
        if (sampler_add(s, item) != 0) {
            return hs_error(pass->rows.raster.name, NULL, "out of memory");
        }
    }
    return 0;
}

static int walk_labels(struct label_pass *pass, struct sampler *s)
{
    const int height = pass->rows.height;
    struct hs_progress progress;
    hs_progress_begin(&progress, "labels", 2 * (uint64_t)height);
    int result = 0;
    for (int step = 0; result == 0 && step < 2 * height; step++) {
        const int y = step % height, learn = step < height;
        if (step == height) {
            db_components_rewind(&pass->components);
        }
        result = read_mapped_row(pass, y, learn);
        if (result == 0) {
            result = number_row(pass, learn);
        }
        if (result == 0 && !learn) {
            result = sample_row(pass, s, y);
        }
        hs_progress_update(&progress, (uint64_t)step + 1);
    }
    hs_progress_end(&progress);
    return result;
}

static int compare_numbers(const void *a, const void *b)
{
    const uint32_t p = *(const uint32_t *)a, q = *(const uint32_t *)b;
    return (p > q) - (p < q);
}

/* Patch numbers become indices of the regions that hold an exemplar. */
static int name_regions_by_patch(struct db_exemplars *e)
{
    uint32_t *numbers = malloc((e->count + 1) * sizeof *numbers);
    e->regions = calloc(e->count + 1, sizeof *e->regions);
    if (!numbers || !e->regions) {
        free(numbers);
        return -1;
    }
    for (size_t i = 0; i < e->count; i++) {
        numbers[i] = e->items[i].region;
    }
    qsort(numbers, e->count, sizeof *numbers, compare_numbers);
    for (size_t i = 0; i < e->count; i++) {
        if (i == 0 || numbers[i] != numbers[i - 1]) {
            numbers[e->region_count++] = numbers[i];
        }
    }
    for (size_t i = 0; i < e->count; i++) {
        const uint32_t *place = bsearch(&e->items[i].region, numbers, e->region_count,
                                        sizeof *numbers, compare_numbers);
        e->items[i].region = (uint32_t)(place - numbers);
        struct db_region *region = &e->regions[place - numbers];
        region->id = (long)(place - numbers) + 1;
        region->class_index = e->items[i].class_index;
    }
    free(numbers);
    return 0;
}

/* A patch is known by its class name: the label itself is no longer at hand. */
static void label_patches(struct db_exemplars *e, const struct db_class_table *table)
{
    for (size_t i = 0; i < e->region_count; i++) {
        struct db_region *region = &e->regions[i];
        snprintf(region->label, sizeof region->label, "%s", table->items[region->class_index].name);
    }
}

static int find_in_labels(struct db_exemplars *e, struct sampler *s,
                          const struct db_exemplar_source *source, const struct db_grid *grid)
{
    struct label_pass pass;
    if (label_pass_open(&pass, source, grid) != 0) {
        return -1;
    }
    int result = walk_labels(&pass, s);
    struct left_out left = {0};
    for (int i = 0; i < LABELS_COUNTED; i++) {
        if (pass.pixels[i] > 0 && pass.class_of[i] < 0) {
            char label[DB_LABEL_SIZE];
            snprintf(label, sizeof label, "%d", i);
            count_left_out(&left, source->map, label, pass.pixels[i]);
        }
    }
    label_pass_close(&pass);
    if (result == 0 && (gather(e, s) != 0 || name_regions_by_patch(e) != 0)) {
        result = hs_error(source->labels_path, NULL, "out of memory");
    }
    if (result == 0) {
        label_patches(e, source->table);
        report_left_out(&left, source->map);
    }
    return result;
}

static void count_regions(struct db_exemplars *e)
{
    for (size_t i = 0; i < e->count; i++) {
        struct db_region *region = &e->regions[e->items[i].region];
        if (region->count++ == 0) {
            region->first_x = e->items[i].x;
            region->first_y = e->items[i].y;
        }
    }
}

/* Every class the map names must have come out of the source. Without a map each class stands for
 * itself, and those that are absent are simply not learnt. */
static int check_classes(const struct db_exemplars *e, const struct db_exemplar_source *source,
                         const char *path)
{
    uint64_t kept[DB_CLASS_MAX] = {0};
    int present = 0;
    for (size_t i = 0; i < e->count; i++) {
        present += kept[e->items[i].class_index]++ == 0;
    }
    for (int i = 0; i < source->map->count; i++) {
        const int c = source->map->items[i].class_index;
        if (c < 0) {
            continue;
        }
        const char *name = source->table->items[c].name, *label = source->map->items[i].label;
        if (e->available[c] == 0 && !source->map->is_default) {
            return hs_error(path, "check the label's spelling, or drop the line from the map",
                            "class `%s` has no exemplar pixel: label `%s` covers none", name,
                            label);
        }
        if (e->available[c] > 0 && kept[c] == 0) {
            return hs_error(path, "draw the polygons apart",
                            "class `%s` has no pixel that another class does not claim too", name);
        }
    }
    if (present < 2) {
        return hs_error(path, "check --field, --map and the CRS",
                        "exemplars of %d classes lie in the image; at least two are needed",
                        present);
    }
    return 0;
}

int db_exemplars_find(struct db_exemplars *e, const struct db_exemplar_source *source,
                      const struct db_grid *grid)
{
    *e = (struct db_exemplars){0};
    struct sampler s = {.cap = (size_t)source->per_class};
    hs_rng_seed(&s.rng, source->seed);
    const char *path = source->labels_path ? source->labels_path : source->polygons_path;
    int result = source->labels_path ? find_in_labels(e, &s, source, grid)
                                     : find_in_polygons(e, &s, source, grid);
    sampler_free(&s);
    if (result == 0) {
        count_regions(e);
        if (e->conflicting > 0) {
            hs_warn(path, "draw the polygons apart",
                    "%llu pixels lie in polygons of two classes "
                    "and are left out",
                    (unsigned long long)e->conflicting);
        }
        result = check_classes(e, source, path);
    }
    if (result != 0) {
        db_exemplars_free(e);
    }
    return result;
}

void db_exemplars_free(struct db_exemplars *e)
{
    free(e->items);
    free(e->regions);
    *e = (struct db_exemplars){0};
}
