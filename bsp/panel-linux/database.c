#include "database.h"

#include "hs/real_time.h"
#include "report.h"
#include "trust/serial.h"
#include "trust/verify.h"

#include <inttypes.h>
#include <signal.h>
#include <string.h>
#include <time.h>

static uint64_t monotonic_ms(void)
{
    return (uint64_t)hs_clock_us(CLOCK_MONOTONIC) / 1000u;
}

/* Signals are blocked and wait for the loop; but it has not begun yet. */
static bool goes_on(void *ctx, uint64_t done_bytes, uint64_t all_bytes)
{
    sigset_t pending;
    const atomic_bool *is_over = ctx;
    (void)done_bytes;
    (void)all_bytes;
    return (is_over == NULL || !atomic_load(is_over)) &&
           (sigpending(&pending) != 0 ||
            (!sigismember(&pending, SIGTERM) && !sigismember(&pending, SIGINT) &&
             !sigismember(&pending, SIGHUP)));
}

/* May an image of this serial number be flown after those that were? */
static bool is_newer(const struct config *c, uint64_t serial)
{
    uint64_t flown = 0;
    const int cause =
        c->database_serial[0] != '\0' ? trust_serial_read(c->database_serial, &flown) : 0;
    if (cause != 0) {
        report(REPORT_WARNING, "%s: %s; which serial number was flown is not known",
               c->database_serial, strerror(cause));
    }
    if (serial >= flown) {
        return true;
    }
    const bool is_flown = c->database_older != 0;
    report(is_flown ? REPORT_WARNING : REPORT_ERROR,
           "%s: its serial number is %" PRIu64 ", and %" PRIu64 " was flown; %s", c->database,
           serial, flown,
           is_flown ? "flown, as database.older says"
                    : "sign it with a higher one, or set database.older = fly");
    return is_flown;
}

/* Remember what is flown. A number that goes back is remembered, too: it was allowed. */
static void remember(const struct config *c, uint64_t serial)
{
    uint64_t flown = 0;
    if (c->database_serial[0] == '\0' ||
        (trust_serial_read(c->database_serial, &flown) == 0 && flown == serial)) {
        return;
    }
    const int cause = trust_serial_write(c->database_serial, serial);
    if (cause != 0) {
        report(REPORT_WARNING, "%s: %s; the serial number that is flown is not remembered",
               c->database_serial, strerror(cause));
    }
}

static struct database judge_good(const struct config *c, const struct trust_result *r, uint64_t ms,
                                  bool is_check)
{
    char fingerprint[TRUST_FINGERPRINT_TEXT];
    const bool is_flown = is_newer(c, r->serial);
    trust_fingerprint(r->key, fingerprint);
    report(REPORT_INFO,
           "%s: signed by key %.16s, serial number %" PRIu64 "; %" PRIu64
           " bytes checked in %" PRIu64 " ms",
           c->database, fingerprint, r->serial, r->image_bytes, ms);
    if (is_flown && !is_check) {
        remember(c, r->serial);
    }
    return (struct database){.is_flown = is_flown};
}

/* An image that no key vouches for. */
static struct database judge_unknown(const struct config *c, const struct trust_result *r)
{
    const bool is_any = c->database_trust != 0;
    if (is_any) {
        report(REPORT_WARNING, "%s: %s; flown, as database.trust says: the glass says UNSIGNED",
               c->database, r->cause);
    } else if (r->verdict == TRUST_UNSIGNED || c->database_key[0] == '\0') {
        report(REPORT_ERROR,
               "%s: %s; `landmass-db sign` signs it, database.key names the key; or set "
               "database.trust = any",
               c->database,
               c->database_key[0] == '\0' ? "no database.key vouches for it" : r->cause);
    } else {
        report(REPORT_ERROR, "%s: %s; %s", c->database, r->cause, trust_remedy(r->verdict));
    }
    return (struct database){.is_flown = is_any, .is_unsigned = is_any};
}

struct database database_judge(const struct config *c, const struct lm_flash *flash, bool is_check,
                               const atomic_bool *is_over)
{
    struct trust_reader reader;
    struct trust_keys keys = {0};
    struct trust_result r;
    trust_reader_of_flash(&reader, flash);
    const bool has_keys =
        c->database_key[0] == '\0' || trust_keys_load(&keys, c->database_key) == 0;
    if (!has_keys && c->database_trust == 0) {
        return (struct database){0};
    }
    const uint64_t start_ms = monotonic_ms();
    switch (trust_verify(&reader, &keys, goes_on, (void *)is_over, &r)) {
    case TRUST_GOOD:
        return judge_good(c, &r, monotonic_ms() - start_ms, is_check);
    case TRUST_UNSIGNED:
    case TRUST_FOREIGN:
        return judge_unknown(c, &r);
    case TRUST_NO_IMAGE:
        return (struct database){.is_flown = true};
    default:
        report(REPORT_ERROR, "%s: %s, at offset %" PRIu64 "; %s", c->database, r.cause, r.offset,
               trust_remedy(r.verdict));
        return (struct database){0};
    }
}
