/* A second reading of CANaerospace, for the tests: written from the specification's tables and
 * sharing nothing with the sender. */
#ifndef DECODE_H
#define DECODE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

struct decoded_frame {
    int64_t time_us;
    char interface[16];
    uint32_t id;
    bool is_extended; /* eight digits of identifier */
    int length;
    uint8_t data[8];
};

/* Read one line of candump -L, holding it to the form: six decimals, three or eight hexadecimal
 * digits of identifier in capitals, pairs of them as data. False when the line is not that. */
bool decode_line(const char *line, struct decoded_frame *f);

/* The data of a frame by the type it must have; false when its type or length differ. */
bool decode_float(const struct decoded_frame *f, double *value);
bool decode_long(const struct decoded_frame *f, int32_t *value);
bool decode_pair(const struct decoded_frame *high, const struct decoded_frame *low, double *value);

uint32_t decode_word(const struct decoded_frame *f);

/* Collects what a log says, value by value, in order of the log. */
struct decoded_log {
    struct decoded_frame *frame; /* owned */
    int count;
};

/* Read a whole log from its present place to the end. False when a line is not of the form. */
bool decode_log(FILE *in, struct decoded_log *log);
void decode_free(struct decoded_log *log);

#endif
