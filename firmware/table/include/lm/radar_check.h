/* Check of a radar table against the ranges that lm/radar.h promises for each field. Every stage of
 * the picture relies on them: what a stage does with a table that breaks one is undefined. */
#ifndef LM_RADAR_CHECK_H
#define LM_RADAR_CHECK_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/radar.h"

/* The first field that breaks its range or a rule between fields. */
struct lm_radar_fault {
    const char *field; /* as lm/radar.h names it, "mode.bam_per_s"; a constant string */
    uint32_t index;    /* of the array's element or row; 0 where there is none */
    const char *needs; /* what a rule between fields asks for, a constant string; NULL: the field is
                        * outside its own range */
};

/* Check every field: names, and numbers of the rows in use. `fault` may be NULL; it is written on
 * failure only.
 *
 * Returns LM_OK, or LM_ERR_TABLE iff
 *  - a number lies outside the range that stands beside its field in lm/radar.h, or
 *  - one of the rules between fields does not hold that lm/radar.h lists.
 *
 * Cost: some 10 k instructions; done once, when the unit starts. */
int lm_radar_check(const struct lm_radar *radar, struct lm_radar_fault *fault);

/* Units of fields. A tool that prints a table writes the number so that it reads exactly back. */
enum lm_radar_unit {
    LM_RADAR_NUMBER, /* a count, a logarithm or an index */
    LM_RADAR_WORD,   /* enum lm_sensor */
    LM_RADAR_Q8,     /* 1/256, of no unit */
    LM_RADAR_DB_Q8,  /* 1/256 dB */
    LM_RADAR_DB_PER_KM_Q16,
    LM_RADAR_BAM,
    LM_RADAR_BAM_PER_S,
    LM_RADAR_M,
    LM_RADAR_NMI, /* nautical miles */
    LM_RADAR_MM,
    LM_RADAR_UM,
    LM_RADAR_MM_S,
    LM_RADAR_NS,
    LM_RADAR_MS,
    LM_RADAR_PERMILLE,
    LM_RADAR_PERCENT,
    LM_RADAR_UNITS
};

/* A field of the table as the check knows it: for tests and for tools that print a table. */
struct lm_radar_field {
    const char *name;
    uint16_t offset; /* of its first element in struct lm_radar, bytes */
    uint8_t size;    /* of an element, bytes: 1, 2 or 4 */
    uint8_t count;   /* elements, 1 and more */
    uint16_t stride; /* from element to element, bytes */
    bool is_signed;
    bool is_of_scales; /* of the rows of scales: those in use count */
    uint8_t unit;      /* enum lm_radar_unit */
    int64_t min, max;
};

/* Field number 0.., in the order in which they are checked; NULL behind the last. */
const struct lm_radar_field *lm_radar_field(uint32_t number);

/* Elements of the field that this table uses. */
uint32_t lm_radar_field_count(const struct lm_radar *radar, const struct lm_radar_field *field);

/* Element `index` of the field, index < count. */
int64_t lm_radar_field_value(const struct lm_radar *radar, const struct lm_radar_field *field,
                             uint32_t index);

/* Set element `index` of the field, index < field->count. Of a value that does not fit the field
 * the low bits are kept. */
void lm_radar_field_set(struct lm_radar *radar, const struct lm_radar_field *field, uint32_t index,
                        int64_t value);

#endif
