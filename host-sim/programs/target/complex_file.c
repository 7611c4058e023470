#include "complex_file.h"

#include "sicd.h"

#include "gis/complex_raster.h"
#include "hs/error.h"
#include "tracer/ends.h"

#include <math.h>
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

/* Returns how many there are. ENDS are the distance, then azimuth, depression and distance of a
 * receiver apart. */
static int make_notes(const struct setup *s, const struct trace_records *r,
                      enum focus_weighting weighting,
                      struct db_complex_note notes[DB_COMPLEX_NOTES_MAX])
{
    note_real(&notes[0], "WAVELENGTH_M", r->look.wavelength_m);
    note_real(&notes[1], "RADAR_AZIMUTH_DEG", r->look.azimuth_deg);
    note_real(&notes[2], "DEPRESSION_DEG", r->look.depression_deg);
    note_real(&notes[3], "PIXEL_M", (double)s->ratio * r->grid.cell_m);
    note_real(&notes[4], "RESOLUTION_M", s->resolution_m);
    note_text(&notes[5], "WEIGHTING", focus_weighting_names[weighting]);
    static const char *const channels[REFLECT_CHANNELS] = {"", " HH", " HV", " VH", " VV"};
    char law[sizeof notes[6].value];
    snprintf(law, sizeof law, "%s%s", s->law, channels[s->channel]);
    note_text(&notes[6], "LAW", law);
    note_text(&notes[7], "ORDER", "slant range, far on top; left of the radar first");
    note_text(&notes[8], "CALIBRATION", "|pixel|^2 of a point: m^2; phase -4 pi range/wavelength");
    const struct trace_ends *e = &r->ends;
    if (ends_are_plain(e)) {
        return DB_COMPLEX_NOTES_MAX - 1;
    }
    char text[sizeof notes[9].value];
    if (e->is_apart) {
        snprintf(text, sizeof text, "%.5g; %.5g %.5g %.5g", e->distance_m, e->receiver_azimuth_deg,
                 e->receiver_depression_deg, e->receiver_distance_m);
    } else {
        snprintf(text, sizeof text, "%.5g", e->distance_m);
    }
    note_text(&notes[9], "ENDS", text);
    return DB_COMPLEX_NOTES_MAX;
}

/* Level ground at the target's height: slant range over cos(depression), and the picture turned as
 * the radar looks. */
static struct db_complex_place place_of(const struct complex_site *site,
                                        const struct trace_records *r, double pixel_m)
{
    const double deg = 3.14159265358979323846 / 180, flattening = 1 / 298.257223563;
    const double e2 = flattening * (2 - flattening), latitude = site->latitude_deg * deg;
    const double w = sqrt(1 - e2 * pow(sin(latitude), 2)), a_m = 6378137;
    const double north_m_deg = a_m * (1 - e2) / pow(w, 3) * deg;
    const double east_m_deg = a_m * cos(latitude) / w * deg;
    const double look = (site->heading_deg + r->look.azimuth_deg + 180) * deg;
    const double near_m = pixel_m / cos(r->look.depression_deg * deg); /* a row down */
    const double width = r->grid.cells_across * r->grid.cell_m / pixel_m;
    const double height = r->grid.cells_range * r->grid.cell_m / pixel_m;
    struct db_complex_place p = {
        {0, cos(look) * pixel_m / east_m_deg, -sin(look) * near_m / east_m_deg, 0,
         -sin(look) * pixel_m / north_m_deg, -cos(look) * near_m / north_m_deg}};
    p.degrees[0] = site->longitude_deg - (width * p.degrees[1] + height * p.degrees[2]) / 2;
    p.degrees[3] = site->latitude_deg - (width * p.degrees[4] + height * p.degrees[5]) / 2;
    return p;
}

/* Rows away from the radar, columns to its left: the chip from its last column to its first. */
static int write_sicd(const struct sicd *s, const char *path, const float complex *chip)
{
    struct db_sicd sicd;
    char *text = sicd_text(s, sicd.corners);
    float complex *turned = malloc((size_t)s->width * (size_t)s->height * sizeof *turned);
    int result = -1;
    if (text && turned) {
        for (int i = 0; i < s->width * s->height; i++) {
            turned[i] = chip[i / s->width * s->width + s->width - 1 - i % s->width];
        }
        sicd.text = text;
        result = db_sicd_write(path, turned, s->width, s->height, &sicd);
    } else if (text) {
        hs_error(path, "give fewer --cells", "out of memory");
    }
    free(text);
    free(turned);
    return result;
}

int complex_file_write(const struct setup *s, const struct trace_records *r,
                       enum focus_weighting weighting, const struct complex_site *site,
                       const char *path, const float complex *chip)
{
    struct db_complex_note notes[DB_COMPLEX_NOTES_MAX];
    const size_t width = r->grid.cells_across / (uint32_t)s->ratio;
    const size_t height = r->grid.cells_range / (uint32_t)s->ratio;
    const double pixel_m = (double)s->ratio * r->grid.cell_m;
    const struct db_complex_place place =
        site ? place_of(site, r, pixel_m) : (struct db_complex_place){0};
    if (site && db_complex_is_nitf(path)) {
        const struct sicd sicd = {s, r, weighting, site, (int)width, (int)height, place.degrees};
        return write_sicd(&sicd, path, chip);
    }
    float complex *turned = malloc(width * height * sizeof *turned);
    if (!turned) {
        return hs_error(path, "give fewer --cells", "out of memory");
    }
    for (size_t row = 0; row < height; row++) {
        memcpy(turned + row * width, chip + (height - 1 - row) * width, width * sizeof *turned);
    }
    const int count = make_notes(s, r, weighting, notes);
    const int result =
        db_complex_write(path, turned, (int)width, (int)height, notes, count, site ? &place : NULL);
    free(turned);
    return result;
}
