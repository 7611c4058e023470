#include "osm_source.h"

#include "hs/error.h"
#include "hs/progress.h"
#include "osm_reading.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Everything one element after another needs. */
struct adding {
    struct osm_store *store;
    struct vector_map *map;
    struct vector_census *census;
    OGRCoordinateTransformationH to_plane;
    const char *texts[2 * OSM_TAGS_MAX];
};

bool osm_source_area(const struct osm_store *s, struct vector_area *area)
{
    if (s->box.is_given) {
        *area = (struct vector_area){s->box.south, s->box.west, s->box.north, s->box.east};
        return true;
    }
    *area = (struct vector_area){HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < s->node_count; i++) {
        const double latitude = 1e-7 * s->nodes[i].latitude_e7,
                     longitude = 1e-7 * s->nodes[i].longitude_e7;
        area->south = fmin(area->south, latitude);
        area->north = fmax(area->north, latitude);
        area->west = fmin(area->west, longitude);
        area->east = fmax(area->east, longitude);
    }
    return s->node_count > 0;
}

static int add_candidate(struct adding *a, int rule, OGRGeometryH geometry,
                         const struct vector_tags *tags, const char *kind, int64_t id)
{
    struct vector_candidate c = {.rule = rule, .geometry = geometry, .tags = *tags};
    snprintf(c.origin, sizeof c.origin, "%s %" PRId64, kind, id);
    return vector_map_add(a->map, &c, a->to_plane, a->census);
}

/* ---- nodes ---- */

static int add_node(struct adding *a, const struct osm_node *n)
{
    const struct vector_tags tags = osm_store_tags(a->store, n->tags, a->texts);
    if (tags.count == 0) {
        return VECTOR_NO_TAGS;
    }
    const int rule = vector_rules_find(a->map->rules, 1u << VECTOR_POINT, &tags);
    if (rule < 0) {
        return VECTOR_NO_RULE;
    }
    if (isnan(n->place_error)) {
        return VECTOR_NO_AREA;
    }
    OGRGeometryH point = OGR_G_CreateGeometry(wkbPoint);
    OGR_G_SetPoint_2D(point, 0, 1e-7 * n->longitude_e7, 1e-7 * n->latitude_e7);
    return add_candidate(a, rule, point, &tags, "node", n->id);
}

/* ---- ways ---- */

static void add_place(OGRGeometryH line, const struct osm_node *n)
{
    OGR_G_AddPoint_2D(line, 1e-7 * n->longitude_e7, 1e-7 * n->latitude_e7);
}

/* A way as lines: the pieces between nodes that are missing. */
static OGRGeometryH lines_of(struct adding *a, const struct osm_path *way)
{
    OGRGeometryH lines = OGR_G_CreateGeometry(wkbMultiLineString), piece = NULL;
    bool is_short = false;
    for (uint32_t i = 0; i <= way->ref_count; i++) {
        const struct osm_node *n =
            i < way->ref_count ? osm_store_node(a->store, a->store->refs[way->refs + i]) : NULL;
        is_short = is_short || (i < way->ref_count && !n);
        if (n) {
            piece = piece ? piece : OGR_G_CreateGeometry(wkbLineString);
            add_place(piece, n);
        } else if (piece) {
            if (OGR_G_GetPointCount(piece) >= 2) {
                OGR_G_AddGeometry(lines, piece);
            }
            OGR_G_DestroyGeometry(piece);
            piece = NULL;
        }
    }
    a->census->shortened += is_short && OGR_G_GetGeometryCount(lines) > 0;
    return lines;
}

/* A closed way as a polygon; NULL when a node is missing. */
static OGRGeometryH polygon_of(const struct adding *a, const struct osm_path *way)
{
    OGRGeometryH ring = OGR_G_CreateGeometry(wkbLinearRing);
    for (uint32_t i = 0; i < way->ref_count; i++) {
        const struct osm_node *n = osm_store_node(a->store, a->store->refs[way->refs + i]);
        if (!n) {
            OGR_G_DestroyGeometry(ring);
            return NULL;
        }
        add_place(ring, n);
    }
    OGRGeometryH polygon = OGR_G_CreateGeometry(wkbPolygon);
    OGR_G_AddGeometryDirectly(polygon, ring);
    return polygon;
}

