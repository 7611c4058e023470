#include "drv/drm.h"

#include "drm_screen.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

_Static_assert(sizeof(struct drm_mode_modeinfo) == sizeof((struct drv_drm *)0)->before.mode,
               "the header keeps room for a mode without knowing the kernel's headers");

static int fail(struct drv_drm *d, const char *format, ...) __attribute__((format(printf, 2, 3)));

static int fail(struct drv_drm *d, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(d->error, sizeof d->error, format, arguments);
    va_end(arguments);
    return LM_ERR_IO;
}

static void release_buffer(struct drv_drm *d, struct drv_drm_buffer *b)
{
    if (b->target.bytes != NULL) {
        munmap(b->target.bytes, b->size_bytes);
    }
    if (b->framebuffer != 0) {
        drm_call(d->fd, DRM_IOCTL_MODE_RMFB, &b->framebuffer);
    }
    if (b->handle != 0) {
        struct drm_mode_destroy_dumb destroy = {.handle = b->handle};
        drm_call(d->fd, DRM_IOCTL_MODE_DESTROY_DUMB, &destroy);
    }
    *b = (struct drv_drm_buffer){0};
}

static void release_buffers(struct drv_drm *d)
{
    for (int i = 0; i < DRV_DRM_BUFFERS; i++) {
        release_buffer(d, &d->buffer[i]);
    }
}

static int make_buffer(struct drv_drm *d, struct drv_drm_buffer *b, uint16_t width, uint16_t height)
{
    const bool is_565 = d->config.format == DRV_RGB565;
    struct drm_mode_create_dumb make = {.width = width, .height = height, .bpp = is_565 ? 16 : 32};
    if (drm_call(d->fd, DRM_IOCTL_MODE_CREATE_DUMB, &make) != 0) {
        return fail(d, "%s: no memory for a picture: %s", d->config.device, strerror(errno));
    }
    b->handle = make.handle;
    struct drm_mode_fb_cmd add = {.width = width,
                                  .height = height,
                                  .pitch = make.pitch,
                                  .bpp = make.bpp,
                                  .depth = is_565 ? 16 : 24,
                                  .handle = make.handle};
    struct drm_mode_map_dumb map = {.handle = make.handle};
    if (drm_call(d->fd, DRM_IOCTL_MODE_ADDFB, &add) != 0) {
        return fail(d, "%s: the card does not show %s: %s", d->config.device,
                    is_565 ? "rgb565" : "xrgb8888", strerror(errno));
    }
    b->framebuffer = add.fb_id;
    if (drm_call(d->fd, DRM_IOCTL_MODE_MAP_DUMB, &map) != 0) {
        return fail(d, "%s: the picture cannot be mapped: %s", d->config.device, strerror(errno));
    }
    void *bytes =
        mmap(NULL, make.size, PROT_READ | PROT_WRITE, MAP_SHARED, d->fd, (off_t)map.offset);
    if (bytes == MAP_FAILED) {
        return fail(d, "%s: the picture cannot be mapped: %s", d->config.device, strerror(errno));
    }
    b->size_bytes = make.size;
    b->target = (struct drv_target){bytes, make.pitch, width, height, d->config.format};
    drv_blit_clear(&b->target);
    memset(&b->lacks, 0xff, sizeof b->lacks); /* all of the picture */
    return LM_OK;
}

static int make_buffers(struct drv_drm *d, uint16_t width, uint16_t height)
{
    if (d->buffer[0].target.width_px == width && d->buffer[0].target.height_px == height) {
        return LM_OK;
    }
    release_buffers(d);
    for (int i = 0; i < DRV_DRM_BUFFERS; i++) {
        if (make_buffer(d, &d->buffer[i], width, height) != LM_OK) {
            release_buffers(d);
            return LM_ERR_IO;
        }
    }
    return LM_OK;
}

/* Remember what the controller showed before we came. */
static void remember(struct drv_drm *d, uint32_t crtc_id)
{
    struct drm_mode_crtc crtc = {.crtc_id = crtc_id};
    if (d->before.crtc_id != 0 || drm_call(d->fd, DRM_IOCTL_MODE_GETCRTC, &crtc) != 0) {
        return;
    }
    d->before.crtc_id = crtc_id;
    d->before.framebuffer = crtc.fb_id;
    d->before.x = crtc.x;
    d->before.y = crtc.y;
    d->before.has_mode = crtc.mode_valid != 0;
    memcpy(d->before.mode, &crtc.mode, sizeof d->before.mode);
}

