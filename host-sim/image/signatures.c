#include "image/signatures.h"

#include "hs/report.h"
#include "hs/signature_file.h"
#include "image/grid.h"

#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

void image_name_print(const char name[16])
{
    for (int i = 0; i < 16; i++) {
        putchar(name[i] == '\0' ? ' ' : name[i] > ' ' && name[i] < 127 ? name[i] : '?');
    }
}

/* Of all looks, in dBsm. */
static double mean_rcs_dbsm(const struct lm_signature *s)
{
    double sum = 0;
    for (uint32_t i = 0; i < db_signature_chips(s); i++) {
        const uint8_t code = s->rcs[i / s->aspects][i % s->aspects];
        sum += code > 0 ? pow(10, (code / 2.0 - 80) / 10) : 0;
    }
    return 10 * log10(sum / db_signature_chips(s));
}

static void report_signature(const struct lm_signature *s, bool is_sound)
{
    hs_report_object(NULL);
    hs_report_text_within("name", s->name, sizeof s->name);
    hs_report_flag("is_sound", is_sound);
    if (is_sound) {
        hs_report_put("aspects", s->aspects);
        hs_report_put("pixel_m", s->pixel_mm / 1000.0);
        hs_report_put("height_m", s->height_mm / 1000.0);
        hs_report_put("mean_rcs_dbsm", mean_rcs_dbsm(s));
        hs_report_array("depressions_deg");
        for (int d = 0; d < s->depressions; d++) {
            hs_report_put(NULL, image_degrees((int32_t)s->depression[d]));
        }
        hs_report_close();
    }
    hs_report_close();
}

void image_signatures_print(const struct image *image)
{
    if (image->db.signature_count == 0) {
        return;
    }
    printf("\nsignature  name              aspects  pixel m  height m  mean dBsm  depressions\n");
    hs_report_array("signatures");
    for (uint32_t i = 0; i < image->db.signature_count; i++) {
        const struct lm_signature *s = &image->signatures[i];
        printf("%9" PRIu32 "  ", i);
        image_name_print(s->name);
        const bool is_sound = lm_signature_check(s, image->db.chip_count) == LM_OK;
        report_signature(s, is_sound);
        if (!is_sound) {
            puts("  damaged");
            continue;
        }
        printf("  %7u  %7.3f  %8.1f  %9.1f ", s->aspects, s->pixel_mm / 1000.0,
               s->height_mm / 1000.0, mean_rcs_dbsm(s));
        for (int d = 0; d < s->depressions; d++) {
            printf(" %.4g", image_degrees((int32_t)s->depression[d]));
        }
        putchar('\n');
    }
    hs_report_close();
}

static void check_chips(const struct image *image, uint32_t number, struct image_findings *findings)
{
    const struct lm_signature *s = &image->signatures[number];
    for (uint32_t i = 0; i < db_signature_chips(s); i++) {
        const struct lm_chip *c = &image->chips[s->chip0 + i];
        const uint64_t at = image->db.chips_offset + (uint64_t)(s->chip0 + i) * LM_CHIP_BYTES;
        if (lm_chip_check(c, number, i % s->aspects, i / s->aspects) != LM_OK) {
            image_find(findings, at,
                       "signature %" PRIu32 ", chip %" PRIu32
                       ": its checksum does not fit it, or it is another one",
                       number, i);
        } else if (!db_chip_rest_is_zero(c)) {
            image_find(findings, at,
                       "signature %" PRIu32 ", chip %" PRIu32 ": unused bytes are not zero", number,
                       i);
        }
    }
}

/* Its chips when it is sound, 0 when not. */
static uint32_t check_signature(const struct image *image, uint32_t number,
                                struct image_findings *findings)
{
    const struct lm_signature *s = &image->signatures[number];
    const uint64_t at = image->db.signatures_offset + (uint64_t)number * LM_SIGNATURE_BYTES;
    if (lm_signature_check(s, image->db.chip_count) != LM_OK) {
        image_find(findings, at,
                   "signature %" PRIu32
                   ": its checksum does not fit it, or a number is out of its "
                   "range",
                   number);
        return 0;
    }
    if (!db_signature_rest_is_zero(s)) {
        image_find(findings, at, "signature %" PRIu32 ": unused bytes are not zero", number);
    }
    check_chips(image, number, findings);
    return db_signature_chips(s);
}

void image_signatures_check(const struct image *image, struct image_findings *findings)
{
    uint64_t chips = 0;
    for (uint32_t i = 0; i < image->db.signature_count; i++) {
        chips += check_signature(image, i, findings);
    }
    /* A chip says whose it is: so the sum tells whether there is one that nobody has. */
    if (chips != image->db.chip_count) {
        image_find(findings, image->db.chips_offset,
                   "%" PRIu32 " chips, %" PRIu64 " of them in sound signatures",
                   image->db.chip_count, chips);
    }
}
