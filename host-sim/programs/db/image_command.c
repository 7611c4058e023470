#include "image_command.h"

#include "hs/error.h"
#include "hs/input_file.h"

#include <string.h>

bool image_command_read(const struct db_usage *usage, const struct db_option *options, size_t count,
                        int argc, char **argv, const char **path, int *exit_code)
{
    const bool has_file = argc > 1 && strncmp(argv[1], "--", 2) != 0;
    *path = has_file ? argv[1] : NULL;
    if (has_file) {
        hs_input_note(*path);
    }
    if (!db_options_read(usage, options, count, has_file ? argc - 1 : argc,
                         has_file ? argv + 1 : argv, exit_code)) {
        return false;
    }
    if (!has_file) {
        hs_error(argv[0], "see `landmass-db --help`", "needs the image FILE before its options");
        *exit_code = HS_EXIT_USAGE;
    }
    return has_file;
}