/* Find a screen and show the front buffer on it. */
static int light(struct drv_drm *d)
{
    struct drm_screen screen;
    const char *cause = drm_screen_find(d->fd, &d->config, &screen);
    if (cause != NULL) {
        return fail(d, "%s: %s", d->config.device, cause);
    }
    if (make_buffers(d, screen.mode.hdisplay, screen.mode.vdisplay) != LM_OK) {
        return LM_ERR_IO;
    }
    drm_call(d->fd, DRM_IOCTL_SET_MASTER, NULL); /* fails for one who is the master already */
    remember(d, screen.crtc_id);
    struct drm_mode_crtc crtc = {.set_connectors_ptr = (uint64_t)(uintptr_t)&screen.connector_id,
                                 .count_connectors = 1,
                                 .crtc_id = screen.crtc_id,
                                 .fb_id = d->buffer[d->front].framebuffer,
                                 .mode_valid = 1,
                                 .mode = screen.mode};
    if (drm_call(d->fd, DRM_IOCTL_MODE_SETCRTC, &crtc) != 0) {
        return fail(d,
                    "%s: the mode of %s cannot be set: %s; does another program hold the screen?",
                    d->config.device, screen.name, strerror(errno));
    }
    drm_screen_find_plane(d->fd, screen.crtc_id, &d->plane);
    d->whole = DRV_DRM_BUFFERS;
    d->connector_id = screen.connector_id;
    d->crtc_id = screen.crtc_id;
    d->width_px = screen.mode.hdisplay;
    d->height_px = screen.mode.vdisplay;
    memcpy(d->connector, screen.name, sizeof d->connector);
    d->state = DRV_DRM_IDLE;
    d->count.lit++;
    d->error[0] = '\0';
    return LM_OK;
}

static void darken(struct drv_drm *d, uint64_t now_us)
{
    d->state = DRV_DRM_DARK;
    d->look_us = now_us + DRV_DRM_LOOK_US;
    d->count.darkened++;
}

int drv_drm_open(struct drv_drm *d, const struct drv_drm_config *config, uint64_t now_us)
{
    *d = (struct drv_drm){.config = *config, .state = DRV_DRM_DARK};
    d->look_us = now_us + DRV_DRM_LOOK_US;
    d->fd = open(config->device, O_RDWR | O_CLOEXEC | O_NONBLOCK);
    if (d->fd < 0) {
        return fail(d, "%s: %s", config->device, strerror(errno));
    }
    struct drm_get_cap dumb = {.capability = DRM_CAP_DUMB_BUFFER};
    if (drm_call(d->fd, DRM_IOCTL_GET_CAP, &dumb) != 0 || dumb.value == 0) {
        const int status = fail(d, "%s: not a card with plain picture memory", config->device);
        close(d->fd);
        d->fd = -1;
        return status;
    }
    (void)light(d);
    return LM_OK;
}

void drv_drm_close(struct drv_drm *d)
{
    if (d->fd < 0) {
        return;
    }
    if (d->before.crtc_id != 0 && d->before.has_mode) {
        struct drm_mode_crtc crtc = {.set_connectors_ptr = (uint64_t)(uintptr_t)&d->connector_id,
                                     .count_connectors = 1,
                                     .crtc_id = d->before.crtc_id,
                                     .fb_id = d->before.framebuffer,
                                     .x = d->before.x,
                                     .y = d->before.y,
                                     .mode_valid = 1};
        memcpy(&crtc.mode, d->before.mode, sizeof crtc.mode);
        drm_call(d->fd, DRM_IOCTL_MODE_SETCRTC, &crtc);
    }
    release_buffers(d);
    drm_call(d->fd, DRM_IOCTL_DROP_MASTER, NULL);
    close(d->fd);
    d->fd = -1;
    d->state = DRV_DRM_DARK;
}

static int flip_plain(const struct drv_drm *d)
{
    struct drm_mode_crtc_page_flip ask = {.crtc_id = d->crtc_id,
                                          .fb_id = d->buffer[d->front ^ 1].framebuffer,
                                          .flags = DRM_MODE_PAGE_FLIP_EVENT,
                                          .user_data = d->sequence + 1};
    return drm_call(d->fd, DRM_IOCTL_MODE_PAGE_FLIP, &ask);
}

_Static_assert(sizeof(struct lm_rectangle) == sizeof(struct drm_mode_rect),
               "left, top, right and bottom are x1, y1, x2 and y2");

/* The kernel keeps the clips for as long as it needs them. */
static int flip_clipped(const struct drv_drm *d)
{
    struct drm_mode_create_blob blob = {.data = (uint64_t)(uintptr_t)d->clip,
                                        .length = d->clips * (uint32_t)sizeof *d->clip};
    if (drm_call(d->fd, DRM_IOCTL_MODE_CREATEPROPBLOB, &blob) != 0) {
        return -1;
    }
    uint32_t plane = d->plane.id, count = 2;
    uint32_t property[2] = {d->plane.picture, d->plane.clips};
    uint64_t value[2] = {d->buffer[d->front ^ 1].framebuffer, blob.blob_id};
    struct drm_mode_atomic ask = {.flags = DRM_MODE_PAGE_FLIP_EVENT | DRM_MODE_ATOMIC_NONBLOCK,
                                  .count_objs = 1,
                                  .objs_ptr = (uint64_t)(uintptr_t)&plane,
                                  .count_props_ptr = (uint64_t)(uintptr_t)&count,
                                  .props_ptr = (uint64_t)(uintptr_t)property,
                                  .prop_values_ptr = (uint64_t)(uintptr_t)value,
                                  .user_data = d->sequence + 1};
    const int status = drm_call(d->fd, DRM_IOCTL_MODE_ATOMIC, &ask);
    const int cause = errno;
    struct drm_mode_destroy_blob done = {.blob_id = blob.blob_id};
    drm_call(d->fd, DRM_IOCTL_MODE_DESTROYPROPBLOB, &done);
    errno = cause;
    return status;
}

