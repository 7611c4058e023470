#include "fake_drm.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/types.h>

#include <drm.h>
#include <drm_mode.h>

enum { FD = 1000, CRTC = 40, ENCODER = 30, CONNECTOR = 20, CONSOLE = 99, PITCH_EXTRA = 64 };

struct fake_drm fake_drm;

int __wrap_open(const char *path, int flags, ...);
int __wrap_close(int fd);
int __wrap_ioctl(int fd, unsigned long request, ...);
ssize_t __wrap_read(int fd, void *bytes, size_t size);
void *__wrap_mmap(void *at, size_t size, int protection, int flags, int fd, off_t offset);
int __wrap_munmap(void *at, size_t size);
ssize_t __real_read(int fd, void *bytes, size_t size);
int __real_close(int fd);

void fake_drm_reset(void)
{
    for (int i = 0; i < FAKE_DRM_BUFFERS; i++) {
        free(fake_drm.buffer[i].pixels);
    }
    fake_drm = (struct fake_drm){
        .has_screen = true, .has_dumb = true, .width = 640, .height = 480, .shown = CONSOLE};
}

void fake_drm_blank(void)
{
    for (uint32_t i = 0; i < fake_drm.pending_count; i++) {
        const struct drm_event_vblank report = {
            .base = {.type = DRM_EVENT_FLIP_COMPLETE, .length = sizeof report},
            .user_data = fake_drm.pending[i].user_data,
        };
        fake_drm.shown = fake_drm.pending[i].framebuffer;
        fake_drm.handle_of_shown = fake_drm.handle_of_framebuffer[fake_drm.shown - 1];
        if (!fake_drm.is_silent) {
            memcpy(fake_drm.reports + fake_drm.report_bytes, &report, sizeof report);
            fake_drm.report_bytes += sizeof report;
        }
    }
    fake_drm.pending_count = 0;
}

int __wrap_open(const char *path, int flags, ...)
{
    (void)flags;
    if (strcmp(path, "/dev/dri/fake") == 0) {
        return FD;
    }
    errno = ENOENT;
    return -1;
}

int __wrap_close(int fd)
{
    return fd == FD ? 0 : __real_close(fd);
}

/* Never more than a few bytes more than one report, as a rude kernel might. */
ssize_t __wrap_read(int fd, void *bytes, size_t size)
{
    if (fd != FD) {
        return __real_read(fd, bytes, size);
    }
    if (fake_drm.report_bytes == 0) {
        errno = EAGAIN;
        return -1;
    }
    const size_t given = size < fake_drm.report_bytes ? size : fake_drm.report_bytes;
    memcpy(bytes, fake_drm.reports, given);
    fake_drm.report_bytes = 0;
    return (ssize_t)given;
}

void *__wrap_mmap(void *at, size_t size, int protection, int flags, int fd, off_t offset)
{
    (void)at;
    (void)protection;
    (void)flags;
    const struct fake_drm_buffer *b = &fake_drm.buffer[offset / 4096 - 1];
    return fd == FD && size <= b->size ? b->pixels : MAP_FAILED;
}

int __wrap_munmap(void *at, size_t size)
{
    (void)at;
    (void)size;
    return 0;
}

static int fail(int cause)
{
    errno = cause;
    return -1;
}

static uint32_t *list_at(uint64_t pointer)
{
    return (uint32_t *)(uintptr_t)pointer;
}

static int resources(struct drm_mode_card_res *r)
{
    if (r->count_crtcs >= 1) {
        list_at(r->crtc_id_ptr)[0] = CRTC;
    }
    if (r->count_connectors >= 1) {
        list_at(r->connector_id_ptr)[0] = CONNECTOR;
    }
    r->count_crtcs = r->count_connectors = r->count_encoders = 1;
    return 0;
}

/* The lists are filled only when they have room for all (drm_mode_getconnector). */
static int connector(struct drm_mode_get_connector *c)
{
    const uint32_t modes = fake_drm.has_screen ? fake_drm.extra_modes + 1 : 0;
    fake_drm.probes += c->count_modes == 0;
    if (c->count_modes >= modes && modes > 0) {
        struct drm_mode_modeinfo *list = (struct drm_mode_modeinfo *)(uintptr_t)c->modes_ptr;
        for (uint32_t i = 0; i < modes; i++) {
            list[i] = (struct drm_mode_modeinfo){.hdisplay = 320, .vdisplay = 200};
        }
        list[modes - 1] = (struct drm_mode_modeinfo){.hdisplay = fake_drm.width,
                                                     .vdisplay = fake_drm.height,
                                                     .type = DRM_MODE_TYPE_PREFERRED};
    }
    if (c->count_encoders >= 1) {
        list_at(c->encoders_ptr)[0] = ENCODER;
    }
    c->count_modes = modes;
    c->count_encoders = 1;
    c->connection = fake_drm.has_screen ? 1 : 2;
    c->connector_type = DRM_MODE_CONNECTOR_HDMIA;
    c->connector_type_id = 1;
    c->encoder_id = 0;
    return 0;
}

