/* Chips: real radar pictures from files, raw MSTAR, CSV, and whatever GDAL reads (PNG, JPEG,
 * TIFF). */
#ifndef NETEM_CHIP_H
#define NETEM_CHIP_H

#include "netem/picture.h"

#include <stddef.h>

enum { NM_CHIP_NAME_SIZE = 256 };

struct nm_chip {
    char name[NM_CHIP_NAME_SIZE]; /* of the file, without its folders */
    struct nm_picture picture; /* owned; amplitude as in the file, 0 or more; 8-bit ones as 0..1 */
    double azimuth_deg;        /* of the radar as the target sees it, 0..360; NaN: unknown */
    double depression_deg;     /* NaN: unknown */
};

/* Reads a chip of any kind, told by its content; db_gdal_start() comes first. Nothing in the file
 * is believed before it was compared with its size. Returns 0, or -1 with the error reported and
 * nothing to close; close the picture when done. */
int nm_chip_read(struct nm_chip *chip, const char *path);

/* True if a file seems to be a chip: by its name's ending, or because it begins as raw MSTAR
 * does. */
int nm_chip_seems(const char *path);

/* A raw MSTAR chip in memory: an ASCII header of lines "Key= value" from "[PhoenixHeaderVer..." to
 * "[EndofPhoenixHeader]", its size under PhoenixHeaderLength, then NumberOfRows rows of
 * NumberOfColumns magnitudes and as many phases, 32-bit floats, most significant byte first; the
 * phases are not read. Whole scenes (native_header_length not 0) are refused. Aspect from TargetAz,
 * depression from MeasuredDepression or else DesiredDepression. `path` names it in messages.
 * Returns 0, or -1 with the error reported. */
int nm_chip_parse_mstar(struct nm_chip *chip, const char *path, const unsigned char *bytes,
                        size_t size);

/* Rows of numbers with commas or blanks between them, all rows of one length. text[size] is 0. */
int nm_chip_parse_csv(struct nm_chip *chip, const char *path, const char *text, size_t size);

#endif
