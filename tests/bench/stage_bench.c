/* The work that `make bench` measures: whole pictures from an image made in memory, all tiles
 * resident.
 *
 *   stage_bench sar N         draw N patches and print nothing: callgrind counts the instructions
 *                             of the functions called here (tests/bench/bench.sh)
 *   stage_bench chips N       the same with 16 targets that have a signature, cells of 0.5 m
 *   stage_bench gm|exp|dbs1|dbs2|gmt|sea N
 *                             N sweeps; prints the lines drawn and sampled
 *   stage_bench image FILE    write the image that the patches are drawn of (tests/cortex-m7)
 *   stage_bench compare N     N times: processor time a pixel of a patch, by the firmware and by
 * the reference in double precision, both without the image's checks */
#include "golden_signature.h"
#include "lm/sector.h"
#include "lm/view.h"
#include "patch_rig.h"
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
    struct patch_rig rig;
    struct lm_chip_source chip_source;
    struct lm_target targets[TARGETS];
};

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
    void *pool = malloc(PATCH_RIG_TILES * sizeof(struct lm_tile));
    uint8_t *pixels = calloc(PATCH_RIG_PX, PATCH_RIG_PX);
    return pool && pixels
               ? patch_rig_open(&w->rig, w->image.bytes, w->image.size, NULL, pool, pixels)
               : -1;
}

/* Four rows of four, 25 m apart, each turned another way. */
static struct lm_target_set parked(struct world *w)
{
    const fx_bam_t apart = (fx_bam_t)(25 / 9.3e-3);
    for (uint32_t i = 0; i < TARGETS; i++) {
        w->targets[i] = (struct lm_target){
            .latitude = w->rig.db.centre_latitude + (i / 4 - 2) * apart,
            .longitude = w->rig.db.centre_longitude + (i % 4 - 2) * apart * 3 / 2,
            .heading = i * FX_BAM_DEG(23),
            .flags = LM_TARGET_ABOVE_GROUND | LM_TARGET_HAS_SIGNATURE,
        };
    }
    w->chip_source = (struct lm_chip_source){w->rig.db.chips_offset, 0};
    lm_chips_init(&w->rig.chips, &w->chip_source, &w->rig.signature);
    return (struct lm_target_set){.items = w->targets,
                                  .count = TARGETS,
                                  .signatures = &w->rig.signature,
                                  .signature_count = 1};
}

/* `targets` may be NULL. */
static int draw_patches(struct world *w, const struct lm_target_set *targets, uint32_t cell_mm,
                        int count)
{
    for (int n = 0; n < count; n++) {
        if (patch_rig_begin(&w->rig, targets, cell_mm) != LM_OK) {
            return -1;
        }
        patch_rig_draw(&w->rig, true);
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
        .position = {w->rig.db.centre_latitude - (fx_bam_t)(8000 / 9.3e-3),
                     w->rig.db.centre_longitude},
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
        .centre = {w->rig.db.centre_latitude, w->rig.db.centre_longitude}};
    lm_sector_start(&sector, &lm_radar_default, &command, 0);
    sector.environment = &fair;
    for (int n = 0; n < count; n++) {
        lm_sector_begin(&sector, &w->rig.tiles, &platform);
        const struct lm_view_from from = {platform.position, platform.heading, 3000 * 1024};
        const struct lm_view view =
            sector.half_m ? lm_view_of_window(&w->rig.frame, &from, command.centre, sector.half_m)
                          : lm_view_of_sector(&w->rig.frame, &from,
                                              lm_radar_default.range[range_index].range_m, false);
        const struct lm_ppi ppi =
            lm_view_ppi(&view, &w->rig.frame, sector.slant.cell_m_q8, sector.edge_m_q8);
        const uint32_t lines = sector.lines;
        for (uint32_t i = 0; i < lines; i++) {
            const uint32_t line =
                lm_sector_draw_line(&sector, &w->rig.tiles, &platform, &w->rig.tone, &w->rig.line);
            lm_scan_conv_sector(&w->rig.plane, &ppi, (fx_bam_t)lm_sector_edge_bam(&sector, line),
                                (fx_bam_t)lm_sector_edge_bam(&sector, line + 1), w->rig.line.grey,
                                sector.slant.cells);
            patch_rig_make_resident(&w->rig);
            drawn++;
        }
    }
    printf("lines %u samples %u\n", drawn, sector.samples);
}

static int write_image(const struct world *w, const char *path)
{
    FILE *file = fopen(path, "wb");
    const bool is_written = file && fwrite(w->image.bytes, 1, w->image.size, file) == w->image.size;
    if (!file || fclose(file) != 0 || !is_written) {
        fprintf(stderr, "stage_bench: %s cannot be written\n", path);
        return 1;
    }
    return 0;
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
    const struct ref_sar sar = {.centre = {(int32_t)w->rig.db.centre_latitude * degrees,
                                           (int32_t)w->rig.db.centre_longitude * degrees},
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
        draw_patches(w, NULL, PATCH_RIG_CELL_MM, 1) != 0 || draw_reference(w, &db) != 0) {
        return -1;
    }
    for (int n = 0; n < runs; n++) {
        const double start = processor_ns();
        int status = draw_patches(w, NULL, PATCH_RIG_CELL_MM, PATCHES);
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
    const bool is_image = strcmp(what, "image") == 0;
    const int count = is_image ? 1 : argc == 3 ? atoi(argv[2]) : 0;
    const bool has_chips = strcmp(what, "chips") == 0, is_finer = strcmp(what, "finer") == 0;
    const int is_patch = has_chips || is_finer || strcmp(what, "sar") == 0,
              is_comparison = strcmp(what, "compare") == 0;
    const struct sector_case *sector = find_case(what);
    if (count < 1 || (!is_patch && !is_comparison && !sector && !is_image)) {
        fputs(
            "usage: stage_bench sar|finer|chips|gm|exp|dbs1|dbs2|gmt|sea|compare N\n"
            "       stage_bench image FILE\n",
            stderr);
        return 2;
    }
    if (open_world(&world, sector ? 12 : 9) != 0) {
        fputs("stage_bench: the scene could not be made\n", stderr);
        return 1;
    }
    if (is_image) {
        return write_image(&world, argv[2]);
    }
    if (is_comparison) {
        return compare(&world, count) != 0;
    }
    if (sector) {
        draw_sweeps(&world, sector, count);
        return 0;
    }
    const struct lm_target_set targets = parked(&world);
    const uint32_t cell_mm = has_chips ? 500 : is_finer ? 1000 : PATCH_RIG_CELL_MM;
    return draw_patches(&world, has_chips ? &targets : NULL, cell_mm, count) != 0;
}
