/* Specific targets from their text file into an image and back: by the builder, the checker and the
 * firmware. */
#include "build/targets.h"
#include "image/path.h"
#include "image_damage.h"

#include "hs/angle.h"
#include "hs/rng.h"
#include "lm/target.h"

#include "check.h"
#include "fx/crc32c.h"
#include "memory_flash.h"
#include "scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char text[] =
    "# everything that a file may say\n"
    "target corners 47.01 8.02 451.5 30 scatterers   # a remark\n"
    "  sphere 0.5  1 2 3\n"
    "  plate 0.3 0.7  -10.25 0 1  350 20 45 both\n"
    "  dihedral 0.4 2  0 0 0  -90 0\n"
    "\ttrihedral 1.25  262.144 -262.144 0.001  0 35.264\n"
    "target truck -33.5 -70.25 -3 359.5 swerling 3 12.5\n"
    "target sixteen_letters_ 0 360 0 -45 swerling 0 -20\n"
    "target ferry 47 8 ground+2.5 90 swerling 1 30 moving 7.5 4000\n"
    "target convoy 47 8 ground 45 scatterers moving 16 100000\n"
    "  sphere 0.5  0 0 -1.5\n"
    "target bus 47 8 ground 0 swerling 1 30 moving 12\n"
    "  via 47.01 8.01\n"
    "  via 47.01 8.03\n"
    "target patrol 47 8 ground 77 swerling 0 30 moving 12.5\n"
    "  via 47.01 8\n"
    "  via 47 8.02\n"
    "  via 47 8\n";

TEST(a_file_says_all_that_a_record_holds)
{
    struct build_targets t;
    scene_text("all.targets", text);
    assert_int_equal(build_targets_read(&t, scene_path("all.targets")), 0);
    assert_int_equal(t.count, 7);
    const struct lm_target *c = &t.items[0];
    assert_string_equal(c->name, "corners");
    assert_true(fabs(hs_degrees(c->latitude) - 47.01) < 1e-7);
    assert_true(fabs(hs_degrees(c->longitude) - 8.02) < 1e-7);
    assert_int_equal(c->elevation_m_q6, 451.5 * 64);
    assert_true(fabs(hs_degrees(c->heading) - 30) < 1e-7);
    assert_int_equal(c->scatterer_count, 4);
    const struct lm_scatterer *plate = &c->scatterers[1];
    assert_int_equal(plate->kind, LM_SHAPE_PLATE);
    assert_int_equal(plate->is_two_sided, 1);
    assert_int_equal(plate->size_mm[0], 300);
    assert_int_equal(plate->size_mm[1], 700);
    assert_int_equal(plate->offset_mm[0], -10250);
    assert_true(fabs(hs_degrees(plate->azimuth) + 10) < 1e-7);
    assert_true(fabs(hs_degrees(plate->elevation) - 20) < 1e-7);
    assert_true(fabs(hs_degrees(plate->roll) - 45) < 1e-7);
    assert_int_equal(c->scatterers[3].offset_mm[1], -LM_TARGET_OFFSET_MAX_MM);
    assert_int_equal(t.items[1].scatterer_count, 0);
    assert_int_equal(t.items[1].swerling, 3);
    assert_int_equal(t.items[1].mean_rcs_dbsm_q8, 12.5 * 256);
    assert_memory_equal(t.items[2].name, "sixteen_letters_", 16);
    assert_int_equal(t.items[2].flags, 0);
    assert_int_equal(t.items[2].speed_mm_s, 0);
    assert_int_equal(t.items[3].flags, LM_TARGET_ABOVE_GROUND);
    assert_int_equal(t.items[3].elevation_m_q6, 160);
    assert_int_equal(t.items[3].speed_mm_s, 7500);
    assert_int_equal(t.items[3].leg_m, 4000);
    assert_int_equal(t.items[4].flags, LM_TARGET_ABOVE_GROUND);
    assert_int_equal(t.items[4].elevation_m_q6, 0);
    assert_int_equal(t.items[4].speed_mm_s, 16000);
    assert_int_equal(t.items[4].leg_m, LM_TARGET_LEG_MAX_M);
    assert_int_equal(t.items[4].scatterer_count, 1);
    assert_int_equal(t.items[5].flags, LM_TARGET_ABOVE_GROUND | LM_TARGET_HAS_PATH);
    assert_int_equal(t.items[5].leg_m, 0);
    assert_int_equal(t.items[5].path_legs, 2);
    assert_int_equal(t.items[5].path_is_round, 0);
    assert_int_equal(t.items[6].path_legs, 3);
    assert_int_equal(t.items[6].path_is_round, 1);
    assert_int_equal(t.items[6].heading, t.items[6].path[0].heading);
    for (uint32_t i = 0; i < t.count; i++) {
        assert_int_equal(t.items[i].id, i);
        assert_int_equal(lm_target_check(&t.items[i]), LM_OK);
    }
    build_targets_free(&t);
}

