/* Radar tap: the pictures of the real firmware as numbers, tapped before they become grey. The
 * checks of this folder (realism.py) measure them.
 *
 *   realism_tap font        print the firmware's font, a row of dots a line
 *   realism_tap IMAGE DIR   draw what standard input asks for, a picture a line:
 *
 *     sar NAME KEY=VALUE...      lat lon cell_mm look range_m height_m plan epoch
 *     sector NAME KEY=VALUE...   lat lon height_m heading track speed_m_s mode fov nm
 *                                clat clon sweeps epoch sea wind tilt
 *                                mover_m mover_az mover_mps mover_dbsm
 *     dbs NAME KEY=VALUE...      speed_m_s fov line
 *
 * Angles are degrees. A picture becomes DIR/NAME.raw, int32 planes one after the other, and
 * DIR/NAME.head, their names and sizes and the numbers of the geometry.
 *
 * Levels are those that lm_sar_draw_line and lm_sector_draw_line make: dB of gamma times 256, all
 * effects in them, before the tone curve. The grey that the curve makes of them stands beside. */
#include "drv/flash_file.h"
#include "hs/angle.h"
#include "lm/dbs.h"
#include "lm/environment.h"
#include "lm/font.h"
#include "lm/sar.h"
#include "lm/sector.h"
#include "lm/unit_map.h"
#include "lm/units.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POOL_TILES = LM_TILE_SLOTS_MAX, POLLS_MAX = 1000000, LINE_MAX = 1024, SWEEPS_MAX = 64 };

struct tap {
    struct drv_flash_file flash;
    struct lm_unit_map map;
    struct lm_line line;
    struct lm_sar sar;
    struct lm_sector sector;
    struct lm_tone tone;
    void *pool;
    const char *folder;
    char name[64];     /* of the picture */
    const char *words; /* KEY=VALUE... of the picture */
};

/* Value of a key of the picture's line, or `otherwise`. */
static double number_of(const struct tap *t, const char *key, double otherwise)
{
    const size_t length = strlen(key);
    for (const char *p = t->words; (p = strstr(p, key)); p += length) {
        if (p > t->words && p[-1] == ' ' && p[length] == '=') {
            return strtod(p + length + 1, NULL);
        }
    }
    return otherwise;
}

static fx_bam_t angle_of(const struct tap *t, const char *key)
{
    return hs_bam(number_of(t, key, 0));
}

static struct lm_position place_of(const struct tap *t, const char *latitude, const char *longitude)
{
    return (struct lm_position){angle_of(t, latitude), angle_of(t, longitude)};
}

static FILE *open_output(const struct tap *t, const char *suffix)
{
    char path[LINE_MAX];
    snprintf(path, sizeof path, "%s/%s.%s", t->folder, t->name, suffix);
    FILE *file = fopen(path, "wb");
    if (!file) {
        perror(path);
        exit(1);
    }
    return file;
}

static bool is_read(const struct tap *t)
{
    return lm_tile_cache_is_idle(&t->map.tiles) && lm_chips_are_settled(&t->map.chips);
}

static void read_tiles(struct tap *t)
{
    for (int i = 0; i < POLLS_MAX && !is_read(t); i++) {
        lm_unit_map_service(&t->map, NULL, 0);
    }
}

/* ---- patch ---- */

enum { CELLS = 256 };

/* Planes of a patch, [line][cell]. */
enum { LEVEL, GREY, CELL, ELEVATION, HEIGHT_DM, PLANES };
static int32_t patch[PLANES][LM_PATCH_LINES_MAX][CELLS];

static void keep_ground(const struct tap *t, uint32_t number)
{
    const struct lm_scan_line *ground = &t->line.ground;
    for (uint32_t i = 0; i < CELLS; i++) {
        const uint32_t cell = ground->cell[i + t->sar.overscan];
        patch[CELL][number][i] = (int32_t)cell;
        patch[ELEVATION][number][i] = ground->elevation_m_q14[i + t->sar.overscan];
        patch[HEIGHT_DM][number][i] = t->map.db.classes.height_dm[cell & 15];
    }
}

