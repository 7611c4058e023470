#include "drm_screen.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>

/* More than any card has; what is beyond is not looked at. */
enum { OBJECTS_MAX = 32, PROPERTIES_MAX = 64, MODES_MAX = 128, CALLS_MAX = 100 };
enum { IS_CONNECTED = 1, IS_PRIMARY = 1 };

struct connector {
    struct drm_mode_get_connector is;
    uint32_t encoders[OBJECTS_MAX];
    struct drm_mode_modeinfo modes[MODES_MAX];
};

int drm_call(int fd, unsigned long request, void *argument)
{
    int status = -1;
    for (int i = 0; i < CALLS_MAX; i++) {
        status = ioctl(fd, request, argument);
        if (status == 0 || (errno != EINTR && errno != EAGAIN)) {
            break;
        }
    }
    return status;
}

static uint64_t address(const void *p)
{
    return (uint64_t)(uintptr_t)p;
}

static uint32_t at_most(uint32_t count, uint32_t limit)
{
    return count < limit ? count : limit;
}

/* The kernel's names, as they are under /sys/class/drm. */
static const char *type_name(uint32_t type)
{
    static const char *const names[] = {
        "Unknown", "VGA",       "DVI-I", "DVI-D", "DVI-A",     "Composite", "SVIDEO",
        "LVDS",    "Component", "DIN",   "DP",    "HDMI-A",    "HDMI-B",    "TV",
        "eDP",     "Virtual",   "DSI",   "DPI",   "Writeback", "SPI",       "USB",
    };
    return names[type < sizeof names / sizeof names[0] ? type : 0];
}

/* With room for modes on the first call the kernel would answer from memory: it is asked with none,
 * which makes it look. */
static bool read_connector(int fd, uint32_t id, struct connector *c)
{
    c->is = (struct drm_mode_get_connector){.connector_id = id};
    if (drm_call(fd, DRM_IOCTL_MODE_GETCONNECTOR, &c->is) != 0) {
        return false;
    }
    const uint32_t modes = at_most(c->is.count_modes, MODES_MAX);
    const uint32_t encoders = at_most(c->is.count_encoders, OBJECTS_MAX);
    c->is = (struct drm_mode_get_connector){.connector_id = id,
                                            .modes_ptr = address(c->modes),
                                            .encoders_ptr = address(c->encoders),
                                            .count_modes = modes,
                                            .count_encoders = encoders};
    if (modes == 0 || drm_call(fd, DRM_IOCTL_MODE_GETCONNECTOR, &c->is) != 0) {
        return false;
    }
    /* A screen that was exchanged between the calls has filled neither list. */
    return c->is.count_modes <= modes && c->is.count_encoders <= encoders && c->is.count_modes > 0;
}

bool drm_screen_is_there(int fd, uint32_t connector_id)
{
    struct drm_mode_modeinfo mode;
    struct drm_mode_get_connector c = {
        .connector_id = connector_id, .modes_ptr = address(&mode), .count_modes = 1};
    return drm_call(fd, DRM_IOCTL_MODE_GETCONNECTOR, &c) == 0 && c.connection == IS_CONNECTED;
}

/* The mode asked for, or the one that the screen prefers, or its first. */
static const struct drm_mode_modeinfo *choose_mode(const struct connector *c,
                                                   const struct drv_drm_config *config)
{
    const struct drm_mode_modeinfo *preferred = NULL;
    for (uint32_t i = 0; i < c->is.count_modes; i++) {
        const struct drm_mode_modeinfo *m = &c->modes[i];
        if (config->width_px != 0 && m->hdisplay == config->width_px &&
            m->vdisplay == config->height_px) {
            return m;
        }
        if (preferred == NULL && (m->type & DRM_MODE_TYPE_PREFERRED) != 0) {
            preferred = m;
        }
    }
    if (config->width_px != 0) {
        return NULL;
    }
    return preferred != NULL ? preferred : &c->modes[0];
}

/* The controller that drives the connector now, or the first that can. 0: none. */
static uint32_t choose_crtc(int fd, const struct connector *c, const uint32_t *crtcs,
                            uint32_t crtc_count)
{
    struct drm_mode_get_encoder e = {.encoder_id = c->is.encoder_id};
    if (e.encoder_id != 0 && drm_call(fd, DRM_IOCTL_MODE_GETENCODER, &e) == 0 && e.crtc_id != 0) {
        return e.crtc_id;
    }
    for (uint32_t i = 0; i < c->is.count_encoders; i++) {
        e = (struct drm_mode_get_encoder){.encoder_id = c->encoders[i]};
        if (drm_call(fd, DRM_IOCTL_MODE_GETENCODER, &e) != 0) {
            continue;
        }
        for (uint32_t k = 0; k < crtc_count; k++) {
            if ((e.possible_crtcs >> k & 1) != 0) {
                return crtcs[k];
            }
        }
    }
    return 0;
}

