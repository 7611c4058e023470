/* Report descriptors of real devices and of liars. The bytes of real ones are as their makers
 * publish them, and what they must mean comes from whoever described the device, not from us. */
#include "check.h"
#include "drv/hid.h"

#include <stdio.h>
#include <string.h>

/* DragonRise game pad 0079:0011. Its first item of all has no data at all, which means 0. */
static const char dragonrise[] =
    "0501 0904 A101 A102 14 7508 9503 8101 26FF00 9502 0930 0931 8102 7501 9504 8101 2501 950A "
    "0509 "
    "1901 290A 8102 950A 8101 C0 C0";

/* Sony DualShock 3, 054C:0268: report 1 of 49 bytes, a vendor's fields, features. */
static const char dualshock3[] =
    "0501 0904 A101 A102 8501 7508 9501 1500 26FF00 8103 7501 9513 1500 2501 3500 4501 0509 1901 "
    "2913 8102 7501 950D 0600FF 8103 1500 26FF00 0501 0901 A100 7508 9504 3500 46FF00 0930 0931 "
    "0932 "
    "0935 8102 C0 0501 7508 9527 0901 8102 7508 9530 0901 9102 7508 9530 0901 B102 C0 A102 8502 "
    "7508 "
    "9530 0901 B102 C0 A102 85EE 7508 9530 0901 B102 C0 A102 85EF 7508 9530 0901 B102 C0 C0";

/* Xbox One S, 045E:02FD: 16-bit axes, a hat that counts from 1, three input reports, a stray zero
 * behind the end. */
static const char xbox[] =
    "0501 0905 a101 8501 0901 a100 0930 0931 1500 27ffff0000 9502 7510 8102 c0 0901 a100 0932 0935 "
    "1500 27ffff0000 9502 7510 8102 c0 0502 09c5 1500 26ff03 9501 750a 8102 1500 2500 7506 9501 "
    "8103 "
    "0502 09c4 1500 26ff03 9501 750a 8102 1500 2500 7506 9501 8103 0501 0939 1501 2508 3500 463b01 "
    "661400 7504 9501 8142 7504 9501 1500 2500 3500 4500 6500 8103 0509 1901 290f 1500 2501 7501 "
    "950f "
    "8102 1500 2500 7501 9501 8103 050c 0a2402 1500 2501 9501 7501 8102 1500 2500 7507 9501 8103 "
    "050c "
    "0901 8502 a101 050c 0a2302 1500 2501 9501 7501 8102 1500 2500 7507 9501 8103 c0 050f 0921 "
    "8503 "
    "a102 0997 1500 2501 7504 9501 9102 1500 2500 7504 9501 9103 0970 1500 2564 7508 9504 9102 "
    "0950 "
    "660110 550e 1500 26ff00 7508 9501 9102 09a7 1500 26ff00 7508 9501 9102 6500 5500 097c 1500 "
    "26ff00 "
    "7508 9501 9102 c0 0506 0920 8504 1500 26ff00 7508 9501 8102 c0 00";

/* The joystick part of the example of "Device Class Definition for PID 1.0" (USB-IF): throttle,
 * X, Y, a hat of four positions, four buttons. */
static const char pid_example[] =
    "0501 1500 0904 A101 8501 0502 09BB 1581 257F 7508 9501 8102 0501 0901 A100 0930 0931 9502 "
    "8102 C0 "
    "0939 1500 2503 3500 460E01 661400 7504 9501 8102 4500 660000 0509 1901 2904 2501 9504 7501 "
    "3500 "
    "8102 C0";

/* As the Logitech Extreme 3D Pro packs its report (Circuits@Home, 2012): X and Y of 10 bits, a hat
 * of 4, Rz, 8 buttons, slider, 4 buttons; with the Push and Pop that trip parsers. */
static const char packed[] =
    "0501 0904 A101 A102 9502 750A 1500 26FF03 0930 0931 8102 9501 7504 2507 0939 8142 7508 26FF00 "
    "0935 8102 A4 9508 7501 2501 0509 1901 2908 8102 B4 0936 8102 9504 7501 2501 0509 1909 290C "
    "8102 "
    "9504 8101 C0 C0";

static size_t bytes_of(const char *hex, uint8_t *bytes)
{
    size_t size = 0;
    int used;
    for (unsigned value; sscanf(hex, " %2x%n", &value, &used) == 1; hex += used) {
        bytes[size++] = (uint8_t)value;
    }
    return size;
}

