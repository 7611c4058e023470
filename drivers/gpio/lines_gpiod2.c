/* Lines through libgpiod 2 (Debian 13). */
#include "lines.h"

#include <dirent.h>
#include <errno.h>
#include <gpiod.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EVENTS_AT_ONCE = 16 };

struct line {
    struct gpiod_chip *chip;
    struct gpiod_line_request *request;
    struct gpiod_edge_event_buffer *events; /* NULL for an output */
    unsigned offset;
};

/* The offset of the line on this chip, or -1: by its name, or, when `label` is not NULL, by the
 * chip's. */
static int offset_on(struct gpiod_chip *chip, const char *name, const char *label, unsigned offset)
{
    const int found = gpiod_chip_get_line_offset_from_name(chip, name);
    struct gpiod_chip_info *info = found < 0 && label != NULL ? gpiod_chip_get_info(chip) : NULL;
    if (info == NULL) {
        return found;
    }
    const bool is_it = (strcmp(gpiod_chip_info_get_label(info), label) == 0 ||
                        strcmp(gpiod_chip_info_get_name(info), label) == 0) &&
                       offset < gpiod_chip_info_get_num_lines(info);
    gpiod_chip_info_free(info);
    return is_it ? (int)offset : -1;
}

static struct gpiod_chip *try_chip(const char *file, const char *name, const char *label,
                                   unsigned *offset)
{
    char path[280];
    snprintf(path, sizeof path, "/dev/%s", file);
    if (strncmp(file, "gpiochip", 8) != 0 || !gpiod_is_gpiochip_device(path)) {
        return NULL;
    }
    struct gpiod_chip *chip = gpiod_chip_open(path);
    const int found = chip != NULL ? offset_on(chip, name, label, *offset) : -1;
    if (found < 0) {
        if (chip != NULL) {
            gpiod_chip_close(chip);
        }
        return NULL;
    }
    *offset = (unsigned)found;
    return chip;
}

/* Version 2 looks for nothing by itself. */
static struct gpiod_chip *find(const char *name, unsigned *offset)
{
    char label[64];
    const bool has_label = gpio_split_name(name, label, sizeof label, offset);
    struct gpiod_chip *chip = NULL;
    DIR *folder = opendir("/dev");
    for (struct dirent *entry; chip == NULL && folder != NULL && (entry = readdir(folder));) {
        chip = try_chip(entry->d_name, name, has_label ? label : NULL, offset);
    }
    if (folder != NULL) {
        closedir(folder);
    }
    return chip;
}

static struct gpiod_line_request *request(struct gpiod_chip *chip, unsigned offset, bool is_output,
                                          bool is_active_low, bool has_edges)
{
    struct gpiod_line_settings *settings = gpiod_line_settings_new();
    struct gpiod_line_config *lines = gpiod_line_config_new();
    struct gpiod_request_config *config = gpiod_request_config_new();
    struct gpiod_line_request *result = NULL;
    if (settings != NULL && lines != NULL && config != NULL) {
        gpiod_request_config_set_consumer(config, "landmass-panel");
        gpiod_line_settings_set_direction(settings, is_output ? GPIOD_LINE_DIRECTION_OUTPUT
                                                              : GPIOD_LINE_DIRECTION_INPUT);
        gpiod_line_settings_set_active_low(settings, is_active_low);
        if (has_edges) {
            gpiod_line_settings_set_edge_detection(settings, GPIOD_LINE_EDGE_BOTH);
        }
        if (gpiod_line_config_add_line_settings(lines, &offset, 1, settings) == 0) {
            result = gpiod_chip_request_lines(chip, config, lines);
        }
    }
    const int cause = errno;
    gpiod_request_config_free(config);
    gpiod_line_config_free(lines);
    gpiod_line_settings_free(settings);
    errno = cause;
    return result;
}

static void release(struct line *line)
{
    if (line->events != NULL) {
        gpiod_edge_event_buffer_free(line->events);
    }
    if (line->request != NULL) {
        gpiod_line_request_release(line->request);
    }
    gpiod_chip_close(line->chip);
    free(line);
}

/* NULL with errno. */
static struct line *make(struct gpiod_chip *chip, unsigned offset, bool is_output,
                         bool is_active_low)
{
    struct line *line = calloc(1, sizeof *line);
    if (line == NULL) {
        gpiod_chip_close(chip);
        return NULL;
    }
    line->chip = chip;
    line->offset = offset;
    line->events = is_output ? NULL : gpiod_edge_event_buffer_new(EVENTS_AT_ONCE);
    if (line->events != NULL) {
        line->request = request(chip, offset, false, is_active_low, true);
        if (line->request == NULL) { /* no interrupt: had without */
            gpiod_edge_event_buffer_free(line->events);
            line->events = NULL;
        }
    }
    if (line->request == NULL) {
        line->request = request(chip, offset, is_output, is_active_low, false);
    }
    if (line->request == NULL) {
        const int cause = errno;
        release(line);
        errno = cause;
        return NULL;
    }
    return line;
}

const char *gpio_line_open(struct drv_gpio_line *l, const char *name, bool is_output,
                           bool is_active_low)
{
    unsigned offset;
    struct gpiod_chip *chip = find(name, &offset);
    if (chip == NULL) {
        return "no chip has a line of this name; gpioinfo lists those there are";
    }
    struct line *line = make(chip, offset, is_output, is_active_low);
    if (line == NULL) {
        return strerror(errno);
    }
    l->handle = line;
    l->fd = line->events != NULL ? gpiod_line_request_get_fd(line->request) : -1;
    return NULL;
}

void gpio_line_close(struct drv_gpio_line *l)
{
    release(l->handle);
    *l = (struct drv_gpio_line){.fd = -1};
}

int gpio_line_get(const struct drv_gpio_line *l)
{
    const struct line *line = l->handle;
    return gpiod_line_request_get_value(line->request, line->offset);
}

int gpio_line_set(const struct drv_gpio_line *l, bool is_active)
{
    const struct line *line = l->handle;
    return gpiod_line_request_set_value(line->request, line->offset,
                                        is_active ? GPIOD_LINE_VALUE_ACTIVE
                                                  : GPIOD_LINE_VALUE_INACTIVE);
}

void gpio_line_forget_events(const struct drv_gpio_line *l)
{
    const struct line *line = l->handle;
    (void)gpiod_line_request_read_edge_events(line->request, line->events, EVENTS_AT_ONCE);
}
