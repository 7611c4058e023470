#include "build/manifest.h"

#include "gis/gdal_start.h"
#include "hs/error.h"
#include "image/sha256.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <inttypes.h>
#include <stdlib.h>

enum { CHUNK_BYTES = 1 << 20 };

void build_manifest_head(FILE *out, const struct build_manifest *m)
{
    static const char *const kinds[] = {"ground", "water", "structure", "trees"};
    fprintf(out,
            "format: landmass flash image, version 3\nbuilder: landmass-db build\nseed: %" PRIu32
            "\n",
            m->seed);
    fputs(m->text_of_options, out);
    for (int i = 0; i < m->table->count; i++) {
        const struct db_class *c = &m->table->items[i];
        fprintf(out, "class: %d %s, %s, gamma %g dB, spread %g dB, height %g m, looks %g\n", i,
                c->name, kinds[c->kind], c->gamma_db, c->spread_db, c->height_m, c->looks);
    }
}

int build_manifest_hash(const char *path, uint64_t *bytes, char digest[IMAGE_SHA256_TEXT])
{
    VSILFILE *file = VSIFOpenL(path, "rb");
    uint8_t *chunk = malloc(CHUNK_BYTES);
    struct image_sha256 sha;
    image_sha256_begin(&sha);
    *bytes = 0;
    size_t got = file && chunk ? VSIFReadL(chunk, 1, CHUNK_BYTES, file) : 0;
    while (got > 0) {
        image_sha256_add(&sha, chunk, got);
        *bytes += got;
        got = VSIFReadL(chunk, 1, CHUNK_BYTES, file);
    }
    image_sha256_end(&sha, digest);
    free(chunk);
    if (file) {
        VSIFCloseL(file);
    }
    return file && chunk ? 0 : -1;
}

int build_manifest_file(FILE *out, const char *role, const char *path)
{
    uint64_t bytes;
    char digest[IMAGE_SHA256_TEXT];
    if (build_manifest_hash(path, &bytes, digest) != 0) {
        return hs_error(path, "check that it is still there", "cannot be read for the manifest");
    }
    fprintf(out, "input: %s %s %" PRIu64 " %s\n", role, CPLGetFilename(path), bytes, digest);
    return 0;
}

int build_manifest_dataset(FILE *out, const char *role, GDALDatasetH dataset)
{
    char **files = GDALGetFileList(dataset);
    int result = 0;
    for (int i = 0; files && files[i] && result == 0; i++) {
        if (db_gdal_is_data(files[i])) {
            result = build_manifest_file(out, role, files[i]);
        }
    }
    CSLDestroy(files);
    return result;
}
