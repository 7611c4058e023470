/* Configuration of the panel: one text file of "option = value" lines. Each option is described
 * once, in the table of config_table.h. The help, the delivered file and the checks come from that
 * table or are compared with it. */
#ifndef PANEL_CONFIG_H
#define PANEL_CONFIG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "drv/blit.h"
#include "drv/stick.h"
#include "lm/bus_event.h"
#include "lm/bus_profile.h"
#include "lm/controls.h"

enum {
    CONFIG_FILE_BYTES = 64 << 10, /* a longer file is refused */
    CONFIG_PATH = 128,
    CONFIG_NAME = 64
};

/* Inputs of the bezel: the buttons 1..LM_BUTTONS, then these. */
enum { CONFIG_KEY_DESIGNATE = LM_BUTTONS, CONFIG_KEY_DROP, CONFIG_KEYS };
enum { CONFIG_LED_ALIVE, CONFIG_LED_FAULT, CONFIG_LED_NIGHT, CONFIG_LEDS };
enum config_glass { CONFIG_GLASS_AUTO, CONFIG_GLASS_DRM, CONFIG_GLASS_FBDEV, CONFIG_GLASS_NONE };

struct config_size {
    uint16_t width_px, height_px; /* 0, 0: not chosen */
};

/* Nodes of the bus that are heard. */
struct config_nodes {
    bool is_list; /* false: all */
    uint8_t bits[LM_BUS_NODE_BYTES];
};

/* Hand controller: the USB device to use. */
struct config_stick {
    enum { CONFIG_STICK_NONE, CONFIG_STICK_AUTO, CONFIG_STICK_NAMED } choice;
    uint16_t vendor, product;
    char serial[CONFIG_NAME]; /* empty: any */
};

/* Values of the options. An empty name means none, or the driver's choice. */
struct config {
    char slot_a[CONFIG_PATH], slot_b[CONFIG_PATH], slot_progress[CONFIG_PATH];
    char database[CONFIG_PATH];
    char further[LM_IMAGES_MAX - 1][CONFIG_PATH]; /* images beside it */
    char database_key[CONFIG_PATH], database_serial[CONFIG_PATH];
    uint32_t database_trust; /* 1: any */
    uint32_t database_older; /* 1: fly */
    char radar[CONFIG_PATH];
    char can[CONFIG_NAME];
    const struct lm_bus_profile *can_profile; /* NULL: can_table, the database's, or canas17 */
    char can_table[CONFIG_PATH];
    char can_2[CONFIG_NAME];                    /* a second interface */
    const struct lm_bus_profile *can_2_profile; /* NULL: can_2_table, or canas17 */
    char can_2_table[CONFIG_PATH];
    struct config_nodes can_nodes;
    uint32_t can_node;
    uint32_t can_partner; /* 0: there is none */
    uint32_t can_heading; /* 1: magnetic */
    uint32_t can_reports; /* 1: on */
    char settings[128];
    char faults[CONFIG_PATH];
    uint32_t can_controls; /* 1: obey */
    uint32_t seed;
    uint32_t tiles;

    uint32_t glass; /* enum config_glass */
    char glass_card[CONFIG_PATH], glass_framebuffer[CONFIG_PATH], glass_connector[CONFIG_NAME];
    struct config_size glass_mode, glass_picture;
    uint32_t glass_turn;                                 /* enum drv_turn */
    uint32_t glass_format;                               /* enum drv_format */
    uint32_t glass_sector;                               /* 1: whole */
    uint32_t glass_heading, glass_strobe, glass_borders; /* 1: on */

    char key[CONFIG_KEYS][CONFIG_NAME]; /* names of lines; [0] is button 1 */
    uint32_t key_active_low;
    uint32_t debounce_ms;
    char led[CONFIG_LEDS][CONFIG_NAME];
    uint32_t led_active_low;
    char backlight[CONFIG_NAME];
    uint32_t backlight_day, backlight_night; /* per cent */

    struct config_stick stick;
    struct drv_stick_config stick_map;

    char record[CONFIG_PATH];
    uint32_t record_size_mib;

    uint32_t priority;
    uint32_t locks_memory;
    char watchdog[CONFIG_PATH];
    uint32_t watchdog_s;
};

/* Set every option to its default. */
void config_defaults(struct config *c);

/* Receiver of a report on each wrong line; lines count from 1. Its option keeps its value. */
typedef void config_report(void *ctx, uint32_t line, const char *cause);

/* Read a whole file into *c. An option that it does not name keeps its value; an option may be
 * given once. Returns the number of wrong lines. Pure. Any bytes are safe; no zero is needed at the
 * end. */
uint32_t config_read(struct config *c, const char *text, size_t size, config_report *report,
                     void *ctx);

/* Option: a row of the table, for help and checks. Its strings are in static memory. */
struct config_option {
    const char *name;
    const char *values;  /* accepted values: "0..90", "auto | drm | fbdev | none" */
    const char *initial; /* default, as written in a file */
    const char *help;
};

uint32_t config_option_count(void);
struct config_option config_option_at(uint32_t index);

#endif
