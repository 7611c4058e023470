/* Plugin of QEMU: what a flight on the board executes and touches, by mode and stage. A stage is
 * what tests/zcu102/images counts: it begins where its caller passes the linker's __wrap_NAME and
 * ends at instrument_leave; inner stages count for themselves. The instrument's own code is left
 * out.
 *
 *   plugin.so,plan=FILE,out=FILE
 *
 * The plan has a line for each fact (hexadecimal addresses):
 *   stage ADDRESS        of __wrap_NAME: stage 1, 2, ... in this order
 *   leave ADDRESS        of instrument_leave
 *   modes ADDRESS COUNT  words of 32 bits: a store to word i begins mode i
 *   skip ADDRESS BYTES   code that is not counted
 *   shared ADDRESS BYTES memory that is not cached
 * The output, a line each:
 *   sum MODE STAGE CALLS INSTRUCTIONS CODE... DATA... SHARED  (struct cache_counts, each)
 *   block INDEX ADDRESS INSTRUCTIONS
 *   trace MODE STAGE INDEX...                                 blocks in their order, from samples
 */
#include "cache_model.h"
#include "qemu_plugin.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MODES_MAX = 20,
    STAGES_MAX = 81,
    RANGES_MAX = 32,
    DEPTH_MAX = 32,
    PATH_MAX_CHARS = 512,
    INSTRUCTION_BYTES = 4,
    /* Of every 31 stretches of 2,000 blocks, which is a line or less, one is traced. */
    STRETCH_BLOCKS = 2000,
    STRETCHES = 31,
    TRACE_BLOCKS_MAX = 16000,
};

struct range {
    uint64_t address, bytes;
};

struct sum {
    uint64_t calls, instructions, shared;
    struct cache_counts code, data;
    uint32_t *blocks;
    uint32_t traced;
};

struct block {
    uint64_t address;
    uint32_t instructions, index;
    uint32_t enters; /* the stage, or 0 */
    bool leaves, is_skipped;
    struct block *before;
};

int qemu_plugin_version = QEMU_PLUGIN_INTERFACE;

/* One flight, one plugin: QEMU hands its callbacks nothing else. */
static struct {
    struct range stages[STAGES_MAX], skipped[RANGES_MAX], modes, shared;
    uint32_t stage_count, skipped_count;
    uint64_t leave;
    char out[PATH_MAX_CHARS];
    struct cache_levels levels;
    struct sum sums[MODES_MAX][STAGES_MAX];
    uint32_t stack[DEPTH_MAX], depth, mode;
    uint64_t executed;
    bool is_skipping;
    struct block *last;
    uint32_t block_count;
} flight;

static bool lies_in(const struct range *range, uint64_t address)
{
    return address - range->address < range->bytes;
}

static uint32_t stage_now(void)
{
    return flight.depth ? flight.stack[(flight.depth - 1) % DEPTH_MAX] : 0;
}

static void trace(struct sum *sum, const struct block *block)
{
    if (flight.executed++ / STRETCH_BLOCKS % STRETCHES != 0 || sum->traced == TRACE_BLOCKS_MAX) {
        return;
    }
    if (sum->blocks == NULL) {
        sum->blocks = calloc(TRACE_BLOCKS_MAX, sizeof *sum->blocks);
        if (sum->blocks == NULL) {
            return;
        }
    }
    sum->blocks[sum->traced++] = block->index;
}

static void executed(unsigned int cpu, void *data)
{
    const struct block *block = data;
    (void)cpu;
    if (block->enters) {
        flight.stack[flight.depth++ % DEPTH_MAX] = block->enters;
        flight.sums[flight.mode][block->enters].calls++;
    }
    flight.depth -= block->leaves && flight.depth > 0;
    flight.is_skipping = block->is_skipped;
    if (block->is_skipped) {
        return;
    }
    struct sum *sum = &flight.sums[flight.mode][stage_now()];
    sum->instructions += block->instructions;
    cache_model_code(&flight.levels, block->address, block->instructions * INSTRUCTION_BYTES,
                     &sum->code);
    trace(sum, block);
}

static void accessed(unsigned int cpu, uint32_t info, uint64_t address, void *data)
{
    (void)cpu;
    (void)data;
    if (lies_in(&flight.modes, address)) {
        flight.mode = (uint32_t)((address - flight.modes.address) / sizeof(uint32_t)) % MODES_MAX;
    }
    if (flight.is_skipping) {
        return;
    }
    struct sum *sum = &flight.sums[flight.mode][stage_now()];
    if (lies_in(&flight.shared, address)) {
        sum->shared++;
        return;
    }
    cache_model_data(&flight.levels, address, 1U << qemu_plugin_mem_size_shift(info), &sum->data);
}

static void classify(struct block *block)
{
    for (uint32_t i = 0; i < flight.stage_count; i++) {
        block->enters = flight.stages[i].address == block->address ? i + 1 : block->enters;
    }
    for (uint32_t i = 0; i < flight.skipped_count; i++) {
        block->is_skipped |= lies_in(&flight.skipped[i], block->address);
    }
    block->leaves = block->address == flight.leave;
}

