/* What the plugin of this folder uses of QEMU's interface for plugins, version 1 (QEMU 6.0 to 8.2;
 * QEMU's docs/devel/tcg-plugins.rst). Debian does not package QEMU's own header. A QEMU of another
 * version refuses the plugin by the number that it exports. */
#ifndef QEMU_PLUGIN_H
#define QEMU_PLUGIN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { QEMU_PLUGIN_INTERFACE = 1, QEMU_PLUGIN_NO_REGISTERS = 0, QEMU_PLUGIN_READS_AND_WRITES = 3 };

struct qemu_plugin_tb;
struct qemu_plugin_insn;

/* Called by QEMU: first when the plugin is loaded; the others as they were registered. */
int qemu_plugin_install(uint64_t id, const void *info, int argc, char **argv);
typedef void (*qemu_translated)(uint64_t id, struct qemu_plugin_tb *block);
typedef void (*qemu_executed)(unsigned int cpu, void *data);
typedef void (*qemu_accessed)(unsigned int cpu, uint32_t info, uint64_t address, void *data);
typedef void (*qemu_ended)(uint64_t id, void *data);

void qemu_plugin_register_vcpu_tb_trans_cb(uint64_t id, qemu_translated call);
void qemu_plugin_register_vcpu_tb_exec_cb(struct qemu_plugin_tb *block, qemu_executed call,
                                          int registers, void *data);
void qemu_plugin_register_vcpu_mem_cb(struct qemu_plugin_insn *instruction, qemu_accessed call,
                                      int registers, int which, void *data);
void qemu_plugin_register_atexit_cb(uint64_t id, qemu_ended call, void *data);

size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *block);
uint64_t qemu_plugin_tb_vaddr(const struct qemu_plugin_tb *block);
struct qemu_plugin_insn *qemu_plugin_tb_get_insn(const struct qemu_plugin_tb *block, size_t index);
unsigned int qemu_plugin_mem_size_shift(uint32_t info);

#endif
