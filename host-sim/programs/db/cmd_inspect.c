#include "commands.h"

#include "hs/error.h"
#include "hs/options.h"
#include "hs/report.h"
#include "image/codes.h"
#include "image/grid.h"
#include "image/reader.h"
#include "image/signatures.h"
#include "image/targets.h"
#include "lm/sensor.h"
#include "signature.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const struct hs_usage usage = {
    "inspect", "print what a database image holds",
    "Prints header, signature, sections, bands, levels, extents, classes, "
    "targets, signatures and manifest. `verify` checks the image's every byte."};

static void report_position(const char *key, int32_t latitude, uint32_t longitude)
{
    hs_report_object(key);
    hs_report_put("latitude_deg", image_degrees(latitude));
    hs_report_put("longitude_deg", image_longitude_degrees(longitude));
    hs_report_close();
}

static void report_header(const struct image *image)
{
    const struct lm_image_header *h = &image->header;
    hs_report_text_within("title", h->title, LM_IMAGE_TITLE_BYTES);
    hs_report_put("format_version", h->version);
    hs_report_put("bytes", h->image_bytes);
    hs_report_put("sensor", lm_sensor_word(h->sensor));
    hs_report_put("radar", image->has_radar ? image->radar.name : NULL);
    hs_report_put("bus_table", image->bus_name[0] ? image->bus_name : NULL);
    report_position("centre", (int32_t)h->centre_latitude, h->centre_longitude);
    hs_report_put("mean_elevation_m", h->mean_elevation_m_q6 / 64.0);
    hs_report_put("geoid_m", h->geoid_m_q6 / 64.0);
    if (image->db.geoid.rows > 0) {
        const struct lm_geoid *g = &image->db.geoid;
        hs_report_object("geoid_grid");
        hs_report_put("rows", g->rows);
        hs_report_put("columns", g->columns);
        hs_report_put("latitude_step_deg", ldexp(360, g->latitude_shift - 32));
        hs_report_put("longitude_step_deg", ldexp(360, g->longitude_shift - 32));
        hs_report_close();
    }
    if (image->db.geoid_pages.rows > 0) {
        const struct lm_geoid_pages *p = &image->db.geoid_pages;
        hs_report_object("geoid_pages");
        hs_report_put("rows", p->rows);
        hs_report_put("columns", p->columns);
        hs_report_put("step_deg", ldexp(360, (int)p->shift - 32));
        hs_report_close();
    }
    hs_report_put("finest_cell_m", ldexp(IMAGE_METRES_PER_BAM, h->shift0));
    hs_report_put("finest_cell_shift", h->shift0);
}

static void report_section(const struct lm_image_section *s)
{
    char crc[9];
    snprintf(crc, sizeof crc, "%08" PRIx32, s->crc);
    hs_report_object(NULL);
    hs_report_put("name", image_section_name(s->type));
    hs_report_put("offset_bytes", s->offset);
    hs_report_put("bytes", s->bytes);
    hs_report_put("crc", crc);
    hs_report_close();
}

static void print_header(const struct image *image)
{
    const struct lm_image_header *h = &image->header;
    printf("title           %.*s\n", LM_IMAGE_TITLE_BYTES, h->title);
    printf("version         %" PRIu32 "\n", h->version);
    printf("bytes           %" PRIu64 "\n", h->image_bytes);
    printf("sensor          %s\n", lm_sensor_word(h->sensor));
    printf("radar           %s\n",
           image->has_radar ? image->radar.name : "none: the display's own");
    printf("bus table       %s\n",
           image->bus_name[0] ? image->bus_name : "none: the display's own");
    db_signature_print(image);
    printf("centre          %.6f, %.6f\n", image_degrees((int32_t)h->centre_latitude),
           image_longitude_degrees(h->centre_longitude));
    printf("mean elevation  %.1f m above mean sea level\n", h->mean_elevation_m_q6 / 64.0);
    printf("geoid           %.1f m above WGS-84\n", h->geoid_m_q6 / 64.0);
    if (image->db.geoid.rows > 0) {
        const struct lm_geoid *g = &image->db.geoid;
        printf("geoid grid      %u x %u nodes, %.3f x %.3f degrees apart\n", g->rows, g->columns,
               ldexp(360, g->latitude_shift - 32), ldexp(360, g->longitude_shift - 32));
    }
    const struct lm_geoid_pages *pages = &image->db.geoid_pages;
    if (pages->rows > 0) {
        printf("geoid pages     %u x %u, nodes %.3f degrees apart\n", pages->rows, pages->columns,
               ldexp(360, (int)pages->shift - 32));
    }
    printf("finest cell     %.3f m (shift0 %u)\n", ldexp(IMAGE_METRES_PER_BAM, h->shift0),
           h->shift0);
    report_header(image);
    printf("\nsection     offset         bytes  crc\n");
    hs_report_array("sections");
    for (uint32_t i = 0; i < h->section_count; i++) {
        const struct lm_image_section *s = &h->sections[i];
        printf("%-9s %8" PRIu64 "  %12" PRIu64 "  %08" PRIx32 "\n", image_section_name(s->type),
               s->offset, s->bytes, s->crc);
        report_section(s);
    }
    hs_report_close();
}

