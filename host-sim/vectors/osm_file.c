#include "vectors/osm_file.h"

#include "osm_reading.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

static bool ends_in(const char *path, const char *ending)
{
    const size_t length = strlen(path), tail = strlen(ending);
    return length > tail && strcasecmp(path + length - tail, ending) == 0;
}

bool osm_file_is_one(const char *path)
{
    return ends_in(path, ".pbf") || ends_in(path, ".osm");
}

int osm_file_read(const char *path, struct osm_sink *sink)
{
    sink->box = (struct osm_box){.is_given = false};
    return ends_in(path, ".pbf") ? osm_pbf_read(path, sink) : osm_xml_read(path, sink);
}

bool osm_room(void **array, size_t *capacity, size_t count, size_t size)
{
    if (count <= *capacity) {
        return true;
    }
    size_t larger = *capacity ? *capacity : 64;
    while (larger < count) {
        larger *= 2;
    }
    void *moved = realloc(*array, larger * size);
    if (!moved) {
        return false;
    }
    *array = moved;
    *capacity = larger;
    return true;
}

uint64_t osm_bytes(FILE *file)
{
    struct stat status;
    return fstat(fileno(file), &status) == 0 && status.st_size > 0 ? (uint64_t)status.st_size : 1;
}
