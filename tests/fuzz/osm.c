#include "osm.h"

#include <math.h>

/* Read every text and number, so that the sanitizers see them. */
static int take(void *context, const struct osm_element *e)
{
    size_t *sum = context;
    FUZZ_ASSERT(e->kind < OSM_KINDS);
    FUZZ_ASSERT(isfinite(e->latitude) && isfinite(e->longitude));
    for (size_t i = 0; i < 2 * e->tag_count; i++) {
        *sum += strlen(e->tags[i]);
    }
    for (size_t i = 0; i < e->ref_count; i++) {
        *sum += (size_t)(e->refs[i] & 1);
        if (e->kind == OSM_RELATION) {
            FUZZ_ASSERT(e->ref_kinds[i] < OSM_KINDS);
            *sum += strlen(e->roles[i]);
        }
    }
    return 0;
}

int fuzz_osm(const uint8_t *data, size_t size, int (*read)(const char *path, struct osm_sink *sink))
{
    struct fuzz_file file;
    size_t sum = 0;
    struct osm_sink sink = {.context = &sum, .take = take};
    fuzz_file_open(&file, data, size);
    const int result = read(file.path, &sink);
    FUZZ_ASSERT(result == 0 || result == -1);
    fuzz_file_close(&file);
    return 0;
}
