/* Power fails at drawn moments of loads into a model of the medium. After each cut there is a slot
 * to fly, and it holds one image, whole: the one that was flown before, or the one whose load had
 * come to its last step. `make cuts` draws more of them. */
#include "check.h"
#include "memory_flash.h"
#include "power.h"
#include "slots/load.h"
#include "tiny_country.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { IMAGES = 3, CUTS_IN_CI = 3000 };

static struct tiny_image images[IMAGES];
static struct power supply;
static struct power_medium media[LM_SLOTS];
static struct slot slots[LM_SLOTS];

static int make_images(void **state)
{
    (void)state;
    for (uint8_t i = 0; i < IMAGES; i++) {
        struct tiny_spec spec = tiny_country((uint8_t)(1 + i % 2));
        spec.latitude_deg += i;
        if (tiny_image_build(&images[i], &spec) != 0) {
            return -1;
        }
    }
    return 0;
}

static int free_images(void **state)
{
    (void)state;
    for (int i = 0; i < IMAGES; i++) {
        tiny_image_free(&images[i]);
    }
    return 0;
}

TEST_GROUP(make_images, free_images);

static uint64_t number_of(const char *name, uint64_t otherwise)
{
    const char *text = getenv(name);
    return text ? strtoull(text, NULL, 10) : otherwise;
}

static void start_over(uint64_t seed)
{
    supply = (struct power){.random = seed * UINT64_C(0x9E3779B97F4A7C15) | 1};
    for (int i = 0; i < LM_SLOTS; i++) {
        memset(&media[i], 0, sizeof media[i]);
    }
}

static void judge(enum slot_depth depth)
{
    for (int i = 0; i < LM_SLOTS; i++) {
        const struct slot_medium medium = power_medium(&media[i], &supply);
        slot_lend(&slots[i], i == 0 ? "slot A" : "slot B", &medium);
        slot_judge(&slots[i], depth, NULL, NULL);
    }
}

/* The image that a slot holds byte for byte, or -1. */
static int image_in(const struct slot *s)
{
    static uint8_t bytes[POWER_ROOM];
    for (int i = 0; i < IMAGES; i++) {
        if (s->record.image_bytes == images[i].size &&
            s->medium.read(s->medium.ctx, 0, bytes, (uint32_t)images[i].size) == 0 &&
            memcmp(bytes, images[i].bytes, images[i].size) == 0) {
            return i;
        }
    }
    return -1;
}

/* How far a load came. */
enum reached { FILLING, SWITCHING, DONE };

static enum reached load(struct slot *to, const struct slot *other, int image)
{
    struct memory_flash source;
    struct slot_load result;
    memory_flash_open(&source, images[image].bytes, images[image].size);
    if (slot_fill(to, &source.port, NULL, NULL, NULL, &result) != 0) {
        return FILLING;
    }
    return slot_switch(to, other, &result) == 0 ? DONE : SWITCHING;
}

struct story {
    uint64_t cuts, loads, resumed, old_flown, new_flown;
    const char *wrong; /* NULL: nothing */
};

/* One start of the panel after a cut. Returns the slot to fly. */
static int look(struct story *s, int flown_image, int loaded_image, enum reached reached)
{
    judge(SLOT_TABLES);
    const int chosen = slot_choose(slots);
    if (chosen < 0) {
        s->wrong = "there is no slot to fly";
        return -1;
    }
    const int image = image_in(&slots[chosen]);
    if (image < 0) {
        s->wrong = "what is flown is a mix, or damaged";
    } else if (reached == DONE && image != loaded_image) {
        s->wrong = "a load that had come to its end is not flown";
    } else if (reached == FILLING && image != flown_image) {
        s->wrong = "a load that was not switched to is flown";
    } else if (image != flown_image && image != loaded_image) {
        s->wrong = "an image is flown that nobody asked for";
    }
    s->old_flown += image == flown_image;
    s->new_flown += image == loaded_image;
    return chosen;
}

/* The operations of a load without a cut, and the first load. */
static uint64_t first_load(void)
{
    judge(SLOT_TABLES);
    assert_int_equal(slot_choose(slots), -1);
    assert_int_equal(load(&slots[0], &slots[1], 1), DONE);
    return supply.operations;
}

/* Half of the moments lie near the records. */
static uint64_t draw_moment(uint64_t operations)
{
    const uint32_t all = (uint32_t)operations + 4;
    switch (power_draw(&supply, 4)) {
    case 0:
        return 1 + power_draw(&supply, 8);
    case 1:
        return all - power_draw(&supply, 12);
    default:
        return 1 + power_draw(&supply, all);
    }
}

