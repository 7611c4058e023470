/* The database that is loaded, as a file. */
#include "commands.h"

#include "hs/error.h"
#include "hs/input_file.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static const char stick_name[] = "landmass.lmdb";

int load_file_open(struct load_file *f)
{
    struct stat about;
    if (stat(f->name, &about) == 0 && S_ISDIR(about.st_mode)) {
        if (snprintf(f->in_folder, sizeof f->in_folder, "%s/%s", f->name, stick_name) >=
            (int)sizeof f->in_folder) {
            return hs_error(f->name, "choose a shorter one", "the path is too long");
        }
        f->name = f->in_folder;
    }
    const int cause = drv_flash_file_open(&f->flash, f->name);
    if (cause != 0) {
        return hs_error(f->name, "check the name", "cannot be read: %s", strerror(cause));
    }
    hs_input_note(f->name);
    return 0;
}

int load_file_check(struct load_file *f, slot_progress *progress, void *ctx)
{
    struct slot_fault fault;
    return slot_check(&f->flash.port, SLOT_RECORDS, progress, ctx, &fault) == 0
               ? 0
               : hs_error(f->name,
                          "nothing was written; `landmass-db verify` lists what is wrong, "
                          "`landmass-db build` makes it again",
                          "offset 0x%" PRIx64 ": %s", fault.offset, fault.cause);
}
