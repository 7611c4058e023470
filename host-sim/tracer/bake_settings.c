#include "tracer/bake_settings.h"

#include "bake_sheet.h"

#include "hs/error.h"
#include "hs/number.h"
#include "hs/report.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const double usual_depressions_deg[] = {5, 10, 15, 20, 30, 45};
enum { USUAL_DEPRESSIONS = sizeof usual_depressions_deg / sizeof usual_depressions_deg[0] };

struct bake_settings bake_settings_default(double gain_db)
{
    return (struct bake_settings){.aspects = 72, .gain_db = gain_db, .mean_dbsm = NAN};
}

void bake_settings_free(struct bake_settings *s)
{
    hs_list_free(&s->depressions);
}

void bake_options(struct bake_settings *s, struct hs_option *o)
{
    const struct hs_option options[BAKE_OPTIONS] = {
        {"out", HS_OUTPUT, &s->out, 0, 0, "FILE.sig", "the signature", true},
        {"name", HS_TEXT, &s->name, 0, 0, "NAME",
         "of the signature, up to 16 letters; left out: that of the file", false},
        {"aspects", HS_INTEGER, &s->aspects, 1, LM_SIGNATURE_ASPECTS_MAX, "N",
         "from how many sides, evenly around", false},
        {"depressions", HS_LIST, &s->depressions, 0, 0, "DEG,DEG...",
         "of the line of sight below the horizon, up to 8, rising, each 1 to 89; left out:\n"
         "5,10,15,20,30,45",
         false},
        {"pixel", HS_REAL, &s->pixel_m, 0, LM_SIGNATURE_PIXEL_MAX_MM / 1000.0, "M",
         "of the chips, 64 either way; 0: the smallest that hold the model and its shadow", false},
        {"gain", HS_REAL, &s->gain_db, -100, 100, "DB", "of cross sections over what is traced",
         false},
        {"mean", HS_REAL, &s->mean_dbsm, -80, 80, "DBSM",
         "in place of --gain: what the model's cross section shall be, as a mean over all looks",
         false},
        {"sheet", HS_OUTPUT, &s->sheet, 0, 0, "FILE.png",
         "chips to look at: a row for each depression", false},
    };
    memcpy(o, options, sizeof options);
}

static int read_depressions(const struct bake_settings *s, struct bake_looks *looks)
{
    looks->depressions = s->depressions.count;
    if (looks->depressions == 0) {
        looks->depressions = USUAL_DEPRESSIONS;
        memcpy(looks->depression_deg, usual_depressions_deg, sizeof usual_depressions_deg);
    } else if (looks->depressions > LM_SIGNATURE_DEPRESSIONS_MAX) {
        return hs_error("--depressions", NULL, "at most %d", LM_SIGNATURE_DEPRESSIONS_MAX);
    }
    double last = 0;
    for (int i = 0; i < s->depressions.count; i++) {
        double degrees;
        if (!hs_number_within(s->depressions.items[i], 1, 89, &degrees) || degrees <= last) {
            return hs_error("--depressions", "give rising numbers from 1 to 89",
                            "\"%s\" will not do", s->depressions.items[i]);
        }
        looks->depression_deg[i] = last = degrees;
    }
    return 0;
}

/* The file's name without folder and ending. */
static const char *default_name(const char *path, char name[17])
{
    const char *slash = strrchr(path, '/');
    const char *file = slash ? slash + 1 : path;
    snprintf(name, 17, "%.*s", (int)strcspn(file, "."), file);
    return name;
}

static int check_name(const char *name)
{
    bool is_plain = *name != '\0' && strlen(name) <= sizeof((struct lm_signature *)0)->name;
    for (const char *c = name; *c; c++) {
        is_plain = is_plain && *c > ' ' && *c < 127;
    }
    return is_plain ? 0
                    : hs_error("--name", "give 1 to 16 letters without blanks", "\"%s\" is no name",
                               name);
}

int bake_plan(const struct bake_settings *s, const struct setup *setup, const struct mesh *m,
              struct bake_order *o)
{
    *o = (struct bake_order){
        .name = s->name,
        .place = setup->model,
        .looks = {.aspects = s->aspects},
        .wavelength_m = setup->wavelength_m,
        .rays_per_cell = (uint32_t)setup->rays_per_cell,
        .bounces = (uint32_t)setup->bounces,
        .threads = (uint32_t)setup->threads,
        .gain_db = s->gain_db,
        .mean_dbsm = s->mean_dbsm,
    };
    if ((s->name && check_name(s->name) != 0) || read_depressions(s, &o->looks) != 0) {
        return -1;
    }
    return bake_layout(&o->layout, m, &o->looks, s->pixel_m, setup->model);
}

static void print_report(const struct db_signature *s, const struct bake_report *r, double seconds)
{
    const uint32_t chips = db_signature_chips(&s->head);
    printf("%.16s: %" PRIu32
           " chips, %u aspects by %u depressions, pixels of %.3f m, origin at row "
           "%u, %.1f m high, %zu bytes\n",
           s->head.name, chips, s->head.aspects, s->head.depressions, s->head.pixel_mm / 1000.0,
           s->head.origin_row, s->head.height_mm / 1000.0,
           sizeof(struct lm_signatures_head) + sizeof s->head + chips * sizeof *s->chips);
    printf(
        "cross section %.1f dBsm in the mean, %.1f to %.1f; gain %.2f dB; %.2f %% of the power "
        "fell outside the chips; %.1f s\n",
        r->mean_dbsm, r->least_dbsm, r->most_dbsm, r->gain_db, 100 * r->lost_share, seconds);
}

static void report_signature(const struct db_signature *s, const struct bake_report *r)
{
    hs_report_text_within("name", s->head.name, sizeof s->head.name);
    hs_report_put("chips", db_signature_chips(&s->head));
    hs_report_put("aspects", s->head.aspects);
    hs_report_put("depressions", s->head.depressions);
    hs_report_put("pixel_m", s->head.pixel_mm / 1000.0);
    hs_report_put("origin_row", s->head.origin_row);
    hs_report_put("height_m", s->head.height_mm / 1000.0);
    hs_report_put("mean_rcs_dbsm", r->mean_dbsm);
    hs_report_put("least_rcs_dbsm", r->least_dbsm);
    hs_report_put("greatest_rcs_dbsm", r->most_dbsm);
    hs_report_put("gain_db", r->gain_db);
    hs_report_put("lost_share", r->lost_share);
    hs_report_put("saturated_pixels", r->saturated);
}

static double now_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int bake_run(const struct bake_settings *s, const struct bake_order *order, const struct mesh *m)
{
    struct bake_order o = *order;
    struct db_signature signature;
    struct bake_report report;
    char name[17];
    const double start = now_seconds();
    o.name = o.name ? o.name : default_name(s->out, name);
    if (check_name(o.name) != 0 || bake(&o, m, &signature, &report) != 0) {
        return -1;
    }
    int result = db_signature_write(&signature, s->out);
    if (result == 0 && s->sheet) {
        result = bake_sheet(&signature, s->sheet);
    }
    if (result == 0) {
        print_report(&signature, &report, now_seconds() - start);
        report_signature(&signature, &report);
    }
    if (result == 0 && report.saturated > 0) {
        hs_warn(s->out, "give a smaller --gain or --mean",
                "%" PRIu32 " pixels are brighter than the brightest code, 47.5 dBsm",
                report.saturated);
    }
    db_signature_free(&signature);
    return result;
}
