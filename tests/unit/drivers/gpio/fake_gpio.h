/* Two GPIO chips for tests, behind either version of libgpiod (fake_gpiod1.c, fake_gpiod2.c). */
#ifndef FAKE_GPIO_H
#define FAKE_GPIO_H

#include <stdbool.h>
#include <stdint.h>

enum { FAKE_CHIPS = 2, FAKE_LINES = 40 };

struct fake_line {
    const char *name;                       /* NULL: none */
    bool level;                             /* of the wire */
    bool no_interrupt, is_broken, is_taken; /* taken: by another program */

    bool is_requested, is_output, is_active_low;
    int events; /* an eventfd: readable when an edge waits; -1: not asked for */
};

struct fake_chip {
    const char *name, *label;
    struct fake_line line[FAKE_LINES];
    int opens; /* not closed yet */
};

extern struct fake_chip fake_chips[FAKE_CHIPS];

void fake_gpio_reset(void);

/* Drive the wire of an input. */
void fake_gpio_drive(struct fake_line *line, bool level);

/* The same for both libraries. Requests answer 0 or an errno. */
int fake_gpio_request(struct fake_line *line, bool is_output, bool is_active_low, bool has_events);
void fake_gpio_release(struct fake_line *line);
int fake_gpio_get(const struct fake_line *line); /* 1, 0, -1 with errno */
int fake_gpio_set(struct fake_line *line, bool is_active);
int fake_gpio_read_events(struct fake_line *line); /* blocks when none waits, as the real one */

#endif
