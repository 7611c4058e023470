/* Store of one OpenStreetMap file: every element by its number, in whatever order they stood. */
#ifndef VECTORS_OSM_STORE_H
#define VECTORS_OSM_STORE_H

#include "vectors/map.h"
#include "vectors/osm_file.h"

struct osm_node {
    int64_t id;
    float place_error; /* 0, or NAN for a place that is none */
    int32_t latitude_e7, longitude_e7;
    size_t tags; /* offset of the texts, 0: none */
};

/* A way or a relation. */
struct osm_path {
    int64_t id;
    size_t refs, tags; /* offsets */
    uint32_t ref_count;
    bool is_repeated, is_taken; /* taken: a relation was made in its place */
};

struct osm_store {
    struct osm_node *nodes;
    struct osm_path *ways, *relations;
    int64_t *refs;
    uint8_t *ref_kinds; /* beside refs: kind of member, plus OSM_INNER */
    char *texts;        /* key, zero, value, zero ... ended by an empty key */
    size_t node_count, node_capacity, way_count, way_capacity, relation_count, relation_capacity;
    size_t ref_count, ref_capacity, kind_capacity, text_count, text_capacity;
    uint64_t repeated_nodes, late;
    enum osm_kind last_kind;
    struct osm_box box;
};

enum { OSM_INNER = 0x10 };

/* Read a file and put its elements in order of their numbers; of repeated ones the first. Returns
 * 0, or -1 with the error reported and nothing to free. */
int osm_store_read(struct osm_store *s, const char *path);
void osm_store_free(struct osm_store *s);

/* By number; NULL when the file has none. */
const struct osm_node *osm_store_node(const struct osm_store *s, int64_t id);
struct osm_path *osm_store_way(const struct osm_store *s, int64_t id);

/* Point `tags` at the texts of an element. `texts` is room for 2 * OSM_TAGS_MAX; further tags are
 * not looked at, which the format's own limits do not allow either. */
enum { OSM_TAGS_MAX = 512 };
struct vector_tags osm_store_tags(const struct osm_store *s, size_t offset, const char **texts);

#endif
