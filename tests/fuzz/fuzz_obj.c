/* A model: what is accepted has finite corners, triangles between corners that are there, and can
 * be audited. */
#include "fuzz.h"
#include "tracer/mesh_audit.h"
#include "tracer/obj_file.h"

#include <math.h>

const uint32_t fuzz_mutations = 15000;

static void check_mesh(const struct mesh *m)
{
    FUZZ_ASSERT(!m->is_full && m->triangle_count > 0);
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        const struct vec v = m->vertices[i];
        FUZZ_ASSERT(isfinite(v.x) && isfinite(v.y) && isfinite(v.z));
    }
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        for (int k = 0; k < 3; k++) {
            FUZZ_ASSERT(m->triangles[i].corner[k] < m->vertex_count);
        }
        FUZZ_ASSERT(m->triangles[i].material < m->material_count);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_file file;
    struct mesh m;
    struct mesh_audit audit;
    fuzz_file_open(&file, data, size);
    if (obj_read(&m, file.path, OBJ_UP_Y) == 0) {
        check_mesh(&m);
        FUZZ_ASSERT(mesh_audit(&m, file.path, &audit) == 0);
        mesh_require_closed(&audit, file.path);
        FUZZ_ASSERT(mesh_drop_degenerate(&m) == audit.degenerate);
        mesh_free(&m);
    }
    fuzz_file_close(&file);
    return 0;
}
