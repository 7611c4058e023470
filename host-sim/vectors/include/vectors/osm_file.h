/* OpenStreetMap files, element by element as they stand: .osm.pbf (protocol buffers) and .osm
 * (XML). Nothing is left out, joined or put in order, so that who reads can account for each
 * element. A file may lack nodes that its ways name, repeat elements, and have them in any order.
 *
 * GDAL's driver does not suit: it leaves out elements with missing or late parts without a word. */
#ifndef VECTORS_OSM_FILE_H
#define VECTORS_OSM_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum osm_kind { OSM_NODE, OSM_WAY, OSM_RELATION, OSM_KINDS };

/* One element; everything in it is good until the callback returns. */
struct osm_element {
    enum osm_kind kind;
    int64_t id;
    double latitude, longitude; /* of nodes: degrees, finite; not checked against -90..90 */
    const int64_t *refs;        /* nodes of a way, members of a relation */
    const uint8_t *ref_kinds;   /* of relations: enum osm_kind of each member */
    const char *const *roles;   /* of relations: of each member */
    size_t ref_count;
    const char *const *tags; /* key, value, key, value ... */
    size_t tag_count;        /* pairs */
};

/* Degrees; the box that the file's head names. */
struct osm_box {
    bool is_given;
    double south, west, north, east;
};

struct osm_sink {
    void *context;
    /* Returns 0 to go on; another value ends the reading. */
    int (*take)(void *context, const struct osm_element *element);
    struct osm_box box; /* written */
};

/* Whether a name ends in .osm or .pbf. */
bool osm_file_is_one(const char *path);

/* Read a file whole. Returns 0, what `take` returned, or -1 with file, place, cause and remedy
 * reported:
 * - the file cannot be read, or ends within an element,
 * - a block is longer than the format allows (32 MiB), or does not unpack to its length,
 * - a block is compressed in another way than by zlib,
 * - a string, node or role is named that the block does not have; a number is none,
 * - the XML is not well formed.
 *
 * Cost: memory of one block (64 MiB at most), whatever the file's size. */
int osm_file_read(const char *path, struct osm_sink *sink);

/* The same for one format, whatever the name. */
int osm_pbf_read(const char *path, struct osm_sink *sink);
int osm_xml_read(const char *path, struct osm_sink *sink);

#endif
