#include "components.h"

#include <stdlib.h>
#include <string.h>

enum { COMPONENT_LIMIT = 1 << 26 };

int db_components_init(struct db_components *p, int width)
{
    *p = (struct db_components){.width = width, .is_first_row = 1};
    p->above_labels = malloc((size_t)width * sizeof *p->above_labels);
    p->above = malloc((size_t)width * sizeof *p->above);
    if (!p->above_labels || !p->above) {
        db_components_free(p);
        return -1;
    }
    return 0;
}

/* The component's smallest number; halves the path on the way. */
static uint32_t find_root(struct db_components *p, uint32_t i)
{
    while (p->parent[i] != i) {
        p->parent[i] = p->parent[p->parent[i]];
        i = p->parent[i];
    }
    return i;
}

static void join(struct db_components *p, uint32_t a, uint32_t b)
{
    a = find_root(p, a);
    b = find_root(p, b);
    if (a < b) {
        p->parent[b] = a;
    } else {
        p->parent[a] = b;
    }
}

static int begin_component(struct db_components *p, int learn, uint32_t *number)
{
    if (p->count == COMPONENT_LIMIT) {
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
 * component. Both passes meet the same neighbours in the same order, hence the same provisional
 * numbers. */
static int number_pixel(struct db_components *p, const int32_t *labels, uint32_t *numbers, int x,
                        int learn)
{
    uint32_t found = DB_NO_COMPONENT;
    if (x > 0 && labels[x - 1] == labels[x]) {
        found = numbers[x - 1];
    }
    for (int nx = x - 1; !p->is_first_row && nx <= x + 1; nx++) {
        if (nx < 0 || nx >= p->width || p->above_labels[nx] != labels[x]) {
            continue;
        }
        if (found == DB_NO_COMPONENT) {
            found = p->above[nx];
        } else if (learn) {
            join(p, found, p->above[nx]);
        }
    }
    numbers[x] = found;
    return found == DB_NO_COMPONENT ? begin_component(p, learn, &numbers[x]) : 0;
}

int db_components_row(struct db_components *p, const int32_t *labels, uint32_t *numbers, int learn)
{
    for (int x = 0; x < p->width; x++) {
        numbers[x] = DB_NO_COMPONENT;
        if (labels[x] >= 0 && number_pixel(p, labels, numbers, x, learn) != 0) {
            return -1;
        }
    }
    memcpy(p->above_labels, labels, (size_t)p->width * sizeof *labels);
    memcpy(p->above, numbers, (size_t)p->width * sizeof *numbers);
    p->is_first_row = 0;
    for (int x = 0; !learn && x < p->width; x++) {
        if (numbers[x] != DB_NO_COMPONENT) {
            numbers[x] = find_root(p, numbers[x]);
        }
    }
    return 0;
}

void db_components_rewind(struct db_components *p)
{
    p->count = 0;
    p->is_first_row = 1;
}

void db_components_free(struct db_components *p)
{
    free(p->parent);
    free(p->above_labels);
    free(p->above);
    *p = (struct db_components){0};
}
