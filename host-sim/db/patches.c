#include "patches.h"

#include <stdlib.h>
#include <string.h>

enum { PATCH_LIMIT = 1 << 26 };

int db_patches_init(struct db_patches *p, int width)
{
    *p = (struct db_patches){.width = width, .is_first_row = 1};
    p->above_labels = malloc((size_t)width * sizeof *p->above_labels);
    p->above = malloc((size_t)width * sizeof *p->above);
    if (!p->above_labels || !p->above) {
        db_patches_free(p);
        return -1;
    }
    return 0;
}

/* The patch's smallest number; halves the path on the way. */
static uint32_t find_root(struct db_patches *p, uint32_t i)
{
    while (p->parent[i] != i) {
        p->parent[i] = p->parent[p->parent[i]];
        i = p->parent[i];
    }
    return i;
}

static void join(struct db_patches *p, uint32_t a, uint32_t b)
{
    a = find_root(p, a);
    b = find_root(p, b);
    if (a < b) {
        p->parent[b] = a;
    } else {
        p->parent[a] = b;
    }
}

static int begin_patch(struct db_patches *p, int learn, uint32_t *number)
{
    if (p->count == PATCH_LIMIT) {
        return -1;
    }
    if (learn && p->count == p->capacity) {
        const size_t capacity = 2 * p->capacity + 1024;
        uint32_t *parent = realloc(p->parent, capacity * sizeof *parent);
        if (!parent) {
            return -1;
        }
        p->parent = parent;
        p->capacity = capacity;
    }
    *number = (uint32_t)p->count++;
    if (learn) {
        p->parent[*number] = *number;
    }
    return 0;
}

/* Take the number of the first neighbour that has the same label, and note that all such are one
 * patch. Both passes meet the same neighbours in the same order, hence the same provisional
 * numbers. */
static int number_pixel(struct db_patches *p, const int32_t *labels, uint32_t *numbers, int x,
                        int learn)
{
    uint32_t found = DB_NO_PATCH;
    if (x > 0 && labels[x - 1] == labels[x]) {
        found = numbers[x - 1];
    }
    for (int nx = x - 1; !p->is_first_row && nx <= x + 1; nx++) {
        if (nx < 0 || nx >= p->width || p->above_labels[nx] != labels[x]) {
            continue;
        }
        if (found == DB_NO_PATCH) {
            found = p->above[nx];
        } else if (learn) {
            join(p, found, p->above[nx]);
        }
    }
    numbers[x] = found;
    return found == DB_NO_PATCH ? begin_patch(p, learn, &numbers[x]) : 0;
}

int db_patches_row(struct db_patches *p, const int32_t *labels, uint32_t *numbers, int learn)
{
    for (int x = 0; x < p->width; x++) {
        numbers[x] = DB_NO_PATCH;
        if (labels[x] >= 0 && number_pixel(p, labels, numbers, x, learn) != 0) {
            return -1;
        }
    }
    memcpy(p->above_labels, labels, (size_t)p->width * sizeof *labels);
    memcpy(p->above, numbers, (size_t)p->width * sizeof *numbers);
    p->is_first_row = 0;
    for (int x = 0; !learn && x < p->width; x++) {
        if (numbers[x] != DB_NO_PATCH) {
            numbers[x] = find_root(p, numbers[x]);
        }
    }
    return 0;
}

void db_patches_rewind(struct db_patches *p)
{
    p->count = 0;
    p->is_first_row = 1;
}

void db_patches_free(struct db_patches *p)
{
    free(p->parent);
    free(p->above_labels);
    free(p->above);
    *p = (struct db_patches){0};
}
