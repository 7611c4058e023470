/* GPIO: lines of GPIO chips through libgpiod: keys in, lamps out. lines_gpiod1.c is for libgpiod
 * 1.6, lines_gpiod2.c for 2.x; the build takes the one whose library is installed.
 *
 * Events only wake the loop. The kernel keeps 16 of them for a line, and then drops the newest
 * (1.6) or the oldest (2.x). A lost event would leave a wrong state for ever, so the level is read
 * each time. */
#ifndef DRV_GPIO_H
#define DRV_GPIO_H

#include <stdbool.h>
#include <stdint.h>

enum { DRV_GPIO_LINES = 64 };

struct drv_gpio_line {
    void *handle; /* owned; the library's */
    int fd;       /* readable after an edge; -1: the line has no events and must be polled */
};

struct drv_gpio {
    int fd; /* -1: closed; else for poll(): readable after an edge of any input */
    uint32_t input_count, output_count;
    struct drv_gpio_line input[DRV_GPIO_LINES], output[DRV_GPIO_LINES];
    char error[160]; /* why the last call failed */

    struct {
        uint32_t edges;  /* times that an input had edges since the last look */
        uint32_t errors; /* lines that could not be read or set */
    } count;
};

/* Prepare to add lines. Returns LM_OK; or LM_ERR_IO, with the cause in g->error. */
int drv_gpio_open(struct drv_gpio *g);

/* Release all lines. Safe on one that is closed. */
void drv_gpio_close(struct drv_gpio *g);

/* Request a line: by its name, which is looked for on all chips; or by CHIP:OFFSET, the chip's
 * label or name and the line's number on it. A chip's name depends on the order of detection, its
 * label does not. Returns the number of the input or of the output, each counted from 0; or
 * LM_ERR_IO, with the cause in g->error. An output begins dark. */
int drv_gpio_add_input(struct drv_gpio *g, const char *name, bool is_active_low);
int drv_gpio_add_output(struct drv_gpio *g, const char *name, bool is_active_low);

/* Discard the events that wait. Returns bit n: input n had an edge since the last call. Never
 * waits. */
uint64_t drv_gpio_take_edges(struct drv_gpio *g);

/* Read the levels. Returns bit n: input n is active. An input that cannot be read counts as
 * inactive. */
uint64_t drv_gpio_levels(struct drv_gpio *g);

/* Light an output, or make it dark. */
void drv_gpio_set(struct drv_gpio *g, uint32_t output, bool is_lit);

#endif
