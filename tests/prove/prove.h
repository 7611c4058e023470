/* What proofs say to the model checker. PROVE must hold for every value that ASSUME leaves. A
 * function nondet_TYPE is declared and never defined: its result is any value of the type, that of
 * a struct any bytes.
 */
#ifndef PROVE_H
#define PROVE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

void __CPROVER_assume(_Bool);
void __CPROVER_assert(_Bool, const char *);

#define ASSUME(condition) __CPROVER_assume(condition)
#define PROVE(condition)  __CPROVER_assert((condition), #condition)

bool nondet_bool(void);
uint8_t nondet_u8(void);
uint16_t nondet_u16(void);
uint32_t nondet_u32(void);
int32_t nondet_i32(void);
uint64_t nondet_u64(void);
int64_t nondet_i64(void);

#endif
