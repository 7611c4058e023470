/* Signatures: from a file .sig into an image and back, by the builder, the checker and the
 * firmware; and files and sections that lie. */
#include "build/signatures.h"
#include "build/targets.h"
#include "image_damage.h"
#include "scene.h"

#include "fx/crc32c.h"
#include "hs/angle.h"
#include "hs/rng.h"
#include "lm/signature.h"

#include "check.h"
#include "memory_flash.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- signatures of numbers drawn by lot ---- */

static void fill(void *bytes, size_t count, struct hs_rng *rng)
{
    uint8_t *b = bytes;
    for (size_t i = 0; i < count; i++) {
        b[i] = (uint8_t)hs_rng_below(rng, 256);
    }
}

static void make(struct db_signature *s, const char *name, uint32_t aspects, uint32_t depressions)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, aspects * 10 + depressions);
    s->head = (struct lm_signature){.aspects = (uint16_t)aspects,
                                    .depressions = (uint8_t)depressions,
                                    .origin_row = 20,
                                    .pixel_mm = 250,
                                    .height_mm = 3100};
    memcpy(s->head.name, name, strlen(name));
    s->chips = calloc(aspects * depressions, sizeof *s->chips);
    for (uint32_t d = 0; d < depressions; d++) {
        s->head.depression[d] = hs_bam(10 + 10 * d);
        fill(s->head.rcs[d], aspects, &rng);
        for (uint32_t a = 0; a < aspects; a++) {
            struct lm_chip *c = &s->chips[d * aspects + a];
            fill(c->level, sizeof c->level, &rng);
            fill(c->shadow, sizeof c->shadow, &rng);
        }
    }
}

static void write_sig(const char *file, const char *name, uint32_t aspects, uint32_t depressions)
{
    struct db_signature s;
    make(&s, name, aspects, depressions);
    assert_int_equal(db_signature_write(&s, scene_path(file)), 0);
    db_signature_free(&s);
}

static size_t load(const char *file, uint8_t **bytes)
{
    FILE *in = fopen(scene_path(file), "rb");
    assert_non_null(in);
    *bytes = malloc(1 << 20);
    const size_t size = fread(*bytes, 1, 1 << 20, in);
    fclose(in);
    return size;
}

