#include "osm_store.h"

#include "hs/error.h"
#include "osm_reading.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct filling {
    struct osm_store *store;
    const char *path;
};

static int short_of_memory(const struct filling *f)
{
    return hs_error(f->path, "cut it to the area with osmium extract", "out of memory");
}

/* Keep the tags; *offset 0 when there are none. */
static bool keep_tags(struct osm_store *s, const struct osm_element *e, size_t *offset)
{
    *offset = 0;
    if (e->tag_count == 0) {
        return true;
    }
    size_t bytes = 1;
    for (size_t i = 0; i < 2 * e->tag_count; i++) {
        bytes += strlen(e->tags[i]) + 1;
    }
    s->text_count += s->text_count == 0; /* 0 means none */
    if (!osm_room((void **)&s->texts, &s->text_capacity, s->text_count + bytes, 1)) {
        return false;
    }
    *offset = s->text_count;
    char *at = s->texts + s->text_count;
    for (size_t i = 0; i < e->tag_count; i++) {
        const char *key = e->tags[2 * i];
        if (!key[0]) {
            continue; /* an empty key would end the list */
        }
        at = stpcpy(at, key) + 1;
        at = stpcpy(at, e->tags[2 * i + 1]) + 1;
    }
    *at++ = '\0';
    s->text_count = (size_t)(at - s->texts);
    return true;
}

struct vector_tags osm_store_tags(const struct osm_store *s, size_t offset, const char **texts)
{
    struct vector_tags tags = {texts, 0};
    const char *at = offset ? s->texts + offset : "";
    while (*at && tags.count < OSM_TAGS_MAX) {
        texts[2 * tags.count] = at;
        at += strlen(at) + 1;
        texts[2 * tags.count + 1] = at;
        at += strlen(at) + 1;
        tags.count++;
    }
    return tags;
}

static bool keep_node(struct osm_store *s, const struct osm_element *e)
{
    const bool is_place = fabs(e->latitude) <= 90 && fabs(e->longitude) <= 180;
    if (!osm_room((void **)&s->nodes, &s->node_capacity, s->node_count + 1, sizeof *s->nodes)) {
        return false;
    }
    struct osm_node *n = &s->nodes[s->node_count];
    *n = (struct osm_node){.id = e->id, .place_error = is_place ? 0 : NAN};
    if (is_place) {
        n->latitude_e7 = (int32_t)lround(1e7 * e->latitude);
        n->longitude_e7 = (int32_t)lround(1e7 * e->longitude);
    }
    s->node_count++;
    return keep_tags(s, e, &n->tags);
}

static bool keep_refs(struct osm_store *s, const struct osm_element *e)
{
    const size_t end = s->ref_count + e->ref_count;
    if (!osm_room((void **)&s->refs, &s->ref_capacity, end + 1, sizeof *s->refs) ||
        !osm_room((void **)&s->ref_kinds, &s->kind_capacity, end + 1, 1)) {
        return false;
    }
    for (size_t i = 0; i < e->ref_count; i++) {
        const bool is_inner = e->roles && strcmp(e->roles[i], "inner") == 0;
        s->refs[s->ref_count + i] = e->refs[i];
        s->ref_kinds[s->ref_count + i] =
            (uint8_t)((e->ref_kinds ? e->ref_kinds[i] : OSM_NODE) | (is_inner ? OSM_INNER : 0));
    }
    s->ref_count = end;
    return true;
}

static bool keep_path(struct osm_store *s, const struct osm_element *e)
{
    const bool is_way = e->kind == OSM_WAY;
    struct osm_path **const paths = is_way ? &s->ways : &s->relations;
    size_t *const count = is_way ? &s->way_count : &s->relation_count;
    size_t *const capacity = is_way ? &s->way_capacity : &s->relation_capacity;
    struct osm_path p = {.id = e->id, .refs = s->ref_count, .ref_count = (uint32_t)e->ref_count};
    if (!osm_room((void **)paths, capacity, *count + 1, sizeof **paths) || !keep_refs(s, e) ||
        !keep_tags(s, e, &p.tags)) {
        return false;
    }
    (*paths)[(*count)++] = p;
    return true;
}

