/* Whole pictures: the stages in their order, line by line. */
#include "hs/error.h"
#include "hs/progress.h"
#include "lm/grain.h"
#include "reference/reference.h"

#include <math.h>
#include <stdlib.h>

static void sample(const struct ref_db *db, double cell_m, const struct ref_params *params,
                   struct ref_bin *bin)
{
    ref_db_ground(db, cell_m, bin->place, params->has_exact_weights, bin);
    ref_db_elevation(db, ref_db_level_for(db, cell_m), bin->place, params->has_exact_weights,
                     &bin->elevation_m);
}

void ref_tables_set(struct ref_tables *tables, const struct ref_params *params)
{
    ref_grain_table(params->looks, tables->grain_db);
}

/* The stages behind aspect, for a line whose levels and draws are known. */
static void finish(struct ref_bin *bins, size_t count, const struct ref_view *view,
                   const struct ref_params *params, const struct ref_tables *tables,
                   double look_deg)
{
    ref_class_gain(bins, count, params, look_deg);
    ref_sea(bins, count, view, params, look_deg);
    ref_speckle(bins, count, tables->grain_db, params->noise_floor_db);
    ref_tone(bins, count, params);
}

struct ref_view ref_gm_view(const struct ref_db *db, const struct ref_gm *gm,
                            const struct ref_params *params)
{
    double below_m;
    ref_db_elevation(db, ref_db_level_for(db, gm->cell_m), gm->antenna, params->has_exact_weights,
                     &below_m);
    return (struct ref_view){gm->antenna_m, fmin(below_m, db->mean_elevation_m), gm->cell_m};
}

double ref_gm_line(struct ref_bin *bins, const struct ref_db *db, const struct ref_gm *gm,
                   const struct ref_params *params, const struct ref_tables *tables,
                   double azimuth_deg, uint32_t sample_number)
{
    const struct ref_view view = ref_gm_view(db, gm, params);
    const double length_m = gm->cell_count * gm->cell_m;
    const struct ref_path path = ref_gm_path(gm->antenna, azimuth_deg, length_m);
    for (unsigned i = 0; i < gm->cell_count; i++) {
        bins[i].range_m = (i + 0.5) * gm->cell_m;
        bins[i].place = ref_path_at(&path, bins[i].range_m / length_m);
        sample(db, gm->cell_m, params, &bins[i]);
    }
    const size_t first = ref_first_shown(bins, gm->cell_count, &view);
    const double horizon = first < gm->cell_count ? ref_gm_horizon(&bins[first], &view) : 0;
    ref_illuminate(bins, gm->cell_count, &view, params, horizon);
    const struct lm_grain_place start = lm_grain_start(LM_GRAIN_SPECKLE, gm->epoch);
    for (uint32_t i = 0; i < gm->cell_count; i++) {
        bins[i].grain = ref_grain(start.row + sample_number, start.column + i);
    }
    finish(bins, gm->cell_count, &view, params, tables, azimuth_deg);
    return horizon;
}

double ref_gm_azimuth_deg(const struct ref_gm *gm, unsigned line)
{
    return gm->centre_azimuth_deg + gm->half_angle_deg * ((2.0 * line + 1) / gm->line_count - 1);
}

/* The bins of a line. */
static struct ref_patch_line line_of(const struct ref_picture *picture)
{
    const size_t first = picture->overscan.before;
    const size_t shown = picture->cell_count;
    return (struct ref_patch_line){first + shown + picture->overscan.behind, first, shown};
}

int ref_picture_allocate(struct ref_picture *picture)
{
    const size_t bins = line_of(picture).count;
    picture->bins = calloc(picture->line_count * bins, sizeof *picture->bins);
    picture->start_horizons = calloc(picture->line_count, sizeof *picture->start_horizons);
    if (picture->bins != NULL && picture->start_horizons != NULL) {
        return 0;
    }
    ref_picture_free(picture);
    hs_error("picture", "ask for fewer lines or cells", "not enough memory for %u x %zu cells",
             picture->line_count, bins);
    return -1;
}

void ref_picture_free(struct ref_picture *picture)
{
    free(picture->bins);
    free(picture->start_horizons);
    picture->bins = NULL;
    picture->start_horizons = NULL;
}

struct ref_bin *ref_picture_bin(const struct ref_picture *picture, unsigned line, int cell)
{
    const struct ref_patch_line bins = line_of(picture);
    return picture->bins + line * bins.count + (size_t)((int)bins.first + cell);
}