static int read_bytes(const uint8_t *bytes, size_t size)
{
    struct db_signature s;
    FILE *out = fopen(scene_path("hostile.sig"), "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(bytes, 1, size, out), size);
    fclose(out);
    const int result = db_signature_read(&s, scene_path("hostile.sig"));
    if (result != 0) {
        assert_null(s.chips);
    }
    db_signature_free(&s);
    return result;
}

/* ---- the file ---- */

TEST(a_file_holds_what_was_baked)
{
    struct db_signature s, back;
    make(&s, "sixteen_letters_", 5, 3);
    assert_int_equal(db_signature_write(&s, scene_path("a.sig")), 0);
    assert_int_equal(db_signature_read(&back, scene_path("a.sig")), 0);
    assert_memory_equal(&back.head, &s.head, sizeof s.head);
    assert_memory_equal(back.chips, s.chips, 15 * sizeof *s.chips);
    db_signature_free(&back);
    db_signature_free(&s);
}

TEST(every_flipped_bit_of_a_file_is_found)
{
    uint8_t *bytes;
    write_sig("one.sig", "one", 1, 1);
    const size_t size = load("one.sig", &bytes);
    assert_int_equal(size, 64 + LM_SIGNATURE_BYTES + LM_CHIP_BYTES);
    for (size_t i = 0; i < size; i += i < 256 ? 1 : 23) {
        bytes[i] = (uint8_t)(bytes[i] ^ 1u << i % 8);
        assert_int_equal(read_bytes(bytes, size), -1);
        bytes[i] = (uint8_t)(bytes[i] ^ 1u << i % 8);
    }
    assert_int_equal(read_bytes(bytes, size), 0);
    for (size_t cut = 0; cut < size; cut += 97) {
        assert_int_equal(read_bytes(bytes, cut), -1);
    }
    assert_int_equal(read_bytes(bytes, size + 1), -1);
    free(bytes);
    assert_int_equal(db_signature_read(&(struct db_signature){0}, scene_path("none.sig")), -1);
    assert_int_equal(db_signature_read(&(struct db_signature){0}, scene_folder()), -1);
}

/* ---- lies under right checksums ---- */

/* The parts of a section of `count` signatures. */
struct parts {
    struct lm_signatures_head *head;
    struct lm_signature *signatures;
    struct lm_chip *chips;
};

static struct parts parts_of(uint8_t *section, uint32_t count)
{
    uint8_t *records = section + sizeof(struct lm_signatures_head);
    return (struct parts){(void *)section, (void *)records,
                          (void *)(records + count * LM_SIGNATURE_BYTES)};
}

static void seal_parts(const struct parts *p, uint32_t count, uint32_t chips)
{
    p->head->crc = fx_crc32c(0, p->head, 60);
    for (uint32_t i = 0; i < count; i++) {
        p->signatures[i].crc =
            fx_crc32c(0, (uint8_t *)&p->signatures[i] + 4, LM_SIGNATURE_BYTES - 4);
    }
    for (uint32_t i = 0; i < chips; i++) {
        p->chips[i].crc = fx_crc32c(0, (uint8_t *)&p->chips[i] + 4, LM_CHIP_BYTES - 4);
    }
}

enum { LIES = 21 };

/* Lie number `lie` about the last signature, which has 6 chips. */
static void tell(const struct parts *p, uint32_t count, uint32_t chips, int lie)
{
    struct lm_signature *s = &p->signatures[count - 1];
    struct lm_chip *last = &p->chips[chips - 1];
    uint32_t *const numbers[] = {&p->head->count, &p->head->record_bytes, &p->head->chip_count,
                                 &p->head->chip_bytes, &s->chip0};
    if (lie < 5) {
        *numbers[lie] += 1;
        return;
    }
    switch (lie) {
    case 5:
        s->aspects = 7;
        break;
    case 6:
        s->aspects = 0;
        break;
    case 7:
        s->depressions = 9;
        break;
    case 8:
        s->origin_row = 65;
        break;
    case 9:
        s->pixel_mm = 9;
        break;
    case 10:
        s->height_mm = 200001;
        break;
    case 11:
        s->depression[1] = s->depression[0];
        break;
    case 12:
        s->depression[2] = 5;
        break; /* behind the last one */
    case 13:
        s->rcs[0][3] = 1;
        break; /* likewise */
    case 14:
        s->name[9] = 'x';
        break; /* likewise */
    case 15:
        last->aspect = 0;
        break;
    case 16:
        last->signature = (uint16_t)(last->signature + 1);
        break;
    case 17:
        last->reserved[54] = 1;
        break;
    case 18:
        s->rcs[7][0] = 1;
        break; /* of no depression */
    case 19:   /* fewer chips than there are */
        s->aspects--;
        s->depressions = 1;
        s->depression[1] = 0;
        memset(&s->rcs[0][s->aspects], 0, sizeof s->rcs - s->aspects);
        break;
    default:
        p->head->reserved[0] = 1;
        break;
    }
}

TEST(a_lie_in_a_file_under_right_checksums_is_found)
{
    uint8_t *bytes;
    write_sig("six.sig", "six", 3, 2);
    const size_t size = load("six.sig", &bytes);
    uint8_t *kept = malloc(size);
    memcpy(kept, bytes, size);
    const struct parts p = parts_of(bytes, 1);
    for (int lie = 0; lie < LIES; lie++) {
        memcpy(bytes, kept, size);
        tell(&p, 1, 6, lie);
        seal_parts(&p, 1, 6);
        assert_int_equal(read_bytes(bytes, size), -1);
    }
    free(kept);
    free(bytes);
}

/* ---- the list of targets ---- */

static const char text[] =
    "library truck  six.sig\n"
    "library tank   folder/ten.sig\n"
    "target a 47.01 8.02 ground 30 signature tank\n"
    "target b 47.02 8.02 451 30 signature truck moving 7.5 4000\n"
    "target c 47.03 8.02 451 30 swerling 1 4\n";

static void write_list(const char *more)
{
    char list[2000], folder[600];
    write_sig("six.sig", "six", 3, 2);
    snprintf(folder, sizeof folder, "mkdir -p %s", scene_path("folder"));
    assert_int_equal(system(folder), 0);
    write_sig("folder/ten.sig", "ten", 10, 1);
    snprintf(list, sizeof list, "%s%s", text, more);
    scene_text("sig.targets", list);
}

TEST(a_list_names_libraries_and_targets_name_them)
{
    struct build_targets t;
    write_list("");
    assert_int_equal(build_targets_read(&t, scene_path("sig.targets")), 0);
    assert_int_equal(t.count, 3);
    assert_int_equal(t.signatures.count, 2);
    assert_string_equal(t.signatures.items[0].head.name, "truck");
    assert_int_equal(t.items[0].flags, LM_TARGET_ABOVE_GROUND | LM_TARGET_HAS_SIGNATURE);
    assert_int_equal(t.items[0].signature, 1);
    assert_int_equal(t.items[1].flags, LM_TARGET_HAS_SIGNATURE);
    assert_int_equal(t.items[1].signature, 0);
    assert_int_equal(t.items[1].speed_mm_s, 7500);
    assert_int_equal(t.items[2].flags, 0);
    for (uint32_t i = 0; i < t.count; i++) {
        assert_int_equal(lm_target_check(&t.items[i]), LM_OK);
    }
    build_targets_free(&t);
}

TEST(a_line_about_signatures_that_makes_no_sense_is_refused)
{
    static const char *const bad[] = {
        "library truck six.sig\n", /* there is one */
        "library\n",
        "library x\n",
        "library x six.sig more\n",
        "library seventeen_letters six.sig\n",
        "library x none.sig\n",
        "library x sig.targets\n",
        "target t 0 0 0 0 signature\n",
        "target t 0 0 0 0 signature none\n",
        "target t 0 0 0 0 signature tankk\n",
        "target t 0 0 0 0 signature tank 5\n",
        "target t 0 0 0 0 signature tank\nsphere 1 0 0 0\n",
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct build_targets t;
        write_list(bad[i]);
        assert_int_equal(build_targets_read(&t, scene_path("sig.targets")), -1);
        assert_null(t.items);
        assert_int_equal(t.signatures.count, 0);
    }
}

/* ---- in an image ---- */

static double flat_m(double x, double y)
{
    (void)x;
    (void)y;
    return 400;
}

static void build(const char *out)
{
    const struct scene_raster terrain = {.width = 60,
                                         .height = 60,
                                         .geotransform = {7.95, 0.001, 0, 47.05, 0, -0.001},
                                         .epsg = 4326,
                                         .type = GDT_Float32,
                                         .value = flat_m};
    scene_classes();
    scene_write("flat.tif", &terrain);
    write_list("");
    assert_int_equal(scene_run("build --classes %s --terrain %s --land-class soil --out %s "
                               "--targets %s",
                               scene_path(SCENE_CLASSES), scene_path("flat.tif"), scene_path(out),
                               scene_path("sig.targets")),
                     0);
}

TEST(the_firmware_reads_the_chips_that_were_baked)
{
    static const struct {
        uint32_t aspects, depressions;
    } sizes[2] = {{3, 2}, {10, 1}};
    struct image image;
    struct memory_flash flash;
    struct lm_db db;
    build("sig.lmdb");
    assert_true(scene_log_holds("targets 3, signatures 2"));
    assert_int_equal(image_open(&image, scene_path("sig.lmdb")), 0);
    assert_int_equal(damage_faults(image.bytes, image.size_bytes), 0);
    memory_flash_open(&flash, image.bytes, image.size_bytes);
    assert_int_equal(lm_db_open(&db, &flash.port, 4), LM_OK);
    assert_int_equal(db.signature_count, 2);
    assert_int_equal(db.chip_count, 16);
    for (uint32_t i = 0; i < 2; i++) {
        struct lm_signature s;
        struct db_signature baked;
        make(&baked, "", sizes[i].aspects, sizes[i].depressions);
        assert_int_equal(lm_signature_read(&db, i, &s, 4), LM_OK);
        assert_string_equal(s.name, i == 0 ? "truck" : "tank");
        assert_memory_equal(s.rcs, baked.head.rcs, sizeof s.rcs);
        for (uint32_t k = 0; k < db_signature_chips(&s); k++) {
            struct lm_chip c;
            const uint64_t at = db.chips_offset + (uint64_t)(s.chip0 + k) * LM_CHIP_BYTES;
            assert_int_equal(lm_db_read(db.flash, at, &c, sizeof c, 4), LM_OK);
            assert_int_equal(lm_chip_check(&c, i, k % s.aspects, k / s.aspects), LM_OK);
            assert_memory_equal(c.level, baked.chips[k].level, sizeof c.level);
            assert_memory_equal(c.shadow, baked.chips[k].shadow, sizeof c.shadow);
        }
        db_signature_free(&baked);
    }
    image_close(&image);
}

TEST(verify_and_inspect_know_signatures)
{
    build("sig.lmdb");
    assert_int_equal(scene_run("verify %s", scene_path("sig.lmdb")), 0);
    assert_int_equal(scene_run("inspect %s", scene_path("sig.lmdb")), 0);
    assert_true(scene_log_holds("SIGNATURES"));
    assert_true(scene_log_holds("truck                   3    0.250       3.1"));
    assert_true(scene_log_holds(" 10 20\n"));
    assert_true(scene_log_holds("signature 1"));
    assert_true(scene_log_holds("input: signature six.sig"));
    assert_true(scene_log_holds("input: signature ten.sig"));
    assert_true(scene_log_holds("section-sha256: SIGNATURES"));
}

struct copy {
    uint8_t *bytes;
    size_t size;
    uint64_t signatures_at, targets_at;
};

static void copy_image(struct copy *c)
{
    struct image image;
    build("sig.lmdb");
    assert_int_equal(image_open(&image, scene_path("sig.lmdb")), 0);
    c->size = image.size_bytes;
    c->bytes = damage_copy(&image);
    c->signatures_at = image.sections[LM_IMAGE_SIGNATURES]->offset;
    c->targets_at = image.db.targets_offset;
    image_close(&image);
}

/* Records, sections and header. */
static void seal_image(struct copy *c)
{
    const struct parts p = parts_of(c->bytes + c->signatures_at, 2);
    struct lm_target *t = (void *)(c->bytes + c->targets_at);
    seal_parts(&p, 2, 16);
    for (int i = 0; i < 3; i++) {
        t[i].crc = fx_crc32c(0, (uint8_t *)&t[i] + 4, LM_TARGET_BYTES - 4);
    }
    damage_seal(c->bytes, LM_IMAGE_TARGETS, LM_IMAGE_SIGNATURES);
}

TEST(a_lie_in_an_image_under_right_checksums_is_found)
{
    struct copy c;
    copy_image(&c);
    uint8_t *kept = malloc(c.size);
    memcpy(kept, c.bytes, c.size);
    for (int lie = 0; lie < LIES + 3; lie++) {
        const struct parts p = parts_of(c.bytes + c.signatures_at, 2);
        struct lm_target *t = (void *)(c.bytes + c.targets_at);
        memcpy(c.bytes, kept, c.size);
        if (lie == 11 || lie == 13) {
            continue; /* one depression, ten aspects: these would be no lies */
        }
        if (lie < LIES) {
            tell(&p, 2, 16, lie);
        } else if (lie == LIES) {
            t[0].signature = 2;
        } else if (lie == LIES + 1) {
            t[0].mean_rcs_dbsm_q8 = 1;
        } else {
            p.signatures[1].chip0 = 0; /* the chips of the other one */
        }
        seal_image(&c);
        assert_true(damage_faults(c.bytes, c.size) > 0);
    }
    memcpy(c.bytes, kept, c.size);
    seal_image(&c);
    assert_int_equal(damage_faults(c.bytes, c.size), 0);
    free(kept);
    free(c.bytes);
}

TEST(every_flipped_bit_of_the_section_is_found)
{
    struct copy c;
    copy_image(&c);
    damage_flip(c.bytes, c.size, c.signatures_at, 64 + 2 * LM_SIGNATURE_BYTES + 16 * LM_CHIP_BYTES,
                331);
    free(c.bytes);
}

static int enter(void **state)
{
    (void)state;
    return scene_folder() ? 0 : -1;
}

TEST_GROUP(enter, NULL);
