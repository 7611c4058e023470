/* Large blocks for the fuzz targets, in place of malloc's (linked by --wrap; fuzz.mk). The address
 * sanitizer maps and shades each block of 128 KiB and more anew, which for structs of some
 * megabytes costs more than all that an input does with them. Here a block is kept for the next;
 * of one of more than 512 KiB, the pages that were touched are given back.
 *
 * What is found stays the same: each block has poisoned memory on both sides, a freed one cannot be
 * touched, and one that is freed twice aborts. A leak is seen once it has used up the places here.
 */
#include "fuzz.h"

#include <sanitizer/asan_interface.h>
#include <sanitizer/lsan_interface.h>
#include <sys/mman.h>

#define LARGE_BYTES ((size_t)128 << 10) /* smaller ones are the sanitizer's */
#define DENSE_BYTES ((size_t)512 << 10) /* these are mostly written all over: quicker to clear */
#define PLACE_BYTES ((size_t)256 << 20) /* so are those that do not fit */

enum { PLACES = 32, PAGE = 4096, FILLED = 4096, FILLING = 0xbe };

const char *__asan_default_options(void);
size_t __sanitizer_get_allocated_size(const volatile void *block); /* gcc has no header for it */
void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void __real_free(void *block);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);
void __wrap_free(void *block);

/* What is freed is kept from use for a mebibyte, not for 256 of them, which no cache would hold. To
 * see who allocated a block, repeat a finding with ASAN_OPTIONS=malloc_context_size=30. The tests
 * have options of their own (standalone.c). */
__attribute__((weak)) const char *__asan_default_options(void)
{
    return "quarantine_size_mb=1:thread_local_quarantine_size_kb=64:malloc_context_size=2:"
           "allocator_release_to_os_interval_ms=-1";
}

/* A place begins with a poisoned page; the block follows; then at least a page is poisoned. */
static uint8_t *places;
static struct place {
    size_t size; /* of its last block; 0: none yet */
    bool is_used;
} place[PLACES];

static size_t whole_pages(size_t bytes)
{
    return (bytes + PAGE - 1) / PAGE * PAGE;
}

static uint8_t *block_of(size_t i)
{
    return places + i * PLACE_BYTES + PAGE;
}

/* The place of a block; PLACES: it is the sanitizer's. */
static size_t place_of(const void *block)
{
    const uintptr_t at = (uintptr_t)block - (uintptr_t)places;
    return places && at < PLACES * PLACE_BYTES ? at / PLACE_BYTES : PLACES;
}

static void begin(void)
{
    if (!places) {
        void *all = mmap(NULL, PLACES * PLACE_BYTES, PROT_NONE,
                         MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        FUZZ_ASSERT(all != MAP_FAILED);
        madvise(all, PLACES * PLACE_BYTES, MADV_NOHUGEPAGE);
        places = all;
    }
}

static void set_edges(size_t i, size_t size)
{
    uint8_t *block = block_of(i);
    if (place[i].size != 0) {
        const size_t old = place[i].size;
        ASAN_UNPOISON_MEMORY_REGION(block + old, whole_pages(old) + PAGE - old);
    }
    ASAN_POISON_MEMORY_REGION(block - PAGE, PAGE);
    ASAN_POISON_MEMORY_REGION(block + size, whole_pages(size) + PAGE - size);
    place[i].size = size;
}

/* A free place: best one whose last block had the same size. */
static size_t find(size_t size)
{
    size_t found = PLACES;
    for (size_t i = 0; i < PLACES && (found == PLACES || place[found].size != size); i++) {
        if (!place[i].is_used) {
            found = i;
        }
    }
    return found;
}

static void *take(size_t size)
{
    if (size < LARGE_BYTES || size > PLACE_BYTES - 3 * PAGE) {
        return NULL;
    }
    begin();
    const size_t i = find(size);
    if (i == PLACES) {
        return NULL;
    }
    uint8_t *block = block_of(i);
    if (place[i].size != size) {
        set_edges(i, size);
    }
    FUZZ_ASSERT(mprotect(block, whole_pages(size), PROT_READ | PROT_WRITE) == 0);
    __lsan_register_root_region(block, size);
    place[i].is_used = true;
    return block;
}

void *__wrap_malloc(size_t size)
{
    void *block = take(size);
    return block ? memset(block, FILLING, FILLED) : __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
    size_t bytes;
    void *block = __builtin_mul_overflow(count, size, &bytes) ? NULL : take(bytes);
    if (block && bytes <= DENSE_BYTES) {
        memset(block, 0, bytes);
    }
    return block ? block : __real_calloc(count, size);
}

void __wrap_free(void *block)
{
    const size_t i = place_of(block);
    if (i == PLACES) {
        __real_free(block);
        return;
    }
    FUZZ_ASSERT(place[i].is_used && block == block_of(i));
    const size_t bytes = whole_pages(place[i].size);
    __lsan_unregister_root_region(block, place[i].size);
    FUZZ_ASSERT(place[i].size <= DENSE_BYTES || madvise(block, bytes, MADV_DONTNEED) == 0);
    FUZZ_ASSERT(mprotect(block, bytes, PROT_NONE) == 0);
    place[i].is_used = false;
}

void *__wrap_realloc(void *old, size_t size)
{
    const size_t i = place_of(old);
    if (i == PLACES && (!old || size < LARGE_BYTES)) {
        return __real_realloc(old, size);
    }
    const size_t had = i == PLACES ? __sanitizer_get_allocated_size(old) : place[i].size;
    void *block = __wrap_malloc(size);
    if (block) {
        memcpy(block, old, size < had ? size : had);
        __wrap_free(old);
    }
    return block;
}
