/* Traced records: the contract of records.h, and a file that is believed only when all of it holds.
 */
#include "check.h"
#include "known_records.h"
#include "support.h"
#include "tracer/records.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RAYS = 8 };

static const char *scratch(void)
{
    static char path[256];
    support_run("mkdir -p %s/tmp", support_build_dir());
    snprintf(path, sizeof path, "%s/tmp/known.trace", support_build_dir());
    return path;
}

TEST(the_known_records_keep_the_contract)
{
    struct trace_records r;
    known_plate(&r, 2, 30, RAYS);
    assert_int_equal(trace_records_check(&r, "plate"), 0);
    trace_records_free(&r);
    known_dihedral(&r, 1, 0.5, 15, RAYS);
    assert_int_equal(trace_records_check(&r, "dihedral"), 0);
    trace_records_free(&r);
}

TEST(what_is_written_is_read_back_to_the_bit)
{
    struct trace_records r, again;
    known_dihedral(&r, 1, 0.5, 15, RAYS);
    assert_int_equal(trace_records_write(&r, scratch()), 0);
    assert_int_equal(trace_records_read(&again, scratch()), 0);
    assert_memory_equal(&again.look, &r.look, sizeof r.look);
    assert_memory_equal(&again.grid, &r.grid, sizeof r.grid);
    assert_memory_equal(&again.sensor, &r.sensor, sizeof r.sensor);
    assert_memory_equal(again.materials, r.materials, sizeof r.materials);
    assert_int_equal(again.bounce_count, r.bounce_count);
    for (uint32_t b = 0; b < r.bounce_count; b++) {
        assert_int_equal(again.bounces[b].count, r.bounces[b].count);
        assert_memory_equal(again.bounces[b].records, r.bounces[b].records,
                            r.bounces[b].count * sizeof(struct trace_record));
    }
    trace_records_free(&again);
    trace_records_free(&r);
}

static size_t load(const char *path, uint8_t **bytes);

