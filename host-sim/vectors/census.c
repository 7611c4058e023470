#include "vectors/census.h"

#include "hs/error.h"
#include "hs/report.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>

static const char *const kind_names[VECTOR_KINDS] = {"nodes", "ways", "relations", "features"};

static const char *const fate_names[VECTOR_FATES] = {"made",
                                                     "without tags",
                                                     "no rule fits",
                                                     "left out by a rule",
                                                     "outside the area",
                                                     "in a relation",
                                                     "narrower than half a cell",
                                                     "repeated",
                                                     "lost: parts not in the file",
                                                     "lost: ring is open",
                                                     "lost: nothing left of it"};

/* Key of the report. */
static const char *const fate_keys[VECTOR_FATES] = {
    "made",          "without_tags",   "no_rule_fits",     "left_out",
    "outside",       "in_a_relation",  "too_narrow",       "repeated",
    "lost_dangling", "lost_open_ring", "lost_nothing_left"};

static void report_kind(const struct vector_census *c, int kind)
{
    hs_report_object(kind_names[kind]);
    hs_report_put("read", c->read[kind]);
    for (int fate = 0; fate < VECTOR_FATES; fate++) {
        hs_report_put(fate_keys[fate], c->fates[kind][fate]);
    }
    hs_report_close();
}

void vector_census_report(const struct vector_census *c, const char *name)
{
    hs_report_object(NULL);
    hs_report_put("path", name);
    for (int kind = 0; kind < VECTOR_KINDS; kind++) {
        if (c->read[kind] > 0) {
            report_kind(c, kind);
        }
    }
    hs_report_put("shortened", c->shortened);
    hs_report_put("holed", c->holed);
    hs_report_put("repaired", c->repaired);
    hs_report_put("missing_nodes", c->missing);
    hs_report_put("out_of_order", c->late);
    hs_report_close();
}

static void print_note(const char *name, uint64_t count, const char *what)
{
    if (count > 0) {
        printf("%s: %" PRIu64 " %s\n", name, count, what);
    }
}

void vector_census_print(const struct vector_census *c, const char *name)
{
    for (int kind = 0; kind < VECTOR_KINDS; kind++) {
        if (c->read[kind] == 0) {
            continue;
        }
        printf("%s: %" PRIu64 " %s\n", name, c->read[kind], kind_names[kind]);
        for (int fate = 0; fate < VECTOR_FATES; fate++) {
            if (c->fates[kind][fate] > 0) {
                printf("    %-28s %10" PRIu64 "\n", fate_names[fate], c->fates[kind][fate]);
            }
        }
    }
    print_note(name, c->shortened, "lines lack nodes; the pieces that are there were made");
    print_note(name, c->holed, "areas lack a ring; the others were made");
    print_note(name, c->repaired, "areas crossed themselves and were made valid");
    print_note(name, c->missing, "references lead to nodes that are not in the file");
    print_note(name, c->late, "elements stand out of order");
}

int vector_census_check(const struct vector_census *c, const char *name)
{
    for (int kind = 0; kind < VECTOR_KINDS; kind++) {
        uint64_t sum = 0;
        for (int fate = 0; fate < VECTOR_FATES; fate++) {
            sum += c->fates[kind][fate];
        }
        if (sum != c->read[kind]) {
            return hs_error(name, "report this as a fault of landmass-db",
                            "has %" PRIu64 " %s, but %" PRIu64 " are accounted for", c->read[kind],
                            kind_names[kind], sum);
        }
    }
    return 0;
}

void vector_census_warn(const struct vector_census *c, const char *name)
{
    uint64_t lost = 0;
    for (int kind = 0; kind < VECTOR_KINDS; kind++) {
        for (int fate = VECTOR_FIRST_LOSS; fate < VECTOR_FATES; fate++) {
            lost += c->fates[kind][fate];
        }
    }
    if (lost > 0) {
        hs_warn(name, "get an extract with complete ways and relations",
                "%" PRIu64 " elements that a rule fits were lost: the table says why", lost);
    }
}
