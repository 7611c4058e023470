#include "complex_file.h"

#include "gis/complex_raster.h"
#include "hs/error.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void note_real(struct db_complex_note *n, const char *name, double value)
{
    n->name = name;
    snprintf(n->value, sizeof n->value, "%.9g", value);
}

static void note_text(struct db_complex_note *n, const char *name, const char *value)
{
    n->name = name;
    snprintf(n->value, sizeof n->value, "%s", value);
}

static void make_notes(const struct setup *s, const struct trace_records *r,
                       enum focus_weighting weighting,
                       struct db_complex_note notes[DB_COMPLEX_NOTES_MAX])
{
    note_real(&notes[0], "WAVELENGTH_M", r->look.wavelength_m);
    note_real(&notes[1], "RADAR_AZIMUTH_DEG", r->look.azimuth_deg);
    note_real(&notes[2], "DEPRESSION_DEG", r->look.depression_deg);
    note_real(&notes[3], "PIXEL_M", (double)s->ratio * r->grid.cell_m);
    note_real(&notes[4], "RESOLUTION_M", s->resolution_m);
    note_text(&notes[5], "WEIGHTING", focus_weighting_names[weighting]);
    note_text(&notes[6], "LAW", s->law);
    note_text(&notes[7], "ORDER", "slant range, far on top; left of the radar first");
    note_text(&notes[8], "CALIBRATION", "|pixel|^2 of a point: m^2; phase -4 pi range/wavelength");
}

int complex_file_write(const struct setup *s, const struct trace_records *r,
                       enum focus_weighting weighting, const char *path, const float complex *chip)
{
    struct db_complex_note notes[DB_COMPLEX_NOTES_MAX];
    const size_t width = r->grid.cells_across / (uint32_t)s->ratio;
    const size_t height = r->grid.cells_range / (uint32_t)s->ratio;
    float complex *turned = malloc(width * height * sizeof *turned);
    if (!turned) {
        return hs_error(path, "give fewer --cells", "out of memory");
    }
    for (size_t row = 0; row < height; row++) {
        memcpy(turned + row * width, chip + (height - 1 - row) * width, width * sizeof *turned);
    }
    make_notes(s, r, weighting, notes);
    const int result =
        db_complex_write(path, turned, (int)width, (int)height, notes, DB_COMPLEX_NOTES_MAX);
    free(turned);
    return result;
}
