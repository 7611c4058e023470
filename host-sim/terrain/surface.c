#include "terrain/surface.h"

#include "fit.h"
#include "gis/gdal_start.h"
#include "gis/plausible.h"
#include "hs/error.h"
#include "hs/report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    POSTS = LM_TILE_POSTS * LM_TILE_POSTS,
    WINDOW_PIXELS_MAX = 2 << 20, /* read at a time */
    BLOCK_MIN = 2                /* posts on a side below which a window is not cut any more */
};

/* Within these the relief of a tile fits its codes. */
static const double lowest_m = -6000.0, highest_m = 9500.0;

/* One opened file on its way into a mosaic. */
struct source {
    struct resample_georef georef;
    struct terrain_member member;
    int group, x, y; /* the first file of its mosaic, and where it lies in that file's pixels */
};

static GDALDatasetH open_dataset(const char *path)
{
    const size_t length = strlen(path);
    CPLErrorReset();
    if (length < 5 || strcmp(path + length - 4, ".zip") != 0 || strncmp(path, "/vsi", 4) == 0) {
        return GDALOpen(path, GA_ReadOnly);
    }
    /* SRTM comes as N43E007.hgt.zip, which holds N43E007.hgt: GDAL needs to be told so. */
    char inside[4096];
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    snprintf(inside, sizeof inside, "/vsizip/%s/%.*s", path, (int)strlen(name) - 4, name);
    GDALDatasetH dataset = GDALOpen(inside, GA_ReadOnly);
    if (!dataset) {
        snprintf(inside, sizeof inside, "/vsizip/%s", path);
        dataset = GDALOpen(inside, GA_ReadOnly);
    }
    return dataset;
}

static int read_units(struct terrain_member *m, const struct terrain_options *options)
{
    int given = 0;
    if (terrain_vertical_read(&m->vertical, m->band, m->path, &options->vertical) != 0) {
        return -1;
    }
    m->nodata = GDALGetRasterNoDataValue(m->band, &given);
    m->has_nodata = given && !isnan(m->nodata);
    const double scale = GDALGetRasterScale(m->band, &given);
    m->scale = m->vertical.metres * (given ? scale : 1.0);
    const double offset = GDALGetRasterOffset(m->band, &given);
    m->offset = m->vertical.metres * (given ? offset : 0.0);
    return 0;
}

static int open_source(struct source *s, const char *path, const struct terrain_options *options)
{
    struct terrain_member *m = &s->member;
    m->dataset = db_gdal_note(open_dataset(path));
    if (!m->dataset) {
        return hs_error(path, "check the name and that `gdalinfo` can read it",
                        "cannot be opened as terrain: %s", db_gdal_complaint());
    }
    m->path = strdup(path);
    m->band = GDALGetRasterBand(m->dataset, 1);
    if (!m->path || !m->band) {
        return hs_error(path, "name one of its sub-datasets, as `gdalinfo` lists them",
                        "holds no band");
    }
    if (read_units(m, options) != 0 ||
        (!options->are_judged &&
         db_plausible_terrain(m->band, path, fabs(m->scale), options->are_trusted) != 0)) {
        return -1;
    }
    m->width = GDALGetRasterXSize(m->dataset);
    m->height = GDALGetRasterYSize(m->dataset);
    return resample_georef_open(&s->georef, m->dataset, path);
}

static void close_source(struct source *s)
{
    if (s->member.dataset) {
        GDALClose(s->member.dataset);
    }
    free(s->member.path);
    terrain_vertical_free(&s->member.vertical);
    resample_georef_close(&s->georef);
}

static bool rectangles_touch(int x, int y, const struct source *a, const struct source *b)
{
    return x <= a->member.width && x + b->member.width >= 0 && y <= a->member.height &&
           y + b->member.height >= 0;
}

