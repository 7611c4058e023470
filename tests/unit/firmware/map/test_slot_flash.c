/* A flash with two slots, read without an operating system: which image is flown, after loads that
 * are cut off at every write, after damage, and where there are no slots. */
#include "lm/slot_flash.h"

#include "check.h"
#include "fx/crc32c.h"
#include "hs/rng.h"
#include "lm/image.h"
#include "memory_flash.h"
#include "tiny_country.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { HALF_BYTES = 1 << 20, FLASH_BYTES = LM_SLOTS * HALF_BYTES, POLLS = 10, NONE = -1 };

static const uint64_t record_at[LM_SLOT_COPIES] = {HALF_BYTES - (128 << 10),
                                                   HALF_BYTES - (64 << 10)}; /* docs/slots.md */

static struct tiny_image images[2];
static uint8_t *flash_bytes;
static struct memory_flash flash;
static struct lm_slot_flash slots;
static struct lm_db db;
static uint64_t scratch[LM_SLOT_SCRATCH_BYTES / 8];

static int make_images(void **state)
{
    (void)state;
    flash_bytes = malloc(FLASH_BYTES);
    for (uint8_t i = 0; i < 2; i++) {
        struct tiny_spec spec = tiny_country(1);
        spec.latitude_deg += i;
        if (tiny_image_build(&images[i], &spec) != 0 || images[i].size > record_at[0]) {
            return -1;
        }
    }
    return 0;
}

static int free_images(void **state)
{
    (void)state;
    free(flash_bytes);
    tiny_image_free(&images[0]);
    tiny_image_free(&images[1]);
    return 0;
}

TEST_GROUP(make_images, free_images);

static int erase(void **state)
{
    (void)state;
    memset(flash_bytes, 0xff, FLASH_BYTES);
    return 0;
}

static uint8_t *slot_at(int slot)
{
    return flash_bytes + (size_t)slot * HALF_BYTES;
}

static struct lm_slot_record record_of(int image, uint32_t state, uint64_t generation,
                                       uint64_t sequence)
{
    struct lm_image_header header;
    memcpy(&header, images[image].bytes, sizeof header);
    struct lm_slot_record r = {.state = state,
                               .generation = generation,
                               .sequence = sequence,
                               .image_bytes = header.image_bytes,
                               .image_crc = header.crc};
    lm_slot_seal(&r);
    return r;
}

static void fill(int slot, int image, uint64_t sequence)
{
    const struct lm_slot_record r = record_of(image, LM_SLOT_WHOLE, 2, sequence);
    memcpy(slot_at(slot), images[image].bytes, images[image].size);
    memcpy(slot_at(slot) + record_at[0], &r, sizeof r);
    memcpy(slot_at(slot) + record_at[1], &r, sizeof r);
}

static void look(void)
{
    memory_flash_open(&flash, flash_bytes, FLASH_BYTES);
    lm_slot_flash_open(&slots, &flash.port, &db, scratch, sizeof scratch, POLLS);
}

/* The image that the port holds, byte by byte; NONE: no image. */
static int flown(void)
{
    static uint8_t bytes[FLASH_BYTES];
    look();
    if (slots.port.size_bytes == 0) {
        return NONE;
    }
    assert_int_equal(lm_db_read(&slots.port, 0, bytes, (uint32_t)slots.port.size_bytes, POLLS),
                     LM_OK);
    for (int i = 0; i < 2; i++) {
        if (slots.port.size_bytes >= images[i].size &&
            memcmp(bytes, images[i].bytes, images[i].size) == 0) {
            return i;
        }
    }
    return NONE;
}

static void assert_verdicts(enum lm_slot_verdict first, enum lm_slot_verdict second)
{
    assert_int_equal(slots.slot[0].verdict, first);
    assert_int_equal(slots.slot[1].verdict, second);
}

TEST_WITH(the_later_of_two_whole_slots_is_flown, erase, NULL)
{
    fill(0, 0, 7);
    fill(1, 1, 8);
    assert_int_equal(flown(), 1);
    assert_verdicts(LM_SLOT_STANDS_BY, LM_SLOT_FLOWN);
    assert_int_equal(slots.slot[0].sequence, 7);
    assert_int_equal(slots.slot[1].sequence, 8);
    assert_int_equal(slots.port.size_bytes, images[1].size);
    fill(0, 0, 9);
    assert_int_equal(flown(), 0);
    assert_verdicts(LM_SLOT_FLOWN, LM_SLOT_STANDS_BY);
}