TEST(a_beacon_has_a_code_and_perhaps_a_delay)
{
    static const char *const wrong[] = {"beacon",      "beacon 16",    "beacon 1.5", "beacon -1",
                                        "beacon 1 16", "beacon 1 2 3", "beacon x"};
    struct build_targets t;
    scene_text("beacons.targets",
               "target a 46 11 ground+20 0 beacon 5\n"
               "target b 46 11 0 0 beacon 15 10 moving 8 6000\n");
    assert_int_equal(build_targets_read(&t, scene_path("beacons.targets")), 0);
    assert_int_equal(t.items[0].signature, 5);
    assert_int_equal(t.items[0].flags, LM_TARGET_ABOVE_GROUND | LM_TARGET_IS_BEACON);
    assert_int_equal(t.items[1].signature, 0xaf);
    assert_int_equal(t.items[1].flags, LM_TARGET_IS_BEACON);
    assert_int_equal(t.items[1].speed_mm_s, 8000);
    for (uint32_t i = 0; i < t.count; i++) {
        assert_int_equal(lm_target_check(&t.items[i]), LM_OK);
    }
    build_targets_free(&t);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char list[80];
        snprintf(list, sizeof list, "target a 46 11 0 0 %s\n", wrong[i]);
        scene_text("beacons.targets", list);
        assert_int_equal(build_targets_read(&t, scene_path("beacons.targets")), -1);
    }
}

/* Legs of up to 100 km end within a decimetre of their places, as the firmware goes them. */
TEST(a_path_leads_to_its_places)
{
    static const double places[5][2] = {
        {60, 179.5}, {60.7, -179.6}, {60.1, -179.2}, {60.1001, -179.2}, {59.7, 179.9}};
    struct build_targets t;
    char list[400] = "target t 60 179.5 0 0 swerling 1 1 moving 20\n";
    for (int i = 1; i < 5; i++) {
        char line[64];
        snprintf(line, sizeof line, "via %.4f %.4f\n", places[i][0], places[i][1]);
        strcat(list, line);
    }
    scene_text("path.targets", list);
    assert_int_equal(build_targets_read(&t, scene_path("path.targets")), 0);
    for (int i = 0; i < 4; i++) {
        const struct lm_position to = {hs_bam(places[i + 1][0]), hs_bam(places[i + 1][1])};
        assert_true(image_path_apart_m(image_path_end(&t.items[0].path[i]), to) <= 0.1);
    }
    build_targets_free(&t);
}

