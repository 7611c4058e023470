/* The part of libgpiod 2 that the driver uses, over the fake chips, and a /dev that holds them. */
#include "fake_gpio.h"

#include <dirent.h>
#include <errno.h>
#include <gpiod.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct gpiod_line_settings {
    enum gpiod_line_direction direction;
    enum gpiod_line_edge edge;
    bool active_low;
};

struct gpiod_line_config {
    unsigned int offset;
    struct gpiod_line_settings settings;
};

struct gpiod_line_request {
    struct fake_line *line;
    unsigned int offset;
};

struct gpiod_request_config {
    int unused;
};

struct gpiod_edge_event_buffer {
    int unused;
};

DIR *__wrap_opendir(const char *path);
struct dirent *__wrap_readdir(DIR *folder);
int __wrap_closedir(DIR *folder);

static const char *const files[] = {"null", "gpiochip-not-one", "gpiochip0", "gpiochip1", NULL};
static int next_file;

DIR *__wrap_opendir(const char *path)
{
    next_file = 0;
    return strcmp(path, "/dev") == 0 ? (DIR *)(void *)files : NULL;
}

struct dirent *__wrap_readdir(DIR *folder)
{
    static struct dirent entry;
    (void)folder;
    if (files[next_file] == NULL) {
        return NULL;
    }
    snprintf(entry.d_name, sizeof entry.d_name, "%s", files[next_file++]);
    return &entry;
}

int __wrap_closedir(DIR *folder)
{
    (void)folder;
    return 0;
}

static struct fake_chip *fake(const void *chip)
{
    return chip == &fake_chips[1] ? &fake_chips[1] : &fake_chips[0];
}

bool gpiod_is_gpiochip_device(const char *path)
{
    return strcmp(path, "/dev/gpiochip0") == 0 || strcmp(path, "/dev/gpiochip1") == 0;
}

struct gpiod_chip *gpiod_chip_open(const char *path)
{
    struct fake_chip *chip = &fake_chips[path[strlen(path) - 1] - '0'];
    chip->opens++;
    return (struct gpiod_chip *)(void *)chip;
}

void gpiod_chip_close(struct gpiod_chip *chip)
{
    fake(chip)->opens--;
}

struct gpiod_chip_info *gpiod_chip_get_info(struct gpiod_chip *chip)
{
    return (struct gpiod_chip_info *)(void *)chip;
}

void gpiod_chip_info_free(struct gpiod_chip_info *info)
{
    (void)info;
}

const char *gpiod_chip_info_get_name(struct gpiod_chip_info *info)
{
    return fake(info)->name;
}

const char *gpiod_chip_info_get_label(struct gpiod_chip_info *info)
{
    return fake(info)->label;
}

size_t gpiod_chip_info_get_num_lines(struct gpiod_chip_info *info)
{
    (void)info;
    return FAKE_LINES;
}

int gpiod_chip_get_line_offset_from_name(struct gpiod_chip *chip, const char *name)
{
    for (int i = 0; i < FAKE_LINES; i++) {
        const struct fake_line *line = &fake(chip)->line[i];
        if (line->name != NULL && strcmp(line->name, name) == 0) {
            return i;
        }
    }
    errno = ENOENT;
    return -1;
}

struct gpiod_line_settings *gpiod_line_settings_new(void)
{
    return calloc(1, sizeof(struct gpiod_line_settings));
}

void gpiod_line_settings_free(struct gpiod_line_settings *settings)
{
    free(settings);
}

int gpiod_line_settings_set_direction(struct gpiod_line_settings *settings,
                                      enum gpiod_line_direction direction)
{
    settings->direction = direction;
    return 0;
}

int gpiod_line_settings_set_edge_detection(struct gpiod_line_settings *settings,
                                           enum gpiod_line_edge edge)
{
    settings->edge = edge;
    return 0;
}

void gpiod_line_settings_set_active_low(struct gpiod_line_settings *settings, bool active_low)
{
    settings->active_low = active_low;
}

struct gpiod_line_config *gpiod_line_config_new(void)
{
    return calloc(1, sizeof(struct gpiod_line_config));
}

void gpiod_line_config_free(struct gpiod_line_config *config)
{
    free(config);
}

int gpiod_line_config_add_line_settings(struct gpiod_line_config *config,
                                        const unsigned int *offsets, size_t count,
                                        struct gpiod_line_settings *settings)
{
    if (count != 1) {
        errno = EINVAL;
        return -1;
    }
    config->offset = offsets[0];
    config->settings = *settings;
    return 0;
}

struct gpiod_request_config *gpiod_request_config_new(void)
{
    return calloc(1, sizeof(struct gpiod_request_config));
}

void gpiod_request_config_free(struct gpiod_request_config *config)
{
    free(config);
}

void gpiod_request_config_set_consumer(struct gpiod_request_config *config, const char *consumer)
{
    (void)config;
    (void)consumer;
}

struct gpiod_line_request *gpiod_chip_request_lines(struct gpiod_chip *chip,
                                                    struct gpiod_request_config *request,
                                                    struct gpiod_line_config *lines)
{
    (void)request;
    struct fake_line *line = &fake(chip)->line[lines->offset];
    const struct gpiod_line_settings *s = &lines->settings;
    errno = fake_gpio_request(line, s->direction == GPIOD_LINE_DIRECTION_OUTPUT, s->active_low,
                              s->edge == GPIOD_LINE_EDGE_BOTH);
    if (errno != 0) {
        return NULL;
    }
    struct gpiod_line_request *result = calloc(1, sizeof *result);
    *result = (struct gpiod_line_request){line, lines->offset};
    return result;
}

void gpiod_line_request_release(struct gpiod_line_request *request)
{
    fake_gpio_release(request->line);
    free(request);
}

enum gpiod_line_value gpiod_line_request_get_value(struct gpiod_line_request *request,
                                                   unsigned int offset)
{
    return offset == request->offset ? (enum gpiod_line_value)fake_gpio_get(request->line)
                                     : GPIOD_LINE_VALUE_ERROR;
}

int gpiod_line_request_set_value(struct gpiod_line_request *request, unsigned int offset,
                                 enum gpiod_line_value value)
{
    return offset == request->offset
               ? fake_gpio_set(request->line, value == GPIOD_LINE_VALUE_ACTIVE)
               : -1;
}

int gpiod_line_request_get_fd(struct gpiod_line_request *request)
{
    return request->line->events;
}

int gpiod_line_request_read_edge_events(struct gpiod_line_request *request,
                                        struct gpiod_edge_event_buffer *buffer, size_t count)
{
    (void)buffer;
    (void)count;
    return fake_gpio_read_events(request->line) == 0 ? 1 : -1;
}

struct gpiod_edge_event_buffer *gpiod_edge_event_buffer_new(size_t capacity)
{
    (void)capacity;
    return calloc(1, sizeof(struct gpiod_edge_event_buffer));
}

void gpiod_edge_event_buffer_free(struct gpiod_edge_event_buffer *buffer)
{
    free(buffer);
}