TEST_WITH(nothing_is_read_past_the_end_of_the_image, erase, NULL)
{
    uint8_t byte;
    fill(1, 0, 1);
    assert_int_equal(flown(), 0);
    assert_int_equal(lm_db_read(&slots.port, images[0].size - 1, &byte, 1, POLLS), LM_OK);
    assert_int_equal(byte, images[0].bytes[images[0].size - 1]);
    assert_int_equal(lm_db_read(&slots.port, images[0].size, &byte, 1, POLLS), LM_ERR_IO);
    assert_int_equal(lm_db_read(&slots.port, UINT64_MAX, &byte, 1, POLLS), LM_ERR_IO);
}

/* A bit of the header, of a table, of the directory and of the manifest, which stands at the end.
 */
TEST_WITH(a_slot_that_is_damaged_gives_way_to_the_other, erase, NULL)
{
    const size_t places[] = {40,
                             images[1].classes_offset + 3,
                             images[1].bands_offset,
                             images[1].directory_offset + 5,
                             images[1].manifest_offset,
                             images[1].size - 1};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        erase(NULL);
        fill(0, 0, 7);
        fill(1, 1, 8);
        slot_at(1)[places[i]] ^= 16;
        assert_int_equal(flown(), 0);
        assert_verdicts(LM_SLOT_FLOWN, LM_SLOT_DAMAGED);
        slot_at(0)[100] ^= 1;
        assert_int_equal(flown(), NONE);
        assert_verdicts(LM_SLOT_DAMAGED, LM_SLOT_DAMAGED);
        assert_int_equal(slots.port.size_bytes, 0);
    }
}

TEST_WITH(an_image_that_the_record_was_not_written_for_is_not_flown, erase, NULL)
{
    fill(0, 0, 7);
    fill(1, 1, 8);
    memcpy(slot_at(1), images[0].bytes, images[0].size);
    assert_int_equal(flown(), 0);
    assert_verdicts(LM_SLOT_FLOWN, LM_SLOT_DAMAGED);
}

/* Slot 0, whose image gets this header and its record another for it. */
static enum lm_slot_verdict verdict_of_header(struct lm_image_header *header)
{
    header->crc = fx_crc32c(0, header, sizeof *header - sizeof header->crc);
    memcpy(slot_at(0), header, sizeof *header);
    struct lm_slot_record r = record_of(0, LM_SLOT_WHOLE, 2, 1);
    r.image_bytes = header->image_bytes;
    r.image_crc = header->crc;
    lm_slot_seal(&r);
    memcpy(slot_at(0) + record_at[0], &r, sizeof r);
    memcpy(slot_at(0) + record_at[1], &r, sizeof r);
    look();
    return slots.slot[0].verdict;
}

/* Header and record agree on a length; up to the records it is the slot's. */
static enum lm_slot_verdict verdict_of_length(uint64_t bytes)
{
    struct lm_image_header header;
    fill(0, 0, 1);
    memcpy(&header, images[0].bytes, sizeof header);
    header.image_bytes = bytes;
    return verdict_of_header(&header);
}

TEST_WITH(an_image_of_a_length_that_reaches_into_the_records_is_not_flown, erase, NULL)
{
    assert_int_equal(verdict_of_length(record_at[0]), LM_SLOT_FLOWN);
    assert_int_equal(verdict_of_length(record_at[0] + 1), LM_SLOT_DAMAGED);
    assert_int_equal(slots.port.size_bytes, 0);
}

/* A section more for the image of slot 0, with its checksum or a wrong one. */
static void add_section(struct lm_image_header *header, uint64_t offset, uint64_t bytes,
                        bool is_sealed)
{
    header->sections[header->section_count++] =
        (struct lm_image_section){.type = LM_IMAGE_SEAL,
                                  .crc = is_sealed ? fx_crc32c(0, slot_at(0) + offset, bytes) : 1,
                                  .offset = offset,
                                  .bytes = bytes};
}

/* An image in slot 0 with a section more, of which the firmware needs nothing. */
static enum lm_slot_verdict verdict_of_section(uint64_t offset, uint64_t bytes, bool is_sealed)
{
    struct lm_image_header header;
    fill(0, 0, 1);
    memcpy(&header, images[0].bytes, sizeof header);
    add_section(&header, offset, bytes, is_sealed);
    return verdict_of_header(&header);
}