static void prefetch_patch(struct tap *t)
{
    for (uint32_t line = 0; line < t->sar.lines; line += 4) {
        lm_sar_prefetch(&t->sar, &t->map.tiles, line);
        read_tiles(t);
    }
    lm_sar_prefetch(&t->sar, &t->map.tiles, t->sar.lines - 1);
    lm_sar_prefetch_targets(&t->sar, &t->map.tiles);
    read_tiles(t);
}

/* Relief of a patch from tiles that are resident, as the unit takes it. */
static struct lm_sar_relief relief_of(struct tap *t, const struct lm_sar_command *command)
{
    (void)lm_sar_relief_of(&t->map.tiles, &lm_radar_default, command);
    read_tiles(t);
    return lm_sar_relief_of(&t->map.tiles, &lm_radar_default, command);
}

static int start_patch(struct tap *t, const struct lm_environment *environment)
{
    const struct lm_sar_command command = {
        .centre = place_of(t, "lat", "lon"),
        .cell_mm = (uint32_t)number_of(t, "cell_mm", 5000),
        .look_azimuth = angle_of(t, "look"),
        .range_m = (uint32_t)number_of(t, "range_m", 20000),
        .height_m_q6 = (int32_t)(number_of(t, "height_m", 3000) * 64),
        .is_plan = number_of(t, "plan", 0) != 0,
    };
    const struct lm_sar_setup setup = {.targets = &t->map.target_set,
                                       .chips = &t->map.chips,
                                       .relief = relief_of(t, &command),
                                       .epoch = (uint32_t)number_of(t, "epoch", 0),
                                       .sea_state = environment->sea_state,
                                       .environment = environment};
    return lm_sar_start(&t->sar, &lm_radar_default, &t->map.db, &command, &setup);
}

/* Ground is that of the line sampled last: lines are sampled one by one and their ground kept. */
static void draw_patch_line(struct tap *t)
{
    const uint32_t number = t->sar.line;
    for (bool is_ready = false; !is_ready;) {
        const uint32_t sampled = t->sar.sampled;
        is_ready = lm_sar_sample_ahead(&t->sar, &t->map.tiles, 1, &t->line);
        if (t->sar.sampled != sampled) {
            keep_ground(t, sampled);
        }
    }
    const int16_t *level_db_q8 = lm_sar_draw_line(&t->sar, &t->map.tiles, &t->tone, &t->line);
    for (uint32_t i = 0; i < CELLS; i++) {
        patch[LEVEL][number][i] = level_db_q8[i];
        patch[GREY][number][i] = t->line.grey[i];
    }
}

static int draw_patch(struct tap *t)
{
    const struct lm_environment fair = {.sea_state = LM_SEA_STATE_OF_IMAGE};
    if (start_patch(t, &fair) != LM_OK) {
        fprintf(stderr, "realism_tap: %s: the patch was refused\n", t->name);
        return -1;
    }
    prefetch_patch(t);
    lm_tone_set(&t->tone, &lm_radar_default.sar.tone);
    while (t->sar.line < t->sar.lines) {
        draw_patch_line(t);
    }
    FILE *raw = open_output(t, "raw"), *head = open_output(t, "head");
    for (int plane = 0; plane < PLANES; plane++) {
        fwrite(patch[plane], sizeof patch[plane][0], t->sar.lines, raw);
    }
    fprintf(head, "planes level grey cell elevation height_dm\nshape %u %d\nlod %u\n", t->sar.lines,
            CELLS, t->sar.lod);
    fprintf(head, "reference_m %.3f\nfloor_db %.3f\n", t->sar.grid.reference_m_q10 / 1024.0,
            lm_radar_default.sar.noise_floor_db_q8 / 256.0);
    fprintf(head, "black_db %.3f\nwhite_db %.3f\n", lm_radar_default.sar.tone.black_db_q8 / 256.0,
            lm_radar_default.sar.tone.white_db_q8 / 256.0);
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        const struct lm_class *class = &t->map.db.classes.entry[i];
        if (class->name[0] != '\0') {
            fprintf(head, "class %.16s %u\n", class->name, class->kind);
        }
    }
    fclose(head);
    return fclose(raw);
}

/* ---- sector ---- */

