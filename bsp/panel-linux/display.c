#include "display.h"

#include "report.h"

#include <stdlib.h>

enum { RETRY_US = 1000000, PICTURE_MIN_PX = 256, PICTURE_MAX_PX = 1024, PICTURE_UNKNOWN_PX = 768 };

static struct drv_drm_config drm_config(const struct config *c)
{
    return (struct drv_drm_config){
        .device = c->glass_card,
        .connector = c->glass_connector[0] != '\0' ? c->glass_connector : NULL,
        .width_px = c->glass_mode.width_px,
        .height_px = c->glass_mode.height_px,
        .format = (enum drv_format)c->glass_format,
        .turn = (enum drv_turn)c->glass_turn,
    };
}

static bool try_drm(struct glass *g, uint64_t now_us)
{
    const struct drv_drm_config config = drm_config(g->config);
    if (drv_drm_open(&g->drm, &config, now_us) != LM_OK) {
        return false;
    }
    g->kind = GLASS_DRM;
    return true;
}

static bool try_fbdev(struct glass *g)
{
    if (drv_fbdev_open(&g->fbdev, g->config->glass_framebuffer,
                       (enum drv_turn)g->config->glass_turn) != LM_OK) {
        return false;
    }
    g->kind = GLASS_FBDEV;
    return true;
}

/* DRM first: it shows whole pictures only. */
static void find_device(struct glass *g, uint64_t now_us)
{
    const uint32_t wanted = g->config->glass;
    const bool may_drm = wanted == CONFIG_GLASS_AUTO || wanted == CONFIG_GLASS_DRM;
    const bool may_fbdev = wanted == CONFIG_GLASS_AUTO || wanted == CONFIG_GLASS_FBDEV;
    g->retry_us = now_us + RETRY_US;
    if (!(may_drm && try_drm(g, now_us)) && may_fbdev) {
        (void)try_fbdev(g);
    }
}

static const char *glass_error(const struct glass *g)
{
    const bool is_fbdev = g->kind == GLASS_FBDEV || g->config->glass == CONFIG_GLASS_FBDEV;
    return is_fbdev ? g->fbdev.error : g->drm.error;
}

static struct config_size screen_size(const struct glass *g)
{
    if (g->kind == GLASS_DRM) {
        return (struct config_size){g->drm.width_px, g->drm.height_px};
    }
    if (g->kind == GLASS_FBDEV) {
        return (struct config_size){g->fbdev.target.width_px, g->fbdev.target.height_px};
    }
    return (struct config_size){0, 0};
}

static void report_state(const struct glass *g)
{
    const struct config_size s = screen_size(g);
    if (!glass_is_lit(g)) {
        report(REPORT_ERROR, "glass: %s; it is looked for once a second", glass_error(g));
    } else {
        report(REPORT_NOTICE, "glass: %s%s, %ux%u, picture of %ux%u",
               g->kind == GLASS_DRM ? "DRM connector " : "frame buffer",
               g->kind == GLASS_DRM ? g->drm.connector : "", s.width_px, s.height_px,
               g->picture.width_px, g->picture.height_px);
    }
}

static struct config_size choose_picture(const struct glass *g)
{
    if (g->config->glass_picture.width_px != 0) {
        return g->config->glass_picture;
    }
    const struct config_size s = screen_size(g);
    uint16_t side = s.width_px < s.height_px ? s.width_px : s.height_px;
    side = side == 0 ? PICTURE_UNKNOWN_PX : side < PICTURE_MIN_PX ? PICTURE_MIN_PX : side;
    side = side > PICTURE_MAX_PX ? PICTURE_MAX_PX : side;
    return (struct config_size){side, side};
}

static int acquire(void *ctx, struct lm_surface *surface)
{
    const struct glass *g = ctx;
    if (g->kind == GLASS_DRM && (g->drm.state == DRV_DRM_DUE || g->drm.state == DRV_DRM_FLIPPING)) {
        return LM_BUSY;
    }
    *surface = g->picture;
    surface->age = g->count.pictures > 0; /* one buffer, which the devices copy */
    return LM_OK;
}

static int present(void *ctx, const struct lm_damage *changed)
{
    struct glass *g = ctx;
    const bool is_dark = g->kind != GLASS_DRM || g->drm.state == DRV_DRM_DARK;
    int status = LM_OK;
    g->count.pictures++;
    if (g->kind == GLASS_DRM) {
        status = drv_drm_present(&g->drm, &g->picture, changed, g->now_us);
    } else if (g->kind == GLASS_FBDEV) {
        status = drv_fbdev_present(&g->fbdev, &g->picture);
    }
    if (!is_dark) {
        return status; /* a flip counts when it is done */
    }
    g->count.renders += status == LM_OK;
    return status;
}

int glass_open(struct glass *g, const struct config *config, uint64_t now_us)
{
    *g = (struct glass){.config = config, .drm.fd = -1, .fbdev.fd = -1};
    find_device(g, now_us);
    const struct config_size size = choose_picture(g);
    g->picture = (struct lm_surface){
        .pixels = calloc((size_t)size.width_px * size.height_px, sizeof *g->picture.pixels),
        .stride_px = size.width_px,
        .width_px = size.width_px,
        .height_px = size.height_px};
    if (g->picture.pixels == NULL) {
        glass_close(g);
        return -1;
    }
    g->port = (struct lm_display){.ctx = g,
                                  .width_px = size.width_px,
                                  .height_px = size.height_px,
                                  .acquire = acquire,
                                  .present = present};
    g->was_lit = glass_is_lit(g);
    if (config->glass != CONFIG_GLASS_NONE) {
        report_state(g);
    }
    return 0;
}

void glass_close(struct glass *g)
{
    drv_drm_close(&g->drm);
    drv_fbdev_close(&g->fbdev);
    free(g->picture.pixels);
    g->picture.pixels = NULL;
    g->kind = GLASS_NONE;
}

void glass_service(struct glass *g, uint64_t now_us)
{
    g->now_us = now_us;
    if (g->kind == GLASS_DRM) {
        drv_drm_service(&g->drm, now_us);
    } else if (g->kind == GLASS_NONE && g->config->glass != CONFIG_GLASS_NONE &&
               now_us >= g->retry_us) {
        find_device(g, now_us);
    }
    if (glass_is_lit(g) != g->was_lit) {
        g->was_lit = !g->was_lit;
        report_state(g);
    }
}

int glass_fd(const struct glass *g)
{
    return g->kind == GLASS_DRM ? g->drm.fd : -1;
}

bool glass_is_lit(const struct glass *g)
{
    return g->kind == GLASS_FBDEV || (g->kind == GLASS_DRM && g->drm.state != DRV_DRM_DARK);
}

uint32_t glass_renders(const struct glass *g)
{
    return g->count.renders + g->drm.count.flips;
}
