#include "classify/error_regions.h"
#include "hs/atomic_file.h"
#include "hs/error.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* What the worst list shows: regions of at least so many exemplars of which less than this part is
 * recognised, so many at most. */
static const double worst_below = 0.9;
enum { WORST_LISTED = 40, WORST_PIXELS = 10 };

int db_report_path(char *path, size_t size, const char *folder, const char *name)
{
    if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
        return hs_error(folder, "create the folder above it first", "cannot be made: %s",
                        strerror(errno));
    }
    const int length = snprintf(path, size, "%s/%s", folder, name);
    if (length < 0 || (size_t)length >= size) {
        return hs_error(folder, "use a shorter name", "is too long a path");
    }
    return 0;
}

/* Everything gathered about one place; the matrix is true x given among the mistaken. */
struct tally {
    uint64_t count, right;
    uint32_t mistaken_for[DB_CLASS_MAX], mistaken[DB_CLASS_MAX];
    uint8_t class_index, part;
};

static void add(struct tally *t, const struct db_exemplar *item, uint8_t given)
{
    t->count++;
    t->class_index = item->class_index;
    t->part = item->part;
    if (given == item->class_index) {
        t->right++;
    } else {
        t->mistaken[item->class_index]++;
        t->mistaken_for[given % DB_CLASS_MAX] += given < DB_CLASS_MAX;
    }
}

static uint8_t commonest(const uint32_t *counts, uint8_t otherwise)
{
    uint8_t best = otherwise;
    uint32_t best_count = 0;
    for (int i = 0; i < DB_CLASS_MAX; i++) {
        if (counts[i] > best_count) {
            best = (uint8_t)i;
            best_count = counts[i];
        }
    }
    return best;
}

static int worst_first(const void *a, const void *b)
{
    const struct db_error_region *p = a, *q = b;
    /* right/count compared without division. */
    const uint64_t x = p->right * q->count, y = q->right * p->count;
    if (x != y) {
        return x < y ? -1 : 1;
    }
    if (p->count != q->count) {
        return p->count > q->count ? -1 : 1;
    }
    return (p->index > q->index) - (p->index < q->index);
}

static struct db_error_region *places_of(const struct tally *tallies, size_t tally_count,
                                         size_t *count)
{
    struct db_error_region *places = malloc((tally_count + 1) * sizeof *places);
    *count = 0;
    for (size_t i = 0; places && i < tally_count; i++) {
        const struct tally *t = &tallies[i];
        if (t->count > 0) {
            places[(*count)++] = (struct db_error_region){
                .index = i,
                .class_index = commonest(t->mistaken, t->class_index),
                .part = t->part,
                .mistaken_for = commonest(t->mistaken_for, DB_CLASS_NODATA),
                .count = t->count,
                .right = t->right,
            };
        }
    }
    if (places) {
        qsort(places, *count, sizeof *places, worst_first);
    }
    return places;
}

struct db_error_region *db_error_regions_by_region(const struct db_exemplar *items,
                                                   const uint8_t *given, size_t item_count,
                                                   size_t region_count, size_t *count)
{
    struct tally *tallies = calloc(region_count + 1, sizeof *tallies);
    struct db_error_region *places = NULL;
    if (tallies) {
        for (size_t i = 0; i < item_count; i++) {
            add(&tallies[items[i].region], &items[i], given[i]);
        }
        places = places_of(tallies, region_count, count);
    }
    free(tallies);
    return places;
}

static size_t squares_across(const struct db_grid *grid, int side)
{
    return ((size_t)grid->width + (size_t)side - 1) / (size_t)side;
}

struct db_error_region *db_error_regions_by_square(const struct db_exemplar *items,
                                                   const uint8_t *given, size_t item_count,
                                                   int side, const struct db_grid *grid,
                                                   size_t *count)
{
    const size_t across = squares_across(grid, side);
    const size_t down = ((size_t)grid->height + (size_t)side - 1) / (size_t)side;
    struct tally *tallies = calloc(across * down, sizeof *tallies);
    struct db_error_region *places = NULL;
    if (tallies) {
        for (size_t i = 0; i < item_count; i++) {
            const size_t at = (size_t)(items[i].y / side) * across + (size_t)(items[i].x / side);
            add(&tallies[at], &items[i], given[i]);
        }
        places = places_of(tallies, across * down, count);
    }
    free(tallies);
    return places;
}

