#include "tracer/obj_file.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/input_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { FACE_CORNERS_MAX = 1024 };

struct reader {
    struct mesh *m;
    const char *path;
    enum obj_up up;
    int line_number;
    uint32_t material;
};

static int line_error(const struct reader *r, const char *remedy, const char *cause)
{
    char place[512];
    snprintf(place, sizeof place, "%s line %d", r->path, r->line_number);
    return hs_error(place, remedy, "%s", cause);
}

static int read_vertex(struct reader *r, const char *text)
{
    double c[3];
    for (int i = 0; i < 3; i++) {
        char *end;
        c[i] = strtod(text, &end);
        if (end == text) {
            return line_error(r, "export the model again", "a vertex needs three numbers");
        }
        if (!(fabs(c[i]) <= MESH_SIZE_MAX_M)) { /* a NaN too */
            return line_error(r, "export the model in metres",
                              "a coordinate is not finite or beyond 10 km");
        }
        text = end;
    }
    const struct vec v =
        r->up == OBJ_UP_Y ? (struct vec){c[0], -c[2], c[1]} : (struct vec){c[0], c[1], c[2]};
    mesh_add_vertex(r->m, v);
    return 0;
}

/* "7", "7/1", "7//3" or "-1": the vertex before the first slash. */
static int read_corner(struct reader *r, const char **text, uint32_t *corner)
{
    char *end;
    errno = 0;
    const long index = strtol(*text, &end, 10);
    if (end == *text || errno != 0 || (*end != '\0' && !strchr("/ \t", *end))) {
        return line_error(r, "export the model again", "a corner of a face is no number");
    }
    const long count = (long)r->m->vertex_count;
    if (index == 0 || index > count || index < -count) {
        return line_error(r, "export the model again", "a face names a vertex that is not there");
    }
    *corner = (uint32_t)(index > 0 ? index - 1 : count + index);
    *text = end + strcspn(end, " \t");
    *text += strspn(*text, " \t");
    return 0;
}

/* The area of the polygon as a vector. */
static struct vec area_of(const struct mesh *m, const uint32_t *corners, int count)
{
    struct vec area = {0, 0, 0};
    const struct vec origin = m->vertices[corners[0]];
    for (int i = 1; i + 1 < count; i++) {
        area = vec_add(area, vec_cross(vec_sub(m->vertices[corners[i]], origin),
                                       vec_sub(m->vertices[corners[i + 1]], origin)));
    }
    return area;
}

/* At no corner may the outline turn against its area; a little is forgiven to rounded numbers. */
static bool is_convex(const struct mesh *m, const uint32_t *corners, int count)
{
    const struct vec area = area_of(m, corners, count);
    for (int i = 0; i < count; i++) {
        const struct vec a = m->vertices[corners[i]], b = m->vertices[corners[(i + 1) % count]];
        const struct vec c = m->vertices[corners[(i + 2) % count]];
        if (vec_dot(vec_cross(vec_sub(b, a), vec_sub(c, b)), area) < -1e-6 * vec_dot(area, area)) {
            return false;
        }
    }
    return true;
}

static int read_face(struct reader *r, const char *text)
{
    uint32_t corners[FACE_CORNERS_MAX];
    int count = 0;
    while (*text) {
        if (count == FACE_CORNERS_MAX) {
            return line_error(r, "divide it into triangles", "a face of more than 1024 corners");
        }
        if (read_corner(r, &text, &corners[count++]) != 0) {
            return -1;
        }
    }
    if (count < 3) {
        return line_error(r, "export the model again", "a face of fewer than three corners");
    }
    if (count > 3 && !is_convex(r->m, corners, count)) {
        return line_error(r, "divide the faces into triangles and export again",
                          "a face is not convex");
    }
    for (int i = 1; i + 1 < count; i++) {
        mesh_add_triangle(r->m, corners[0], corners[i], corners[i + 1], r->material);
    }
    return 0;
}

