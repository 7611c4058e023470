/* KMZ: a ZIP archive, read by libzip. Its KML is doc.kml, or else the first that is there (OGC
 * 07-147r2, annex C). */
#include "read_formats.h"
#include "whole_text.h"

#include "hs/error.h"

#include <string.h>
#include <strings.h>
#include <zip.h>

enum { KML_BYTES_MOST = 256 << 20 };

static const char remedy[] = "save it again as KML";

bool nav_is_kmz(const char *bytes, size_t size)
{
    return size >= 4 && memcmp(bytes, "PK\3\4", 4) == 0;
}

static bool is_kml(const char *name)
{
    const char *dot = name ? strrchr(name, '.') : NULL;
    return dot && strcasecmp(dot, ".kml") == 0;
}

static zip_int64_t find_kml(zip_t *archive)
{
    const zip_int64_t usual = zip_name_locate(archive, "doc.kml", ZIP_FL_NOCASE);
    const zip_int64_t count = zip_get_num_entries(archive, 0);
    for (zip_int64_t i = 0; usual < 0 && i < count; i++) {
        if (is_kml(zip_get_name(archive, (zip_uint64_t)i, 0))) {
            return i;
        }
    }
    return usual;
}

/* The declared size is only a hint; the text ends where the data do, or at the limit. */
static int64_t read_entry(void *context, void *to, size_t bytes)
{
    return zip_fread(context, to, bytes);
}

static char *unpack(zip_t *archive, const char *name, size_t *size)
{
    const zip_int64_t index = find_kml(archive);
    if (index < 0) {
        hs_error(name, remedy, "is an archive without a .kml file");
        return NULL;
    }
    zip_file_t *entry = zip_fopen_index(archive, (zip_uint64_t)index, 0);
    char *text = NULL;
    if (!entry || nav_whole_text(read_entry, entry, KML_BYTES_MOST, &text, size) != 0) {
        hs_error(name, remedy, "holds a KML file that is damaged, encrypted or above %d MB",
                 KML_BYTES_MOST >> 20);
    }
    if (entry) {
        zip_fclose(entry);
    }
    return text;
}

char *nav_unpack_kmz(const char *bytes, size_t size, const char *name, size_t *text_size)
{
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t *source = zip_source_buffer_create(bytes, size, 0, &error);
    zip_t *archive = source ? zip_open_from_source(source, ZIP_RDONLY, &error) : NULL;
    char *text = NULL;
    if (archive) {
        text = unpack(archive, name, text_size);
        zip_discard(archive);
    } else {
        hs_error(name, remedy, "is no whole KMZ archive: %s", zip_error_strerror(&error));
        zip_source_free(source);
    }
    zip_error_fini(&error);
    return text;
}
