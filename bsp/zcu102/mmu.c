#include "mmu.h"

#include "sections.h"

#include <stddef.h>
#include <stdint.h>

/* Descriptors of stage 1 with 4 KiB pages (DDI 0487, D5.3). */
enum {
    TABLE = 3,
    BLOCK = 1,
    PAGE = 3,
    MAIR_CACHED = 0 << 2, /* the indices of MAIR_EL1 in start.S */
    MAIR_NOT_CACHED = 1 << 2,
    MAIR_DEVICE = 2 << 2,
    READ_ONLY = 1 << 7,
    SHAREABLE = 3 << 8, /* inner */
    ACCESSED = 1 << 10
};
#define NEVER_RUN (UINT64_C(3) << 53) /* PXN, UXN */

#define CODE      (MAIR_CACHED | READ_ONLY | SHAREABLE | ACCESSED)
#define CONSTANTS (MAIR_CACHED | READ_ONLY | SHAREABLE | ACCESSED | NEVER_RUN)
#define VARIABLES (MAIR_CACHED | SHAREABLE | ACCESSED | NEVER_RUN)
#define SHARED    (MAIR_NOT_CACHED | SHAREABLE | ACCESSED | NEVER_RUN)
#define DEVICE    (MAIR_DEVICE | ACCESSED | NEVER_RUN)

enum { PAGE_BITS = 12, BLOCK_BITS = 21, GIGABYTE_BITS = 30, ENTRIES = 512, PAGED_BLOCKS = 2 };

/* Of the linker script. */
extern const char __text_start[], __text_end[], __rodata_start[], __rodata_end[], __data_start[],
    __bss_end[], __stack_bottom[], __stack_top[], __exception_stack_bottom[],
    __exception_stack_top[], __last_stack_bottom[], __last_stack_top[], __kept_start[],
    __kept_end[], __bulk_start[], __bulk_end[], __shared_start[], __shared_end[];

struct tables {
    uint64_t gigabytes[ENTRIES];
    uint64_t low_blocks[ENTRIES];           /* of DDR from address 0 */
    uint64_t high_blocks[ENTRIES];          /* of registers, below 4 GiB */
    uint64_t pages[PAGED_BLOCKS * ENTRIES]; /* of the first blocks */
};

static uint64_t address(const char *symbol)
{
    return (uint64_t)(uintptr_t)symbol;
}

static void map_pages(struct tables *t, const char *start, const char *end, uint64_t attributes)
{
    for (uint64_t a = address(start); a < address(end); a += UINT64_C(1) << PAGE_BITS) {
        t->pages[a >> PAGE_BITS] = a | attributes | PAGE;
    }
}

static void map_blocks(uint64_t *blocks, uint64_t start, uint64_t end, uint64_t attributes)
{
    for (uint64_t a = start; a < end; a += UINT64_C(1) << BLOCK_BITS) {
        blocks[a >> BLOCK_BITS & (ENTRIES - 1)] = a | attributes | BLOCK;
    }
}

static void map_memory(struct tables *t)
{
    map_pages(t, __text_start, __text_end, CODE);
    map_pages(t, __rodata_start, __rodata_end, CONSTANTS);
    map_pages(t, __data_start, __bss_end, VARIABLES);
    map_pages(t, __stack_bottom, __stack_top, VARIABLES);
    map_pages(t, __exception_stack_bottom, __exception_stack_top, VARIABLES);
    map_pages(t, __last_stack_bottom, __last_stack_top, VARIABLES);
    map_pages(t, __kept_start, __kept_end, VARIABLES);
    map_blocks(t->low_blocks, address(__bulk_start), address(__bulk_end), VARIABLES);
    map_blocks(t->low_blocks, address(__shared_start), address(__shared_end), SHARED);
    for (uint32_t i = 0; i < PAGED_BLOCKS; i++) {
        t->low_blocks[i] = (uint64_t)(uintptr_t)(t->pages + (size_t)ENTRIES * i) | TABLE;
    }
}

const void *zcu102_mmu_build(void)
{
    /* start.S has cleared it: what is not mapped here faults. */
    static ZCU102_TABLES struct tables tables;
    struct tables *t = &tables;
    map_memory(t);
    map_blocks(t->high_blocks, 0xF9000000u, 0xF9200000u, DEVICE); /* interrupt controller */
    map_blocks(t->high_blocks, 0xFD400000u, 0xFD600000u, DEVICE); /* display, its DMA, watchdog */
    map_blocks(t->high_blocks, 0xFF000000u, 0xFF200000u, DEVICE); /* UART, CAN, flash */
    t->gigabytes[0] = (uint64_t)(uintptr_t)t->low_blocks | TABLE;
    t->gigabytes[0xFFFFFFFFu >> GIGABYTE_BITS] = (uint64_t)(uintptr_t)t->high_blocks | TABLE;
    return t;
}
