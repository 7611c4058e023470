#include "signature.h"

#include "hs/error.h"
#include "hs/progress.h"
#include "hs/report.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static int read_mapped(void *ctx, uint64_t offset, void *to, uint32_t bytes)
{
    memcpy(to, (const uint8_t *)ctx + offset, bytes);
    return 0;
}

static struct trust_reader reader_of(const struct image *image)
{
    return (struct trust_reader){(void *)(uintptr_t)image->bytes, image->size_bytes, read_mapped};
}

static const char *word_of(enum trust_verdict verdict, bool has_keys)
{
    switch (verdict) {
    case TRUST_GOOD:
        return "trusted";
    case TRUST_FOREIGN:
        return has_keys ? "foreign" : "fits";
    case TRUST_UNSIGNED:
        return "none";
    default:
        return "broken";
    }
}

static void tell(const struct trust_result *r, bool has_keys, const char *remark)
{
    char fingerprint[TRUST_FINGERPRINT_TEXT];
    trust_fingerprint(r->key, fingerprint);
    hs_report_object("signature");
    hs_report_text("state", word_of(r->verdict, has_keys));
    if (r->is_sealed) {
        hs_report_count("serial", r->serial);
        hs_report_text("key_sha256", fingerprint);
        printf("signature       %s%s; serial %" PRIu64 ", key %s\n", word_of(r->verdict, has_keys),
               remark, r->serial, fingerprint);
    } else {
        printf("signature       %s\n", word_of(r->verdict, has_keys));
    }
    hs_report_close();
}

void db_signature_print(const struct image *image)
{
    static const struct trust_keys none;
    const struct trust_reader reader = reader_of(image);
    struct trust_result r;
    const enum trust_verdict verdict = trust_identify(&reader, &none, &r);
    tell(&r, false, verdict == TRUST_FOREIGN ? " header and seal, `verify` checks the rest" : "");
}

static bool show(void *ctx, uint64_t done_bytes, uint64_t all_bytes)
{
    (void)all_bytes;
    hs_progress_update(ctx, done_bytes);
    return true;
}

int db_signature_check(const struct image *image, const char *path, const char *key_path)
{
    const struct trust_reader reader = reader_of(image);
    struct trust_keys keys = {0};
    struct trust_result r;
    struct hs_progress progress;
    if (key_path && trust_keys_load(&keys, key_path) != 0) {
        return -1;
    }
    hs_progress_begin(&progress, "checking the signature", image->size_bytes);
    const enum trust_verdict verdict = trust_verify(&reader, &keys, show, &progress, &r);
    hs_progress_end(&progress);
    if (verdict == TRUST_NO_IMAGE && !key_path) {
        return 0; /* what is wrong with it has been said */
    }
    tell(&r, key_path != NULL,
         verdict == TRUST_FOREIGN && !key_path ? "; --key tells whether it is to be trusted" : "");
    if (verdict == TRUST_GOOD || (!key_path && verdict == TRUST_FOREIGN) ||
        (!key_path && verdict == TRUST_UNSIGNED)) {
        return 0;
    }
    return hs_error(path, trust_remedy(verdict), "%s, at offset %" PRIu64, r.cause, r.offset);
}