int ref_gm_sweep(struct ref_picture *picture, const struct ref_db *db, const struct ref_gm *gm,
                 const struct ref_params *params)
{
    *picture = (struct ref_picture){.line_count = gm->line_count,
                                    .cell_count = gm->cell_count,
                                    .view = ref_gm_view(db, gm, params),
                                    .level = ref_db_level_for(db, gm->cell_m)};
    if (ref_picture_allocate(picture) != 0) {
        return -1;
    }
    struct ref_tables tables;
    ref_tables_set(&tables, params);
    struct hs_progress progress;
    hs_progress_begin(&progress, "lines", gm->line_count);
    for (unsigned line = 0; line < gm->line_count; line++) {
        hs_progress_update(&progress, line);
        picture->start_horizons[line] =
            ref_gm_line(ref_picture_bin(picture, line, 0), db, gm, params, &tables,
                        ref_gm_azimuth_deg(gm, line), line);
    }
    hs_progress_end(&progress);
    return 0;
}

unsigned ref_sar_lines(const struct ref_sar *sar)
{
    const double half_m = sar->cell_count * sar->cell_m / 2;
    return 2 * (unsigned)ceil(sar->cell_count * sar->range_m / (2 * (sar->range_m - half_m)));
}

/* x_k of a line at the centre's range, and y_i of a cell. */
static double sar_across_m(const struct ref_sar *sar, unsigned line)
{
    return (line + 0.5 - ref_sar_lines(sar) / 2.0) * sar->cell_m;
}

static double sar_along_m(const struct ref_sar *sar, int cell)
{
    return (cell + 0.5 - sar->cell_count / 2.0) * sar->cell_m;
}

double ref_sar_horizon(const struct ref_db *db, const struct ref_sar *sar,
                       const struct ref_params *params, unsigned before, unsigned line)
{
    const int first = -(int)before;
    const double tangent = sar_across_m(sar, line) / sar->range_m;
    const double end_m = sar->range_m + sar_along_m(sar, first) - sar->cell_m / 2;
    const double start_m = end_m / 16, cell_m = (end_m - start_m) / REF_COARSE_CELLS;
    struct ref_path path;
    for (int i = 0; i < 3; i++) {
        const double range_m = start_m + (end_m - start_m) * i / 2;
        const struct ref_place p = ref_patch_offset(sar->centre, sar->azimuth_deg,
                                                    tangent * range_m, range_m - sar->range_m);
        path.latitude_deg[i] = p.latitude_deg;
        path.longitude_deg[i] = p.longitude_deg;
    }
    struct ref_bin bins[REF_COARSE_CELLS] = {{0}};
    for (int i = 0; i < REF_COARSE_CELLS; i++) {
        bins[i].range_m = start_m + (i + 0.5) * cell_m;
        bins[i].place = ref_path_at(&path, (i + 0.5) / REF_COARSE_CELLS);
        sample(db, cell_m, params, &bins[i]);
    }
    return ref_highest_tangent(bins, REF_COARSE_CELLS, sar->antenna_m);
}

/* First cell that is traced, and the one behind the last. */
static int first_cell(const struct ref_picture *picture)
{
    return -(int)picture->overscan.before;
}

static int end_cell(const struct ref_picture *picture)
{
    return (int)(picture->cell_count + picture->overscan.behind);
}

static void sar_line(const struct ref_picture *picture, const struct ref_db *db,
                     const struct ref_sar *sar, const struct ref_params *params,
                     const struct ref_surface *surface, unsigned line)
{
    const int first = first_cell(picture), end = end_cell(picture);
    for (int i = first; i < end; i++) {
        struct ref_bin *bin = ref_picture_bin(picture, line, i);
        const double along_m = sar_along_m(sar, i);
        bin->range_m = sar->range_m + along_m;
        bin->place = ref_surface_at(surface, sar_across_m(sar, line), along_m);
        sample(db, sar->cell_m, params, bin);
    }
    struct ref_bin *const bins = ref_picture_bin(picture, line, first);
    const size_t count = (size_t)(end - first);
    const double map_m = ref_db_cell_m(db, 0);
    if (ref_db_level_for(db, sar->cell_m) == 0 && sar->cell_m >= 24 &&
        sar->cell_m >= 2 * map_m / 3) {
        ref_raise_crests(bins, count, &picture->view);
    }
    ref_illuminate(
        bins, count, &picture->view, params,
        ref_behind_foreground(bins, count, &picture->view, picture->start_horizons[line]));
}

