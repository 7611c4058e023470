/* JSON text (RFC 8259), written member by member. What comes out is well formed whatever the texts
 * and numbers are: control characters are escaped, bytes that are no UTF-8 become U+FFFD, numbers
 * that are not finite become null, and hs_json_end closes what is open.
 *
 * Written here and not by a library: it lies below the option parser, and so below the programs
 * that make the firmware's tables, which are built with libc and libm alone. */
#ifndef HS_JSON_H
#define HS_JSON_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum { HS_JSON_DEPTH_MAX = 16 };

struct hs_json {
    FILE *out; /* borrowed; its error mark tells a failed write */
    int depth; /* objects and arrays that are open */
    struct {
        bool is_array, has_members;
    } level[HS_JSON_DEPTH_MAX];
};

/* Open the outermost object. */
void hs_json_begin(struct hs_json *j, FILE *out);

/* Close whatever is open, the outermost object too. */
void hs_json_end(struct hs_json *j);

/* Open an object or an array, at most HS_JSON_DEPTH_MAX deep, and close the innermost; the
 * outermost stays open. `key` is a name of this program's own that its object has not yet; in an
 * array it is ignored, here and below, and may be NULL. */
void hs_json_object(struct hs_json *j, const char *key);
void hs_json_array(struct hs_json *j, const char *key);
void hs_json_close(struct hs_json *j);

void hs_json_text(struct hs_json *j, const char *key, const char *value); /* NULL: null */
void hs_json_real(struct hs_json *j, const char *key, double value);      /* 12 digits */
void hs_json_integer(struct hs_json *j, const char *key, int64_t value);
void hs_json_count(struct hs_json *j, const char *key, uint64_t value);
void hs_json_flag(struct hs_json *j, const char *key, bool value);

#endif