static void report_band(const struct lm_band *b, const struct image_frame *first,
                        const struct image_frame *last, uint32_t width)
{
    hs_report_object(NULL);
    hs_report_put("level", b->lod);
    hs_report_put("zone", b->zone);
    hs_report_put("south_deg", image_degrees(first->south));
    hs_report_put("west_deg", image_longitude_degrees(first->west));
    hs_report_put("north_deg", image_degrees(last->south));
    hs_report_put("east_deg", image_longitude_degrees(first->west + width));
    hs_report_put("rows", b->rows);
    hs_report_put("columns", b->columns);
    hs_report_close();
}

static void print_bands(const struct image *image)
{
    printf("\nlevel zone      south       west      north       east        rows     columns\n");
    hs_report_array("bands");
    for (uint32_t i = 0; i < image->header.band_count; i++) {
        const struct lm_band *b = &image->db.bands[i];
        const uint8_t shift = (uint8_t)(image->header.shift0 + b->lod);
        const struct image_frame first = image_frame_of(shift, b->zone, b->row0, b->column0);
        const struct image_frame last = image_frame_of(shift, b->zone, b->row0 + b->rows, 0);
        const uint32_t width =
            (uint32_t)((uint64_t)b->columns * LM_TILE_CELLS << (shift + b->zone));
        printf("%5u %4u %10.5f %10.5f %10.5f %10.5f  %10" PRIu32 "  %10" PRIu32 "\n", b->lod,
               b->zone, image_degrees(first.south), image_longitude_degrees(first.west),
               image_degrees(last.south), image_longitude_degrees(first.west + width), b->rows,
               b->columns);
        report_band(b, &first, &last, width);
    }
    hs_report_close();
}

/* Tiles of a level, or of all, and how their records are stored. */
struct stored {
    uint32_t tiles, compressed;
    uint64_t bytes;
};

static void count_tiles(const struct image *image, const struct lm_band *b, struct stored *n)
{
    const uint32_t end = b->entry0 + b->rows * b->columns;
    for (uint32_t entry = b->entry0; entry < end; entry++) {
        const struct lm_tile_entry *e = &image->entries[entry];
        if (e->place != LM_TILE_ABSENT) {
            n->tiles++;
            n->compressed += e->encoding == LM_TILE_LZ4;
            n->bytes += (uint64_t)e->size * LM_DB_PLACE_BYTES;
        }
    }
}

/* The directory counts as part of what a cell takes. */
static void print_stored(const struct image *image, const struct stored *all)
{
    const double bytes =
        (double)all->bytes + (double)image->header.entry_count * sizeof(struct lm_tile_entry);
    const double bytes_a_cell = bytes / ((double)all->tiles * LM_TILE_CELLS * LM_TILE_CELLS);
    printf("records         %" PRIu32 " compressed, %" PRIu32
           " raw; %.3f bytes a cell with their "
           "directory\n",
           all->compressed, all->tiles - all->compressed, bytes_a_cell);
    hs_report_put("compressed_records", all->compressed);
    hs_report_put("bytes_a_cell", bytes_a_cell);
}