/* Give `i` and all that touch it, directly or through others, to the group of `first`. */
static void spread_group(struct source *sources, int count, int i)
{
    for (int j = 0; j < count; j++) {
        int x, y;
        if (sources[j].group < 0 &&
            resample_is_aligned(&sources[i].georef, &sources[j].georef, &x, &y) &&
            rectangles_touch(x, y, &sources[i], &sources[j])) {
            sources[j].group = sources[i].group;
            sources[j].x = sources[i].x + x;
            sources[j].y = sources[i].y + y;
            spread_group(sources, count, j);
        }
    }
}

/* Hand the members of a group over to a mosaic. */
static int make_mosaic(struct terrain_mosaic *m, struct source *sources, int count, int group)
{
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0, members = 0;
    for (int i = 0; i < count; i++) {
        const struct source *s = &sources[i];
        if (s->group == group) {
            x0 = s->x < x0 ? s->x : x0;
            y0 = s->y < y0 ? s->y : y0;
            x1 = s->x + s->member.width > x1 ? s->x + s->member.width : x1;
            y1 = s->y + s->member.height > y1 ? s->y + s->member.height : y1;
            members++;
        }
    }
    m->members = calloc((size_t)members, sizeof *m->members);
    if (!m->members) {
        return hs_error(sources[group].member.path, NULL, "out of memory");
    }
    m->georef = sources[group].georef;
    sources[group].georef = (struct resample_georef){0};
    resample_georef_reframe(&m->georef, x0, y0, x1 - x0, y1 - y0);
    for (int i = 0; i < count; i++) {
        struct source *s = &sources[i];
        if (s->group == group) {
            s->member.x = s->x - x0;
            s->member.y = s->y - y0;
            m->members[m->member_count++] = s->member;
            s->member = (struct terrain_member){0};
        }
    }
    return 0;
}

static int finish_layer(struct terrain_layer *layer, const struct terrain_options *options)
{
    const char *path = layer->mosaic.members[0].path;
    layer->voids.sea_level_m = options->sea_level_m;
    layer->voids.are_sea = options->voids_are_sea;
    if (resample_area(&layer->mosaic.georef, &layer->area) != 0 ||
        resample_pixel_bam(&layer->mosaic.georef, &layer->pixel_latitude_bam,
                           &layer->pixel_longitude_bam) != 0) {
        return hs_error(path, "check its geotransform and CRS with gdalinfo",
                        "its middle lies nowhere on Earth");
    }
    return options->have_no_voids ? 0 : terrain_voids_fill(&layer->voids, &layer->mosaic);
}

static int make_layers(struct terrain *t, struct source *sources, int count)
{
    t->layers = count > 0 ? calloc((size_t)count, sizeof *t->layers) : NULL;
    if (!t->layers) {
        return hs_error("terrain", NULL, "out of memory");
    }
    for (int i = 0; i < count; i++) {
        sources[i].group = -1;
    }
    for (int i = 0; i < count; i++) {
        if (sources[i].group < 0) {
            sources[i].group = i;
            spread_group(sources, count, i);
        }
    }
    for (int i = 0; i < count; i++) {
        if (sources[i].group == i) {
            struct terrain_layer *layer = &t->layers[t->layer_count++];
            if (make_mosaic(&layer->mosaic, sources, count, i) != 0 ||
                finish_layer(layer, &t->options) != 0) {
                return -1;
            }
        }
    }
    return 0;
}

/* ---- overlaps ---- */

enum { MEETINGS = 16 /* places along a side of an overlap */, MEETINGS_LEAST = 8 };

/* Two models of one place differ by some metres, and in woods by the height of trees: UNSOURCED. */
static const double apart_most_m = 25;

