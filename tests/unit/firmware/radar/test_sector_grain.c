/* The grain of sectors: looks of each mode by what the dwell offers, and how wide a grain is.
 * docs/EQUATIONS.md, "Speckle". */
#include "check.h"
#include "hs/angle.h"
#include "scales.h"
#include "sector_world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Soil of -10 dB, far above the noise. */
static struct tiny_cell even_cell(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    (void)p;
    return (struct tiny_cell){-10, TINY_SOIL, 0};
}

struct grain {
    double enl, along, across; /* correlation of powers one bin and one line away */
};

/* The powers before noise of some sweeps, flown at 250 m/s, `off_deg` right of the track. Bins
 * 100..199, where even ground is even after beam and pulse, and lines within a few degrees. */
static struct grain grain_of(struct sector_world *w, const struct lm_sector_command *command,
                             double off_deg)
{
    enum { FIRST = 100, END = 200, SWEEPS = 12 };
    double n = 0, sum = 0, squares = 0, along = 0, across = 0;
    static uint32_t before[LM_CELLS_ROOM];
    w->platform.track = w->platform.heading - hs_bam(off_deg);
    start_sector(w, command, NULL, NULL);
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        bool has_before = false;
        do {
            const uint32_t *power = w->sector.power_q24;
            const double azimuth_deg = line_azimuth_deg(&w->sector, draw_line(w));
            const bool is_in = fabs(azimuth_deg) < 2;
            for (int i = FIRST; is_in && i < END; i++) {
                const double x = ldexp(power[i], -24);
                n++;
                sum += x;
                squares += x * x;
                along += x * ldexp(power[i + 1], -24);
                across += x * ldexp(has_before ? before[i] : power[i], -24);
            }
            memcpy(before, power, sizeof before);
            has_before = is_in;
        } while (!lm_sector_is_at_edge(&w->sector));
    }
    const double mean = sum / n, variance = squares / n - mean * mean;
    return (struct grain){mean * mean / variance, (along / n - mean * mean) / variance,
                          (across / n - mean * mean) / variance};
}

static struct sector_world *make_plain(void)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.cell = even_cell;
    spec.shift0 = 13;
    spec.rows = spec.columns = 8;
    struct sector_world *w = make_sector_world(&spec);
    w->platform = (struct lm_platform){
        .position = {w->map.db.centre_latitude - FX_BAM_DEG(1) / 10, w->map.db.centre_longitude},
        .height_m_q10 = 3000 * 1024,
        .speed_mm_s = 250000};
    return w;
}

/* N(o) = 2 V B^2 sin o / (l w). */
static double available(const struct sector_world *w, double rate_deg_s, double off_deg)
{
    const double rad = acos(-1) / 180, beam = hs_degrees(w->radar.antenna.azimuth_beam) * rad;
    return 2 * 250 * beam * beam * sin(off_deg * rad) /
           (w->radar.wavelength_um * 1e-6 * rate_deg_s * rad);
}

TEST(looks_are_what_the_dwell_offers_and_sharpening_leaves)
{
    struct sector_world *w = make_plain();
    static const struct {
        const char *name;
        uint8_t fov;
        double rate_deg_s, sharpening, off_deg;
    } cases[] = {{"GM", LM_FOV_NORM, 120, 1, 45},
                 {"GM", LM_FOV_NORM, 120, 1, 20},
                 {"DBS1", LM_FOV_DBS1, 15, 8, 45},
                 {"DBS2", LM_FOV_DBS2, 3, 64, 45}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct lm_sector_command command = {.range_index = scale_of(10),
                                                  .azimuth_index = 2,
                                                  .fov = cases[i].fov,
                                                  .centre = place_at(w, 0, 12000)};
        const double wanted =
            available(w, cases[i].rate_deg_s, cases[i].off_deg) / cases[i].sharpening;
        const struct grain g = grain_of(w, &command, cases[i].off_deg);
        print_message("# %s %.0f degrees off: ENL %.1f of %.1f; next bin %.2f, next line %.2f\n",
                      cases[i].name, cases[i].off_deg, g.enl, wanted, g.along, g.across);
        assert_true(fabs(g.enl / wanted - 1) < 0.2);
        assert_true(g.across > 0.5); /* a grain is as wide as the beam */
    }
    free_sector_world(w);
}

TEST(the_ground_map_is_coarser_near_the_track)
{
    struct sector_world *w = make_plain();
    const struct lm_sector_command command = {.range_index = scale_of(10), .azimuth_index = 2};
    const double near = grain_of(w, &command, 5).enl, far = grain_of(w, &command, 45).enl;
    print_message("# GM: ENL %.1f at 5 degrees, %.1f at 45\n", near, far);
    assert_true(near < far / 4);
    free_sector_world(w);
}
