/* What a fuzz target is: a file fuzz_NAME.c that defines the two things below, and a folder
 * corpus/NAME of small inputs to begin with. It is linked twice: with clang's libFuzzer (fuzz.sh),
 * and with standalone.c into a test that needs no fuzzer. */
#ifndef FUZZ_H
#define FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Feed one input to the code under test. Always 0; whatever is wrong aborts the program. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* How many mutated inputs the test in `make check` tries: some seconds of them. */
extern const uint32_t fuzz_mutations;

/* What must hold whatever the input is. */
#define FUZZ_ASSERT(condition)                                                                     \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            fprintf(stderr, "%s:%d: does not hold: %s\n", __FILE__, __LINE__, #condition);         \
            abort();                                                                               \
        }                                                                                          \
    } while (0)

/* The input as a supply of numbers, little-endian; zeros once it is used up. */
struct fuzz_supply {
    const uint8_t *at;
    size_t left;
};

static inline uint64_t fuzz_take(struct fuzz_supply *s, size_t bytes)
{
    uint64_t value = 0;
    const size_t n = bytes < s->left ? bytes : s->left;
    memcpy(&value, s->at, n);
    s->at += n;
    s->left -= n;
    return value;
}

static inline uint8_t fuzz_u8(struct fuzz_supply *s)
{
    return (uint8_t)fuzz_take(s, 1);
}

static inline uint16_t fuzz_u16(struct fuzz_supply *s)
{
    return (uint16_t)fuzz_take(s, 2);
}

static inline uint32_t fuzz_u32(struct fuzz_supply *s)
{
    return (uint32_t)fuzz_take(s, 4);
}

/* The input as a file, for readers that insist on a name. */
struct fuzz_file {
    int descriptor;
    size_t size;
    char path[32];
};

void fuzz_file_open(struct fuzz_file *f, const uint8_t *data, size_t size);
void fuzz_file_close(struct fuzz_file *f);

#endif
