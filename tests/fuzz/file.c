#include "fuzz.h"

#include <sys/mman.h>
#include <unistd.h>

/* Files are kept: to make one takes longer than most readers need for an input. */
enum { KEPT = 2 };
static struct fuzz_file kept[KEPT];
static int kept_count;

void fuzz_file_open(struct fuzz_file *f, const uint8_t *data, size_t size)
{
    if (kept_count > 0) {
        *f = kept[--kept_count];
    } else {
        f->size = 0;
        f->descriptor = memfd_create("input", MFD_CLOEXEC);
        FUZZ_ASSERT(f->descriptor >= 0);
        snprintf(f->path, sizeof f->path, "/proc/self/fd/%d", f->descriptor);
    }
    FUZZ_ASSERT(pwrite(f->descriptor, data, size, 0) == (ssize_t)size);
    FUZZ_ASSERT(size >= f->size || ftruncate(f->descriptor, (off_t)size) == 0);
    f->size = size;
}

void fuzz_file_close(struct fuzz_file *f)
{
    if (kept_count < KEPT) {
        kept[kept_count++] = *f;
    } else {
        close(f->descriptor);
    }
}
