#include "image/targets.h"

#include "hs/report.h"
#include "hs/zero_bytes.h"
#include "image/grid.h"
#include "image/path.h"
#include "image/scatterer_kinds.h"
#include "image/signatures.h"
#include "lm/target.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static void print_body(const struct lm_scatterer *s)
{
    const bool is_known = s->kind >= LM_SHAPE_SPHERE && s->kind < LM_SHAPE_KINDS;
    printf("        %-9s", is_known ? scatterer_kinds[s->kind].name : "unknown");
    for (int i = 0; is_known && i < scatterer_kinds[s->kind].sizes; i++) {
        printf(" %g", s->size_mm[i] / 1000.0);
    }
    printf(" m at %g %g %g", s->offset_mm[0] / 1000.0, s->offset_mm[1] / 1000.0,
           s->offset_mm[2] / 1000.0);
    if (is_known && scatterer_kinds[s->kind].has_direction) {
        printf(", facing %.3f %.3f, roll %.3f", image_longitude_degrees(s->azimuth),
               image_degrees((int32_t)s->elevation), image_degrees((int32_t)s->roll));
    }
    puts(s->is_two_sided ? ", both sides" : "");
}

static void report_body(const struct lm_scatterer *s)
{
    const bool is_known = s->kind >= LM_SHAPE_SPHERE && s->kind < LM_SHAPE_KINDS;
    hs_report_object(NULL);
    hs_report_text("shape", is_known ? scatterer_kinds[s->kind].name : "unknown");
    hs_report_array("size_m");
    for (int i = 0; is_known && i < scatterer_kinds[s->kind].sizes; i++) {
        hs_report_real(NULL, s->size_mm[i] / 1000.0);
    }
    hs_report_close();
    hs_report_array("offset_m");
    for (int i = 0; i < 3; i++) {
        hs_report_real(NULL, s->offset_mm[i] / 1000.0);
    }
    hs_report_close();
    if (is_known && scatterer_kinds[s->kind].has_direction) {
        hs_report_real("azimuth_deg", image_longitude_degrees(s->azimuth));
        hs_report_real("elevation_deg", image_degrees((int32_t)s->elevation));
        hs_report_real("roll_deg", image_degrees((int32_t)s->roll));
    }
    hs_report_flag("is_two_sided", s->is_two_sided != 0);
    hs_report_close();
}

static void print_leg(const struct lm_path_leg *leg)
{
    const struct lm_position to = image_path_end(leg);
    printf("        via %.6f %.6f: %.1f m on %.2f\n", image_degrees((int32_t)to.latitude),
           image_longitude_degrees(to.longitude), leg->length_mm / 1000.0,
           image_degrees((int64_t)leg->heading));
}

static void report_leg(const struct lm_path_leg *leg)
{
    const struct lm_position to = image_path_end(leg);
    hs_report_object(NULL);
    hs_report_real("end_latitude_deg", image_degrees((int32_t)to.latitude));
    hs_report_real("end_longitude_deg", image_longitude_degrees(to.longitude));
    hs_report_real("length_m", leg->length_mm / 1000.0);
    hs_report_real("heading_deg", image_degrees((int64_t)leg->heading));
    hs_report_close();
}

static void report_motion(const struct lm_target *t)
{
    hs_report_real("speed_m_s", t->speed_mm_s / 1000.0);
    if (!(t->flags & LM_TARGET_HAS_PATH)) {
        hs_report_integer("leg_m", t->leg_m);
        return;
    }
    hs_report_flag("path_is_round", t->path_is_round != 0);
    hs_report_array("path");
    for (int k = 0; lm_target_check(t) == LM_OK && k < t->path_legs; k++) {
        report_leg(&t->path[k]);
    }
    hs_report_close();
}

static void report_echo(const struct lm_target *t)
{
    if (t->flags & LM_TARGET_HAS_SIGNATURE) {
        hs_report_integer("signature", t->signature);
        return;
    }
    if (t->flags & LM_TARGET_IS_BEACON) {
        hs_report_integer("beacon", t->signature & 15);
        hs_report_integer("late_us", t->signature >> 4);
    }
    if (t->scatterer_count == 0) {
        hs_report_integer("swerling", t->swerling);
        hs_report_real("mean_rcs_dbsm", t->mean_rcs_dbsm_q8 / 256.0);
        return;
    }
    hs_report_array("scatterers");
    for (int k = 0; k < t->scatterer_count && k < LM_SCATTERERS_MAX; k++) {
        report_body(&t->scatterers[k]);
    }
    hs_report_close();
}

static void report_target(const struct lm_target *t)
{
    hs_report_object(NULL);
    hs_report_integer("id", t->id);
    hs_report_text_within("name", t->name, sizeof t->name);
    hs_report_real("latitude_deg", image_degrees((int32_t)t->latitude));
    hs_report_real("longitude_deg", image_longitude_degrees(t->longitude));
    hs_report_real("elevation_m", t->elevation_m_q6 / 64.0);
    hs_report_flag("is_above_ground", (t->flags & LM_TARGET_ABOVE_GROUND) != 0);
    hs_report_real("heading_deg", image_degrees((int64_t)t->heading));
    report_echo(t);
    report_motion(t);
    hs_report_close();
}

