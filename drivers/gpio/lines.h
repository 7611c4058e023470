/* One line of a GPIO chip, by either version of libgpiod. Private to the GPIO driver. */
#ifndef GPIO_LINES_H
#define GPIO_LINES_H

#include <stdbool.h>
#include <stddef.h>

#include "drv/gpio.h"

/* "CHIP:OFFSET" taken apart: false when the name is not of this form. */
bool gpio_split_name(const char *name, char *chip, size_t size, unsigned *offset);

/* NULL, or the cause why the line cannot be had. An input is asked for both edges; where the chip
 * has no interrupt for it, it is had without. */
const char *gpio_line_open(struct drv_gpio_line *line, const char *name, bool is_output,
                           bool is_active_low);
void gpio_line_close(struct drv_gpio_line *line);

/* 1 active, 0 inactive, -1 with errno. */
int gpio_line_get(const struct drv_gpio_line *line);
int gpio_line_set(const struct drv_gpio_line *line, bool is_active);

/* Read the events that wait; only when line->fd is readable. */
void gpio_line_forget_events(const struct drv_gpio_line *line);

#endif
