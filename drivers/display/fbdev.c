#include "drv/fbdev.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/fb.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

static int fail(struct drv_fbdev *f, const char *device, const char *cause)
{
    snprintf(f->error, sizeof f->error, "%s: %s", device, cause);
    drv_fbdev_close(f);
    return LM_ERR_IO;
}

/* The colours where we put them? */
static bool is_format(const struct fb_var_screeninfo *v, uint32_t bits, uint32_t red,
                      uint32_t green, uint32_t blue)
{
    return v->bits_per_pixel == bits && v->red.offset == red && v->green.offset == green &&
           v->blue.offset == blue;
}

/* Whether `pictures` screens one below the other lie within the memory. */
static bool has_room(const struct fb_fix_screeninfo *fix, const struct fb_var_screeninfo *v,
                     uint32_t pictures)
{
    const uint64_t row_bytes = (uint64_t)v->xres * v->bits_per_pixel / 8;
    return fix->line_length >= row_bytes &&
           (uint64_t)fix->line_length * v->yres * pictures <= fix->smem_len;
}

int drv_fbdev_open(struct drv_fbdev *f, const char *device, enum drv_turn turn)
{
    struct fb_fix_screeninfo fix;
    struct fb_var_screeninfo v;
    *f = (struct drv_fbdev){.turn = turn};
    f->fd = open(device, O_RDWR | O_CLOEXEC);
    if (f->fd < 0) {
        return fail(f, device, strerror(errno));
    }
    if (ioctl(f->fd, FBIOGET_FSCREENINFO, &fix) != 0 ||
        ioctl(f->fd, FBIOGET_VSCREENINFO, &v) != 0) {
        return fail(f, device, "not a frame buffer");
    }
    const bool is_565 = is_format(&v, 16, 11, 5, 0);
    if (!is_565 && !is_format(&v, 32, 16, 8, 0)) {
        return fail(f, device, "its pixels are neither xrgb8888 nor rgb565");
    }
    if (v.xres == 0 || v.yres == 0 || v.xres > 16384 || v.yres > 16384 || !has_room(&fix, &v, 1)) {
        return fail(f, device, "its sizes contradict each other");
    }
    f->size_bytes = fix.smem_len;
    f->bytes = mmap(NULL, f->size_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, f->fd, 0);
    if (f->bytes == MAP_FAILED) {
        f->bytes = NULL;
        return fail(f, device, strerror(errno));
    }
    f->can_pan = v.yres_virtual >= 2 * v.yres && fix.ypanstep > 0 && has_room(&fix, &v, 2);
    f->target = (struct drv_target){f->bytes, fix.line_length, (uint16_t)v.xres, (uint16_t)v.yres,
                                    is_565 ? DRV_RGB565 : DRV_XRGB8888};
    memset(f->bytes, 0, f->size_bytes);
    return LM_OK;
}

void drv_fbdev_close(struct drv_fbdev *f)
{
    if (f->bytes != NULL) {
        munmap(f->bytes, f->size_bytes);
        f->bytes = NULL;
    }
    if (f->fd >= 0) {
        close(f->fd);
        f->fd = -1;
    }
}

int drv_fbdev_present(struct drv_fbdev *f, const struct lm_surface *picture)
{
    struct drv_target to = f->target;
    const uint32_t next = f->can_pan ? f->shown ^ 1 : 0;
    to.bytes = (char *)f->bytes + (size_t)next * to.height_px * to.stride_bytes;
    drv_blit(&to, picture, f->turn, NULL);
    f->count.pictures++;
    if (f->can_pan) {
        struct fb_var_screeninfo v;
        if (ioctl(f->fd, FBIOGET_VSCREENINFO, &v) != 0) {
            f->count.errors++;
            return LM_ERR_IO;
        }
        v.yoffset = next * to.height_px;
        if (ioctl(f->fd, FBIOPAN_DISPLAY, &v) != 0) {
            f->count.errors++;
            return LM_ERR_IO;
        }
        f->shown = next;
    }
    return LM_OK;
}
