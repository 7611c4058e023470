#include "image/recode.h"

#include "hs/error.h"
#include "image/writer.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Append the tiles in the order of their records. */
static int copy_tiles(const struct image *image, struct image_writer *w)
{
    uint32_t *entries = malloc(((size_t)image->header.entry_count + 1) * sizeof *entries);
    uint32_t count = 0;
    if (!entries) {
        return hs_error(w->file.path, NULL, "out of memory");
    }
    for (uint32_t i = 0; i < image->header.entry_count; i++) {
        const struct lm_tile_entry *e = &image->entries[i];
        if (e->place != LM_TILE_ABSENT) {
            image_writer_detail(w, i, e->detail_place, e->detail_size);
            entries[count++] = i;
        }
    }
    image_sort_by_place(image, entries, count);
    int result = 0;
    for (uint32_t i = 0; i < count && result == 0; i++) {
        result = image_writer_tile(w, entries[i], image_entry_tile(image, entries[i]));
    }
    free(entries);
    return result;
}

static struct image_bytes bytes_of(const struct image *image, enum lm_image_section_type type)
{
    const struct lm_image_section *s = image->sections[type];
    return s ? (struct image_bytes){image->bytes + s->offset, s->bytes} : (struct image_bytes){0};
}

/* Lines that the writer makes again. */
static bool is_writers(const char *line, size_t length)
{
    static const char *const keys[] = {"section-sha256:", "records:"};
    for (int i = 0; i < 2; i++) {
        const size_t n = strlen(keys[i]);
        if (length >= n && memcmp(line, keys[i], n) == 0) {
            return true;
        }
    }
    return false;
}

/* The caller frees it. NULL without memory. */
static char *manifest_of(const struct image *image)
{
    const struct image_bytes manifest = bytes_of(image, LM_IMAGE_MANIFEST);
    const char *line = manifest.data, *const end = line + manifest.count;
    char *text = malloc(manifest.count + 1), *to = text;
    while (text && line < end) {
        const char *stop = memchr(line, '\n', (size_t)(end - line));
        const size_t length = stop ? (size_t)(stop - line) + 1 : (size_t)(end - line);
        if (!is_writers(line, length)) {
            memcpy(to, line, length);
            to += length;
        }
        line += length;
    }
    if (text) {
        *to = '\0';
    }
    return text;
}

int image_recode(const struct image *image, const char *name, enum image_compression how,
                 const char *path)
{
    struct image_writer w;
    struct lm_image_header header = image->header;
    header.record_count = 0;
    memset(header.sections, 0, sizeof header.sections);
    if (image_writer_begin(&w, path, &header, &image->db.classes, image->db.bands) != 0) {
        return -1;
    }
    w.compression = how;
    w.has_borders = true;
    w.targets = bytes_of(image, LM_IMAGE_TARGETS);
    w.signatures = bytes_of(image, LM_IMAGE_SIGNATURES);
    w.geoid = bytes_of(image, LM_IMAGE_GEOID);
    w.detail = bytes_of(image, LM_IMAGE_DETAIL);
    w.radar = bytes_of(image, LM_IMAGE_RADAR);
    w.bus = bytes_of(image, LM_IMAGE_BUS);
    w.geoid_pages = bytes_of(image, LM_IMAGE_GEOID_PAGES);
    if (image->sections[LM_IMAGE_SEAL]) {
        hs_warn(name, "seal the new image", "its seal is left out");
    }
    char *manifest = copy_tiles(image, &w) == 0 ? manifest_of(image) : NULL;
    if (!manifest) {
        image_writer_abort(&w);
        return hs_error(path, NULL, "cannot be made");
    }
    const int result = image_writer_end(&w, manifest);
    free(manifest);
    return result;
}
