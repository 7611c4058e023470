/* Whose signature is accepted. */
#include "commands.h"

#include "hs/error.h"
#include "hs/report.h"
#include "trust/serial.h"
#include "trust/verify.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* A step back in serial numbers is refused here, as the panel would refuse it. */
static int accept_serial(const struct slot_places *c, const char *path, uint64_t serial)
{
    uint64_t flown = 0;
    const int cause = c->serial[0] != '\0' ? trust_serial_read(c->serial, &flown) : 0;
    if (cause != 0) {
        hs_warn(c->serial, NULL, "%s; which serial number was flown is not known", strerror(cause));
    }
    if (serial < flown && !c->is_older) {
        return hs_error(path, "sign it with a higher one, or set database.older = fly",
                        "its serial number is %" PRIu64 ", and %" PRIu64 " was flown", serial,
                        flown);
    }
    return 0;
}

static int accept_good(const struct slot_places *c, const char *path, const struct trust_result *r,
                       enum load_length length)
{
    char fingerprint[TRUST_FINGERPRINT_TEXT];
    if (length == LOAD_FULL) {
        trust_fingerprint(r->key, fingerprint);
        printf("signed by key %.16s, serial number %" PRIu64 "\n", fingerprint, r->serial);
        hs_report_text("key", fingerprint);
        hs_report_count("serial", r->serial);
    }
    return accept_serial(c, path, r->serial);
}

int load_accept(const struct slot_places *c, const char *path, const struct lm_flash *flash,
                enum load_length length)
{
    struct trust_reader reader;
    trust_reader_of_flash(&reader, flash);
    struct trust_keys keys = {0};
    struct trust_result r;
    if (c->key[0] != '\0' && trust_keys_load(&keys, c->key) != 0 && !c->is_any) {
        return -1;
    }
    const enum trust_verdict verdict = length == LOAD_FULL
                                           ? trust_verify(&reader, &keys, NULL, NULL, &r)
                                           : trust_identify(&reader, &keys, &r);
    if (verdict == TRUST_GOOD) {
        return accept_good(c, path, &r, length);
    }
    if (verdict != TRUST_UNSIGNED && verdict != TRUST_FOREIGN) {
        return hs_error(path, trust_remedy(verdict), "offset 0x%" PRIx64 ": %s", r.offset, r.cause);
    }
    if (!c->is_any) {
        return hs_error(path,
                        "`landmass-db sign` signs it, database.key names the key; or --unsigned, "
                        "which the panel flies with database.trust = any",
                        "%s", r.cause);
    }
    return length == LOAD_FULL ? hs_warn(path, NULL, "%s; the glass will say UNSIGNED", r.cause)
                               : 0;
}
