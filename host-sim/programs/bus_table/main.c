/* bus_table TABLE FILE: the profile that the text table TABLE describes, as C, for the build to
 * compile (make/generated.mk). FILE is replaced whole, or left alone if anything fails. */
#include "bus/print.h"
#include "bus/table_text.h"
#include "hs/atomic_file.h"
#include "hs/error.h"

int main(int argc, char **argv)
{
    static struct bus_table table;
    struct hs_atomic_file file;
    hs_set_program("bus_table");
    if (argc != 3) {
        hs_error("command line", NULL, "expected TABLE FILE");
        return HS_EXIT_USAGE;
    }
    if (bus_table_load(&table, argv[1]) != 0 || hs_atomic_open(&file, argv[2]) != 0) {
        return HS_EXIT_FAILED;
    }
    bus_print_c(file.stream, &table.profile);
    return hs_atomic_commit(&file) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
