#include "fuzz.h"

#include <sys/mman.h>
#include <unistd.h>

void fuzz_file_open(struct fuzz_file *f, const uint8_t *data, size_t size)
{
    f->descriptor = memfd_create("input", MFD_CLOEXEC);
    FUZZ_ASSERT(f->descriptor >= 0);
    FUZZ_ASSERT(write(f->descriptor, data, size) == (ssize_t)size);
    snprintf(f->path, sizeof f->path, "/proc/self/fd/%d", f->descriptor);
}

void fuzz_file_close(struct fuzz_file *f)
{
    close(f->descriptor);
}
