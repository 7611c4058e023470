/* Arrays of numbers inside a struct of a MATLAB file of level 5 (MathWorks, "MAT-File Format",
 * chapter 1), plain or compressed. Nothing in the file is trusted: sizes are checked before they
 * are followed. */
#ifndef REALRADAR_MAT_FILE_H
#define REALRADAR_MAT_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct rr_mat_slice {
    const uint8_t *at;
    size_t size;
};

struct rr_mat_numbers {
    uint32_t type; /* as stored: MATLAB packs whole numbers */
    struct rr_mat_slice bytes;
};

/* Borrows from the file it was found in. */
struct rr_mat_array {
    size_t rows, columns; /* values are stored by columns */
    bool is_complex;
    struct rr_mat_numbers real, imaginary;
};

struct rr_mat_file {
    const char *path;           /* borrowed, for messages */
    uint8_t *bytes;             /* owned: the file */
    uint8_t *inflated;          /* owned: the variable, where it was compressed; or NULL */
    struct rr_mat_slice fields; /* the struct's fields, after their names */
    struct rr_mat_slice names;
    size_t name_size;
};

/* Read the file and find the 1 x 1 struct called `variable`. Files above 256 MiB are refused, and
 * variables that inflate to more. Returns 0, or -1 with the error reported and nothing to close. */
int rr_mat_open(struct rr_mat_file *file, const char *path, const char *variable);

/* Find the two-dimensional, non-empty array of numbers called `name` in the struct. Returns 0, or
 * -1 with the error reported. */
int rr_mat_field(const struct rr_mat_file *file, const char *name, struct rr_mat_array *array);

/* Value i in the order of storage, i < rows * columns; the imaginary part of a real array is 0. */
double rr_mat_real(const struct rr_mat_array *array, size_t i);
double rr_mat_imaginary(const struct rr_mat_array *array, size_t i);

void rr_mat_close(struct rr_mat_file *file);

#endif