TEST_WITH(a_section_that_leaves_the_image_makes_the_slot_a_damaged_one, erase, NULL)
{
    const uint64_t size = images[0].size;
    assert_int_equal(verdict_of_section(size - 64, 64, true), LM_SLOT_FLOWN);
    assert_int_equal(verdict_of_section(size - 64, 64, false), LM_SLOT_DAMAGED);
    assert_int_equal(verdict_of_section(size - 64, 65, false), LM_SLOT_DAMAGED);
    assert_int_equal(verdict_of_section(size, 0, true), LM_SLOT_FLOWN);
    assert_int_equal(verdict_of_section(size + 1, 0, false), LM_SLOT_DAMAGED);
    assert_int_equal(verdict_of_section(UINT64_MAX - 63, 64, false), LM_SLOT_DAMAGED);
}

TEST_WITH(the_checksum_of_a_section_that_takes_too_long_is_not_asked_for, erase, NULL)
{
    assert_int_equal(verdict_of_section(0, LM_SLOT_CHECKED_BYTES + 1, false), LM_SLOT_FLOWN);
}

/* All sections together take no longer: of two that each would fit, the second is left out. */
TEST_WITH(the_checksums_of_a_slot_take_no_longer_than_those_of_its_room, erase, NULL)
{
    struct lm_image_header header;
    for (uint64_t more = 0; more < 2; more++) {
        uint64_t room = LM_SLOT_CHECKED_BYTES;
        fill(0, 0, 1);
        memcpy(&header, images[0].bytes, sizeof header);
        for (uint32_t i = 0; i < header.section_count; i++) {
            room -= header.sections[i].bytes <= room ? header.sections[i].bytes : 0;
        }
        header.image_bytes = record_at[0];
        const uint64_t half = room / 2, first = images[0].size, second = first + half;
        add_section(&header, first, half, true);
        add_section(&header, second, room - half + more, false);
        assert_int_equal(verdict_of_header(&header), more ? LM_SLOT_FLOWN : LM_SLOT_DAMAGED);
    }
}

/* A header that says something else when it is read once more, with the same checksum. */
static struct {
    uint32_t reads, section_count;
    uint64_t image_bytes;
} second_header;

static bool fetch_another_header(void *to, const uint8_t *from, uint32_t length)
{
    memcpy(to, from, length);
    if (from == slot_at(0) && second_header.reads++ == 1) {
        struct lm_image_header *h = to;
        h->section_count =
            second_header.section_count ? second_header.section_count : h->section_count;
        h->image_bytes += second_header.image_bytes;
    }
    return true;
}

static enum lm_slot_verdict verdict_of_two_headers(uint32_t section_count, uint64_t more_bytes)
{
    memory_flash_open(&flash, flash_bytes, FLASH_BYTES);
    flash.fetch = fetch_another_header;
    second_header.reads = 0;
    second_header.section_count = section_count;
    second_header.image_bytes = more_bytes;
    lm_slot_flash_open(&slots, &flash.port, &db, scratch, sizeof scratch, POLLS);
    assert_int_equal(second_header.reads, 2);
    return slots.slot[0].verdict;
}

TEST_WITH(a_flash_whose_header_changes_leads_nowhere, erase, NULL)
{
    fill(0, 0, 1);
    assert_int_equal(verdict_of_two_headers(0, 0), LM_SLOT_FLOWN);
    assert_int_equal(verdict_of_two_headers(0, 64), LM_SLOT_DAMAGED);
    /* Behind the last section of a header nothing is taken for one. */
    assert_int_equal(verdict_of_two_headers(UINT32_MAX, 0), LM_SLOT_FLOWN);
}

TEST_WITH(a_record_without_the_number_of_a_load_is_damaged, erase, NULL)
{
    fill(0, 0, 0);
    assert_int_equal(flown(), NONE);
    assert_verdicts(LM_SLOT_DAMAGED, LM_SLOT_EMPTY);
}

TEST_WITH(a_flash_without_slots_is_one_image, erase, NULL)
{
    memcpy(flash_bytes, images[0].bytes, images[0].size);
    assert_int_equal(flown(), 0);
    assert_verdicts(LM_SLOT_EMPTY, LM_SLOT_EMPTY);
    assert_int_equal(slots.port.size_bytes, FLASH_BYTES);
    /* Its first load goes into slot B, and is cut off. */
    const struct lm_slot_record loading = record_of(1, LM_SLOT_LOADING, 1, 0);
    memcpy(slot_at(1) + record_at[0], &loading, sizeof loading);
    assert_int_equal(flown(), 0);
    assert_verdicts(LM_SLOT_EMPTY, LM_SLOT_CUT_OFF);
    fill(1, 1, 1);
    assert_int_equal(flown(), 1);
    /* From here on slot A is written, and what lies there is no image of its own any more. */
    memcpy(slot_at(0) + record_at[1], &loading, sizeof loading);
    slot_at(1)[100] ^= 1;
    assert_int_equal(flown(), NONE);
}

