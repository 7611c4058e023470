/* The work that `make bench` measures: whole pictures from an image made in memory, all tiles
 * resident.
 *
 *   stage_bench sar N         draw N patches and print nothing: callgrind counts the instructions
 *                             of the functions called here (tests/bench/bench.sh)
 *   stage_bench chips N       the same with 16 targets that have a signature, cells of 0.5 m
 *   stage_bench gm|exp|dbs1|dbs2|gmt|sea N
 *                             N sweeps; prints the lines drawn and sampled
 *   stage_bench compare N     N times: processor time a pixel of a patch, by the firmware and by
 * the reference in double precision, both without the image's checks */
#include "golden_signature.h"
#include "lm/sar.h"
#include "lm/scan_conv.h"
#include "lm/sector.h"
#include "lm/view.h"
#include "memory_flash.h"
#include "reference/reference.h"
#include "tiny_image.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* A mixed scene: water, fields, forest, a block of buildings every 80 m, hills. */
static struct tiny_cell scene_cell(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    const double u = sin(p->east_m / 170) + sin(p->north_m / 230);
    if (u < -1.2) {
        return (struct tiny_cell){-40, TINY_WATER, 0};
    }
    if (fabs(remainder(p->east_m, 80)) < 12 && fabs(remainder(p->north_m, 80)) < 15) {
        return (struct tiny_cell){0, TINY_STRUCTURE, 5};
    }
    if (u > 0.9) {
        return (struct tiny_cell){-15, TINY_TREES, 7};
    }
    return (struct tiny_cell){-20 + 2 * sin(p->east_m / 31), TINY_SOIL, 0};
}

static double scene_elevation(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return 60 + 40 * sin(p->east_m / 400) * cos(p->north_m / 300);
}

enum { TARGETS = 16 };

struct world {
    struct tiny_image image;
    struct memory_flash flash;
    struct lm_db db;
    struct lm_tile_cache tiles;
    struct lm_signature signature;
    struct lm_chip_source chip_source;
    struct lm_chips chips;
    struct lm_target targets[TARGETS];
    void *pool;
    struct lm_tone tone;
    struct lm_line line;
    struct lm_plane plane;
    struct lm_frame frame;
    struct lm_patch_painter painter;
};

/* The glass: a display of 512 x 512, where a patch has 366 x 366 pixels. */
enum { DISPLAY_PX = 512, CELL_MM = 5000 };

static int open_world(struct world *w, uint8_t shift0)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.cell = scene_cell;
    spec.elevation_m = scene_elevation;
    spec.shift0 = shift0;
    spec.rows = 10;
    spec.columns = 20; /* wide enough for a sector of the shortest range */
    if (tiny_image_build(&w->image, &spec) != 0 || golden_add_signature(&w->image) != 0) {
        return -1;
    }
    memory_flash_open(&w->flash, w->image.bytes, w->image.size);
    const size_t bytes = 400 * sizeof(struct lm_tile);
    w->pool = malloc(bytes);
    w->plane = (struct lm_plane){
        .pixels = calloc(DISPLAY_PX, DISPLAY_PX), .width_px = DISPLAY_PX, .height_px = DISPLAY_PX};
    w->frame = lm_frame_of_display(DISPLAY_PX, DISPLAY_PX);
    return w->pool && w->plane.pixels && lm_db_open(&w->db, &w->flash.port, 10) == LM_OK &&
                   lm_tile_cache_init(&w->tiles, &w->db, w->pool, bytes, 10) == LM_OK &&
                   lm_signature_read(&w->db, 0, &w->signature, 10) == LM_OK &&
                   lm_tone_set(&w->tone, &lm_radar_default.sar.tone) == LM_OK
               ? 0
               : -1;
}

static void make_resident(struct world *w)
{
    bool is_idle = false;
    for (int i = 0; i < 100000 && !is_idle; i++) {
        lm_chips_service(&w->chips, &w->tiles);
        lm_tile_cache_service(&w->tiles, 0, 1);
        is_idle = lm_tile_cache_is_idle(&w->tiles) && lm_chips_are_settled(&w->chips);
    }
}