static bool is_closed(const struct osm_store *s, const struct osm_path *way)
{
    return way->ref_count >= 4 && s->refs[way->refs] == s->refs[way->refs + way->ref_count - 1];
}

static int add_way(struct adding *a, const struct osm_path *way)
{
    const unsigned line = 1u << VECTOR_LINE, area = 1u << VECTOR_AREA;
    if (way->is_repeated || way->is_taken) {
        return way->is_repeated ? VECTOR_REPEATED : VECTOR_IN_RELATION;
    }
    const struct vector_tags tags = osm_store_tags(a->store, way->tags, a->texts);
    if (tags.count == 0) {
        return VECTOR_NO_TAGS;
    }
    const bool is_ring = is_closed(a->store, way);
    const int rule = vector_rules_find(a->map->rules, is_ring ? line | area : line, &tags);
    if (rule < 0) {
        const int of_area = vector_rules_find(a->map->rules, area, &tags);
        return of_area < 0                                  ? VECTOR_NO_RULE
               : a->map->rules->items[of_area].leave_out[0] ? VECTOR_LEFT_OUT
                                                            : VECTOR_OPEN;
    }
    if (a->map->rules->items[rule].leave_out[0]) {
        return VECTOR_LEFT_OUT;
    }
    const bool is_area = a->map->rules->items[rule].from == VECTOR_AREA;
    OGRGeometryH geometry = is_area ? polygon_of(a, way) : lines_of(a, way);
    if (!geometry || OGR_G_IsEmpty(geometry)) {
        OGR_G_DestroyGeometry(geometry);
        return VECTOR_DANGLING;
    }
    return add_candidate(a, rule, geometry, &tags, "way", way->id);
}

/* ---- relations ---- */

/* What the rings of a relation are joined of. */
struct joining {
    OGRGeometryH outer, inner; /* multilinestrings; owned */
    int missing, ways;
    const struct osm_path *first_outer;
};

static void gather_members(struct adding *a, const struct osm_path *relation, struct joining *j)
{
    const struct osm_store *s = a->store;
    for (uint32_t i = 0; i < relation->ref_count; i++) {
        const uint8_t kind = s->ref_kinds[relation->refs + i];
        if ((kind & ~OSM_INNER) != OSM_WAY) {
            continue;
        }
        const struct osm_path *way = osm_store_way(s, s->refs[relation->refs + i]);
        j->ways++;
        if (!way) {
            j->missing++;
            continue;
        }
        const struct vector_census before = *a->census;
        OGRGeometryH lines = lines_of(a, way);
        j->missing += a->census->shortened > before.shortened || OGR_G_IsEmpty(lines);
        a->census->shortened = before.shortened; /* it is the relation's loss */
        for (int k = 0; k < OGR_G_GetGeometryCount(lines); k++) {
            OGR_G_AddGeometry(kind & OSM_INNER ? j->inner : j->outer,
                              OGR_G_GetGeometryRef(lines, k));
        }
        OGR_G_DestroyGeometry(lines);
        if (!(kind & OSM_INNER) && !j->first_outer) {
            j->first_outer = way;
        }
    }
}

static bool same_place(OGRGeometryH a, int i, OGRGeometryH b, int k)
{
    return OGR_G_GetX(a, i) == OGR_G_GetX(b, k) && OGR_G_GetY(a, i) == OGR_G_GetY(b, k);
}

/* Add the points of a line to a ring that ends where it begins, or, turned round, ends. */
static bool append(OGRGeometryH ring, OGRGeometryH line)
{
    const int last = OGR_G_GetPointCount(ring) - 1, count = OGR_G_GetPointCount(line);
    const bool is_forward = same_place(ring, last, line, 0),
               is_backward = same_place(ring, last, line, count - 1);
    for (int i = 1; i < count && (is_forward || is_backward); i++) {
        const int k = is_forward ? i : count - 1 - i;
        OGR_G_AddPoint_2D(ring, OGR_G_GetX(line, k), OGR_G_GetY(line, k));
    }
    return is_forward || is_backward;
}

static bool ring_is_closed(OGRGeometryH ring)
{
    const int count = OGR_G_GetPointCount(ring);
    return count >= 4 && same_place(ring, 0, ring, count - 1);
}