void image_targets_print(const struct image *image)
{
    if (image->db.target_count == 0) {
        return;
    }
    printf("\ntarget  name              latitude   longitude  elevation m  heading\n");
    hs_report_array("targets");
    for (uint32_t i = 0; i < image->db.target_count; i++) {
        const struct lm_target *t = &image->targets[i];
        printf("%6" PRIu32 "  ", t->id);
        image_name_print(t->name);
        const bool is_above_ground = (t->flags & LM_TARGET_ABOVE_GROUND) != 0;
        printf("%10.6f %11.6f %s%*.1f %8.2f", image_degrees((int32_t)t->latitude),
               image_longitude_degrees(t->longitude), is_above_ground ? "ground" : "",
               is_above_ground ? 6 : 12, t->elevation_m_q6 / 64.0,
               image_degrees((int64_t)t->heading));
        if (t->flags & LM_TARGET_HAS_SIGNATURE) {
            printf("  signature %u", t->signature);
        } else if (t->flags & LM_TARGET_IS_BEACON) {
            printf("  beacon %d, %d us late", t->signature & 15, t->signature >> 4);
        } else if (t->scatterer_count == 0) {
            printf("  swerling %u, mean %.1f dBsm", t->swerling, t->mean_rcs_dbsm_q8 / 256.0);
        }
        if (t->flags & LM_TARGET_HAS_PATH) {
            printf("  moving %.1f m/s%s", t->speed_mm_s / 1000.0,
                   t->path_is_round ? ", round" : "");
        } else if (t->speed_mm_s != 0) {
            printf("  moving %.1f m/s, leg %" PRIu32 " m", t->speed_mm_s / 1000.0, t->leg_m);
        }
        putchar('\n');
        for (int k = 0; lm_target_check(t) == LM_OK && k < t->path_legs; k++) {
            print_leg(&t->path[k]);
        }
        for (int k = 0; k < t->scatterer_count && k < LM_SCATTERERS_MAX; k++) {
            print_body(&t->scatterers[k]);
        }
        report_target(t);
    }
    hs_report_close();
}

/* What the firmware does not look at: unused numbers of the record. */
static bool rest_is_zero(const struct lm_target *t)
{
    const size_t used = strnlen(t->name, sizeof t->name);
    bool rest = db_is_zero(t->reserved, sizeof t->reserved) &&
                db_is_zero(t->name + used, sizeof t->name - used);
    for (int i = 0; i < t->scatterer_count; i++) {
        const struct lm_scatterer *s = &t->scatterers[i];
        rest = rest && s->reserved == 0 &&
               (scatterer_kinds[s->kind].sizes == 2 || s->size_mm[1] == 0) &&
               (s->kind == LM_SHAPE_PLATE || !s->is_two_sided);
    }
    const size_t used_bytes = t->path_legs * sizeof t->path[0] +
                              t->scatterer_count * sizeof t->scatterers[0]; /* one of them is 0 */
    const bool is_point = t->scatterer_count == 0 && !(t->flags & LM_TARGET_HAS_SIGNATURE);
    return rest && (is_point || (t->swerling == 0 && t->mean_rcs_dbsm_q8 == 0)) &&
           db_is_zero((const uint8_t *)t->scatterers + used_bytes,
                      sizeof t->scatterers - used_bytes);
}

/* Does a sound path begin at the target, go from leg to leg without a step, and come back when it
 * is round? */
static bool path_hangs_together(const struct lm_target *t)
{
    const struct lm_position begin = {t->latitude, t->longitude};
    struct lm_position at = begin;
    for (int i = 0; i < t->path_legs; i++) {
        if (t->path[i].latitude != at.latitude || t->path[i].longitude != at.longitude) {
            return false;
        }
        at = image_path_end(&t->path[i]);
    }
    return t->path_legs == 0 ||
           (t->heading == t->path[0].heading &&
            (!t->path_is_round || image_path_apart_m(begin, at) <= IMAGE_PATH_SLACK_M));
}

static bool id_is_new(const struct image *image, uint32_t index)
{
    for (uint32_t i = 0; i < index; i++) {
        if (image->targets[i].id == image->targets[index].id) {
            return false;
        }
    }
    return true;
}

void image_targets_check(const struct image *image, struct image_findings *findings)
{
    for (uint32_t i = 0; i < image->db.target_count; i++) {
        const struct lm_target *t = &image->targets[i];
        const uint64_t at = image->db.targets_offset + (uint64_t)i * LM_TARGET_BYTES;
        if (lm_target_check(t) != LM_OK) {
            image_find(findings, at,
                       "target %" PRIu32
                       ": its checksum does not fit it, or a number is out of "
                       "its range",
                       i);
        } else if ((t->flags & LM_TARGET_HAS_SIGNATURE) &&
                   t->signature >= image->db.signature_count) {
            image_find(findings, at, "target %" PRIu32 ": its signature %u is not in the image", i,
                       t->signature);
        } else if (!path_hangs_together(t)) {
            image_find(findings, at, "target %" PRIu32 ": its path has gaps", i);
        } else if (!rest_is_zero(t)) {
            image_find(findings, at, "target %" PRIu32 ": unused numbers are not zero", i);
        }
        if (!id_is_new(image, i)) {
            image_find(findings, at, "target %" PRIu32 ": its id is another one's", i);
        }
    }
}