static const char *parse(const char *hex, struct drv_hid_map *map)
{
    uint8_t bytes[1024];
    return drv_hid_parse(bytes, bytes_of(hex, bytes), map);
}

static const struct drv_hid_field *field_of(const struct drv_hid_map *map, uint16_t page,
                                            uint16_t usage)
{
    for (uint32_t i = 0; i < map->count; i++) {
        if (map->field[i].page == page && map->field[i].usage == usage) {
            return &map->field[i];
        }
    }
    fail_msg("no field of page %u, usage %x", page, usage);
    return NULL;
}

static void expect_field(const struct drv_hid_map *map, uint16_t page, uint16_t usage, int bit,
                         int bits, int32_t low, int32_t high)
{
    const struct drv_hid_field *f = field_of(map, page, usage);
    assert_int_equal(f->bit, bit);
    assert_int_equal(f->bits, bits);
    assert_int_equal(f->low, low);
    assert_int_equal(f->high, high);
}

static int32_t value_in(const struct drv_hid_map *map, uint16_t page, uint16_t usage,
                        const char *report)
{
    uint8_t bytes[DRV_HID_REPORT_BYTES];
    int32_t value;
    assert_true(
        drv_hid_read(map, field_of(map, page, usage), bytes, bytes_of(report, bytes), &value));
    return value;
}

TEST(a_dragonrise_pad_has_two_axes_behind_three_idle_bytes_and_ten_buttons)
{
    struct drv_hid_map map;
    assert_null(parse(dragonrise, &map));
    assert_int_equal(map.application, 4);
    assert_false(map.has_numbers);
    assert_int_equal(map.count, 12);
    expect_field(&map, 1, 0x30, 24, 8, 0, 255);
    expect_field(&map, 1, 0x31, 32, 8, 0, 255);
    expect_field(&map, 9, 1, 44, 1, 0, 1);
    expect_field(&map, 9, 10, 53, 1, 0, 1);
}

TEST(a_dualshock_has_four_axes_and_nineteen_buttons_in_report_one)
{
    struct drv_hid_map map;
    assert_null(parse(dualshock3, &map));
    assert_true(map.has_numbers);
    assert_int_equal(map.count, 23);
    expect_field(&map, 9, 1, 8, 1, 0, 1);
    expect_field(&map, 9, 19, 26, 1, 0, 1);
    expect_field(&map, 1, 0x30, 40, 8, 0, 255);
    expect_field(&map, 1, 0x35, 64, 8, 0, 255);
    assert_int_equal(field_of(&map, 1, 0x30)->report, 1);
}

/* Places as the table of the xpadneo project has them. */
TEST(an_xbox_pad_has_the_places_that_others_have_found)
{
    struct drv_hid_map map;
    assert_null(parse(xbox, &map));
    assert_int_equal(map.application, 5);
    expect_field(&map, 1, 0x30, 0, 16, 0, 65535);
    expect_field(&map, 1, 0x31, 16, 16, 0, 65535);
    expect_field(&map, 1, 0x35, 48, 16, 0, 65535);
    expect_field(&map, 1, 0x39, 96, 4, 1, 8);
    expect_field(&map, 9, 1, 104, 1, 0, 1);
    expect_field(&map, 9, 15, 118, 1, 0, 1);
}

TEST(the_example_of_the_standard_is_understood)
{
    struct drv_hid_map map;
    assert_null(parse(pid_example, &map));
    expect_field(&map, 2, DRV_HID_THROTTLE, 0, 8, -127, 127);
    expect_field(&map, 1, 0x30, 8, 8, -127, 127);
    expect_field(&map, 1, 0x31, 16, 8, -127, 127);
    expect_field(&map, 1, 0x39, 24, 4, 0, 3);
    expect_field(&map, 9, 4, 31, 1, 0, 1);
    assert_int_equal(value_in(&map, 1, 0x30, "01 00 81 7F 00"), -127);
    assert_int_equal(value_in(&map, 1, 0x31, "01 00 81 7F 00"), 127);
}

/* The report and what it means are those of the article: FC F1 87 80 is X 1FC, Y 1FC, hat 8. */
TEST(ten_bit_axes_across_bytes_read_as_others_read_them)
{
    struct drv_hid_map map;
    assert_null(parse(packed, &map));
    const char rest[] = "FC F1 87 80 00 00 00";
    assert_int_equal(value_in(&map, 1, 0x30, rest), 0x1fc);
    assert_int_equal(value_in(&map, 1, 0x31, rest), 0x1fc);
    assert_int_equal(value_in(&map, 1, 0x35, rest), 0x80);
    const struct drv_hid_field *hat = field_of(&map, 1, 0x39);
    uint8_t bytes[8];
    int32_t value;
    assert_false(drv_hid_read(&map, hat, bytes, bytes_of(rest, bytes), &value));
    assert_int_equal(value, 8);
    /* After Pop the slider is 8 bits of 0..255 again, behind the buttons. */
    expect_field(&map, 1, 0x36, 40, 8, 0, 255);
    expect_field(&map, 9, 12, 51, 1, 0, 1);
}