TEST(a_line_that_makes_no_sense_is_refused)
{
    static const char *const bad[] = {
        "sphere 1 0 0 0\n",
        "target t 0 0 0 0\n",
        "target t 0 0 0 0 nothing\n",
        "target t 91 0 0 0 scatterers\nsphere 1 0 0 0\n",
        "target t nan 0 0 0 scatterers\nsphere 1 0 0 0\n",
        "target t 0 0 0 0 swerling 5 0\n",
        "target t 0 0 0 0 swerling 1.5 0\n",
        "target t 0 0 0 0 swerling 1 101\n",
        "target t 0 0 0 0 swerling 1 0\nsphere 1 0 0 0\n",
        "target seventeen_letters 0 0 0 0 swerling 1 0\n",
        "target t 0 0 0 0 scatterers\n",
        "target t 0 0 0 0 scatterers\ntarget u 0 0 0 0 swerling 1 1\n",
        "target t 0 0 0 0 scatterers\ncube 1 0 0 0\n",
        "target t 0 0 0 0 scatterers\nsphere 0 0 0 0\n",
        "target t 0 0 0 0 scatterers\nsphere 101 0 0 0\n",
        "target t 0 0 0 0 scatterers\nsphere 1 0 0\n",
        "target t 0 0 0 0 scatterers\nsphere 1 0 0 0 0\n",
        "target t 0 0 0 0 scatterers\nsphere 1 0 0 263\n",
        "target t 0 0 0 0 scatterers\ntrihedral 1 0 0 0 1\n",
        "target t 0 0 0 0 scatterers\ntrihedral 1 0 0 0 1 2 both\n",
        "target t 0 0 0 0 scatterers\nplate 1 1 0 0 0 1 both\n",
        "target t 0 0 0 0 scatterers\nplate 1 1 0 0 0 1 2 3 4\n",
        "target t 0 0 ground2 0 swerling 1 1\n",
        "target t 0 0 ground+ 0 swerling 1 1\n",
        "target t 0 0 grounds 0 swerling 1 1\n",
        "target t 0 0 0 0 swerling 1 1 moving 0 100\n",
        "target t 0 0 0 0 swerling 1 1 moving 2000 100\n",
        "target t 0 0 0 0 swerling 1 1 moving 20 0\n",
        "target t 0 0 0 0 swerling 1 1 moving 20 100001\n",
        "target t 0 0 0 0 swerling 1 1 moving 20\n",
        "target t 0 0 0 0 swerling 1 1 20 100\n",
        "target t 0 0 0 0 moving 20 100\n",
        "target a b c d e f g h i j k l m n o p q r s\n",
        "via 1 1\n",
        "target t 0 0 0 0 swerling 1 1\nvia 0 0.1\n",
        "target t 0 0 0 0 swerling 1 1 moving 20 100\nvia 0 0.1\n",
        "target t 0 0 0 0 swerling 1 1 moving 20\nvia 0 0.1 1\n",
        "target t 0 0 0 0 swerling 1 1 moving 20\nvia 0 0\n",
        "target t 0 0 0 0 swerling 1 1 moving 20\nvia 0 1\n",
        "target t 0 0 0 0 swerling 1 1 moving 20\nvia 0 0.1\nvia 0 0\nvia 0 0.2\n",
        "target t 89.9 0 0 0 swerling 1 1 moving 20\nvia 89.9 180\n",
        "target t 0 0 0 0 scatterers moving 20\nsphere 1 0 0 0\n",
        "target t 0 0 0 0 scatterers moving 20\nvia 0 0.1\n",
        "target t 0 0 0 0 swerling 1 1 moving 20 target u 0 0 0 0 swerling 1 1\n",
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct build_targets t;
        scene_text("bad.targets", bad[i]);
        assert_int_equal(build_targets_read(&t, scene_path("bad.targets")), -1);
        assert_null(t.items);
    }
    struct build_targets t;
    assert_int_equal(build_targets_read(&t, scene_path("there is none")), -1);
}

/* The file above with bytes changed, lost and doubled: refused with an error, or read into records
 * that the firmware takes. */
TEST(whatever_is_read_the_firmware_takes)
{
    struct hs_rng rng;
    uint32_t taken = 0, refused = 0;
    FILE *keep = stderr;
    stderr = fopen("/dev/null", "w");
    assert_non_null(stderr);
    hs_rng_seed(&rng, 9);
    for (int i = 0; i < 3000; i++) {
        static const char spare[] = " \n\t#-+.0123456789eEnatrgplsbohx";
        char mutant[sizeof text + 8];
        struct build_targets t;
        memcpy(mutant, text, sizeof text);
        for (uint32_t k = 1 + hs_rng_below(&rng, 3); k > 0; k--) {
            char *at = mutant + hs_rng_below(&rng, sizeof text - 1);
            const uint32_t what = hs_rng_below(&rng, 3);
            if (what == 0) {
                *at = spare[hs_rng_below(&rng, sizeof spare - 1)];
            } else if (what == 1 && at[1]) {
                memmove(at, at + 1, strlen(at));
            } else if (strlen(mutant) < sizeof mutant - 1) {
                memmove(at + 1, at, strlen(at) + 1);
            }
        }
        scene_text("mutant.targets", mutant);
        if (build_targets_read(&t, scene_path("mutant.targets")) != 0) {
            refused++;
            continue;
        }
        for (uint32_t k = 0; k < t.count; k++) {
            assert_int_equal(lm_target_check(&t.items[k]), LM_OK);
            taken++;
        }
        build_targets_free(&t);
    }
    fclose(stderr);
    stderr = keep;
    print_message("# %u records taken, %u files refused\n", taken, refused);
    assert_true(taken > 500 && refused > 500);
}

