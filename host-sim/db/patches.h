/* 8-connected patches of equal labels, found row by row: memory grows with the patches, not the
 * pixels. */
#ifndef DB_PATCHES_H
#define DB_PATCHES_H

#include <stddef.h>
#include <stdint.h>

#define DB_NO_PATCH UINT32_MAX

struct db_patches {
    uint32_t
        *parent; /* owned; of each provisional number, another one of the same patch, or itself */
    size_t count, capacity;
    int32_t *above_labels; /* owned */
    uint32_t *above;       /* owned: provisional numbers of the row above */
    int width;
    int is_first_row;
};

/* Both return 0, or -1 out of memory. */
int db_patches_init(struct db_patches *p, int width);

/* Number the pixels of the next row; those with a negative label get DB_NO_PATCH. To be called for
 * all rows from the top once (`learn` 1), then db_patches_rewind and once more (`learn` 0): the
 * numbers of the second time are final, equal exactly within one patch. -1 also when there are more
 * than 2^26 beginnings of patches. */
int db_patches_row(struct db_patches *p, const int32_t *labels, uint32_t *numbers, int learn);
void db_patches_rewind(struct db_patches *p);

void db_patches_free(struct db_patches *p);

#endif
