/* Translation tables of the board (linker/zcu102.ld): every address maps to itself, or to nothing.
 * Mapped are code (read-only), constants (read-only, never run), variables and stacks with unmapped
 * pages between them, bulk memory, memory shared with devices (not cached), and the registers of
 * the devices in use. Anything else faults, so that a stray pointer is found. */
#ifndef ZCU102_MMU_H
#define ZCU102_MMU_H

/* Write the tables and return the first; called from start.S with the MMU still off. */
const void *zcu102_mmu_build(void);

/* Turn MMU and caches on (start.S). */
void zcu102_mmu_enable(const void *table);

#endif