/* Four rows of four, 25 m apart, each turned another way. */
static struct lm_target_set parked(struct world *w)
{
    const fx_bam_t apart = (fx_bam_t)(25 / 9.3e-3);
    for (uint32_t i = 0; i < TARGETS; i++) {
        w->targets[i] = (struct lm_target){
            .latitude = w->db.centre_latitude + (i / 4 - 2) * apart,
            .longitude = w->db.centre_longitude + (i % 4 - 2) * apart * 3 / 2,
            .heading = i * FX_BAM_DEG(23),
            .flags = LM_TARGET_ABOVE_GROUND | LM_TARGET_HAS_SIGNATURE,
        };
    }
    w->chip_source = (struct lm_chip_source){w->db.chips_offset, 0};
    lm_chips_init(&w->chips, &w->chip_source, &w->signature);
    return (struct lm_target_set){
        .items = w->targets, .count = TARGETS, .signatures = &w->signature, .signature_count = 1};
}

/* `targets` may be NULL. */
static int draw_patches(struct world *w, const struct lm_target_set *targets, uint32_t cell_mm,
                        int count)
{
    struct lm_sar sar;
    const struct lm_sar_setup scene = {.targets = targets,
                                       .chips = &w->chips,
                                       .relief = {.reference_m_q10 = 60 * 1024},
                                       .sea_state = LM_SEA_STATE_OF_IMAGE};
    const struct lm_sar_command command = {
        .centre = {w->db.centre_latitude, w->db.centre_longitude},
        .cell_mm = cell_mm,
        .look_azimuth = FX_BAM_DEG(37),
        .range_m = 20000,
        .height_m_q6 = 3000 * 64,
    };
    for (int n = 0; n < count; n++) {
        if (lm_sar_start(&sar, &lm_radar_default, &w->db, &command, &scene) != LM_OK) {
            return -1;
        }
        const struct lm_patch_fan fan = {.lines = sar.lines,
                                         .cells = lm_radar_default.sar.cells,
                                         .centre_m_q8 = sar.geometry.centre_m_q8,
                                         .cell_m_q8 = sar.geometry.cell_m_q8};
        lm_patch_painter_set(&w->painter, &w->frame, &fan);
        for (uint32_t line = 0; line < sar.lines; line += 8) {
            lm_sar_prefetch(&sar, &w->tiles, line);
            make_resident(w);
        }
        lm_sar_prefetch_targets(&sar, &w->tiles);
        make_resident(w);
        while (sar.line < sar.lines) {
            lm_sar_draw_line(&sar, &w->tiles, &w->tone, &w->line);
            lm_scan_conv_patch(&w->painter, &w->plane, sar.line - 1, w->line.grey);
        }
    }
    return 0;
}

static const struct sector_case {
    const char *name;
    uint8_t mode, field;
} sector_cases[] = {
    {"gm", LM_SECTOR_GM, LM_FOV_NORM},   {"exp", LM_SECTOR_GM, LM_FOV_EXP},
    {"dbs1", LM_SECTOR_GM, LM_FOV_DBS1}, {"dbs2", LM_SECTOR_GM, LM_FOV_DBS2},
    {"gmt", LM_SECTOR_GMT, LM_FOV_NORM}, {"sea", LM_SECTOR_SEA, LM_FOV_NORM},
};

static const struct sector_case *find_case(const char *name)
{
    for (size_t i = 0; i < sizeof sector_cases / sizeof *sector_cases; i++) {
        if (strcmp(sector_cases[i].name, name) == 0) {
            return &sector_cases[i];
        }
    }
    return NULL;
}

/* Sweeps of one mode and field of view, around the middle of the scene. Says how many lines were
 * drawn and how many sampled for them. */
