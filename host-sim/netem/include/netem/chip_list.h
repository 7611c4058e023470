/* Chip lists: which chips there are, and what is known of each. */
#ifndef NETEM_CHIP_LIST_H
#define NETEM_CHIP_LIST_H

#include <stddef.h>

enum { NM_CHIPS_MAX = 100000 };

enum nm_set { NM_SET_OPEN, NM_SET_TRAINING, NM_SET_VALIDATION };

struct nm_chip_entry {
    char *path;            /* owned */
    double azimuth_deg;    /* NaN: take the chip's own */
    double depression_deg; /* likewise */
    int shift_x, shift_y;  /* of the target from the middle, pixels right and down */
    double gain; /* from the file's amplitude to that of a calibrated chip; NaN: unknown */
    enum nm_set set;
};

struct nm_chip_list {
    struct nm_chip_entry *entries; /* owned */
    int count, room;
};

/* `path` is a folder, whose files that seem to be chips are taken in the order of their names, or a
 * list of lines FILE [AZIMUTH DEPRESSION [SHIFT_X SHIFT_Y [GAIN [training|validation]]]] with tabs
 * or blanks between, '-' for what is unknown, FILE relative to the list's folder, '#' for remarks.
 * Returns 0, or -1 with the error reported and nothing to free. */
int nm_chip_list_read(struct nm_chip_list *list, const char *path);
void nm_chip_list_free(struct nm_chip_list *list);

/* Puts the entries of `more` behind those of `list`; `more` is left empty. Returns 0, or -1 with
 * the error reported. */
int nm_chip_list_append(struct nm_chip_list *list, struct nm_chip_list *more);

/* Writes such a list; paths as they are. Returns 0, or -1 with the error reported. */
int nm_chip_list_write(const struct nm_chip_list *list, const char *path, const char *remark);

#endif