TEST_WITH(reads_that_fail_are_no_sound_slot_and_no_endless_start, erase, NULL)
{
    fill(0, 0, 7);
    fill(1, 1, 8);
    memory_flash_open(&flash, flash_bytes, FLASH_BYTES);
    flash.fail_every = 1;
    lm_slot_flash_open(&slots, &flash.port, &db, scratch, sizeof scratch, POLLS);
    assert_verdicts(LM_SLOT_EMPTY, LM_SLOT_EMPTY);
    for (uint32_t read = 1; read < 40; read++) {
        memory_flash_open(&flash, flash_bytes, FLASH_BYTES);
        flash.fail_read = read;
        lm_slot_flash_open(&slots, &flash.port, &db, scratch, sizeof scratch, POLLS);
        const bool is_old = slots.slot[0].verdict == LM_SLOT_FLOWN;
        const bool is_new = slots.slot[1].verdict == LM_SLOT_FLOWN;
        assert_true(is_old != is_new);
        if (read > 4 && is_old) { /* after the records */
            assert_int_equal(slots.slot[1].verdict, LM_SLOT_DAMAGED);
        }
    }
}

TEST_WITH(a_flash_too_small_for_slots_is_one_image, erase, NULL)
{
    memory_flash_open(&flash, flash_bytes, 256 << 10);
    lm_slot_flash_open(&slots, &flash.port, &db, scratch, sizeof scratch, POLLS);
    assert_int_equal(flash.reads, 0);
    assert_int_equal(slots.port.size_bytes, 256 << 10);
}

/* ---- power is cut ---- */

struct writing {
    size_t at;
    const void *bytes;
    size_t length;
};

/* Write the first `whole` of them, then a part of the next in a drawn order of its bytes. */
static void write_until(const struct writing *all, size_t whole, struct hs_rng *rng)
{
    for (size_t i = 0; i < whole; i++) {
        memcpy(flash_bytes + all[i].at, all[i].bytes, all[i].length);
    }
    const struct writing *torn = &all[whole];
    for (size_t n = hs_rng_below(rng, 400); n > 0; n--) {
        const size_t k = hs_rng_below(rng, (uint32_t)torn->length);
        flash_bytes[torn->at + k] =
            hs_rng_below(rng, 8) == 0 ? 0xff : ((const uint8_t *)torn->bytes)[k];
    }
}

/* The order of docs/slots.md: two records, the image, two records. The old image flies until the
 * first record of the switch, the new one after it. */
TEST_WITH(no_cut_in_a_load_leaves_nothing_or_a_mix_to_fly, erase, NULL)
{
    struct hs_rng rng;
    const struct lm_slot_record loading = record_of(1, LM_SLOT_LOADING, 3, 0);
    const struct lm_slot_record whole = record_of(1, LM_SLOT_WHOLE, 4, 8);
    const size_t base = HALF_BYTES, half = images[1].size / 2;
    const struct writing all[] = {
        {base + record_at[0], &loading, sizeof loading},
        {base + record_at[1], &loading, sizeof loading},
        {base, images[1].bytes, half},
        {base + half, images[1].bytes + half, images[1].size - half},
        {base + record_at[0], &whole, sizeof whole},
        {base + record_at[1], &whole, sizeof whole},
        {FLASH_BYTES - 1, "\xff", 1},
    };
    hs_rng_seed(&rng, 20261123);
    for (size_t cut = 0; cut < sizeof all / sizeof all[0]; cut++) {
        for (int turn = 0; turn < 50; turn++) {
            erase(NULL);
            fill(0, 0, 7);
            fill(1, 0, 6); /* an older load, of the same image: it may not become a mix either */
            write_until(all, cut, &rng);
            const int image = flown();
            assert_true(image != NONE && (cut >= 4 || image == 0) && (cut <= 4 || image == 1));
        }
    }
}

TEST_WITH(a_small_flash_is_read_from_its_first_byte, erase, NULL)
{
    uint8_t bytes[64];
    for (size_t i = 0; i < sizeof bytes; i++) {
        flash_bytes[i] = (uint8_t)(3 * i + 1);
    }
    memory_flash_open(&flash, flash_bytes, 256 << 10);
    lm_slot_flash_open(&slots, &flash.port, &db, scratch, sizeof scratch, POLLS);
    assert_int_equal(lm_db_read(&slots.port, 0, bytes, sizeof bytes, POLLS), LM_OK);
    assert_memory_equal(bytes, flash_bytes, sizeof bytes);
}