TEST(a_maximum_written_as_minus_one_byte_is_255)
{
    struct drv_hid_map map;
    assert_null(parse("0501 0904 A101 25FF 1500 7508 9501 0930 8102 C0", &map));
    assert_int_equal(map.field[0].high, 255);
    assert_null(parse("0501 0904 A101 1581 257F 7508 9501 0930 8102 C0", &map));
    assert_int_equal(map.field[0].low, -127);
    assert_int_equal(map.field[0].high, 127);
}

TEST(a_report_that_is_too_short_or_another_one_says_nothing)
{
    struct drv_hid_map map;
    int32_t value;
    assert_null(parse(pid_example, &map));
    const struct drv_hid_field *y = field_of(&map, 1, 0x31);
    const uint8_t right[] = {1, 0, 5, 6}, other[] = {2, 0, 5, 6};
    assert_true(drv_hid_read(&map, y, right, 4, &value));
    assert_int_equal(value, 6);
    for (size_t size = 0; size < 4; size++) {
        assert_false(drv_hid_read(&map, y, right, size, &value));
    }
    assert_false(drv_hid_read(&map, y, other, 4, &value));
}

TEST(a_descriptor_that_contradicts_itself_is_refused)
{
    static const struct {
        const char *hex, *cause;
    } bad[] = {
        {"0501 0904 A101", "does not end"},
        {"C0", "did not begin"},
        {"0501 09", "cut off"},
        {"FE", "cut off"},
        {"FE 20 00 11", "cut off"},
        {"A101 A101 A101 A101 A101 A101 A101 A101 A101", "too deep"},
        {"A4 A4 A4 A4 A4", "pushed"},
        {"B4", "popped"},
        {"A101 7508 9501 0930 1505 2503 8102 C0", "minimum is above"},
        {"A101 0930 8102 C0", "without a size"},
        {"A101 7521 9501 0930 8102 C0", "without a size"},
        {"A101 7508 9541 0930 8102 C0", "longer than 64"},
        {"A101 7508 9540 0930 8102 8102 C0", "longer than 64"},
        {"A101 7520 97FFFFFFFF 0930 8102 C0", "longer than 64"},
        {"A101 7508 97FFFFFF1F 0930 8103 C0", "longer than 64"},
        {"A101 8500 C0", "not 1..255"},
        {"A101 860001 C0", "not 1..255"},
        {"A101 7508 9501 0930 2501 8102 8501 C0", "after fields without one"},
        {"A101 1905 2901 C0", "backwards"},
        {"0700000100", "beyond 16 bits"},
        {"7508 9501 0930 2501 8102", "outside of any collection"},
        {"0C", "does not exist"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct drv_hid_map map;
        const char *cause = parse(bad[i].hex, &map);
        if (cause == NULL || strstr(cause, bad[i].cause) == NULL) {
            fail_msg("%s: %s", bad[i].hex, cause ? cause : "accepted");
        }
    }
    static uint8_t long_one[DRV_HID_DESCRIPTOR_BYTES + 1];
    struct drv_hid_map map;
    assert_non_null(drv_hid_parse(long_one, sizeof long_one, &map));
}

TEST(a_real_descriptor_cut_anywhere_is_refused)
{
    uint8_t bytes[1024];
    const size_t size = bytes_of(dualshock3, bytes);
    for (size_t length = 5; length < size; length++) {
        struct drv_hid_map map;
        const char *cause = drv_hid_parse(bytes, length, &map);
        assert_non_null(cause); /* the collection that began at the fifth byte ends with the last */
    }
}

TEST(more_fields_than_there_is_room_for_are_left_out)
{
    struct drv_hid_map map;
    assert_null(parse("0501 0904 A101 1500 2501 0509 1901 29FF 7501 96FF01 8102 C0", &map));
    assert_int_equal(map.count, DRV_HID_FIELDS);
    assert_int_equal(map.field[DRV_HID_FIELDS - 1].usage, DRV_HID_FIELDS);
}