/* Take one ring out of the lines from number `first`; NULL when it does not close. */
static OGRGeometryH join_ring(OGRGeometryH lines, int first, bool *is_used)
{
    const int count = OGR_G_GetGeometryCount(lines);
    OGRGeometryH ring = OGR_G_CreateGeometry(wkbLinearRing),
                 begin = OGR_G_GetGeometryRef(lines, first);
    for (int i = 0; i < OGR_G_GetPointCount(begin); i++) {
        OGR_G_AddPoint_2D(ring, OGR_G_GetX(begin, i), OGR_G_GetY(begin, i));
    }
    is_used[first] = true;
    bool grows = true;
    while (grows && !ring_is_closed(ring)) {
        grows = false;
        for (int i = 0; i < count && !grows; i++) {
            grows = !is_used[i] && append(ring, OGR_G_GetGeometryRef(lines, i));
            is_used[i] = is_used[i] || grows;
        }
    }
    if (!ring_is_closed(ring)) {
        OGR_G_DestroyGeometry(ring);
        return NULL;
    }
    return ring;
}

/* All rings of lines as polygons; *open counts those that do not close. NULL out of memory. */
static OGRGeometryH join_rings(OGRGeometryH lines, int *open)
{
    const int count = OGR_G_GetGeometryCount(lines);
    bool *is_used = calloc((size_t)count + 1, sizeof *is_used);
    OGRGeometryH polygons = is_used ? OGR_G_CreateGeometry(wkbMultiPolygon) : NULL;
    for (int i = 0; i < count && polygons; i++) {
        if (is_used[i]) {
            continue;
        }
        OGRGeometryH ring = join_ring(lines, i, is_used);
        if (!ring) {
            ++*open;
            continue;
        }
        OGRGeometryH polygon = OGR_G_CreateGeometry(wkbPolygon);
        OGR_G_AddGeometryDirectly(polygon, ring);
        OGR_G_AddGeometryDirectly(polygons, polygon);
    }
    free(is_used);
    return polygons;
}

/* Rings that cross are made valid first: GEOS subtracts nothing else. */
static OGRGeometryH made_valid(OGRGeometryH g)
{
    OGRGeometryH valid = OGR_G_IsValid(g) ? NULL : OGR_G_MakeValid(g);
    if (valid) {
        OGR_G_DestroyGeometry(g);
    }
    return valid ? valid : g;
}

/* The relation's area: its outer rings less its inner ones. NULL when no outer ring closes. */
static OGRGeometryH area_of(struct adding *a, struct joining *j, bool *is_holed)
{
    int open = 0;
    OGRGeometryH outer = join_rings(j->outer, &open), inner = join_rings(j->inner, &open);
    if (!outer || !inner || OGR_G_IsEmpty(outer)) {
        OGR_G_DestroyGeometry(outer);
        OGR_G_DestroyGeometry(inner);
        return NULL;
    }
    *is_holed = open > 0 || j->missing > 0;
    const bool was_valid = OGR_G_IsValid(outer);
    outer = made_valid(outer);
    a->census->repaired += !was_valid;
    OGRGeometryH rest = outer;
    if (!OGR_G_IsEmpty(inner)) {
        inner = made_valid(inner);
        rest = OGR_G_Difference(outer, inner);
        rest = rest ? rest : OGR_G_Clone(outer);
        OGR_G_DestroyGeometry(outer);
    }
    OGR_G_DestroyGeometry(inner);
    return rest;
}

static bool is_multipolygon(const struct vector_tags *tags)
{
    const char *type = vector_tag(tags, "type");
    return type && (strcmp(type, "multipolygon") == 0 || strcmp(type, "boundary") == 0 ||
                    strcmp(type, "building") == 0);
}

static int add_area(struct adding *a, const struct osm_path *relation, struct joining *j, int rule,
                    const struct vector_tags *tags)
{
    bool is_holed = false;
    if (a->map->rules->items[rule].leave_out[0]) {
        return VECTOR_LEFT_OUT;
    }
    OGRGeometryH area = area_of(a, j, &is_holed);
    if (!area) {
        return j->missing > 0 ? VECTOR_DANGLING : VECTOR_OPEN;
    }
    const int fate = add_candidate(a, rule, area, tags, "relation", relation->id);
    a->census->holed += fate == VECTOR_MADE && is_holed;
    return fate;
}