/* ---- in an image ---- */

static double hills_m(double x, double y)
{
    return 400 + 30 * sin(x * 300) * cos(y * 200);
}

static void build(const char *out, const char *more)
{
    const struct scene_raster terrain = {.width = 100,
                                         .height = 100,
                                         .geotransform = {7.95, 0.001, 0, 47.05, 0, -0.001},
                                         .epsg = 4326,
                                         .type = GDT_Float32,
                                         .value = hills_m};
    scene_classes();
    scene_write("terrain.tif", &terrain);
    assert_int_equal(scene_run("build --classes %s --terrain %s --land-class soil --out %s %s",
                               scene_path(SCENE_CLASSES), scene_path("terrain.tif"),
                               scene_path(out), more),
                     0);
}

static void build_with_targets(const char *out)
{
    char more[600];
    scene_text("all.targets", text);
    snprintf(more, sizeof more, "--targets %s", scene_path("all.targets"));
    build(out, more);
}

TEST(the_targets_of_a_file_are_those_that_the_firmware_reads)
{
    struct build_targets t;
    struct image image;
    struct memory_flash flash;
    struct lm_db db;
    build_with_targets("with.lmdb");
    assert_true(scene_log_holds("targets 7"));
    assert_int_equal(build_targets_read(&t, scene_path("all.targets")), 0);
    assert_int_equal(image_open(&image, scene_path("with.lmdb")), 0);
    memory_flash_open(&flash, image.bytes, image.size_bytes);
    assert_int_equal(lm_db_open(&db, &flash.port, 4), LM_OK);
    assert_int_equal(db.target_count, t.count);
    for (uint32_t i = 0; i < t.count; i++) {
        struct lm_target read_back;
        assert_int_equal(lm_target_read(&db, i, &read_back, 4), LM_OK);
        assert_memory_equal(&read_back, &t.items[i], sizeof read_back);
    }
    assert_int_equal(damage_faults(image.bytes, image.size_bytes), 0);
    image_close(&image);
    build_targets_free(&t);
}

TEST(verify_and_inspect_know_targets)
{
    build_with_targets("with.lmdb");
    assert_int_equal(scene_run("verify %s", scene_path("with.lmdb")), 0);
    assert_int_equal(scene_run("inspect %s", scene_path("with.lmdb")), 0);
    assert_true(scene_log_holds("TARGETS"));
    assert_true(scene_log_holds("corners"));
    assert_true(
        scene_log_holds("plate     0.3 0.7 m at -10.25 0 1, facing -10.000 20.000, roll "
                        "45.000, both sides"));
    assert_true(scene_log_holds("swerling 3, mean 12.5 dBsm"));
    assert_true(scene_log_holds("ground   2.5"));
    assert_true(scene_log_holds("moving 7.5 m/s, leg 4000 m"));
    assert_true(scene_log_holds("moving 12.5 m/s, round\n"));
    assert_true(scene_log_holds("via 47.010000 8.010000: 1346"));
    assert_true(scene_log_holds("input: targets all.targets"));
    assert_true(scene_log_holds("section-sha256: TARGETS"));
}

TEST(a_fault_in_the_file_leaves_no_image)
{
    scene_text("bad.targets", "target t 0 0 0 0 scatterers\nsphere 1 0 0\n");
    assert_int_equal(scene_run("build --classes %s --terrain %s --land-class soil --out %s "
                               "--targets %s",
                               scene_path(SCENE_CLASSES), scene_path("terrain.tif"),
                               scene_path("none.lmdb"), scene_path("bad.targets")),
                     1);
    assert_true(scene_log_holds("bad.targets:2"));
    assert_null(fopen(scene_path("none.lmdb"), "rb"));
}

/* Sections and bytes of an image without targets are those of its twin with them, but for the
 * header, the manifest and what lies behind the tiles. */