static bool height_at(const struct source *s, double latitude_bam, double longitude_bam, double *m)
{
    const struct terrain_member *t = &s->member;
    double x, y;
    float value;
    resample_to_pixels(&s->georef, 1, &latitude_bam, &longitude_bam, &x, &y);
    if (!(x >= 0 && x < t->width && y >= 0 && y < t->height) ||
        GDALRasterIO(t->band, GF_Read, (int)x, (int)y, 1, 1, &value, 1, 1, GDT_Float32, 0, 0) !=
            CE_None ||
        (t->has_nodata && value == (float)t->nodata)) {
        return false;
    }
    *m = (double)value * t->scale + t->offset +
         terrain_vertical_shift(&t->vertical, t->width, t->height, x, y);
    return *m >= lowest_m && *m <= highest_m;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The median of a's heights above b's where both have one; NAN where they hardly meet. */
static double apart(const struct source *a, const struct source *b, const struct image_area *on)
{
    double differences[MEETINGS * MEETINGS];
    int count = 0;
    for (int i = 0; i < MEETINGS * MEETINGS; i++) {
        const double u = (i % MEETINGS + 0.5) / MEETINGS, v = (i / MEETINGS + 0.5) / MEETINGS;
        const double latitude = (double)on->south + v * (double)(on->north - on->south);
        const double longitude = (double)on->west + u * (double)on->width;
        double p, q;
        if (height_at(a, latitude, longitude, &p) && height_at(b, latitude, longitude, &q)) {
            differences[count++] = p - q;
        }
    }
    qsort(differences, (size_t)count, sizeof differences[0], by_size);
    return count < MEETINGS_LEAST ? (double)NAN : differences[count / 2];
}

/* Each pair is looked at where the smaller of the two lies. */
static int terrain_overlaps_judge(const struct source *sources, int count, bool are_trusted)
{
    struct image_area areas[HS_LIST_MAX];
    for (int i = 0; i < count; i++) {
        if (resample_area(&sources[i].georef, &areas[i]) != 0) {
            areas[i] = (struct image_area){.width = 0};
        }
    }
    for (int i = 0; i < count; i++) {
        for (int k = i + 1; k < count; k++) {
            if (areas[i].width == 0 || areas[k].width == 0 ||
                !image_areas_meet(&areas[i], &areas[k])) {
                continue;
            }
            const bool first = areas[i].north - areas[i].south < areas[k].north - areas[k].south;
            const double m = apart(&sources[i], &sources[k], &areas[first ? i : k]);
            if (fabs(m) > apart_most_m &&
                hs_doubt(are_trusted, sources[k].member.path,
                         "compare their units and datums (--terrain-unit, --terrain-datum)",
                         "lies %.0f m %s %s where both have heights (median)", fabs(m),
                         m > 0 ? "below" : "above", sources[i].member.path) != 0) {
                return -1;
            }
        }
    }
    return 0;
}

/* Files that say the same as the one before are passed over. */
static void say_heights(const struct source *sources, int count)
{
    const char *last = "";
    hs_report_array("terrain_heights");
    for (int i = 0; i < count; i++) {
        const struct terrain_member *m = &sources[i].member;
        if (strcmp(m->vertical.said, last) != 0) {
            printf("terrain from %s: %s\n", m->path, m->vertical.said);
            hs_report_object(NULL);
            hs_report_put("path", m->path);
            hs_report_put("heights", m->vertical.said);
            hs_report_close();
        }
        last = m->vertical.said;
    }
    hs_report_close();
}

int terrain_open(struct terrain *t, const struct hs_list *paths,
                 const struct terrain_options *options)
{
    *t = (struct terrain){.options = *options};
    if (paths->count == 0) {
        return 0;
    }
    struct source *sources = calloc((size_t)paths->count, sizeof *sources);
    int result = sources ? 0 : hs_error("terrain", NULL, "out of memory");
    for (int i = 0; result == 0 && i < paths->count; i++) {
        result = open_source(&sources[i], paths->items[i], options);
    }
    if (result == 0) {
        say_heights(sources, paths->count);
        result = options->are_judged
                     ? 0
                     : terrain_overlaps_judge(sources, paths->count, options->are_trusted);
    }
    if (result == 0) {
        result = make_layers(t, sources, paths->count);
    }
    for (int i = 0; sources && i < paths->count; i++) {
        close_source(&sources[i]);
    }
    free(sources);
    if (result != 0) {
        terrain_close(t);
    }
    return result;
}

void terrain_close(struct terrain *t)
{
    for (int i = 0; i < t->layer_count; i++) {
        terrain_mosaic_close(&t->layers[i].mosaic);
        terrain_voids_free(&t->layers[i].voids);
    }
    free(t->layers);
    *t = (struct terrain){0};
}

void terrain_set_cell(struct terrain *t, uint8_t shift0)
{
    const double cell = (double)((int64_t)1 << shift0);
    for (int i = 0; i < t->layer_count; i++) {
        struct terrain_layer *layer = &t->layers[i];
        layer->lattice = resample_lattice_of(&layer->mosaic.georef, shift0);
        layer->blur_x = fmax(0.0, cell / layer->pixel_longitude_bam - 1.0);
        layer->blur_y = fmax(0.0, cell / layer->pixel_latitude_bam - 1.0);
        terrain_fit_set(&layer->fit, cell / layer->pixel_longitude_bam,
                        cell / layer->pixel_latitude_bam);
    }
}

/* Pixels of a layer in memory. */
struct patch {
    struct resample_window window;
    float *metres;
    uint8_t *state;
};

static void free_patch(struct patch *p)
{
    free(p->metres);
    free(p->state);
}

/* Read the window of a patch. Returns 0, or -1 with the error reported and nothing to free. */
static int read_patch(const struct terrain_layer *layer, struct patch *p)
{
    const size_t pixels = (size_t)p->window.width * (size_t)p->window.height;
    p->metres = malloc(pixels * sizeof *p->metres);
    p->state = malloc(pixels);
    int result = -1;
    if (!p->metres || !p->state) {
        hs_error(layer->mosaic.members[0].path, "choose smaller cells", "out of memory");
    } else {
        result = terrain_mosaic_read(&layer->mosaic, &p->window, p->metres, p->state);
    }
    if (result == 0) {
        terrain_voids_apply(&layer->voids, &p->window, p->metres, p->state);
    } else {
        free_patch(p);
    }
    return result;
}

/* State of the pixel that holds a position; TERRAIN_NONE outside the window or for NaN. */
static enum terrain_state state_at(const struct patch *p, double x, double y)
{
    const struct resample_window *w = &p->window;
    if (!(x >= w->x && x < w->x + w->width && y >= w->y && y < w->y + w->height)) {
        return TERRAIN_NONE;
    }
    const size_t row = (size_t)((int)y - w->y), column = (size_t)((int)x - w->x);
    return p->state[row * (size_t)w->width + column];
}

/* Integral of the triangle of half width 1 from its left end to t. */
static double triangle_below(double t)
{
    if (t <= -1.0 || t >= 1.0) {
        return t < 0.0 ? 0.0 : 1.0;
    }
    return t < 0.0 ? 0.5 * (1.0 + t) * (1.0 + t) : 1.0 - 0.5 * (1.0 - t) * (1.0 - t);
}

/* Weight of a pixel `distance` away in the mean of the bilinear surface over `blur` pixels. The
 * weights of all pixels sum to 1 and have the right centre for any `blur`: a plane stays the plane
 * it is. */
static double weight_of(double distance, double blur)
{
    if (blur <= 0.0) {
        return fmax(0.0, 1.0 - fabs(distance));
    }
    return (triangle_below(distance + blur / 2) - triangle_below(distance - blur / 2)) / blur;
}

/* Weighted mean of the pixels with an elevation around a position; there is at least the one it
 * lies in. */
static double interpolate(const struct terrain_layer *layer, const struct patch *p, double x,
                          double y)
{
    const struct resample_window *w = &p->window;
    const double cx = x - 0.5, cy = y - 0.5;
    const double rx = 1.0 + layer->blur_x / 2, ry = 1.0 + layer->blur_y / 2;
    const int x0 = (int)fmax(ceil(cx - rx), w->x);
    const int x1 = (int)fmin(floor(cx + rx), w->x + w->width - 1);
    const int y0 = (int)fmax(ceil(cy - ry), w->y);
    const int y1 = (int)fmin(floor(cy + ry), w->y + w->height - 1);
    double sum = 0.0, weights = 0.0;
    for (int v = y0; v <= y1; v++) {
        const double wy = weight_of(v - cy, layer->blur_y);
        const size_t row = (size_t)(v - w->y) * (size_t)w->width;
        for (int u = x0; u <= x1; u++) {
            const float metres = p->metres[row + (size_t)(u - w->x)];
            const double weight = wy * weight_of(u - cx, layer->blur_x);
            if (!isnan(metres) && weight > 0.0) {
                sum += weight * (double)metres;
                weights += weight;
            }
        }
    }
    return sum / weights;
}

/* Pixels along one axis that a fitted post depends on, with their weights. */
struct fit_axis {
    double centre;
    int first, count;
    double weight[16];
};

/* Of the posts before: those of a column share one axis and those of a row the other, where the
 * layer lies north up on the image's grid. */
struct fit_axes {
    struct fit_axis column[LM_TILE_POSTS], row;
};

/* `a` is that of another post, or zeroed. */
static void set_fit_axis(struct fit_axis *a, const struct terrain_fit *fit, double cell,
                         double centre)
{
    if (a->count > 0 && a->centre == centre) {
        return;
    }
    a->centre = centre;
    const double reach = terrain_fit_reach(cell);
    a->first = (int)ceil(centre - reach);
    a->count = (int)floor(centre + reach) - a->first + 1;
    for (int i = 0; i < a->count; i++) {
        a->weight[i] = terrain_fit_weight(fit, cell, a->first + i - centre);
    }
}

/* A post fitted to the surface, no higher and no lower than the pixels that are less than a cell
 * from where it is drawn: flat water beside a cliff stays flat. NAN where a pixel is missing. */
static double fitted(const struct terrain_layer *layer, const struct patch *p, double x, double y,
                     struct fit_axis *column, struct fit_axis *row)
{
    const struct terrain_fit *fit = &layer->fit;
    const struct resample_window *w = &p->window;
    set_fit_axis(column, fit, fit->cell_x, x - 0.5);
    set_fit_axis(row, fit, fit->cell_y, y - 0.5);
    if (column->first < w->x || column->first + column->count > w->x + w->width ||
        row->first < w->y || row->first + row->count > w->y + w->height) {
        return (double)NAN;
    }
    double sum = 0.0, low = HUGE_VAL, high = -HUGE_VAL;
    for (int r = 0; r < row->count; r++) {
        const float *metres = p->metres + (size_t)(row->first + r - w->y) * (size_t)w->width +
                              (size_t)(column->first - w->x);
        const bool is_near_row = fabs(row->first + r + 0.5 - y) < 1.0 + fit->cell_y;
        for (int c = 0; c < column->count; c++) {
            const double here = (double)metres[c];
            sum += row->weight[r] * column->weight[c] * here;
            if (is_near_row && fabs(column->first + c + 0.5 - x) < 1.0 + fit->cell_x) {
                low = here < low ? here : low;
                high = here > high ? here : high;
            }
        }
    }
    return isnan(sum) ? sum : fmin(fmax(sum, low), high);
}

/* True where the surface is flat: the pixels that a post lies between are equal. */
static bool is_flat(const struct patch *p, double x, double y)
{
    const struct resample_window *w = &p->window;
    const int column = (int)floor(x - 0.5) - w->x, row = (int)floor(y - 0.5) - w->y;
    if (column < 0 || column + 1 >= w->width || row < 0 || row + 1 >= w->height) {
        return false;
    }
    const float *m = p->metres + (size_t)row * (size_t)w->width + (size_t)column;
    return m[0] == m[1] && m[0] == m[w->width] && m[0] == m[w->width + 1];
}

/* Flat ground stays as it is, so that the sea ends where it did. */
static double height_of_post(const struct terrain_layer *layer, const struct patch *p, double x,
                             double y, struct fit_axis *column, struct fit_axis *row)
{
    const double metres =
        layer->fit.is_on && !is_flat(p, x, y) ? fitted(layer, p, x, y, column, row) : (double)NAN;
    return isnan(metres) ? interpolate(layer, p, x, y) : metres;
}

/* What is known of a tile's posts so far. */
struct work {
    double x[POSTS], y[POSTS]; /* in the layer at hand */
    double metres[POSTS];
    uint8_t state[POSTS];   /* best enum terrain_state so far */
    double distance[POSTS]; /* to the nearest layer, BAM; only where the state is TERRAIN_NONE */
};

/* Posts first..last of rows and columns. */
struct block {
    int row0, row1, column0, column1;
};

static void sample_patch(const struct terrain_layer *layer, const struct patch *p, struct work *w,
                         const struct block *b)
{
    struct fit_axes axes = {0};
    for (int r = b->row0; r <= b->row1; r++) {
        for (int c = b->column0; c <= b->column1; c++) {
            const int i = r * LM_TILE_POSTS + c;
            const enum terrain_state state = state_at(p, w->x[i], w->y[i]);
            if (state > w->state[i] && state >= TERRAIN_FILLED) {
                w->metres[i] =
                    height_of_post(layer, p, w->x[i], w->y[i], &axes.column[c], &axes.row);
                w->state[i] = (uint8_t)state;
            }
        }
    }
}

static struct resample_window block_window(const struct terrain_layer *layer, const struct work *w,
                                           const struct block *b)
{
    double x[POSTS], y[POSTS];
    size_t count = 0;
    for (int r = b->row0; r <= b->row1; r++) {
        for (int c = b->column0; c <= b->column1; c++) {
            x[count] = w->x[r * LM_TILE_POSTS + c];
            y[count++] = w->y[r * LM_TILE_POSTS + c];
        }
    }
    const double cell = fmax(layer->fit.cell_x, layer->fit.cell_y);
    const int margin = layer->fit.is_on ? (int)ceil(terrain_fit_reach(cell)) + 1
                                        : (int)ceil(fmax(layer->blur_x, layer->blur_y) / 2) + 2;
    return resample_window_of(&layer->mosaic.georef, count, x, y, margin);
}

static int sample_block(const struct terrain_layer *layer, struct work *w, const struct block *b)
{
    struct patch p = {.window = block_window(layer, w, b)};
    if (p.window.width == 0) {
        return 0;
    }
    const size_t pixels = (size_t)p.window.width * (size_t)p.window.height;
    const int side = b->row1 - b->row0 + 1;
    if (pixels > WINDOW_PIXELS_MAX && side > BLOCK_MIN) {
        const int row = b->row0 + side / 2, column = b->column0 + (b->column1 - b->column0 + 1) / 2;
        const struct block parts[4] = {{b->row0, row - 1, b->column0, column - 1},
                                       {b->row0, row - 1, column, b->column1},
                                       {row, b->row1, b->column0, column - 1},
                                       {row, b->row1, column, b->column1}};
        for (int i = 0; i < 4; i++) {
            if (sample_block(layer, w, &parts[i]) != 0) {
                return -1;
            }
        }
        return 0;
    }
    if (read_patch(layer, &p) != 0) {
        return -1;
    }
    sample_patch(layer, &p, w, b);
    free_patch(&p);
    return 0;
}

static void map_posts(const struct terrain_layer *layer, const struct image_frame *frame,
                      struct work *w)
{
    struct resample_mesh mesh;
    resample_mesh_make(&mesh, &layer->mosaic.georef, &layer->lattice, frame);
    resample_mesh_posts(&mesh, w->x, w->y);
}

static double clamp(double value, double low, double high)
{
    return value < low ? low : value > high ? high : value;
}

/* A post that nothing reaches, and the place on a layer's edge (or in a void of it) that is nearest
 * to it. */
struct stray {
    int post;
    double x, y, distance;
};

/* The strays that this layer is the nearest to so far; returns how many. */
static size_t find_strays(const struct terrain_layer *layer, const struct work *w,
                          struct stray *strays)
{
    const struct resample_georef *g = &layer->mosaic.georef;
    size_t count = 0;
    for (int i = 0; i < POSTS; i++) {
        if (w->state[i] >= TERRAIN_FILLED || isnan(w->x[i])) {
            continue;
        }
        struct stray s = {.post = i,
                          .x = clamp(w->x[i], 0.5, g->width - 0.5),
                          .y = clamp(w->y[i], 0.5, g->height - 0.5)};
        s.distance = hypot((s.x - w->x[i]) * layer->pixel_longitude_bam,
                           (s.y - w->y[i]) * layer->pixel_latitude_bam);
        if (s.distance < w->distance[i]) {
            strays[count++] = s;
        }
    }
    return count;
}

/* Give `count` strays the height of their nearest pixel. Cuts their number in two as long as their
 * pixels are too many to be read at once. */
static int lend_heights(const struct terrain_layer *layer, const struct stray *strays, size_t count,
                        struct work *w)
{
    double x[POSTS] = {0}, y[POSTS] = {0};
    for (size_t i = 0; i < count; i++) {
        x[i] = strays[i].x;
        y[i] = strays[i].y;
    }
    struct patch p = {.window = resample_window_of(&layer->mosaic.georef, count, x, y, 0)};
    const size_t pixels = (size_t)p.window.width * (size_t)p.window.height;
    if (pixels > WINDOW_PIXELS_MAX && count > 1) {
        const size_t half = count / 2;
        return lend_heights(layer, strays, half, w) == 0 &&
                       lend_heights(layer, strays + half, count - half, w) == 0
                   ? 0
                   : -1;
    }
    if (read_patch(layer, &p) != 0) {
        return -1;
    }
    for (size_t i = 0; i < count; i++) {
        const size_t row = (size_t)((int)y[i] - p.window.y);
        const float metres =
            p.metres[row * (size_t)p.window.width + (size_t)((int)x[i] - p.window.x)];
        if (!isnan(metres)) {
            w->metres[strays[i].post] = (double)metres;
            w->distance[strays[i].post] = strays[i].distance;
        }
    }
    free_patch(&p);
    return 0;
}

static int extend_edge(const struct terrain_layer *layer, struct work *w)
{
    struct stray *strays = malloc(POSTS * sizeof *strays);
    if (!strays) {
        return hs_error(layer->mosaic.members[0].path, NULL, "out of memory");
    }
    const size_t count = find_strays(layer, w, strays);
    const int result = count > 0 ? lend_heights(layer, strays, count, w) : 0;
    free(strays);
    return result;
}

static int store_posts(const struct work *w, struct terrain_posts *posts)
{
    int reached = 0;
    for (int i = 0; i < POSTS; i++) {
        const int r = i / LM_TILE_POSTS, c = i % LM_TILE_POSTS;
        posts->q6[r][c] = (int32_t)lround(clamp(w->metres[i], lowest_m, highest_m) * 64.0);
        posts->has[r][c] = w->state[i] >= TERRAIN_FILLED;
        reached += posts->has[r][c];
    }
    return reached;
}

static int sample_layers(struct terrain *t, const struct image_frame *frame, struct work *w)
{
    const struct image_area area = image_frame_area(frame);
    const struct block all = {0, LM_TILE_POSTS - 1, 0, LM_TILE_POSTS - 1};
    for (int i = 0; i < t->layer_count; i++) {
        if (image_areas_meet(&t->layers[i].area, &area)) {
            map_posts(&t->layers[i], frame, w);
            if (sample_block(&t->layers[i], w, &all) != 0) {
                return -1;
            }
        }
    }
    uint64_t beyond = 0;
    for (int i = 0; i < POSTS; i++) {
        beyond += w->state[i] < TERRAIN_FILLED;
    }
    t->posts_beyond += beyond;
    for (int i = 0; beyond > 0 && i < t->layer_count; i++) {
        map_posts(&t->layers[i], frame, w);
        if (extend_edge(&t->layers[i], w) != 0) {
            return -1;
        }
    }
    return 0;
}

int terrain_posts(struct terrain *t, const struct image_frame *frame, struct terrain_posts *posts)
{
    struct work *w = calloc(1, sizeof *w);
    if (!w) {
        return hs_error("terrain", NULL, "out of memory");
    }
    for (int i = 0; i < POSTS; i++) {
        w->metres[i] = t->options.sea_level_m;
        w->distance[i] = HUGE_VAL;
    }
    const int result = sample_layers(t, frame, w) == 0 ? store_posts(w, posts) : -1;
    free(w);
    return result;
}
