#include "visual/canvas.h"

#include "hs/class_table.h"
#include "hs/error.h"

#include <gdal.h>
#include <gdal_alg.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

uint32_t visual_patch(struct visual_patches *p, const char *name)
{
    for (uint32_t i = p->count; i > 0; i--) {
        if (strncmp(p->names[i - 1], name, VISUAL_PATCH_NAME_SIZE - 1) == 0) {
            return i;
        }
    }
    if (p->count == VISUAL_PATCHES_MAX) {
        return 0;
    }
    if (p->count == p->room) {
        const uint32_t room = p->room ? 2 * p->room : 64;
        void *names = realloc(p->names, room * sizeof *p->names);
        if (!names) {
            return 0;
        }
        p->names = names;
        p->room = room;
    }
    snprintf(p->names[p->count], VISUAL_PATCH_NAME_SIZE, "%s", name);
    return ++p->count;
}

void visual_patches_free(struct visual_patches *p)
{
    free(p->names);
    *p = (struct visual_patches){.names = NULL};
}

int visual_canvas_open(struct visual_canvas *c, double width, double height, const char *place)
{
    *c = (struct visual_canvas){.width = 0};
    if (!(width >= 1 && height >= 1 && width * height <= (double)VISUAL_CELLS_MAX)) {
        return hs_error(place, "choose a larger --cell or a smaller --area",
                        "becomes %.0f x %.0f cells; 1 to %.0f are made", width, height,
                        (double)VISUAL_CELLS_MAX);
    }
    c->width = (int)width;
    c->height = (int)height;
    const size_t count = (size_t)c->width * (size_t)c->height;
    for (int i = 0; i < 3; i++) {
        c->rgb[i] = calloc(count, 1);
    }
    c->patch = calloc(count, sizeof *c->patch);
    c->classes = malloc(count);
    c->top = malloc(count * sizeof *c->top);
    c->ground = malloc(count * sizeof *c->ground);
    if (!c->rgb[0] || !c->rgb[1] || !c->rgb[2] || !c->patch || !c->classes || !c->top ||
        !c->ground) {
        visual_canvas_close(c);
        return hs_error(place, "choose a larger --cell or a smaller --area", "out of memory");
    }
    memset(c->classes, DB_CLASS_NODATA, count);
    for (size_t i = 0; i < count; i++) {
        c->top[i] = c->ground[i] = NAN;
    }
    return 0;
}

void visual_canvas_close(struct visual_canvas *c)
{
    for (int i = 0; i < 3; i++) {
        free(c->rgb[i]);
    }
    free(c->patch);
    free(c->classes);
    free(c->top);
    free(c->ground);
    *c = (struct visual_canvas){.width = 0};
}

/* A raster over memory of ours. */
static GDALDatasetH over(void *pixels, const char *type, const struct visual_canvas *c)
{
    char name[160];
    snprintf(name, sizeof name, "MEM:::DATAPOINTER=%p,PIXELS=%d,LINES=%d,DATATYPE=%s", pixels,
             c->width, c->height, type);
    return GDALOpen(name, GA_Update);
}

static int fill(struct visual_canvas *c, uint8_t *is_known)
{
    GDALDatasetH ground = over(c->ground, "Float32", c), mask = over(is_known, "Byte", c);
    const int reach = c->width > c->height ? c->width : c->height;
    const bool is_filled = ground && mask &&
                           GDALFillNodata(GDALGetRasterBand(ground, 1), GDALGetRasterBand(mask, 1),
                                          reach, 0, 0, NULL, NULL, NULL) == CE_None;
    if (ground) {
        GDALClose(ground);
    }
    if (mask) {
        GDALClose(mask);
    }
    return is_filled ? 0 : -1;
}

int64_t visual_canvas_fill_ground(struct visual_canvas *c, const char *place)
{
    const size_t count = (size_t)c->width * (size_t)c->height;
    uint8_t *is_known = malloc(count);
    int64_t holes = 0;
    for (size_t i = 0; is_known && i < count; i++) {
        const bool is_hole = isnan(c->ground[i]);
        is_known[i] = !is_hole;
        holes += is_hole;
    }
    int result = 0;
    if (!is_known) {
        result = hs_error(place, NULL, "out of memory");
    } else if (holes == (int64_t)count) {
        result =
            hs_error(place, "map its materials to classes of the kinds ground and water with --map",
                     "shows no ground from above");
    } else if (holes > 0 && fill(c, is_known) != 0) {
        result = hs_error(place, NULL, "the ground under it cannot be filled");
    }
    free(is_known);
    return result == 0 ? holes : -1;
}