TEST(an_image_without_targets_is_what_it_was)
{
    struct image with, without;
    build("without.lmdb", "");
    build_with_targets("with.lmdb");
    assert_int_equal(image_open(&with, scene_path("with.lmdb")), 0);
    assert_int_equal(image_open(&without, scene_path("without.lmdb")), 0);
    assert_int_equal(without.header.section_count, 5);
    assert_int_equal(without.db.target_count, 0);
    assert_int_equal(damage_faults(without.bytes, without.size_bytes), 0);
    for (int type = LM_IMAGE_CLASSES; type <= LM_IMAGE_TILES; type++) {
        const struct lm_image_section *a = with.sections[type], *b = without.sections[type];
        assert_int_equal(a->offset, b->offset);
        assert_int_equal(a->bytes, b->bytes);
        assert_memory_equal(with.bytes + a->offset, without.bytes + b->offset, b->bytes);
    }
    image_close(&with);
    image_close(&without);
}

/* ---- damage ---- */

struct copy {
    uint8_t *bytes;
    size_t size;
    uint64_t head_at;
};

static void copy_image(struct copy *c)
{
    struct image image;
    build_with_targets("with.lmdb");
    assert_int_equal(image_open(&image, scene_path("with.lmdb")), 0);
    c->size = image.size_bytes;
    c->bytes = damage_copy(&image);
    c->head_at = image.sections[LM_IMAGE_TARGETS]->offset;
    image_close(&image);
}

/* Put every checksum right again: records, head, section and header. */
static void seal(struct copy *c)
{
    uint8_t *head = c->bytes + c->head_at;
    for (int i = 0; i < 7; i++) {
        uint8_t *record = head + 64 + i * LM_TARGET_BYTES;
        const uint32_t crc = fx_crc32c(0, record + 4, LM_TARGET_BYTES - 4);
        memcpy(record, &crc, 4);
    }
    const uint32_t head_crc = fx_crc32c(0, head, 60);
    memcpy(head + 60, &head_crc, 4);
    damage_seal(c->bytes, LM_IMAGE_TARGETS, LM_IMAGE_TARGETS);
}

TEST(a_lie_about_a_target_under_right_checksums_is_found)
{
    struct copy c;
    copy_image(&c);
    struct lm_target *t = (void *)(c.bytes + c.head_at + 64);
    struct lm_target kept[7];
    memcpy(kept, t, sizeof kept);
    seal(&c);
    assert_int_equal(damage_faults(c.bytes, c.size), 0);
    for (int lie = 0; lie < 20; lie++) {
        memcpy(t, kept, sizeof kept);
        switch (lie) {
        case 0:
            t[0].scatterers[0].kind = 9;
            break;
        case 1:
            t[0].scatterer_count = 17;
            break;
        case 2:
            t[0].scatterers[4].kind = 1;
            break; /* behind the last one */
        case 3:
            t[0].scatterers[0].size_mm[1] = 1;
            break; /* a sphere has one size */
        case 4:
            t[0].scatterers[3].is_two_sided = 1;
            break;
        case 5:
            t[0].scatterers[0].reserved = 1;
            break;
        case 6:
            t[1].id = 0;
            break;
        case 7:
            t[1].name[12] = 'x';
            break;
        case 8:
            t[1].swerling = 7;
            break;
        case 9:
            t[0].swerling = 1;
            break; /* it has bodies */
        case 10:
            t[2].reserved[4] = 1;
            break;
        case 11:
            t[5].path[1].latitude += 100;
            break; /* a gap */
        case 12:
            t[5].path[0].length_mm += 500;
            break;
        case 13:
            t[5].path_legs = 1;
            break; /* another one lies behind it */
        case 14:
            t[5].path_is_round = 1;
            break; /* it does not end where it began */
        case 15:
            t[6].heading += 1;
            break;
        case 16:
            t[6].path_legs = 33;
            break;
        case 17:
            t[6].flags = 0;
            break;
        case 18:
            t[1].path_legs = 1;
            break; /* it has no path */
        default:
            c.bytes[c.head_at + 40] = 1;
            break;
        }
        seal(&c);
        assert_true(damage_faults(c.bytes, c.size) > 0);
        c.bytes[c.head_at + 40] = 0;
    }
    free(c.bytes);
}

TEST(every_flipped_bit_of_the_section_is_found)
{
    struct copy c;
    copy_image(&c);
    damage_flip(c.bytes, c.size, c.head_at, 64 + 3 * LM_TARGET_BYTES, 7);
    free(c.bytes);
}