static int take(void *context, const struct osm_element *e)
{
    const struct filling *f = context;
    struct osm_store *s = f->store;
    s->late += e->kind < s->last_kind;
    s->last_kind = e->kind;
    const bool is_kept = e->kind == OSM_NODE ? keep_node(s, e) : keep_path(s, e);
    return is_kept ? 0 : short_of_memory(f);
}

/* ---- order ---- */

static int compare_ids(int64_t a, int64_t b)
{
    return (a > b) - (a < b);
}

static int compare_nodes(const void *a, const void *b)
{
    const struct osm_node *p = a, *q = b;
    /* Of equals the one that came first has its tags first, if it has any; places decide then. */
    const int order[4] = {
        compare_ids(p->id, q->id), compare_ids((int64_t)p->tags, (int64_t)q->tags),
        compare_ids(p->latitude_e7, q->latitude_e7), compare_ids(p->longitude_e7, q->longitude_e7)};
    for (int i = 0; i < 4; i++) {
        if (order[i]) {
            return order[i];
        }
    }
    return 0;
}

static int compare_paths(const void *a, const void *b)
{
    const struct osm_path *p = a, *q = b;
    const int by_id = compare_ids(p->id, q->id);
    return by_id ? by_id : compare_ids((int64_t)p->refs, (int64_t)q->refs);
}

static void order_paths(struct osm_path *paths, size_t count)
{
    if (count > 0) {
        qsort(paths, count, sizeof *paths, compare_paths);
    }
    for (size_t i = 1; i < count; i++) {
        paths[i].is_repeated = paths[i].id == paths[i - 1].id;
    }
}

static void order_nodes(struct osm_store *s)
{
    if (s->node_count > 0) {
        qsort(s->nodes, s->node_count, sizeof *s->nodes, compare_nodes);
    }
    size_t kept = 0;
    for (size_t i = 0; i < s->node_count; i++) {
        if (kept > 0 && s->nodes[kept - 1].id == s->nodes[i].id) {
            s->repeated_nodes++;
            s->nodes[kept - 1].tags =
                s->nodes[kept - 1].tags ? s->nodes[kept - 1].tags : s->nodes[i].tags;
        } else {
            s->nodes[kept++] = s->nodes[i];
        }
    }
    s->node_count = kept;
}

int osm_store_read(struct osm_store *s, const char *path)
{
    *s = (struct osm_store){.nodes = NULL};
    struct filling f = {s, path};
    struct osm_sink sink = {.context = &f, .take = take};
    if (osm_file_read(path, &sink) != 0) {
        osm_store_free(s);
        return -1;
    }
    s->box = sink.box;
    order_nodes(s);
    order_paths(s->ways, s->way_count);
    order_paths(s->relations, s->relation_count);
    return 0;
}

void osm_store_free(struct osm_store *s)
{
    free(s->nodes);
    free(s->ways);
    free(s->relations);
    free(s->refs);
    free(s->ref_kinds);
    free(s->texts);
    *s = (struct osm_store){.nodes = NULL};
}

const struct osm_node *osm_store_node(const struct osm_store *s, int64_t id)
{
    size_t low = 0, high = s->node_count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        const bool is_before = s->nodes[middle].id < id;
        low = is_before ? middle + 1 : low;
        high = is_before ? high : middle;
    }
    const bool is_found =
        low < s->node_count && s->nodes[low].id == id && !isnan(s->nodes[low].place_error);
    return is_found ? &s->nodes[low] : NULL;
}

struct osm_path *osm_store_way(const struct osm_store *s, int64_t id)
{
    size_t low = 0, high = s->way_count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        const bool is_before = s->ways[middle].id < id;
        low = is_before ? middle + 1 : low;
        high = is_before ? high : middle;
    }
    return low < s->way_count && s->ways[low].id == id ? &s->ways[low] : NULL;
}