static void print_levels(const struct image *image)
{
    struct stored levels[LM_DB_LODS_MAX] = {{0}}, all = {0};
    for (uint32_t i = 0; i < image->header.band_count; i++) {
        const struct lm_band *b = &image->db.bands[i];
        count_tiles(image, b, &levels[b->lod]);
        count_tiles(image, b, &all);
    }
    printf("\nlevel     cell m       tiles         bytes\n");
    hs_report_array("levels");
    for (int level = 0; level < image->header.lod_count; level++) {
        const double cell_m = ldexp(IMAGE_METRES_PER_BAM, image->header.shift0 + level);
        const struct stored *n = &levels[level];
        printf("%5d %10.2f  %10" PRIu32 "  %12" PRIu64 "\n", level, cell_m, n->tiles, n->bytes);
        hs_report_object(NULL);
        hs_report_put("level", level);
        hs_report_put("cell_m", cell_m);
        hs_report_put("tiles", n->tiles);
        hs_report_put("bytes", n->bytes);
        hs_report_close();
    }
    hs_report_close();
    print_stored(image, &all);
}

static void report_class(int number, const struct lm_class *c, const char *kind)
{
    char colour[8];
    snprintf(colour, sizeof colour, "#%02x%02x%02x", c->colour[0], c->colour[1], c->colour[2]);
    hs_report_object(NULL);
    hs_report_put("class", number);
    hs_report_text_within("name", c->name, sizeof c->name);
    hs_report_put("kind", kind);
    hs_report_put("gamma_db", c->gamma_db_q8 / 256.0);
    hs_report_put("spread_db", c->spread_db_q8 / 256.0);
    hs_report_put("height_m", c->height_dm / 10.0);
    hs_report_put("looks", c->looks);
    hs_report_put("colour", colour);
    hs_report_close();
}

static void print_classes(const struct image *image)
{
    static const char *const kinds[] = {"ground", "water", "structure", "trees"};
    printf("\nclass name             kind       gamma dB  spread dB  height m  looks  colour\n");
    hs_report_array("classes");
    for (int i = 0; i < LM_DB_CLASS_NONE; i++) {
        const struct lm_class *c = &image->db.classes.entry[i];
        const char *kind = c->kind <= LM_KIND_TREES ? kinds[c->kind] : "unknown";
        if (c->name[0]) {
            printf("%5d %-16.16s %-9s %9.2f  %9.2f  %8.1f  %5u  %02x%02x%02x\n", i, c->name, kind,
                   c->gamma_db_q8 / 256.0, c->spread_db_q8 / 256.0, c->height_dm / 10.0, c->looks,
                   c->colour[0], c->colour[1], c->colour[2]);
            report_class(i, c, kind);
        }
    }
    hs_report_close();
    char heights[160];
    image_heights_text(image->db.classes.height_dm, heights, sizeof heights);
    printf("heights m      %s\n", heights);
    image_heights_report(image->db.classes.height_dm);
}

/* Control characters of a damaged or hostile file do not reach the terminal. */
static void print_manifest(const struct image *image)
{
    const struct lm_image_section *s = image->sections[LM_IMAGE_MANIFEST];
    hs_report_text_within("manifest", (const char *)image->bytes + s->offset, s->bytes);
    putchar('\n');
    for (uint64_t i = 0; i < s->bytes; i++) {
        const uint8_t c = image->bytes[s->offset + i];
        putchar(c == '\n' || (c >= ' ' && c != 127) ? c : '?');
    }
}

int db_cmd_inspect(int argc, char **argv)
{
    const char *path = NULL;
    int exit_code;
    const struct hs_option options[] = {
        {"FILE", HS_INPUT_ARGUMENT, &path, 0, 0, NULL, "the database image", true},
    };
    if (!hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    struct image image;
    if (image_open(&image, path) != 0) {
        return HS_EXIT_FAILED;
    }
    print_header(&image);
    print_levels(&image);
    print_bands(&image);
    print_classes(&image);
    image_targets_print(&image);
    image_signatures_print(&image);
    print_manifest(&image);
    image_close(&image);
    return HS_EXIT_OK;
}