/* Speckle is drawn for the cells that are shown. */
static void draw_patch_line(struct ref_bin *shown, const struct ref_sar *sar, unsigned line)
{
    for (uint32_t i = 0; i < sar->cell_count; i++) {
        shown[i].grain = ref_grain(sar->grain_row + line, sar->grain_column + i);
    }
}

/* The rain as the antenna sees it. */
static struct ref_patch_rain find_rain(const struct ref_sar *sar, const struct ref_view *view)
{
    struct ref_patch_rain w = sar->rain;
    const struct ref_place antenna =
        ref_patch_offset(sar->centre, sar->azimuth_deg, 0, -sar->range_m);
    double sight_deg, bearing_deg, distance_m;
    ref_geo_inverse(antenna, sar->centre, &sight_deg, &distance_m);
    for (size_t n = 0; n < w.environment.rain_count; n++) {
        struct ref_rain *rain = &w.environment.rain[n];
        ref_geo_inverse(antenna, sar->rain_centre[n], &bearing_deg, &rain->distance_m);
        rain->off_deg = remainder(bearing_deg - sight_deg, 360);
    }
    w.slant = hypot(sar->range_m, view->antenna_m - view->reference_m) / sar->range_m;
    return w;
}

static void rain_on_line(const struct ref_picture *picture, const struct ref_sar *sar,
                         const struct ref_patch_rain *rain, unsigned line)
{
    const double aside_deg = atan2(sar_across_m(sar, line), sar->range_m) * 180 / acos(-1.0);
    for (int i = first_cell(picture); i < end_cell(picture); i++) {
        struct ref_bin *bin = ref_picture_bin(picture, line, i);
        bin->loss_db = ref_patch_loss_db(rain, aside_deg, bin->range_m, sar->cell_m);
        bin->veil = ref_patch_veil(rain, &picture->view, bin->range_m, aside_deg);
    }
}

/* Before the speckle of any line. */
static void rain_on(const struct ref_picture *picture, const struct ref_sar *sar)
{
    const struct ref_patch_rain rain = find_rain(sar, &picture->view);
    for (unsigned line = 0; line < picture->line_count && rain.environment.rain_count != 0;
         line++) {
        rain_on_line(picture, sar, &rain, line);
    }
}

/* Add the side lobes of the shown cells, whose echoes are known. */
static int add_side_lobes(const struct ref_picture *picture, const struct ref_sar *sar,
                          const struct ref_params *params, const double *shadow_db)
{
    const size_t cells = sar->cell_count;
    double *level_db = calloc(picture->line_count * cells, sizeof *level_db);
    if (!level_db) {
        return hs_error("picture", "ask for fewer lines or cells", "out of memory");
    }
    for (size_t i = 0; i < picture->line_count * cells; i++) {
        level_db[i] = ref_picture_bin(picture, (unsigned)(i / cells), (int)(i % cells))->echo_db;
    }
    const int status = ref_side_lobes(&params->side_lobes, level_db, shadow_db, picture->line_count,
                                      cells, sar->side_lobe_seed);
    for (size_t i = 0; i < picture->line_count * cells; i++) {
        ref_picture_bin(picture, (unsigned)(i / cells), (int)(i % cells))->echo_db = level_db[i];
    }
    free(level_db);
    return status;
}

/* From the illuminated ground to the levels that are shown. */
static int make_levels(const struct ref_picture *picture, const struct ref_sar *sar,
                       const struct ref_params *params)
{
    const struct ref_patch_line cells = line_of(picture);
    struct ref_tables tables;
    struct ref_leak leak = {0};
    double *shadow_db = calloc(picture->line_count, sizeof *shadow_db);
    if (!shadow_db) {
        return hs_error("picture", "ask for fewer lines or cells", "out of memory");
    }
    ref_tables_set(&tables, params);
    for (unsigned line = 0; line < picture->line_count; line++) {
        struct ref_bin *bins = ref_picture_bin(picture, line, first_cell(picture));
        draw_patch_line(bins + cells.first, sar, line);
        ref_class_gain(bins, cells.count, params, sar->azimuth_deg);
        ref_sea(bins, cells.count, &picture->view, params, sar->azimuth_deg);
        ref_patch_echo(bins, &cells, tables.grain_db, params, &leak, line);
        shadow_db[line] = leak.shadow_db;
    }
    const int status = add_side_lobes(picture, sar, params, shadow_db);
    free(shadow_db);
    return status;
}

