/* For clang-tidy alone, before every source of host-sim: what it cannot see from a declaration,
 * that hs_error returns -1. Without it every `return hs_error(...)` looks as if the caller might go
 * on. */
#include "hs/error.h"
#define hs_error(...) (hs_error(__VA_ARGS__), -1)