static void draw_sweep(struct tap *t, const struct lm_platform *platform, int32_t *level,
                       int32_t *grey)
{
    do {
        const uint32_t line =
            lm_sector_draw_line(&t->sector, &t->map.tiles, platform, &t->tone, &t->line);
        const uint32_t cells = t->sector.slant.cells;
        for (uint32_t i = 0; level && i < cells; i++) {
            level[(size_t)line * cells + i] = t->sector.level_db_q8[i];
            grey[(size_t)line * cells + i] = t->line.grey[i];
        }
        read_tiles(t);
    } while (!lm_sector_is_at_edge(&t->sector));
}

static void write_sector(struct tap *t, const struct lm_platform *platform, uint32_t sweeps)
{
    const size_t count = (size_t)t->sector.lines * t->sector.slant.cells;
    int32_t *level = calloc(2 * count, sizeof *level);
    FILE *raw = open_output(t, "raw"), *head = open_output(t, "head");
    fprintf(head, "planes");
    for (uint32_t n = 0; level && n < sweeps; n++) {
        draw_sweep(t, platform, level, level + count);
        fwrite(level, sizeof *level, 2 * count, raw);
        fprintf(head, " level%u grey%u", n, n);
    }
    fprintf(head, "\nshape %u %u\nlod %u\n", t->sector.lines, t->sector.slant.cells, t->sector.lod);
    fprintf(head, "heading %.9f\nleft %.9f\nwidth %.9f\n", hs_degrees(t->sector.up),
            hs_degrees((fx_bam_t)t->sector.left), hs_degrees(t->sector.width));
    fprintf(head, "edge_m %.4f\ncell_m %.6f\nreference_m %.3f\nhalf_m %u\n",
            t->sector.edge_m_q8 / 256.0, t->sector.slant.cell_m_q8 / 256.0,
            t->sector.grid.reference_m_q10 / 1024.0, t->sector.half_m);
    free(level);
    fclose(head);
    fclose(raw);
}

/* A vehicle of that cross section on the line of sight, which comes nearer by mover_mps. */
static struct lm_target mover_of(const struct tap *t, const struct lm_platform *platform)
{
    struct lm_geo_origin origin;
    const fx_bam_t azimuth = platform->heading + angle_of(t, "mover_az");
    lm_geo_set_origin(&origin, platform->position);
    const struct lm_position place =
        lm_geo_direct(&origin, azimuth, (uint32_t)number_of(t, "mover_m", 0) * 256);
    return (struct lm_target){
        .id = 1,
        .latitude = place.latitude,
        .longitude = place.longitude,
        .elevation_m_q6 = 3 * 64,
        .heading = azimuth + FX_BAM_180,
        .flags = LM_TARGET_ABOVE_GROUND,
        .mean_rcs_dbsm_q8 = (int32_t)(number_of(t, "mover_dbsm", 30) * 256),
        .speed_mm_s = (uint32_t)(number_of(t, "mover_mps", 0) * 1000),
        .leg_m = 1000,
    };
}

static int draw_sector(struct tap *t)
{
    const struct lm_environment weather = {
        .sea_state = (uint8_t)number_of(t, "sea", LM_SEA_STATE_OF_IMAGE),
        .has_wind = number_of(t, "wind", -1) >= 0,
        .wind_from = angle_of(t, "wind"),
    };
    const struct lm_platform platform = {
        .position = place_of(t, "lat", "lon"),
        .height_m_q10 = (int32_t)(number_of(t, "height_m", 3000) * 1024),
        .heading = angle_of(t, "heading"),
        .track = angle_of(t, "track"),
        .speed_mm_s = (uint32_t)(number_of(t, "speed_m_s", 250) * 1000),
    };
    const struct lm_sector_command command = {
        .mode = (uint8_t)number_of(t, "mode", LM_SECTOR_GM),
        .fov = (uint8_t)number_of(t, "fov", LM_FOV_NORM),
        .range_index =
            (uint8_t)lm_radar_find_range(&lm_radar_default, (uint8_t)number_of(t, "nm", 10)),
        .centre = place_of(t, "clat", "clon"),
        .beam = {.is_tilt_manual = number_of(t, "tilt", 1000) < 1000,
                 .tilt = (int32_t)hs_bam(number_of(t, "tilt", 0))},
    };
    const struct lm_target mover = mover_of(t, &platform);
    const struct lm_target_set movers = {.items = &mover, .count = 1};
    const uint32_t epoch = (uint32_t)number_of(t, "epoch", 0);
    const uint32_t sweeps = (uint32_t)fmin(number_of(t, "sweeps", 1), SWEEPS_MAX);
    lm_tone_set(&t->tone, &lm_radar_default.mode[command.mode].tone);
    /* The first sweep reads the tiles. */
    for (int is_read = 0; is_read < 2; is_read++) {
        lm_sector_start(&t->sector, &lm_radar_default, &command, epoch);
        t->sector.environment = &weather;
        t->sector.targets = number_of(t, "mover_m", 0) > 0 ? &movers : NULL;
        if (!is_read) {
            draw_sweep(t, &platform, NULL, NULL);
        }
    }
    lm_sector_begin(&t->sector, &t->map.tiles, &platform);
    write_sector(t, &platform, sweeps);
    return 0;
}