static void fly(struct story *s, uint64_t cuts, bool ignores_sync)
{
    int flown = 1, wanted = 0;
    const uint64_t operations = first_load();
    supply.ignores_sync = ignores_sync;
    while (s->cuts < cuts && !s->wrong) {
        judge(SLOT_TABLES);
        const int chosen = slot_choose(slots), target = chosen ^ 1;
        supply.operations = 0;
        supply.cut_at = draw_moment(operations);
        const enum reached reached = load(&slots[target], &slots[chosen], wanted);
        supply.is_out = true; /* after a load that came to its end, too */
        for (int i = 0; i < LM_SLOTS; i++) {
            power_restore(&media[i]);
        }
        supply.is_out = false;
        supply.cut_at = 0;
        s->cuts++;
        s->loads += reached == DONE;
        const int now = look(s, flown, wanted, reached);
        if (s->wrong) {
            return;
        }
        flown = image_in(&slots[now]);
        const bool is_resumed = flown != wanted && power_draw(&supply, 3) > 0;
        s->resumed += is_resumed;
        wanted = is_resumed ? wanted : (flown + 1 + (int)power_draw(&supply, IMAGES - 1)) % IMAGES;
    }
}

TEST(no_cut_leaves_the_panel_without_a_database_or_with_a_mix)
{
    struct story s = {0};
    const uint64_t cuts = number_of("LANDMASS_CUTS", CUTS_IN_CI),
                   seed = number_of("LANDMASS_SEED", 1);
    start_over(seed);
    fly(&s, cuts, false);
    printf("# %" PRIu64 " cuts of seed %" PRIu64 ": %" PRIu64 " loads came to their end, %" PRIu64
           " were taken up again; after the cut the old image was flown %" PRIu64
           " times, the new one %" PRIu64 "\n",
           s.cuts, seed, s.loads, s.resumed, s.old_flown, s.new_flown);
    if (s.wrong) {
        fail_msg("cut %" PRIu64 " of seed %" PRIu64 ": %s", s.cuts, seed, s.wrong);
    }
    assert_true(s.loads > cuts / 50);
    assert_true(s.resumed > cuts / 10);
    assert_true(s.old_flown > cuts / 10 && s.new_flown > cuts / 10);
}

/* The model must be able to break what does not wait for it. */
TEST(a_medium_that_lies_about_its_syncs_is_found_out)
{
    struct story s = {0};
    start_over(7);
    fly(&s, 300, true);
    assert_non_null(s.wrong);
}

TEST(a_load_that_is_taken_up_again_writes_only_what_is_missing)
{
    struct memory_flash source;
    struct slot_load first, second;
    start_over(3);
    judge(SLOT_TABLES);
    memory_flash_open(&source, images[1].bytes, images[1].size);
    supply.cut_at = supply.operations + 20;
    assert_int_equal(slot_fill(&slots[0], &source.port, NULL, NULL, NULL, &first), -1);
    supply.is_out = false; /* the program was ended, and nothing was lost */
    supply.cut_at = 0;
    judge(SLOT_TABLES);
    assert_int_equal(slots[0].verdict, SLOT_CUT_OFF);
    assert_int_equal(slot_fill(&slots[0], &source.port, NULL, NULL, NULL, &second), 0);
    assert_true(second.kept_bytes > 0);
    assert_int_equal(second.kept_bytes + second.written_bytes, images[1].size);
    assert_int_equal(slot_switch(&slots[0], &slots[1], &second), 0);
    judge(SLOT_RECORDS);
    assert_int_equal(slot_choose(slots), 0);
    assert_int_equal(image_in(&slots[0]), 1);
}

/* Every bit of the image is under some checksum: what is damaged is not flown. */
TEST(a_slot_with_a_wrong_byte_in_a_section_is_not_whole)
{
    start_over(5);
    judge(SLOT_TABLES);
    assert_int_equal(load(&slots[0], &slots[1], 0), DONE);
    const size_t places[] = {0,
                             100,
                             images[0].classes_offset + 5,
                             images[0].bands_offset + 4,
                             images[0].directory_offset + 3,
                             images[0].tiles_offset + 1000,
                             images[0].manifest_offset};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        uint8_t *byte = media[0].seen + LM_SLOT_COPIES * POWER_SECTOR + places[i];
        *byte ^= 0x10;
        judge(SLOT_RECORDS);
        assert_int_equal(slots[0].verdict, SLOT_DAMAGED);
        assert_true(slots[0].fault.cause[0] != '\0');
        *byte ^= 0x10;
    }
    judge(SLOT_RECORDS);
    assert_int_equal(slots[0].verdict, SLOT_WHOLE);
}
