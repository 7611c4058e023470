/* MMU: translation tables of the board (linker/zcu102.ld). An address is mapped to itself or not at
 * all. Mapped are
 * - code: read-only;
 * - constants: read-only, not executable;
 * - variables and stacks, with unmapped pages between them;
 * - bulk memory;
 * - memory shared with devices: not cached;
 * - registers of the devices in use.
 * Any other access faults, so that a stray pointer is found. */
#ifndef ZCU102_MMU_H
#define ZCU102_MMU_H

/* Write the tables and return the first one. Called by start.S with the MMU off. */
const void *zcu102_mmu_build(void);

/* Enable MMU and caches. Implemented in start.S. */
void zcu102_mmu_enable(const void *table);

#endif