static void draw_sweeps(struct world *w, const struct sector_case *what, int count)
{
    uint32_t drawn = 0;
    static struct lm_sector sector;
    const struct lm_platform platform = {
        .position = {w->db.centre_latitude - (fx_bam_t)(8000 / 9.3e-3), w->db.centre_longitude},
        .height_m_q10 = 3000 * 1024,
        .track = FX_BAM_DEG(-30),
        .speed_mm_s = 250000,
    };
    const struct lm_environment fair = {.sea_state = LM_SEA_STATE_OF_IMAGE};
    const uint8_t range_index = (uint8_t)lm_radar_find_range(&lm_radar_default, 10);
    const struct lm_sector_command command = {
        .mode = what->mode,
        .range_index = range_index,
        .fov = what->field,
        .centre = {w->db.centre_latitude, w->db.centre_longitude}};
    lm_sector_start(&sector, &lm_radar_default, &command, 0);
    sector.environment = &fair;
    for (int n = 0; n < count; n++) {
        lm_sector_begin(&sector, &w->tiles, &platform);
        const struct lm_view_from from = {platform.position, platform.heading, 3000 * 1024};
        const struct lm_view view =
            sector.half_m ? lm_view_of_window(&w->frame, &from, command.centre, sector.half_m)
                          : lm_view_of_sector(&w->frame, &from,
                                              lm_radar_default.range[range_index].range_m, false);
        const struct lm_ppi ppi =
            lm_view_ppi(&view, &w->frame, sector.slant.cell_m_q8, sector.edge_m_q8);
        const uint32_t lines = sector.lines;
        for (uint32_t i = 0; i < lines; i++) {
            const uint32_t line =
                lm_sector_draw_line(&sector, &w->tiles, &platform, &w->tone, &w->line);
            lm_scan_conv_sector(&w->plane, &ppi, (fx_bam_t)lm_sector_edge_bam(&sector, line),
                                (fx_bam_t)lm_sector_edge_bam(&sector, line + 1), w->line.grey,
                                sector.slant.cells);
            make_resident(w);
            drawn++;
        }
    }
    printf("lines %u samples %u\n", drawn, sector.samples);
}

static double processor_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

/* The patch of draw_patches by the reference. */
static int draw_reference(const struct world *w, const struct ref_db *db)
{
    const double degrees = 360 / 4294967296.0;
    const struct ref_sar sar = {.centre = {(int32_t)w->db.centre_latitude * degrees,
                                           (int32_t)w->db.centre_longitude * degrees},
                                .azimuth_deg = 37,
                                .range_m = 20000,
                                .antenna_m = 3000,
                                .cell_m = 5,
                                .cell_count = lm_radar_default.sar.cells};
    const struct ref_params params = ref_params_default();
    struct ref_picture picture;
    if (ref_sar_patch(&picture, db, &sar, &params) != 0) {
        return -1;
    }
    ref_picture_free(&picture);
    return 0;
}

static int compare(struct world *w, int runs)
{
    enum { PATCHES = 20 }; /* of the firmware in a run */
    const double pixels = (double)lm_radar_default.sar.cells * lm_radar_default.sar.cells;
    struct ref_db db;
    /* The first patches read and check the tiles. */
    if (ref_db_open_memory(&db, w->image.bytes, w->image.size, "scene") != 0 ||
        draw_patches(w, NULL, CELL_MM, 1) != 0 || draw_reference(w, &db) != 0) {
        return -1;
    }
    for (int n = 0; n < runs; n++) {
        const double start = processor_ns();
        int status = draw_patches(w, NULL, CELL_MM, PATCHES);
        const double middle = processor_ns();
        status |= draw_reference(w, &db);
        const double end = processor_ns();
        if (status != 0) {
            return -1;
        }
        const double firmware_ns = (middle - start) / PATCHES / pixels;
        const double reference_ns = (end - middle) / pixels;
        printf("%.2f %.2f %.1f\n", firmware_ns, reference_ns, reference_ns / firmware_ns);
    }
    ref_db_close(&db);
    return 0;
}

int main(int argc, char **argv)
{
    static struct world world; /* large, and this is a program, not the firmware */
    const char *what = argc == 3 ? argv[1] : "";
    const int count = argc == 3 ? atoi(argv[2]) : 0;
    const bool has_chips = strcmp(what, "chips") == 0, is_finer = strcmp(what, "finer") == 0;
    const int is_patch = has_chips || is_finer || strcmp(what, "sar") == 0,
              is_comparison = strcmp(what, "compare") == 0;
    const struct sector_case *sector = find_case(what);
    if (count < 1 || (!is_patch && !is_comparison && !sector)) {
        fputs("usage: stage_bench sar|finer|chips|gm|exp|dbs1|dbs2|gmt|sea|compare N\n", stderr);
        return 2;
    }
    if (open_world(&world, sector ? 12 : 9) != 0) {
        fputs("stage_bench: the scene could not be made\n", stderr);
        return 1;
    }
    if (is_comparison) {
        return compare(&world, count) != 0;
    }
    if (sector) {
        draw_sweeps(&world, sector, count);
        return 0;
    }
    const struct lm_target_set targets = parked(&world);
    const uint32_t cell_mm = has_chips ? 500 : is_finer ? 1000 : CELL_MM;
    return draw_patches(&world, has_chips ? &targets : NULL, cell_mm, count) != 0;
}
