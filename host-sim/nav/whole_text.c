#include "whole_text.h"

#include <stdlib.h>

enum { FIRST_BYTES = 1 << 16 };

enum nav_whole nav_whole_text(nav_source_fn *read, void *context, size_t most, char **text,
                              size_t *size)
{
    enum nav_whole result = NAV_WHOLE_TOO_LARGE;
    size_t capacity = 0;
    *text = NULL;
    *size = 0;
    for (size_t wanted = FIRST_BYTES; wanted <= most; wanted *= 2) {
        char *grown = realloc(*text, wanted + 1);
        if (!grown) {
            break;
        }
        *text = grown;
        capacity = wanted;
        int64_t n = 1;
        while (*size < capacity && (n = read(context, *text + *size, capacity - *size)) > 0) {
            *size += (size_t)n;
        }
        if (n <= 0) {
            result = n == 0 ? NAV_WHOLE_DONE : NAV_WHOLE_UNREADABLE;
            break;
        }
    }
    if (result == NAV_WHOLE_DONE) {
        (*text)[*size] = '\0';
    } else {
        free(*text);
        *text = NULL;
    }
    return result;
}
