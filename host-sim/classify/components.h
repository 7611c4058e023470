/* 8-connected components of equal labels, found row by row: memory grows with the components, not
 * the pixels. */
#ifndef CLASSIFY_COMPONENTS_H
#define CLASSIFY_COMPONENTS_H

#include <stddef.h>
#include <stdint.h>

#define DB_NO_COMPONENT UINT32_MAX

struct db_components {
    uint32_t *parent; /* owned; of each provisional number, another one of the same component, or
                         itself */
    size_t count, capacity;
    int32_t *above_labels; /* owned */
    uint32_t *above;       /* owned: provisional numbers of the row above */
    int width;
    int is_first_row;
};

/* Both return 0, or -1 out of memory. */
int db_components_init(struct db_components *p, int width);

/* Number the pixels of the next row; those with a negative label get DB_NO_COMPONENT. To be called
 * for all rows from the top once (`learn` 1), then db_components_rewind and once more (`learn` 0):
 * the numbers of the second time are final, equal exactly within one component. -1 also when there
 * are more than 2^26 beginnings of components. */
int db_components_row(struct db_components *p, const int32_t *labels, uint32_t *numbers, int learn);
void db_components_rewind(struct db_components *p);

void db_components_free(struct db_components *p);

#endif
