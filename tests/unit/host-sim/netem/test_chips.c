/* Chips from files: written here byte by byte as the format is described, and damaged. */
#include "check.h"
#include "gis/gdal_start.h"
#include "hs/png.h"
#include "netem/chip.h"
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { COLUMNS = 5, ROWS = 3, FILE_SIZE_MAX = 2048 };

static void put_float(unsigned char *at, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; i++) {
        at[i] = (unsigned char)(bits >> (24 - 8 * i));
    }
}

/* A chip as the MSTAR release describes it; `extra` goes into the header. Magnitudes are
 * 0.25 * (1, 2, 3 ...), phases follow. */
static size_t make_mstar(unsigned char *bytes, const char *extra)
{
    char header[512];
    const char *text =
        "[PhoenixHeaderVer01.04]\n"
        "PhoenixHeaderLength= %05d\n"
        "PhoenixSigSize= 00120\n"
        "PhoenixSigNum= 0001\n"
        "native_header_length= 0\n"
        "Filename= HB14931.015\n"
        "NumberOfColumns= 5\n"
        "NumberOfRows= 3\n"
        "TargetType= slicey\n"
        "TargetAz= 282.952300\n"
        "DesiredDepression= 15\n"
        "MeasuredDepression= 15.046900\n"
        "%s"
        "[EndofPhoenixHeader]\n";
    const int length = snprintf(header, sizeof header, text, 0, extra);
    snprintf(header, sizeof header, text, length, extra);
    memcpy(bytes, header, (size_t)length);
    for (int i = 0; i < 2 * COLUMNS * ROWS; i++) {
        put_float(bytes + length + 4 * i, 0.25f * (float)(i + 1));
    }
    return (size_t)length + 8 * COLUMNS * ROWS;
}

TEST(a_raw_mstar_chip_gives_its_magnitudes_and_its_aspect)
{
    unsigned char bytes[FILE_SIZE_MAX];
    char path[] = "/tmp/landmass-chip-XXXXXX";
    const int fd = mkstemp(path);
    const size_t size = make_mstar(bytes, "");
    assert_int_equal(write(fd, bytes, size), size);
    close(fd);
    struct nm_chip chip;
    assert_int_equal(nm_chip_read(&chip, path), 0);
    assert_int_equal(chip.picture.width, COLUMNS);
    assert_int_equal(chip.picture.height, ROWS);
    for (int i = 0; i < COLUMNS * ROWS; i++) {
        assert_true(chip.picture.pixels[i] == 0.25 * (i + 1));
    }
    assert_true(fabs(chip.azimuth_deg - 282.9523) < 1e-9);
    assert_true(fabs(chip.depression_deg - 15.0469) < 1e-9);
    assert_string_equal(chip.name, path + 5);
    nm_picture_close(&chip.picture);
    unlink(path);
}

TEST(every_truncated_or_impossible_mstar_chip_is_refused)
{
    unsigned char bytes[FILE_SIZE_MAX];
    struct nm_chip chip;
    const size_t size = make_mstar(bytes, "");
    const size_t half = size - 4 * COLUMNS * ROWS; /* the phases may be missing */
    assert_int_equal(nm_chip_parse_mstar(&chip, "whole", bytes, half), 0);
    nm_picture_close(&chip.picture);
    for (size_t cut = 17; cut < half; cut += 37) {
        assert_int_equal(nm_chip_parse_mstar(&chip, "cut", bytes, cut), -1);
    }
    static const char *const lies[] = {
        "NumberOfColumns= 0\n",
        "NumberOfColumns= 4097\n",
        "NumberOfRows= -3\n",
        "NumberOfRows= 2.5\n",
        "NumberOfRows= many\n",
        "NumberOfRows= nan\n",
        "PhoenixHeaderLength= 1e9\n",
        "PhoenixHeaderLength= -5\n",
        "native_header_length= 512\n",
        "NumberOfColumns= 1000000000000\n",
        "TargetAz= 1e30\n",
    };
    for (size_t i = 0; i < sizeof lies / sizeof lies[0]; i++) {
        const size_t with_lie = make_mstar(bytes, lies[i]);
        assert_int_equal(nm_chip_parse_mstar(&chip, lies[i], bytes, with_lie), -1);
    }
}

