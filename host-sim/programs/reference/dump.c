#include "dump.h"

#include "hs/atomic_file.h"
#include "hs/error.h"

#include <string.h>

enum { COLUMNS = 23 };

const char ref_dump_columns[] =
    "line,cell,range_m,latitude_deg,longitude_deg,has_data,class,kind,gamma_db,height_m,elevation_"
    "m,"
    "tangent,horizon,rise,is_lit,gain_db,edge_db,level_db,grain,class_gain_db,echo_db,brightness,"
    "grey";

static void fill_row(double row[COLUMNS], unsigned line, int cell, const struct ref_bin *bin)
{
    const double values[COLUMNS] = {line,
                                    cell,
                                    bin->range_m,
                                    bin->place.latitude_deg,
                                    bin->place.longitude_deg,
                                    bin->has_data,
                                    bin->class_index,
                                    bin->kind,
                                    bin->gamma_db,
                                    bin->height_m,
                                    bin->elevation_m,
                                    bin->tangent,
                                    bin->horizon,
                                    bin->rise,
                                    bin->is_lit,
                                    bin->gain_db,
                                    bin->edge_db,
                                    bin->level_db,
                                    bin->grain,
                                    bin->class_gain_db,
                                    bin->echo_db,
                                    bin->brightness,
                                    bin->grey};
    memcpy(row, values, sizeof values);
}

static void write_row(FILE *stream, bool is_raw, const double row[COLUMNS])
{
    if (is_raw) {
        fwrite(row, sizeof row[0], COLUMNS, stream);
        return;
    }
    for (int i = 0; i < COLUMNS; i++) {
        fprintf(stream, "%s%.12g", i > 0 ? "," : "", row[i]);
    }
    fputc('\n', stream);
}

int ref_dump(const struct ref_picture *picture, const char *path)
{
    const size_t length = strlen(path);
    const bool is_raw = length > 4 && strcmp(path + length - 4, ".f64") == 0;
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    if (!is_raw) {
        fprintf(file.stream, "%s\n", ref_dump_columns);
    }
    for (unsigned line = 0; line < picture->line_count; line++) {
        for (int cell = 0; cell < (int)picture->cell_count; cell++) {
            double row[COLUMNS];
            fill_row(row, line, cell, ref_picture_bin(picture, line, cell));
            write_row(file.stream, is_raw, row);
        }
    }
    return hs_atomic_commit(&file);
}
