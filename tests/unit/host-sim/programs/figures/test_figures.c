/* landmass-figures: pictures that are there, not empty, and nothing left of a failure. */
#include "check.h"
#include "support.h"

#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static int draw(const char *arguments)
{
    return support_run("%s/bin/landmass-figures %s 2>/dev/null >/dev/null", support_build_dir(),
                       arguments);
}

/* Pixels of neither white nor grey: ink. */
static size_t inked_pixels(const char *path)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    size_t ink = 0;
    assert_true(png_image_begin_read_from_file(&image, path));
    image.format = PNG_FORMAT_RGB;
    uint8_t *pixels = malloc(PNG_IMAGE_SIZE(image));
    assert_non_null(pixels);
    assert_true(png_image_finish_read(&image, NULL, pixels, 0, NULL));
    for (size_t i = 0; i < PNG_IMAGE_SIZE(image); i += 3) {
        ink += pixels[i] != pixels[i + 1] || pixels[i] != pixels[i + 2];
    }
    free(pixels);
    return ink;
}

TEST(every_figure_is_drawn)
{
    static const char *const names[] = {"figure1", "table1"};
    assert_int_equal(support_run("mkdir -p %s/tmp", support_build_dir()), 0);
    for (int i = 0; i < 2; i++) {
        char path[512], arguments[600];
        snprintf(path, sizeof path, "%s/tmp/%s-%ld.png", support_build_dir(), names[i],
                 (long)getpid());
        snprintf(arguments, sizeof arguments, "%s %s", names[i], path);
        assert_int_equal(draw(arguments), 0);
        assert_true(inked_pixels(path) > 5000);
        unlink(path);
    }
}

TEST(a_wrong_command_line_exits_with_2_and_an_unwritable_file_with_1)
{
    assert_int_equal(draw("--help"), 0);
    assert_int_equal(draw(""), 2);
    assert_int_equal(draw("figure9 there.png"), 2);
    assert_int_equal(draw("figure1 /no/such/folder/there.png"), 1);
    assert_int_equal(access("there.png", F_OK), -1);
}
