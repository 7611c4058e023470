/* A profile as C. It is apart from print.c because the build runs it on every machine, and print.c
 * needs a driver of Linux. */
#include "bus/print.h"

#include "lm/canas.h"

#include <ctype.h>

/* The enumerator of a field: LM_BUS_TRUE_HEADING for "true-heading". */
static void print_field(FILE *out, uint8_t field)
{
    fprintf(out, "LM_BUS_");
    for (const char *c = lm_bus_fields[field].name; *c != '\0'; c++) {
        fputc(*c == '-' ? '_' : toupper((unsigned char)*c), out);
    }
}

static const char *boolean(bool value)
{
    return value ? "true" : "false";
}

static void print_packing(FILE *out, const struct lm_bus_packing *p)
{
    static const char *const types[] = {"LM_BUS_UNSIGNED", "LM_BUS_SIGNED", "LM_BUS_FLOAT"};
    fprintf(out,
            "        .packing = {.mask = 0x%08X, .bits = {%u, %u}, .match = {%u, %u}, "
            ".match_value = %u,\n"
            "                    .type = %s, .is_little_endian = %s, .is_fast = %s,\n"
            "                    .has_none = %s, .none = 0x%X,\n"
            "                    .multiplier = %d, .shift = %u, .frac_bits = %u, .bias = %lld},\n",
            p->mask, p->bits.first, p->bits.count, p->match.first, p->match.count, p->match_value,
            types[p->type], boolean(p->is_little_endian), boolean(p->is_fast), boolean(p->has_none),
            p->none, p->multiplier, p->shift, p->frac_bits, (long long)p->bias);
}

static void print_types(FILE *out, const struct lm_bus_row *row)
{
    const char *between = "        .types = ";
    for (int type = 0; type < LM_CANAS_TYPES; type++) {
        if (row->types >> type & 1) {
            fprintf(out, "%s1u << %d /* %s */", between, type, lm_canas_types[type].name);
            between = " | ";
        }
    }
    fprintf(out, ", .per_unit = %d,\n", row->per_unit);
}

static void print_row(FILE *out, const struct lm_bus_profile *profile, const struct lm_bus_row *row)
{
    fprintf(out, "    {\n        .name = \"%s\",\n        .id = 0x%X, .field = ", row->name,
            row->id);
    print_field(out, row->field);
    fprintf(out,
            ", .priority = %u,\n"
            "        .stale_ms = %u, .dead_ms = %u, .period_us = %u, .low = %d, .high = %d,\n",
            row->priority, row->stale_ms, row->dead_ms, row->period_us, row->low, row->high);
    if (profile->framing == LM_BUS_PACKED) {
        print_packing(out, &row->packing);
    } else {
        print_types(out, row);
    }
    fprintf(out, "    },\n");
}

void bus_print_c(FILE *out, const struct lm_bus_profile *profile)
{
    fprintf(out,
            "/* Made of a text table by the build: change the table (BUS_TABLE), not this. */\n"
            "/* clang-format off */\n"
            "#include \"lm/bus_profile.h\"\n\nstatic const struct lm_bus_row rows[] = {\n");
    for (int i = 0; i < profile->row_count; i++) {
        print_row(out, profile, &profile->rows[i]);
    }
    fprintf(out,
            "};\n\nconst struct lm_bus_profile lm_bus_generic = {\n    .name = \"%s\",\n"
            "    .rows = rows,\n    .row_count = sizeof rows / sizeof *rows,\n"
            "    .framing = %s,\n    .are_types_assumed = %s,\n"
            "    .channel_mask = 0x%08X,\n    .invalid_mask = 0x%08X,\n};\n",
            profile->name,
            profile->framing == LM_BUS_PACKED ? "LM_BUS_PACKED" : "LM_BUS_CANAEROSPACE",
            boolean(profile->are_types_assumed), profile->channel_mask, profile->invalid_mask);
}