/* NULL, or why this connector will not do. */
static const char *try_connector(int fd, uint32_t id, const struct drv_drm_config *config,
                                 const uint32_t *crtcs, uint32_t crtc_count, struct drm_screen *s)
{
    struct connector c;
    if (!read_connector(fd, id, &c) || c.is.connection != IS_CONNECTED) {
        return "no screen is connected";
    }
    *s = (struct drm_screen){.connector_id = id};
    snprintf(s->name, sizeof s->name, "%s-%u", type_name(c.is.connector_type),
             c.is.connector_type_id);
    if (config->connector != NULL && strcmp(config->connector, s->name) != 0) {
        return "no screen is connected to the connector asked for";
    }
    const struct drm_mode_modeinfo *mode = choose_mode(&c, config);
    if (mode == NULL) {
        return "the screen does not have the mode asked for";
    }
    s->mode = *mode;
    s->crtc_id = choose_crtc(fd, &c, crtcs, crtc_count);
    return s->crtc_id != 0 ? NULL : "the card has no controller for the screen";
}

const char *drm_screen_find(int fd, const struct drv_drm_config *config, struct drm_screen *screen)
{
    uint32_t crtcs[OBJECTS_MAX], connectors[OBJECTS_MAX];
    struct drm_mode_card_res card = {.crtc_id_ptr = address(crtcs),
                                     .connector_id_ptr = address(connectors),
                                     .count_crtcs = OBJECTS_MAX,
                                     .count_connectors = OBJECTS_MAX};
    if (drm_call(fd, DRM_IOCTL_MODE_GETRESOURCES, &card) != 0) {
        return "the device drives no screens";
    }
    const char *cause = "the card has no connector";
    for (uint32_t i = 0; i < at_most(card.count_connectors, OBJECTS_MAX); i++) {
        const char *why = try_connector(fd, connectors[i], config, crtcs,
                                        at_most(card.count_crtcs, OBJECTS_MAX), screen);
        if (why == NULL) {
            return NULL;
        }
        cause = why;
    }
    return cause;
}

/* The number of a plane's property, and its value; 0 if there is none of that name. */
static uint32_t find_property(int fd, const struct drm_mode_obj_get_properties *of,
                              const char *name, uint64_t *value)
{
    const uint32_t *ids = (const uint32_t *)(uintptr_t)of->props_ptr;
    const uint64_t *values = (const uint64_t *)(uintptr_t)of->prop_values_ptr;
    for (uint32_t i = 0; i < at_most(of->count_props, PROPERTIES_MAX); i++) {
        struct drm_mode_get_property p = {.prop_id = ids[i]};
        if (drm_call(fd, DRM_IOCTL_MODE_GETPROPERTY, &p) == 0 &&
            strncmp(p.name, name, sizeof p.name) == 0) {
            *value = values[i];
            return ids[i];
        }
    }
    return 0;
}

/* True if that plane shows the controller's picture and takes clips. */
static bool try_plane(int fd, uint32_t crtc_id, uint32_t id, struct drv_drm_plane *plane)
{
    uint32_t ids[PROPERTIES_MAX];
    uint64_t values[PROPERTIES_MAX], type = 0, other;
    struct drm_mode_get_plane p = {.plane_id = id};
    struct drm_mode_obj_get_properties of = {.props_ptr = address(ids),
                                             .prop_values_ptr = address(values),
                                             .count_props = PROPERTIES_MAX,
                                             .obj_id = id,
                                             .obj_type = DRM_MODE_OBJECT_PLANE};
    if (drm_call(fd, DRM_IOCTL_MODE_GETPLANE, &p) != 0 || p.crtc_id != crtc_id ||
        drm_call(fd, DRM_IOCTL_MODE_OBJ_GETPROPERTIES, &of) != 0 ||
        of.count_props > PROPERTIES_MAX || find_property(fd, &of, "type", &type) == 0 ||
        type != IS_PRIMARY) {
        return false;
    }
    *plane = (struct drv_drm_plane){id, find_property(fd, &of, "FB_ID", &other),
                                    find_property(fd, &of, "FB_DAMAGE_CLIPS", &other)};
    return plane->picture != 0 && plane->clips != 0;
}

void drm_screen_find_plane(int fd, uint32_t crtc_id, struct drv_drm_plane *plane)
{
    uint32_t planes[OBJECTS_MAX];
    struct drm_set_client_cap ask = {.capability = DRM_CLIENT_CAP_ATOMIC, .value = 1};
    struct drm_mode_get_plane_res card = {.plane_id_ptr = address(planes),
                                          .count_planes = OBJECTS_MAX};
    bool is_found = false;
    if (drm_call(fd, DRM_IOCTL_SET_CLIENT_CAP, &ask) == 0 &&
        drm_call(fd, DRM_IOCTL_MODE_GETPLANERESOURCES, &card) == 0) {
        for (uint32_t i = 0; i < at_most(card.count_planes, OBJECTS_MAX) && !is_found; i++) {
            is_found = try_plane(fd, crtc_id, planes[i], plane);
        }
    }
    if (!is_found) {
        *plane = (struct drv_drm_plane){0};
    }
}