/* Relations of older files have their tags on the outer way: they are made in its place. */
static int add_multipolygon(struct adding *a, const struct osm_path *relation,
                            const struct vector_tags *tags, struct joining *j)
{
    const unsigned area = 1u << VECTOR_AREA;
    const int rule = vector_rules_find(a->map->rules, area, tags);
    if (rule >= 0) {
        return add_area(a, relation, j, rule, tags);
    }
    if (tags->count > 1 || !j->first_outer || j->first_outer->is_repeated) {
        return VECTOR_NO_RULE;
    }
    struct osm_path *way = osm_store_way(a->store, j->first_outer->id);
    const struct vector_tags of_way = osm_store_tags(a->store, way->tags, a->texts);
    const int rule_of_way = vector_rules_find(a->map->rules, area, &of_way);
    if (rule_of_way < 0) {
        return VECTOR_NO_RULE;
    }
    const int fate = add_area(a, relation, j, rule_of_way, &of_way);
    way->is_taken = fate == VECTOR_MADE;
    return fate;
}

static int add_relation(struct adding *a, const struct osm_path *relation)
{
    if (relation->is_repeated) {
        return VECTOR_REPEATED;
    }
    const struct vector_tags tags = osm_store_tags(a->store, relation->tags, a->texts);
    if (tags.count == 0 || !is_multipolygon(&tags)) {
        return tags.count == 0 ? VECTOR_NO_TAGS : VECTOR_NO_RULE;
    }
    struct joining j = {.outer = OGR_G_CreateGeometry(wkbMultiLineString),
                        .inner = OGR_G_CreateGeometry(wkbMultiLineString)};
    gather_members(a, relation, &j);
    const int fate = add_multipolygon(a, relation, &tags, &j);
    OGR_G_DestroyGeometry(j.outer);
    OGR_G_DestroyGeometry(j.inner);
    return fate;
}

/* ---- all of them ---- */

static int note(struct vector_census *census, enum vector_kind kind, int fate)
{
    if (fate < 0) {
        return -1;
    }
    census->fates[kind][fate]++;
    return 0;
}

/* Relations first: they may stand for their ways. */
static int add_all(struct adding *a, struct hs_progress *bar)
{
    const struct osm_store *s = a->store;
    uint64_t done = 0;
    int result = 0;
    for (size_t i = 0; i < s->relation_count && result == 0; i++) {
        result = note(a->census, VECTOR_RELATIONS, add_relation(a, &s->relations[i]));
        hs_progress_update(bar, ++done);
    }
    for (size_t i = 0; i < s->way_count && result == 0; i++) {
        result = note(a->census, VECTOR_WAYS, add_way(a, &s->ways[i]));
        hs_progress_update(bar, ++done);
    }
    for (size_t i = 0; i < s->node_count && result == 0; i++) {
        result = note(a->census, VECTOR_NODES, add_node(a, &s->nodes[i]));
        hs_progress_update(bar, ++done);
    }
    return result;
}

static uint64_t count_missing(const struct osm_store *s)
{
    uint64_t missing = 0;
    for (size_t i = 0; i < s->way_count; i++) {
        const struct osm_path *way = &s->ways[i];
        for (uint32_t k = 0; k < way->ref_count && !way->is_repeated; k++) {
            missing += osm_store_node(s, s->refs[way->refs + k]) == NULL;
        }
    }
    return missing;
}

int osm_source_add(struct vector_source *source, struct vector_map *map)
{
    struct osm_store *s = source->store;
    struct adding *a = calloc(1, sizeof *a);
    if (!a) {
        return hs_error(source->path, NULL, "out of memory");
    }
    a->store = s;
    a->map = map;
    a->census = &source->census;
    a->to_plane = vector_map_from(map, NULL, source->path);
    struct vector_census *c = &source->census;
    c->read[VECTOR_NODES] = s->node_count + s->repeated_nodes;
    c->fates[VECTOR_NODES][VECTOR_REPEATED] = s->repeated_nodes;
    c->read[VECTOR_WAYS] = s->way_count;
    c->read[VECTOR_RELATIONS] = s->relation_count;
    c->late = s->late;
    c->missing = count_missing(s);
    struct hs_progress bar;
    hs_progress_begin(&bar, "features", s->node_count + s->way_count + s->relation_count);
    const int result = a->to_plane ? add_all(a, &bar) : -1;
    hs_progress_end(&bar);
    OCTDestroyCoordinateTransformation(a->to_plane);
    free(a);
    return result;
}
