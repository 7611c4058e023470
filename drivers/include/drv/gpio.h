/* Lines of GPIO chips through libgpiod: keys in, lamps out. The file lines_gpiod1.c is for libgpiod
 * 1.6, lines_gpiod2.c for 2.x; the build takes the one whose library is installed.
 *
 * Events only wake the loop. The kernel keeps 16 of them for a line and drops the newest (1.6) or
 * the oldest (2.x) when nobody reads, so that what they say may be wrong for ever: what counts is
 * the level, which is read again each time. */
#ifndef DRV_GPIO_H
#define DRV_GPIO_H

#include <stdbool.h>
#include <stdint.h>

enum { DRV_GPIO_LINES = 64 };

struct drv_gpio_line {
    void *handle; /* owned, of the library */
    int fd;       /* readable when there was an edge; -1: the line can only be asked */
};

struct drv_gpio {
    int fd; /* for poll(): readable when any input had an edge; -1: closed */
    uint32_t input_count, output_count;
    struct drv_gpio_line input[DRV_GPIO_LINES], output[DRV_GPIO_LINES];
    char error[160];

    struct {
        uint32_t edges;  /* times that an input was found to have had edges */
        uint32_t errors; /* lines that could not be read or set */
    } count;
};

/* LM_OK, or LM_ERR_IO with g->error. */
int drv_gpio_open(struct drv_gpio *g);
void drv_gpio_close(struct drv_gpio *g);

/* Request a line by its name, which is looked for on all chips, or by CHIP:OFFSET, the chip's label
 * or name and a number (names of chips change with the order in which they are found; labels do
 * not). Returns the number of the input or output, which count from 0, or LM_ERR_IO with g->error
 * saying why. An output begins dark. */
int drv_gpio_add_input(struct drv_gpio *g, const char *name, bool is_active_low);
int drv_gpio_add_output(struct drv_gpio *g, const char *name, bool is_active_low);

/* Forget the events that wait. Bit n: input n has had an edge since the last call. Never waits. */
uint64_t drv_gpio_take_edges(struct drv_gpio *g);

/* Bit n: input n is active now. One that cannot be read counts as inactive. */
uint64_t drv_gpio_levels(struct drv_gpio *g);

void drv_gpio_set(struct drv_gpio *g, uint32_t output, bool is_lit);

#endif