/* Ask the kernel for a flip, with clips where it takes them. A card that refuses clips is asked
 * without from then on. */
static int ask_flip(struct drv_drm *d)
{
    if (d->plane.id == 0 || d->clips == 0 || d->whole != 0) {
        return flip_plain(d);
    }
    if (flip_clipped(d) == 0) {
        d->count.clipped++;
        return 0;
    }
    if (errno == EBUSY) {
        return -1;
    }
    d->plane = (struct drv_drm_plane){0};
    return flip_plain(d);
}

/* Ask for the flip that is due. */
static int flip(struct drv_drm *d, uint64_t now_us)
{
    if (ask_flip(d) == 0) {
        d->whole = (uint8_t)(d->whole - (d->whole != 0));
        d->sequence++;
        d->state = DRV_DRM_FLIPPING;
        d->since_us = now_us;
        return LM_OK;
    }
    if (errno == EBUSY) {
        d->count.busy++;
        return LM_OK;
    }
    d->count.errors++;
    fail(d, "%s: the picture cannot be shown: %s", d->config.device, strerror(errno));
    darken(d, now_us);
    return LM_ERR_IO;
}

static void take_report(struct drv_drm *d, const struct drm_event_vblank *report)
{
    if (d->state != DRV_DRM_FLIPPING || report->user_data != d->sequence) {
        d->count.late++;
        return;
    }
    d->count.flips++;
    d->front ^= 1;
    d->state = DRV_DRM_IDLE;
}

static void take_reports(struct drv_drm *d)
{
    _Alignas(struct drm_event_vblank) char bytes[1024];
    const ssize_t size = read(d->fd, bytes, sizeof bytes);
    for (ssize_t at = 0; at + (ssize_t)sizeof(struct drm_event) <= size;) {
        struct drm_event_vblank report = {0};
        memcpy(&report.base, bytes + at, sizeof report.base);
        if (report.base.length < sizeof report.base || report.base.length > size - at) {
            return;
        }
        if (report.base.type == DRM_EVENT_FLIP_COMPLETE && report.base.length >= sizeof report) {
            memcpy(&report, bytes + at, sizeof report);
            take_report(d, &report);
        }
        at += report.base.length;
    }
}

/* Look once a second whether the screen is still, or again, connected. */
static void look(struct drv_drm *d, uint64_t now_us)
{
    d->look_us = now_us + DRV_DRM_LOOK_US;
    if (d->state == DRV_DRM_DARK) {
        (void)light(d);
    } else if (!drm_screen_is_there(d->fd, d->connector_id)) {
        fail(d, "%s: the screen of %s is gone", d->config.device, d->connector);
        darken(d, now_us);
    }
}

void drv_drm_service(struct drv_drm *d, uint64_t now_us)
{
    take_reports(d);
    if (d->state == DRV_DRM_DUE) {
        if (now_us - d->since_us > DRV_DRM_FLIP_US) {
            d->front ^= 1; /* setting the mode shows what could not be flipped to */
            darken(d, now_us);
            d->look_us = now_us;
        } else {
            (void)flip(d, now_us);
        }
    } else if (d->state == DRV_DRM_FLIPPING && now_us - d->since_us > DRV_DRM_FLIP_US) {
        d->count.lost++;
        d->front ^= 1;
        d->state = DRV_DRM_IDLE;
    }
    if (now_us >= d->look_us) {
        look(d, now_us);
    }
}

int drv_drm_present(struct drv_drm *d, const struct lm_surface *picture,
                    const struct lm_damage *changed, uint64_t now_us)
{
    struct drv_drm_buffer *const back = &d->buffer[d->front ^ 1];
    for (int i = 0; i < DRV_DRM_BUFFERS; i++) {
        lm_damage_add(&d->buffer[i].lacks, changed);
    }
    if (d->state == DRV_DRM_DARK) {
        return LM_OK;
    }
    if (d->state != DRV_DRM_IDLE) {
        return LM_BUSY;
    }
    drv_blit(&back->target, picture, d->config.turn, &back->lacks);
    d->clips = drv_blit_parts(&back->target, picture, d->config.turn, &back->lacks, d->clip,
                              DRV_DRM_CLIPS);
    lm_damage_clear(&back->lacks);
    d->state = DRV_DRM_DUE;
    d->since_us = now_us;
    return flip(d, now_us);
}
