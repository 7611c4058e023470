#include "terrain/mosaic.h"

#include "gis/gdal_start.h"
#include "hs/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Land lies between the Dead Sea and Everest, sea beds reach -11 km; what is beyond is a marker for
 * "void". */
static const double lowest_m = -12000.0, highest_m = 9500.0;

static int clamp(int value, int low, int high)
{
    return value < low ? low : value > high ? high : value;
}

/* The part of the window that a member covers. */
static struct resample_window overlap(const struct terrain_member *m,
                                      const struct resample_window *w)
{
    const int x0 = clamp(w->x, m->x, m->x + m->width);
    const int x1 = clamp(w->x + w->width, m->x, m->x + m->width);
    const int y0 = clamp(w->y, m->y, m->y + m->height);
    const int y1 = clamp(w->y + w->height, m->y, m->y + m->height);
    return (struct resample_window){x0, y0, x1 - x0, y1 - y0};
}

/* Lay one member's pixels over what is there; its voids cover only nothing. */
static void lay_over(const struct terrain_member *m, const struct resample_window *part,
                     const float *raw, const struct resample_window *window, float *metres,
                     uint8_t *state)
{
    for (int r = 0; r < part->height; r++) {
        const size_t to = (size_t)(part->y - window->y + r) * (size_t)window->width +
                          (size_t)(part->x - window->x);
        const float *from = raw + (size_t)r * (size_t)part->width;
        for (int c = 0; c < part->width; c++) {
            const size_t at = to + (size_t)c;
            const double value =
                from[c] * m->scale + m->offset +
                terrain_vertical_shift(&m->vertical, m->width, m->height, part->x - m->x + c + 0.5,
                                       part->y - m->y + r + 0.5);
            const bool is_void = (m->has_nodata && from[c] == (float)m->nodata) ||
                                 !(value >= lowest_m && value <= highest_m);
            if (!is_void) {
                metres[at] = (float)value;
                state[at] = TERRAIN_MEASURED;
            } else if (state[at] == TERRAIN_NONE) {
                state[at] = TERRAIN_VOID;
            }
        }
    }
}

static int read_member(const struct terrain_member *m, const struct resample_window *window,
                       float *metres, uint8_t *state)
{
    const struct resample_window part = overlap(m, window);
    if (part.width <= 0 || part.height <= 0) {
        return 0;
    }
    float *raw = malloc((size_t)part.width * (size_t)part.height * sizeof *raw);
    if (!raw) {
        return hs_error(m->path, NULL, "out of memory");
    }
    CPLErrorReset();
    if (GDALRasterIO(m->band, GF_Read, part.x - m->x, part.y - m->y, part.width, part.height, raw,
                     part.width, part.height, GDT_Float32, 0, 0) != CE_None) {
        free(raw);
        return hs_error(m->path, "the file may be cut short; fetch it again",
                        "cannot be read at row %d: %s", part.y - m->y, db_gdal_complaint());
    }
    lay_over(m, &part, raw, window, metres, state);
    free(raw);
    return 0;
}

int terrain_mosaic_read(const struct terrain_mosaic *m, const struct resample_window *window,
                        float *metres, uint8_t *state)
{
    const size_t count = (size_t)window->width * (size_t)window->height;
    for (size_t i = 0; i < count; i++) {
        metres[i] = NAN;
    }
    memset(state, TERRAIN_NONE, count);
    for (int i = m->member_count - 1; i >= 0; i--) {
        if (read_member(&m->members[i], window, metres, state) != 0) {
            return -1;
        }
    }
    return 0;
}

void terrain_mosaic_close(struct terrain_mosaic *m)
{
    for (int i = 0; i < m->member_count; i++) {
        GDALClose(m->members[i].dataset);
        free(m->members[i].path);
        terrain_vertical_free(&m->members[i].vertical);
    }
    free(m->members);
    resample_georef_close(&m->georef);
    *m = (struct terrain_mosaic){0};
}