struct ref_lean ref_sar_lean(const struct ref_sar *sar, double reference_m)
{
    const double above_m = sar->antenna_m - reference_m;
    const double grazing =
        fmax(above_m / sar->range_m - sar->range_m / (2 * REF_EFFECTIVE_EARTH_M), 0);
    return (struct ref_lean){sar->is_plan ? 0 : grazing / sar->cell_m, reference_m};
}

/* Elevation of the map, or off it the mean of the image's land. */
static double map_elevation_m(const struct ref_db *db, unsigned level, struct ref_place place,
                              const struct ref_params *params)
{
    double elevation_m;
    return ref_db_elevation(db, level, place, params->has_exact_weights, &elevation_m)
               ? elevation_m
               : db->mean_elevation_m;
}

/* d(Y) + 2 whole cells, or none. */
static unsigned overscan_cells(const struct ref_lean *lean, double above_m)
{
    const double cells = floor(above_m * lean->cells_m);
    return cells < 1 ? 0 : (unsigned)fmin(cells + 2, REF_OVERSCAN_MAX);
}

struct ref_overscan ref_sar_overscan(const struct ref_db *db, const struct ref_sar *sar,
                                     const struct ref_params *params, double reference_m)
{
    enum { ROWS = 3, PLACES = 5 };
    const unsigned level = ref_db_level_for(db, sar->cell_m);
    const struct ref_lean lean = ref_sar_lean(sar, reference_m);
    const double half_m = sar->cell_count * sar->cell_m / 2;
    double rise_m = 0, fall_m = 0;
    for (int row = 0; row < ROWS; row++) {
        const double along_m = half_m * (1 + row / 8.0);
        for (int place = 0; place < PLACES; place++) {
            const double across_m = half_m * (place - PLACES / 2) / (PLACES / 2);
            const struct ref_place far = ref_patch_offset(sar->centre, sar->azimuth_deg, across_m,
                                                          along_m),
                                   near = ref_patch_offset(sar->centre, sar->azimuth_deg, across_m,
                                                           -along_m);
            rise_m = fmax(rise_m, map_elevation_m(db, level, far, params) - reference_m);
            fall_m = fmax(fall_m, reference_m - map_elevation_m(db, level, near, params));
        }
    }
    const double room_m = sar->range_m - half_m - REF_TRACED_FROM_M;
    const double most = fmax(floor(room_m / sar->cell_m), 0);
    return (struct ref_overscan){(unsigned)fmin(overscan_cells(&lean, fall_m), most),
                                 overscan_cells(&lean, rise_m)};
}

/* Geometry of a patch, and room for its cells. */
static int begin_patch(struct ref_picture *picture, const struct ref_db *db,
                       const struct ref_sar *sar, const struct ref_params *params)
{
    *picture = (struct ref_picture){.line_count = ref_sar_lines(sar),
                                    .cell_count = sar->cell_count,
                                    .view = {sar->antenna_m, 0, sar->cell_m},
                                    .level = ref_db_level_for(db, sar->cell_m)};
    picture->view.reference_m = map_elevation_m(db, picture->level, sar->centre, params);
    picture->overscan = ref_sar_overscan(db, sar, params, picture->view.reference_m);
    return ref_picture_allocate(picture);
}

int ref_sar_patch(struct ref_picture *picture, const struct ref_db *db, const struct ref_sar *sar,
                  const struct ref_params *params)
{
    if (begin_patch(picture, db, sar, params) != 0) {
        return -1;
    }
    const struct ref_surface surface = ref_sar_surface(sar, picture->overscan);
    struct ref_params laid = *params;
    laid.lean = ref_sar_lean(sar, picture->view.reference_m);
    struct hs_progress progress;
    hs_progress_begin(&progress, "lines", picture->line_count);
    for (unsigned line = 0; line < picture->line_count; line++) {
        hs_progress_update(&progress, line);
        picture->start_horizons[line] =
            ref_sar_horizon(db, sar, params, picture->overscan.before, line);
        sar_line(picture, db, sar, params, &surface, line);
    }
    hs_progress_end(&progress);
    rain_on(picture, sar);
    if (make_levels(picture, sar, &laid) != 0) {
        ref_picture_free(picture);
        return -1;
    }
    for (unsigned line = 0; line < picture->line_count; line++) {
        ref_tone(ref_picture_bin(picture, line, 0), sar->cell_count, params);
    }
    return 0;
}
