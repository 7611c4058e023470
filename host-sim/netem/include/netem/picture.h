/* Picture of real numbers, rows from the top. */
#ifndef NETEM_PICTURE_H
#define NETEM_PICTURE_H

#include <stddef.h>

enum { NM_PICTURE_SIDE_MAX = 4096 };

struct nm_picture {
    int width, height; /* 1..NM_PICTURE_SIDE_MAX */
    double *pixels;    /* owned */
};

/* Pixels are zero. Returns 0, or -1 out of memory with the error reported. */
int nm_picture_open(struct nm_picture *p, int width, int height);
void nm_picture_close(struct nm_picture *p);

/* Position of the simulated picture's pixel (0, 0) on a real one. */
struct nm_origin {
    int x, y;
};

/* The origin that puts a square of `side` pixels in the middle of `p`. */
struct nm_origin nm_picture_middle(const struct nm_picture *p, int side);

/* The square of `side` pixels at `origin`, zero where it leaves the picture. */
void nm_picture_cut(const struct nm_picture *p, struct nm_origin origin, int side, double *square);

#endif