static void translated(uint64_t id, struct qemu_plugin_tb *tb)
{
    (void)id;
    struct block *block = calloc(1, sizeof *block);
    if (block == NULL) {
        abort();
    }
    block->address = qemu_plugin_tb_vaddr(tb);
    block->instructions = (uint32_t)qemu_plugin_tb_n_insns(tb);
    block->index = flight.block_count++;
    block->before = flight.last;
    flight.last = block;
    classify(block);
    qemu_plugin_register_vcpu_tb_exec_cb(tb, executed, QEMU_PLUGIN_NO_REGISTERS, block);
    for (uint32_t i = 0; i < block->instructions; i++) {
        qemu_plugin_register_vcpu_mem_cb(qemu_plugin_tb_get_insn(tb, i), accessed,
                                         QEMU_PLUGIN_NO_REGISTERS, QEMU_PLUGIN_READS_AND_WRITES,
                                         NULL);
    }
}

static void print_counts(FILE *out, const struct cache_counts *c)
{
    fprintf(out, " %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64, c->accesses,
            c->misses, c->next, c->far_misses, c->far_next);
}

static void print_sum(FILE *out, uint32_t mode, uint32_t stage)
{
    const struct sum *sum = &flight.sums[mode][stage];
    if (sum->instructions == 0) {
        return;
    }
    fprintf(out, "sum %u %u %" PRIu64 " %" PRIu64, mode, stage, sum->calls, sum->instructions);
    print_counts(out, &sum->code);
    print_counts(out, &sum->data);
    fprintf(out, " %" PRIu64 "\ntrace %u %u", sum->shared, mode, stage);
    for (uint32_t i = 0; i < sum->traced; i++) {
        fprintf(out, " %u", sum->blocks[i]);
    }
    fprintf(out, "\n");
}

static void ended(uint64_t id, void *data)
{
    (void)id;
    (void)data;
    FILE *out = fopen(flight.out, "w");
    if (out == NULL) {
        fprintf(stderr, "plugin: %s cannot be written\n", flight.out);
        return;
    }
    for (const struct block *b = flight.last; b; b = b->before) {
        fprintf(out, "block %u %" PRIx64 " %u\n", b->index, b->address, b->instructions);
    }
    for (uint32_t mode = 0; mode < MODES_MAX; mode++) {
        for (uint32_t stage = 0; stage <= flight.stage_count; stage++) {
            print_sum(out, mode, stage);
        }
    }
    if (fclose(out) != 0) {
        fprintf(stderr, "plugin: %s was not written to its end\n", flight.out);
    }
}

/* False if the line is none of a plan's. */
static bool take_line(const char *word, uint64_t first, uint64_t second)
{
    const struct range range = {.address = first, .bytes = second};
    if (strcmp(word, "stage") == 0 && flight.stage_count + 1 < STAGES_MAX) {
        flight.stages[flight.stage_count++] = range;
    } else if (strcmp(word, "skip") == 0 && flight.skipped_count < RANGES_MAX) {
        flight.skipped[flight.skipped_count++] = range;
    } else if (strcmp(word, "leave") == 0) {
        flight.leave = first;
    } else if (strcmp(word, "shared") == 0) {
        flight.shared = range;
    } else if (strcmp(word, "modes") == 0) {
        flight.modes = (struct range){.address = first, .bytes = second * sizeof(uint32_t)};
    } else {
        return false;
    }
    return true;
}

static bool read_plan(const char *path)
{
    FILE *plan = fopen(path, "r");
    if (plan == NULL) {
        fprintf(stderr, "plugin: the plan %s cannot be read\n", path);
        return false;
    }
    char line[PATH_MAX_CHARS], word[16];
    bool good = true;
    while (good && fgets(line, sizeof line, plan)) {
        uint64_t first = 0, second = 0;
        good = sscanf(line, "%15s %" SCNx64 " %" SCNx64, word, &first, &second) >= 2 &&
               take_line(word, first, second);
    }
    if (!good) {
        fprintf(stderr, "plugin: the plan %s has a line that is none: %s", path, line);
    }
    fclose(plan);
    return good;
}

static const char *option(int argc, char **argv, const char *name)
{
    const size_t length = strlen(name);
    for (int i = 0; i < argc; i++) {
        if (strncmp(argv[i], name, length) == 0) {
            return argv[i] + length;
        }
    }
    return NULL;
}

int qemu_plugin_install(uint64_t id, const void *info, int argc, char **argv)
{
    (void)info;
    const char *plan = option(argc, argv, "plan="), *out = option(argc, argv, "out=");
    if (plan == NULL || out == NULL || strlen(out) >= sizeof flight.out || !read_plan(plan)) {
        fprintf(stderr, "plugin: it wants plan=FILE,out=FILE\n");
        return 1;
    }
    strcpy(flight.out, out);
    cache_model_levels(&flight.levels);
    qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
    qemu_plugin_register_atexit_cb(id, ended, NULL);
    return 0;
}