TEST(a_magnitude_that_is_none_is_refused)
{
    static const float wrong[] = {-1, NAN, INFINITY, 2e9f};
    for (int i = 0; i < 4; i++) {
        unsigned char bytes[FILE_SIZE_MAX];
        struct nm_chip chip;
        const size_t size = make_mstar(bytes, "");
        put_float(bytes + size - 4 * (2 * COLUMNS * ROWS - 7), wrong[i]);
        assert_int_equal(nm_chip_parse_mstar(&chip, "wrong", bytes, size), -1);
    }
}

TEST(an_angle_that_is_absent_is_unknown)
{
    unsigned char bytes[FILE_SIZE_MAX];
    struct nm_chip chip;
    const size_t size =
        make_mstar(bytes, "TargetAz= \nMeasuredDepression= 95\nDesiredDepression= 0\n");
    assert_int_equal(nm_chip_parse_mstar(&chip, "no angles", bytes, size), 0);
    assert_true(isnan(chip.azimuth_deg) && isnan(chip.depression_deg));
    nm_picture_close(&chip.picture);
}

static int parse_csv(struct nm_chip *chip, const char *text)
{
    return nm_chip_parse_csv(chip, "chip.csv", text, strlen(text));
}

TEST(a_csv_chip_is_rows_of_numbers)
{
    struct nm_chip chip;
    assert_int_equal(parse_csv(&chip, "0.5, 1,2\r\n\n3 4,\t5e-1\n\n"), 0);
    assert_int_equal(chip.picture.width, 3);
    assert_int_equal(chip.picture.height, 2);
    static const double expected[] = {0.5, 1, 2, 3, 4, 0.5};
    assert_memory_equal(chip.picture.pixels, expected, sizeof expected);
    nm_picture_close(&chip.picture);
}

TEST(a_csv_chip_that_is_no_chip_is_refused)
{
    static const char *const wrong[] = {"",      "\n\n",   "1,2\n3\n", "1\n2,3\n",
                                        "a,b\n", "1,,2\n", "1,-2\n",   "nan\n",
                                        "inf\n", "1;2\n",  "1,2x\n"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        struct nm_chip chip;
        if (parse_csv(&chip, wrong[i]) != -1) {
            fail_msg("accepted: %s", wrong[i]);
        }
    }
}

TEST(a_png_chip_is_read_from_zero_to_one)
{
    char path[] = "/tmp/landmass-chip-XXXXXX.png";
    const int fd = mkstemps(path, 4);
    close(fd);
    static const uint8_t pixels[6] = {0, 51, 102, 153, 204, 255};
    assert_int_equal(hs_png_write_grey(path, pixels, 3, 2, 3), 0);
    struct nm_chip chip;
    db_gdal_start();
    assert_int_equal(nm_chip_read(&chip, path), 0);
    assert_int_equal(chip.picture.width, 3);
    for (int i = 0; i < 6; i++) {
        assert_true(fabs(chip.picture.pixels[i] - 0.2 * i) < 1e-12);
    }
    assert_true(isnan(chip.azimuth_deg));
    nm_picture_close(&chip.picture);
    unlink(path);
}

TEST(a_real_chip_is_read)
{
    char path[512];
    if (!support_data_path("mstar_t72_15deg/170001.jpeg", path, sizeof path)) {
        skip();
    }
    struct nm_chip chip;
    db_gdal_start();
    assert_int_equal(nm_chip_read(&chip, path), 0);
    assert_int_equal(chip.picture.width, 128);
    assert_int_equal(chip.picture.height, 128);
    double most = 0;
    for (int i = 0; i < 128 * 128; i++) {
        most = fmax(most, chip.picture.pixels[i]);
    }
    assert_true(most == 1);
    nm_picture_close(&chip.picture);
}
