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
enum { CURSOR = 50, PLANE = 51, TYPE = 60, PICTURE = 61, CLIPS = 62, BLOB = 70 };
enum { TYPE_PRIMARY = 1, TYPE_CURSOR = 2 }; /* of planes */

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

/* Copy the clips of a buffer, or all of it, to what the cards show. */
static void copy_clips(uint32_t handle, const struct fake_drm_clips *clips)
{
    const struct fake_drm_buffer *b = &fake_drm.buffer[handle - 1];
    const uint32_t row_words = (uint32_t)(b->size / b->height / sizeof *b->pixels);
    const int32_t all[4] = {0, 0, (int32_t)b->width, (int32_t)b->height};
    for (uint32_t n = 0; n < (clips->count ? clips->count : 1) && b->bpp == 32; n++) {
        const int32_t *r = clips->count ? clips->rectangle[n] : all;
        for (int32_t y = r[1]; y < r[3]; y++) {
            for (int32_t x = r[0]; x < r[2]; x++) {
                const uint32_t at = (uint32_t)y * row_words + (uint32_t)x;
                fake_drm.screen[at] = fake_drm.copy[handle - 1][at] = b->pixels[at];
                fake_drm.copied_px += clips->count != 0;
            }
        }
    }
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
        copy_clips(fake_drm.handle_of_shown, &fake_drm.pending[i].clips);
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
    if (fake_drm.handle_of_shown != 0) {
        copy_clips(fake_drm.handle_of_shown, &(struct fake_drm_clips){.count = 0});
    }
    return 0;
}

static int take_flip(uint32_t framebuffer, uint64_t user_data, const struct fake_drm_clips *clips)
{
    if (fake_drm.pending_count > 0 && !fake_drm.is_silent) {
        return fail(EBUSY);
    }
    fake_drm.flips++;
    fake_drm.pending[fake_drm.pending_count].user_data = user_data;
    fake_drm.pending[fake_drm.pending_count].clips = *clips;
    fake_drm.pending[fake_drm.pending_count++].framebuffer = framebuffer;
    return 0;
}

static int flip(const struct drm_mode_crtc_page_flip *f)
{
    if (fake_drm.flip_errno != 0) {
        return fail(fake_drm.flip_errno);
    }
    return take_flip(f->fb_id, f->user_data, &(struct fake_drm_clips){.count = 0});
}

/* As drm_mode_atomic: of one plane, its picture and its clips. */
static int flip_atomic(const struct drm_mode_atomic *a)
{
    const uint32_t *property = list_at(a->props_ptr);
    const uint64_t *value = (const uint64_t *)(uintptr_t)a->prop_values_ptr;
    if (fake_drm.atomic_errno != 0) {
        return fail(fake_drm.atomic_errno);
    }
    if (!fake_drm.takes_clips || a->count_objs != 1 || list_at(a->objs_ptr)[0] != PLANE ||
        list_at(a->count_props_ptr)[0] != 2 || property[0] != PICTURE || property[1] != CLIPS ||
        value[1] != BLOB || a->flags != (DRM_MODE_PAGE_FLIP_EVENT | DRM_MODE_ATOMIC_NONBLOCK)) {
        return fail(EINVAL);
    }
    return take_flip((uint32_t)value[0], a->user_data, &fake_drm.blob);
}

/* Clips that do not lie in the picture are refused, as the kernel does. */
static int make_blob(struct drm_mode_create_blob *b)
{
    const size_t each = sizeof fake_drm.blob.rectangle[0];
    if (b->length == 0 || b->length % each != 0 || b->length / each > FAKE_DRM_CLIPS) {
        return fail(EINVAL);
    }
    memcpy(fake_drm.blob.rectangle, list_at(b->data), b->length);
    fake_drm.blob.count = (uint32_t)(b->length / each);
    for (uint32_t n = 0; n < fake_drm.blob.count; n++) {
        const int32_t *r = fake_drm.blob.rectangle[n];
        if (r[0] < 0 || r[1] < 0 || r[0] >= r[2] || r[1] >= r[3] || r[2] > fake_drm.width ||
            r[3] > fake_drm.height) {
            return fail(EINVAL);
        }
    }
    fake_drm.live_blobs++;
    b->blob_id = BLOB;
    return 0;
}

static int planes(struct drm_mode_get_plane_res *r)
{
    if (r->count_planes >= 2) {
        list_at(r->plane_id_ptr)[0] = CURSOR;
        list_at(r->plane_id_ptr)[1] = PLANE;
    }
    r->count_planes = 2;
    return 0;
}

static int properties(struct drm_mode_obj_get_properties *o)
{
    static const uint32_t ids[] = {PICTURE, CLIPS, TYPE};
    const bool is_cursor = o->obj_id == CURSOR;
    const uint64_t type = is_cursor ? TYPE_CURSOR : TYPE_PRIMARY;
    if (o->count_props >= 3) {
        memcpy(list_at(o->props_ptr), ids, sizeof ids);
        memcpy(list_at(o->prop_values_ptr), (uint64_t[]){0, 0, type}, 3 * sizeof type);
    }
    o->count_props = 3;
    return 0;
}

static int property(struct drm_mode_get_property *p)
{
    strcpy(p->name, p->prop_id == PICTURE  ? "FB_ID"
                    : p->prop_id == TYPE   ? "type"
                    : fake_drm.takes_clips ? "FB_DAMAGE_CLIPS"
                                           : "rotation");
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
    case DRM_IOCTL_SET_CLIENT_CAP:
        return 0;
    case DRM_IOCTL_MODE_GETPLANERESOURCES:
        return planes(p);
    case DRM_IOCTL_MODE_GETPLANE:
        ((struct drm_mode_get_plane *)p)->crtc_id = CRTC;
        return 0;
    case DRM_IOCTL_MODE_OBJ_GETPROPERTIES:
        return properties(p);
    case DRM_IOCTL_MODE_GETPROPERTY:
        return property(p);
    case DRM_IOCTL_MODE_CREATEPROPBLOB:
        return make_blob(p);
    case DRM_IOCTL_MODE_DESTROYPROPBLOB:
        fake_drm.live_blobs--;
        return 0;
    case DRM_IOCTL_MODE_ATOMIC:
        return flip_atomic(p);
    case DRM_IOCTL_SET_MASTER:
        fake_drm.masters++;
        return 0;
    case DRM_IOCTL_DROP_MASTER:
        return 0;
    default:
        return fail(ENOTTY);
    }
}
