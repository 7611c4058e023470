/* The serial number that was flown: remembered whole, and nothing else is taken for one. */
#include "signed.h"

#include "check.h"
#include "trust/serial.h"

#include <errno.h>
#include <string.h>

TEST(without_a_file_nothing_was_flown)
{
    uint64_t serial = 5;
    assert_int_equal(trust_serial_read(signed_path("none"), &serial), 0);
    assert_int_equal(serial, 0);
}

TEST(what_was_written_is_read)
{
    static const uint64_t numbers[] = {0, 1, 20261123, UINT32_MAX, UINT64_MAX};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        uint64_t serial = 3;
        assert_int_equal(trust_serial_write(signed_path("serial"), numbers[i]), 0);
        assert_int_equal(trust_serial_read(signed_path("serial"), &serial), 0);
        assert_true(serial == numbers[i]);
    }
    signed_run("test ! -e serial.new");
}

TEST(what_is_no_number_is_refused)
{
    static const char *const texts[] = {"",
                                        "\n",
                                        "serial",
                                        "serial \n",
                                        "serial 7",
                                        "serial -7\n",
                                        "serial  7\n",
                                        "serial 7 \n",
                                        "serial 7\n\n",
                                        "serial 18446744073709551616\n",
                                        "serial 111111111111111111111111111111111111111111\n",
                                        "7\n"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        uint64_t serial = 3;
        signed_write("serial", texts[i], strlen(texts[i]));
        assert_int_equal(trust_serial_read(signed_path("serial"), &serial), EBADMSG);
        assert_int_equal(serial, 0);
    }
}

TEST(a_folder_that_cannot_be_written_is_told_and_leaves_nothing)
{
    assert_int_equal(trust_serial_write(signed_path("nowhere/serial"), 7), ENOENT);
    signed_run("mkdir -p folder/serial");
    assert_int_not_equal(trust_serial_write(signed_path("folder/serial"), 7), 0);
    signed_run("test ! -e folder/serial.new");
}

TEST_GROUP(signed_open, NULL);
