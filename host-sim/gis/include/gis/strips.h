/* Strips: a raster that is made in parts, each some rows of it, on whatever machine. They are cut
 * at multiples of DB_STRIP_ROWS, and whole rasters are written in steps of DB_STRIP_WRITE, so that
 * strips put together are, byte for byte, the file that is written in one go. */
#ifndef GIS_STRIPS_H
#define GIS_STRIPS_H

#include "gis/raster.h"

enum { DB_STRIP_ROWS = 1024, DB_STRIP_WRITE = 256, DB_STRIPS_MAX = 256 };

/* Metadata of a strip, "2 of 16"; counted from 0. */
#define DB_STRIP_ITEM "LANDMASS_STRIP"

/* Rows `first` .. `end` - 1. */
struct db_rows {
    int first, end;
};

/* `rows` and `reach` more on either side, as far as the raster goes. */
struct db_rows db_rows_around(struct db_rows rows, int reach, const struct db_grid *grid);

/* The options of a command that makes strips. */
struct db_strip_options {
    long shard, shards; /* -1 and 0: the whole raster */
    const char *plan;   /* NULL: no plan is wanted */
};

#define DB_STRIP_DEFAULTS                                                                          \
    (struct db_strip_options)                                                                      \
    {                                                                                              \
        -1, 0, NULL                                                                                \
    }

/* Five entries for the table of such a command. */
#define DB_STRIP_OPTIONS(o)                                                                        \
    {.name = "shards",                                                                             \
     .kind = HS_INTEGER,                                                                           \
     .target = &(o)->shards,                                                                       \
     .low = 1,                                                                                     \
     .high = DB_STRIPS_MAX,                                                                        \
     .value_name = "N",                                                                            \
     .help =                                                                                       \
         "Cut the raster into N strips of rows, of 1,024 or a multiple of it. `landmass-db "       \
         "mosaic`\n"                                                                               \
         "puts them together: the bytes of a run in one go."},                                     \
        {.name = "shard",                                                                          \
         .kind = HS_INTEGER,                                                                       \
         .target = &(o)->shard,                                                                    \
         .low = 0,                                                                                 \
         .high = DB_STRIPS_MAX - 1,                                                                \
         .value_name = "K",                                                                        \
         .help = "Make strip K alone, counted from 0."},                                           \
        {.name = "plan",                                                                           \
         .kind = HS_OUTPUT,                                                                        \
         .target = &(o)->plan,                                                                     \
         .value_name = "FILE",                                                                     \
         .help =                                                                                   \
             "Instead of a raster write a text that says of each strip which rows it has and "     \
             "which\n"                                                                             \
             "files reach into it."},                                                              \
        HS_NEEDS_ROW("shard", "shards"), HS_NEEDS_ROW("plan", "shards")

/* NULL, or what is wrong with the options that stand together; *option is the one to name. */
const char *db_strips_fault(const struct db_strip_options *o, const char *out, const char **option);

/* The rows of the strip that is to be made: of all where none is. Returns 0, or -1 reported: there
 * are more strips than multiples of DB_STRIP_ROWS, or no such strip. */
int db_strips_rows(const struct db_strip_options *o, const struct db_grid *grid,
                   struct db_rows *rows);

/* The grid of some rows. The CRS is borrowed from `whole`. */
struct db_grid db_strips_grid(const struct db_grid *whole, struct db_rows rows);

/* Say in the strip which one it is; nothing for a whole raster. */
void db_strips_tag(struct db_raster_out *out, const struct db_strip_options *o);

/* Write the plan: the raster's size, and of each strip its rows and the files of `rasters` within
 * `reach` rows of it. What a raster that is put together of others (VRT) has elsewhere is left out;
 * other files and `plain` ones reach everywhere. Returns 0, or -1 with the error reported. */
struct db_strip_sources {
    const struct db_raster *const *rasters;
    int raster_count;
    const char *const *plain; /* NULL entries are passed over */
    int plain_count;
    int reach;
};
int db_strips_write_plan(const struct db_strip_options *o, const struct db_grid *grid,
                         const struct db_strip_sources *sources);

/* Rows on their way into a raster: gathered to DB_STRIP_WRITE of them, then written and flushed. */
struct db_row_writer {
    struct db_raster_out *out; /* borrowed */
    uint8_t *held;             /* owned */
    size_t row_bytes;
    int next, count; /* the row of the raster behind what is held; rows held */
};

/* Returns 0, or -1 out of memory, reported. */
int db_row_writer_init(struct db_row_writer *w, struct db_raster_out *out);
/* The next `rows` rows. Returns 0, or -1 with the error reported. */
int db_row_writer_add(struct db_row_writer *w, int rows, const void *pixels);
/* Write what is held. */
int db_row_writer_end(struct db_row_writer *w);
/* Harmless on a zeroed struct. */
void db_row_writer_free(struct db_row_writer *w);

#endif