/* Ends that are not plain make another version, so that who does not know them refuses the file. */
TEST(where_transmitter_and_receiver_stand_is_read_back)
{
    static const struct {
        struct trace_ends ends;
        bool is_sound;
        uint8_t version;
    } cases[] = {
        {{0, false, 0, 0, 0}, true, 1},      {{25, false, 0, 0, 0}, true, 2},
        {{0, true, 0, 30, 0}, true, 2},      {{25, true, 310, 20, 1e6}, true, 2},
        {{0.001, false, 0, 0, 0}, false, 0}, {{NAN, false, 0, 0, 0}, false, 0},
        {{25, false, 310, 0, 0}, false, 0},  {{25, true, 360, 30, 0}, false, 0},
        {{25, true, 310, 90, 0}, false, 0},  {{25, true, 310, 30, -1}, false, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct trace_records r, again;
        known_dihedral(&r, 1, 0.5, 15, RAYS);
        r.ends = cases[i].ends;
        assert_int_equal(trace_records_write(&r, scratch()), cases[i].is_sound ? 0 : -1);
        trace_records_free(&r);
        if (!cases[i].is_sound) {
            continue;
        }
        assert_int_equal(trace_records_read(&again, scratch()), 0);
        const struct trace_ends *found = &again.ends, *given = &cases[i].ends;
        assert_true(found->distance_m == given->distance_m && found->is_apart == given->is_apart &&
                    found->receiver_azimuth_deg == given->receiver_azimuth_deg &&
                    found->receiver_depression_deg == given->receiver_depression_deg &&
                    found->receiver_distance_m == given->receiver_distance_m);
        trace_records_free(&again);
        uint8_t *bytes;
        load(scratch(), &bytes);
        assert_int_equal(bytes[8], cases[i].version);
        free(bytes);
    }
}

/* Records in memory may have more: those of a file are named in its head. */
TEST(more_materials_than_a_file_names_are_not_written)
{
    struct trace_records r, again;
    known_dihedral(&r, 1, 0.5, 15, RAYS);
    for (uint32_t m = r.material_count; m < TRACE_FILE_MATERIALS_MAX + 1; m++) {
        snprintf(r.materials[m], TRACE_NAME_SIZE, "metal.%u", m);
    }
    for (uint32_t more = 0; more < 2; more++) {
        r.material_count = TRACE_FILE_MATERIALS_MAX + more;
        assert_int_equal(trace_records_check(&r, "dihedral"), 0);
        assert_int_equal(trace_records_write(&r, scratch()), more ? -1 : 0);
    }
    assert_int_equal(trace_records_read(&again, scratch()), 0);
    assert_int_equal(again.material_count, TRACE_FILE_MATERIALS_MAX);
    assert_string_equal(again.materials[31], "metal.31");
    trace_records_free(&again);
    trace_records_free(&r);
}

static size_t load(const char *path, uint8_t **bytes)
{
    FILE *in = fopen(path, "rb");
    assert_non_null(in);
    assert_int_equal(fseek(in, 0, SEEK_END), 0);
    const size_t size = (size_t)ftell(in);
    rewind(in);
    *bytes = malloc(size);
    assert_int_equal(fread(*bytes, 1, size, in), size);
    fclose(in);
    return size;
}

static int read_bytes(const uint8_t *bytes, size_t size)
{
    FILE *out = fopen(scratch(), "wb");
    fwrite(bytes, 1, size, out);
    fclose(out);
    struct trace_records r;
    const int result = trace_records_read(&r, scratch());
    trace_records_free(&r);
    return result;
}

/* One bit of each byte in turn, and each length up to the whole. */
TEST(a_file_of_which_any_byte_changed_or_is_missing_is_refused)
{
    struct trace_records r;
    known_dihedral(&r, 1, 0.5, 15, 2);
    assert_int_equal(trace_records_write(&r, scratch()), 0);
    trace_records_free(&r);
    uint8_t *bytes;
    const size_t size = load(scratch(), &bytes);
    for (size_t i = 0; i < size; i++) {
        bytes[i] ^= (uint8_t)(1 << i % 8);
        assert_int_equal(read_bytes(bytes, size), -1);
        bytes[i] ^= (uint8_t)(1 << i % 8);
    }
    for (size_t length = 0; length < size; length += 7) {
        assert_int_equal(read_bytes(bytes, length), -1);
    }
    assert_int_equal(read_bytes(bytes, size), 0);
    free(bytes);
}

/* Each field of a record, one after the other, set to what it must not be. */
TEST(a_record_that_breaks_the_contract_is_not_written)
{
    struct trace_records r;
    known_dihedral(&r, 1, 0.5, 15, RAYS);
    struct trace_record *t = &r.bounces[1].records[3];
    const struct trace_record good = *t;
    enum { FAULTS = 13 };
    struct trace_record bad[FAULTS];
    for (int i = 0; i < FAULTS; i++) {
        bad[i] = good;
    }
    bad[0].ray = RAYS * RAYS;
    bad[1].ray = 2;
    bad[2].parent = 2;
    bad[3].across_m = NAN;
    bad[4].range_m = INFINITY;
    bad[5].phase_rad = 4;
    bad[6].incidence_rad = 1.6f;
    bad[7].echo_rad = 1.6f;
    bad[8].turn_rad = -0.1f;
    bad[9].normal[1] = 0.5f;
    bad[10].material = 2;
    bad[11].flags = 4;
    bad[12].flags = TRACE_GOES_ON;
    for (int i = 0; i < FAULTS; i++) {
        *t = bad[i];
        assert_int_equal(trace_records_check(&r, "broken on purpose"), -1);
    }
    *t = good;
    assert_int_equal(trace_records_check(&r, "whole"), 0);
    trace_records_free(&r);
}

TEST(an_echo_falls_into_the_cell_that_holds_it)
{
    const struct trace_grid grid = {4, 6, 0.5};
    assert_int_equal(trace_cell(&grid, -1, -1.5f), 0);
    assert_int_equal(trace_cell(&grid, 0.99f, -1.5f), 3);
    assert_int_equal(trace_cell(&grid, 0, 0), 3 * 4 + 2);
    assert_int_equal(trace_cell(&grid, 0.99f, 1.49f), 23);
    assert_int_equal(trace_cell(&grid, 1, 0), -1);
    assert_int_equal(trace_cell(&grid, 0, 1.5f), -1);
    assert_int_equal(trace_cell(&grid, -1.01f, 0), -1);
    assert_int_equal(trace_cell(&grid, NAN, 0), -1);
}

TEST(the_image_of_a_channel_is_keyed_by_the_place_of_emission)
{
    struct trace_records r;
    known_dihedral(&r, 1, 0.5, 15, RAYS);
    struct trace_bounce *second = &r.bounces[1];
    second->records[0] = second->records[5]; /* only ray 5 is left of the second bounce */
    second->count = 1;
    float image[RAYS * RAYS];
    trace_image(&r, 1, TRACE_MATERIAL, image);
    for (int i = 0; i < RAYS * RAYS; i++) {
        assert_true(i == 5 ? image[i] == 0 : isnan(image[i]));
    }
    trace_image(&r, 0, TRACE_INCIDENCE, image);
    assert_true(fabsf(image[0] - 75 * 3.14159265f / 180) < 1e-6f);               /* floor, low */
    assert_true(fabsf(image[RAYS * RAYS - 1] - 15 * 3.14159265f / 180) < 1e-6f); /* wall, high */
    trace_records_free(&r);
}
