/* Head of an image as the trust library reads it: header and seal, checked for their form. */
#ifndef TRUST_HEAD_H
#define TRUST_HEAD_H

#include "trust/verify.h"

struct trust_head {
    struct lm_image_header header;
    uint8_t order[LM_IMAGE_SECTIONS_MAX]; /* numbers of the sections, by their offset */
    uint32_t seal_index;                  /* of SEAL in the table */
    struct trust_seal seal;
};

/* Note what is wrong, in printf's manner; returns `verdict`. */
enum trust_verdict trust_note(struct trust_result *r, enum trust_verdict verdict, uint64_t offset,
                              const char *cause, ...) __attribute__((format(printf, 4, 5)));

/* Read header and seal. The sections lie inside the image, behind its header, and share no byte.
 * TRUST_GOOD says that there is a seal whose form is right, TRUST_UNSIGNED that there is none;
 * nothing else has been compared. */
enum trust_verdict trust_head_read(struct trust_head *head, const struct trust_reader *reader,
                                   struct trust_result *r);

/* "CLASSES" and so on. */
const char *trust_section_name(uint32_t type);

#endif
