#include "hs/error.h"
#include "tables/tables.h"

#include <stdlib.h>
#include <string.h>

const struct table_set *table_set_find(const char *name)
{
    for (int i = 0; i < table_set_count; i++) {
        if (strcmp(table_sets[i].name, name) == 0) {
            return &table_sets[i];
        }
    }
    return NULL;
}

/* Whether `value` is a number of the C type "intN_t" or "uintN_t", N = 8, 16 or 32. */
static int fits(const char *type, int64_t value)
{
    const int is_unsigned = type[0] == 'u';
    const int bits = atoi(type + (is_unsigned ? 4 : 3));
    const int64_t span = (int64_t)1 << (is_unsigned ? bits : bits - 1);
    return value < span && value >= (is_unsigned ? 0 : -span);
}

static int print_row(FILE *out, const struct table *t, int row)
{
    const int per_line = strstr(t->type, "32") != NULL ? 8 : 12;
    for (int i = 0; i < t->columns; i++) {
        const int64_t value = t->entry(row, i);
        if (!fits(t->type, value)) {
            return hs_error(t->name, "choose another format or type",
                            "entry %d is %lld, which is no %s", i, (long long)value, t->type);
        }
        fprintf(out, "%s%lld%s,", i % per_line == 0 ? "\n    " : " ", (long long)value,
                t->type[0] == 'u' ? "u" : "");
    }
    return 0;
}

static int print_table(FILE *out, const struct table *t)
{
    fprintf(out, "\n/* %s */\nconst %s %s", t->content, t->type, t->name);
    if (t->rows > 0) {
        fprintf(out, "[%d]", t->rows);
    }
    fprintf(out, "[%d] = {", t->columns);
    if (t->rows == 0) {
        if (print_row(out, t, 0) != 0) {
            return -1;
        }
    }
    for (int row = 0; row < t->rows; row++) {
        fprintf(out, "\n{");
        if (print_row(out, t, row) != 0) {
            return -1;
        }
        fprintf(out, "\n},");
    }
    fprintf(out, "\n};\n");
    return 0;
}

int table_set_print(FILE *out, const struct table_set *set)
{
    fprintf(out,
            "/* Made by the build: landmass-tables %s. Change the formula (host-sim/tables), not "
            "this. */"
            "\n/* clang-format off */\n#include \"%s\"\n",
            set->name, set->header);
    for (int i = 0; i < set->table_count; i++) {
        if (print_table(out, &set->tables[i]) != 0) {
            return -1;
        }
    }
    return 0;
}
