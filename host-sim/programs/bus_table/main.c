/* bus_table TABLE FILE: the profile that the text table TABLE describes, as C, for the build to
 * compile (make/generated.mk). FILE is replaced whole, or left alone if anything fails. */
#include "bus/print.h"
#include "bus/table_text.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/input_file.h"

#include <errno.h>
#include <string.h>

static int read_table(struct bus_table *table, const char *path)
{
    FILE *in = hs_input_open(path, "r");
    if (in == NULL) {
        return hs_error(path, "BUS_TABLE of board.mk names it", "cannot be opened: %s",
                        strerror(errno));
    }
    const int status = bus_table_read(table, in, path);
    fclose(in);
    return status;
}

int main(int argc, char **argv)
{
    static struct bus_table table;
    struct hs_atomic_file file;
    hs_set_program("bus_table");
    if (argc != 3) {
        hs_error("command line", NULL, "expected TABLE FILE");
        return HS_EXIT_USAGE;
    }
    if (read_table(&table, argv[1]) != 0 || hs_atomic_open(&file, argv[2]) != 0) {
        return HS_EXIT_FAILED;
    }
    bus_print_c(file.stream, &table.profile);
    return hs_atomic_commit(&file) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
