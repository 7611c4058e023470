/* landmass-tables: the constant tables of fixed/ and firmware/, as C. */
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "tables/tables.h"

#include <errno.h>
#include <string.h>

static void print_help(void)
{
    printf(
        "usage: landmass-tables SET [FILE]\n\n"
        "Write the constant tables of SET as C source to FILE, or to the standard output.\n"
        "A FILE that stands already is replaced whole, or left alone if anything fails.\n\n"
        "Sets, and where the build puts them, below build/<board>/gen:\n");
    for (int i = 0; i < table_set_count; i++) {
        printf("  %-10s %s\n", table_sets[i].name, table_sets[i].file);
    }
}

static int print_to_stdout(const struct table_set *set)
{
    if (table_set_print(stdout, set) != 0) {
        return HS_EXIT_FAILED;
    }
    if (fflush(stdout) != 0) {
        hs_error("standard output", "make room, or name a FILE elsewhere", "%s", strerror(errno));
        return HS_EXIT_FAILED;
    }
    return HS_EXIT_OK;
}

static int print_to_file(const struct table_set *set, const char *path)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return HS_EXIT_FAILED;
    }
    if (table_set_print(file.stream, set) != 0) {
        hs_atomic_abort(&file);
        return HS_EXIT_FAILED;
    }
    return hs_atomic_commit(&file) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}

int main(int argc, char **argv)
{
    hs_set_program("landmass-tables");
    if (argc == 2 && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)) {
        print_help();
        return HS_EXIT_OK;
    }
    if (argc < 2 || argc > 3) {
        hs_error("command line", "try landmass-tables --help", "expected SET [FILE]");
        return HS_EXIT_USAGE;
    }
    const struct table_set *set = table_set_find(argv[1]);
    if (set == NULL) {
        hs_error(argv[1], "landmass-tables --help lists the sets", "there is no such set");
        return HS_EXIT_USAGE;
    }
    return argc == 2 ? print_to_stdout(set) : print_to_file(set, argv[2]);
}