static int read_material(struct reader *r, const char *name)
{
    for (const char *c = name; *c; c++) {
        if (*c < '!' || *c > '~') {
            return line_error(r, "rename it", "the name of a material is not plain ASCII");
        }
    }
    r->material = mesh_material(r->m, name);
    return r->material < TRACE_MATERIALS_MAX
               ? 0
               : line_error(r, "use at most 32 materials with names of up to 31 letters",
                            "no room for this material");
}

static int read_line(struct reader *r, char *line)
{
    line[strcspn(line, "#\r\n")] = '\0';
    char *text = line + strspn(line, " \t");
    const size_t length = strcspn(text, " \t");
    char *rest = text + length + strspn(text + length, " \t");
    const bool is_continued = strlen(rest) > 0 && rest[strlen(rest) - 1] == '\\';
    if (is_continued) {
        return line_error(r, "export it again without broken lines", "a line goes on in the next");
    }
    if (length == 1 && *text == 'v') {
        return read_vertex(r, rest);
    }
    if (length == 1 && *text == 'f') {
        return read_face(r, rest);
    }
    if (length == 6 && strncmp(text, "usemtl", 6) == 0) {
        rest[strcspn(rest, " \t")] = '\0';
        return read_material(r, *rest ? rest : "metal");
    }
    if (strncmp(text, "curv", 4) == 0 || strncmp(text, "surf", 4) == 0) {
        return line_error(r, "convert the model to triangles", "curved surfaces are not read");
    }
    return 0;
}

static int read_lines(struct reader *r, FILE *in)
{
    char *line = NULL;
    size_t capacity = 0;
    int result = 0;
    while (result == 0 && getline(&line, &capacity, in) >= 0) {
        r->line_number++;
        result = read_line(r, line);
    }
    free(line);
    if (result == 0 && ferror(in)) {
        return hs_error(r->path, "check the disk", "cannot be read to its end");
    }
    if (result == 0 && r->m->is_full) {
        return hs_error(r->path, "reduce the model", "more than %d vertices or triangles, or %s",
                        MESH_TRIANGLES_MAX, "too little memory for them");
    }
    if (result == 0 && r->m->triangle_count == 0) {
        return hs_error(r->path, "give a Wavefront OBJ file", "has no faces");
    }
    return result;
}

static int read_open(struct reader *r, FILE *in)
{
    struct stat status;
    if (fstat(fileno(in), &status) != 0 || !S_ISREG(status.st_mode)) {
        return hs_error(r->path, "give a Wavefront OBJ file", "is no ordinary file");
    }
    if (status.st_size > OBJ_BYTES_MAX) {
        return hs_error(r->path, "reduce the model to what is larger than a centimetre",
                        "has %lld MB, more than the %lld that are read",
                        (long long)status.st_size >> 20, OBJ_BYTES_MAX >> 20);
    }
    return read_lines(r, in);
}

int obj_read(struct mesh *m, const char *path, enum obj_up up)
{
    *m = (struct mesh){0};
    FILE *in = hs_input_open(path, "rb");
    if (!in) {
        return hs_error(path, "check the name", "cannot be opened: %s", strerror(errno));
    }
    struct reader r = {.m = m, .path = path, .up = up, .material = mesh_material(m, "metal")};
    const int result = read_open(&r, in);
    fclose(in);
    if (result != 0) {
        mesh_free(m);
    }
    return result;
}

int obj_write(const struct mesh *m, const char *path)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    fputs("# Metres; x ahead, y to the left, z up.\n", file.stream);
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        const struct vec v = m->vertices[i];
        fprintf(file.stream, "v %.17g %.17g %.17g\n", v.x, v.y, v.z);
    }
    uint32_t material = TRACE_MATERIALS_MAX;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        const struct mesh_triangle *t = &m->triangles[i];
        if (t->material != material) {
            material = t->material;
            fprintf(file.stream, "usemtl %s\n", m->materials[material]);
        }
        fprintf(file.stream, "f %u %u %u\n", t->corner[0] + 1, t->corner[1] + 1, t->corner[2] + 1);
    }
    return hs_atomic_commit(&file);
}