static const char *part_name(uint8_t part)
{
    static const char *const names[] = {"train", "validate", "held-out", "unknown"};
    return part <= DB_PART_UNKNOWN ? names[part] : "?";
}

static const char *class_name(const struct db_class_table *table, uint8_t index)
{
    return index < table->count ? table->items[index].name : "-";
}

static int write_regions(const char *path, const struct db_error_region *places, size_t count,
                         const struct db_region *regions, const struct db_class_table *table)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    fputs("region,label,class,part,first_x,first_y,pixels,recognised,mistaken_for\n", file.stream);
    for (size_t i = 0; i < count; i++) {
        const struct db_region *r = &regions[places[i].index];
        fprintf(file.stream, "%ld,\"%s\",%s,%s,%d,%d,%llu,%.4f,%s\n", r->id, r->label,
                class_name(table, r->class_index), part_name(places[i].part), r->first_x,
                r->first_y, (unsigned long long)places[i].count,
                (double)places[i].right / (double)places[i].count,
                class_name(table, places[i].mistaken_for));
    }
    return hs_atomic_commit(&file);
}

static int write_squares(const char *path, const struct db_error_region *places, size_t count,
                         int side, const struct db_grid *grid, const struct db_class_table *table)
{
    const size_t across = squares_across(grid, side);
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    fputs("x,y,side,pixels,recognised,class,mistaken_for\n", file.stream);
    for (size_t i = 0; i < count; i++) {
        fprintf(
            file.stream, "%zu,%zu,%d,%llu,%.4f,%s,%s\n", places[i].index % across * (size_t)side,
            places[i].index / across * (size_t)side, side, (unsigned long long)places[i].count,
            (double)places[i].right / (double)places[i].count,
            class_name(table, places[i].class_index), class_name(table, places[i].mistaken_for));
    }
    return hs_atomic_commit(&file);
}

static int write_worst(const char *path, const struct db_error_region *places, size_t count,
                       const struct db_region *regions, const struct db_class_table *table)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    fprintf(file.stream,
            "Regions of which less than %.0f %% is recognised, worst first. Look at them in the "
            "image: draw\n"
            "more exemplars like them, or correct them by hand where the bands cannot tell the "
            "classes apart.\n\n",
            100 * worst_below);
    int listed = 0;
    for (size_t i = 0; i < count && listed < WORST_LISTED; i++) {
        const struct db_region *r = &regions[places[i].index];
        const double right = (double)places[i].right / (double)places[i].count;
        if (right < worst_below && places[i].count >= WORST_PIXELS) {
            listed++;
            fprintf(
                file.stream,
                "region %ld (%s, %s) near pixel %d,%d: %.1f %% of %llu recognised, mostly taken "
                "for %s\n",
                r->id, r->label, part_name(places[i].part), r->first_x, r->first_y, 100 * right,
                (unsigned long long)places[i].count, class_name(table, places[i].mistaken_for));
        }
    }
    return hs_atomic_commit(&file);
}

int db_error_regions_write(const char *folder, const struct db_exemplar *items,
                           const uint8_t *given, size_t item_count, const struct db_region *regions,
                           size_t region_count, int side, const struct db_grid *grid,
                           const struct db_class_table *table)
{
    char path[1024];
    size_t count;
    struct db_error_region *places =
        db_error_regions_by_region(items, given, item_count, region_count, &count);
    if (!places) {
        return hs_error(folder, NULL, "out of memory");
    }
    int result = db_report_path(path, sizeof path, folder, "regions.csv");
    if (result == 0) {
        result = write_regions(path, places, count, regions, table);
    }
    if (result == 0 && (result = db_report_path(path, sizeof path, folder, "worst.txt")) == 0) {
        result = write_worst(path, places, count, regions, table);
    }
    free(places);
    places = db_error_regions_by_square(items, given, item_count, side, grid, &count);
    if (result == 0 && (result = db_report_path(path, sizeof path, folder, "squares.csv")) == 0) {
        result = places ? write_squares(path, places, count, side, grid, table)
                        : hs_error(folder, NULL, "out of memory");
    }
    free(places);
    return result;
}
