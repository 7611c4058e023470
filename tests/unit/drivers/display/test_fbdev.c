/* The frame buffer driver over a screen that is a file, whose shape the test tells. */
#include "check.h"
#include "drv/fbdev.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/fb.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

enum { WIDTH = 40, HEIGHT = 30, PITCH = 192, SIDE = 20 };

static struct {
    struct fb_var_screeninfo v;
    struct fb_fix_screeninfo fix;
    uint32_t pans;
    bool refuses_pan;
    int fd; /* of the memory */
    const uint8_t *memory;
} screen;

int __wrap_open(const char *path, int flags, ...);
int __wrap_ioctl(int fd, unsigned long request, ...);

int __wrap_open(const char *path, int flags, ...)
{
    (void)flags;
    if (strcmp(path, "/dev/fb-test") == 0) {
        return dup(screen.fd);
    }
    errno = ENOENT;
    return -1;
}

int __wrap_ioctl(int fd, unsigned long request, ...)
{
    va_list arguments;
    va_start(arguments, request);
    void *p = va_arg(arguments, void *);
    va_end(arguments);
    (void)fd;
    if (request == FBIOGET_VSCREENINFO) {
        memcpy(p, &screen.v, sizeof screen.v);
        return 0;
    }
    if (request == FBIOGET_FSCREENINFO) {
        memcpy(p, &screen.fix, sizeof screen.fix);
        return 0;
    }
    if (request == FBIOPAN_DISPLAY && !screen.refuses_pan) {
        memcpy(&screen.v, p, sizeof screen.v);
        screen.pans++;
        return 0;
    }
    errno = EINVAL;
    return -1;
}

static int set_up(void **state)
{
    (void)state;
    memset(&screen, 0, sizeof screen);
    screen.v = (struct fb_var_screeninfo){.xres = WIDTH,
                                          .yres = HEIGHT,
                                          .xres_virtual = WIDTH,
                                          .yres_virtual = HEIGHT,
                                          .bits_per_pixel = 32,
                                          .red = {.offset = 16},
                                          .green = {.offset = 8}};
    screen.fix = (struct fb_fix_screeninfo){.line_length = PITCH, .smem_len = 2 * PITCH * HEIGHT};
    screen.fd = memfd_create("screen", MFD_CLOEXEC);
    assert_int_equal(ftruncate(screen.fd, (off_t)screen.fix.smem_len), 0);
    screen.memory = mmap(NULL, screen.fix.smem_len, PROT_READ, MAP_SHARED, screen.fd, 0);
    assert_true(screen.memory != MAP_FAILED);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    munmap((void *)(uintptr_t)screen.memory, screen.fix.smem_len);
    close(screen.fd);
    return 0;
}

static int show(struct drv_fbdev *f, uint32_t colour)
{
    uint32_t pixels[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; i++) {
        pixels[i] = colour;
    }
    const struct lm_surface picture = {
        .pixels = pixels, .stride_px = SIDE, .width_px = SIDE, .height_px = SIDE};
    return drv_fbdev_present(f, &picture);
}

/* In the middle of what is visible. */
static const uint8_t *middle(void)
{
    const uint32_t row = screen.v.yoffset + HEIGHT / 2;
    return screen.memory + row * PITCH + WIDTH / 2 * screen.v.bits_per_pixel / 8;
}

static uint32_t middle_word(void)
{
    uint32_t word;
    memcpy(&word, middle(), sizeof word);
    return word;
}

TEST_WITH(a_screen_of_one_picture_is_written_to_directly, set_up, tear_down)
{
    struct drv_fbdev f;
    assert_int_equal(drv_fbdev_open(&f, "/dev/fb-test", DRV_TURN_0), LM_OK);
    assert_false(f.can_pan);
    for (uint32_t n = 1; n < 5; n++) {
        assert_int_equal(show(&f, n), LM_OK);
        assert_int_equal(middle_word(), n);
    }
    assert_int_equal(screen.memory[0], 0); /* the border is black */
    drv_fbdev_close(&f);
    drv_fbdev_close(&f); /* once more does no harm */
}

TEST_WITH(a_screen_of_two_is_turned_over_only_when_the_picture_is_whole, set_up, tear_down)
{
    struct drv_fbdev f;
    screen.v.yres_virtual = 2 * HEIGHT;
    screen.fix.ypanstep = 1;
    assert_int_equal(drv_fbdev_open(&f, "/dev/fb-test", DRV_TURN_0), LM_OK);
    assert_true(f.can_pan);
    for (uint32_t n = 1; n < 5; n++) {
        assert_int_equal(show(&f, n), LM_OK);
        assert_int_equal(screen.pans, n);
        assert_int_equal(screen.v.yoffset, n % 2 * HEIGHT);
        assert_int_equal(middle_word(), n);
    }
    screen.refuses_pan = true;
    assert_int_equal(show(&f, 9), LM_ERR_IO);
    assert_int_not_equal(middle_word(), 9); /* the last whole picture stays */
    assert_int_equal(f.count.errors, 1);
    drv_fbdev_close(&f);
}

TEST_WITH(a_screen_of_sixteen_bits_gets_sixteen_bits, set_up, tear_down)
{
    struct drv_fbdev f;
    screen.v.bits_per_pixel = 16;
    screen.v.red.offset = 11;
    screen.v.green.offset = 5;
    assert_int_equal(drv_fbdev_open(&f, "/dev/fb-test", DRV_TURN_90), LM_OK);
    assert_int_equal(show(&f, 0xff0000), LM_OK);
    assert_int_equal(middle()[0], 0x00);
    assert_int_equal(middle()[1], 0xf8);
    drv_fbdev_close(&f);
}

TEST_WITH(what_cannot_be_shown_on_is_refused, set_up, tear_down)
{
    struct drv_fbdev f;
    assert_int_equal(drv_fbdev_open(&f, "/dev/fb-none", DRV_TURN_0), LM_ERR_IO);
    assert_non_null(strstr(f.error, "/dev/fb-none"));
    screen.v.red.offset = 0; /* blue and red exchanged */
    screen.v.blue.offset = 16;
    assert_int_equal(drv_fbdev_open(&f, "/dev/fb-test", DRV_TURN_0), LM_ERR_IO);
    screen.v.red.offset = 16;
    screen.v.blue.offset = 0;
    screen.fix.line_length = 4 * WIDTH - 1; /* rows that overlap */
    assert_int_equal(drv_fbdev_open(&f, "/dev/fb-test", DRV_TURN_0), LM_ERR_IO);
    screen.fix.line_length = PITCH;
    screen.fix.smem_len = PITCH * HEIGHT - 1; /* less memory than screen */
    assert_int_equal(drv_fbdev_open(&f, "/dev/fb-test", DRV_TURN_0), LM_ERR_IO);
    assert_non_null(strstr(f.error, "contradict"));
    screen.fix.smem_len = 2 * PITCH * HEIGHT;
    assert_int_equal(f.fd, -1);
}