static int create(struct drm_mode_create_dumb *d)
{
    for (uint32_t i = 0; i < FAKE_DRM_BUFFERS; i++) {
        struct fake_drm_buffer *b = &fake_drm.buffer[i];
        if (b->pixels == NULL) {
            d->handle = i + 1;
            d->pitch = d->width * d->bpp / 8 + PITCH_EXTRA;
            d->size = (uint64_t)d->pitch * d->height;
            *b = (struct fake_drm_buffer){malloc(d->size), d->size, d->width, d->height, d->bpp};
            memset(b->pixels, 0xa5, d->size);
            fake_drm.live_buffers++;
            return 0;
        }
    }
    return fail(ENOMEM);
}

static int destroy(const struct drm_mode_destroy_dumb *d)
{
    free(fake_drm.buffer[d->handle - 1].pixels);
    fake_drm.buffer[d->handle - 1].pixels = NULL;
    fake_drm.live_buffers--;
    return 0;
}

static int add_framebuffer(struct drm_mode_fb_cmd *f)
{
    for (uint32_t i = 0; i < FAKE_DRM_BUFFERS; i++) {
        if (fake_drm.handle_of_framebuffer[i] == 0) {
            fake_drm.handle_of_framebuffer[i] = f->handle;
            f->fb_id = i + 1;
            fake_drm.live_framebuffers++;
            return 0;
        }
    }
    return fail(ENOMEM);
}

static int remove_framebuffer(const uint32_t *id)
{
    fake_drm.handle_of_framebuffer[*id - 1] = 0;
    fake_drm.live_framebuffers--;
    return 0;
}

static int set_mode(const struct drm_mode_crtc *c)
{
    if (fake_drm.is_foreign || c->crtc_id != CRTC) {
        return fail(EACCES);
    }
    fake_drm.modes_set++;
    fake_drm.shown = c->fb_id;
    fake_drm.handle_of_shown =
        c->fb_id == CONSOLE ? 0 : fake_drm.handle_of_framebuffer[c->fb_id - 1];
    fake_drm.pending_count = 0;
    return 0;
}

static int flip(const struct drm_mode_crtc_page_flip *f)
{
    if (fake_drm.flip_errno != 0) {
        return fail(fake_drm.flip_errno);
    }
    if (fake_drm.pending_count > 0 && !fake_drm.is_silent) {
        return fail(EBUSY);
    }
    fake_drm.flips++;
    fake_drm.pending[fake_drm.pending_count].user_data = f->user_data;
    fake_drm.pending[fake_drm.pending_count++].framebuffer = f->fb_id;
    return 0;
}

static int current_mode(struct drm_mode_crtc *c)
{
    c->fb_id = CONSOLE;
    c->mode_valid = 1;
    return 0;
}

int __wrap_ioctl(int fd, unsigned long request, ...)
{
    va_list arguments;
    va_start(arguments, request);
    void *p = va_arg(arguments, void *);
    va_end(arguments);
    if (fd != FD) {
        return fail(EBADF);
    }
    if (fake_drm.interrupts > 0) {
        fake_drm.interrupts--;
        return fail(EINTR);
    }
    switch (request) {
    case DRM_IOCTL_GET_CAP:
        ((struct drm_get_cap *)p)->value = fake_drm.has_dumb;
        return 0;
    case DRM_IOCTL_MODE_GETRESOURCES:
        return resources(p);
    case DRM_IOCTL_MODE_GETCONNECTOR:
        return connector(p);
    case DRM_IOCTL_MODE_GETENCODER:
        ((struct drm_mode_get_encoder *)p)->crtc_id = 0;
        ((struct drm_mode_get_encoder *)p)->possible_crtcs = 1;
        return 0;
    case DRM_IOCTL_MODE_CREATE_DUMB:
        return create(p);
    case DRM_IOCTL_MODE_DESTROY_DUMB:
        return destroy(p);
    case DRM_IOCTL_MODE_MAP_DUMB:
        ((struct drm_mode_map_dumb *)p)->offset = 4096u * ((struct drm_mode_map_dumb *)p)->handle;
        return 0;
    case DRM_IOCTL_MODE_ADDFB:
        return add_framebuffer(p);
    case DRM_IOCTL_MODE_RMFB:
        return remove_framebuffer(p);
    case DRM_IOCTL_MODE_GETCRTC:
        return current_mode(p);
    case DRM_IOCTL_MODE_SETCRTC:
        return set_mode(p);
    case DRM_IOCTL_MODE_PAGE_FLIP:
        return flip(p);
    case DRM_IOCTL_SET_MASTER:
        fake_drm.masters++;
        return 0;
    case DRM_IOCTL_DROP_MASTER:
        return 0;
    default:
        return fail(ENOTTY);
    }
}
