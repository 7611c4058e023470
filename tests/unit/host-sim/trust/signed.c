#include "signed.h"

#include "check.h"
#include "fx/crc32c.h"
#include "support.h"
#include "tiny_image.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { PATH_BYTES = 512, PATHS = 4 };

const char *signed_path(const char *name)
{
    static char paths[PATHS][PATH_BYTES];
    static int next;
    char *path = paths[next++ % PATHS];
    snprintf(path, PATH_BYTES, "%s/tmp/trust/%s", support_build_dir(), name);
    return path;
}

void signed_run(const char *command)
{
    char line[2048];
    snprintf(line, sizeof line, "cd %s && %s", signed_path(""), command);
    if (system(line) != 0) {
        fail_msg("failed: %s", command);
    }
}

uint8_t *signed_read(const char *name, size_t *size)
{
    struct stat status;
    FILE *file = fopen(signed_path(name), "rb");
    assert_non_null(file);
    assert_int_equal(fstat(fileno(file), &status), 0);
    *size = (size_t)status.st_size;
    uint8_t *bytes = malloc(*size + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

void signed_write(const char *name, const void *bytes, size_t size)
{
    FILE *file = fopen(signed_path(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static int read_memory(void *ctx, uint64_t offset, void *to, uint32_t bytes)
{
    memcpy(to, (const uint8_t *)ctx + offset, bytes);
    return 0;
}

enum trust_verdict signed_judge(const uint8_t *bytes, size_t size, const char *key,
                                struct trust_result *r)
{
    const struct trust_reader reader = {(void *)(uintptr_t)bytes, size, read_memory};
    struct trust_keys keys = {0};
    assert_int_equal(trust_keys_load(&keys, signed_path(key)), 0);
    return trust_verify(&reader, &keys, NULL, NULL, r);
}

const struct lm_image_section *signed_section(const uint8_t *bytes, uint32_t type)
{
    const struct lm_image_header *h = (const void *)bytes;
    for (uint32_t i = 0; i < h->section_count && i < LM_IMAGE_SECTIONS_MAX; i++) {
        if (h->sections[i].type == type) {
            return &h->sections[i];
        }
    }
    return NULL;
}

void signed_repair(uint8_t *bytes)
{
    struct lm_image_header *h = (void *)bytes;
    struct lm_image_section *s = (void *)(uintptr_t)signed_section(bytes, LM_IMAGE_SEAL);
    s->crc = fx_crc32c(0, bytes + s->offset, s->bytes);
    h->crc = fx_crc32c(0, h, offsetof(struct lm_image_header, crc));
}

/* What the sections hold does not matter to a signature, but that none is of a length that leaves
 * no gap behind it, and that one has a type of a later version. */
static void write_image(void)
{
    static const uint32_t types[] = {
        LM_IMAGE_TARGETS, LM_IMAGE_SIGNATURES, LM_IMAGE_GEOID,       LM_IMAGE_DETAIL,
        LM_IMAGE_RADAR,   LM_IMAGE_BUS,        LM_IMAGE_GEOID_PAGES, 77};
    const struct tiny_spec spec = tiny_spec_at(46, 11);
    struct tiny_image image;
    uint8_t bytes[700];
    assert_int_equal(tiny_image_build(&image, &spec), 0);
    for (uint32_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        memset(bytes, (int)(i + 1), sizeof bytes);
        assert_int_equal(tiny_image_add_section(&image, types[i], bytes, 601 + 7 * i), 0);
    }
    assert_int_equal(tiny_image_write(&image, signed_path("image.lmdb")), 0);
    tiny_image_free(&image);
}

int signed_open(void **state)
{
    char command[2 * PATH_BYTES];
    (void)state;
    snprintf(command, sizeof command, "rm -rf %s && mkdir -p %s", signed_path(""), signed_path(""));
    assert_int_equal(system(command), 0);
    write_image();
    signed_run(
        "for k in a b; do openssl genpkey -algorithm ed25519 -out $k.pem && "
        "openssl pkey -in $k.pem -pubout -out $k.pub || exit 1; done");
    struct trust_signer signer;
    assert_int_equal(trust_signer_load(&signer, signed_path("a.pem"), NULL), 0);
    assert_int_equal(
        trust_sign_image(signed_path("image.lmdb"), signed_path("signed.lmdb"), &signer, 7), 0);
    trust_signer_forget(&signer);
    return 0;
}