/* Sharpening of the lines of a window from the velocity to 60 degrees off it, `line` degrees apart.
 */
static int print_sharpening(const struct tap *t)
{
    const struct lm_radar *radar = &lm_radar_default;
    const struct lm_fov_row *fov = &radar->fov[(uint8_t)number_of(t, "fov", LM_FOV_DBS1)];
    const struct lm_dbs_scan scan = {.bam_per_s = fov->bam_per_s,
                                     .speed_mm_s =
                                         (uint32_t)(number_of(t, "speed_m_s", 250) * 1000),
                                     .line = hs_bam(number_of(t, "line", 0.1))};
    FILE *head = open_output(t, "head");
    fprintf(head, "ratio");
    for (fx_bam_t off = 0; off <= FX_BAM_DEG(60); off += scan.line) {
        fprintf(head, " %.3f", lm_dbs_sharpening_q8(radar, &scan, fov->sharpening, off) / 256.0);
    }
    fprintf(head, "\n");
    return fclose(head);
}

/* ---- program ---- */

static int open_image(struct tap *t, const char *path)
{
    const size_t bytes = POOL_TILES * sizeof(struct lm_tile);
    t->pool = malloc(bytes);
    if (!t->pool || drv_flash_file_open(&t->flash, path) != 0) {
        fprintf(stderr, "realism_tap: %s: cannot be opened\n", path);
        return -1;
    }
    const struct lm_unit_map_lent lent = {.flash = &t->flash.port,
                                          .tile_pool = t->pool,
                                          .tile_pool_bytes = bytes,
                                          .flash_poll_limit = POLLS_MAX};
    if (lm_unit_map_open(&t->map, &lent) != LM_OK || !t->map.is_usable) {
        fprintf(stderr, "realism_tap: %s: is no image that the firmware opens\n", path);
        return -1;
    }
    return 0;
}

static int draw(struct tap *t, const char *line)
{
    char kind[16];
    int used = 0;
    if (sscanf(line, "%15s %63s%n", kind, t->name, &used) != 2) {
        return 0;
    }
    t->words = line + used; /* each key has a space before it */
    return strcmp(kind, "sar") == 0      ? draw_patch(t)
           : strcmp(kind, "sector") == 0 ? draw_sector(t)
           : strcmp(kind, "dbs") == 0    ? print_sharpening(t)
                                         : -1;
}

static int print_font(void)
{
    for (int c = ' '; c <= '~'; c++) {
        const uint8_t *glyph = lm_font_glyph((char)c);
        for (int row = 0; row < LM_FONT_HEIGHT; row++) {
            printf("%d%c", glyph[row], row == LM_FONT_HEIGHT - 1 ? '\n' : ' ');
        }
    }
    return 0;
}

int main(int argc, char **argv)
{
    static struct tap tap; /* large, and this is a program, not the firmware */
    static char line[LINE_MAX];
    if (argc == 2 && strcmp(argv[1], "font") == 0) {
        return print_font();
    }
    if (argc != 3) {
        fputs("usage: realism_tap font | IMAGE DIR <pictures (tests/realism/tap.c)\n", stderr);
        return 2;
    }
    tap.folder = argv[2];
    if (open_image(&tap, argv[1]) != 0) {
        return 1;
    }
    while (fgets(line, sizeof line, stdin)) {
        if (draw(&tap, line) != 0) {
            return 1;
        }
    }
    free(tap.pool);
    drv_flash_file_close(&tap.flash);
    return 0;
}
