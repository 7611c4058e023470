/* Memory sections for large variables (linker/zcu102.ld). None of them is cleared at the start, but
 * the tables. */
#ifndef ZCU102_SECTIONS_H
#define ZCU102_SECTIONS_H

/* Bulk memory, cached: tiles and pictures. */
#define ZCU102_BULK __attribute__((section(".bss._bulk"), aligned(64)))

/* Memory that devices read and write: not cached. */
#define ZCU102_SHARED __attribute__((section(".bss._shared"), aligned(256)))

/* Memory that keeps its contents across a reset. */
#define ZCU102_KEPT __attribute__((section(".bss._kept"), aligned(64)))

/* Translation tables: cleared first, for all other variables are cleared with the MMU on. */
#define ZCU102_TABLES __attribute__((section(".bss._tables"), aligned(4096)))

#endif
