#include "netem/picture.h"

#include "hs/error.h"

#include <stdlib.h>

int nm_picture_open(struct nm_picture *p, int width, int height)
{
    *p = (struct nm_picture){width, height, calloc((size_t)width * (size_t)height, sizeof(double))};
    return p->pixels ? 0 : hs_error("picture", "use a smaller picture", "out of memory");
}

void nm_picture_close(struct nm_picture *p)
{
    free(p->pixels);
    *p = (struct nm_picture){0};
}

struct nm_origin nm_picture_middle(const struct nm_picture *p, int side)
{
    return (struct nm_origin){(p->width - side) / 2, (p->height - side) / 2};
}

void nm_picture_cut(const struct nm_picture *p, struct nm_origin origin, int side, double *square)
{
    for (int y = 0; y < side; y++) {
        for (int x = 0; x < side; x++) {
            const int px = origin.x + x, py = origin.y + y;
            const int is_inside = px >= 0 && px < p->width && py >= 0 && py < p->height;
            square[y * side + x] = is_inside ? p->pixels[py * p->width + px] : 0;
        }
    }
}
