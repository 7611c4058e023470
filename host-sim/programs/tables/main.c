/* landmass-tables: the constant tables of fixed/ and firmware/, as C. */
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/menu.h"
#include "hs/options.h"
#include "tables/tables.h"

#include <errno.h>
#include <string.h>

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

/* Print the set that argv[0] names. */
static int run(int argc, char **argv)
{
    const struct table_set *set = table_set_find(argv[0]);
    const struct hs_usage usage = {
        set->name, "constant tables as C source",
        "The build makes them so, below build/<board>/gen. A FILE that stands already is replaced "
        "whole, or left alone if anything fails."};
    const char *path = NULL;
    int exit_code;
    const struct hs_option options[] = {
        {"FILE", HS_OUTPUT_ARGUMENT, &path, 0, 0, NULL, "left out: standard output", false},
    };
    if (!hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    return path ? print_to_file(set, path) : print_to_stdout(set);
}

enum { SETS_MAX = 16 };

int main(int argc, char **argv)
{
    struct hs_command commands[SETS_MAX];
    for (int i = 0; i < table_set_count && i < SETS_MAX; i++) {
        commands[i] = (struct hs_command){table_sets[i].name, table_sets[i].file, run};
    }
    const struct hs_menu menu = {.program = "landmass-tables",
                                 .purpose = "the constant tables of fixed/ and firmware/, as C",
                                 .commands = commands,
                                 .count = table_set_count < SETS_MAX ? table_set_count : SETS_MAX};
    return hs_menu_main(&menu, argc, argv);
}
